// What a page says in words: the numbers of a tick, the candidates of a replan, the layers, the orders.

// Shows the numbers of a tick. `more` holds further rows.
function showValues(flight, now, more = []) {
  const T = flight.ticks, row = now - flight.first, number = planAt(flight.plans, now), plan = flight.plans[number];
  const values = [
    ["downrange", T.x[row].toFixed(2) + " m"], ["height", T.z[row].toFixed(2) + " m"],
    ["airspeed", T.airspeed[row].toFixed(2) + " m/s"], ["pitch", degrees(T.pitch[row]).toFixed(1) + " deg"],
    ["flight path", degrees(T.flight_path[row]).toFixed(1) + " deg"], ["thrust", T.thrust[row].toFixed(2) + " N"],
    ["elevator", `${T.elevator[row].toFixed(2)} ${ELEVATOR[flight.header.aircraft.elevator?.unit] || ""}`],
    ["plan", plan ? `${number + 1} of ${flight.plans.length}` : "none"],
    ["outcome", plan ? OUTCOMES[plan.outcome] || plan.outcome : "-"],
    ["candidates", plan ? plan.candidates : "-"], ["feasible", plan ? plan.feasible : "-"],
    plan && "way_out" in plan ? ["way out", plan.way_out.toFixed(2) + " s"] : ["trees", plan ? plan.tree_runs : "-"],
    ["cost", plan && plan.cost !== null ? plan.cost.toFixed(2) : "-"],
    ["violation", plan && plan.violation !== null ? plan.violation.toFixed(3) + " m" : "-"], ...more];
  $("values" + flight.id).replaceChildren(...values.map(([name, value]) => {
    const row = document.createElement("div"), dt = document.createElement("dt"), dd = document.createElement("dd");
    dt.textContent = name; dd.textContent = value; dd.id = "v-" + name.replace(" ", "-") + flight.id;
    row.append(dt, dd);
    return row;
  }));
}

// Why this plan: what each candidate of the cycle cost, by part. The chosen one is marked. A row under the pointer
// shows its path in the view.
function showWhy(flight, now, look, changed) {
  const detail = detailAt(flight, now), table = $("why" + flight.id);
  if (table.detail === detail) {
    // The first row is the head.
    [...table.rows].forEach((row, index) => row.classList.toggle("marked", look.marked !== null && index === look.marked + 1));
    return;
  }
  table.detail = detail;
  look.marked = null;
  const said = $("why-note" + flight.id);
  if (!detail) {
    said.textContent = flight.details.size ? "No plan is in force yet." : "There are no details of the planning cycles.";
    return table.replaceChildren();
  }
  const byParts = detail.judged.some(judged => judged.parts), number = (value, digits = 2) => value?.toFixed(digits) ?? "-";
  said.textContent = detail.chosen === null ? "The cycle chose no candidate." : byParts
    ? "The lowest price wins. The first rounds refine every candidate, further rounds the best of them."
    : "The paper's method ranks by violation, then by cost. It knows only the cost of a candidate that beat those before it.";
  const head = byParts ? ["", "candidate", "round", "price", "clearance", "unknown", "onward", "effort", "lack [m]", "feasible"]
    : ["", "candidate", "cost", "feasible"];
  const rounds = {};
  const rows = detail.judged.map(({ candidate, feasible, price, parts }, index) => {
    const round = rounds[candidate] = (rounds[candidate] || 0) + 1;
    const p = parts || {}, mark = index === detail.chosen ? "\u2713 chosen" : "", fits = feasible ? "yes" : "no";
    return byParts ? [mark, candidate + 1, round, number(price), number(p.clearance), number(p.unknown), number(p.onward),
      number(p.effort), number(p.lack, 3), fits] : [mark, candidate + 1, number(price), fits];
  });
  const line = (cells, kind) => {
    const row = document.createElement("tr");
    row.append(...cells.map(text => Object.assign(document.createElement(kind), { textContent: text })));
    return row;
  };
  table.replaceChildren(line(head, "th"), ...rows.map((cells, index) => {
    const row = line(cells, "td");
    row.className = index === detail.chosen ? "chosen" : "";
    row.onpointerenter = () => { look.marked = index; changed(); };
    row.onpointerleave = () => { look.marked = null; changed(); };
    return row;
  }));
}

// The scenario keys of a header, flat, with their values as text. The field follows from the others, or is a file's.
function scenarioKeys(header) {
  const keys = {}, put = (path, value) => {
    if (value !== null && typeof value === "object" && !Array.isArray(value))
      for (const [name, inner] of Object.entries(value)) put([...path, name], inner);
    else keys[path.join(" ").replaceAll("_", " ")] = typeof value === "object" ? JSON.stringify(value) : String(value);
  };
  const { field, package_version, aircraft, ...rest } = header;
  put([], { aircraft: aircraft.name, ...rest });
  return keys;
}

// In what the scenarios of two flights differ: the keys with both values.
function differences(one, other) {
  const a = scenarioKeys(one), b = scenarioKeys(other);
  const names = [...new Set([...Object.keys(a), ...Object.keys(b)])].filter(name => a[name] !== b[name]);
  return names.map(name => `${name} ${a[name] ?? "none"} / ${b[name] ?? "none"}`);
}

// An order as text.
function orderText(order) {
  const part = ([name, value]) => {
    if (name === "tick" || name === "order") return [];
    if (name === "field") return Object.entries(value).map(([kind, all]) => `${all.length} ${kind}`);
    return [typeof value === "boolean" || order.order === "disturb" ? `${name.replace("_", " ")} ${value}` : value];
  };
  return `${(order.tick / 100).toFixed(2)} s: ${order.order} ` + Object.entries(order).flatMap(part).join(" ");
}

// A box for each layer, which `on` follows.
function addLayers(on, changed) {
  LAYERS.forEach(([name, style], index) => {
    const label = document.createElement("label"), box = document.createElement("input"), mark = document.createElement("i");
    box.type = "checkbox"; box.checked = on[name]; box.id = "layer-" + name;
    box.onchange = () => { on[name] = box.checked; changed(); };
    mark.style.setProperty("--c", `var(--${style})`);
    label.title = `key ${index + 1}`;
    label.append(box, mark, name);
    $("layers").append(label);
  });
}
