// The scene behind the aircraft, on a plain canvas: whole things are sorted by their depth and painted from far to near.
// Farthest trunk that is drawn, where haze begins, and over how many metres it closes [m].
const FAR = 95, HAZE = [10, 82], SHADES = 32;
// Columns of the picture of which it is known whether a trunk hides all that is behind, and how many of them a hidden trunk may still show.
const COLUMNS = 4096, SLIVER = 3;
// How deep a slice of lidar returns is [m].
const SLICE = 0.5;
// Direction to the sun [rad, from ahead to the right], the length of a shadow as a share of the height [-], and how much of a trunk's is
// drawn [m].
const SUN = 2.9, SHADE = 2.4, SHADOW = 9;
const SUNWARDS = [0.6 * Math.cos(SUN), 0.6 * Math.sin(SUN), 0.8];
// Half the width from which a trunk has two tones and a foot, and three tones [pixels]: a strip costs as much as it is long.
const TONES = [4, 8];
// Height up to which trunks are drawn, and where crowns begin [m]. In the simulation they have no end. Crowns beyond `FINE` [m] are of one
// piece, and those of hidden trunks are left out.
const TOP = 23, CROWN = 19, FINE = 35;
const EARTH = ["sky", "haze", "earth", "bark", "bark-dark", "pale", "pale-dark", "crown", "crown-pale", "wing", "wing-dark", "placed", "bad",
  "plan", "candidate", "flown"];
const paint = {};

const channels = text => [1, 3, 5].map(at => parseInt(text.slice(at, at + 2), 16));
const mixed = (a, b, share) => `rgb(${a.map((part, i) => Math.round(part + share * (b[i] - part))).join()})`;

// Shades of each colour from near to far.
function readPaint() {
  const style = getComputedStyle(document.documentElement), hex = name => channels(style.getPropertyValue("--" + name).trim());
  const haze = hex("haze");
  for (const name of EARTH) paint[name] = Array.from({ length: SHADES + 1 }, (_, i) => mixed(hex(name), haze, i / SHADES));
}

const shadeOf = depth => Math.max(0, Math.min(SHADES, Math.round((depth - HAZE[0]) / HAZE[1] * SHADES)));

// The aircraft in spans: ahead, right, down. A fuselage of rings, surfaces of quads.
const AIRCRAFT = (() => {
  const faces = [], rings = [[0.4, 0.018], [0.34, 0.045], [0.1, 0.055], [-0.12, 0.04], [-0.4, 0.012]], sides = 6;
  const ring = ([x, r]) => Array.from({ length: sides }, (_, i) => [x, r * Math.cos(i * 2 * Math.PI / sides), r * Math.sin(i * 2 * Math.PI / sides)]);
  for (let at = 0; at + 1 < rings.length; at++) {
    const [a, b] = [ring(rings[at]), ring(rings[at + 1])];
    for (let i = 0; i < sides; i++) faces.push(["wing", [a[i], a[(i + 1) % sides], b[(i + 1) % sides], b[i]]]);
  }
  for (const s of [1, -1]) {
    faces.push(["wing", [[0.15, 0, -0.06], [0.135, s * 0.36, -0.08], [-0.06, s * 0.36, -0.08], [-0.07, 0, -0.06]]]);
    faces.push(["tip", [[0.135, s * 0.36, -0.08], [0.1, s * 0.5, -0.09], [-0.03, s * 0.5, -0.09], [-0.06, s * 0.36, -0.08]]]);
    faces.push(["wing", [[-0.3, 0, -0.01], [-0.33, s * 0.17, -0.01], [-0.41, s * 0.17, -0.01], [-0.42, 0, -0.01]]]);
  }
  faces.push(["tip", [[-0.29, 0, -0.02], [-0.37, 0, -0.14], [-0.43, 0, -0.14], [-0.42, 0, -0.02]]]);
  return faces;
})();
// Its outline from above, for the shadow and the map.
const OUTLINE = [[0.4, 0], [0.34, 0.04], [0.15, 0.05], [0.1, 0.5], [-0.03, 0.5], [-0.07, 0.05], [-0.3, 0.03], [-0.33, 0.17], [-0.41, 0.17], [-0.42, 0]];
const BOTH = [...OUTLINE, ...OUTLINE.map(([a, b]) => [a, -b]).reverse()];

