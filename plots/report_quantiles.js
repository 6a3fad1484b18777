// The highest peak under scatter: quantiles over the nominal preload, with bands between the outermost.

const mostBands = 3;  // that are drawn at first

// quantiles.csv with heights in metres as well, where the study tells them.
function quantilesInMetres(model) {
  const { quantiles, optimum } = model.study;
  const columns = { ...quantiles.columns };
  if (!model.isSI) return { ...quantiles, columns };
  const size = new Map(optimum.columns.curve.map((curve, i) => [curve, optimum.columns.Y_m[i] / optimum.columns.Y_opt[i]]));
  for (const name of Object.keys(columns).filter((column) => /^Y_q[\d.]+$/.test(column)))
    columns[`${name}_m`] = columns[name].map((value, row) => (value === null ? null : value * size.get(columns.curve[row])));
  return { ...quantiles, columns };
}

// The column of a quantile in one of the families Y, Y_m and ratio.
const quantileName = (family, level) => (family === "Y_m" ? `Y_q${level}_m` : `${family}_q${level}`);

function dashOf(level, middle) {
  return level === middle ? "" : level < middle ? "2 3" : "7 3";
}

function quantileTraces(design, x, values, levels, y, state, several) {
  const middle = levels[Math.floor(levels.length / 2)];
  const where = `${x.words.words}: %{x:.6~g} ${unitText(x.unit)}`;
  const lines = levels.map((level) => ({ type: "scatter", mode: "lines", keys: [design.key, `q ${level}`], rows: design.rows,
    x: design.rows.map((row) => x.values[row]), y: design.rows.map((row) => values.get(level)[row]),
    line: { color: design.look.colour, width: level === middle ? 2.6 : 1.4,
      dash: dashOf(level, middle).replace(" ", "px,").replace(/(\d)$/, "$1px") || "solid" },
    hovertemplate: `<b>${design.label}</b><br>${level} % stay below %{y:.6~g} ${unitText(y.unit)}<br>${where}<extra></extra>` }));
  const band = bandOf(design.rows, x.values, values.get(levels[0]), values.get(levels[levels.length - 1]), design.look, [design.key, "band"]);
  const marked = several ? [evenly(design.rows, x.values, values.get(middle), state, design.shift)] : [];
  return [band, ...lines,
    ...marked.map((rows) => markersOf(rows, x.values, values.get(middle), design.look, [design.key, `q ${middle}`]))];
}

// The best preload without scatter and with it, on the 95 % quantile.
function robustTraces(model, design, x, y, state) {
  const { columns } = model.study.robust;
  const i = columns.curve.indexOf(design.curve);
  if (i < 0 || columns.P_q95[i] === null) return [];
  const metres = state.y === "Y_m" ? columns.Y_q95_m[i] / columns.Y_q95[i] : 1;
  const height = (name) => (state.y === "ratio" ? columns[name.replace("Y", "ratio")][i] : columns[name][i] * metres) / y.size;
  const scale = state.x === model.preload ? columns[model.preload][i] / columns.P_q95[i] : 1;
  const point = (type, preload, value) => ({ type: "scatter", mode: "markers", keys: [design.key, `type ${type}`], rows: [null],
    x: [preload * scale], y: [value], marker: { ...markerOf(type), size: 11 },
    hovertemplate: `<b>${types[type][0]}</b>, ${design.label}<br>95 % stay below %{y:.6~g} ${unitText(y.unit)}` +
      ` at %{x:.6~g} ${unitText(x.unit)}<extra></extra>` });
  return [point("robust", columns.P_q95[i], height("Y_q95")), point("optimum", columns.P_opt[i], height("Y_q95_opt"))];
}

function quantilesPicture(parent, model) {
  const table = quantilesInMetres(model);
  const designs = drawnDesigns(model, table);
  const levels = Object.keys(table.columns).filter((name) => /^Y_q[\d.]+$/.test(name)).map((name) => Number(name.slice(3))).sort((a, b) => a - b);
  const middle = levels[Math.floor(levels.length / 2)];
  const top = levels[levels.length - 1];
  const hasRobust = model.study.robust && levels.includes(95);
  // By these the picture chooses its unit.
  for (const family of ["Y", "Y_m", "ratio"])
    if (table.columns[quantileName(family, top)]) table.columns[family] = table.columns[quantileName(family, top)];
  const panel = (x, y, state) => {
    const values = new Map(levels.map((level) => [level,
      table.columns[quantileName(state.y, level)].map((value) => (value === null ? null : value / y.size))]));
    return { title: y.title, traces: [
      ...designs.flatMap((design) => quantileTraces(design, x, values, levels, y, state, designs.length > 1)),
      ...(hasRobust ? designs.flatMap((design) => robustTraces(model, design, x, y, state)) : [])] };
  };
  const lines = levels.map((level) => ({ key: `q ${level}`, label: `${level} % stay below`,
    sample: { width: level === middle ? 2.6 : 1.4, dash: dashOf(level, middle) } }));
  studyPicture(parent, model, { name: "quantiles", title: "The highest peak under scatter", table, panel,
    xs: model.isSI ? [model.preload, "P"] : ["P"], ys: known(table, model.isSI ? ["Y_m", "ratio"] : ["ratio", "Y"]),
    hidden: designs.slice(mostBands).map((design) => design.key),
    note: "Of all that are made for a preload so many per cent stay below a line; the band lies between the lowest and the highest quantile.",
    key: () => [["Designs", designKey(designs)],
      ["Lines", [...lines, { key: "band", label: "between them", sample: { fill: areaOf(lookOf(0)) } }]],
      ["Points", hasRobust ? ["optimum", "robust"].map(typeKey) : []]] });
}
