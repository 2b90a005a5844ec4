// The page that flies: the module asks nobody, and this page shows what it answers.
const columns = ["t", "x", "z", "airspeed", "pitch", "flight_path", "ref_x", "ref_z", "ref_airspeed", "ref_pitch",
  "ref_flight_path", "thrust", "elevator", "wind_x", "wind_z"];
// The fields, each with the number of obstacles that a choice of it brings: more slalom or walls block the way.
const DENSITY = { endless: 40, paper: 20, sealed: 40, forest: 60, canyon: 12, slalom: 10, walls: 6, wires: 40 };
// The settings of a flight, and what a link without them means. `sight` is in per cent of the usual range.
const USUAL = { seed: 1, obstacles: 40, sight: 100, hz: 4, aircraft: "reference", field: "endless", duration: 600 };
// Longest time of a frame that is spent on flying in a hurry [ms], and least time between two looks at numbers.
const HURRY = 12, LOOK = 100;
// How long a refusal is told [ms].
const TOLD = 3000;
// Ticks that the charts show.
const WINDOW = 2000;
const WIND = 1.5, DROPOUTS = 0.3;

// `gauge` is the module once more: it is asked for a lidar's range while `module` holds the flight. `good` are the
// settings of the last flight that began.
let module = null, gauge = null, settings = { ...USUAL }, good = null, flight = null, now = 0;
let failed = false, playing = false, ended = false, target = null, due = 0, last = null, looked = 0, pace = null, told = 0;
let pending = [], planning = [], placeOf = null, heard = false;
// `resume` says whether the flight goes on at the target.
let resume = false;
// What a visitor need not know at first is off.
const look = { follow: true, on: Object.fromEntries(LAYERS.map(([name]) => [name, !["corridor", "reference"].includes(name)])), window: null, hover: null,
  cursor: null, marked: null, note: text => { $("occupancy").textContent = text; } };

// The settings as a scenario file has them. What is usual is left out.
function scenario() {
  const { seed, obstacles, hz, aircraft, field, duration } = settings;
  const asked = { seed, obstacles, replan_hz: hz, duration };
  if (field !== "paper") asked.generator = { name: field };
  if (aircraft !== "reference") asked.aircraft = aircraft;
  if (settings.sight !== 100) {
    const usual = ask({ ask: "begin", scenario: asked }, gauge).header.lidar.range_max;
    asked.lidar = { range_max: usual * settings.sight / 100 };
  }
  return asked;
}

// Begins a flight with these orders, up to a tick if one is given.
function begin(orders = [], until = null, goesOn = false) {
  try {
    take(orders, until);
    resume = goesOn;
  } catch (error) {
    refuse(error);
  }
}

function take(orders, until) {
  const begun = ask({ ask: "begin", scenario: scenario(), orders, details: true });
  good = { ...settings };
  if (flight) keepMine();
  // The listeners of the charts hold this object.
  flight = Object.assign(flight || { id: "", first: 0 }, { header: begun.header, plans: [], orders: [], details: new Map(),
    ticks: Object.fromEntries(columns.map(name => [name, []])), far: undefined, summary: null,
    crash: null });
  if (!heard) { heard = true; hearCharts(flight, look, stir, null); hearView(flight, look, stir, () => placeOf); }
  [now, ended, due, last, planning, pending, drag, target, slow, resume] = [0, false, 0, null, [], [], null, until, null, false];
  for (const id of ["wind", "dropouts", "elevator"]) $(id).checked = false;
  const h = flight.header, count = Object.values(h.field).reduce((sum, kind) => sum + kind.length, 0);
  $("title").textContent = `Seed ${h.seed}, ${count} obstacles, aircraft ${settings.aircraft}`;
  showSettings(begun.aircraft);
  showOrders();
  fly(1);
  setPlaying(until === null);
}

// Draws anew after the pointer moved. While it flies, the next frame does so anyway.
function stir() { if (!playing && target === null && slow === null && !drag) show(); }

// Tells why a flight did not begin. The one before stays as it was; if there is none, the usual one begins.
function refuse(error) {
  settings = { ...(good || USUAL) };
  attempt(() => { if (flight) showSettings(); else take([], null); });
  fail(error);
}

// Does what can fail, and tells if it did. Returns whether it did not.
function attempt(what) {
  try { what(); return true; } catch (error) { fail(error); return false; }
}

// Stands, and tells why until something else is done.
function fail(error) {
  target = null;
  try { setPlaying(false); } catch { /* What is told below came first. */ }
  failed = true;
  say(error.message || String(error), true);
}

