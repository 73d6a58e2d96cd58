// What the run says of itself: by what it was made, how exact it is, how long it took, what is in it.

const part = id => document.getElementById(id);

function listInto(section, title, sentences) {
  if (sentences.length === 0) return;
  const head = document.createElement('p'), list = document.createElement('ul');
  head.textContent = title;
  for (const sentence of sentences) {
    const item = document.createElement('li');
    item.textContent = sentence;
    list.append(item);
  }
  section.replaceChildren(head, list);
  section.hidden = false;
}

// What a manifest has as a list; anyone may have edited it.
const listOf = list => (Array.isArray(list) ? list : []);

function warningText(warning) {
  if (typeof warning === 'string') return warning;
  const place = warning?.place ? `${warning.place}: ` : '', code = warning?.code ? ` (${warning.code})` : '';
  return `${place}${warning?.text ?? JSON.stringify(warning)}${code}`;
}

// Those of the run, which tell of its frames, too; where a manifest has none, those of frames with their numbers.
function warnings() {
  const list = listOf(run.head.warnings).map(warningText);
  if (run.head.warnings) return list;
  for (const sensor of run.sensors)
    for (const {frame, entry} of sensor.frames) {
      for (const warning of listOf(entry.warnings))
        list.push(`${sensor.name}, frame ${frame}: ${warningText(warning)}`);
      if (entry.unpromised > 0 && !entry.warnings)
        list.push(`${sensor.name}, frame ${frame}: ${entry.unpromised} returns may be off by more than was asked for.`);
    }
  return list;
}

// An error in metres and as a share of the amplitude, as far as they are known.
function errorText(metres, share) {
  const words = [];
  if (typeof metres === 'number') words.push(lengthText(metres));
  if (typeof share === 'number') words.push(`${numberText(100 * share, 3)} % of the amplitude`);
  return words.join(', ');
}

function accuracyFacts(head, entry) {
  const modes = {
    exact: 'exact: every diode at every sample',
    reduced: 'reduced: few sources in place of the diodes',
    auto: 'auto: the cheapest way within the error',
  };
  const asked = errorText(head.max_error_m, head.max_amplitude_error);
  const claimed = errorText(entry.error_claimed_m, entry.amplitude_error_claimed);
  const found = errorText(entry.error_found_m, entry.amplitude_error_found);
  return [
    ['mode', modes[entry.mode ?? head.mode] ?? entry.mode],
    ['error asked for', asked && `at most ${asked}`],
    ['error claimed', claimed ? `at most ${claimed}` : entry.mode && 'nothing is claimed'],
    ['error found', found ? `${found}, in ${entry.checked_pixels} pixels that were computed again` : ''],
    ['returns beyond the error', entry.unpromised > 0 ? String(entry.unpromised) : ''],
    ['precision', entry.precision],
  ];
}

function bouncesText({elements, claimed_m}) {
  const claimed = typeof claimed_m === 'number'
    ? `; multipath is off by ${lengthText(claimed_m)} at most in 95 % of the pixels` : '';
  return `${elements} elements of surfaces${claimed}`;
}

function signalFacts(entry) {
  const wave = typeof entry.waveform === 'string' ? entry.waveform : entry.waveform && 'harmonics';
  const hertz = listOf(entry.modulation_hz), ambiguity = listOf(entry.ambiguity_m).map(lengthText).join(', ');
  return [
    ['pixels', entry.resolution && `${entry.resolution[0]} columns x ${entry.resolution[1]} rows`],
    ['modulation', hertz.length > 0 && `${hertz.map(frequencyText).join(', ')}, ${wave}, ${entry.taps} taps`],
    ['ambiguity range', ambiguity],
    ['diodes', entry.diodes && String(entry.diodes)],
    ['light that bounces', entry.bounces && bouncesText(entry.bounces)],
  ];
}

function deformationFacts({told}) {
  const list = listOf(told?.deformation_mm), names = ['mean', 'min', 'max', 'centre', 'rms'];
  return list.map((of, i) => {
    const figure = name => (typeof of[name] === 'number' ? numberText(of[name], 5) : 'none');
    const at = list.length > 1 ? ` at ${frequencyText(listOf(told.modulation_hz)[i])}` : '';
    return [`deformation${at}`, `${names.map(name => `${name} ${figure(name)}`).join(', ')} mm`];
  });
}

// What `correct` found of an image.
function correctionFacts({correction}) {
  if (!correction) return [];
  const {pixels, noise_um} = correction;
  return [
    ['image', correction.image],
    ['corrected', pixels && `${pixels.corrected + pixels.edge} pixels, ${pixels.edge} of them at edges`],
    ['noise of ranges', typeof noise_um === 'number' && lengthText(1e-6 * noise_um)],
  ];
}

