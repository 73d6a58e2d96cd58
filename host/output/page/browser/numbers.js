// Numbers as people read them.

function trimmed(text) {
  return text.includes('.') && !text.includes('e') ? text.replace(/\.?0+$/, '') : text;
}

// With so many significant digits, and a proper minus sign.
function numberText(value, digits = 5) {
  if (value === 0) return '0';
  if (!Number.isFinite(value)) return Number.isNaN(value) ? 'no value' : value > 0 ? 'infinite' : '−infinite';
  const size = Math.abs(value);
  let text;
  if (size >= 1e7 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split('e');
    text = `${trimmed(mantissa)}e${Number(exponent)}`;
  } else {
    text = trimmed(value.toPrecision(digits));
    if (text.includes('e')) text = String(Math.round(value));
  }
  return text.replace(/-/g, '−');
}

const withUnit = (text, unit) => (unit ? `${text} ${unit}` : text);

function frequencyText(hertz) {
  if (hertz >= 1e6) return `${numberText(hertz / 1e6, 7)} MHz`;
  return hertz >= 1e3 ? `${numberText(hertz / 1e3, 7)} kHz` : `${numberText(hertz, 7)} Hz`;
}

// A length in the unit in which it is a number of a few digits.
function lengthText(metres) {
  const size = Math.abs(metres);
  for (const [factor, unit] of [[1, 'm'], [1e-3, 'mm'], [1e-6, 'µm'], [1e-9, 'nm']])
    if (size >= factor) return `${numberText(metres / factor, 4)} ${unit}`;
  return metres === 0 ? '0 m' : `${numberText(metres, 4)} m`;
}

function timeText(ms) {
  if (ms >= 1000) return `${numberText(ms / 1000, 4)} s`;
  return `${numberText(ms, 4)} ms`;
}

function bytesText(bytes) {
  if (bytes >= 1 << 20) return `${numberText(bytes / (1 << 20), 4)} MiB`;
  return bytes >= 1024 ? `${numberText(bytes / 1024, 4)} KiB` : `${bytes} bytes`;
}

function ordinalText(number) {
  const tens = Math.floor(number / 10) % 10, ones = number % 10;
  return number + (tens === 1 ? 'th' : ['th', 'st', 'nd', 'rd'][ones] ?? 'th');
}

// Round numbers from `least` to `greatest`, about `count` of them, at least two where there are any.
function ticks(least, greatest, count) {
  const span = greatest - least;
  if (!(span > 0)) return [least];
  const raw = span / Math.max(2, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const sizes = [0.2, 0.5, 1, 2, 5, 10].map(factor => factor * power);
  for (let i = sizes.findIndex(size => size >= raw * 0.999); ; --i) {
    const first = Math.ceil(least / sizes[i] - 1e-9), last = Math.floor(greatest / sizes[i] + 1e-9);
    if (last > first || i === 0) return Array.from({length: last - first + 1}, (_, k) => (first + k) * sizes[i]);
  }
}

// Labels of ticks, all with as many decimals as their step needs.
function tickTexts(list) {
  const size = Math.max(...list.map(Math.abs));
  if (list.length < 2 || size >= 1e6 || size < 1e-3) return list.map(value => numberText(value, 4));
  const step = list[1] - list[0];
  const decimals = Math.max(0, Math.min(9, Math.ceil(-Math.log10(step) - 1e-6)));
  return list.map(value => value.toFixed(decimals).replace('-', '−'));
}

// Count, mean, root of the mean square, and quantiles of the finite values.
function statisticsOf(values) {
  const finite = Float32Array.from(values.filter(Number.isFinite)).sort();
  const count = finite.length;
  let sum = 0, squares = 0;
  for (const value of finite) {
    sum += value;
    squares += value * value;
  }
  const at = share => finite[Math.min(count - 1, Math.floor(share * count))];
  return {count, none: values.length - count, least: finite[0], greatest: finite[count - 1], median: at(0.5),
          mean: sum / count, rms: Math.sqrt(squares / count)};
}
