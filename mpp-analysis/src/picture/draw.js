"use strict";
// The drawing of a flight, for every page. A flight has an `id` (the end of its elements' ids), `header`, `ticks`
// (columns, whose first row is the tick `first`), `plans`, `details` (a map from the tick of a scan), `orders`, and
// at its end `summary` and `closest`.
const OUTCOMES = { Adopted: "feasible", LeastViolating: "least violating", KeptPrevious: "last plan kept",
  TrimHold: "straight and level", Pursuit: "pursuit", Reserve: "reserve", Latest: "strikes latest" };
// What the occupancy layer is.
const MEMORY = "what the planner took for occupied: its map with memory of all scans so far, cells of 0.5 m, " +
  "hidden parts of obstacles completed.";
const GRID = "what the planner took for occupied: the grid of this one scan, cells of 1 m, padded; " +
  "whatever else is free, and nothing is unknown.";
const LAYERS = [["field", "obstacle"], ["scan", "scan"], ["occupancy", "cells"], ["candidates", "candidate"],
  ["corridor", "corridor"], ["plan", "plan"], ["reference", "reference"], ["flown", "flown"], ["unknown", "unknown"]];
// What a flight is judged by: pitch and flight path angle [deg], initial altitude and band about it [m].
const LIMITS = { pitch: 60, flight_path: 45, altitude: 50, band: 11 };
const $ = id => document.getElementById(id);
const degrees = radians => radians * 180 / Math.PI;
const colour = {};

function readColours() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["text", "faint", "line", "ground", "good", "bad", "placed", ...LAYERS.map(([, c]) => c)])
    colour[name] = style.getPropertyValue("--" + name).trim();
}

const lastTick = flight => flight.first + flight.ticks.t.length - 1;
const band = flight => LIMITS.band * flight.header.world_scale;
const isGood = outcome => outcome === "survived";