function writeFacts() {
  const {head} = run, {entry} = shown.frame;
  const rows = [
    ['made by', `${head.program ?? 'pmdsim'} ${head.version ?? ''} ${head.command ?? ''}`],
    ['device', head.device],
    ['driver', head.driver],
    ...correctionFacts(head), ...deformationFacts(shown.frame), ...accuracyFacts(head, entry), ...signalFacts(entry),
    ['run', head.run],
  ];
  const body = document.createElement('tbody');
  for (const [name, words] of rows.filter(([, words]) => words)) {
    const row = body.insertRow();
    cell(row, 'th', name);
    cell(row, 'td', words);
  }
  part('facts').replaceChildren(body);
}

function writeTimes() {
  const {frame_ms, passes_ms} = shown.frame;
  part('times-part').hidden = !passes_ms;
  if (!passes_ms) return;
  const passes = Object.entries(passes_ms).filter(([, ms]) => typeof ms === 'number');
  const most = Math.max(frame_ms, ...passes.map(([, ms]) => ms), 1e-9), body = document.createElement('tbody');
  for (const [name, ms] of [...passes, ['the whole frame', frame_ms]]) {
    const row = body.insertRow(), bar = document.createElement('span');
    cell(row, 'th', name.replaceAll('_', ' '));
    cell(row, 'td', timeText(ms), 'number');
    bar.style.width = `${100 * ms / most}%`;
    cell(row, 'td', '', 'bar').append(bar);
  }
  part('times').replaceChildren(body);
}

// The objects that the frame sees, by how many pixels.
function writeObjects() {
  const channel = shown.frame.channels.find(each => each.quantity === 'object_id');
  const values = channel && shown.all.get(channel.name);
  part('objects-part').hidden = !values;
  if (!values) return;
  const body = document.createElement('tbody'), head = document.createElement('thead');
  const title = head.insertRow();
  for (const [words, kind] of [['object', ''], ['name', ''], ['pixels', 'number'], ['share', 'number']])
    if (words !== 'name' || objectNames.size > 0) cell(title, 'th', words, kind).scope = 'col';
  for (const [id, count] of frequentNumbers(values).slice(0, 200)) {
    const row = body.insertRow(), swatch = document.createElement('span');
    swatch.className = 'swatch';
    swatch.style.background = cssColour(colourOfInteger(channel, id));
    cell(row, 'th', id === noId ? channel.none : String(id)).prepend(swatch);
    if (objectNames.size > 0) cell(row, 'td', objectNames.get(id) ?? '');
    cell(row, 'td', String(count), 'number');
    cell(row, 'td', `${numberText(100 * count / values.length, 3)} %`, 'number');
  }
  part('objects').replaceChildren(head, body);
}

function writeInputs() {
  const inputs = listOf(run.head.inputs);
  part('inputs-part').hidden = inputs.length === 0;
  const body = part('inputs').createTBody();
  for (const input of inputs) {
    const row = body.insertRow();
    cell(row, 'th', String(input.file));
    cell(row, 'td', typeof input.bytes === 'number' ? bytesText(input.bytes) : '', 'number');
    cell(row, 'td', input.xxh3_128 ? `XXH3 ${input.xxh3_128}` : '', 'unit');
  }
}

// Long texts are laid out when they are opened.
function unfolds(id, words) {
  const details = part(`${id}-part`);
  details.addEventListener('toggle', () => { if (details.open) part(id).textContent = words(); });
}

function writeRun() {
  const {head} = run;
  document.title = `${run.title}: pmdsim ${head.command ?? ''}`;
  part('title').textContent = run.title;
  const device = head.correction ? head.correction.image : head.device ?? 'unknown device';
  part('summary').textContent = `pmdsim ${head.version ?? ''} ${head.command ?? ''}, ${device}`;
  listInto(part('warnings'), 'Warnings of the run:', warnings());
  part('left-out').hidden = run.left_out.length === 0;
  part('left-out').textContent =
    `The files have more than this page. ${run.left_out.join(' ')} A larger page has more: pmdsim report --max-size.`;
  unfolds('setup', () => JSON.stringify(head.setup, null, 2));
  unfolds('camera', () => JSON.stringify(shown.frame.entry.camera, null, 2));
  part('footer').textContent = `Made by pmdsim ${head.version ?? ''}. This page works without a network.`;
  writeInputs();
}

let described = null;
views.push(changed => {
  if (described !== shown.frame) {
    writeFacts();
    writeTimes();
    if (part('camera-part').open) part('camera').textContent = JSON.stringify(shown.frame.entry.camera, null, 2);
  }
  if (described !== shown.frame || changed.has('others')) writeObjects();
  described = shown.frame;
});
