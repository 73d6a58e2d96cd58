// Where pixels look: the camera of the manifest, which is OpenCV's, turned round. docs/outputs.md has the formulas.

// Whether the frame has one: anyone may have edited its manifest.
function hasCamera(frame) {
  const {camera} = frame.entry;
  const areNumbers = (list, count) => Array.isArray(list) && list.length >= count && list.every(Number.isFinite);
  const isMatrix = (rows, columns) =>
    Array.isArray(rows) && rows.length >= 3 && rows.every(row => areNumbers(row, columns));
  return camera && isMatrix(camera.camera_matrix, 3) && isMatrix(camera.world_from_camera, 4) &&
    areNumbers(camera.distortion, 4);
}

function inverse3(m) {
  const minor = (a, b, c, d) => m[a][b] * m[c][d] - m[a][d] * m[c][b];
  const columns = [[minor(1, 1, 2, 2), -minor(0, 1, 2, 2), minor(0, 1, 1, 2)],
                   [-minor(1, 0, 2, 2), minor(0, 0, 2, 2), -minor(0, 0, 1, 2)],
                   [minor(1, 0, 2, 1), -minor(0, 0, 2, 1), minor(0, 0, 1, 1)]];
  const determinant = m[0][0] * columns[0][0] + m[0][1] * columns[1][0] + m[0][2] * columns[2][0];
  return columns.map(row => row.map(value => value / determinant));
}

const times = (m, v) => m.map(row => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
const product = (a, b) => a.map(row => [0, 1, 2].map(k => row[0] * b[0][k] + row[1] * b[1][k] + row[2] * b[2][k]));

// OpenCV's tilted sensor, from the plane across the axis to the tilted one.
function tiltMatrix([x, y]) {
  const aboutX = [[1, 0, 0], [0, Math.cos(x), Math.sin(x)], [0, -Math.sin(x), Math.cos(x)]];
  const aboutY = [[Math.cos(y), 0, -Math.sin(y)], [0, 1, 0], [Math.sin(y), 0, Math.cos(y)]];
  const r = product(aboutY, aboutX);
  return product([[r[2][2], 0, -r[0][2]], [0, r[2][2], -r[1][2]], [0, 0, 1]], r);
}

// Slopes without Brown's distortion, by fixed-point steps as cv::undistortPoints takes them.
function undistorted([k1, k2, p1, p2, k3], x0, y0) {
  let x = x0, y = y0;
  for (let i = 0; i < 100; ++i) {
    const r2 = x * x + y * y, radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const nextX = (x0 - 2 * p1 * x * y - p2 * (r2 + 2 * x * x)) / radial;
    const nextY = (y0 - p1 * (r2 + 2 * y * y) - 2 * p2 * x * y) / radial;
    const moved = Math.abs(nextX - x) + Math.abs(nextY - y);
    x = nextX;
    y = nextY;
    if (!(moved > 1e-10)) break;
  }
  return [x, y];
}

// The angle to the axis of a fisheye's ray at the distance `r` from its middle, by Newton's steps.
function fisheyeAngle([k1, k2, k3, k4], r) {
  let angle = Math.min(r, Math.PI / 2);
  for (let i = 0; i < 50; ++i) {
    const a2 = angle * angle;
    const value = angle * (1 + a2 * (k1 + a2 * (k2 + a2 * (k3 + a2 * k4)))) - r;
    const slope = 1 + a2 * (3 * k1 + a2 * (5 * k2 + a2 * (7 * k3 + a2 * 9 * k4)));
    const moved = value / slope;
    angle -= moved;
    if (!(Math.abs(moved) > 1e-12)) break;
  }
  return angle;
}

function rayOf(camera, fromPixel, tilt, column, row) {
  let [x, y, w] = times(fromPixel, [column, row, 1]);
  if (tilt) [x, y, w] = times(tilt, [x / w, y / w, 1]);
  x /= w;
  y /= w;
  if (camera.model === 'fisheye') {
    const r = Math.hypot(x, y), angle = fisheyeAngle(camera.distortion, r);
    const side = r > 0 ? Math.sin(angle) / r : 1;
    return [side * x, side * y, Math.cos(angle)];
  }
  if (camera.model === 'brown') [x, y] = undistorted(camera.distortion, x, y);
  const length = Math.hypot(x, y, 1);
  return [x / length, y / length, 1 / length];
}

// Unit vectors in the camera's frame (x right, y down, z forward), three numbers for each pixel that is here.
function raysOf(frame) {
  const {camera} = frame.entry, rays = new Float32Array(3 * frame.columns * frame.rows);
  const fromPixel = inverse3(camera.camera_matrix);
  const angles = camera.tilt_rad ?? (camera.distortion.length === 14 ? camera.distortion.slice(12) : null);
  const tilt = angles ? inverse3(tiltMatrix(angles)) : null;
  for (let row = 0, at = 0; row < frame.rows; ++row)
    for (let column = 0; column < frame.columns; ++column, at += 3)
      rays.set(rayOf(camera, fromPixel, tilt, column * step, row * step), at);
  return rays;
}

// The rays of cameras that differ in their places only are the same.
const raysMade = new Map();
function raysFor(frame) {
  const {world_from_camera, ...camera} = frame.entry.camera;
  const key = JSON.stringify([camera, frame.columns, frame.rows]);
  if (!raysMade.has(key)) {
    raysMade.clear();
    raysMade.set(key, raysOf(frame));
  }
  return raysMade.get(key);
}
