// Pictures of a study: peaks over the preload, and the best preload over a key.

const mostDesigns = 24;  // of which curves are drawn
const mostAtOnce = 4;    // of which lesser peaks are drawn at first

function studyModel(study) {
  const { columns } = study.optimum;
  const names = Object.keys(columns);
  const keys = names.slice(1, names.indexOf("P_opt"));
  const differs = keys.filter((key) => columns[key].some((value) => value !== columns[key][0]));
  const designs = columns.curve.map((curve, i) => ({ curve, index: i, look: lookOf(i),
    label: labelOf(Object.fromEntries(differs.map((key) => [key, columns[key][i]])), differs) || "the design" }));
  // What is lowered is compared with the free base where that is known, as in the answer.
  const measure = columns.ratio_opt.some((ratio) => ratio !== null) ? columns.ratio_opt : columns.Y_opt;
  const best = measure.reduce((least, value, i) => (value !== null && (least < 0 || value < measure[least]) ? i : least), -1);
  const preload = preloadIn(columns);
  const isSI = (study.summary.case.study.objective ?? "Y") === "Y" && preload !== undefined;
  return { study, system: study.summary.case.system, keys, differs, designs, isSI, preload, best };
}

function rowsBy(column) {
  const found = new Map();
  column.forEach((value, row) => (found.has(value) ? found.get(value).push(row) : found.set(value, [row])));
  return found;
}

const known = (table, names) => names.filter((name) => table.columns[name] && table.columns[name].some((value) => value !== null));

// The designs that have rows in a table, with these.
function drawnDesigns(model, table) {
  const rows = rowsBy(table.columns.curve);
  return model.designs.filter((design) => rows.has(design.curve)).slice(0, mostDesigns)
    .map((design, i, all) => ({ ...design, rows: rows.get(design.curve), key: `design ${design.curve}`, shift: (i + 0.5) / all.length }));
}

const designKey = (designs) => (designs.length < 2 ? []
  : designs.map((design) => ({ key: design.key, label: design.label, sample: keyOf(design.look) })));

// spec: name, title, note, hidden, table, xs, ys, panel(x, y, state), key(state), tell, besides(y): columns drawn with y.
function studyPicture(parent, model, { table, xs, ys, panel, besides = () => [], ...spec }) {
  const columnOf = (column) => scaledColumn(table, column, model.system);
  const options = (names) => names.map((column) => [column, plainText(columnOf(column).title)]);
  const automatic = (now) => Object.assign(now, { logX: wantsLog(table.columns[now.x]),
    logY: wantsLog([now.y, ...besides(now.y)].flatMap((column) => table.columns[column])) });
  return picture(parent, { ...spec, state: automatic({ x: xs[0], y: ys[0] }),
    controls: (now, update) => axisControls(now, update, { xs: options(xs), ys: options(ys), automatic }),
    panels: (now) => [panel(columnOf(now.x), columnOf(now.y), now)], axes: (now) => ({ x: columnOf(now.x).title }) });
}

// ---- Peaks over the preload ----

// Every peak of a design thin, the highest one thick.
function peakTraces(table, design, x, y, state, several) {
  const { columns } = table;
  const pick = (values, rows) => rows.map((row) => (row === null ? null : values[row]));
  const line = (rows, key, width) => ({ type: "scatter", mode: "lines", keys: [design.key, key], rows, x: pick(x.values, rows),
    y: pick(y.values, rows), line: { color: design.look.colour, width },
    hovertemplate: `<b>${design.label}</b><br>${hoverOf(y, x)}<extra></extra>` });
  const branches = [...rowsBy(design.rows.map((row) => columns.peak_branch[row])).values()];
  const all = branches.flatMap((branch) => [...branch.map((i) => design.rows[i]), null]);
  const highest = design.rows.filter((row) => columns.is_global[row] === 1).sort((a, b) => columns.P[a] - columns.P[b]);
  const marked = several ? [evenly(highest, x.values, y.values, state, design.shift)] : [];
  return [line(all, "others", 1.2), line(highest, "highest", 2.8),
    ...marked.map((rows) => markersOf(rows, x.values, y.values, design.look, [design.key, "highest"]))];
}