function fillPath(pen, points, style) {
  pen.fillStyle = style;
  pen.beginPath();
  points.forEach(([u, v], i) => i ? pen.lineTo(u, v) : pen.moveTo(u, v));
  pen.fill();
}

function drawGround(pen, camera) {
  const { width, height, put, f, eye, roll } = camera, flat = Math.hypot(f[0], f[1]);
  const [, v] = put(eye[0] + f[0] / flat * 1e4, eye[1] + f[1] / flat * 1e4, eye[2]), size = width + height;
  pen.save();
  pen.translate(width / 2, v);
  pen.rotate(-roll);
  const sky = pen.createLinearGradient(0, -0.6 * height, 0, 0), earth = pen.createLinearGradient(0, 0, 0, 0.3 * height);
  sky.addColorStop(0, paint.sky[0]); sky.addColorStop(1, paint.haze[0]);
  earth.addColorStop(0, paint.haze[0]); earth.addColorStop(0.25, paint.earth[SHADES / 2]); earth.addColorStop(1, paint.earth[0]);
  pen.fillStyle = sky; pen.fillRect(-size, -size, 2 * size, size);
  // One colour costs less than a gradient.
  pen.fillStyle = paint.earth[0]; pen.fillRect(-size, 0.29 * height, 2 * size, size);
  pen.fillStyle = earth; pen.fillRect(-size, 0, 2 * size, 0.3 * height);
  pen.restore();
}

// Squares of 10 m, and tufts between them that tell of the speed.
function drawGrid(pen, { eye, depth, put }) {
  const step = 10, reach = 70, [x0, y0] = [0, 1].map(axis => Math.floor(eye[axis] / step) * step);
  pen.strokeStyle = colour.faint; pen.fillStyle = colour.faint; pen.lineWidth = 1;
  for (const [least, most, alpha] of [[0.5, 25, 0.3], [25, 45, 0.18], [45, 70, 0.09]]) {
    pen.globalAlpha = alpha;
    pen.beginPath();
    for (let a = -reach; a <= reach; a += step) for (const [xa, ya, xb, yb] of [[a, -reach, a, reach], [-reach, a, reach, a]]) {
      const [p, q, s, t] = [x0 + xa, y0 + ya, x0 + xb, y0 + yb], first = depth(p, q, 0), rise = depth(s, t, 0) - first;
      const [from, to] = [least, most].map(away => Math.max(0, Math.min(1, (away - first) / rise)));
      if (from === to) continue;
      pen.moveTo(...put(p + from * (s - p), q + from * (t - q), 0)); pen.lineTo(...put(p + to * (s - p), q + to * (t - q), 0));
    }
    pen.stroke();
  }
  pen.globalAlpha = 0.5;
  for (let column = -10; column < 11; column++) for (let row = -10; row < 11; row++) {
    const [i, j] = [Math.round(eye[0] / 3) + column, Math.round(eye[1] / 3) + row], chance = Math.abs(Math.sin(i * 12.9898 + j * 78.233) * 43758.5453) % 1;
    const [x, y] = [3 * i + 3 * chance, 3 * j + 3 * (chance * 7 % 1)], away = depth(x, y, 0);
    if (away < 1 || away > 30) continue;
    const [u, v, d] = put(x, y, 0), size = 40 / d;
    pen.fillRect(u - size / 2, v - size / 4, size, size / 2);
  }
  pen.globalAlpha = 1;
}

// Ground that is not level, in squares: each as bright as the sun stands above it.
function drawTerrain(pen, items, heightAt, { eye, f, depth, put }) {
  const step = 5, [x0, y0] = [0, 1].map(axis => Math.floor(eye[axis] / step) * step);
  for (let a = -FAR; a < FAR; a += step) for (let b = -FAR; b < FAR; b += step) {
    if (a * f[0] + b * f[1] < -2 * step || Math.hypot(a, b) > FAR) continue;
    const places = [[0, 0], [step, 0], [step, step], [0, step]].map(([p, q]) => [x0 + a + p, y0 + b + q, heightAt(x0 + a + p, y0 + b + q)]);
    if (places.some(place => depth(...place) < 0.5)) continue;
    const [p, q, , r] = places, normal = [(p[2] - q[2]) / step, (p[2] - r[2]) / step, 1];
    const light = normal.reduce((sum, part, axis) => sum + part * SUNWARDS[axis], 0) / Math.hypot(...normal);
    const away = places.reduce((sum, place) => sum + depth(...place), 0) / 4, earth = channelsOf(paint.earth[shadeOf(away)]);
    items.push([away, () => {
      const style = mixed(earth, [0, 0, 0], Math.max(0, Math.min(0.6, 0.8 - light)));
      fillPath(pen, places.map(place => put(...place)), style);
      pen.strokeStyle = style; pen.lineWidth = 0.7; pen.stroke();
    }]);
  }
}

