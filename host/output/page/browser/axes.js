// What all drawings share: a sharp canvas, boxes on it, axes and lines.

const font = '12px system-ui, "Segoe UI", "DejaVu Sans", Arial, sans-serif';

// The canvas's context, cleared, in CSS pixels: as wide as the canvas is laid out, `height` high.
function cleared(canvas, height) {
  const width = Math.max(200, canvas.clientWidth), sharp = window.devicePixelRatio || 1;
  canvas.style.height = `${height}px`;
  canvas.width = Math.round(width * sharp);
  canvas.height = Math.round(height * sharp);
  const context = canvas.getContext('2d');
  context.scale(sharp, sharp);
  context.font = font;
  context.textBaseline = 'middle';
  return context;
}

function text(context, words, x, y, colour, align = 'left') {
  context.fillStyle = colour;
  context.textAlign = align;
  context.fillText(words, x, y);
}

function line(context, x1, y1, x2, y2, colour, width = 1) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
  context.stroke();
}

function outline(context, box, colour) {
  context.strokeStyle = colour;
  context.lineWidth = 1;
  context.strokeRect(box.x - 0.5, box.y - 0.5, box.width + 1, box.height + 1);
}

// Ticks of a horizontal axis from `ends[0]` at the left to `ends[1]` at the right of the box; with `grid` lines
// across it.
function bottomAxis(context, box, ends, colours, {grid = false, labels = true, count = box.width / 80} = {}) {
  const list = ticks(ends[0], ends[1], count), words = tickTexts(list);
  list.forEach((value, i) => {
    const x = box.x + (value - ends[0]) / (ends[1] - ends[0]) * box.width;
    if (grid) line(context, x, box.y, x, box.y + box.height, colours.grid);
    else line(context, x, box.y + box.height + 1, x, box.y + box.height + 5, colours.line);
    if (labels) text(context, words[i], x, box.y + box.height + 14, colours.quiet, 'center');
  });
}

// The same from the bottom to the top, on the left of the box or on its right; `down` turns it over.
function sideAxis(context, box, ends, colours, {grid = false, right = false, down = false, labels = true} = {}) {
  const list = ticks(ends[0], ends[1], box.height / 45), words = tickTexts(list);
  list.forEach((value, i) => {
    const share = (value - ends[0]) / (ends[1] - ends[0]);
    const y = box.y + (down ? share : 1 - share) * box.height;
    const edge = right ? box.x + box.width + 1 : box.x - 5;
    if (grid) line(context, box.x, y, box.x + box.width, y, colours.grid);
    else line(context, edge, y, edge + 4, y, colours.line);
    if (labels) text(context, words[i], right ? edge + 7 : box.x - 7, y, colours.quiet, right ? 'left' : 'right');
  });
}
