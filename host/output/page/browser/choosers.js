// What the reader chooses: sensor, channel, frequency, frame, the ends of the colours.

const chooser = id => document.getElementById(id);
const fill = (select, options) => select.replaceChildren(...options);

function fillSensors() {
  fill(chooser('sensor'), run.sensors.map((sensor, i) => new Option(sensor.name, i)));
  chooser('sensor-chooser').hidden = run.sensors.length < 2;
}

// Each quantity once, whatever its frequencies, in groups.
function fillChannels() {
  const groups = new Map();
  for (const channel of shown.frame.channels) {
    const group = groups.get(channel.group) ?? new Map();
    group.set(channel.quantity, channel);
    groups.set(channel.group, group);
  }
  fill(chooser('channel'), [...groups].map(([name, channels]) => {
    const group = document.createElement('optgroup');
    group.label = name;
    for (const channel of channels.values())
      group.append(new Option(channel.unit ? `${channel.title} (${channel.unit})` : channel.title, channel.quantity));
    return group;
  }));
}

function fillFrequencies() {
  const hertz = listOf(shown.frame.entry.modulation_hz);
  const several = shown.frame.channels.some(channel => channel.frequency !== null);
  fill(chooser('frequency'), hertz.map((value, i) => new Option(frequencyText(value), i)));
  chooser('frequency-chooser').hidden = !several;
}

function settleFrames() {
  const count = shown.sensor.frames.length;
  chooser('frame').max = count - 1;
  chooser('frame-chooser').hidden = chooser('same-chooser').hidden = count < 2;
}

function frameText() {
  const {frame, entry} = shown.frame;
  const seconds = typeof entry.time_s === 'number' ? `, ${numberText(entry.time_s, 4)} s` : '';
  return `${frame}${seconds}`;
}

// Writes what is shown into the choosers.
function settle() {
  chooser('sensor').value = run.sensors.indexOf(shown.sensor);
  chooser('channel').value = shown.quantity;
  chooser('frequency').value = shown.frequency;
  chooser('frame').value = shown.sensor.frames.indexOf(shown.frame);
  chooser('frame-text').textContent = chooser('frame').ariaValueText = frameText();
  chooser('range').value = shown.range;
  chooser('own-range').hidden = shown.range !== 'own';
}
views.push(changed => { if (changed.has('values')) settle(); });

function choose(channel) {
  shown.quantity = channel.quantity;
  if (channel.frequency !== null) shown.frequency = channel.frequency;
  return show();
}

function chooseSensor(index) {
  shown.sensor = run.sensors[index];
  shown.frame = shown.sensor.frames[0];
  shown.frequency = 0;
  fillChannels();
  fillFrequencies();
  settleFrames();
  look(shown.frame.columns >> 1, shown.frame.rows >> 1);
  return show();
}

function chooseFrame(index) {
  shown.frame = shown.sensor.frames[index];
  return show();
}

function chooseRange() {
  shown.range = chooser('range').value;
  if (shown.range === 'own') {
    shown.own = shown.ends.map(end => Number(end.toPrecision(6)));
    [chooser('range-from').value, chooser('range-to').value] = shown.own;
  }
  paint();
}

function takeOwnRange() {
  const ends = [chooser('range-from').valueAsNumber, chooser('range-to').valueAsNumber];
  if (!(ends[0] < ends[1])) return;
  shown.own = ends;
  paint();
}

// One frame after the other, each as soon as it is there, at most ten a second.
let playing = false;
async function play() {
  playing = !playing;
  chooser('play').textContent = playing ? 'Stop' : 'Play';
  chooser('play').ariaPressed = String(playing);
  while (playing) {
    const next = (shown.sensor.frames.indexOf(shown.frame) + 1) % shown.sensor.frames.length;
    chooseFrame(next);
    await new Promise(resolve => setTimeout(resolve, 100));
  }
}

chooser('choosers').addEventListener('submit', event => event.preventDefault());
chooser('sensor').addEventListener('change', event => chooseSensor(Number(event.target.value)));
chooser('channel').addEventListener('change', event => { shown.quantity = event.target.value; show(); });
chooser('frequency').addEventListener('change', event => { shown.frequency = Number(event.target.value); show(); });
chooser('frame').addEventListener('input', event => chooseFrame(Number(event.target.value)));
chooser('play').addEventListener('click', play);
chooser('range').addEventListener('change', chooseRange);
chooser('range-from').addEventListener('change', takeOwnRange);
chooser('range-to').addEventListener('change', takeOwnRange);
chooser('same').addEventListener('change', event => { shown.same = event.target.checked; paint(); });