// Shadows of the trunks near by, all in one path.
function drawShadows(pen, trunks, { depth, put, focus }) {
  const [x, y] = [-Math.cos(SUN) * SHADOW, -Math.sin(SUN) * SHADOW];
  pen.globalAlpha = 0.22; pen.fillStyle = "#000";
  pen.beginPath();
  for (const { trunk: t } of trunks) {
    if (depth(t.x, t.y, 0) < 1 || depth(t.x + x, t.y + y, 0) < 1) continue;
    const [u, v, d] = put(t.x, t.y, 0), [u2, v2, d2] = put(t.x + x, t.y + y, 0), w = focus * t.r / d, w2 = focus * t.r / d2;
    if (d > 45) continue;
    pen.moveTo(u - w, v); pen.lineTo(u + w, v); pen.lineTo(u2 + w2, v2); pen.lineTo(u2 - w2, v2);
  }
  pen.fill();
  pen.globalAlpha = 1;
}

// The trunks in sight, each with its depth and its place to the right.
function inSight({ trunks }, tick, { eye, f, width, focus }, own) {
  const flat = Math.hypot(f[0], f[1]), seen = [], slope = 0.62 * width / focus;
  for (const trunk of trunks) {
    if (trunk.mine > tick) continue;
    const a = trunk.x - eye[0], b = trunk.y - eye[1], depth = (a * f[0] + b * f[1]) / flat, across = (b * f[0] - a * f[1]) / flat;
    if (depth > 0.5 && depth < FAR && Math.abs(across) < depth * slope + 4) seen.push({ depth, across, trunk });
  }
  return hide(seen, slope, own - 1);
}

// Marks the trunks that nearer ones hide from foot to top but for a pixel, of which only crowns are seen. In a dense forest most are. Trunks
// without an end hide, if they are no glass because they are nearer than `least`; a tilted picture draws them a little thinner than they are.
function hide(seen, slope, least) {
  const full = new Uint8Array(COLUMNS), column = (across, depth) => (across / depth / slope + 1) / 2 * COLUMNS;
  seen.sort((a, b) => a.depth - b.depth);
  for (const sight of seen) {
    const { depth, across, trunk: { r, top } } = sight, from = column(across - r, depth), to = column(across + r, depth);
    let open = from >= 0 && to <= COLUMNS ? 0 : COLUMNS;
    for (let at = Math.floor(from); open <= SLIVER && at < to; at++) open += 1 - full[at];
    sight.hidden = open <= SLIVER;
    if (depth > least && (top ?? TOP) >= TOP)
      full.fill(1, Math.max(0, Math.ceil(column(across - 0.9 * r, depth))), Math.max(0, Math.floor(column(across + 0.9 * r, depth))));
  }
  return seen;
}

