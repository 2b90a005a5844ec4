// The page that flies through forests: the worker flies a little ahead of the picture, and each forest is followed by the next.
// The settings of a flight, and what a link without them means: trunks/m^2, m/s, m/s from the left, m/s, a name, m.
const USUAL = { seed: 2, density: 0.04, speed: 12, wind: 0, gusts: 0, lidar: "grid-90x16", sight: 45 };
// Ticks that the worker is ahead of the picture, ticks of a question, and of one in a hurry to the moment of a link.
const LEAD = 25, STEP = 10, HURRY = 100;
// What a click plants is so far away at most [m], and the button's tree so far ahead of the aircraft [s].
const REACH = 60, SOON = 2;
// The last ticks before a crash are shown again at this share of real time; how long an end is shown [ms]; how long a word is told [ms].
const LAST = 120, SLOW = 0.3, PATIENCE = 7000, TOLD = 3000, LOOK = 100;
// Mean time of a frame beyond which fewer pixels must do [ms].
const SLUGGISH = 40;

let settings = { ...USUAL }, good = null, flight = null, shown = 0, playing = false, busy = false, turn = 0, until = null;
let pending = [], kept = null, camera = null, placeOnMap = null, last = null, looked = 0, told = 0, slow = false, done = false, next = null, pace = 1;
let crossed = 0, crashed = 0, painted = null;
// How many panels beside the scene are to be painted, one a frame: the map and the instruments take turns.
let panels = 0, mapNext = false;
// `sharpest` is the most pixels of the scene in one of the page: fewer where frames take long.
const look = { around: 0, ghost: null, sharpest: 2 };
let gaps = 0;
const still = matchMedia("(prefers-reduced-motion: reduce)");

// As a scenario file has them. What is not there is left out, as on the command line.
const scenario = () => ({ seed: settings.seed, density: settings.density, airspeed: settings.speed,
  wind: settings.wind ? [0, settings.wind, 0] : undefined, gusts: settings.gusts || undefined,
  lidar: settings.lidar === USUAL.lidar ? undefined : settings.lidar,
  sight: settings.sight === USUAL.sight ? undefined : settings.sight });

function command() {
  const { seed, density, speed, wind, gusts, lidar, sight } = settings;
  return `sil-harness fly --preset space --seed ${seed} --density ${density} --airspeed ${speed}` + (wind ? ` --wind 0,${wind},0` : "") +
    (gusts ? ` --gusts ${gusts}` : "") + (lidar === USUAL.lidar ? "" : ` --lidar ${lidar}`) +
    (sight === USUAL.sight ? "" : ` --sight ${sight}`) + (flight.orders.length ? " --orders LOG" : "");
}

// Begins a flight with these orders, and stands at a tick if one is given.
async function begin(orders = [], stop = null) {
  const own = ++turn;
  try {
    const begun = await inquire({ ask: "begin", scenario: scenario(), orders });
    if (own !== turn) return;
    keepMine();
    good = { ...settings };
    flight = newFlight(begun);
    [shown, busy, until, pending, last, slow, done, next, pace] = [0, false, stop, [], null, false, false, null, 1];
    look.ghost = null;
    $("end").hidden = true; $("head").hidden = false;
    $("about").textContent = `A fixed wing, ${settings.speed} m/s, no map: it knows only what its lidar has hit.`;
    $("mine").hidden = !kept;
    document.title = `Forest ${settings.seed}, flown by lidar alone`;
    showSettings();
    setPlaying(stop === null && !still.matches);
    feed();
  } catch (error) {
    if (own === turn) refuse(error);
  }
}

// Tells why a flight did not begin. The one before stays as it was; if there is none, the usual one begins.
function refuse(error) {
  settings = { ...(good || USUAL) };
  if (flight) showSettings(); else begin();
  tell(error.message || String(error), true);
}

function say(text, over = false) {
  $("state").textContent = text;
  $("state").className = over ? "over" : "";
}

