// What is shown: which sensor, frame and channel, which pixel is looked at, and the values of these.

const shown = {
  sensor: run.sensors[0],
  frame: run.sensors[0].frames[0],
  quantity: '',
  frequency: 0,
  range: 'robust', // 'all', 'own'
  own: [0, 1],
  same: true, // the colours of all frames alike
  column: 0, row: 0, // of the pixel that is looked at, among those that are here
  held: false,       // it stays where it is when the mouse moves
  channel: null, values: null, scale: '', ends: [0, 1], pixels: null, // of the picture
  all: new Map(), // values by the channel's name, of this frame, as far as they are unpacked
};

// Views are functions that draw what has changed: 'values' or only the 'pixel' that is looked at.
const views = [];
let waiting = new Set();

function drawNow(changed) {
  if (shown.values) for (const view of views) view(changed);
}

function redraw(what) {
  if (waiting.size === 0)
    requestAnimationFrame(() => {
      const changed = waiting;
      waiting = new Set();
      drawNow(changed);
    });
  waiting.add(what);
}

// The channel of that name's quantity at the chosen frequency; of channels of no frequency the one there is.
function channelOf(frame, quantity, frequency) {
  const alike = frame.channels.filter(channel => channel.quantity === quantity);
  return alike.find(channel => channel.frequency === frequency) ?? alike[0];
}

// The least and the greatest value that colours are for: of this frame, or of all of the sensor's together.
function valuesRange(channel) {
  const key = shown.range === 'all' ? 'extent' : 'range';
  const frames = shown.same ? shown.sensor.frames : [shown.frame];
  const ranges = frames.map(frame => channelOf(frame, channel.quantity, channel.frequency ?? 0)?.[key]).filter(Boolean);
  if (ranges.length === 0) return channel.range;
  const range = [Math.min(...ranges.map(each => each[0])), Math.max(...ranges.map(each => each[1]))];
  return range[1] > range[0] ? range : channel.range;
}

// Which map of colours between which ends. Zero is in the middle where values lie on both sides of it, and where a
// quantity that has a sign does not stay far from zero: a deformation from 2.5 to 2.7 mm would be of one colour.
function scaleAndEnds(channel) {
  if (!['sequential', 'zero_centred'].includes(channel.scale)) return [channel.scale, channel.range ?? [0, 1]];
  if (shown.range === 'own') return [shown.own[0] < 0 && shown.own[1] > 0 ? 'zero_centred' : 'sequential', shown.own];
  const [least, greatest] = valuesRange(channel), size = Math.max(Math.abs(least), Math.abs(greatest));
  const straddles = least < 0 && greatest > 0, isNarrow = greatest - least < 0.5 * size;
  const isCentred = straddles || (channel.scale === 'zero_centred' && !isNarrow);
  return isCentred ? ['zero_centred', [-size, size]] : ['sequential', [least, greatest]];
}

function paint() {
  [shown.scale, shown.ends] = scaleAndEnds(shown.channel);
  shown.pixels = pixelsOf(shown.channel, shown.values, shown.scale, shown.ends);
  redraw('values');
}

// Unpacks the channel and then, when nothing else is asked for meanwhile, the frame's others.
let asked = 0;
async function show() {
  const mine = ++asked;
  const {frame} = shown;
  const channel = channelOf(frame, shown.quantity, shown.frequency) ?? frame.channels[0];
  shown.quantity = channel.quantity;
  const values = await valuesOf(channel);
  if (mine !== asked) return;
  const all = shown.all.frame === frame ? shown.all : Object.assign(new Map(), {frame});
  all.set(channel.name, values);
  Object.assign(shown, {channel, values, all});
  shown.column = Math.min(shown.column, frame.columns - 1);
  shown.row = Math.min(shown.row, frame.rows - 1);
  paint();
  await showOthers(mine, frame, all);
}

async function showOthers(mine, frame, all) {
  const later = frame.channels.filter(channel => !all.has(channel.name));
  // What points in space need comes first.
  later.sort((a, b) => (b.unit === 'm') - (a.unit === 'm'));
  for (const channel of later) {
    await new Promise(resolve => setTimeout(resolve));
    if (mine !== asked) return;
    all.set(channel.name, await valuesOf(channel));
    if (mine !== asked) return;
    redraw('others');
  }
}

function look(column, row) {
  const within = (value, count) => Math.max(0, Math.min(count - 1, value));
  const next = [within(column, shown.frame.columns), within(row, shown.frame.rows)];
  if (next[0] === shown.column && next[1] === shown.row) return;
  [shown.column, shown.row] = next;
  redraw('pixel');
}

// The frequency that the channel belongs to, of several.
const frequencyOf = channel => frequencyText(shown.frame.entry.modulation_hz?.[channel.frequency] ?? NaN);

// A value in words: its number, what it means that there is none, or the name of an object.
const objectNames = namesOfObjects(run.head.objects ?? run.sensors[0].frames[0].entry.objects);

function bitsText(bits) {
  if (bits === 0) return 'none';
  const names = [];
  for (let bit = 0; bit < 32; ++bit)
    if (bits >>> bit & 1) names.push(bit < 16 ? `A of image ${bit}` : `B of image ${bit - 16}`);
  return names.join(', ');
}

function valueText(channel, value) {
  if (channel.scale === 'bits') return bitsText(value);
  if (isId(channel)) {
    if (value === noId) return channel.none;
    const isNamed = channel.quantity === 'object_id' && objectNames.has(value);
    return isNamed ? `${value} (${objectNames.get(value)})` : String(value);
  }
  if (isInteger(channel)) return String(value);
  return Number.isNaN(value) ? channel.none : numberText(value, channel.kind === 'f8' ? 13 : 7);
}
const isNone = (channel, value) => Number.isNaN(value) || (isId(channel) && value === noId);
