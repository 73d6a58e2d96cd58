// Points in space, drawn into an image with a depth buffer: no WebGL, which is slow or absent where there is no GPU.

// Where the pixels' points lie in the world, three numbers each; NaN where there is no distance.
function worldPoints(frame, distances) {
  const rays = raysFor(frame), points = new Float32Array(rays.length), m = frame.entry.camera.world_from_camera;
  for (let i = 0, at = 0; i < distances.length; ++i, at += 3) {
    const x = distances[i] * rays[at], y = distances[i] * rays[at + 1], z = distances[i] * rays[at + 2];
    for (let k = 0; k < 3; ++k) points[at + k] = m[k][0] * x + m[k][1] * y + m[k][2] * z + m[k][3];
  }
  return points;
}

// The middle of the points, coordinate by coordinate, and how far the outer ones are from it.
function extentOf(points) {
  const every = 3 * Math.max(1, Math.floor(points.length / 3 / 20000));
  const sorted = [[], [], []];
  for (let i = 0; i < points.length; i += every)
    if (Number.isFinite(points[i])) for (let k = 0; k < 3; ++k) sorted[k].push(points[i + k]);
  if (sorted[0].length === 0) return {middle: [0, 0, 0], size: 1};
  const at = (list, share) => list[Math.min(list.length - 1, Math.floor(share * list.length))];
  sorted.forEach(list => list.sort((a, b) => a - b));
  const sides = sorted.map(list => at(list, 0.99) - at(list, 0.01));
  const middle = sorted.map(list => (at(list, 0.01) + at(list, 0.99)) / 2);
  return {middle, size: Math.max(Math.hypot(...sides), 1e-6)};
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, factor) => a.map(value => value * factor);
const sum = (a, b) => a.map((value, i) => value + b[i]);
const unit = a => scaled(a, 1 / Math.hypot(...a));

// Right, up and towards the viewer, of a view from the angles `yaw` about the world's up axis and `pitch` above the
// horizon; at yaw 0 the viewer looks along -Z.
function viewAxes({yaw, pitch}) {
  const back = [Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)];
  const right = [Math.cos(yaw), 0, -Math.sin(yaw)];
  return {right, up: cross(back, right), back};
}

// Places in the picture of a view: [x, y, depth]. `eye` is how far the viewer is from the pivot, `focal` the focal
// length in parts of the picture's shorter side.
function projection(view, width, height) {
  const {right, up, back} = viewAxes(view), focal = view.focal * Math.min(width, height);
  return point => {
    const p = [point[0] - view.pivot[0], point[1] - view.pivot[1], point[2] - view.pivot[2]];
    const depth = view.eye - dot(back, p);
    return [width / 2 + focal * dot(right, p) / depth, height / 2 - focal * dot(up, p) / depth, depth];
  };
}

// An image of the points with a square of some pixels each, the nearest in front. `ids` gets the number of the point
// that is seen at a pixel, -1 for none. `spacing` is the angle from one pixel of the camera at `origin` to the next.
function drawPoints({image, ids, depths, points, view}, colours, spacing, origin) {
  const {width, height} = image, out = new Uint32Array(image.data.buffer);
  const {right: r, up: u, back: b} = viewAxes(view), [px, py, pz] = view.pivot, [ox, oy, oz] = origin;
  const focal = view.focal * Math.min(width, height), near = 1e-3 * view.eye;
  out.fill(0);
  ids.fill(-1);
  depths.fill(Infinity);
  for (let i = 0, at = 0; at < points.length; ++i, at += 3) {
    const x = points[at] - px, y = points[at + 1] - py, z = points[at + 2] - pz;
    const depth = view.eye - (b[0] * x + b[1] * y + b[2] * z);
    if (!(depth > near)) continue; // nor where there is no point
    const scale = focal / depth;
    const sx = width / 2 + scale * (r[0] * x + r[1] * y + r[2] * z);
    const sy = height / 2 - scale * (u[0] * x + u[1] * y + u[2] * z);
    if (!(sx > -8 && sy > -8 && sx < width + 8 && sy < height + 8)) continue;
    // From the sensor, by the sum of the coordinates, which is somewhat more: surfaces are seen from other sides.
    const far = Math.abs(points[at] - ox) + Math.abs(points[at + 1] - oy) + Math.abs(points[at + 2] - oz);
    const side = Math.min(9, Math.max(1, Math.ceil(spacing * far * scale)));
    const left = Math.max(0, Math.round(sx - side / 2)), right = Math.min(width, Math.round(sx - side / 2) + side);
    const top = Math.max(0, Math.round(sy - side / 2)), bottom = Math.min(height, Math.round(sy - side / 2) + side);
    const colour = colours[i];
    for (let row = top; row < bottom; ++row)
      for (let pixel = row * width + left, end = row * width + right; pixel < end; ++pixel)
        if (depth < depths[pixel]) {
          depths[pixel] = depth;
          out[pixel] = colour;
          ids[pixel] = i;
        }
  }
}

// The focal length, in parts of the shorter side, with which all that the sensor sees fits the picture.
function focalOf(frame, width, height) {
  const rays = raysFor(frame), steepest = [1e-6, 1e-6];
  for (const at of [0, 3 * (frame.columns - 1), rays.length - 3 * frame.columns, rays.length - 3])
    for (const k of [0, 1])
      steepest[k] = Math.max(steepest[k], Math.min(4, Math.abs(rays[at + k]) / Math.max(1e-3, rays[at + 2])));
  return 0.49 * Math.min(width / steepest[0], height / steepest[1]) / Math.min(width, height);
}

// The corners of what the sensor sees, at a distance of so many metres, in the world.
function cornersOfView(frame, distance) {
  const rays = raysFor(frame), last = frame.columns * frame.rows - 1, m = frame.entry.camera.world_from_camera;
  return [0, frame.columns - 1, last, last - frame.columns + 1].map(pixel => {
    const ray = rays.subarray(3 * pixel, 3 * pixel + 3);
    return [0, 1, 2].map(k => m[k][3] + distance * dot(m[k], ray));
  });
}
