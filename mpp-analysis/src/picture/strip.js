// The whole flight as a strip: what the charts show of it, and how a pointer changes that.

// Draws the height over the whole flight, with the window of the charts.
function drawStrip(flight, now, look) {
  const [pen, width, height] = canvas("strip" + flight.id), whole = wholeFlight(flight, look), [from, to] = shownTicks(flight, look);
  if (!flight.ticks.t.length) return;
  const u = tick => LEFT + (width - RIGHT - LEFT) * (tick - whole[0]) / (whole[1] - whole[0]);
  keepPicture(pen, flight, "strip", [whole, flight.plans.length, !!flight.summary], width, height, painter => {
    const column = flight.ticks.z, points = seriesPoints(flight, {}, "z", whole, width);
    let low = Infinity, high = -Infinity;
    for (const z of column) { low = Math.min(low, z); high = Math.max(high, z); }
    const v = z => height - 8 - (height - 14) * (z - low + 0.5) / (high - low + 1);
    drawSeries(painter, points, u, v, colour.flown, 1.5, strideOf(...whole, width) > 1);
    drawEvents(painter, flight, whole, u, height + FOOT);
  });
  pen.fillStyle = colour.ground; pen.globalAlpha = 0.7;
  pen.fillRect(LEFT, 0, u(from) - LEFT, height); pen.fillRect(u(to), 0, width - RIGHT - u(to), height);
  pen.globalAlpha = 1; pen.strokeStyle = pen.fillStyle = colour.faint; pen.lineWidth = 1;
  pen.strokeRect(u(from) + 0.5, 0.5, Math.max(u(to) - u(from) - 1, 1), height - 1);
  for (const edge of [from, to]) pen.fillRect(u(edge) - 3, height / 2 - 9, 6, 18);
  line(pen, [[u(now), 0], [u(now), height]], colour.text, 1);
}

// The window after a drag by so many ticks: of its `part`, which is either end, or all of it.
function dragged([from, to], [first, last], part, by) {
  if (part === "all") {
    const start = Math.min(Math.max(from + by, first), last - (to - from));
    return [start, start + to - from];
  }
  const moved = part === "from" ? [Math.max(from + by, first), to] : [from, Math.min(to + by, last)];
  const least = Math.min(20, last - first);
  if (moved[1] - moved[0] >= least) return moved;
  return part === "from" ? [to - least, to] : [from, from + least];
}

// Lets the pointer act on the strip: a drag moves the window or an end of it, a click seeks, a double click shows all.
function hearStrip(flight, look, changed, seek) {
  const element = $("strip" + flight.id);
  let drag = null;
  const ticksOf = pixels => {
    const [first, last] = wholeFlight(flight, look);
    return Math.round(pixels * (last - first) / (element.clientWidth - RIGHT - LEFT));
  };
  element.addEventListener("pointerdown", event => {
    if (event.button || !flight.ticks.t.length) return;
    const shown = shownTicks(flight, look), whole = wholeFlight(flight, look);
    const tick = whole[0] + ticksOf(event.clientX - element.getBoundingClientRect().left - LEFT), near = ticksOf(14);
    // However small the window is, its middle moves all of it.
    const inside = Math.min(near, (shown[1] - shown[0]) / 4);
    const is = (end, outwards) => Math.abs(tick - end) < ((tick - end) * outwards > 0 ? near : inside);
    const part = is(shown[0], -1) ? "from" : is(shown[1], 1) ? "to" : "all";
    drag = { u: event.clientX, tick, shown, part, moved: false };
    element.setPointerCapture(event.pointerId);
  });
  element.addEventListener("pointermove", event => {
    if (!drag || !(drag.moved ||= Math.abs(event.clientX - drag.u) > 4)) return;
    const whole = wholeFlight(flight, look), wanted = dragged(drag.shown, whole, drag.part, ticksOf(event.clientX - drag.u));
    look.window = wanted[1] - wanted[0] < whole[1] - whole[0] ? wanted : null;
    changed();
  });
  element.addEventListener("pointerup", () => {
    if (drag && !drag.moved) {
      const [from, to] = shownTicks(flight, look), [first, last] = wholeFlight(flight, look);
      const tick = Math.min(Math.max(drag.tick, first), last);
      // The window comes along.
      if (tick < from || tick > to) look.window = dragged([from, to], [first, last], "all", tick - Math.round((from + to) / 2));
      seek(tick);
    }
    drag = null;
  });
  element.addEventListener("pointercancel", () => { drag = null; });
  element.addEventListener("dblclick", () => { look.window = null; changed(); });
}
