// The view of the points: the mouse and keys that turn it, and what is drawn on top.

const cloudCanvas = document.getElementById('cloud'), cloudChooser = document.getElementById('cloud-distance');
const cloudImage = document.createElement('canvas');
const cloudHeight = 520;
const cloud = {
  view: null, points: null, key: '', ids: null, depths: null, image: null,
  extent: {middle: [0, 0, 0], size: 1}, sharp: 1, drag: null,
};

const originOf = frame => [0, 1, 2].map(k => frame.entry.camera.world_from_camera[k][3]);
const forwardOf = frame => [0, 1, 2].map(k => frame.entry.camera.world_from_camera[k][2]);

// Distances along the pixels' rays: those that were measured, and the true one.
const isDistance = channel => !isInteger(channel) && /(^|_)distance_m($|_)|^range_m$/.test(channel.quantity);
const distancesOf = frame => frame.channels.filter(channel =>
  hasCamera(frame) && isDistance(channel) && (channel.frequency === null || channel.frequency === shown.frequency));

function fillCloudChooser() {
  const list = distancesOf(shown.frame), before = cloudChooser.value;
  const key = list.map(channel => channel.name).join();
  if (cloudChooser.dataset.key === key) return;
  cloudChooser.dataset.key = key;
  cloudChooser.replaceChildren(...list.map(channel => new Option(channel.title, channel.name)));
  const unwrapped = list.find(channel => channel.quantity === 'unwrapped_distance_m');
  if (list.some(channel => channel.name === before)) cloudChooser.value = before;
  else if (unwrapped) cloudChooser.value = unwrapped.name;
}

// The angles from which a direction looks: `back` points from what is seen to the viewer.
const anglesOf = back => ({yaw: Math.atan2(back[0], back[2]), pitch: Math.asin(Math.max(-1, Math.min(1, back[1])))});

function setView(name) {
  const {middle, size} = cloud.extent, origin = originOf(shown.frame);
  const eye = size * 1.45;
  if (name === 'sensor') {
    const towards = sum(origin, scaled(middle, -1)), forward = forwardOf(shown.frame);
    const away = Math.max(1e-3 * size, -dot(towards, forward));
    const focal = focalOf(shown.frame, cloudCanvas.clientWidth, cloudHeight);
    const pivot = sum(origin, scaled(forward, away));
    cloud.view = {pivot, eye: away, focal, ...anglesOf(scaled(forward, -1))};
  } else {
    const back = anglesOf(unit(scaled(forwardOf(shown.frame), -1)));
    const beside = {yaw: back.yaw + 0.6, pitch: Math.max(-1.5, Math.min(1.5, back.pitch + 0.35))};
    cloud.view = {pivot: [...middle], eye, focal: 1.6, ...(name === 'above' ? {yaw: back.yaw, pitch: 1.5} : beside)};
  }
  redraw('cloud');
}

// Makes the points anew where the frame or the distance is another. False where there are none yet.
function makePoints() {
  const distances = shown.all.get(cloudChooser.value);
  if (!distances) return false;
  const key = `${shown.sensor.name}\n${shown.frame.frame}\n${cloudChooser.value}`;
  if (cloud.key === key) return true;
  cloud.points = worldPoints(shown.frame, distances);
  cloud.extent = extentOf(cloud.points);
  cloud.key = key;
  if (cloud.sensor !== shown.sensor) {
    cloud.sensor = shown.sensor;
    setView('beside');
  }
  return true;
}

function makeImage(width, height) {
  if (cloud.image?.width === width && cloud.image.height === height) return;
  cloudImage.width = width;
  cloudImage.height = height;
  cloud.image = new ImageData(width, height);
  cloud.ids = new Int32Array(width * height);
  cloud.depths = new Float32Array(width * height);
}

function drawSensor(context, project, colours) {
  const origin = originOf(shown.frame), eye = project(origin);
  const corners = cornersOfView(shown.frame, 0.12 * cloud.extent.size).map(project);
  if (!(eye[2] > 0.02 * cloud.view.eye) || corners.some(corner => !(corner[2] > 0.02 * cloud.view.eye))) return;
  corners.forEach((corner, i) => {
    const next = corners[(i + 1) % 4];
    line(context, eye[0], eye[1], corner[0], corner[1], colours.accent, 1.2);
    line(context, corner[0], corner[1], next[0], next[1], colours.accent, 1.2);
  });
  text(context, shown.sensor.name, eye[0] + 6, eye[1] - 8, colours.accent);
}

function drawAxes(context, width, height, colours) {
  const {right, up} = viewAxes(cloud.view), x0 = width - 44, y0 = height - 40;
  [['x', '#d6453d'], ['y', '#3a9a46'], ['z', '#3b74d8']].forEach(([name, colour], k) => {
    const x = x0 + 26 * right[k], y = y0 - 26 * up[k];
    line(context, x0, y0, x, y, colour, 2);
    text(context, name, x0 + 34 * right[k], y0 - 34 * up[k], colours.quiet, 'center');
  });
}

