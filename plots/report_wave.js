// The motion at a special point, over a period: base and damper round the circumference, and the relative motion of the contacts,
// told by which of them stick and which slip. Nodes of one sector lag behind each other as the wave does; those of a whole ring
// have each their own row of sectors.csv.

const mostNodes = 200;  // that are drawn
const mostPoints = 200; // that may be chosen
const waveSize = { width: 900, height: 430, left: 84, right: 12, middles: [100, 320], half: 80 };
const periodSeconds = 4;
const wavePoints = ["peak", "fold", "corner_fold", "switch", "trough"];
const byStick = { stick: "#00705a", slip: "#b3400b" };

// y_i = Y cos(w t - beta - 2 pi n i / N), u_i and r_i = u_i - y_i likewise; `turn` is t over the period.
function motionOf(point, node, turn) {
  const { Y, U, R, S, alpha, beta, psi } = point.sectors ? point.sectors[node] : point;
  const theta = 2 * Math.PI * (turn - (point.sectors ? 0 : (point.waves * node) / point.nodes));
  return { y: Y * Math.cos(theta - beta), u: U * Math.cos(theta - alpha), r: R * Math.cos(theta - psi), state: stateAt(R, S, theta - psi) };
}

// A contact of stiffness and limit sticks behind each turning point of r until r has changed by 2 S.
function stateAt(R, S, phase) {
  if (!(R > S)) return "stick";
  const half = ((phase % Math.PI) + Math.PI) % Math.PI;
  return half < Math.acos(1 - (2 * S) / R) ? "stick" : "slip";
}

// Whether the columns tell all of the motion: one contact at each node, in one harmonic, of whole rings in sectors.csv.
function hasWave({ isFriction, sectors, table: { columns }, input: { branch, system, ring } }) {
  const response = branch.response || "forced";
  const isTold = ring ? Boolean(sectors) && Math.max(...sectors.columns.contact) === 1 : system?.elements > 2;
  return isFriction && isTold && !branch.curve && response === "forced" && (system.harmonics ?? 1) === 1 &&
    ["Y", "U", "R", "S", "beta", "alpha", "psi", "type"].every((name) => columns[name]) &&
    !Object.keys(columns).some((name) => /_h\d+$|^[UR]_(contact_)?\d/.test(name));
}

const nodesOf = ({ sectors, system }) => (sectors ? Math.max(...sectors.columns.sector) : system.elements);

function wavePoint(model, row) {
  const names = ["Y", "U", "R", "beta", "alpha", "psi"];
  const known = ({ columns }, at) => Object.fromEntries(names.map((name) => [name, columns[name][at]]));
  if (!model.sectors) return { ...known(model.table, row), S: model.table.columns.S[row], row, nodes: nodesOf(model), waves: model.system.wave_number };
  const { columns } = model.sectors;
  const sectors = model.ring.get(row)
    .map((at) => ({ ...known(model.sectors, at), S: columns.R_over_S[at] > 0 ? columns.R[at] / columns.R_over_S[at] : Infinity }));
  const largest = (name) => Math.max(...sectors.map((one) => one[name]));
  return { Y: largest("Y"), U: largest("U"), R: largest("R"), sectors, row, nodes: sectors.length };
}

function waveRows({ ring, table: { columns } }) {
  const isKnown = (row) => ["Y", "U", "R", "S", "beta", "alpha", "psi"].every((name) => Number.isFinite(columns[name][row])) &&
    (!ring || ring.has(row));
  const rows = wavePoints.flatMap((type) => columns.type.map((_, row) => row).filter((row) => columns.type[row] === type && isKnown(row))
    .sort((a, b) => columns.Y[b] - columns.Y[a]));
  return rows.slice(0, mostPoints);
}

function waveLabel(model, row) {
  const { columns } = model.table;
  const name = columns.frequency_Hz ? "frequency_Hz" : "eta";
  const unit = name === "eta" ? "" : " Hz";
  const branch = model.branches.length > 1 ? `${plainText(model.branches[columns.branch[row]].label)}: ` : "";
  return `${branch}${types[columns.type[row]]?.[0] || columns.type[row]}, ${plainText(symbolOf(name))} = ${short(columns[name][row], 5)}${unit}, ` +
    `R/S = ${short(columns.R_over_S[row], 4)}`;
}

// An amplitude at a point, in SI units where the table has them.
function lengthText({ table: { columns } }, row, value) {
  const inMetres = columns.Y_m ? value * (columns.Y_m[row] / columns.Y[row]) : value;
  const [size, unit] = prefix(columns.Y_m ? "m" : "1", inMetres);
  return `${short(inMetres / size, 3)} ${unitText(unit)}`;
}

