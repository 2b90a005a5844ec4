// The replay of a flight in space: the scene, the flight from above and from the side, attitude and charts, all of one moment.
const DATA = /*DATA*/null;
const CHARTS = [
  { title: "height", unit: "m", least: 1, digits: 2, series: [["ref_z", "reference"], ["z", "flown"]] },
  { title: "airspeed", unit: "m/s", least: 1, digits: 2, series: [["ref_airspeed", "reference"], ["airspeed", "flown"]] },
  { title: "bank", unit: "deg", least: 4, digits: 1, change: degrees, series: [["ref_bank", "reference"], ["bank", "flown"]] },
  { title: "distance from the nearest thing", unit: "m", least: 1, digits: 2, floor: 0, series: [["gap", "flown"]] },
  { title: "candidates (broad), feasible", unit: "", least: 2, digits: 0, floor: 0, plans: true, series: [["candidates", "candidate"], ["feasible", "plan"]] }];
const look = { around: 0, ghost: undefined, sharpest: 2, window: null, hover: null };
let flight = null, now = 0, playing = false, started = null, changed = true;

async function unpack(packed) {
  const bytes = Uint8Array.from(atob(packed), letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const { header, summary, plans, orders, hash, look: seen, ticks } = JSON.parse(await new Response(stream).text());
  const trunks = seen.bodies.filter(body => body.cylinder).map(({ cylinder: c }) => [c.x, c.y, c.radius, c.height]);
  flight = newFlight({ header, trunks, span: seen.span, state: seen.moments[0], bodies: seen.bodies.filter(body => !body.cylinder),
    terrain: seen.terrain });
  const planted = orders.map(({ tick, x, y, radius }) => ({ tick, x, y, radius }));
  takeNews(flight, { states: seen.moments.slice(1), cycles: seen.cycles, orders: planted, planning: [], ended: true });
  for (const [name, [unit, steps]] of Object.entries(ticks)) {
    let sum = 0;
    flight.ticks[name] = steps.map(step => step === null ? null : (sum += step) * unit);
  }
  const gap = seen.moments.map(([, , , gap]) => gap), least = gap.reduce((best, value, tick) => value < gap[best] ? tick : best, 0);
  Object.assign(flight.ticks, { t: gap, gap });
  Object.assign(flight, { id: "", first: 0, summary, plans, hash, closest: { tick: least } });
  flight.crash = crashOf(flight);
}

function title() {
  const { header: h, summary: s } = flight;
  $("title").textContent = `${h.space.world || "stem map"}${h.space.density === undefined ? "" : " " + h.space.density}, ${h.aircraft.name}, seed ${h.seed}`;
  $("result").textContent = `${s.outcome.replace(/-/g, " ")}: ${account(flight)} ${s.replans} replans, ${h.obstacles} bodies, log ${flight.hash}`;
  document.title = $("title").textContent;
}

function show() {
  drawScene(flight, now, look);
  drawMap(flight, now, look);
  drawSide(flight, now);
  drawAttitude(flight, now);
  drawCharts(flight, Math.min(now, lastTick(flight)), look);
  drawStrip(flight, Math.min(now, lastTick(flight)), look);
  const { at, airspeed, gap, bank, ahead } = stateAt(flight, now), angle = value => `${degrees(value).toFixed(1)}°`;
  const values = { ahead: meters(at[0], 2), right: meters(at[1], 2), height: meters(at[2], 2), airspeed: `${airspeed.toFixed(2)} m/s`, bank: angle(bank),
    pitch: angle(Math.asin(ahead[2])), nearest: gap >= 5 ? "over 5 m" : meters(Math.max(0, gap), 2) };
  $("now").replaceChildren(...Object.entries(values).map(([name, text]) => {
    const row = document.createElement("div"), dt = document.createElement("dt"), dd = document.createElement("dd");
    dt.textContent = name; dd.textContent = text; dd.id = "v-" + name;
    row.append(dt, dd);
    return row;
  }));
  $("time").value = now;
  $("clock").textContent = `${(now / 100).toFixed(2)} s`;
  $("link").href = $("link").textContent = "#t=" + (now / 100).toFixed(2);
}

function setPlaying(value) {
  playing = value;
  started = null;
  $("play").textContent = playing ? "Pause" : "Play";
  if (!playing) history.replaceState(null, "", "#t=" + (now / 100).toFixed(2));
}

function go(tick) {
  now = Math.max(0, Math.min(lastTick(flight), tick));
  if (playing) setPlaying(false);
  changed = true;
}

function frame(time) {
  requestAnimationFrame(frame);
  if (playing) {
    if (started === null) started = { time, now: now >= lastTick(flight) ? 0 : now };
    now = Math.min(Math.round(started.now + (time - started.time) / 10 * Number($("speed").value)), lastTick(flight));
    changed = true;
    if (now === lastTick(flight)) setPlaying(false);
  }
  if (changed) { changed = false; show(); }
}

function hear() {
  $("play").onclick = () => setPlaying(!playing);
  $("time").oninput = event => go(Number(event.target.value));
  $("speed").onchange = () => { started = null; };
  $("nearest").onclick = () => go(flight.closest.tick);
  hearCharts(flight, look, () => { changed = true; }, go);
  hearStrip(flight, look, () => { changed = true; }, go);
  let from = null;
  $("view").addEventListener("pointerdown", event => { from = event.clientX; $("view").setPointerCapture(event.pointerId); });
  $("view").addEventListener("pointermove", event => { if (from !== null) { look.around = Math.max(-2.5, Math.min(2.5, (event.clientX - from) / 250)); changed = true; } });
  for (const end of ["pointerup", "pointercancel"]) $("view").addEventListener(end, () => { from = null; look.around = 0; changed = true; });
  addEventListener("resize", () => { changed = true; });
  addEventListener("hashchange", fromHash);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { readColours(); readPaint(); changed = true; });
  addEventListener("keydown", event => {
    if (event.ctrlKey || event.metaKey || event.altKey || ["INPUT", "SELECT", "BUTTON"].includes(event.target.tagName)) return;
    const step = (event.shiftKey ? 100 : 10) * ({ ArrowLeft: -1, ArrowRight: 1 }[event.key] || 0);
    if (event.key === " ") setPlaying(!playing); else if (step) go(now + step); else return;
    event.preventDefault();
  });
}

function fromHash() {
  const match = /^#t=([\d.]+)$/.exec(location.hash);
  if (match) go(Math.round(parseFloat(match[1]) * 100));
}

// A flight opens at its most telling moment.
async function start() {
  readColours();
  readPaint();
  document.body.inert = true;
  try {
    await unpack(DATA);
  } catch (error) {
    $("title").textContent = "this browser cannot unpack the flight: " + error.message;
    return;
  }
  $("time").max = lastTick(flight);
  title();
  hear();
  go(flight.closest.tick);
  fromHash();
  document.body.inert = false;
  requestAnimationFrame(frame);
}
start();