function drawMark(context, project, colours) {
  const at = 3 * (shown.row * shown.frame.columns + shown.column);
  const point = cloud.points.subarray(at, at + 3);
  const [x, y, depth] = project(point);
  if (!(depth > 0) || !Number.isFinite(x)) return;
  for (const [colour, width] of [['#fff', 4], [colours.mark, 2]]) {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    context.arc(x, y, 6, 0, 2 * Math.PI);
    context.stroke();
  }
  const say = value => numberText(value, 5);
  const words = `x ${say(point[0])}, y ${say(point[1])}, z ${say(point[2])} m`;
  context.fillStyle = colours.card;
  context.fillRect(8, 6, context.measureText(words).width + 12, 22);
  text(context, words, 14, 17, colours.ink);
}

function drawCloud(changed) {
  fillCloudChooser();
  const hasPoints = makePoints();
  const context = cleared(cloudCanvas, cloudHeight), colours = palette(), width = cloudCanvas.clientWidth;
  if (!hasPoints) {
    const words = cloudChooser.value ? 'The distances are being unpacked ...' : 'This frame has no distances here.';
    text(context, words, width / 2, cloudHeight / 2, colours.quiet, 'center');
    return;
  }
  cloud.sharp = Math.min(1.5, window.devicePixelRatio || 1);
  makeImage(Math.round(width * cloud.sharp), Math.round(cloudHeight * cloud.sharp));
  const matrix = shown.frame.entry.camera.camera_matrix;
  const spacing = step / Math.max(1e-9, Math.hypot(matrix[0][0], matrix[1][0]));
  if (changed.size > 1 || !changed.has('pixel') || cloud.drawn !== cloud.key)
    drawPoints(cloud, shown.pixels, spacing, originOf(shown.frame));
  cloud.drawn = cloud.key;
  cloudImage.getContext('2d').putImageData(cloud.image, 0, 0);
  context.drawImage(cloudImage, 0, 0, width, cloudHeight);
  const project = projection(cloud.view, width, cloudHeight);
  drawSensor(context, project, colours);
  drawAxes(context, width, cloudHeight, colours);
  drawMark(context, project, colours);
}
views.push(drawCloud);

function turn(right, down) {
  cloud.view.yaw -= right;
  cloud.view.pitch = Math.max(-1.55, Math.min(1.55, cloud.view.pitch + down));
  redraw('cloud');
}

// By pixels of the picture at the pivot.
function move(right, down) {
  const axes = viewAxes(cloud.view), pixels = Math.min(cloudCanvas.clientWidth, cloudHeight);
  const metres = cloud.view.eye / (cloud.view.focal * pixels);
  cloud.view.pivot = sum(cloud.view.pivot, sum(scaled(axes.right, -right * metres), scaled(axes.up, down * metres)));
  redraw('cloud');
}

function zoom(factor) {
  cloud.view.eye = Math.max(1e-3 * cloud.extent.size, Math.min(20 * cloud.extent.size, cloud.view.eye * factor));
  redraw('cloud');
}

// The pixel of the point below the mouse, or of one close to it.
function lookBelow(event) {
  const {width, height} = cloud.image;
  const [x, y] = [event.offsetX, event.offsetY].map(place => Math.round(place * cloud.sharp));
  for (let reach = 0; reach <= 4; ++reach)
    for (let dy = -reach; dy <= reach; ++dy)
      for (let dx = -reach; dx <= reach; ++dx) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= width || y + dy >= height) continue;
        const id = cloud.ids[(y + dy) * width + x + dx];
        if (id >= 0) return look(id % shown.frame.columns, Math.floor(id / shown.frame.columns));
      }
}

cloudCanvas.addEventListener('pointerdown', event => {
  if (!cloud.view) return;
  cloud.drag = [event.clientX, event.clientY];
  cloudCanvas.setPointerCapture(event.pointerId);
});
cloudCanvas.addEventListener('pointermove', event => {
  if (cloud.drag) {
    const [right, down] = [event.clientX - cloud.drag[0], event.clientY - cloud.drag[1]];
    cloud.drag = [event.clientX, event.clientY];
    if (event.shiftKey || event.buttons === 2) move(right, down);
    else turn(right * 0.008, down * 0.008);
  } else if (cloud.image && !shown.held) {
    lookBelow(event);
  }
});
for (const end of ['pointerup', 'pointercancel']) cloudCanvas.addEventListener(end, () => { cloud.drag = null; });
cloudCanvas.addEventListener('contextmenu', event => event.preventDefault());
cloudCanvas.addEventListener('wheel', event => {
  if (!cloud.view || document.activeElement !== cloudCanvas) return; // the page scrolls
  event.preventDefault();
  zoom(Math.exp(0.0015 * event.deltaY));
}, {passive: false});

const turning = 0.1, moving = 30;
cloudCanvas.addEventListener('keydown', event => {
  if (!cloud.view || event.ctrlKey || event.altKey || event.metaKey) return;
  const arrow = arrows[event.key];
  if (arrow && event.shiftKey) move(-moving * arrow[0], -moving * arrow[1]);
  else if (arrow) turn(turning * arrow[0], turning * arrow[1]);
  else if (event.key === '+' || event.key === '=') zoom(0.85);
  else if (event.key === '-') zoom(1 / 0.85);
  else if (event.key === 'Home') setView('beside');
  else return;
  event.preventDefault();
});
for (const button of document.querySelectorAll('[data-view]'))
  button.addEventListener('click', () => { if (cloud.points) setView(button.dataset.view); });
cloudChooser.addEventListener('change', () => redraw('cloud'));