// The number of the plan in force at a tick: the last one that is flown by then.
function planAt(plans, tick) {
  let low = 0, high = plans.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (plans[middle].used_from_tick !== null && plans[middle].used_from_tick <= tick) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

// The cycle of the plan in force, if its details are there.
function detailAt(flight, tick) {
  const plan = flight.plans[planAt(flight.plans, tick)];
  return plan && flight.details.get(plan.tick);
}

function canvas(id, sharpest = Infinity) {
  const element = $(id), ratio = Math.min(window.devicePixelRatio || 1, sharpest);
  const width = element.clientWidth, height = element.clientHeight;
  if (element.width !== Math.round(width * ratio) || element.height !== Math.round(height * ratio)) {
    element.width = Math.round(width * ratio);
    element.height = Math.round(height * ratio);
  }
  const pen = element.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.font = "12px system-ui, 'DejaVu Sans', sans-serif";
  return [pen, width, height];
}

function line(pen, points, style, width, dash = []) {
  pen.beginPath();
  let down = false;
  for (const point of points) {
    if (point === null) { down = false; continue; }
    if (down) pen.lineTo(point[0], point[1]); else pen.moveTo(point[0], point[1]);
    down = true;
  }
  pen.strokeStyle = style; pen.lineWidth = width; pen.setLineDash(dash);
  // Broad lines are the ground that others are seen on.
  pen.globalAlpha = width > 3 ? 0.45 : 1;
  pen.stroke();
  pen.globalAlpha = 1;
  pen.setLineDash([]);
}

// Downrange places of the obstacles that have an end.
function extents(field) {
  const of = (kind, places) => (field[kind] || []).flatMap(places);
  return [...of("circle", o => o.x), ...of("capsule", o => [o.from[0], o.to[0]]),
    ...of("polygon", o => o.points.map(p => p[0])), ...of("polyline", o => o.points.map(p => p[0]))];
}

// The obstacles where they are at a time. Thin ones are drawn a pixel wide at least.
function drawField(pen, field, time, at, scale, width, height, style = colour.obstacle) {
  const of = kind => field[kind] || [];
  const moved = (o, [x, z]) => at(x + (o.velocity ? o.velocity[0] : 0) * time, z + (o.velocity ? o.velocity[1] : 0) * time);
  pen.fillStyle = pen.strokeStyle = style;
  pen.lineCap = pen.lineJoin = "round";
  const path = points => {
    pen.beginPath();
    for (const [u, v] of points) pen.lineTo(u, v);
  };
  for (const o of of("circle")) {
    const [u, v] = moved(o, [o.x, o.z]), radius = Math.max(o.radius * scale, 1);
    if (u < -radius || u > width + radius) continue;
    pen.beginPath(); pen.arc(u, v, radius, 0, 7); pen.fill();
  }
  const stroke = (o, points, thickness) => {
    path(points.map(p => moved(o, p))); pen.lineWidth = Math.max(thickness * scale, 1); pen.stroke();
  };
  for (const o of of("capsule")) stroke(o, [o.from, o.to], 2 * o.radius);
  for (const o of of("polyline")) stroke(o, o.points, o.thickness);
  for (const o of of("polygon")) { path(o.points.map(p => moved(o, p))); pen.fill(); }
  // Beyond its ends a line goes on level, to the edges of the view.
  const sheet = (o, edge) => {
    const line = o.points.map(p => at(...p)), first = line[0], last = line[line.length - 1];
    const left = Math.min(0, first[0]), right = Math.max(width, last[0]);
    path([[left, edge], [left, first[1]], ...line, [right, last[1]], [right, edge]]); pen.fill();
  };
  for (const o of of("ground")) sheet(o, height + 1e4);
  for (const o of of("ceiling")) sheet(o, -1e4);
  pen.lineCap = "butt"; pen.lineJoin = "miter";
}

// The part of the world that the picture shows: its scale [pixels/m], its left edge and its middle [m].
function sight(flight, row, follow, width, height) {
  const T = flight.ticks, unit = flight.header.world_scale;
  if (!follow) {
    flight.far ??= Math.max(0, ...extents(flight.header.field));
    const start = T.x[0] - 8, end = Math.max(flight.first ? 0 : flight.far, T.x[T.t.length - 1]) + 20;
    return [width / (end - start), start, LIMITS.altitude];
  }
  // A tall picture shows less of the way ahead, and so more of what is near.
  const scale = Math.min(height / 26, Math.max(width / 62, Math.min(height / 48, width / 36))) / unit;
  return [scale, T.x[row] - 0.22 * width / scale, T.z[row]];
}

// The places of some rows as points of the picture; null where there is none. Rows that share a pixel are left out.
function track(T, x, z, first, last, at, scale) {
  const points = [], stride = Math.max(1, Math.floor(8 / scale));
  for (let i = first; i <= last; i += i + stride > last && i < last ? last - i : stride)
    points.push(T[x][i] === null ? null : at(T[x][i], T[z][i]));
  return points;
}

// The stage of the corridor under the pointer: the one whose place is next to it, or to the aircraft.
function stageAt(detail, place) {
  const path = detail.paths[detail.chosen] || [], apart = path.map(([x, z]) => Math.hypot(x - place[0], z - place[1]));
  return apart.indexOf(Math.min(...apart));
}

function drawStage(pen, detail, stage, at, width) {
  const polygon = detail.corridor[stage], path = detail.paths[detail.chosen];
  if (!polygon || !path) return;
  pen.fillStyle = pen.strokeStyle = colour.corridor;
  if (polygon.length > 2) {
    pen.beginPath();
    for (const [x, z] of polygon) pen.lineTo(...at(x, z));
    pen.closePath();
    pen.globalAlpha = 0.2; pen.fill();
    pen.globalAlpha = 1; pen.lineWidth = 1.5; pen.stroke();
  }
  const [u, v] = at(...path[stage]);
  pen.beginPath(); pen.arc(u, v, 4, 0, 7); pen.fill();
  pen.textAlign = "center";
  label(pen, `corridor of stage ${stage} of ${detail.corridor.length - 1}` + (polygon.length > 2 ? "" : ": empty"), width / 2, 14, colour.corridor);
}

// Text that is read upon whatever lies beneath.
function label(pen, text, u, v, style) {
  pen.strokeStyle = colour.ground; pen.lineWidth = 3; pen.strokeText(text, u, v);
  pen.fillStyle = style; pen.fillText(text, u, v);
}

// What the flight is judged by: band and goal, closest approach, and the end.
function drawMarks(pen, flight, at, width) {
  const goal = LIMITS.altitude, edge = band(flight);
  for (const z of [goal - edge, goal + edge]) line(pen, [[0, at(0, z)[1]], [width, at(0, z)[1]]], colour.bad, 1, [2, 4]);
  line(pen, [[0, at(0, goal)[1]], [width, at(0, goal)[1]]], colour.good, 1, [10, 6]);
  pen.textAlign = "right";
  label(pen, "goal", width - 6, at(0, goal)[1] - 3, colour.good);
  label(pen, "band", width - 6, at(0, goal + edge)[1] - 3, colour.bad);
  pen.textAlign = "center";
  if (flight.closest) {
    const { x, z, clearance } = flight.closest, [u, v] = at(x, z);
    pen.beginPath(); pen.arc(u, v, 9, 0, 7); pen.strokeStyle = colour.scan; pen.lineWidth = 1.5; pen.stroke();
    label(pen, `closest ${clearance.toFixed(2)} m`, u, v + 24, colour.scan);
  }
  if (flight.summary) {
    const T = flight.ticks, row = T.t.length - 1, [u, v] = at(T.x[row], T.z[row]), good = isGood(flight.summary.outcome);
    const style = good ? colour.good : colour.bad;
    if (good) line(pen, [[u, v - 12], [u, v + 12]], style, 3);
    else { line(pen, [[u - 8, v - 8], [u + 8, v + 8]], style, 3); line(pen, [[u + 8, v - 8], [u - 8, v + 8]], style, 3); }
    label(pen, flight.summary.outcome.replace(/-/g, " "), u, v - 16, style);
  }
}

// Draws the side view at a tick. `look` says whether to `follow` the aircraft, which layers are `on`, the `cursor`
// (a place) and the `marked` candidate, if any. Returns a function from a point of the picture to a place in the world.
function drawView(flight, now, look) {
  const [pen, width, height] = canvas("view" + flight.id), T = flight.ticks, on = look.on;
  if (!T.t.length) return null;
  const row = now - flight.first;
  const [scale, x0, z0] = sight(flight, row, look.follow, width, height);
  const at = (x, z) => [(x - x0) * scale, height / 2 - (z - z0) * scale];
  const step = [10, 50, 100, 500, 1000, 5000].find(step => step * scale > 45) || 10000;
  const detail = detailAt(flight, now);
  const cells = (rows, style, edge) => {
    pen.fillStyle = style;
    for (const [x, z, length] of rows) {
      const [u, v] = at(x, z + edge);
      pen.fillRect(u, v, length * scale + .4, edge * scale + .4);
    }
  };
  if (on.unknown && detail) cells(detail.map.unknown, colour.unknown, detail.map.cell);
  const texts = [];
  for (let x = Math.ceil(x0 / step) * step; x < x0 + width / scale; x += step) {
    line(pen, [at(x, -1e4), at(x, 1e4)], colour.line, 0.5);
    texts.push([x + " m", at(x, 0)[0] + 3, height - 5]);
  }
  const rise = [10, 50, 100, 500, 1000].find(rise => rise * scale > 14) || 5000;
  for (let z = Math.ceil((z0 - height / 2 / scale) / rise) * rise; z < z0 + height / 2 / scale; z += rise) {
    line(pen, [at(-1e4, z), at(1e6, z)], colour.line, 0.5);
    // The lowest place is that of distances.
    if (at(0, z)[1] < height - 22) texts.push([z + " m", 4, at(0, z)[1] - 3]);
  }
  if (on.field) drawField(pen, flight.header.field, T.t[row], at, scale, width, height);
  if (on.occupancy && detail) {
    look.note(detail.map.unknown.length ? MEMORY : GRID);
    pen.globalAlpha = 0.8;
    cells(detail.map.occupied, colour.cells, detail.map.cell);
    pen.globalAlpha = 1;
  }
  // An order of the next tick is shown at once.
  if (on.field) for (const order of flight.orders)
    if (order.field && order.tick <= now + 1) drawField(pen, order.field, T.t[row], at, scale, width, height, colour.placed);
  if (on.candidates && detail) {
    detail.paths.forEach(path => line(pen, path.map(([x, z]) => at(x, z)), colour.candidate, 0.8));
    const marked = detail.paths[look.marked];
    if (marked) line(pen, marked.map(([x, z]) => at(x, z)), colour.text, 2.5);
  }
  if (on.corridor && detail && detail.chosen !== null)
    drawStage(pen, detail, stageAt(detail, look.cursor || [T.x[row], T.z[row]]), at, width);
  if (on.scan && detail) {
    pen.fillStyle = colour.scan;
    for (const [x, z] of detail.hits) { const [u, v] = at(x, z); pen.fillRect(u - 2, v - 2, 4, 4); }
  }
  if (on.plan && detail) line(pen, detail.trajectory.map(([x, z]) => at(x, z)), colour.plan, 3);
  pen.textAlign = "left";
  for (const text of texts) label(pen, ...text, colour.faint);
  drawMarks(pen, flight, at, width);
  // What lies left of the picture is not drawn.
  let first = row;
  while (first > 0 && T.x[first] > x0) first--;
  if (on.reference) line(pen, track(T, "ref_x", "ref_z", first, row, at, scale), colour.reference, 5);
  if (on.flown) {
    line(pen, track(T, "x", "z", first, row, at, scale), colour.flown, 2);
    drawReplans(pen, flight, first, row, at, scale);
  }
  const [u, v] = at(T.x[row], T.z[row]);
  pen.save(); pen.translate(u, v); pen.rotate(-T.pitch[row]);
  pen.fillStyle = colour.text; pen.beginPath();
  pen.moveTo(12, 0); pen.lineTo(-10, -5); pen.lineTo(-6, 0); pen.lineTo(-10, 5); pen.fill();
  pen.restore();
  return (u, v) => [x0 + u / scale, z0 + (height / 2 - v) / scale];
}

// A dot on the flown path wherever a plan took over, as long as the dots lie apart.
function drawReplans(pen, flight, first, last, at, scale) {
  const T = flight.ticks;
  pen.fillStyle = colour.plan;
  for (let i = planAt(flight.plans, flight.first + last); i >= 0; i--) {
    const row = flight.plans[i].used_from_tick - flight.first;
    if (row < first || scale < 0.5) return;
    const [u, v] = at(T.x[row], T.z[row]);
    pen.beginPath(); pen.arc(u, v, 3, 0, 7); pen.fill();
  }
}