const peakLines = [{ key: "highest", label: "highest peak", sample: { width: 2.8 } }, { key: "others", label: "all peaks", sample: { width: 1.2 } }];

function peaksPicture(parent, model) {
  const table = model.study.sweep;
  const { columns } = table;
  const designs = drawnDesigns(model, table);
  const heights = model.isSI ? ["Y_m", "ratio"] : ["ratio", "Y_max"];
  const panel = (x, y, state) => ({ title: y.title, traces: [
    ...designs.flatMap((design) => peakTraces(table, design, x, y, state, designs.length > 1)),
    ...specialTraces(table, designs.flatMap((design) => design.rows), x.values, y.values, hoverOf(y, x))] });
  const told = known(table, ["P", model.preload, "eta_peak", "frequency_Hz", "Y_max", "Y_m", "ratio", "R_over_S"]);
  const tell = (row) => {
    const design = model.designs.find(({ curve }) => curve === columns.curve[row]);
    const numbers = told.map((name) => `${title(describe(name, model.system), "")} ${short(columns[name][row], 6)}${unitOfColumn(name)}`);
    return `<b>${design.label}</b>, ${harmless(columns.type[row])}: ${numbers.join(", ")}`;
  };
  studyPicture(parent, model, { name: "peaks", title: "Peaks over the preload", table, panel, tell,
    hidden: designs.length > mostAtOnce ? ["others"] : [], xs: model.isSI ? [model.preload, "P"] : ["P"],
    ys: known(table, [...heights, "eta_peak", "frequency_Hz", "R_over_S", "dissipated"]),
    note: designs.length < model.designs.length ? `The first ${designs.length} of ${model.designs.length} designs are drawn.` : "",
    key: () => [["Designs", designKey(designs)], ["Lines", peakLines], ["Points", specialKey(table)]] });
}

// ---- The best preload over a key ----

const limits = { P_opt: ["P_low", "P_high"], preload_N: ["preload_low_N", "preload_high_N"],
  preload_N_per_m: ["preload_low_N_per_m", "preload_high_N_per_m"] };

function optimumPicture(parent, model) {
  const table = model.study.optimum;
  const { columns } = table;
  const key = model.differs[0];
  const look = lookOf(0);
  const rows = columns.curve.map((_, row) => row);
  const panel = (x, y, state) => {
    const line = { type: "scatter", mode: "lines+markers", keys: ["optimum"], rows, x: x.values, y: y.values,
      text: model.designs.map((design) => design.label), hovertemplate: `<b>%{text}</b><br>${hoverOf(y, x)}<extra></extra>`,
      line: { color: look.colour, width: 2.4 }, marker: { size: 9, color: "#fff", line: { color: look.colour, width: 2 } } };
    const band = limits[state.y] ? [bandOf(rows.filter((row) => columns[limits[state.y][0]][row] !== null), x.values,
      ...limits[state.y].map((name) => columns[name]), look, ["band"])] : [];
    return { title: y.title, traces: [...band, line] };
  };
  studyPicture(parent, model, { name: "optimum", title: `Best preload over ${plainText(describe(key, model.system).words || symbolOf(key))}`,
    table, panel, besides: (y) => limits[y] || [], xs: [key],
    ys: known(table, model.isSI ? [model.preload, "Y_m", "ratio_opt"] : ["P_opt", "ratio_opt", "Y_opt"]),
    key: (state) => [["Lines", [{ key: "optimum", label: "each design", sample: keyOf(look) },
      ...(limits[state.y] ? [{ key: "band", label: "highest peak within a factor 2 of the lowest", sample: { fill: areaOf(look) } }] : [])]]] });
}

function studyPictures(parent, study) {
  const model = studyModel(study);
  const first = model.differs.length ? study.optimum.columns[model.differs[0]] : [""];
  if (study.quantiles) quantilesPicture(parent, model);
  if (study.sweep) peaksPicture(parent, model);
  if (isGrid(model)) mapPicture(parent, model);
  else if (first.every((value) => typeof value === "number")) optimumPicture(parent, model);
  return model;
}
