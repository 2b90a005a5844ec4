// A camera behind the aircraft. It is a function of the flight alone: the same tick gives the same picture.
// Where it is: behind and above the aircraft [m], aimed so far ahead [m]; ticks over which it follows; its share of the bank.
const CHASE = { behind: 4.6, above: 1.7, ahead: 12, lag: 40, roll: 0.3 };
const NEAREST = 0.3;

function mean(flight, tick, ticks, of) {
  const count = 5;
  let sum = 0;
  for (let at = 0; at < count; at++) sum += of(stateAt(flight, Math.max(0, tick - ticks * at / (count - 1))));
  return sum / count;
}

// Course over ground [rad].
function courseAt(flight, tick) {
  const [x, y] = stateAt(flight, tick).at, [x0, y0] = stateAt(flight, Math.max(0, tick - CHASE.lag)).at;
  return Math.hypot(x - x0, y - y0) < 1 ? 0 : Math.atan2(y - y0, x - x0);
}

// `put` gives pixels and depth of a place, `depth` its depth alone. `flat` is the horizontal direction of sight.
function cameraAt(flight, tick, width, height, around = 0) {
  const { at } = stateAt(flight, tick), course = courseAt(flight, tick) + around;
  const level = mean(flight, tick, CHASE.lag, state => state.at[2]), roll = CHASE.roll * mean(flight, tick, 15, state => state.bank);
  const cos = Math.cos(course), sin = Math.sin(course);
  const eye = [at[0] - CHASE.behind * cos, at[1] - CHASE.behind * sin, Math.max(0.5, 0.5 * (level + at[2]) + CHASE.above)];
  const pitch = Math.atan2(at[2] - eye[2], CHASE.ahead);
  const up = [-Math.sin(pitch) * cos, -Math.sin(pitch) * sin, Math.cos(pitch)], side = [-sin, cos, 0];
  const f = [Math.cos(pitch) * cos, Math.cos(pitch) * sin, Math.sin(pitch)], [cr, sr] = [Math.cos(roll), Math.sin(roll)];
  const r = side.map((part, i) => part * cr - up[i] * sr), u = up.map((part, i) => part * cr + side[i] * sr);
  // 62 degrees over the height of a wide picture, as much over the width of a tall one.
  const focus = Math.max(height, Math.min(width, 1.3 * height)) / 2 / Math.tan(31 * Math.PI / 180);
  const depth = (x, y, z) => (x - eye[0]) * f[0] + (y - eye[1]) * f[1] + (z - eye[2]) * f[2];
  const put = (x, y, z) => {
    const a = x - eye[0], b = y - eye[1], c = z - eye[2], d = Math.max(NEAREST, a * f[0] + b * f[1] + c * f[2]);
    return [width / 2 + focus * (a * r[0] + b * r[1] + c * r[2]) / d, height / 2 - focus * (a * u[0] + b * u[1] + c * u[2]) / d, d];
  };
  // The place on the ground under a pixel, at most `most` away; beyond it, that far in this direction.
  const ground = (px, py, most) => {
    const a = (px - width / 2) / focus, b = (height / 2 - py) / focus, ray = f.map((part, i) => part + a * r[i] + b * u[i]);
    const way = Math.hypot(ray[0], ray[1]), reach = ray[2] < 0 ? Math.min(most, eye[2] / -ray[2] * way) : most;
    return [eye[0] + ray[0] / way * reach, eye[1] + ray[1] / way * reach];
  };
  return { eye, f, r, u, roll, focus, width, height, put, depth, ground, sun: Math.cos(course - SUN) };
}