function drawTrunk(pen, { trunk: { x, y, r, top, seen, mine, crown }, depth, hidden }, tick, camera, nearer, hit = false) {
  const { put, focus, f, eye, r: right } = camera, flat = (x - eye[0]) * f[0] + (y - eye[1]) * f[1], shade = shadeOf(depth);
  let low = 0, high = Math.min(top ?? Infinity, TOP + 3 * crown);
  // What is behind the picture has no place in it.
  const limit = eye[2] + (0.4 - flat) / (f[2] || -1e-6);
  if (f[2] < 0) high = Math.min(high, limit); else low = Math.max(low, limit);
  if (high <= low) return;
  const [u, v, d] = put(x, y, low), [u2, v2, d2] = put(x, y, high), w = focus * r / d, w2 = focus * r / d2;
  const known = seen !== null && seen <= tick, kind = known ? "bark" : "pale";
  // Between the camera and the aircraft it is glass.
  pen.globalAlpha = nearer ? 0.25 : 1;
  if (low === 0 && w > TONES[0] && !hidden) {
    pen.fillStyle = paint[kind + "-dark"][shade];
    pen.beginPath(); pen.ellipse(u, v, w * 1.5, w * 0.5, 0, 0, 7); pen.fill();
  }
  const strip = (a, b, style) => {
    pen.fillStyle = style; pen.beginPath();
    pen.moveTo(u + a * w, v); pen.lineTo(u + b * w, v); pen.lineTo(u2 + b * w2, v2); pen.lineTo(u2 + a * w2, v2);
    pen.fill();
  };
  const [sx, sy] = [Math.cos(SUN), Math.sin(SUN)], side = sx * right[0] + sy * right[1] > 0 ? 1 : -1;
  const edge = Math.max(-0.7, Math.min(0.8, sx * f[0] + sy * f[1]));
  const lit = hit ? "bad" : mine !== null ? "placed" : kind, pale = Math.min(SHADES, shade + 3);
  // The strips overlap a little, or their seams would show.
  if (w < TONES[0] && !hidden) strip(-1, 1, paint[lit][pale]);
  else if (!hidden) {
    strip(-side, side * (edge + 0.05), paint[kind + "-dark"][shade]);
    if (w > TONES[1]) strip(side * edge, side * (edge + 0.5), paint[lit][pale]);
    strip(side * (w > TONES[1] ? edge + 0.45 : edge), side, paint[lit][shade]);
  }
  if (high > CROWN && !(hidden && depth > FINE)) {
    pen.fillStyle = paint[known ? "crown" : "crown-pale"][shade];
    pen.beginPath();
    for (let part = 0; part < (depth < FINE ? 3 : 1); part++) {
      const [cu, cv, cd] = put(x + (crown - 0.5) * 2 + part - 1, y + (part === 1 ? 0.8 : -0.6), CROWN + 1.3 * part + 2 * crown), size = focus * (1.9 + crown - 0.3 * part) / cd;
      // Most crowns are above the picture.
      if (cv < -size || cu < -size || cu > camera.width + size) continue;
      pen.moveTo(cu + size, cv); pen.ellipse(cu, cv, size, size * 0.62, 0, 0, 7);
    }
    pen.fill();
  }
  pen.globalAlpha = 1;
}

// A body that is no trunk. Boxes are cut into tiles, which sort by their depth.
const TILE = 5;
function drawBody(pen, items, body, { eye, depth, put, focus }) {
  const { sphere, capsule } = body, corners = cornersOf(body), middle = [0, 1, 2].map(axis => (corners[0][axis] + corners[7][axis]) / 2), away = depth(...middle);
  const style = (kind, d) => paint[kind][shadeOf(d)];
  if (sphere || capsule) {
    const ends = sphere ? [sphere.centre] : [capsule.from, capsule.to], { radius } = sphere || capsule;
    if (ends.some(end => depth(...end) < radius + 0.5) || away > FAR) return;
    items.push([away, () => {
      const [[u, v, d], ...more] = ends.map(end => put(...end));
      if (more.length) { pen.lineCap = "round"; line(pen, [[u, v], more[0]], style("bark", away), Math.max(1, 2 * focus * radius / put(...middle)[2])); pen.lineCap = "butt"; return; }
      pen.fillStyle = style("bark", away); pen.beginPath(); pen.arc(u, v, focus * radius / d, 0, 7); pen.fill();
    }]);
    return;
  }
  const [least, most] = [corners[0], corners[7]];
  for (let axis = 0; axis < 3; axis++) {
    const at = eye[axis] < least[axis] ? least[axis] : eye[axis] > most[axis] ? most[axis] : null, [p, q] = [0, 1, 2].filter(other => other !== axis);
    if (at === null) continue;
    const steps = [p, q].map(side => Math.max(1, Math.ceil((most[side] - least[side]) / TILE))), kind = ["bark", "bark-dark", "pale"][axis];
    const edge = (side, i, of) => least[side] + (most[side] - least[side]) * i / of;
    for (let i = 0; i < steps[0]; i++) for (let j = 0; j < steps[1]; j++) {
      const tile = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(([a, b]) => { const place = []; place[axis] = at; place[p] = edge(p, a, steps[0]); place[q] = edge(q, b, steps[1]); return place; });
      const depths = tile.map(place => depth(...place)), d = depths.reduce((sum, part) => sum + part, 0) / 4;
      if (Math.min(...depths) < 0.5 || d > FAR) continue;
      items.push([d, () => { const fill = style(kind, d); fillPath(pen, tile.map(place => put(...place)), fill); pen.strokeStyle = fill; pen.lineWidth = 0.7; pen.stroke(); }]);
    }
  }
}