// Flies so many ticks, with the orders that wait.
function fly(ticks) {
  if (ended || ticks < 1) return;
  const answer = ask({ ask: "fly", ticks, orders: pending.map(({ tick, ...order }) => order) });
  const first = flight.ticks.t.length;
  for (const name of columns) flight.ticks[name].push(...answer.ticks[name]);
  now = Math.max(flight.ticks.t.length - 1, 0);
  flight.plans.push(...answer.plans);
  for (const detail of answer.details) flight.details.set(detail.tick, detail);
  // Only the newest cycles are drawn.
  for (const tick of flight.details.keys()) if (tick < first - WINDOW) flight.details.delete(tick);
  planning.push(...answer.planning);
  if (pending.length || answer.orders.length) {
    flight.orders = flight.orders.filter(order => !pending.includes(order)).concat(answer.orders);
    pending = [];
    for (const order of answer.orders) showSwitches(order);
    showOrders();
  }
  if (answer.refused.length) {
    say("refused: " + answer.refused.join(", "));
    told = performance.now() + TOLD;
  }
  ended = answer.ended;
  if (ended && !goesOn()) setPlaying(false);
}

// Whether the flight came to the end of an endless field while somebody watched it.
function goesOn() {
  return playing && target === null && settings.field === "endless" && now + 1 >= settings.duration * 100;
}

// Goes on past the end of an endless field: in the field of the next seed, with the switches as they are. The page
// holds one flight at a time, so it can go on for ever.
function goOn() {
  const given = { gusts: $("wind").checked ? WIND : 0, dropouts: $("dropouts").checked ? DROPOUTS : 0,
    elevator_stuck: $("elevator").checked };
  const on = Object.entries(given).filter(([, value]) => value);
  settings.seed++;
  begin(on.map(([name, value]) => ({ tick: 0, order: "disturb", [name]: value })));
}

// Gives an order for the next tick.
function order(given) {
  if (!flight || ended) return;
  const entry = { tick: flight.ticks.t.length, ...given };
  pending.push(entry);
  flight.orders.push(entry);
  showOrders();
  show();
}

function frame(time) {
  requestAnimationFrame(frame);
  if (flight && slow !== null) return showSlowly(time);
  if (!flight || !playing && target === null) return;
  const before = flight.ticks.t.length, since = last === null ? 0 : Math.min(time - last, 250);
  last = time;
  const speed = $("speed").value;
  if (!attempt(() => {
    if (target !== null || speed === "max" && !drag) hurry();
    else {
      due += since / 10 * (drag ? HELD : Number(speed));
      fly(Math.floor(due));
      due -= Math.floor(due);
    }
    if (ended && playing) goOn();
  })) return;
  if (since > 0) {
    const measured = (flight.ticks.t.length - before) * 10 / since;
    pace = pace === null ? measured : pace + 0.05 * (measured - pace);
  }
  if (target === null || time - looked > LOOK) show(time);
}

// Flies for the time of a frame, or up to the target.
function hurry() {
  const begun = performance.now();
  while (!ended && performance.now() - begun < HURRY) {
    const left = target === null ? Infinity : target - flight.ticks.t.length;
    if (left <= 0) break;
    fly(Math.min(25, left));
  }
  if (target !== null && (ended || flight.ticks.t.length >= target)) {
    target = null;
    setPlaying(resume && !ended);
  }
}

function show(time = null) {
  if (!flight || !flight.ticks.t.length) return;
  look.follow = $("follow").checked;
  placeOf = drawView(flight, now, look);
  const view = $("view"), pen = view.getContext("2d");
  drawCrash(pen, flight, now, pointOf);
  drawPointer(pen, view.clientWidth, view.clientHeight);
  if (time !== null && time - looked < LOOK) return;
  looked = time ?? looked;
  showDuel();
  if ($("drawer").open) showNumbers();
}

// What the drawer shows at the present time.
function showNumbers() {
  const T = flight.ticks, cost = planning.slice(-50).sort((a, b) => a - b);
  const number = value => value.toFixed(1) + " ms";
  showValues(flight, now, [
    ["wind", `${T.wind_x[now].toFixed(1)}, ${T.wind_z[now].toFixed(1)} m/s`],
    ["cycle time", cost.length ? number(planning[planning.length - 1]) : "-"],
    ["cycle median", cost.length ? number(cost[cost.length >> 1]) : "-"],
    ["pace", pace === null ? "-" : pace.toFixed(1) + " x"]]);
  showWhy(flight, now, look, stir);
  look.window = [Math.max(0, now - WINDOW), Math.max(now, 1)];
  drawCharts(flight, now, look);
}

function say(text, over = false) {
  $("state").textContent = text;
  $("state").className = over ? "over" : "";
}

// Hash and outcome of the flight so far. They cost time, so they are shown while the flight stands.
function showLog() {
  const { hash, summary } = ask({ ask: "log" });
  const first = ended && !flight.summary;
  if (ended) flight.summary = summary;
  if (first) {
    flight.crash = crashOf(flight);
    if (flight.crash && !matchMedia("(prefers-reduced-motion: reduce)").matches) slow = 0;
  }
  $("hash").textContent = hash;
  if (ended) say(`${summary.outcome.replace(/-/g, " ")} after ${summary.t_end.toFixed(2)} s and ` +
    `${summary.x_end.toFixed(0)} m`, summary.outcome !== "survived");
  history.replaceState(null, "", fragment());
  $("link").href = fragment();
}

