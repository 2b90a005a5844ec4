"use strict";
// The drawing of a flight, for every page. A flight has `header`, `ticks` (columns), `plans`, `details` (a map
// from the tick of a scan), and `orders`.
const OUTCOMES = { Adopted: "feasible", LeastViolating: "least violating", KeptPrevious: "last plan kept",
  TrimHold: "straight and level" };
// What the occupancy layer is.
const MEMORY = "what the planner took for occupied: its map with memory of all scans so far, cells of 0.5 m, " +
  "hidden parts of obstacles completed; the faint ground is what no beam has told of.";
const GRID = "what the planner took for occupied: the grid of this one scan, cells of 1 m, padded; " +
  "whatever else is free.";
const LAYERS = [["field", "obstacle"], ["scan", "scan"], ["occupancy", "cells"], ["candidates", "candidate"],
  ["corridor", "corridor"], ["plan", "plan"], ["reference", "reference"], ["flown", "flown"]];
const $ = id => document.getElementById(id);
const degrees = radians => radians * 180 / Math.PI;
const colour = {};

function readColours() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["text", "faint", "line", "ground", "unknown", ...LAYERS.map(([, c]) => c)])
    colour[name] = style.getPropertyValue("--" + name).trim();
}

// The plan in force at a tick: the last one that is flown by then.
function planAt(plans, tick) {
  let found = -1;
  for (let i = 0; i < plans.length && plans[i].used_from_tick <= tick; i++) found = i;
  return found;
}

