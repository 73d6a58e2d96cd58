// The picture with its profiles, and the mouse and keys that choose the pixel.

const pictureCanvas = document.getElementById('picture');
let pictureBox = {x: 0, y: 0, width: 1, height: 1};

// Boxes of picture, row profile, column profile and colour bar on a canvas of that width.
function boxesOf(width) {
  const {columns, rows} = shown.frame;
  const left = 52, profile = Math.min(110, width * 0.16), bar = 16, gap = 14, legend = 62, below = 104;
  const most = Math.max(120, width - left - gap - profile - gap - 10 - bar - legend);
  const scale = Math.min(most / columns, 470 / rows);
  const image = {x: left, y: 24, width: Math.round(columns * scale), height: Math.round(rows * scale)};
  const beside = image.x + image.width + gap;
  const rowProfile = {x: left, y: image.y + image.height + gap, width: image.width, height: below};
  return {
    image, rowProfile,
    columnProfile: {x: beside, y: image.y, width: profile, height: image.height},
    bar: {x: beside + profile + gap + 10, y: image.y, width: bar, height: image.height},
    none: {x: beside, y: rowProfile.y + below - 16},
    height: rowProfile.y + below + 26,
  };
}

function drawPictureView(changed) {
  if (!changed.has('values') && !changed.has('pixel')) return;
  if (changed.has('values')) refreshPicture();
  const {height} = boxesOf(Math.max(200, pictureCanvas.clientWidth));
  const context = cleared(pictureCanvas, height), colours = palette();
  const boxes = boxesOf(Math.max(200, pictureCanvas.clientWidth));
  pictureBox = boxes.image;
  drawPicture(context, boxes.image, colours);
  drawRowProfile(context, boxes.rowProfile, colours);
  drawColumnProfile(context, boxes.columnProfile, colours);
  if (isNumbered(shown.channel))
    drawColourNames(context, {...boxes.bar, x: boxes.bar.x - 8, width: 90}, colours);
  else
    drawColourBar(context, boxes.bar, colours);
  drawNoneName(context, boxes.none, colours);
  drawCross(context, boxes.image, colours);
}
views.push(drawPictureView);

function titleOf(channel) {
  const frequency = channel.frequency === null ? '' : ` at ${frequencyOf(channel)}`;
  return `${channel.title[0].toUpperCase()}${channel.title.slice(1)}${frequency}`;
}

function writePictureWords(changed) {
  if (!changed.has('values')) return;
  const {channel, frame} = shown;
  const title = `${titleOf(channel)}, ${shown.sensor.name}, frame ${frame.frame}`;
  document.getElementById('picture-title').textContent = title;
  document.getElementById('about').textContent = `${channel.name}: ${channel.about || 'a channel of the files'}`;
  pictureCanvas.setAttribute('aria-label', `Picture of ${titleOf(channel)}, ${frame.columns} x ${frame.rows} pixels`);
  document.getElementById('statistics').textContent = statisticsText();
}

function statisticsText() {
  const {channel, values} = shown;
  if (isNumbered(channel)) return `${frequentNumbers(values).length} different numbers`;
  const of = statisticsOf(values), say = value => withUnit(numberText(value, 5), channel.unit);
  const none = of.none > 0 ? `; ${of.none} of ${values.length} pixels: ${channel.none}` : '';
  if (of.count === 0) return `No pixel has a value: ${channel.none}`;
  const rms = shown.scale === 'zero_centred' ? `, rms ${say(of.rms)}` : '';
  const ends = `least ${say(of.least)}, median ${say(of.median)}, mean ${say(of.mean)}, greatest ${say(of.greatest)}`;
  return `${ends}${rms}${none}`;
}
views.push(writePictureWords);

function pixelAt(event) {
  const x = (event.offsetX - pictureBox.x) / pictureBox.width, y = (event.offsetY - pictureBox.y) / pictureBox.height;
  if (x < 0 || x >= 1 || y < 0 || y >= 1) return null;
  return [Math.floor(x * shown.frame.columns), Math.floor(y * shown.frame.rows)];
}

pictureCanvas.addEventListener('pointermove', event => {
  const pixel = pixelAt(event);
  if (pixel && !shown.held) look(...pixel);
});
pictureCanvas.addEventListener('click', event => {
  const pixel = pixelAt(event);
  if (!pixel) return;
  shown.held = !shown.held;
  look(...pixel);
  redraw('pixel');
});

const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
pictureCanvas.addEventListener('keydown', event => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const arrow = arrows[event.key], far = event.shiftKey ? 10 : 1;
  if (arrow) look(shown.column + far * arrow[0], shown.row + far * arrow[1]);
  else if (event.key === 'Home') look(shown.frame.columns >> 1, shown.frame.rows >> 1);
  else if (event.key === 'Escape') shown.held = false;
  else return;
  if (arrow || event.key === 'Home') shown.held = true;
  event.preventDefault();
});
