// The link to a moment: settings, orders, and the tick.
// What a click, a drag and the switches give, from the numbers of a short text; `unit` is the world's scale. In space, a click
// plants a trunk of this radius [m].
const RADIUS = 0.3;
const disturb = (name, change) => (tick, unit, value) => ({ tick, order: "disturb", [name]: change(value) });
const SHORT = {
  c: (tick, radius, x, z) => ({ tick, order: "obstacles", field: { circle: [{ x, z, radius }] } }),
  b: (tick, unit, ...v) => ({ tick, order: "obstacles",
    field: { capsule: [{ from: v.slice(0, 2), to: v.slice(2), radius: unit / 2 }] } }),
  p: (tick, unit, x, y) => ({ tick, order: "trunk", x, y, radius: RADIUS }),
  g: disturb("gusts", Number), d: disturb("dropouts", Number), e: disturb("elevator_stuck", Boolean) };

// How many numbers follow the tick.
const COUNTS = { c: 2, b: 4, p: 2, g: 1, d: 1, e: 1 };

// The letter and the numbers of an order.
function numbersOf({ tick, order, x, y, field, gusts, dropouts, elevator_stuck }) {
  if (order === "disturb") return gusts !== undefined ? ["g", tick, gusts] : dropouts !== undefined ? ["d", tick, dropouts]
    : ["e", tick, Number(elevator_stuck)];
  if (order === "trunk") return ["p", tick, x, y];
  const [[kind, o]] = things(field).concat([[null, null]]);
  return kind === "circle" ? ["c", tick, o.x, o.z] : kind === "capsule" ? ["b", tick, ...o.from, ...o.to] : [];
}

// Orders as a short text, the unit first; empty if there is an order that it cannot give back to the last bit.
function packOrders(orders, unit) {
  const text = [unit, ...orders.map(numbersOf).map(([letter, ...numbers]) => letter + numbers.join("_"))].join("*");
  const sorted = value => JSON.stringify(value, (key, v) =>
    v && typeof v === "object" && !Array.isArray(v) ? Object.fromEntries(Object.entries(v).sort()) : v);
  try {
    return sorted(unpackOrders(text)) === sorted(orders) ? text : "";
  } catch { return ""; }
}

function unpackOrders(text) {
  const [unit, ...parts] = text.split("*");
  return parts.map(part => {
    const [tick, ...numbers] = part.slice(1).split("_").map(Number);
    if (numbers.length !== COUNTS[part[0]] || ![tick, ...numbers, Number(unit)].every(Number.isFinite)) throw new Error(part);
    return SHORT[part[0]](tick, Number(unit), ...numbers);
  });
}

// The settings, the orders and the moment as the end of a link; of a whole flight without its moment.
function fragment(whole = false) {
  const link = new URLSearchParams();
  for (const [name, value] of Object.entries(settings)) if (value !== USUAL[name]) link.set(name, value);
  if (!whole) link.set("t", flight.ticks.t.length);
  const given = flight.orders.filter(order => !pending.includes(order));
  const short = packOrders(given, flight.header.world_scale);
  if (given.length) link.set(short ? "o" : "orders", short || JSON.stringify(given));
  return "#" + link;
}

// Takes settings, orders and moment from the link, and begins.
function fromLink() {
  const link = new URLSearchParams(location.hash.slice(1));
  settings = { ...USUAL };
  for (const [name, usual] of Object.entries(USUAL)) {
    const text = link.get(name);
    if (text === null) continue;
    settings[name] = typeof usual === "number" ? Number(text) : text;
    // JSON has no such numbers: the module would take them for numbers that are not given.
    if (typeof usual === "number" && !Number.isFinite(settings[name]))
      return refuse(new Error(`${name} is not a number: ${text}`));
  }
  let orders = [];
  try {
    orders = JSON.parse(link.get("orders") || "[]");
    if (link.has("o")) orders = unpackOrders(link.get("o"));
  } catch {
    return refuse(new Error("the link's orders are damaged"));
  }
  const until = Math.floor(Number(link.get("t")));
  begin(orders, link.has("t") && until > 0 ? until : null);
}

// Copies what came of it, and the link to this moment.
function copyLink() {
  if (playing) setPlaying(false);
  const tell = text => { say(text); told = performance.now() + TOLD; };
  const text = `${$("verdict").textContent} ${location.href}`;
  const failing = () => tell("The browser does not let this page copy; the link is in its address line.");
  if (!navigator.clipboard) return failing();
  navigator.clipboard.writeText(text).then(() => tell("Copied."), failing);
}