function tell(text, over = false) {
  say(text, over);
  told = performance.now() + TOLD;
}

// Asks for the next ticks if the picture needs them. Answers come one after the other.
async function feed() {
  const head = flight.states.length - 1, hurries = until !== null && head < until;
  if (busy || flight.ended || !hurries && !pending.length && (!playing || head >= shown + LEAD)) return;
  const own = turn, ticks = hurries ? Math.min(HURRY, until - head) : STEP, orders = pending.map(({ tick, ...order }) => order);
  pending = [];
  busy = true;
  try {
    const news = await inquire({ ask: "fly", ticks: orders.length && !playing ? 1 : ticks, orders });
    if (own !== turn) return;
    takeNews(flight, news);
    if (news.refused.length) tell("Not planted: the aircraft is there.", true);
    if (until !== null && (flight.ended || flight.states.length - 1 >= until)) { until = null; shown = flight.states.length - 1; }
    else if (until !== null) say(`going to the moment: ${Math.round(100 * (flight.states.length - 1) / until)} %`);
    busy = false;
    if (!playing && until === null) stand(own);
  } catch (error) {
    if (own === turn) tell(error.message || String(error), true);
  }
  busy = false;
  if (own === turn && flight) feed();
}

// Hash and summary of the log so far.
async function stand(own) {
  const { hash, summary } = await inquire({ ask: "log" });
  if (own !== turn) return;
  flight.hash = hash;
  if (flight.ended) { flight.summary = summary; flight.crash = crashOf(flight); }
  showLog();
}

function showLog() {
  flight.ticks.t.length = flight.states.length - 1;
  history.replaceState(null, "", fragment(flight.ended));
  $("link").href = location.hash || "#";
  $("hash").textContent = flight.hash || "-";
  $("command").textContent = command();
  $("log").textContent = flight.hash ? `Log hash after ${seconds(flight.states.length - 1)}: ${flight.hash}` : "";
}

// What the flight has become is shown: its end, after the last moments of a crash once more.
async function finish() {
  if (done) return;
  done = true;
  const own = turn;
  await stand(own);
  if (own !== turn) return;
  if (flight.summary.outcome === "survived") crossed++; else crashed++;
  if (flight.summary.outcome === "collision" && playing && !still.matches) { slow = true; shown = Math.max(0, flight.states.length - 1 - LAST); }
  else showEnd();
}

function showEnd() {
  slow = false;
  const { outcome } = flight.summary;
  $("outcome").textContent = verdict(flight, flight.states.length - 1);
  $("account").textContent = account(flight) + (crossed + crashed > 1 ? ` ${crossed} of ${crossed + crashed} forests so far.` : "");
  $("end").className = isGood(outcome) ? "glass" : "glass over";
  $("end").hidden = false; $("head").hidden = true;
  $("play").textContent = playing ? "Pause" : "Fly again";
  next = playing && !still.matches ? performance.now() + PATIENCE : null;
  $("stay").hidden = next === null;
  $("wait").textContent = "";
}

function setPlaying(value) {
  playing = value;
  $("play").textContent = playing ? "Pause" : done ? "Fly again" : "Play";
  if (!flight) return;
  if (!playing) next = null;
  if (!playing && !busy && until === null) { shown = flight.states.length - 1; stand(turn); }
}

function frame(time) {
  requestAnimationFrame(frame);
  if (!flight) return;
  const since = last === null ? 0 : Math.min(time - last, 100), head = flight.states.length - 1;
  last = time;
  const before = shown;
  gaps += 0.05 * (since - gaps);
  if (gaps > SLUGGISH) { look.sharpest = Math.max(1, look.sharpest - 0.5); gaps = 0; }
  if (until === null && (playing || slow)) {
    shown = Math.min(head, shown + since / 10 * (slow ? SLOW : 1));
    if (since > 0 && !slow && !done) pace += 0.03 * ((shown - before) * 10 / since - pace);
  } else if (until === null) shown = head;
  if (flight.ended && shown >= head && until === null) { if (slow) showEnd(); else finish(); }
  if (next !== null && time > next) return nextForest();
  feed();
  show(time);
}

