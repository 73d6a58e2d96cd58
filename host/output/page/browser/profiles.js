// The values along the row and the column of the pixel that is looked at, beside the picture.

const valuesOfRow = row => shown.values.subarray(row * shown.frame.columns, (row + 1) * shown.frame.columns);
const valuesOfColumn = column =>
  Float64Array.from({length: shown.frame.rows}, (_, row) => shown.values[row * shown.frame.columns + column]);

// The ends of a curve's axis: of its own values, but no narrower than rounding or whole numbers make them.
function endsOfCurve(values) {
  if (shown.channel.scale === 'turn') return [0, 2 * Math.PI];
  let least = Infinity, greatest = -Infinity;
  for (const value of values)
    if (Number.isFinite(value) && !isNone(shown.channel, value)) {
      least = Math.min(least, value);
      greatest = Math.max(greatest, value);
    }
  if (least > greatest) return shown.ends;
  const middle = (least + greatest) / 2;
  const leastHalf = isInteger(shown.channel) ? 0.5 : Math.max(1e-6 * Math.abs(middle), 1e-30);
  const half = Math.max((greatest - least) / 2, leastHalf) * 1.06;
  return [middle - half, middle + half];
}

// A curve of values at even places; nothing is drawn where there is none. `place(share, level)` gives x and y of a
// place along the axis of pixels and a value, both from 0 to 1.
function drawCurve(context, values, ends, colour, place) {
  context.strokeStyle = context.fillStyle = colour;
  context.lineWidth = 1.4;
  context.lineJoin = 'round';
  context.beginPath();
  const isDotted = isInteger(shown.channel);
  let drawing = false;
  for (let i = 0; i < values.length; ++i) {
    const is = Number.isFinite(values[i]) && !isNone(shown.channel, values[i]);
    const [x, y] = place((i + 0.5) / values.length, (values[i] - ends[0]) / (ends[1] - ends[0]));
    if (is && isDotted) context.fillRect(x - 0.8, y - 0.8, 1.6, 1.6);
    else if (is && drawing) context.lineTo(x, y);
    else if (is) context.moveTo(x, y);
    drawing = is;
  }
  context.stroke();
}

function drawRowProfile(context, box, colours) {
  const values = valuesOfRow(shown.row), ends = endsOfCurve(values), {columns} = shown.frame;
  bottomAxis(context, box, [-0.5 * step, (columns - 0.5) * step], colours);
  sideAxis(context, box, ends, colours, {grid: true});
  outline(context, box, colours.line);
  const [x] = placeOfPixel(box, shown.column, shown.row);
  line(context, x, box.y, x, box.y + box.height, colours.mark);
  drawCurve(context, values, ends, colours.accent,
            (share, level) => [box.x + share * box.width, box.y + (1 - level) * box.height]);
  text(context, `along row ${shown.row * step}`, box.x + box.width + 14, box.y + 36, colours.quiet);
  text(context, shown.channel.unit, box.x + box.width + 14, box.y + 54, colours.quiet);
}

function drawColumnProfile(context, box, colours) {
  const values = valuesOfColumn(shown.column), ends = endsOfCurve(values);
  bottomAxis(context, box, ends, colours, {grid: true, count: 3});
  outline(context, box, colours.line);
  const [, y] = placeOfPixel(box, shown.column, shown.row);
  line(context, box.x, y, box.x + box.width, y, colours.mark);
  drawCurve(context, values, ends, colours.accent,
            (share, level) => [box.x + level * box.width, box.y + share * box.height]);
  text(context, `along column ${shown.column * step}`, box.x, box.y - 12, colours.quiet);
}
