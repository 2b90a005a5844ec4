// The flight from above, ahead upwards, and from the side.
// What the map shows ahead and behind [m]; half of the slab that the side view shows, and how far it reaches ahead and behind [m].
const AHEAD = 55, BACK = 14, SLAB = 6, STRIP = [45, 15];

// Draws the map. Returns what finds the place under a pixel.
function drawMap(flight, tick, look) {
  const [pen, width, height] = canvas("map"), { at } = stateAt(flight, tick), course = courseAt(flight, tick), [cos, sin] = [Math.cos(course), Math.sin(course)];
  const scale = height / (AHEAD + BACK), middle = height * AHEAD / (AHEAD + BACK);
  const put = (x, y) => {
    const a = x - at[0], b = y - at[1];
    return [width / 2 + scale * (b * cos - a * sin), middle - scale * (a * cos + b * sin)];
  };
  const place = (u, v) => {
    const right = (u - width / 2) / scale, ahead = (middle - v) / scale;
    return [at[0] + ahead * cos - right * sin, at[1] + ahead * sin + right * cos];
  };
  pen.fillStyle = paint.earth[0]; pen.fillRect(0, 0, width, height);
  // Ground is the darker, the nearer it comes to the height of the aircraft.
  for (let a = -90; flight.heightAt && a < 90; a += 5) for (let b = -90; b < 90; b += 5) {
    const [x, y] = [Math.floor(at[0] / 5) * 5 + a, Math.floor(at[1] / 5) * 5 + b];
    pen.globalAlpha = Math.max(0, Math.min(1, (flight.heightAt(x + 2.5, y + 2.5) - at[2] + 15) / 15));
    fillPath(pen, [[0, 0], [5, 0], [5, 5], [0, 5]].map(([p, q]) => put(x + p, y + q)), paint.bark[0]);
  }
  pen.globalAlpha = 0.35; pen.strokeStyle = colour.faint; pen.lineWidth = 1;
  pen.beginPath();
  for (let step = -90; step <= 90; step += 10) {
    const [x, y] = [0, 1].map(axis => Math.floor(at[axis] / 10) * 10 + step), [x0, y0] = [at[0] - 90, at[1] - 90];
    pen.moveTo(...put(x, y0)); pen.lineTo(...put(x, y0 + 180));
    pen.moveTo(...put(x0, y)); pen.lineTo(...put(x0 + 180, y));
  }
  pen.stroke(); pen.globalAlpha = 1;
  drawPlans(pen, flight.bodies, at[2], put, scale);
  for (const trunk of flight.trunks) {
    const { x, y, r, seen, mine } = trunk;
    if (mine > tick) continue;
    const [u, v] = put(x, y);
    if (u < -9 || v < -9 || u > width + 9 || v > height + 9) continue;
    pen.fillStyle = trunk === flight.crash ? colour.bad : mine !== null ? colour.placed : paint[seen !== null && seen <= tick ? "bark" : "pale"][0];
    pen.beginPath(); pen.arc(u, v, Math.max(trunk === flight.crash ? 4 : 1.8, r * scale), 0, 7); pen.fill();
  }
  const plan = newest(flight.cycles, tick, cycle => cycle.due), scan = newest(flight.cycles, tick, cycle => cycle.tick);
  pen.fillStyle = colour.scan;
  for (let i = 0; i < (scan ? scan.hits.length : 0); i += 3) {
    const [u, v] = put(scan.hits[i], scan.hits[i + 1]);
    pen.fillRect(u - 0.75, v - 0.75, 1.5, 1.5);
  }
  const trail = [];
  for (let back = 0; back <= 300 && back <= tick; back += 5) trail.push(put(...stateAt(flight, tick - back).at));
  line(pen, trail, colour.flown, 2);
  if (plan?.paths.length) plan.paths.forEach((path, i) => {
    const last = i === plan.paths.length - 1;
    line(pen, placesOf(path, plan.begins, tick).map(([x, y]) => put(x, y)), last ? colour.plan : colour.candidate, last ? 3 : 1.2);
  });
  if (look.ghost) {
    const [u, v] = put(look.ghost.x, look.ghost.y);
    pen.strokeStyle = colour.placed; pen.lineWidth = 2;
    pen.beginPath(); pen.arc(u, v, 6, 0, 7); pen.stroke();
  }
  const { attitude } = stateAt(flight, tick), size = Math.max(flight.span, 22 / scale);
  fillPath(pen, BOTH.map(([a, b]) => { const way = turned(attitude, [a, b, 0]); return put(at[0] + size * way[0], at[1] + size * way[1]); }), colour.text);
  caption(pen, "from above, 10 m squares" + (look.ghost === undefined ? "" : "; click plants a tree"), 8, 18);
  return place;
}

