// Pictures of a run: each branch told by its marker and colour, slip thick and stick thin, what is unstable dashed. Where
// branches stick alike, one line stands for them.

const commonLook = { colour: "#4a4a4a" };
const mostComparisons = 3e6;  // of rows with branches: beyond that each branch is drawn by itself

function namedBranches(run) {
  const { columns } = run.points;
  const branches = run.summary.branches.map((summary, i) => ({ summary, rows: [], look: lookOf(i) }));
  columns.branch.forEach((branch, row) => branches[branch] && branches[branch].rows.push(row));
  const values = (branch, key) => JSON.stringify(branch.summary.values[key]);
  const keys = [...new Set(branches.flatMap((branch) => Object.keys(branch.summary.values)))]
    .filter((key) => branches.some((branch) => values(branch, key) !== values(branches[0], key)));
  const used = new Map();
  branches.forEach((branch, i) => {
    const label = labelOf(branch.summary.values, keys) || `branch ${i}`;
    used.set(label, (used.get(label) || 0) + 1);
    branch.label = used.get(label) > 1 ? `${label} (${used.get(label)})` : label;
  });
  return branches;
}

// What its problem is given by.
const settingsOf = (input) => input.system ?? input.model.parameters;

function runModel(run) {
  const table = run.points;
  const input = run.summary.case;
  const { regime, unstable } = table.columns;
  // On the border itself stick and slip mean the same.
  const slips = input.branch.curve !== "switch" && regime.some((name) => name.startsWith("slip"));
  const part = regime.map((name) => (slips && !name.startsWith("slip") ? "stick" : "slip"));
  const branches = namedBranches(run);
  const ring = run.sectors && { sectors: run.sectors, ring: sectorRows(run.sectors, table, branches) };
  return { table, input, system: settingsOf(input), ...ring, branches, part, hasStick: slips && part.includes("stick"),
    stability: unstable ? unstable.map((count) => (count > 0 ? "unstable" : count < 0 ? "untold" : "stable")) : null,
    isFriction: input.system?.model in frictionModels };
}

// ---- Branches that stick alike ----

// The stuck segments of a branch, as pairs of rows from left to right.
function stuckSegments(rows, xs, ys, sticks) {
  const segments = [];
  for (let i = 1; i < rows.length; ++i) {
    const [a, b] = [rows[i - 1], rows[i]];
    if (!sticks(a) || xs[b] === null || ys[b] === null || xs[a] === xs[b]) continue;
    segments.push(xs[a] < xs[b] ? [a, b] : [b, a]);
  }
  return segments.sort((one, other) => xs[one[0]] - xs[other[0]]);
}

// Whether a row lies on one of the segments.
function liesOn(segments, row, xs, ys, height) {
  let [from, to] = [0, segments.length];
  while (from < to) {
    const middle = (from + to) >> 1;
    if (xs[segments[middle][0]] <= xs[row]) from = middle + 1;
    else to = middle;
  }
  if (!from) return false;
  const [a, b] = segments[from - 1];
  if (xs[row] > xs[b]) return false;
  const at = ys[a] + ((ys[b] - ys[a]) * (xs[row] - xs[a])) / (xs[b] - xs[a]);
  return Math.abs(at - ys[row]) <= 2e-3 * Math.min(Math.abs(ys[row]), height);
}

// Of each row: "" it is the branch's own; "drawn" others stick there alike and it stands for them; "left out".
function commonRows(model, xs, ys) {
  const mark = new Array(xs.length).fill("");
  if (!model.hasStick || model.branches.length < 2 || xs.length * model.branches.length > mostComparisons) return mark;
  const sticks = (row) => model.part[row] === "stick" && xs[row] !== null && ys[row] !== null;
  const segments = model.branches.map(({ rows }) => stuckSegments(rows, xs, ys, sticks));
  const [low, high] = extent(ys);
  model.branches.forEach(({ rows }, i) => rows.filter(sticks).forEach((row) => {
    const other = segments.findIndex((one, k) => k !== i && liesOn(one, row, xs, ys, high - low));
    if (other >= 0) mark[row] = other < i ? "left out" : "drawn";
  }));
  return mark;
}

// ---- A picture of branches ----

