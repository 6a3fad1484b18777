// The tables of a page, and what certificates and verification mean.

const mostRows = 500;  // of a table on the page

const heading = (level, text, id) => element(`h${level}`, id ? { id } : {}, text);
const paragraph = (html, attributes = {}) => element("p", { ...attributes, html });

function headOf(column, system) {
  const { words, symbol, unit } = describe(column, system);
  return heads[column] || `${symbol || words || harmless(column)}${unitText(unit) ? ` [${unit}]` : ""}`;
}

// The order of rows by a column, what is empty last.
function sorter(rows, by, rising) {
  const value = (i) => rows[i][by] ?? Infinity;
  return (a, b) => (value(a) < value(b) ? -1 : value(a) > value(b) ? 1 : a - b) * (rising ? 1 : -1);
}

// A table of rows { column: value }, which a click on the head of a column sorts; `best` is the row to stand out, `long` are
// columns of sentences. A cell's title has all digits.
function tableOf(name, columns, rows, { system = null, best = -1, long = [] } = {}) {
  const isWord = (column) => rows.some((row) => typeof row[column] === "string");
  const classOf = (column) => (long.includes(column) ? "word long" : isWord(column) ? "word" : "");
  const cell = (row, column) => element("td", { class: classOf(column), title: row[column] ?? "" }, short(row[column]));
  const body = element("tbody");
  const order = rows.map((_, i) => i);
  const fill = () => body.replaceChildren(...order.slice(0, mostRows).map((i) =>
    element("tr", i === best ? { class: "best" } : {}, ...columns.map((column) => cell(rows[i], column)))));
  let sorted = { by: "", rising: true };
  const sortBy = (by) => {
    sorted = { by, rising: sorted.by !== by || !sorted.rising };
    order.sort(sorter(rows, by, sorted.rising));
    fill();
  };
  const head = columns.map((column) => element("th", { class: classOf(column), scope: "col" },
    element("button", { type: "button", title: column, html: headOf(column, system), onclick: () => sortBy(column) })));
  fill();
  const made = element("div", { class: "scroll", tabindex: "0", id: `table-${name}` },
    element("table", {}, element("thead", {}, element("tr", {}, ...head)), body));
  return rows.length > mostRows ? [made, paragraph(`The first ${mostRows} of ${rows.length} rows.`, { class: "note" })] : [made];
}

function rowsOf({ columns }) {
  const names = Object.keys(columns);
  return columns[names[0]].map((_, i) => Object.fromEntries(names.map((name) => [name, columns[name][i]])));
}

const filled = (columns, rows) => columns.filter((column) => rows.some((row) => row[column] !== undefined && row[column] !== null));

// ---- A run ----

const stops = { reached_end: "whole", left_range: "back over its first value", closed_loop: "closed", own_image: "on its own image", requested: "as asked for",
  left_regime: "on a border", infinite_period: "period without end" };
const rounded = (value) => (typeof value === "number" ? Number(value.toPrecision(2)) : value);

function branchTable({ summary: { branches, case: input } }) {
  const keys = [...new Set(branches.flatMap((branch) => Object.keys(branch.values)))];
  const rows = branches.map((branch) => {
    const isPeak = ({ type, Y }) => branch.peak && type === "peak" && Y === branch.peak.Y;
    const { eta, Y, R_over_S, frequency_Hz, Y_m } = (branch.special || []).find(isPeak) || branch.peak || {};
    const values = keys.map((key) => [key, typeof branch.values[key] === "object" ? JSON.stringify(branch.values[key]) : branch.values[key]]);
    return { branch: branch.branch, ...Object.fromEntries(values), points: branch.points, eta, Y, R_over_S, frequency_Hz, Y_m,
      power_error: rounded(branch.power_error), motion_error: rounded(branch.motion_error), ended: stops[branch.stop] || branch.explanation };
  });
  return tableOf("branches", filled(Object.keys(rows[0]), rows), rows, { system: settingsOf(input), long: ["ended"] });
}