// Corners about a body that is no trunk [m].
function cornersOf({ sphere, capsule, box }) {
  const r = (sphere || capsule || { radius: 0 }).radius, ends = sphere ? [sphere.centre] : capsule ? [capsule.from, capsule.to] : [box.least, box.most];
  const [least, most] = [Math.min, Math.max].map((of, side) => [0, 1, 2].map(axis => of(...ends.map(end => end[axis] ?? TOP)) + (side ? r : -r)));
  return [0, 1, 2, 3, 4, 5, 6, 7].map(bits => [0, 1, 2].map(axis => bits >> axis & 1 ? most[axis] : least[axis]));
}

// Other bodies from above: dark where the aircraft could meet them at its height.
function drawPlans(pen, bodies, height, put, scale) {
  for (const body of bodies) {
    const corners = cornersOf(body), { sphere, capsule } = body, level = corners[0][2] < height + 1 && corners[7][2] > height - 1;
    pen.fillStyle = pen.strokeStyle = paint[level ? "bark" : "pale"][0];
    if (sphere) { pen.beginPath(); pen.arc(...put(...sphere.centre), sphere.radius * scale, 0, 7); pen.fill(); }
    else if (capsule) line(pen, [put(...capsule.from), put(...capsule.to)], pen.strokeStyle, Math.max(1.5, 2 * capsule.radius * scale));
    else fillPath(pen, [0, 1, 3, 2].map(i => put(...corners[i])), pen.fillStyle);
  }
}

// The attitude indicator: the horizon as the pilot sees it, 30 degrees of pitch from the centre to the edge, marks of bank at 30 and 60.
function drawAttitude(flight, tick) {
  if (!$("attitude").clientHeight) return;
  const [pen, size] = canvas("attitude"), { bank, ahead } = stateAt(flight, tick), r = size / 2, scale = r / (30 * Math.PI / 180);
  pen.save();
  pen.translate(r, r);
  pen.beginPath(); pen.arc(0, 0, r - 1, 0, 7); pen.clip();
  pen.rotate(-bank);
  const level = Math.asin(Math.max(-1, Math.min(1, ahead[2]))) * scale;
  pen.fillStyle = paint.sky[0]; pen.fillRect(-size, -size, 2 * size, 2 * size);
  pen.fillStyle = paint.earth[0]; pen.fillRect(-size, level, 2 * size, 2 * size);
  line(pen, [[-size, level], [size, level]], colour.text, 1.5);
  for (const step of [-20, -10, 10, 20]) line(pen, [-1, 1].map(side => [side * r * 0.2, level - step * Math.PI / 180 * scale]), colour.text, 1);
  for (const mark of [-60, -30, 0, 30, 60]) line(pen, [0.84, 1].map(way => [way * r * Math.sin(mark * Math.PI / 180), -way * r * Math.cos(mark * Math.PI / 180)]), colour.text, 1.5);
  pen.restore();
  // The aircraft, which does not move.
  line(pen, [[r * 0.45, r], [r * 0.8, r], null, [r * 1.2, r], [r * 1.55, r], null, [r, r * 0.07], [r, r * 0.22]], colour.flown, 2.5);
  pen.strokeStyle = colour.faint; pen.lineWidth = 1; pen.beginPath(); pen.arc(r, r, r - 1, 0, 7); pen.stroke();
}

