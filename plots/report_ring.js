// Of a whole ring, of which sectors.csv has every contact at the special points: which contacts slip along a branch. Between two
// special points, switches among them, each goes on as it left the first one.

// Of a branch its special points one after the other, each with its rows.
function ringPoints({ columns }, branch) {
  const found = new Map();
  columns.point.forEach((point, row) => {
    if (columns.branch[row] !== branch) return;
    if (!found.has(point)) found.set(point, []);
    found.get(point).push(row);
  });
  return [...found].sort((a, b) => a[0] - b[0]).map(([, rows]) => rows);
}

// Of each row of the drawn table that is a special point, its rows of sectors.csv.
function sectorRows(sectors, { columns }, branches) {
  const found = new Map();
  branches.forEach(({ rows }, i) => {
    const points = ringPoints(sectors, i);
    const special = rows.filter((row) => columns.type[row] !== "regular");
    if (special.length !== points.length) return;
    special.forEach((row, k) => found.set(row, points[k]));
  });
  return found;
}

// One trace of rectangles for what sticks and one for what slips; a contact that stays as it is has one for each way.
function stickTraces({ columns }, points, x, each) {
  const cells = { stick: { x: [], y: [] }, slip: { x: [], y: [] } };
  const add = (state, from, to, k) => {
    const [low, high] = [k, k + 1].map((edge) => 0.5 + edge / each);
    cells[state].x.push(from, to, to, from, from, null);
    cells[state].y.push(low, low, high, high, low, null);
  };
  const at = (i, k) => columns[x][points[i][k]];
  const rises = (i, k) => Math.sign(at(i + 1, k) - at(i, k));
  for (let k = 0; k < points[0].length; ++k) {
    for (let from = 0, to = 0; from < points.length - 1; from = to) {
      const state = columns.state[points[from][k]];
      while (to < points.length - 1 && columns.state[points[to][k]] === state && rises(to, k) * rises(from, k) >= 0) ++to;
      add(state, at(from, k), at(to, k), k);
    }
  }
  return Object.entries(cells).map(([state, cell]) => ({ type: "scatter", mode: "lines", keys: [state], rows: cell.x.map(() => null), ...cell,
    hoverinfo: "skip", fill: "toself", fillcolor: `${byStick[state]}${state === "slip" ? "b0" : "30"}`, line: { width: 0 } }));
}

function stickPicture(parent, model) {
  const { sectors, input: { branch } } = model;
  if (!sectors || !["eta", "P"].includes(branch.parameter)) return;
  const { columns } = sectors;
  const each = Math.max(...columns.contact);
  const paths = model.branches.map((_, i) => ringPoints(sectors, i));
  const drawn = paths.map((points, i) => [i, points]).filter(([, points]) => points.length > 1);
  if (!drawn.length) return;
  const x = branch.parameter;
  picture(parent, { name: "sticks", title: "Which contacts slip, round the ring",
    state: { x, y: "sector", branch: drawn[0][0], logX: wantsLog(columns[x]), logY: false },
    controls: (now, update) => [
      ...(drawn.length > 1 ? [choice("of", drawn.map(([i]) => [i, plainText(model.branches[i].label)]), now.branch,
        (value) => { now.branch = Number(value); update(); })] : []),
      tick("log x", now.logX, (value) => { now.logX = value; update(); })],
    panels: (now) => [{ title: "sector", traces: stickTraces(sectors, paths[now.branch], x, each) }],
    axes: () => ({ x: scaledColumn(sectors, x, model.system).title, y: each > 1 ? `sector, its ${each} contacts side by side` : "sector" }),
    key: () => [["Contacts", ["stick", "slip"].map((state) => ({ key: state, label: state === "slip" ? "slips" : "sticks",
      sample: { fill: `${byStick[state]}${state === "slip" ? "b0" : "30"}` } }))]] });
}
