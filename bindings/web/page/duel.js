// The duel: what the visitor put into the way, what the aircraft made of it, and the words for both.
// Shares of real time: the last second before a crash, and while the pointer is down.
const SLOW = 1 / 4, HELD = 1 / 8;
// How far *again with my obstacles* goes back, and how much the slow motion shows [ticks].
const BACK = 400, LAST = 100;
// A beam that ends so near an obstacle's edge has hit it [m at the reference aircraft's size].
const NEAR = 0.4;
const WORDS = { capsule: "bar", polyline: "wall" };
const round1 = value => Math.abs(value).toFixed(1), seconds = ticks => (ticks / 100).toFixed(2) + " s";

// The obstacles of a field, each with its kind.
const things = field => Object.entries(field || {}).flatMap(([kind, all]) => all.map(o => [kind, o]));

// An obstacle's middle line and half of its thickness.
function spine(kind, o) {
  if (kind === "circle") return [[[o.x, o.z]], o.radius];
  if (kind === "capsule") return [[o.from, o.to], o.radius];
  if (kind === "polyline") return [o.points, o.thickness / 2];
  const first = o.points[0], last = o.points[o.points.length - 1];
  if (kind === "polygon") return [[...o.points, first], 0];
  return [[[-1e6, first[1]], ...o.points, [1e6, last[1]]], 0];
}

// Distance from a place to an obstacle's edge at a time [m].
function apart(kind, o, [x, z], time) {
  const [points, half] = spine(kind, o), [vx, vz] = o.velocity || [0, 0], px = x - vx * time, pz = z - vz * time;
  let least = Infinity;
  points.forEach(([ax, az], index) => {
    const [bx, bz] = points[index + 1] || [ax, az], dx = bx - ax, dz = bz - az, square = dx * dx + dz * dz;
    const share = square && Math.min(Math.max(((px - ax) * dx + (pz - az) * dz) / square, 0), 1);
    least = Math.min(least, Math.hypot(ax + share * dx - px, az + share * dz - pz));
  });
  return least - half;
}

// `slow` is when the slow motion of a crash began. `mine` are the orders of the last flight with obstacles of the
// visitor, and its end.
let slow = null, mine = null;
// How each obstacle of an order stands: the rows that were looked at, the least distance in them, whether it is passed.
const met = new WeakMap();

// Counts the visitor's obstacles that were ahead when they were placed, and those that the aircraft has passed.
// `nearest` is the least distance to one of those [m].
function tally({ ticks: T, orders }) {
  const sum = { placed: 0, passed: 0, nearest: Infinity };
  for (const order of orders) for (const [kind, o] of things(order.field)) {
    const [points, half] = spine(kind, o), end = Math.max(...points.map(p => p[0])) + half;
    if (order.tick < T.x.length && end < T.x[order.tick]) continue;
    if (!met.has(o)) met.set(o, { row: order.tick, nearest: Infinity, passed: false });
    const known = met.get(o);
    for (; !known.passed && known.row < T.x.length; known.row++) {
      known.nearest = Math.min(known.nearest, apart(kind, o, [T.x[known.row], T.z[known.row]], T.t[known.row]));
      known.passed = T.x[known.row] > end;
    }
    sum.placed++;
    if (!known.passed) continue;
    sum.passed++;
    sum.nearest = Math.min(sum.nearest, known.nearest);
  }
  return sum;
}

// The line on top. `crash` says what ended the flight, if it is lost.
function verdict({ placed, passed, nearest }, crash = null) {
  const score = `You placed ${placed}, it passed ${passed}` + (passed ? `, nearest ${round1(nearest)} m` : "") + ".";
  if (crash) return (crash.mine ? "You got it! " : crash.kind ? "It hit the field. " : "It lost control. ") + (placed ? score : "");
  return placed ? score : "It flies by its lidar alone. Click into its way, or drag a bar.";
}

// What a lost flight ran into: its kind, whether it is the visitor's, and the ticks of its order, of the first scan that
// hit it, and of the first tick that was flown by a plan that knew. Null where there is none.
function crashOf({ header, ticks: T, orders, plans, details, summary }) {
  if (isGood(summary.outcome)) return null;
  const end = T.t.length - 1, crash = { end, kind: null, mine: false, placed: null, seen: null, away: null, known: null };
  if (summary.outcome !== "collision") return crash;
  let least = Infinity;
  const look = (field, placed) => things(field).forEach(([kind, o]) => {
    const distance = apart(kind, o, [T.x[end], T.z[end]], T.t[end]);
    if (distance < least) { least = distance; Object.assign(crash, { kind, o, placed, mine: placed !== null }); }
  });
  look(header.field, null);
  for (const order of orders) look(order.field, order.tick);
  const scans = [...details.values()].filter(({ tick }) => tick >= crash.placed).sort((a, b) => a.tick - b.tick);
  const first = scans.find(({ tick, hits }) =>
    hits.some(hit => Math.abs(apart(crash.kind, crash.o, hit, tick / 100)) < NEAR * header.world_scale));
  if (!first) return crash;
  crash.seen = first.tick;
  crash.away = apart(crash.kind, crash.o, first.from, first.tick / 100);
  crash.known = plans.find(plan => plan.tick === first.tick)?.used_from_tick ?? null;
  if (crash.known > end) crash.known = null;
  return crash;
}

