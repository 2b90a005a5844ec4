// The page of a flight that was flown, or that is watched while it is flown.
const DATA = /*DATA*/null;
const live = DATA === null, TOKEN = "/*TOKEN*/";
const columns = ["t", "x", "z", "airspeed", "pitch", "pitch_rate", "flight_path", "ref_x", "ref_z", "ref_airspeed",
  "ref_pitch", "ref_flight_path", "est_airspeed", "est_pitch", "est_flight_path", "thrust", "elevator"];
const log = live ? { header: null, ticks: Object.fromEntries(columns.map(name => [name, []])), plans: [], orders: [],
  summary: null } : DATA.log;
const T = log.ticks;
log.orders ||= [];
log.details = new Map((live ? [] : DATA.details).map(detail => [detail.tick, detail]));
const look = { follow: true, on: Object.fromEntries(LAYERS.map(([name]) => [name, true])),
  note: text => { $("occupancy").textContent = text; } };
let now = 0, playing = live, speed = 1, started = null, changed = false;

function show() {
  if (!T.t.length) return;
  now = Math.min(Math.max(now, 0), T.t.length - 1);
  $("time").max = T.t.length - 1;
  $("time").value = now;
  $("clock").value = T.t[now].toFixed(2) + " s";
  showValues(log, now);
  $("link").textContent = $("link").href = "#t=" + T.t[now].toFixed(2);
  $("link").href = $("link").textContent;
  look.follow = $("follow").checked;
  drawView(log, now, look);
  drawCharts(log, now, 0);
}

function title() {
  const h = log.header, s = log.summary;
  const obstacles = Object.values(h.field).reduce((count, kind) => count + kind.length, 0);
  let line = `seed ${h.seed}, preset ${h.preset}, ${obstacles} obstacles, ${h.paths} paths`;
  if (s) line += `: ${s.outcome.replace(/-/g, " ")} after ${s.t_end.toFixed(2)} s, clearance ` +
    (s.min_clearance === null ? "none" : s.min_clearance.toFixed(2) + " m") + `, ${s.replans} replans, ` +
    `${s.candidates} candidates, ${s.feasible} feasible`;
  if (!live) line += `, log ${DATA.hash}`;
  $("title").textContent = document.title = line;
  $("orders").replaceChildren(...log.orders.map(order => {
    const item = document.createElement("li");
    item.textContent = orderText(order);
    return item;
  }));
}

function setPlaying(value) {
  playing = value;
  started = null;
  $("play").textContent = playing ? "Pause" : "Play";
  if (live) control({ pause: playing ? 0 : 1 });
  else if (!playing) history.replaceState(null, "", "#t=" + T.t[now].toFixed(2));
}

function go(tick) { now = tick; started = null; if (!live && playing) setPlaying(false); show(); }

function toPlan(direction) {
  const starts = log.plans.map(plan => plan.used_from_tick);
  const next = direction > 0 ? starts.find(tick => tick > now) : starts.filter(tick => tick < now).pop();
  if (next !== undefined) go(next);
}

function frame(time) {
  if (changed) { changed = false; show(); }
  if (playing && !live && T.t.length) {
    if (started === null) started = { time, now: now === T.t.length - 1 ? 0 : now };
    now = Math.min(Math.round(started.now + (time - started.time) / 10 * speed), T.t.length - 1);
    show();
    if (now === T.t.length - 1) setPlaying(false);
  }
  requestAnimationFrame(frame);
}

function control(values) {
  fetch("/control?" + new URLSearchParams(values), { method: "POST", headers: { "X-Token": TOKEN } }).catch(() => {});
}

function fromHash() {
  const match = /^#t=([\d.]+)$/.exec(location.hash);
  if (match && T.t.length) { now = Math.round(parseFloat(match[1]) * 100); show(); }
}

addLayers(look.on, show);
const speeds = live ? [["0.25", "0.25 x"], ["1", "real time"], ["4", "4 x"], ["max", "as fast as possible"]]
  : [["0.1", "0.1 x"], ["0.25", "0.25 x"], ["1", "real time"], ["4", "4 x"]];
for (const [value, text] of speeds) $("speed").append(new Option(text, value, false, value === "1"));
$("speed").onchange = event => { if (live) control({ speed: event.target.value }); else { speed = Number(event.target.value); started = null; } };
$("time").oninput = event => go(Number(event.target.value));
$("play").onclick = () => setPlaying(!playing);
$("back").onclick = () => toPlan(-1);
$("next").onclick = () => toPlan(1);
$("follow").onchange = show;
addEventListener("resize", show);
addEventListener("hashchange", fromHash);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { readColours(); show(); });
addEventListener("keydown", event => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
  const layer = LAYERS[Number(event.key) - 1];
  const step = event.shiftKey ? 100 : 10;
  if (event.key === " ") setPlaying(!playing);
  else if (event.key === "ArrowLeft") go(now - step);
  else if (event.key === "ArrowRight") go(now + step);
  else if (event.key === "Home") go(0);
  else if (event.key === "End") go(T.t.length - 1);
  else if (event.key === "[") toPlan(-1);
  else if (event.key === "]") toPlan(1);
  else if (event.key === "f") { $("follow").checked = !$("follow").checked; show(); }
  else if (layer) $("layer-" + layer[0]).click();
  else return;
  event.preventDefault();
});

readColours();
if (live) {
  $("play").textContent = "Pause";
  $("title").textContent = "waiting for the flight";
  const source = new EventSource("/events");
  source.addEventListener("begin", event => { log.header = JSON.parse(event.data); title(); });
  source.addEventListener("ticks", event => {
    const rows = JSON.parse(event.data);
    const atEnd = now >= T.t.length - 1;
    for (const name of columns) T[name].push(...rows[name]);
    if (atEnd) now = T.t.length - 1;
    changed = true;
  });
  source.addEventListener("plan", event => { log.plans.push(JSON.parse(event.data)); });
  source.addEventListener("detail", event => { const d = JSON.parse(event.data); log.details.set(d.tick, d); });
  source.addEventListener("end", event => {
    log.summary = JSON.parse(event.data);
    source.close();
    title();
    show();
    $("play").disabled = true;
  });
} else {
  title();
  if (!log.details.size)
    for (const name of ["scan", "occupancy", "candidates", "corridor", "plan"]) $("layer-" + name).disabled = true;
  fromHash();
  show();
}
requestAnimationFrame(frame);
