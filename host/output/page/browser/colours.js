// Colours for values. The maps come with the page: red, green and blue at even steps from 0 to 1.

const steps = 1024;
const packedColour = (red, green, blue) => (255 << 24 | blue << 16 | green << 8 | red) >>> 0; // as ImageData has it
const noneColour = packedColour(...run.colours.none.map(level => Math.round(255 * level)));

// The colours of a map at `steps` places.
function mapColours(name) {
  const levels = run.colours[name === 'share' ? 'sequential' : name];
  const last = levels[0].length - 1;
  return Uint32Array.from({length: steps}, (_, i) => {
    const place = i / (steps - 1) * last;
    const below = Math.min(Math.floor(place), last - 1);
    const mixed = level => Math.round(255 * (level[below] + (level[below + 1] - level[below]) * (place - below)));
    return packedColour(...levels.map(mixed));
  });
}

const mapsMade = {};
const coloursOf = scale => mapsMade[scale] ??= mapColours(scale);

const cssColour = packed => `rgb(${packed & 255} ${packed >> 8 & 255} ${packed >> 16 & 255})`;

// A colour of its own for each id: hues by the golden ratio, so that neighbours differ.
function idColour(id) {
  const hue = id * 0.618033988749895 % 1 * 6;
  const light = 0.82 - 0.13 * (id % 3), low = light * (0.32 + 0.16 * (Math.floor(id / 3) % 3));
  const ramp = offset => Math.abs((hue + offset) % 6 - 3) - 1;
  const part = offset => Math.round(255 * (low + (light - low) * Math.min(1, Math.max(0, ramp(offset)))));
  return packedColour(part(0), part(4), part(2));
}

function colourOfInteger(channel, value) {
  if (isId(channel)) return value === noId ? noneColour : idColour(value);
  return value === 0 ? noneColour : idColour(value);
}

// The pixels of a picture of `values`, in the colours of `scale` between the ends of `range`.
function pixelsOf(channel, values, scale, range) {
  const pixels = new Uint32Array(values.length);
  if (isNumbered(channel)) {
    for (let i = 0; i < values.length; ++i) pixels[i] = colourOfInteger(channel, values[i]);
    return pixels;
  }
  const map = coloursOf(scale);
  const factor = (steps - 1) / (range[1] - range[0]);
  for (let i = 0; i < values.length; ++i) {
    const place = (values[i] - range[0]) * factor;
    const within = place <= 0 ? 0 : place >= steps - 1 ? steps - 1 : place + 0.5 | 0;
    pixels[i] = Number.isNaN(place) ? noneColour : map[within];
  }
  return pixels;
}

// The page's own colours, as the style has them just now.
function palette() {
  const style = getComputedStyle(document.documentElement);
  const colour = name => style.getPropertyValue(`--${name}`).trim();
  const names = ['card', 'ink', 'quiet', 'line', 'grid', 'accent', 'mark'];
  return Object.fromEntries(names.map(name => [name, colour(name)]));
}
