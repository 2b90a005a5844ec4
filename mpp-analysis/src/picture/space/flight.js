// A flight in space as the page knows it: what was flown, what was seen, and what came of it.
// Side of the cells in which trunks are found again [m], and how near a beam ends to the bark that it hit [m].
const CELL = 4, HIT = 0.25;
const cellOf = (x, y) => Math.floor(x / CELL) * 4096 + Math.floor(y / CELL);

// A trunk: `mine` is the tick at which the visitor planted it, `seen` that at which a beam first hit it, `away` the
// distance then. `crown` is a number of its own within 1.
function addTrunk(flight, [x, y, r, top = null], mine = null) {
  const trunk = { x, y, r, top: top ?? Infinity, mine, seen: null, away: null, met: mine || 0, nearest: Infinity, passed: false,
    crown: (Math.abs(x * 7.31 + y * 3.77) * 10) % 1 };
  flight.trunks.push(trunk);
  const key = cellOf(x, y);
  if (!flight.cells.has(key)) flight.cells.set(key, []);
  flight.cells.get(key).push(trunk);
  return trunk;
}

// The height of the ground at a place, from a height map.
function heightsOf({ corner, cell, rows }) {
  const place = (value, count) => { const at = Math.max(0, Math.min(count - 1.001, value)), low = Math.floor(at); return [low, at - low]; };
  return (x, y) => {
    const [column, a] = place((x - corner[0]) / cell, rows[0].length), [row, b] = place((y - corner[1]) / cell, rows.length);
    const along = row => rows[row][column] * (1 - a) + rows[row][column + 1] * a;
    return along(row) * (1 - b) + along(row + 1) * b;
  };
}

function newFlight({ header, trunks, span, state, bodies = [], terrain = null }) {
  const lowest = terrain ? terrain.rows.reduce((least, row) => Math.min(least, ...row), Infinity) : 0;
  const flight = { header, span, bodies, heightAt: terrain && heightsOf(terrain), lowest, trunks: [], cells: new Map(), states: [state], cycles: [], orders: [], planning: [],
    ended: false, summary: null, hash: null, crash: null, ticks: { t: { length: 0 } } };
  for (const trunk of trunks) addTrunk(flight, trunk);
  return flight;
}

// Takes what the worker has flown.
function takeNews(flight, { states, cycles, orders, planning, ended }) {
  for (const { tick, x, y, radius } of orders) addTrunk(flight, [x, y, radius], tick);
  flight.orders.push(...orders);
  flight.states.push(...states);
  flight.planning.push(...planning);
  for (const cycle of cycles) {
    cycle.hits = Float32Array.from(cycle.hits, value => value / 100);
    cycle.paths = cycle.paths.map(path => path.map(knot => knot.map(value => value / 100)));
    flight.cycles.push(cycle);
    notice(flight, cycle);
  }
  flight.ended = ended;
}

// Marks the trunks that a sweep has hit.
function notice(flight, { tick, hits }) {
  const [here] = flight.states[tick];
  for (let at = 0; at < hits.length; at += 3) {
    const x = hits[at], y = hits[at + 1];
    if (hits[at + 2] < 0.2) continue;
    for (let column = -1; column <= 1; column++) for (let row = -1; row <= 1; row++)
      for (const trunk of flight.cells.get(cellOf(x + column * HIT * 3, y + row * HIT * 3)) || []) {
        if (trunk.seen !== null || trunk.mine > tick || Math.abs(Math.hypot(trunk.x - x, trunk.y - y) - trunk.r) > HIT) continue;
        trunk.seen = tick;
        trunk.away = Math.hypot(trunk.x - here[0], trunk.y - here[1]) - trunk.r;
      }
  }
}

// A direction of the body (ahead, right, down) in the world (ahead, right, up).
function turned([w, x, y, z], [a, b, c]) {
  const p = 2 * (y * c - z * b), q = 2 * (z * a - x * c), r = 2 * (x * b - y * a);
  return [a + w * p + y * r - z * q, b + w * q + z * p - x * r, -(c + w * r + x * q - y * p)];
}

