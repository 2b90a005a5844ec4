// The pointer and the key that put obstacles into the way.
let drag = null, over = null;

function pixel(event) {
  const box = $("view").getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

// A place in the world, to the centimetre, from a point of the picture.
const placed = point => placeOf(...point).map(value => Math.round(value * 100) / 100);

// The inverse of `placeOf`.
function pointOf(x, z) {
  const [x0, z0] = placeOf(0, 0), scale = 1 / (placeOf(1, 0)[0] - x0);
  return [(x - x0) * scale, (z0 - z) * scale];
}

// The obstacle from where the pointer went down to where it is: a bar, or a circle if it did not move. The first place
// stays where it was in the world, while the field runs on beneath the pointer.
function drawn() {
  const [[u, v], [right, down]] = [drag.from, drag.to], radius = flight.header.world_scale;
  return Math.hypot(right - u, down - v) > 12 ? { capsule: [{ from: drag.place, to: placed(drag.to), radius: radius / 2 }] }
    : { circle: [{ x: drag.place[0], z: drag.place[1], radius }] };
}

// Draws what would be placed, and how far ahead of the aircraft that is.
function drawPointer(pen, width, height) {
  const point = drag ? drag.to : over;
  if (!point || ended) return;
  const scale = pointOf(1, 0)[0] - pointOf(0, 0)[0], T = flight.ticks, radius = flight.header.world_scale * scale;
  if (drag) {
    pen.globalAlpha = 0.6;
    drawField(pen, drawn(), 0, pointOf, scale, width, height, colour.placed);
    pen.globalAlpha = 1;
  } else {
    pen.beginPath(); pen.arc(...point, radius, 0, 7);
    pen.strokeStyle = colour.placed; pen.lineWidth = 2; pen.stroke();
  }
  const ahead = (placeOf(...point)[0] - T.x[now]) / T.airspeed[now];
  if (ahead > 0) labelInside(pen, `${ahead.toFixed(1)} s ahead`, point[0], point[1] - radius - 8, colour.text);
}

// A circle on the plan, 1.5 s ahead: for those who have no pointer.
function placeAhead() {
  const T = flight.ticks, x = T.x[now] + 1.5 * T.airspeed[now], path = detailAt(flight, now)?.trajectory || [];
  const near = path.reduce((best, p) => Math.abs(p[0] - x) < Math.abs(best[0] - x) ? p : best, [Infinity, T.z[now]]);
  const [, z] = Math.abs(near[0] - x) < 2 * flight.header.world_scale ? near : [x, T.z[now]];
  const [u, v] = [x, z].map(value => Math.round(value * 100) / 100);
  order({ order: "obstacles", field: { circle: [{ x: u, z: v, radius: flight.header.world_scale }] } });
}

$("view").addEventListener("pointerdown", event => {
  if (!placeOf || ended || event.button) return;
  $("view").setPointerCapture(event.pointerId);
  drag = { from: pixel(event), to: pixel(event), place: placed(pixel(event)) };
});
$("view").addEventListener("pointermove", event => {
  over = event.pointerType === "mouse" ? pixel(event) : null;
  if (!drag) return;
  drag.to = pixel(event);
  if (!playing) show();
});
$("view").addEventListener("pointerleave", () => { over = null; });
$("view").addEventListener("pointercancel", () => { drag = null; });
$("view").addEventListener("pointerup", event => {
  if (!drag) return;
  drag.to = pixel(event);
  const field = drawn();
  drag = null;
  order({ order: "obstacles", field });
});