function caption(pen, text, u, v) {
  pen.textAlign = "left";
  pen.lineWidth = 3; pen.strokeStyle = colour.ground; pen.strokeText(text, u, v);
  pen.fillStyle = colour.text; pen.fillText(text, u, v);
}

// Draws the side view: what is within a slab about the course, and the ceiling.
function drawSide(flight, tick) {
  if (!$("side").clientHeight) return;
  const [pen, width, height] = canvas("side"), { at } = stateAt(flight, tick), course = courseAt(flight, tick), [cos, sin] = [Math.cos(course), Math.sin(course)];
  const [, , ceiling] = flight.header.space.extent, scale = width / (STRIP[0] + STRIP[1]), { heightAt, lowest } = flight;
  const up = (height - 22) / (ceiling - lowest + 1), floor = height - 4;
  const along = (x, y) => (x - at[0]) * cos + (y - at[1]) * sin, across = (x, y) => (y - at[1]) * cos - (x - at[0]) * sin;
  const put = (way, z) => [(STRIP[1] + way) * scale, floor - (z - lowest) * up];
  pen.fillStyle = paint.haze[0]; pen.fillRect(0, 0, width, height);
  pen.fillStyle = paint.earth[0]; pen.fillRect(0, floor, width, 4);
  const profile = [];
  for (let way = -STRIP[1]; heightAt && way <= STRIP[0]; way++) profile.push(put(way, heightAt(at[0] + way * cos, at[1] + way * sin)));
  if (heightAt) fillPath(pen, [[0, height], ...profile, [width, height]], paint.earth[0]);
  pen.fillStyle = pen.strokeStyle = paint.pale[0];
  for (const body of flight.bodies) {
    const corners = cornersOf(body), ways = corners.map(([x, y]) => along(x, y)), asides = corners.map(([x, y]) => across(x, y));
    if (Math.min(...asides) > SLAB || Math.max(...asides) < -SLAB) continue;
    const heights = corners.map(corner => Math.min(corner[2], ceiling + 5)), [u, v] = put(Math.min(...ways), Math.max(...heights)), [u2, v2] = put(Math.max(...ways), Math.min(...heights));
    if (body.sphere) { pen.beginPath(); pen.ellipse((u + u2) / 2, (v + v2) / 2, (u2 - u) / 2, (v2 - v) / 2, 0, 0, 7); pen.fill(); }
    else pen.fillRect(u, v, Math.max(1.5, u2 - u), Math.max(1.5, v2 - v));
  }
  for (const { x, y, r, seen, mine } of flight.trunks) {
    const way = along(x, y), aside = Math.abs(across(x, y));
    if (mine > tick || aside > SLAB || way < -STRIP[1] || way > STRIP[0]) continue;
    const [u, v] = put(way, ceiling + 5), known = seen !== null && seen <= tick, w = Math.max(2, 2 * r * scale);
    pen.globalAlpha = 1 - 0.8 * aside / SLAB;
    pen.fillStyle = mine !== null ? colour.placed : paint[known ? "bark" : "pale"][0];
    pen.fillRect(u - w / 2, v, w, floor - v);
  }
  pen.globalAlpha = 1;
  line(pen, [put(-STRIP[1], ceiling), put(STRIP[0], ceiling)], colour.faint, 1, [4, 4]);
  const trail = [];
  for (let back = 0; back <= 150 && back <= tick; back += 5) { const [x, y, z] = stateAt(flight, tick - back).at; trail.push(put(along(x, y), z)); }
  line(pen, trail, colour.flown, 2);
  const plan = newest(flight.cycles, tick, cycle => cycle.due);
  if (plan?.paths.length) plan.paths.forEach((path, i) => {
    const last = i === plan.paths.length - 1;
    line(pen, placesOf(path, plan.begins, tick).map(([x, y, z]) => put(along(x, y), z)), last ? colour.plan : colour.candidate, last ? 3 : 1.2);
  });
  const [u, v] = put(0, at[2]);
  pen.fillStyle = colour.text; pen.beginPath(); pen.arc(u, v, 4, 0, 7); pen.fill();
  caption(pen, `from the side, ${Math.round(lowest)} to ${Math.round(ceiling)} m`, 8, 14);
}
