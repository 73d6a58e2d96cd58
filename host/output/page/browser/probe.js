// The table of all channels of the pixel that is looked at. A click on a channel shows it.

const probeTable = document.getElementById('probe');
const probeCells = new Map(); // by the channel's name
let probeFrame = null;

function cell(row, kind, words, name = '') {
  const made = document.createElement(kind);
  made.textContent = words;
  if (name) made.className = name;
  if (kind === 'th') made.scope = 'row';
  row.append(made);
  return made;
}

function groupRow(body, words) {
  const row = body.insertRow();
  row.className = 'group';
  const head = cell(row, 'th', words);
  head.colSpan = 3;
  head.scope = 'rowgroup';
}

function channelRow(body, channel) {
  const row = body.insertRow();
  const head = cell(row, 'th', '');
  const button = document.createElement('button');
  button.type = 'button';
  button.textContent = channel.title + (channel.frequency === null ? '' : `, ${frequencyOf(channel)}`);
  button.title = `${channel.name}: ${channel.about}`;
  head.append(button);
  row.addEventListener('click', () => choose(channel));
  probeCells.set(channel.name, {row, value: cell(row, 'td', '', 'number'), channel});
  cell(row, 'td', channel.scale === 'bits' ? '' : channel.unit, 'unit');
}

function makeProbe() {
  probeFrame = shown.frame;
  probeCells.clear();
  const body = document.createElement('tbody');
  let group = '';
  for (const channel of shown.frame.channels) {
    if (channel.group !== group) groupRow(body, channel.group);
    group = channel.group;
    channelRow(body, channel);
  }
  probeTable.replaceChildren(body);
}

function fillProbe() {
  if (probeFrame !== shown.frame) makeProbe();
  const at = shown.row * shown.frame.columns + shown.column;
  for (const [name, {row, value, channel}] of probeCells) {
    const values = shown.all.get(name);
    value.textContent = values ? valueText(channel, values[at]) : '...';
    value.className = values && isNone(channel, values[at]) ? 'none' : 'number';
    row.classList.toggle('shown', channel === shown.channel);
  }
  const {channel} = shown, value = shown.values[at], words = valueText(channel, value);
  const said = isNone(channel, value) || isNumbered(channel) ? words : withUnit(words, channel.unit);
  const place = `column ${shown.column * step}, row ${shown.row * step}: ${said}${shown.held ? ' (held)' : ''}`;
  document.getElementById('probe-place').textContent = place;
}
views.push(fillProbe);
