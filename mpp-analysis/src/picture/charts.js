// The charts of a flight over time, and what the pointer does there. A chart's unit may depend on the flight.
const LEFT = 44, RIGHT = 8, FOOT = 18;

// The ticks that the charts show: the whole flight, or the window of `look`.
function shownTicks(flight, look) {
  return look.window || [flight.first, Math.max(lastTick(flight), flight.first + 1, look.last || 0)];
}

const wholeFlight = (flight, look) => shownTicks(flight, { ...look, window: null });
const unitOf = (flight, chart) => typeof chart.unit === "string" ? chart.unit : chart.unit(flight);

// The value of a series at a tick; null where there is none.
function valueAt(flight, chart, name, tick) {
  if (chart.plans) return flight.plans[planAt(flight.plans, tick)]?.[name] ?? null;
  const value = flight.ticks[name][tick - flight.first] ?? null;
  return value === null || !chart.change ? value : chart.change(value);
}

// The values of a series between two ticks, as [tick, least, greatest], or null in a gap. Where a pixel holds several
// ticks, they share an entry, which reaches to the value before it: no peak is lost.
function seriesPoints(flight, chart, name, [from, to], pixels) {
  const points = [];
  if (chart.plans) {
    for (let i = Math.max(planAt(flight.plans, from), 0); i < flight.plans.length; i++) {
      const start = flight.plans[i].used_from_tick, end = flight.plans[i + 1]?.used_from_tick ?? lastTick(flight);
      if (start === null || start > to) break;
      const value = flight.plans[i][name];
      points.push([Math.max(start, from), value, value], [Math.min(end, to), value, value]);
    }
    return points;
  }
  const column = flight.ticks[name], change = chart.change || (value => value), stride = strideOf(from, to, pixels);
  const first = Math.max(from - flight.first, 0), last = Math.min(to - flight.first, column.length - 1);
  let before = null;
  for (let row = first; row <= last; row += stride) {
    let low = before ?? Infinity, high = before ?? -Infinity;
    if (stride === 1) [low, high] = [Infinity, -Infinity];
    for (let k = row; k < row + stride && k <= last; k++) {
      before = column[k];
      if (before === null) continue;
      if (before < low) low = before;
      if (before > high) high = before;
    }
    points.push(low > high ? null : [row + flight.first, change(low), change(high)]);
  }
  return points;
}

const strideOf = (from, to, pixels) => Math.max(1, Math.floor((to - from) / pixels));

// Draws a series. Columns from the least to the greatest value of a pixel are much faster to draw than a line.
function drawSeries(pen, points, u, v, style, width, dense) {
  if (!dense) return line(pen, points.map(point => point && [u(point[0]), v(point[1])]), style, width);
  pen.fillStyle = style;
  pen.globalAlpha = width > 3 ? 0.45 : 1;
  for (let i = 0; i < points.length; i++) {
    if (points[i] === null) continue;
    const [tick, low, high] = points[i], left = Math.floor(u(tick)), right = points[i + 1] ? Math.floor(u(points[i + 1][0])) : left + 1;
    pen.fillRect(left, Math.round(v(high) - width / 2), right - left, Math.round(v(low) - v(high) + width));
  }
  pen.globalAlpha = 1;
}

