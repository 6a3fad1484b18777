// Curves and points in a plane, of a table's rows.

// Contrast to white of at least 4.5; a curve is told by its marker as well, what it does by width and dash.
const palette = ["#0b5fa5", "#b3400b", "#00705a", "#8b2f8f", "#7a5c00", "#4a4a4a"];
const curveMarkers = ["circle", "square", "diamond", "triangle-left", "cross", "x", "triangle-right"];
const marksOnCurve = 6;

const lookOf = (i) => ({ colour: palette[i % palette.length], marker: curveMarkers[i % curveMarkers.length] });
const keyOf = (look, width = 2.4) => ({ ...look, width, hollow: true });
const areaOf = (look) => `${look.colour}2e`;
const unitText = (unit) => (unit === "1" ? "" : unit);

// A column with its words, in a unit that is read easily.
function scaledColumn(table, name, system) {
  const words = describe(name, system);
  const values = table.columns[name];
  const [low, high] = extent(values);
  const [size, unit] = prefix(words.unit, Math.max(Math.abs(low), Math.abs(high)));
  return { name, words, unit, size, values: size === 1 ? values : values.map((value) => (value === null ? null : value / size)),
    title: title(words, unit) };
}

// What stands beside the pointer on a curve.
function hoverOf(y, x) {
  const line = (column, value) => `${plainText(column.words.words || column.words.symbol)}: ${value} ${unitText(column.unit)}`;
  return `${line(x, "%{x:.7~g}")}<br>${line(y, "%{y:.7~g}")}`;
}

// The traces of one curve, of which `styleOf(row)` says how each of its rows is drawn: null for not at all. Parts of
// different styles meet in one point.
function styledTraces(rows, xs, ys, styleOf, traceOf) {
  const found = new Map();
  const push = (style, row) => {
    if (!found.has(style)) found.set(style, { x: [], y: [], rows: [] });
    const line = found.get(style);
    line.x.push(row === null ? null : xs[row]);
    line.y.push(row === null ? null : ys[row]);
    line.rows.push(row);
  };
  let before = null;
  rows.forEach((row, i) => {
    const style = styleOf(row);
    if (style !== before && before !== null) {
      push(before, row);
      push(before, null);
    } else if (style !== before && i) {
      push(style, rows[i - 1]);
    }
    if (style !== null) push(style, row);
    before = style;
  });
  return [...found].map(([style, line]) => ({ type: "scatter", mode: "lines", ...line, ...traceOf(style) }));
}

// Some rows of a curve that lie evenly along it as it is seen, shifted so that those of other curves do not cover them.
function evenly(rows, xs, ys, state, shift) {
  const place = (value, log) => (log ? Math.log(value) : value);
  const isSeen = (value, log) => value !== null && (!log || value > 0);
  const at = rows.filter((row) => isSeen(xs[row], state.logX) && isSeen(ys[row], state.logY))
    .map((row) => [row, place(xs[row], state.logX), place(ys[row], state.logY)]);
  if (at.length < 2) return [];
  const [width, height] = [1, 2].map((k) => { const [low, high] = extent(at.map((point) => point[k])); return high - low || 1; });
  let length = 0;
  const along = at.map((point, i) =>
    (length += i ? Math.hypot((point[1] - at[i - 1][1]) / width, (point[2] - at[i - 1][2]) / height) : 0));
  const chosen = [];
  for (let i = 0; chosen.length < marksOnCurve && i < at.length; ++i)
    if (along[i] >= (length * (chosen.length + shift)) / marksOnCurve) chosen.push(at[i][0]);
  return chosen;
}

// The markers that tell a curve.
function markersOf(rows, xs, ys, look, keys) {
  return { type: "scatter", mode: "markers", x: rows.map((row) => xs[row]), y: rows.map((row) => ys[row]), rows, keys, hoverinfo: "skip",
    marker: { symbol: look.marker, size: 8, color: "#fff", line: { color: look.colour, width: 1.6 } } };
}

function markerOf(type) {
  const symbol = types[type][1];
  return { symbol, size: { circle: 6, star: 13 }[symbol] || 9, color: ink, line: { color: "#fff", width: 1 } };
}

// One trace for each type of special points, those at the same place once.
function specialTraces(table, rows, xs, ys, hover) {
  const found = new Map();
  const seen = new Set();
  for (const row of rows) {
    const type = table.columns.type[row];
    if (!types[type] || xs[row] === null || ys[row] === null) continue;
    const place = `${type} ${xs[row].toPrecision(8)} ${ys[row].toPrecision(8)}`;
    if (seen.has(place)) continue;
    seen.add(place);
    if (!found.has(type)) found.set(type, { x: [], y: [], rows: [] });
    const points = found.get(type);
    points.x.push(xs[row]);
    points.y.push(ys[row]);
    points.rows.push(row);
  }
  return [...found].map(([type, points]) => ({ type: "scatter", mode: "markers", ...points, keys: [`type ${type}`],
    marker: markerOf(type), hovertemplate: `<b>${types[type][0]}</b><br>${hover}<extra></extra>` }));
}

const typeKey = (type) => ({ key: `type ${type}`, label: types[type][0], sample: { marker: types[type][1] } });
const specialKey = (table) => Object.keys(types).filter((type) => table.columns.type.includes(type)).map(typeKey);

// An area between two curves over the same rows.
function bandOf(rows, xs, low, high, look, keys) {
  const back = [...rows].reverse();
  return { type: "scatter", mode: "lines", keys, rows: [...rows, ...back].map(() => null), hoverinfo: "skip", line: { width: 0 },
    fill: "toself", fillcolor: areaOf(look), x: [...rows, ...back].map((row) => xs[row]),
    y: [...rows.map((row) => low[row]), ...back.map((row) => high[row])] };
}