// The places of a path from a tick on, a quarter of its own apart: ahead, right, up, bank.
function placesOf(path, begins, tick) {
  const places = [], last = path.length - 1;
  for (let at = Math.max(0, (tick - begins) / 25); at <= last; at += 0.25) {
    const i = Math.min(last - 1, Math.floor(at)), t = at - i, [a, b, c, d] = [-1, 0, 1, 2].map(step => path[Math.max(0, Math.min(last, i + step))]);
    places.push([0, 1, 2, 3].map(k => b[k] + 0.5 * t * (c[k] - a[k] + t * (2 * a[k] - 5 * b[k] + 4 * c[k] - d[k] + t * (3 * (b[k] - c[k]) + d[k] - a[k])))));
  }
  return places;
}

// A ribbon as wide as `half` to both sides, banked as the wing will be, from a depth on. Thinner ones lie beneath broader ones.
function ribbon(pen, items, places, half, name, from, { depth, put }) {
  const edges = places.map(([x, y, z, bank], i) => {
    const [p, q] = [places[Math.max(0, i - 1)], places[Math.min(places.length - 1, i + 1)]], way = Math.hypot(q[0] - p[0], q[1] - p[1]) || 1;
    const side = [-(q[1] - p[1]) / way * Math.cos(bank), (q[0] - p[0]) / way * Math.cos(bank), -Math.sin(bank)];
    return [-half, half].map(width => [x, y, z].map((part, axis) => part + width * side[axis]));
  });
  for (let i = 0; i + 1 < edges.length; i++) {
    const [[a, b], next] = [edges[i], edges[i + 1]], away = depth(...places[i].slice(0, 3));
    if (away < from) continue;
    // It reaches a little beneath the next piece, or the seams would show.
    const [c, d] = next.map((place, side) => place.map((part, axis) => part + 0.4 * (part - edges[i][side][axis])));
    items.push([away + 0.1 / half, () => fillPath(pen, [a, b, d, c].map(place => put(...place)), paint[name][Math.round(0.6 * SHADES * i / edges.length)])]);
  }
}

function drawAircraft(pen, state, span, { put }) {
  const faces = AIRCRAFT.map(([kind, points]) => {
    const places = points.map(point => { const way = turned(state.attitude, point); return way.map((part, axis) => state.at[axis] + span * part); });
    const [a, b, c] = [0, 1, 3].map(i => places[i]), [p, q] = [b, c].map(other => other.map((part, axis) => part - a[axis]));
    const normal = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]], length = Math.hypot(...normal) || 1;
    const light = Math.abs(normal.reduce((sum, part, axis) => sum + part * SUNWARDS[axis], 0)) / length, pixels = places.map(place => put(...place));
    return { kind, light, pixels, depth: pixels.reduce((sum, [, , d]) => sum + d, 0) / pixels.length };
  });
  faces.sort((a, b) => b.depth - a.depth);
  const [bright, dark] = ["wing", "wing-dark"].map(name => channelsOf(paint[name][0])), tip = channels(colour.flown);
  for (const { kind, light, pixels } of faces) {
    const full = kind === "tip" ? tip : bright, style = mixed(full, kind === "tip" ? full.map(part => part * 0.6) : dark, 1 - light);
    fillPath(pen, pixels, style);
    pen.strokeStyle = style; pen.lineWidth = 0.7; pen.stroke();
  }
  const nose = turned(state.attitude, [0.41, 0, 0]).map((part, axis) => state.at[axis] + span * part);
  const disc = Array.from({ length: 16 }, (_, i) => turned(state.attitude, [0, 0.1 * Math.cos(i * Math.PI / 8), 0.1 * Math.sin(i * Math.PI / 8)])
    .map((part, axis) => nose[axis] + span * part)).map(place => put(...place));
  pen.globalAlpha = 0.15; fillPath(pen, disc, colour.text); pen.globalAlpha = 1;
}

const channelsOf = style => style.slice(4, -1).split(",").map(Number);