function runPanel(model, x, name, state) {
  const y = scaledColumn(model.table, name, model.system);
  const [xs, ys] = [x.values, y.values];
  const mark = commonRows(model, xs, ys);
  const hover = hoverOf(y, x);
  const styleOf = (row) => mark[row] === "left out" ? null
    : [model.part[row], model.stability ? model.stability[row] : "stable", mark[row] ? "common" : ""].join(" ");
  const lines = model.branches.flatMap((branch, i) => styledTraces(branch.rows, xs, ys, styleOf, (style) => {
    const [part, stability, common] = style.split(" ");
    return { keys: [common || `branch ${i}`, part, stability],
      line: { color: (common ? commonLook : branch.look).colour, width: part === "stick" ? 1.3 : 2.6,
        dash: { unstable: "6px,4px", untold: "2px,3px" }[stability] || "solid" },
      hovertemplate: `<b>${common ? "stuck alike" : branch.label}</b><br>${hover}<extra></extra>` };
  }));
  const several = model.branches.length > 1 ? model.branches : [];
  const markers = several.map((branch, i) => {
    const own = branch.rows.filter((row) => !mark[row]);
    return markersOf(evenly(own, xs, ys, state, (i + 0.5) / several.length), xs, ys, branch.look, [`branch ${i}`]);
  });
  const special = specialTraces(model.table, model.branches.flatMap((branch) => branch.rows), xs, ys, hover);
  return { title: y.title, short: /_h\d+$/.test(name) ? y.words.words.replace(/.*, /, "") : "harmonic 1",
    traces: [...lines, ...markers, ...special], hasCommon: mark.some((one) => one) };
}

function runKey(model, panels) {
  const branches = model.branches.length < 2 ? []
    : model.branches.map((branch, i) => ({ key: `branch ${i}`, label: branch.label, sample: keyOf(branch.look) }));
  if (panels.some((panel) => panel.hasCommon))
    branches.push({ key: "common", label: "stuck alike, whatever the branch", sample: { ...commonLook, width: 1.3 } });
  const parts = model.hasStick ? [{ key: "slip", label: "slip", sample: { width: 2.8 } },
    { key: "stick", label: "stick", sample: { width: 1.3 } }] : [];
  const told = model.stability || [];
  if (told.some((one) => one !== "stable")) {
    parts.push({ key: "stable", label: "stable", sample: { width: 2 } },
      { key: "unstable", label: "unstable", sample: { width: 2, dash: "6 4" } });
  }
  if (told.includes("untold")) parts.push({ key: "untold", label: "stability not told", sample: { width: 2, dash: "2 3" } });
  return [["Branches", branches], ["Lines", parts], ["Points", specialKey(model.table)]];
}

// All that is known of the row under the pointer.
function tellRow(model, row) {
  const { columns } = model.table;
  const branch = model.branches[columns.branch[row]];
  const numbers = Object.keys(columns)
    .filter((name) => !["branch", "point", "type", "regime", "arclength"].includes(name) && !/_h\d+$/.test(name))
    .map((name) => `${symbolOf(name)} = ${short(columns[name][row], 6)}${unitOfColumn(name)}`);
  const type = columns.type[row] === "regular" ? "" : `, ${columns.type[row].replaceAll("_", " ")}`;
  return `<b>${branch ? branch.label : ""}</b>, ${harmless(columns.regime[row] + type)}: ${numbers.join(", ")}`;
}

// more: panelsOf(y), the columns of the panels where there are several; logX, logY; note.
function runPicture(parent, model, name, heading, { xs, ys, x, y, panelsOf, logX, logY, note }) {
  const columnOf = (column) => scaledColumn(model.table, column, model.system);
  const options = (names) => names.map((column) => [column, plainText(columnOf(column).title)]);
  const automatic = (now) => Object.assign(now, { logX: logX ?? wantsLog(model.table.columns[now.x]),
    logY: logY ?? wantsLog(model.table.columns[now.y]) });
  let panels = [];
  return picture(parent, { name, title: heading, note, state: automatic({ x, y }),
    controls: (now, update) => axisControls(now, update, { xs: options(xs), ys: options(ys), automatic }),
    panels: (now) => {
      panels = (panelsOf ? panelsOf(now.y) : [now.y]).map((column) => runPanel(model, columnOf(now.x), column, now));
      return panels;
    },
    axes: (now) => ({ x: columnOf(now.x).title, y: columnOf(now.y).title, floor: panelsOf ? 1e-6 : undefined }),
    key: () => runKey(model, panels), tell: (row) => tellRow(model, row) });
}