function specialTable(run, model) {
  const rows = run.summary.branches.flatMap((branch, i) => (branch.special || []).map(({ type, state, ...numbers }) =>
    ({ of: model.branches[i] ? plainText(model.branches[i].label) : "", point: type.replaceAll("_", " "), ...numbers })));
  return tableOf("special", [...new Set(rows.flatMap(Object.keys))], rows, { system: model.system });
}

function certificateRow({ branch, certificate }) {
  const { proven, gap, from, to, boxes, widest, folds, single_valued } = certificate;
  const range = ({ low, high, certain }) => `${certain ? "" : "perhaps "}${short(low, 9)} to ${short(high, 9)}`;
  return { branch, proven: proven ? "yes" : `no: ${gap ? gap.reason : ""}`, from, to, boxes, widest,
    folds: folds.map(range).join("; ") || "none", "other solutions": single_valued ? "none" : "not excluded" };
}

function certificates(run) {
  const rows = run.summary.branches.filter((branch) => branch.certificate).map(certificateRow);
  if (!rows.length) return [];
  return [heading(2, "What is proven", "proven"), ...tableOf("certificates", Object.keys(rows[0]), rows, { long: ["folds"] }),
    paragraph(`Interval arithmetic encloses each of these branches in boxes. In every box there is exactly one solution for each
      value of the parameter, and neighbouring boxes hold the same one: the branch exists, has no fold but those named, and
      nothing was jumped. Where other solutions are excluded, the response has no other one at all at these frequencies. Proven
      is the equation in one harmonic with its numbers as double precision holds them; whether the model fits the structure is
      not.`, { class: "meaning" })];
}

function verification(run) {
  if (!run.verified) return [];
  return [heading(2, "What was solved anew", "verified"),
    ...tableOf("verified", Object.keys(run.verified.columns), rowsOf(run.verified), { system: run.summary.case.system }),
    paragraph(`These points were solved again by other means. <i>Y harmonics</i> is the amplitude with more harmonics of the
      friction force, <i>Y time</i> that of all nodes integrated in time with their contacts, which assumes no travelling wave;
      differences are relative to the traced <i>Y</i>. <i>Growth</i> is the largest factor by which a disturbance grows in a
      period: below 1 the response is stable. The <i>error of power</i> is how far the work of the force is from what is
      dissipated. Where nothing stands, that way was not taken.`, { class: "meaning" })];
}

// ---- A study ----

const mainColumns = ["P_opt", "P_low", "P_high", "eta_opt", "Y_opt", "Y_nd_max", "ratio_opt", "R_over_S", "zeta_eq", "kind"];
const mainColumnsSI = (preload) => [preload, ...limits[preload], "frequency_Hz", "Y_m", "Y_nd_max_m",
  "ratio_opt", "P_opt", "eta_opt", "Y_opt", "R_over_S", "zeta_eq", "kind"];

function studyTables(study, model) {
  const rows = rowsOf(study.optimum);
  const main = filled([...model.keys, ...(model.isSI ? mainColumnsSI(model.preload) : mainColumns)], rows);
  const parts = [heading(3, "Best preloads"), ...tableOf("optimum", main, rows, { system: model.system, best: model.best }),
    element("details", {}, element("summary", {}, "All columns of optimum.csv"),
      ...tableOf("optimum-all", Object.keys(study.optimum.columns), rows))];
  if (study.robust) {
    parts.push(heading(3, "With scatter"),
      ...tableOf("robust", Object.keys(study.robust.columns), rowsOf(study.robust), { system: model.system }),
      paragraph(`At the best <i>P</i> the 95 % quantile of the highest peak is lowest. The <i>error</i> is estimated of the
        interpolation, the <i>sampling error</i> is the relative standard error from the number of samples.`, { class: "meaning" }));
  }
  const failed = (study.summary.failed || []).map(({ curve, failure }) => ({ curve, why: failure }));
  if (failed.length) parts.push(heading(3, "Designs that failed"), ...tableOf("failed", ["curve", "why"], failed, { long: ["why"] }));
  return parts;
}