// The state at a tick, which need not be whole.
function stateAt({ states }, tick) {
  const first = Math.max(0, Math.min(states.length - 1, Math.floor(tick))), next = Math.min(states.length - 1, first + 1);
  const [p, q, airspeed, gap] = states[first], [p2, q2, airspeed2, gap2] = states[next], share = Math.min(1, Math.max(0, tick - first));
  const mix = (a, b) => a + share * (b - a), same = q.reduce((sum, part, i) => sum + part * q2[i], 0) < 0 ? -1 : 1;
  const turn = q.map((part, i) => mix(part, same * q2[i])), length = Math.hypot(...turn);
  const attitude = turn.map(part => part / length);
  const right = turned(attitude, [0, 1, 0]), up = turned(attitude, [0, 0, -1]);
  return { at: p.map((part, i) => mix(part, p2[i])), attitude, right, up, ahead: turned(attitude, [1, 0, 0]),
    airspeed: mix(airspeed, airspeed2), gap: mix(gap, gap2), bank: Math.atan2(-right[2], up[2]) };
}

// The newest of the cycles that satisfy something that once true stays true.
function newest(cycles, tick, of) {
  for (let at = cycles.length - 1; at >= 0; at--) if (of(cycles[at]) <= tick) return cycles[at];
  return null;
}

// Distance of wing and fuselage from the bark of a trunk, which is higher than anything flies [m].
function apart(flight, [p, attitude], { x, y, r }) {
  const half = direction => {
    const [a, b] = turned(attitude, direction), u = x - p[0], v = y - p[1];
    const share = Math.max(-1, Math.min(1, (u * a + v * b) / (a * a + b * b || 1)));
    return Math.hypot(u - share * a, v - share * b);
  };
  return Math.min(half([0, flight.span / 2, 0]), half([flight.span * 0.4, 0, 0]) - 0.08) - r;
}

// Counts the visitor's trunks up to a tick: how many, how many the aircraft has passed, and the least distance to these [m].
function tally(flight, tick) {
  const sum = { placed: 0, passed: 0, nearest: Infinity };
  for (const trunk of flight.trunks) {
    if (trunk.mine === null || trunk.mine > tick) continue;
    for (; !trunk.passed && trunk.met <= tick; trunk.met++) {
      trunk.nearest = Math.min(trunk.nearest, apart(flight, flight.states[trunk.met], trunk));
      trunk.passed = flight.states[trunk.met][0][0] > trunk.x + flight.span;
    }
    sum.placed++;
    if (!trunk.passed) continue;
    sum.passed++;
    sum.nearest = Math.min(sum.nearest, trunk.nearest);
  }
  return sum;
}

// The trunk that a lost flight hit; null where it hit the ground or nothing.
function crashOf(flight) {
  if (flight.summary.outcome !== "collision") return null;
  const state = flight.states[flight.states.length - 1];
  let [hit, least] = [null, state[0][2]];
  for (const trunk of flight.trunks) {
    const distance = apart(flight, state, trunk);
    if (distance < least) [hit, least] = [trunk, distance];
  }
  return hit;
}

const meters = (value, digits = 0) => value.toFixed(digits) + " m";
const seconds = ticks => (ticks / 100).toFixed(1) + " s";

// The line on top.
function verdict(flight, tick) {
  const { placed, passed, nearest } = tally(flight, tick), { summary, crash } = flight;
  const score = `You planted ${placed}, it passed ${passed}` + (passed ? `, nearest ${meters(Math.max(0, nearest), 1)}.` : ".");
  if (!summary) return placed ? score : "It has never seen this forest.";
  const said = { survived: "Through.", collision: !crash ? "It hit the ground." : crash.mine === null ? "It hit a tree." : "You got it!" };
  return (said[summary.outcome] || "It did not arrive.") + (placed ? " " + score : "");
}

// What came of a flight that has ended, in a sentence or two.
function account({ summary, crash, states }) {
  const way = `${meters(summary.x_end)} in ${summary.t_end.toFixed(1)} s`, end = states.length - 1;
  if (summary.outcome === "survived") return `${way}, nearest ${meters(summary.min_clearance ?? 5, 2)}.`;
  if (summary.outcome !== "collision") return `${way}; ${summary.outcome.replace(/-/g, " ")}.`;
  if (!crash) return `After ${way}.`;
  return `After ${way}. ` + (crash.mine === null ? "" : `You planted it ${seconds(end - crash.mine)} before. `) +
    (crash.seen === null ? "No beam had hit this tree." : `It saw this tree ${seconds(end - crash.seen)} before, ${meters(crash.away)} away.`);
}