function svgElement(name, attributes, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

// The drawing, with what is moved.
function waveDrawing(nodes) {
  const { width, height, left, right, middles, half } = waveSize;
  const text = (x, y, content, more = {}) => svgElement("text", { x, y, "font-size": 15, fill: ink, ...more }, content);
  const frame = (middle) => [svgElement("line", { x1: left, x2: width - right, y1: middle, y2: middle, stroke: "#8a94a3" }),
    svgElement("line", { x1: left, x2: left, y1: middle - half, y2: middle + half, stroke: "#8a94a3" })];
  const curve = (colour, dash) => svgElement("polyline", { fill: "none", stroke: colour, "stroke-width": 2.4, "stroke-dasharray": dash });
  const curves = { y: curve(palette[0], ""), u: curve(palette[3], "8 4"), r: curve("#8a94a3", "") };
  const dots = nodes.map(() => svgElement("path", {}));
  const tops = middles.map((middle) => text(left - 6, middle - half + 6, "", { "text-anchor": "end" }));
  const drawing = svgElement("svg", { viewBox: `0 0 ${width} ${height}`, width: "100%", role: "img",
    "aria-label": "Displacement of base and damper, and relative motion of the contacts, round the circumference" },
    ...middles.flatMap(frame), ...tops, text(left + 8, 14, "displacement"), text(left + 8, 234, "relative motion of the contacts"),
    text((left + width) / 2, height - 6, "round the circumference, node by node", { "text-anchor": "middle" }), curves.y, curves.u, curves.r, ...dots);
  return { drawing, curves, dots, tops };
}

const dotOf = { stick: "M-3-3H3V3H-3Z", slip: "M5.5 0A5.5 5.5 0 1 1-5.5 0A5.5 5.5 0 1 1 5.5 0Z" };

function moveWave({ curves, dots }, nodes, point, turn) {
  const { width, left, right, middles, half } = waveSize;
  const across = (node) => left + ((width - left - right) * node) / point.nodes;
  const largest = Math.max(point.Y, point.U) || 1;
  const up = (middle, part) => middle - half * part;
  const motions = nodes.map((node) => motionOf(point, node, turn));
  const closed = [...nodes, point.nodes];
  const line = (value) => closed.map((node, i) => `${across(node).toFixed(1)},${value(motions[i % nodes.length]).toFixed(1)}`).join(" ");
  curves.y.setAttribute("points", line(({ y }) => up(middles[0], y / largest)));
  curves.u.setAttribute("points", line(({ u }) => up(middles[0], u / largest)));
  curves.r.setAttribute("points", line(({ r }) => up(middles[1], r / (point.R || 1))));
  motions.forEach(({ r, state }, i) => {
    const place = `translate(${across(nodes[i]).toFixed(1)} ${up(middles[1], r / (point.R || 1)).toFixed(1)})`;
    const look = { d: dotOf[state], transform: place, fill: state === "slip" ? "#fff" : byStick.stick, stroke: byStick[state],
      "stroke-width": state === "slip" ? 2 : 0, class: state };
    for (const [key, value] of Object.entries(look)) dots[i].setAttribute(key, value);
  });
}

const waveKey = () => [[{ colour: palette[0], width: 2.4 }, "base"], [{ colour: palette[3], width: 2.4, dash: "8 4" }, "damper"],
  [{ colour: byStick.stick, marker: "square" }, "contact sticks"], [{ colour: byStick.slip, marker: "circle", hollow: true }, "contact slips"]];

function wavePicture(parent, model) {
  if (!hasWave(model)) return;
  const rows = waveRows(model);
  if (!rows.length) return;
  const every = Math.ceil(nodesOf(model) / mostNodes);
  const nodes = Array.from({ length: Math.ceil(nodesOf(model) / every) }, (_, i) => i * every);
  const made = waveDrawing(nodes);
  const state = { point: null, turn: 0, isPlaying: false };
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  const time = element("input", { type: "range", min: 0, max: 1, step: 0.005, "aria-label": "Time over the period",
    oninput: () => { pause(); show(Number(time.value)); } });
  const show = (turn) => {
    state.turn = turn;
    time.value = turn;
    moveWave(made, nodes, state.point, turn);
  };
  const choose = (row) => {
    state.point = wavePoint(model, row);
    made.tops[0].textContent = lengthText(model, row, Math.max(state.point.Y, state.point.U));
    made.tops[1].textContent = lengthText(model, row, state.point.R);
    show(state.turn);
  };
  // Who wishes little motion is shown eighths of the period, one each half second.
  let before = null;
  const step = (now) => {
    if (!state.isPlaying) return;
    const turns = (now - (before ?? now)) / 1000 / periodSeconds;
    if (before === null || !still.matches || turns >= 1 / 8) {
      before = now;
      show((state.turn + (still.matches ? Math.round(8 * turns) / 8 : turns)) % 1);
    }
    requestAnimationFrame(step);
  };
  const button = element("button", { type: "button", class: "play", onclick: () => (state.isPlaying ? pause() : play()) }, "Play");
  const play = () => { state.isPlaying = true; before = null; button.textContent = "Pause"; requestAnimationFrame(step); };
  const pause = () => { state.isPlaying = false; button.textContent = "Play"; };
  const key = element("div", { class: "key" }, ...waveKey().map(([look, name]) => element("label", { html: `${sample(look)} ${name}` })));
  const thin = every > 1 ? [paragraph(`One in ${every} of the ${nodesOf(model)} nodes is drawn.`, { class: "note" })] : [];
  parent.append(element("figure", { id: "figure-wave" }, element("figcaption", {}, model.sectors ? "The ring at a special point, over a period" : "The wave at a special point, over a period"),
    element("div", { class: "controls" }, choice("Point", rows.map((row) => [row, waveLabel(model, row)]), rows[0], (row) => choose(Number(row))),
      button, element("label", {}, "t / T", time)), made.drawing, key, ...thin));
  choose(rows[0]);
  report.wave = state;
}
