// Maps of a chart: what the best preload is and gives over two keys, each value with each, in shades of rising brightness.

const steps = 12;
const shades = ["#440154", "#414487", "#2a788e", "#22a884", "#7ad151", "#fde725"];

function shade(level) {
  const at = (level / (steps - 1)) * (shades.length - 1);
  const i = Math.min(Math.floor(at), shades.length - 2);
  const part = (colour, k) => parseInt(colour.slice(1 + 2 * k, 3 + 2 * k), 16);
  const mixed = (k) => Math.round(part(shades[i], k) + (at - i) * (part(shades[i + 1], k) - part(shades[i], k)));
  return "#" + [0, 1, 2].map((k) => mixed(k).toString(16).padStart(2, "0")).join("");
}

// Of a key: its values in rising order, where their cells end, and whether they are spaced as logarithms.
function mapAxis(model, key) {
  const values = model.study.optimum.columns[key];
  const sorted = [...new Set(values)].sort((a, b) => a - b);
  const unevenness = (f) => { const [low, high] = extent(sorted.slice(1).map((value, i) => f(value) - f(sorted[i]))); return high / low; };
  const same = (value) => value;
  const log = sorted[0] > 0 && sorted.length > 2 && unevenness(Math.log) < unevenness(same);
  const [to, from] = log ? [Math.log, Math.exp] : [same, same];
  const middles = sorted.slice(1).map((value, i) => (to(value) + to(sorted[i])) / 2);
  const last = sorted.length - 1;
  const ends = [2 * to(sorted[0]) - middles[0], ...middles, 2 * to(sorted[last]) - middles[last - 1]].map(from);
  return { key, values, sorted, ends, log, place: new Map(sorted.map((value, i) => [value, i])), words: describe(key, model.system) };
}

// Whether every value of one key stands with every value of another.
function isGrid(model) {
  const { columns, every } = model.study.optimum;
  if (model.differs.length !== 2 || every > 1) return false;
  const [a, b] = model.differs.map((key) => columns[key]);
  if ([...a, ...b].some((value) => typeof value !== "number")) return false;
  const pairs = new Set(a.map((value, i) => `${value} ${b[i]}`));
  return pairs.size === a.length && pairs.size === new Set(a).size * new Set(b).size;
}

// How values become levels: { level(value), ends }.
function scaleOf(values, log) {
  const [low, high] = extent(log ? values.filter((value) => value > 0) : values);
  const [to, from] = log ? [Math.log, Math.exp] : [(value) => value, (value) => value];
  const width = (to(high) - to(low)) / steps || 1;
  const level = (value) => (value === null || (log && value <= 0) ? null : Math.min(steps - 1, Math.floor((to(value) - to(low)) / width)));
  return { level, ends: Array.from({ length: steps + 1 }, (_, i) => from(to(low) + i * width)) };
}

// The cells of each level as one trace of many rectangles; neighbours in a row are one.
function cellTraces(across, up, levels) {
  const grid = up.sorted.map(() => new Array(across.sorted.length).fill(null));
  levels.forEach((level, i) => { grid[up.place.get(up.values[i])][across.place.get(across.values[i])] = level; });
  const cells = Array.from({ length: steps }, () => ({ x: [], y: [] }));
  grid.forEach((line, j) => {
    for (let from = 0, to = 0; from < line.length; from = to) {
      while (to < line.length && line[to] === line[from]) ++to;
      if (line[from] === null) continue;
      const [left, right, bottom, top] = [across.ends[from], across.ends[to], up.ends[j], up.ends[j + 1]];
      cells[line[from]].x.push(left, right, right, left, left, null);
      cells[line[from]].y.push(bottom, bottom, top, top, bottom, null);
    }
  });
  return cells.map((cell, level) => ({ type: "scatter", mode: "lines", keys: [], rows: cell.x.map(() => null), ...cell, hoverinfo: "skip",
    fill: "toself", fillcolor: shade(level), line: { width: 0.6, color: shade(level) } })).filter((trace) => trace.x.length);
}

// What the pointer finds, and the best design.
function mapPoints(model, across, up, value) {
  const symbol = (axis) => axis.words.symbol || axis.words.words;
  const points = { type: "scatter", mode: "markers", keys: [], rows: across.values.map((_, i) => i), x: across.values, y: up.values,
    marker: { opacity: 0, size: 12 }, text: value.values.map((one) => `${short(one, 5)} ${unitText(value.unit)}`),
    hovertemplate: `<b>%{text}</b><br>${symbol(across)} = %{x:.5~g}, ${symbol(up)} = %{y:.5~g}<extra></extra>` };
  if (model.best < 0) return [points];
  return [points, { type: "scatter", mode: "markers", keys: ["type optimum"], rows: [model.best], x: [across.values[model.best]],
    y: [up.values[model.best]], hoverinfo: "skip", marker: { symbol: "star", size: 15, color: "#fff", line: { color: ink, width: 1.6 } } }];
}

function scaleKey({ ends }, value) {
  const fields = Array.from({ length: steps }, (_, i) => {
    const middle = i === steps / 2 - 1 ? `<span>${short(ends[i + 1], 3)}</span>` : "";
    return `<i style="background:${shade(i)}" title="${short(ends[i], 3)} to ${short(ends[i + 1], 3)}"></i>${middle}`;
  });
  return `<span>${short(ends[0], 3)}</span>${fields.join("")}<span>${short(ends[steps], 3)}</span><span>${value.title}</span>`;
}

function mapPicture(parent, model) {
  const table = model.study.optimum;
  const [across, up] = model.differs.map((key) => mapAxis(model, key));
  const shown = known(table, model.isSI ? ["ratio_opt", model.preload, "Y_m", "frequency_Hz"] : ["ratio_opt", "P_opt", "eta_opt", "Y_opt"]);
  const column = (name) => scaledColumn(table, name, model.system);
  const isLog = (name) => wantsLog(table.columns[name]);
  picture(parent, { name: "map", title: "Best preload over two keys",
    state: { x: across.key, y: shown[0], logX: across.log, logY: up.log, logShades: isLog(shown[0]) },
    controls: (now, update) => {
      const set = (name) => (value) => { Object.assign(now, { [name]: value }, name === "y" ? { logShades: isLog(value) } : {}); update(); };
      return [choice("shows", shown.map((name) => [name, plainText(column(name).title)]), now.y, set("y")),
        tick("log shades", now.logShades, set("logShades")), tick("log y", now.logY, set("logY")), tick("log x", now.logX, set("logX"))];
    },
    panels: (now) => {
      const value = column(now.y);
      const { level } = scaleOf(value.values, now.logShades);
      return [{ title: title(up.words, up.words.unit),
        traces: [...cellTraces(across, up, value.values.map(level)), ...mapPoints(model, across, up, value)] }];
    },
    axes: () => ({ x: title(across.words, across.words.unit) }),
    scale: (now) => { const value = column(now.y); return scaleKey(scaleOf(value.values, now.logShades), value); },
    key: () => [["Points", [{ key: "type optimum", label: "design on which the damper does most", sample: { marker: "star", hollow: true } }]]],
    tell: (i) => `<b>${model.designs[i].label}</b>: ` +
      shown.map(column).map((value) => `${value.title} ${short(value.values[i], 6)}`).join(", ") });
}