// Draws what does not change with the pointer.
function drawCurves(pen, flight, [from, to], width, height, together) {
  const rows = (height - FOOT) / CHARTS.length, right = width - RIGHT;
  const u = tick => LEFT + (right - LEFT) * (tick - from) / (to - from);
  CHARTS.forEach((chart, index) => {
    const series = chart.series.map(([name, style]) =>
      [name, style, seriesPoints(flight, chart, name, [from, to], width)]);
    const limits = chart.limits ? chart.limits(flight) : [];
    let low = Math.min(Infinity, ...limits), high = Math.max(-Infinity, ...limits);
    // Flights side by side have the same axes.
    for (const one of together) for (const [name] of chart.series)
      for (const point of seriesPoints(one, chart, name, [from, to], width)) if (point !== null) { low = Math.min(low, point[1]); high = Math.max(high, point[2]); }
    if (low > high) [low, high] = [0, 1];
    // Noise is not blown up to fill the chart.
    const margin = Math.max((high - low) * .08, (chart.least - (high - low)) / 2); low -= margin; high += margin;
    if (chart.plans) high = Math.ceil(high - margin);
    if (chart.floor !== undefined) low = Math.max(low, chart.floor);
    const digits = high - low < 5 && !chart.plans ? 1 : 0, top = index * rows + 16, bottom = (index + 1) * rows - 6;
    const v = value => bottom - (bottom - top) * (value - low) / (high - low);
    line(pen, [[LEFT, bottom], [right, bottom]], colour.line, 1);
    pen.fillStyle = colour.faint; pen.textAlign = "left";
    const unit = unitOf(flight, chart);
    pen.fillText(chart.title + (unit && ` [${unit}]`), LEFT, index * rows + 12);
    pen.textAlign = "right";
    if (limits.length) for (const limit of limits) {
      line(pen, [[LEFT, v(limit)], [right, v(limit)]], colour.bad, 1, [2, 4]);
      pen.fillStyle = colour.bad; pen.fillText(limit.toFixed(Math.abs(limit) < 2 ? 2 : 0), LEFT - 4, v(limit) + 4);
    } else {
      pen.fillText(high.toFixed(digits), LEFT - 4, top + 8);
      pen.fillText(low.toFixed(digits), LEFT - 4, bottom);
    }
    if (chart.goal) {
      line(pen, [[LEFT, v(chart.goal)], [right, v(chart.goal)]], colour.good, 1, [10, 6]);
      pen.fillStyle = colour.good; pen.fillText("goal", LEFT - 4, v(chart.goal) + 4);
    }
    pen.save(); pen.beginPath(); pen.rect(LEFT, top - 2, right - LEFT, bottom - top + 4); pen.clip();
    // Where both are the same, the broad reference shows on both sides of what was flown.
    for (const [name, style, points] of series)
      drawSeries(pen, points, u, v, colour[style], name.startsWith("ref_") || name === "candidates" ? 4 : 1.5,
        !chart.plans && strideOf(from, to, width) > 1);
    pen.restore();
  });
  drawEvents(pen, flight, [from, to], u, height);
  const choices = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 60, 120, 300, 600];
  const every = choices.find(s => (right - LEFT) * s * 100 / (to - from) > 55) || 1200;
  pen.fillStyle = colour.faint; pen.textAlign = "center";
  for (let k = Math.ceil(from / 100 / every); k * every <= to / 100; k++) {
    const tick = 100 * k * every;
    line(pen, [[u(tick), height - FOOT], [u(tick), height - 14]], colour.faint, 1);
    pen.fillText((k * every).toFixed(every < 1 ? 1 : 0) + " s", Math.min(u(tick), width - 16), height - 3);
  }
}

// Replans as short strokes above the time, the closest approach and the end as lines.
function drawEvents(pen, flight, [from, to], u, height) {
  let before = -9;
  for (const { used_from_tick: tick } of flight.plans) {
    if (tick === null || tick < from || tick > to || u(tick) - before < 3) continue;
    before = u(tick);
    line(pen, [[before, height - FOOT - 5], [before, height - FOOT]], colour.plan, 1.5);
  }
  const mark = (tick, style, dash) => {
    if (tick >= from && tick <= to) line(pen, [[u(tick), 14], [u(tick), height - FOOT]], style, 1.5, dash);
  };
  if (flight.closest) mark(flight.closest.tick, colour.scan, [4, 3]);
  if (flight.summary) mark(lastTick(flight), isGood(flight.summary.outcome) ? colour.good : colour.bad, []);
}