// What the aircraft saw of it, and when.
function sawText({ kind, mine, placed, end, seen, away, known }) {
  if (!kind) return "";
  const before = tick => `${seconds(end - tick)} before`, word = WORDS[kind] || kind;
  return (mine ? `You placed the ${word} ${before(placed)} the crash. ` : "") + (seen === null
    ? `It never saw the ${word}.`
    : `It saw the ${word} ${before(seen)}${mine ? "" : " the crash"}, ${round1(away)} m away, and flew ` + (known === null
      ? "no plan that knew of it." : `a plan that knew of it from ${before(known)}.`));
}

// The tick that the slow motion shows so long after it began [ms].
function slowTick(elapsed, last) {
  return Math.min(last, Math.max(last - LAST, 0) + Math.floor(elapsed / 10 * SLOW));
}

// The orders of a flight for another one, in which the visitor's obstacles of the last seconds are there before them.
// Returns them and the tick from which the other one is worth watching.
function withMine({ orders, ticks }) {
  const from = Math.max(0, ticks.t.length - BACK);
  const early = orders.map(order => order.field && order.tick > from ? { ...order, tick: from } : order);
  return [early.sort((a, b) => a.tick - b.tick), from];
}

// A text in the middle of a point, moved as far as it takes to be inside the picture.
function labelInside(pen, text, u, v, style) {
  const half = pen.measureText(text).width / 2 + 4, width = $("view").clientWidth;
  pen.textAlign = "center";
  label(pen, text, Math.min(Math.max(u, half), width - half), Math.max(v, 16), style);
}

// Shows at the obstacle that ended the flight what was known of it at a tick.
function drawCrash(pen, flight, now, at) {
  const { crash, ticks: T } = flight;
  if (!crash?.kind) return;
  const row = crash.end, [points, half] = spine(crash.kind, crash.o), circle = crash.kind === "circle";
  const [u, v] = at(...(circle ? points[0] : [T.x[row], T.z[row]])), radius = Math.abs(at(0, 0)[1] - at(0, half)[1]);
  const seen = crash.seen !== null && now >= crash.seen, known = crash.known !== null && now >= crash.known;
  const style = seen ? colour.scan : colour.text;
  pen.beginPath(); pen.arc(u, v, (circle ? radius : 8) + 6, 0, 7);
  pen.strokeStyle = style; pen.lineWidth = 2; pen.stroke();
  const text = (now < crash.placed ? "not there yet" : known ? "known to the plan" : seen ? "seen" : "not seen yet") +
    (now < row ? `, ${seconds(row - now)} left` : "");
  pen.font = "bold 14px system-ui, 'DejaVu Sans', sans-serif";
  labelInside(pen, text, u, v - (circle ? radius : 8) - 30, style);
}

// Keeps the visitor's obstacles for *again with my obstacles*, also when the settings change before.
function keepMine() {
  const orders = flight.orders.filter(order => !pending.includes(order));
  if (orders.some(order => order.field)) mine = { orders, ticks: { t: { length: flight.ticks.t.length } } };
}

// The flight once more, with the obstacles of its last seconds there before them.
function againWithMine() {
  keepMine();
  if (!mine) return;
  const [orders, from] = withMine(mine);
  begin(orders, from || null, true);
}

// The last second before a crash.
function showSlowly(time) {
  if (slow === 0) slow = time;
  const end = flight.ticks.t.length - 1;
  now = slowTick(time - slow, end);
  if (now === end) slow = null;
  show(time);
}

// What the first screen says.
function showDuel() {
  const own = flight.orders.some(order => order.field);
  const score = verdict(tally(flight), flight.crash), saw = flight.crash ? sawText(flight.crash) : "";
  // Only what is new is read out.
  if ($("verdict").textContent !== score) $("verdict").textContent = score;
  if ($("saw").textContent !== saw) $("saw").textContent = saw;
  document.title = (own ? score : "Can you stop it?") + " A flight by lidar alone";
  $("slow").hidden = !flight.crash;
  $("mine").disabled = !mine && !own;
  const share = target === null ? "" : `, ${Math.floor(100 * flight.ticks.t.length / target)} %`;
  $("clock").textContent = `${flight.ticks.t[now].toFixed(2)} s, ` +
    (slow !== null ? "slow motion" : target !== null ? "going to the moment" + share : playing ? "flying" : ended ? "ended" : "paused");
  if (!ended && !failed && told < performance.now()) say("");
}
