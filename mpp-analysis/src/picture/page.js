// The page of flights that were flown, or of one that is watched while it is flown.
const DATA = /*DATA*/null;
const live = DATA === null, TOKEN = "/*TOKEN*/";
const columns = ["t", "x", "z", "airspeed", "pitch", "flight_path", "ref_x", "ref_z", "ref_airspeed", "ref_pitch",
  "ref_flight_path", "thrust", "elevator"];
// How much a live page keeps: so many ticks, and the newest cycles. What is older is dropped.
let kept = 60_000, keptCycles = 600;
// What both flights share: layers, the window of the charts, the tick under the pointer, the last tick of all.
const look = { follow: true, on: Object.fromEntries(LAYERS.map(([name]) => [name, true])), window: null, hover: null, last: 0,
  note: text => { $("occupancy").textContent = text; } };
const flights = [];
look.together = flights;
let now = 0, playing = live, speed = 1, started = null, changed = false;

function addFlight(parts) {
  const flight = { id: flights.length ? "-b" : "", header: null, plans: [], orders: [], summary: null, closest: null, first: 0,
    details: new Map(), ticks: Object.fromEntries(columns.map(name => [name, []])), ...parts };
  // The pointer in one view says nothing about the other.
  flight.look = Object.assign(Object.create(look), { cursor: null, marked: null, tick: 0 });
  if (flights.length) {
    const other = $("flight").cloneNode(true);
    for (const element of [other, ...other.querySelectorAll("[id]")]) element.id += flight.id;
    $("flights").append(other);
    document.body.classList.add("two");
  }
  flights.push(flight);
  const redraw = () => { changed = true; };
  hearCharts(flight, look, redraw, go);
  hearStrip(flight, look, redraw, go);
  hearView(flight, flight.look, redraw, () => flight.place);
}

// The packed flights: columns are whole multiples of a unit, each as its step from the one before.
async function unpack(text) {
  const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  for (const { ticks, details, ...rest } of await new Response(stream).json()) {
    const T = Object.fromEntries(Object.entries(ticks).map(([name, [unit, steps]]) => {
      let sum = 0;
      return [name, steps.map(step => step === null ? null : (sum += step) * unit)];
    }));
    T.t = T.x.map((_, tick) => tick / 100);
    addFlight({ ...rest, ticks: T, details: new Map(details.map(detail => [detail.tick, detail])) });
  }
}

const begins = () => flights[0].first;
const ends = () => Math.max(...flights.map(lastTick));

function show() {
  if (!flights.length || !flights[0].ticks.t.length) return;
  look.last = flights.length > 1 ? ends() : 0;
  now = Math.min(Math.max(now, begins()), ends());
  $("time").min = begins();
  $("time").max = ends();
  $("time").value = now;
  $("clock").value = (now / 100).toFixed(2) + " s";
  $("link").textContent = "#t=" + (now / 100).toFixed(2);
  $("link").href = $("link").textContent;
  look.follow = $("follow").checked;
  // While it plays, the window of the charts goes along.
  if (look.window && playing && (now < look.window[0] || now > look.window[1])) {
    const span = look.window[1] - look.window[0], start = Math.max(begins(), Math.min(now, ends() - span));
    look.window = [start, start + span];
  }
  for (const flight of flights) {
    const tick = flight.look.tick = Math.min(now, lastTick(flight));
    showValues(flight, tick);
    showWhy(flight, tick, flight.look, () => { changed = true; });
    flight.place = drawView(flight, tick, flight.look);
    drawCharts(flight, tick, look);
    drawStrip(flight, tick, look);
  }
}