// ---- Which pictures there are ----

const inUnits = { eta: "frequency_Hz", Y: "Y_m", U: "U_m", R: "R_m", dissipated: "dissipated_J" };

function harmonicsPicture(parent, model, numeric, x) {
  const harmonics = numeric.filter((name) => /^[YUR](_\d+)?_h\d+$/.test(name));
  const baseOf = (name) => name.replace(/_h\d+$/, "");
  const bases = [...new Set(harmonics.map(baseOf))].filter((name) => numeric.includes(name));
  if (!bases.length) return;
  runPicture(parent, model, "harmonics", "Harmonics beside one another", { xs: [x], ys: bases, x, y: bases.includes("Y") ? "Y" : bases[0],
    logX: false, logY: true, panelsOf: (base) => [base, ...harmonics.filter((name) => baseOf(name) === base)],
    note: "All panels have the same scale and are enlarged together; a millionth of the largest value is where they end." });
}

// [[name, heading, x, y]] of the pictures that suit the kind of run.
function chosenPictures(model, best, ys) {
  const { branch } = model.input;
  const heading = (name) => plainText(title(describe(name, model.system), ""));
  if (branch.curve) {
    const [first, second] = branch.parameters.map(best);
    const plane = ["curve", "The curve in its two parameters", first, second];
    return model.isFriction ? [plane, ["amplitude", "Amplitude along the curve", second, best("Y")]] : [plane];
  }
  const x = best(branch.parameter);
  if (!model.isFriction) {
    const order = [...(branch.extrema_of || []), ...ys].filter((name) => ys.includes(name) && name !== x && !(name in model.system));
    return [...new Set(order)].slice(0, 2).map((name, i) => [i ? "second" : "branch", `${heading(name)} over ${heading(x)}`, x, name]);
  }
  if (branch.response === "limit_cycle")
    return [["branch", "Size of the limit cycle", x, "R_over_S"], ["second", "Frequency of the limit cycle", x, best("eta")]];
  if (branch.response === "nonlinear_mode") {
    const over = branch.parameter === "R" ? "R_over_S" : x;
    return [["branch", "Frequency of the mode", over, best("eta")], ["second", "Damping of the mode", over, "zeta"]];
  }
  return [["amplitude", "Amplitude of the base", x, best("Y")], ["relative", "How far the contact slips", x, "R_over_S"]];
}

function runPictures(parent, run) {
  const model = runModel(run);
  const { columns } = model.table;
  const { branch } = model.input;
  const varies = (name) => { const [low, high] = extent(columns[name]); return high > low; };
  const told = ["branch", "point", "type", "regime", "unstable", "stable", "worst_wave", "growth_error"];
  const numeric = Object.keys(columns).filter((name) => !told.includes(name) && columns[name].some((value) => typeof value === "number"));
  const preload = preloadIn(columns);
  const best = (name) => (numeric.includes("frequency_Hz") && (name === "P" ? preload : inUnits[name])) || name;
  const across = branch.curve ? branch.parameters : [branch.parameter];
  const common = [...across, ...across.map(best), "eta", "P", "R_over_S", "frequency_Hz", preload, "arclength"];
  const xs = numeric.filter((name) => varies(name) && (!model.isFriction || common.includes(name)));
  const ys = numeric.filter((name) => name !== "arclength" && varies(name));
  for (const [name, heading, x, y] of chosenPictures(model, best, ys)) {
    if (columns[x] && columns[y])
      runPicture(parent, model, name, heading, { xs: [...new Set([x, ...xs])], ys: [...new Set([y, ...ys])], x, y });
  }
  if (model.isFriction && !branch.curve) harmonicsPicture(parent, model, numeric, best(branch.parameter));
  stickPicture(parent, model);
  wavePicture(parent, model);
  return model;
}
