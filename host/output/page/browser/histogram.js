// How often which value of the shown channel occurs: bars between the ends of the colours, in these colours; of
// integers the most frequent.

const histogramCanvas = document.getElementById('histogram');
const histogramHeight = 190;

function countsOf(values, ends, bars) {
  const counts = new Uint32Array(bars);
  let below = 0, above = 0, none = 0;
  const factor = bars / (ends[1] - ends[0]);
  for (const value of values) {
    if (Number.isNaN(value)) ++none;
    else if (value < ends[0]) ++below;
    else if (value > ends[1]) ++above;
    else ++counts[Math.min(bars - 1, Math.floor((value - ends[0]) * factor))];
  }
  return {counts, below, above, none};
}

// Of the colours' ends as much as this frame has values for.
function endsOfBars() {
  const {channel, ends} = shown, has = channel.extent ?? ends;
  const common = [Math.max(ends[0], has[0]), Math.min(ends[1], has[1])];
  return common[1] - common[0] > 0.02 * (ends[1] - ends[0]) ? common : ends;
}

function drawBars(context, width, colours) {
  const {channel, values, scale} = shown, bars = 96, ends = endsOfBars();
  const {counts, below, above, none} = countsOf(values, ends, bars);
  const box = {x: 52, y: 8, width: width - 66, height: histogramHeight - 52};
  const most = Math.max(1, ...counts), map = coloursOf(scale), [low, high] = shown.ends;
  sideAxis(context, box, [0, most], colours, {grid: true});
  bottomAxis(context, box, ends, colours, {count: box.width / 60});
  counts.forEach((count, i) => {
    const height = count / most * box.height;
    const value = ends[0] + (i + 0.5) / bars * (ends[1] - ends[0]);
    context.fillStyle = cssColour(map[Math.round((value - low) / (high - low) * (steps - 1))]);
    context.fillRect(box.x + i / bars * box.width, box.y + box.height - height, box.width / bars + 0.5, height);
  });
  line(context, box.x, box.y + box.height + 0.5, box.x + box.width, box.y + box.height + 0.5, colours.line);
  const words = [below && `${below} below`, above && `${above} above`, none && `${none} without: ${channel.none}`];
  text(context, words.filter(Boolean).join(', '), box.x, histogramHeight - 8, colours.quiet);
  text(context, channel.unit, box.x + box.width, histogramHeight - 8, colours.quiet, 'right');
}

function drawMostFrequent(context, width, colours) {
  const numbers = frequentNumbers(shown.values), most = numbers[0][1], fit = Math.floor(histogramHeight / 20) - 1;
  numbers.slice(0, fit).forEach(([value, count], i) => {
    const y = 10 + 20 * i, left = width * 0.42;
    text(context, fitting(context, valueText(shown.channel, value), left - 12), left - 8, y, colours.ink, 'right');
    context.fillStyle = cssColour(colourOfInteger(shown.channel, value));
    context.fillRect(left, y - 7, Math.max(1, count / most * (width - left - 80)), 14);
    text(context, `${numberText(100 * count / shown.values.length, 3)} %`, width - 4, y, colours.quiet, 'right');
  });
  const more = numbers.length - fit;
  if (more > 0) text(context, `and ${more} more numbers`, width * 0.42, histogramHeight - 8, colours.quiet);
}

function drawHistogram(changed) {
  if (!changed.has('values')) return;
  const context = cleared(histogramCanvas, histogramHeight), colours = palette();
  const draw = isNumbered(shown.channel) ? drawMostFrequent : drawBars;
  draw(context, histogramCanvas.clientWidth, colours);
}
views.push(drawHistogram);