function show(time) {
  // What stands still is not painted again: the flight's worker needs the processor more.
  const { ghost } = look, size = [innerWidth, innerHeight, devicePixelRatio], picture = [turn, shown, flight.trunks.length, flight.cycles.length, !!flight.crash, look.around,
    look.sharpest, ghost && [ghost.x, ghost.y], colour.ground, size].join();
  if (picture !== painted) {
    painted = picture;
    camera = drawScene(flight, shown, look).camera;
    panels = 2;
  }
  if (panels > 0) {
    panels--;
    mapNext = !mapNext;
    if (mapNext) placeOnMap = drawMap(flight, shown, look);
    else { drawSide(flight, shown); drawAttitude(flight, shown); }
  }
  if (time - looked < LOOK) return;
  looked = time;
  const state = stateAt(flight, shown), unit = { airspeed: `${state.airspeed.toFixed(1)} m/s`, height: meters(state.at[2], 1),
    bank: `${Math.round(Math.abs(degrees(state.bank)))}° ${state.bank > 0.02 ? "R" : state.bank < -0.02 ? "L" : ""}`,
    gap: state.gap >= 5 ? "over 5 m" : meters(Math.max(0, state.gap), 1), flown: meters(state.at[0]) };
  for (const [name, text] of Object.entries(unit)) $("v-" + name).textContent = text;
  const score = slow ? `Once more, slowly: ${seconds(flight.states.length - 1 - shown)} left` : verdict(flight, shown);
  // Only what is new is read out.
  if ($("verdict").textContent !== score) $("verdict").textContent = score;
  if (next !== null) $("wait").textContent = `in ${Math.ceil((next - time) / 1000)} s`;
  if (performance.now() > told && until === null)
    say(`forest ${settings.seed}, ${flight.trunks.length} trunks, ${(shown / 100).toFixed(1)} s` + (playing && pace < 0.9 && !done ? `, ${pace.toFixed(1)} x real time` : ""));
}

function showSettings() {
  for (const name of Object.keys(USUAL)) $(name).value = settings[name];
  showRanges();
}

function showRanges() {
  const text = { density: `${$("density").value} /m²`, speed: `${$("speed").value} m/s`, gusts: `${$("gusts").value} m/s`,
    wind: Number($("wind").value) ? `${Math.abs($("wind").value)} m/s from ${$("wind").value > 0 ? "left" : "right"}` : "none",
    sight: Number($("sight").value) < USUAL.sight ? `${$("sight").value} m` : flight ? `all of ${flight.header.lidar.range_max} m` : "" };
  for (const [name, words] of Object.entries(text)) document.querySelector(`output[for=${name}]`).value = words;
}

function nextForest() { next = null; settings.seed++; begin(); }

// Keeps the visitor's trees of the flight that goes.
function keepMine() { if (flight?.orders.length) kept = flight.orders; }

// The same forest, in which all trees of the visitor stand from the start.
function againWithMine() {
  keepMine();
  if (kept) begin(kept.map(order => ({ ...order, tick: 0 })));
}

// Plants a tree at a place, to the centimetre.
function plant([x, y]) {
  if (!flight || flight.ended) return;
  pending.push({ order: "trunk", x: Math.round(x * 100) / 100, y: Math.round(y * 100) / 100, radius: RADIUS });
  feed();
}