// The shadow on the ground, which shows the height.
function drawUnder(pen, state, span, { put, depth }) {
  const [x, y, z] = state.at, shape = BOTH.map(([a, b]) => {
    const way = turned(state.attitude, [a, b, 0]);
    return [x + span * way[0] - SHADE * z * Math.cos(SUN), y + span * way[1] - SHADE * z * Math.sin(SUN), 0];
  });
  if (shape.some(place => depth(...place) < 0.5)) return;
  pen.globalAlpha = 0.6; fillPath(pen, shape.map(place => put(...place)), "#000"); pen.globalAlpha = 1;
}

// Streaks behind the tips of the wing: the last quarter of a second.
function drawStreaks(pen, items, flight, tick, { put, depth }) {
  for (const tip of [0.5, -0.5]) for (let back = 0; back < 24; back += 3) {
    const ends = [back, back + 3].map(ticks => {
      const { at, attitude } = stateAt(flight, Math.max(0, tick - ticks)), way = turned(attitude, [-0.03, tip, -0.09]);
      return at.map((part, axis) => part + flight.span * way[axis]);
    });
    if (ends.some(place => depth(...place) < 0.6) || tick - back <= 3) continue;
    items.push([depth(...ends[1]), () => line(pen, ends.map(place => put(...place)), paint.flown[Math.round(SHADES * back / 24)], 1.2)]);
  }
}

// Where beams ended, in slices of equal depth: a slice is one path.
function drawHits(pen, items, hits, { width, height, put, focus }) {
  const slices = new Map();
  for (let at = 0; at < hits.length; at += 3) {
    const [u, v, d] = put(hits[at], hits[at + 1], hits[at + 2]), slice = Math.floor((d - 0.45) / SLICE);
    if (d < 1 || u < 0 || v < 0 || u > width || v > height) continue;
    if (!slices.has(slice)) slices.set(slice, []);
    slices.get(slice).push(u, v);
  }
  for (const [slice, places] of slices) items.push([slice * SLICE, () => {
    const size = Math.max(1.6, Math.min(4, 0.07 * focus / (slice * SLICE + 0.5)));
    pen.fillStyle = colour.scan; pen.beginPath();
    for (let at = 0; at < places.length; at += 2) pen.rect(places[at] - size / 2, places[at + 1] - size / 2, size, size);
    pen.fill();
  }]);
}

// Draws the scene. Returns the camera, which knows what is under a pixel.
function drawScene(flight, tick, look) {
  const [pen, width, height] = canvas("view", look.sharpest), state = stateAt(flight, tick), camera = cameraAt(flight, tick, width, height, look.around);
  const { depth, eye } = camera, own = depth(...state.at), trunks = inSight(flight, tick, camera, own);
  drawGround(pen, camera);
  if (!flight.heightAt) {
    drawGrid(pen, camera);
    drawShadows(pen, trunks, camera);
    drawUnder(pen, state, flight.span, camera);
  }
  const items = trunks.map(sight => [sight.depth, () => drawTrunk(pen, sight, tick, camera, sight.depth < own - 1, sight.trunk === flight.crash)]);
  const plan = newest(flight.cycles, tick, cycle => cycle.due), scan = newest(flight.cycles, tick, cycle => cycle.tick);
  if (plan?.paths.length) {
    const all = plan.paths.map(path => placesOf(path, plan.begins, tick));
    for (const places of all.slice(0, -1)) ribbon(pen, items, places.filter((_, i) => i % 2 === 0), 0.03, "candidate", own + 2, camera);
    ribbon(pen, items, all[all.length - 1], 0.22, "plan", own + 0.6, camera);
  }
  if (scan) drawHits(pen, items, scan.hits, camera);
  if (flight.heightAt) drawTerrain(pen, items, flight.heightAt, camera);
  for (const body of flight.bodies) drawBody(pen, items, body, camera);
  drawStreaks(pen, items, flight, tick, camera);
  if (look.ghost) {
    const trunk = { ...look.ghost, r: RADIUS, seen: null, mine: 0, crown: 0.5 };
    items.push([depth(trunk.x, trunk.y, eye[2]), () => { pen.globalAlpha = 0.5; drawTrunk(pen, { trunk, depth: Math.max(1, depth(trunk.x, trunk.y, 0)) }, tick, camera, true); }]);
  }
  items.push([own, () => drawAircraft(pen, state, flight.span, camera)]);
  items.sort((a, b) => b[0] - a[0]);
  for (const [, draw] of items) draw();
  return { camera, shown: trunks.length, items: items.length };
}