// A flight in a sentence, with its outcome in colour.
function title(flight) {
  const h = flight.header, s = flight.summary, heading = $("title" + flight.id);
  const obstacles = Object.values(h.field).reduce((count, kind) => count + kind.length, 0);
  const word = (text, kind) => Object.assign(document.createElement(kind), { textContent: text });
  heading.replaceChildren(`${h.aircraft.name}, seed ${h.seed}, preset ${h.preset}, ${obstacles} obstacles`);
  if (s) {
    const outcome = word(s.outcome.replace(/-/g, " "), "span");
    outcome.className = isGood(s.outcome) ? "good" : "bad";
    const totals = `clearance ${s.min_clearance === null ? "none" : s.min_clearance.toFixed(2) + " m"}, ${s.replans} replans, ` +
      `${s.candidates} candidates, ${s.feasible} feasible` + (flight.hash ? `, log ${flight.hash}` : "");
    heading.append(": ", outcome, ` after ${s.t_end.toFixed(2)} s `, word(totals, "small"));
  }
  document.title = heading.textContent;
  if (flights.length > 1 && flights.every(one => one.header)) {
    const found = differences(...flights.map(one => one.header)), more = found.length > 6 ? `, and ${found.length - 6} more` : "";
    $("differ").textContent = found.length ? `${found.slice(0, 6).join(", ")}${more}` : "Two flights of one scenario";
    document.title = $("differ").textContent;
  }
  $("orders" + flight.id).replaceChildren(...flight.orders.map(order => {
    const item = document.createElement("li");
    item.textContent = orderText(order);
    return item;
  }));
}

function setPlaying(value) {
  playing = value;
  started = null;
  $("play").textContent = playing ? "Pause" : "Play";
  if (!live && !playing) history.replaceState(null, "", "#t=" + (now / 100).toFixed(2));
}

// A live flight is asked; its server then tells every page.
function press() {
  if (live) control({ pause: playing ? 1 : 0 });
  else setPlaying(!playing);
}

function go(tick) { now = tick; started = null; if (!live && playing) setPlaying(false); show(); }

function toPlan(direction) {
  const starts = flights[0].plans.map(plan => plan.used_from_tick).filter(tick => tick !== null);
  const next = direction > 0 ? starts.find(tick => tick > now) : starts.filter(tick => tick < now).pop();
  if (next !== undefined) go(next);
}

function frame(time) {
  if (changed) { changed = false; show(); }
  if (playing && !live) {
    if (started === null) started = { time, now: now === ends() ? 0 : now };
    now = Math.min(Math.round(started.now + (time - started.time) / 10 * speed), ends());
    show();
    if (now === ends()) setPlaying(false);
  }
  requestAnimationFrame(frame);
}

function control(values) {
  fetch("/control?" + new URLSearchParams(values), { method: "POST", headers: { "X-Token": TOKEN } }).catch(() => {});
}

function fromHash() {
  const match = /^#t=([\d.]+)$/.exec(location.hash);
  if (match) { now = Math.round(parseFloat(match[1]) * 100); show(); }
}

// Zooms the charts about the time that is shown.
function zoom(factor) {
  const flight = flights[0], all = wholeFlight(flight, look);
  look.window = factor === Infinity ? null : zoomed(shownTicks(flight, look), all, now, factor);
  show();
}

addLayers(look.on, show);
const speeds = live ? [["0.25", "0.25 x"], ["1", "real time"], ["4", "4 x"], ["max", "as fast as possible"]]
  : [["0.1", "0.1 x"], ["0.25", "0.25 x"], ["1", "real time"], ["4", "4 x"]];
for (const [value, text] of speeds) $("speed").append(new Option(text, value, false, value === "1"));
$("speed").onchange = event => { if (live) control({ speed: event.target.value }); else { speed = Number(event.target.value); started = null; } };
$("time").oninput = event => go(Number(event.target.value));
$("play").onclick = press;
$("back").onclick = () => toPlan(-1);
$("next").onclick = () => toPlan(1);
$("follow").onchange = show;
$("zoom-in").onclick = () => zoom(0.5);
$("zoom-out").onclick = () => zoom(2);
$("zoom-all").onclick = () => zoom(Infinity);
addEventListener("resize", show);
addEventListener("hashchange", fromHash);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { readColours(); show(); });
addEventListener("keydown", event => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
  const layer = LAYERS[Number(event.key) - 1];
  const step = event.shiftKey ? 100 : 10;
  if (event.key === " ") press();
  else if (event.key === "ArrowLeft") go(now - step);
  else if (event.key === "ArrowRight") go(now + step);
  else if (event.key === "Home") go(begins());
  else if (event.key === "End") go(ends());
  else if (event.key === "+") zoom(0.5);
  else if (event.key === "-") zoom(2);
  else if (event.key === "0") zoom(Infinity);
  else if (event.key === "[") toPlan(-1);
  else if (event.key === "]") toPlan(1);
  else if (event.key === "f") { $("follow").checked = !$("follow").checked; show(); }
  else if (layer) $("layer-" + layer[0]).click();
  else return;
  event.preventDefault();
});

