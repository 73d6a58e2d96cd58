// The picture of a channel in a box, its colour bar or the names of its colours, and the cross of the pixel.

const picture = document.createElement('canvas'); // as many pixels as the frame has here

function refreshPicture() {
  picture.width = shown.frame.columns;
  picture.height = shown.frame.rows;
  const bytes = new Uint8ClampedArray(shown.pixels.buffer);
  picture.getContext('2d').putImageData(new ImageData(bytes, shown.frame.columns, shown.frame.rows), 0, 0);
}

// From the number of a pixel among those that are here to the file's.
const step = run.pixel_step;

function drawPicture(context, box, colours) {
  const {columns, rows} = shown.frame;
  context.imageSmoothingEnabled = box.width < columns; // shrunk: averaged; enlarged: each pixel a square
  context.imageSmoothingQuality = 'high';
  context.drawImage(picture, box.x, box.y, box.width, box.height);
  outline(context, box, colours.line);
  sideAxis(context, box, [-0.5 * step, (rows - 0.5) * step], colours, {down: true});
}

// The middle of a pixel in the box.
function placeOfPixel(box, column, row) {
  const {columns, rows} = shown.frame;
  return [box.x + (column + 0.5) / columns * box.width, box.y + (row + 0.5) / rows * box.height];
}

function drawCross(context, box, colours) {
  const [x, y] = placeOfPixel(box, shown.column, shown.row);
  const gap = Math.max(4, box.width / shown.frame.columns);
  line(context, box.x, y, x - gap, y, colours.mark);
  line(context, x + gap, y, box.x + box.width, y, colours.mark);
  line(context, x, box.y, x, y - gap, colours.mark);
  line(context, x, y + gap, x, box.y + box.height, colours.mark);
  for (const [colour, width] of [['#fff', 3.5], [colours.mark, 1.5]]) {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.strokeRect(x - gap / 2 - 1, y - gap / 2 - 1, gap + 2, gap + 2);
  }
}

function drawColourBar(context, box, colours) {
  const {channel, scale, ends} = shown;
  const map = coloursOf(scale);
  for (let y = 0; y < box.height; ++y) {
    context.fillStyle = cssColour(map[Math.round((1 - (y + 0.5) / box.height) * (steps - 1))]);
    context.fillRect(box.x, box.y + y, box.width, 1.5);
  }
  outline(context, box, colours.line);
  const value = shown.values[shown.row * shown.frame.columns + shown.column];
  if (scale === 'turn') {
    ['0', 'π/2', 'π', '3π/2', '2π'].forEach((words, i) => {
      const y = box.y + (1 - i / 4) * box.height;
      line(context, box.x + box.width + 1, y, box.x + box.width + 5, y, colours.line);
      text(context, words, box.x + box.width + 8, y, colours.quiet);
    });
  } else {
    sideAxis(context, box, ends, colours, {right: true});
  }
  text(context, channel.unit || '1', box.x, box.y - 12, colours.quiet);
  const share = (value - ends[0]) / (ends[1] - ends[0]);
  if (!Number.isNaN(share)) {
    const y = box.y + (1 - Math.max(0, Math.min(1, share))) * box.height;
    context.fillStyle = colours.mark;
    context.beginPath();
    context.moveTo(box.x - 1, y);
    context.lineTo(box.x - 9, y - 5);
    context.lineTo(box.x - 9, y + 5);
    context.fill();
  }
}

// Which numbers an integer channel has, the most frequent first: [[number, pixels], ...].
function frequentNumbers(values) {
  const counts = new Map();
  for (const value of values) counts.set(value, (counts.get(value) ?? 0) + 1);
  return [...counts].sort((a, b) => b[1] - a[1] || a[0] - b[0]);
}

function drawColourNames(context, box, colours) {
  const numbers = frequentNumbers(shown.values), fit = Math.floor(box.height / 20) - 1;
  numbers.slice(0, fit).forEach(([value], i) => {
    const y = box.y + 8 + 20 * i;
    context.fillStyle = cssColour(colourOfInteger(shown.channel, value));
    context.fillRect(box.x, y - 6, 12, 12);
    text(context, fitting(context, valueText(shown.channel, value), box.width - 20), box.x + 18, y, colours.ink);
  });
  const more = numbers.length - fit;
  if (more > 0) text(context, `and ${more} more`, box.x, box.y + 8 + 20 * fit, colours.quiet);
}

function drawNoneName(context, box, colours) {
  context.fillStyle = cssColour(noneColour);
  context.fillRect(box.x, box.y + 1, 12, 12);
  text(context, shown.channel.none, box.x + 18, box.y + 7, colours.quiet);
}

// The words, cut where they are longer than `width`.
function fitting(context, words, width) {
  let cut = words;
  while (cut.length > 1 && context.measureText(cut).width > width) cut = `${cut.replace(/…$/, '').slice(0, -1)}…`;
  return cut;
}