// A tree on the plan: for those who have no pointer.
function plantAhead() {
  if (!flight || flight.ended) return;
  const plan = newest(flight.cycles, shown, cycle => cycle.due), { at, airspeed } = stateAt(flight, shown), course = courseAt(flight, shown);
  const places = plan?.paths.length ? placesOf(plan.paths[plan.paths.length - 1], plan.begins, shown) : [];
  const place = places.find(([x, y]) => Math.hypot(x - at[0], y - at[1]) > SOON * airspeed);
  plant(place || [at[0] + SOON * airspeed * Math.cos(course), at[1] + SOON * airspeed * Math.sin(course)]);
}

function hear(id, place) {
  const point = event => { const box = $(id).getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
  let held = null;
  $(id).addEventListener("pointerdown", event => { if (!event.button) held = { from: point(event), around: look.around, moved: false }; });
  $(id).addEventListener("pointermove", event => {
    const [u, v] = point(event);
    if (held && id === "view" && Math.abs(u - held.from[0]) > 12) { held.moved = true; $(id).setPointerCapture(event.pointerId); }
    if (held?.moved) { look.around = Math.max(-2.5, Math.min(2.5, (u - held.from[0]) / 250)); look.ghost = null; return; }
    const [x, y] = event.pointerType === "mouse" && flight && !flight.ended ? place([u, v]) || [] : [];
    look.ghost = x === undefined ? null : { x, y };
  });
  $(id).addEventListener("pointerleave", () => { look.ghost = null; });
  $(id).addEventListener("pointercancel", () => { held = null; look.around = 0; });
  $(id).addEventListener("pointerup", event => {
    const moved = held?.moved, known = held;
    held = null;
    look.around = 0;
    if (!known || moved) return;
    const there = place(point(event));
    if (there) plant(there);
  });
}

hear("view", ([u, v]) => camera && camera.ground(u, v, REACH));
hear("map", ([u, v]) => placeOnMap && placeOnMap(u, v));
for (const name of Object.keys(USUAL)) $(name).onchange = ({ target: { value } }) => { settings[name] = typeof USUAL[name] === "number" ? Number(value) : value; begin(); };
for (const name of ["density", "speed", "wind", "gusts", "sight"]) $(name).oninput = showRanges;
$("play").onclick = () => done && !playing && !slow ? begin() : setPlaying(!playing);
$("ahead").onclick = plantAhead;
$("other").onclick = $("next").onclick = nextForest;
$("again").onclick = () => begin();
$("mine").onclick = againWithMine;
$("stay").onclick = () => { next = null; $("stay").hidden = true; $("wait").textContent = ""; };
$("copy").onclick = copyLink;
$("save").onclick = async event => {
  if ($("save").download) return;
  event.preventDefault();
  const bytes = await inquire({ ask: "bytes" }), url = URL.createObjectURL(new Blob([bytes], { type: "application/json" }));
  Object.assign($("save"), { href: url, download: `forest-seed${settings.seed}.json` });
  $("save").click();
  $("save").removeAttribute("download"); $("save").href = "#";
  // By then the browser has it.
  setTimeout(() => URL.revokeObjectURL(url), 10000);
};
addEventListener("hashchange", fromLink);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { readColours(); readPaint(); });
addEventListener("keydown", event => {
  if (!flight || event.ctrlKey || event.metaKey || event.altKey || ["INPUT", "SELECT"].includes(event.target.tagName)) return;
  if (event.key === "Escape") $("drawer").open = false;
  const id = { " ": "play", t: "ahead", n: "other", r: "again", m: "mine", c: "copy" }[event.key];
  // The space key presses what has the focus.
  if (!id || event.key === " " && ["BUTTON", "SUMMARY"].includes(event.target.tagName)) return;
  $(id).click();
  event.preventDefault();
});

// Unpacks the module in the worker and begins.
async function start(packed) {
  readColours();
  readPaint();
  document.body.inert = true;
  try {
    hire();
    await send({ packed });
  } catch (error) {
    return say("this browser cannot run the flight: " + error.message, true);
  }
  fromLink();
  document.body.inert = false;
  requestAnimationFrame(frame);
}