// The part of a live flight that is kept.
function keep(flight, rows) {
  const T = flight.ticks;
  if (!T.t.length) flight.first = Math.round(rows.t[0] * 100);
  for (const name of columns) T[name].push(...rows[name]);
  const over = T.t.length - kept;
  // Many at once, because it moves all the others.
  if (over > kept / 10) {
    for (const name of columns) T[name].splice(0, over);
    flight.first += over;
    flight.plans.splice(0, Math.max(planAt(flight.plans, flight.first), 0));
  }
}

// How a page stands to the server of its flight.
function tellState(flight, source) {
  $("state").textContent = flight.summary
    ? "The flight has ended. When another flight begins at this address, this page shows it."
    : source.readyState === EventSource.OPEN ? ""
    : "The server is gone. This page tries to reach it again, and goes on when the server is back.";
}

function watch() {
  addFlight({});
  $("play").textContent = "Pause";
  $("title").textContent = "waiting for the flight";
  connect(flights[0]);
}

// Follows the server's events. A browser that lost the connection asks for what came after the last event.
function connect(flight) {
  const source = new EventSource("/events"), told = () => tellState(flight, source);
  const hear = (kind, act) => source.addEventListener(kind, event => act(JSON.parse(event.data), event));
  source.onopen = told;
  source.onerror = () => {
    told();
    // A browser gives up when it gets another answer than events, for instance that there is no place.
    if (source.readyState === EventSource.CLOSED) setTimeout(connect, 2000, flight);
  };
  hear("begin", (header, event) => {
    // Another flight has another server, which obeys only the page that it served.
    if (!event.lastEventId.startsWith(TOKEN)) return location.reload();
    Object.assign(flight, { header, plans: [], orders: [], first: 0, summary: null, closest: null });
    for (const name of columns) flight.ticks[name].length = 0;
    flight.details.clear();
    now = 0;
    title(flight);
  });
  hear("pace", ({ pause, speed }) => {
    setPlaying(!pause);
    const choice = $("speed");
    if (![...choice.options].some(option => option.value === speed)) choice.append(new Option(speed + " x", speed));
    choice.value = speed;
  });
  hear("ticks", rows => {
    const atEnd = !flight.ticks.t.length || now >= lastTick(flight);
    if (!rows.t.length) return;
    keep(flight, rows);
    if (atEnd) now = lastTick(flight);
    changed = true;
  });
  hear("plan", plan => { flight.plans.push(plan); });
  hear("detail", detail => {
    flight.details.set(detail.tick, detail);
    for (const tick of flight.details.keys()) if (flight.details.size > keptCycles) flight.details.delete(tick);
  });
  hear("closest", closest => { flight.closest = closest; changed = true; });
  hear("order", order => { flight.orders.push(order); title(flight); });
  hear("end", summary => {
    flight.summary = summary;
    told();
    title(flight);
    show();
    $("play").disabled = true;
  });
}

async function start() {
  readColours();
  if (live) return watch();
  // Nothing can be steered before it is unpacked.
  document.body.inert = true;
  try {
    await unpack(DATA);
  } catch (error) {
    $("title").textContent = "this browser cannot unpack the flight: " + error.message;
    return;
  }
  flights.forEach(title);
  if (!flights.some(flight => flight.details.size))
    for (const name of ["scan", "occupancy", "candidates", "corridor", "plan", "unknown"]) $("layer-" + name).disabled = true;
  // It opens at its most telling moment.
  now = flights[0].closest?.tick ?? 0;
  fromHash();
  show();
  document.body.inert = false;
}
start().then(() => requestAnimationFrame(frame));