function setPlaying(value) {
  playing = value;
  failed = false;
  last = pace = null;
  $("play").textContent = playing ? "Pause" : ended ? "Fly again" : "Play";
  $("step").disabled = $("next").disabled = $("ahead").hidden = ended;
  if (!flight) return;
  if (playing) $("hash").textContent = "shown while the flight stands";
  else if (target === null) showLog();
  show();
}

function toNextPlan() {
  if (playing) setPlaying(false);
  const plans = flight.plans.length;
  for (let tick = 0; tick < 1000 && !ended && flight.plans.length === plans; tick++) fly(1);
  if (!ended) setPlaying(false);
}

function showSettings(names) {
  const options = (id, all) => $(id).replaceChildren(...all.map(name => new Option(name)));
  if (!$("aircraft").length) { options("aircraft", names); options("field", Object.keys(DENSITY)); }
  for (const id of ["obstacles", "sight", "hz", "aircraft", "field", "seed"]) $(id).value = settings[id];
  showRanges();
}

function showRanges() {
  document.querySelector("output[for=obstacles]").value = $("obstacles").value;
  document.querySelector("output[for=sight]").value = $("sight").value + " %";
}

function showSwitches(given) {
  if (given.gusts !== undefined) $("wind").checked = given.gusts > 0;
  if (given.dropouts !== undefined) $("dropouts").checked = given.dropouts > 0;
  if (given.elevator_stuck !== undefined) $("elevator").checked = given.elevator_stuck;
}

function showOrders() {
  $("orders").replaceChildren(...flight.orders.slice(-6).map(given => {
    const item = document.createElement("li");
    item.textContent = orderText(given);
    return item;
  }));
}

$("wind").onchange = event => order({ order: "disturb", gusts: event.target.checked ? WIND : 0 });
$("dropouts").onchange = event => order({ order: "disturb", dropouts: event.target.checked ? DROPOUTS : 0 });
$("elevator").onchange = event => order({ order: "disturb", elevator_stuck: event.target.checked });
for (const id of ["obstacles", "sight", "hz", "seed"])
  $(id).onchange = event => { settings[id] = Number(event.target.value); begin(); };
$("aircraft").onchange = event => { settings.aircraft = event.target.value; begin(); };
$("field").onchange = event => {
  settings.field = event.target.value;
  settings.obstacles = DENSITY[settings.field];
  begin();
};
for (const id of ["obstacles", "sight"]) $(id).oninput = showRanges;
const steer = what => () => { if (flight) attempt(what); };
$("play").onclick = steer(() => ended ? begin() : setPlaying(!playing));
$("step").onclick = steer(() => { playing = false; fly(1); setPlaying(false); });
$("next").onclick = steer(toNextPlan);
$("again").onclick = () => begin();
$("other").onclick = () => { settings.seed++; begin(); };
$("slow").onclick = () => { slow = 0; };
$("mine").onclick = againWithMine;
$("ahead").onclick = steer(placeAhead);
$("copy").onclick = steer(copyLink);
$("drawer").ontoggle = () => { if (flight) show(); };
$("follow").onchange = () => show();
$("speed").onchange = () => { due = 0; pace = null; };
$("save").onclick = event => {
  const made = attempt(() => {
    const url = URL.createObjectURL(new Blob([askBytes({ ask: "bytes" })], { type: "application/json" }));
    event.target.download = `flight-seed${settings.seed}-web.json`;
    event.target.href = url;
    // By then the browser has it.
    setTimeout(() => URL.revokeObjectURL(url), 10000);
  });
  if (!made) event.preventDefault();
};
addEventListener("resize", () => show());
addEventListener("hashchange", fromLink);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { readColours(); show(); });
addEventListener("keydown", event => {
  if (!flight || event.ctrlKey || event.metaKey || event.altKey || ["SELECT", "INPUT"].includes(event.target.tagName) && event.target.type !== "checkbox") return;
  const buttons = { " ": "play", ".": "step", "]": "next", r: "again", n: "other", w: "wind", d: "dropouts",
    e: "elevator", f: "follow", o: "ahead", m: "mine", c: "copy", l: "slow" };
  // The space key presses what has the focus.
  if (event.key === " " && ["BUTTON", "INPUT", "SUMMARY"].includes(event.target.tagName)) return;
  const layer = LAYERS[Number(event.key) - 1], id = buttons[event.key] || layer && "layer-" + layer[0];
  if (!id) return;
  $(id).click();
  event.preventDefault();
});

// Unpacks the module and begins.
async function start(packed) {
  readColours();
  addLayers(look.on, () => show());
  // Nothing can be steered before it flies.
  document.body.inert = true;
  try {
    const made = await unpack(packed), given = { env: { clock: () => performance.now() } };
    module = made.instance.exports;
    gauge = (await WebAssembly.instantiate(made.module, given)).exports;
  } catch (error) {
    return fail(new Error("this browser cannot run the flight: " + error.message));
  }
  fromLink();
  document.body.inert = false;
  requestAnimationFrame(frame);
}