// Puts a picture under the pen that is painted anew only if its key has changed, so that a frame that changes only the
// pointer or the time is cheap. The flight keeps it by its name.
function keepPicture(pen, flight, name, key, width, height, paint) {
  const ratio = window.devicePixelRatio || 1;
  key = [key, width, height, ratio, colour.ground].join();
  if (flight[name]?.key !== key) {
    const image = document.createElement("canvas");
    [image.width, image.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    const painter = image.getContext("2d");
    painter.setTransform(ratio, 0, 0, ratio, 0, 0);
    painter.font = pen.font;
    paint(painter);
    flight[name] = { key, image };
  }
  pen.drawImage(flight[name].image, 0, 0, width, height);
}

// Draws the charts. `look` may have a `window` of ticks and a `hover`, the tick under the pointer.
function drawCharts(flight, now, look) {
  const [pen, width, height] = canvas("charts" + flight.id);
  if (!flight.ticks.t.length) return;
  const [from, to] = shownTicks(flight, look);
  keepPicture(pen, flight, "curves", [from, to, lastTick(flight), flight.plans.length, !!flight.summary], width, height,
    painter => drawCurves(painter, flight, [from, to], width, height, look.together || [flight]));
  const u = tick => LEFT + (width - RIGHT - LEFT) * (tick - from) / (to - from), rows = (height - FOOT) / CHARTS.length;
  if (now >= from && now <= to) line(pen, [[u(now), 0], [u(now), height - FOOT]], colour.text, 1);
  const shown = look.hover ?? now;
  if (look.hover !== null && look.hover !== undefined) line(pen, [[u(shown), 0], [u(shown), height - FOOT]], colour.faint, 1, [3, 3]);
  pen.textAlign = "right";
  CHARTS.forEach((chart, index) => {
    let end = width - RIGHT;
    for (const [name, style] of [...chart.series].reverse()) {
      const text = valueText(flight, chart, name, shown);
      pen.fillStyle = colour[style]; pen.fillText(text, end, index * rows + 12);
      end -= pen.measureText(text).width + 10;
    }
  });
  $("readout" + flight.id).value = readout(flight, shown);
}

function valueText(flight, chart, name, tick) {
  const value = valueAt(flight, chart, name, Math.min(Math.max(tick, flight.first), lastTick(flight)));
  return value === null ? "-" : value.toFixed(chart.digits);
}

// The values at a tick as text.
function readout(flight, tick) {
  const of = chart => chart.series.map(([name]) => valueText(flight, chart, name, tick)).reverse().join(" / ");
  return `${(tick / 100).toFixed(2)} s: ` + CHARTS.slice(0, 5).map(chart => `${chart.title} ${of(chart)} ${unitOf(flight, chart)}`).join(", ");
}

// The window of ticks after zooming by a factor about a tick; null if it holds the whole flight.
function zoomed([from, to], [first, last], tick, factor) {
  const span = Math.max((to - from) * factor, 20);
  if (span >= last - first) return null;
  const start = Math.min(Math.max(tick - (tick - from) * span / (to - from), first), last - span);
  return [Math.round(start), Math.round(start + span)];
}

// Lets the pointer act on the charts: hovering shows values, a click seeks, a drag moves and the wheel zooms the
// window, a double click shows all. `seek` is null where the time cannot be chosen.
function hearCharts(flight, look, changed, seek) {
  const element = $("charts" + flight.id), all = () => wholeFlight(flight, look);
  let drag = null;
  const tickAt = event => {
    const box = element.getBoundingClientRect(), [from, to] = shownTicks(flight, look);
    const share = (event.clientX - box.left - LEFT) / (box.width - RIGHT - LEFT);
    return Math.round(Math.min(Math.max(from + share * (to - from), from), to));
  };
  element.addEventListener("pointerdown", event => {
    if (!event.button && seek) drag = { u: event.clientX, window: shownTicks(flight, look), moved: false };
  });
  element.addEventListener("pointermove", event => {
    if (!flight.ticks.t.length) return;
    if (drag && look.window && Math.abs(event.clientX - drag.u) > 4) {
      element.setPointerCapture(event.pointerId);
      drag.moved = true;
      const [first, last] = all(), [from, to] = drag.window;
      const by = (drag.u - event.clientX) * (to - from) / (element.clientWidth - RIGHT - LEFT);
      const start = Math.round(Math.min(Math.max(from + by, first), last - (to - from)));
      look.window = [start, start + to - from];
    }
    look.hover = tickAt(event);
    changed();
  });
  element.addEventListener("pointerup", event => { if (drag && !drag.moved) seek(tickAt(event)); drag = null; });
  element.addEventListener("pointerleave", () => { look.hover = null; changed(); });
  element.addEventListener("pointercancel", () => { drag = null; });
  if (!seek) return;
  element.addEventListener("dblclick", () => { look.window = null; changed(); });
  element.addEventListener("wheel", event => {
    event.preventDefault();
    look.window = zoomed(shownTicks(flight, look), all(), tickAt(event), event.deltaY > 0 ? 1.25 : 0.8);
    changed();
  }, { passive: false });
}

// The candidate within 7 pixels of a place in the view, or null. `scale` is in pixels/m.
function candidateAt(flight, tick, [x, z], scale) {
  let best = 7 / scale, found = null;
  (detailAt(flight, tick)?.paths || []).forEach((path, index) => {
    for (let i = 1; i < path.length; i++) {
      const [[x0, z0], [x1, z1]] = [path[i - 1], path[i]], length = Math.hypot(x1 - x0, z1 - z0) || 1;
      const along = Math.min(Math.max(((x - x0) * (x1 - x0) + (z - z0) * (z1 - z0)) / length ** 2, 0), 1);
      const apart = Math.hypot(x - x0 - along * (x1 - x0), z - z0 - along * (z1 - z0));
      if (apart < best) [best, found] = [apart, index];
    }
  });
  return found;
}

// Lets the pointer choose in the view the stage of the corridor, and a candidate. `place` gives what drawView returned.
function hearView(flight, look, changed, place) {
  const element = $("view" + flight.id);
  element.addEventListener("pointermove", event => {
    const box = element.getBoundingClientRect(), placeOf = place();
    look.cursor = placeOf && placeOf(event.clientX - box.left, event.clientY - box.top);
    const scale = placeOf && 1 / (placeOf(1, 0)[0] - placeOf(0, 0)[0]);
    look.marked = placeOf && candidateAt(flight, look.tick, look.cursor, scale);
    changed();
  });
  element.addEventListener("pointerleave", () => { look.cursor = look.marked = null; changed(); });
}