function canvas(id) {
  const element = $(id), ratio = window.devicePixelRatio || 1;
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
function drawField(pen, field, time, at, scale, width, height) {
  const of = kind => field[kind] || [];
  const moved = (o, [x, z]) => at(x + (o.velocity ? o.velocity[0] : 0) * time, z + (o.velocity ? o.velocity[1] : 0) * time);
  pen.fillStyle = pen.strokeStyle = colour.obstacle;
  pen.lineCap = pen.lineJoin = "round";
  const path = points => {
    pen.beginPath();
    for (const [u, v] of points) pen.lineTo(u, v);
  };
  for (const o of of("circle")) {
    pen.beginPath(); pen.arc(...moved(o, [o.x, o.z]), Math.max(o.radius * scale, 1), 0, 7); pen.fill();
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
function sight(flight, now, follow, width, height) {
  const T = flight.ticks, unit = flight.header.world_scale;
  if (!follow) {
    const end = Math.max(...extents(flight.header.field), T.x[T.t.length - 1]) + 20;
    return [width / (end + 10), -8, 50];
  }
  const scale = Math.min(width / 62, height / 26) / unit;
  return [scale, T.x[now] - 0.22 * width / scale, T.z[now]];
}

// The places of a tick range as points of the picture; null where there is none.
const track = (T, x, z, first, last, at) =>
  Array.from({ length: last - first + 1 }, (_, i) => T[x][first + i] === null ? null : at(T[x][first + i], T[z][first + i]));

// Draws the side view at a tick. `look` says whether to `follow` the aircraft and which layers are `on`. Returns
// a function from a point of the picture to a place in the world.
function drawView(flight, now, look) {
  const [pen, width, height] = canvas("view"), T = flight.ticks, on = look.on;
  if (!T.t.length) return null;
  const [scale, x0, z0] = sight(flight, now, look.follow, width, height);
  const at = (x, z) => [(x - x0) * scale, height / 2 - (z - z0) * scale];
  const step = scale > 4 ? 10 : 50;
  const plan = planAt(flight.plans, now);
  const detail = plan < 0 ? undefined : flight.details.get(flight.plans[plan].tick);
  const cells = (rows, style, edge) => {
    pen.fillStyle = style;
    for (const [x, z, length] of rows) {
      const [u, v] = at(x, z + edge);
      pen.fillRect(u, v, length * scale + .4, edge * scale + .4);
    }
  };
  if (on.occupancy && detail) cells(detail.map.unknown, colour.unknown, detail.map.cell);
  pen.fillStyle = colour.faint; pen.textAlign = "left";
  for (let x = Math.ceil(x0 / step) * step; x < x0 + width / scale; x += step) {
    line(pen, [at(x, -1e4), at(x, 1e4)], colour.line, 0.5);
    pen.fillText(x + " m", at(x, 0)[0] + 3, height - 5);
  }
  const rise = scale > 1 ? 10 : 50;
  for (let z = Math.ceil((z0 - height / 2 / scale) / rise) * rise; z < z0 + height / 2 / scale; z += rise) {
    line(pen, [at(-1e4, z), at(1e4, z)], colour.line, 0.5);
    pen.fillText(z + " m", 4, at(0, z)[1] - 3);
  }
  if (on.corridor && detail) {
    pen.fillStyle = colour.corridor;
    for (const polygon of detail.corridor) {
      if (polygon.length < 3) continue;
      pen.beginPath();
      for (const [x, z] of polygon) pen.lineTo(...at(x, z));
      pen.closePath();
      pen.globalAlpha = 0.03; pen.fill();
      pen.globalAlpha = 0.3; pen.strokeStyle = colour.corridor; pen.lineWidth = 0.7; pen.stroke();
    }
    pen.globalAlpha = 1;
  }
  if (on.field) {
    drawField(pen, flight.header.field, T.t[now], at, scale, width, height);
    // An order of the next tick is shown at once.
    for (const order of flight.orders)
      if (order.field && order.tick <= now + 1) drawField(pen, order.field, T.t[now], at, scale, width, height);
  }
  if (on.occupancy && detail) {
    look.note(detail.map.unknown.length ? MEMORY : GRID);
    pen.globalAlpha = 0.8;
    cells(detail.map.occupied, colour.cells, detail.map.cell);
    pen.globalAlpha = 1;
  }
  if (on.candidates && detail)
    detail.paths.forEach(path => line(pen, path.map(([x, z]) => at(x, z)), colour.candidate, 1));
  if (on.scan && detail) {
    pen.fillStyle = colour.scan;
    for (const [x, z] of detail.hits) { const [u, v] = at(x, z); pen.fillRect(u - 2, v - 2, 4, 4); }
  }
  if (on.plan && detail) line(pen, detail.trajectory.map(([x, z]) => at(x, z)), colour.plan, 2, [6, 4]);
  // What lies left of the picture is not drawn.
  let first = now;
  while (first > 0 && T.x[first] > x0) first--;
  if (on.reference) line(pen, track(T, "ref_x", "ref_z", first, now, at), colour.reference, 5);
  if (on.flown) line(pen, track(T, "x", "z", first, now, at), colour.flown, 2);
  const [u, v] = at(T.x[now], T.z[now]);
  pen.save(); pen.translate(u, v); pen.rotate(-T.pitch[now]);
  pen.fillStyle = colour.text; pen.beginPath();
  pen.moveTo(12, 0); pen.lineTo(-10, -5); pen.lineTo(-6, 0); pen.lineTo(-10, 5); pen.fill();
  pen.restore();
  return (u, v) => [x0 + u / scale, z0 + (height / 2 - v) / scale];
}

// Draws the charts of the ticks from `first` on.
function drawCharts(flight, now, first) {
  const [pen, width, height] = canvas("charts"), T = flight.ticks;
  if (!T.t.length) return;
  const band = (height - 18) / 6, left = 44, right = width - 8;
  const total = Math.max(T.t.length - 1, first + 1), span = total - first;
  const u = tick => left + (right - left) * (tick - first) / span;
  const stride = Math.max(1, Math.floor(span / (2 * width)));
  const ticks = []; for (let i = first; i <= total && i < T.t.length; i += stride) ticks.push(i);
  const chart = (row, title, least, series) => {
    const values = series.flatMap(s => s.of.map(v => v)).filter(v => v !== null && isFinite(v));
    let low = Infinity, high = -Infinity;
    for (const v of values) { low = Math.min(low, v); high = Math.max(high, v); }
    if (low > high) [low, high] = [0, 1];
    // Noise is not blown up to fill the chart.
    const margin = Math.max((high - low) * .08, (least - (high - low)) / 2); low -= margin; high += margin;
    const digits = high - low < 5 ? 1 : 0;
    const top = row * band + 14, bottom = (row + 1) * band - 6;
    const v = value => bottom - (bottom - top) * (value - low) / (high - low);
    line(pen, [[left, bottom], [right, bottom]], colour.line, 1);
    pen.fillStyle = colour.faint; pen.textAlign = "left"; pen.fillText(title, left, row * band + 11);
    pen.textAlign = "right";
    pen.fillText(high.toFixed(digits), left - 4, top + 8);
    pen.fillText(low.toFixed(digits), left - 4, bottom);
    for (const s of series)
      line(pen, s.at.map((tick, i) => s.of[i] === null ? null : [u(tick), v(s.of[i])]), s.colour, s.width);
  };
  // Where both are the same, the broad reference shows on both sides of what was flown.
  const of = (name, style, change = value => value) => ({ at: ticks, colour: style, width: name.startsWith("ref_") ? 4 : 1.5,
    of: ticks.map(i => T[name][i] === null ? null : change(T[name][i])) });
  chart(0, "height [m]", 1, [of("ref_z", colour.reference), of("z", colour.flown)]);
  chart(1, "airspeed [m/s]", 1, [of("ref_airspeed", colour.reference), of("airspeed", colour.flown)]);
  chart(2, "pitch [deg]", 4, [of("ref_pitch", colour.reference, degrees), of("pitch", colour.flown, degrees)]);
  chart(3, "flight path [deg]", 4, [of("ref_flight_path", colour.reference, degrees), of("flight_path", colour.flown, degrees)]);
  chart(4, "thrust [N]", 1, [of("thrust", colour.flown)]);
  // What a plan came to holds until the next one.
  const shown = flight.plans.slice(Math.max(planAt(flight.plans, first), 0));
  const starts = shown.map(plan => plan.used_from_tick);
  const plans = starts.flatMap((tick, i) => [Math.max(tick, first), Math.min(starts[i + 1] ?? Infinity, total)]);
  const steps = name => shown.flatMap(plan => [plan[name], plan[name]]);
  chart(5, "planner: candidates (broad), feasible", 2, [
    { at: plans, of: steps("candidates"), colour: colour.candidate, width: 4 },
    { at: plans, of: steps("feasible"), colour: colour.plan, width: 1.5 }]);
  const choices = [1, 2, 5, 10, 20, 60, 120, 300, 600];
  const every = choices.find(s => (right - left) * s * 100 / span > 55) || 1200;
  pen.fillStyle = colour.faint; pen.textAlign = "center";
  for (let s = Math.ceil(first / 100 / every) * every; s <= total / 100; s += every) {
    line(pen, [[u(100 * s), height - 18], [u(100 * s), height - 14]], colour.faint, 1);
    pen.fillText(s + " s", Math.min(u(100 * s), width - 16), height - 3);
  }
  line(pen, [[u(now), 0], [u(now), height - 18]], colour.text, 1);
}

// Shows the numbers of a tick. `more` holds further rows.
function showValues(flight, now, more = []) {
  const T = flight.ticks, number = planAt(flight.plans, now), plan = flight.plans[number];
  const values = [
    ["downrange", T.x[now].toFixed(2) + " m"], ["height", T.z[now].toFixed(2) + " m"],
    ["airspeed", T.airspeed[now].toFixed(2) + " m/s"], ["pitch", degrees(T.pitch[now]).toFixed(1) + " deg"],
    ["flight path", degrees(T.flight_path[now]).toFixed(1) + " deg"], ["thrust", T.thrust[now].toFixed(2) + " N"],
    ["elevator", T.elevator[now].toFixed(2)],
    ["plan", plan ? `${number + 1} of ${flight.plans.length}` : "none"],
    ["outcome", plan ? OUTCOMES[plan.outcome] || plan.outcome : "-"],
    ["candidates", plan ? plan.candidates : "-"], ["feasible", plan ? plan.feasible : "-"],
    ["trees", plan ? plan.tree_runs : "-"],
    ["cost", plan && plan.cost !== null ? plan.cost.toFixed(2) : "-"],
    ["violation", plan && plan.violation !== null ? plan.violation.toFixed(3) + " m" : "-"], ...more];
  $("values").replaceChildren(...values.map(([name, value]) => {
    const row = document.createElement("div"), dt = document.createElement("dt"), dd = document.createElement("dd");
    dt.textContent = name; dd.textContent = value; dd.id = "v-" + name.replace(" ", "-");
    row.append(dt, dd);
    return row;
  }));
}

// An order as text.
function orderText(order) {
  const part = ([name, value]) => {
    if (name === "tick" || name === "order") return [];
    if (name === "field") return Object.entries(value).map(([kind, all]) => `${all.length} ${kind}`);
    return [typeof value === "boolean" || order.order === "disturb" ? `${name.replace("_", " ")} ${value}` : value];
  };
  return `${(order.tick / 100).toFixed(2)} s: ${order.order} ` + Object.entries(order).flatMap(part).join(" ");
}

// A box for each layer, which `on` follows.
function addLayers(on, changed) {
  LAYERS.forEach(([name, style], index) => {
    const label = document.createElement("label"), box = document.createElement("input"), mark = document.createElement("i");
    box.type = "checkbox"; box.checked = on[name]; box.id = "layer-" + name;
    box.onchange = () => { on[name] = box.checked; changed(); };
    mark.style.setProperty("--c", `var(--${style})`);
    label.title = `key ${index + 1}`;
    label.append(box, mark, name);
    $("layers").append(label);
  });
}
