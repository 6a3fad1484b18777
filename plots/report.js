// The page: the answer, pictures, tables, the case.

const report = { pictures: {}, errors: [] };
window.arcslipReport = report;
window.addEventListener("error", (event) => report.errors.push(event.message));
window.addEventListener("unhandledrejection", (event) => report.errors.push(String(event.reason)));

// The results, with columns of texts as lists of texts.
function readData() {
  const data = JSON.parse(document.getElementById("data").textContent);
  Object.assign(frictionModels, data.models);
  const tables = [...Object.values(data.run || {}), ...Object.values(data.study || {})].filter((one) => one.columns);
  for (const { columns } of tables) {
    for (const [name, column] of Object.entries(columns))
      if (!Array.isArray(column)) columns[name] = column.at.map((place) => column.words[place]);
  }
  return data;
}

// A sentence as it is printed, with signs that every browser has.
const spoken = (sentence) => sentence.replace(/(\d) um\b/g, "$1 µm").replace(/\beta = /g, "η = ");

function answers({ run, study }) {
  const boxes = [study, run].filter(Boolean).map(({ answer }, i) => element("section",
    { class: "answer", id: i ? "answer-run" : "answer" }, ...answer.map((text) => element("p", {}, spoken(text)))));
  const remarks = (study?.summary.remarks || []).map((text) => element("p", { class: "meaning" }, spoken(text)));
  return [...boxes, ...remarks];
}

function thinned(table, what) {
  if (!table || table.every < 2) return [];
  return [paragraph(`Of the ${table.rows} rows of ${what} the special ones and every ${table.every}th other one are drawn.`, { class: "note" })];
}

const hints = { mouse: "Drag over a picture to enlarge a part, double-click to see all again; point at a curve for its values; click in the " +
    "key to take curves out.",
  touch: "Tap on a curve for its values, in the key to take curves out, on the signs above a picture to enlarge it.",
  nothing: "Nothing is drawn: there are neither branches, nor peaks over the preload in sweep.csv, nor designs that differ in numbers." };

// Draws all pictures into the section, and gives the models that they and the tables share.
function drawPictures(section, { run, study }) {
  const hint = element("p", { class: "note" }, byTouch() ? hints.touch : hints.mouse);
  section.append(heading(2, "Pictures"), hint);
  const models = { study: study && studyPictures(section, study), run: run && runPictures(section, run) };
  section.append(...thinned(run?.points, run?.table), ...thinned(study?.sweep, "sweep.csv"), ...thinned(study?.optimum, "optimum.csv"));
  if (!Object.keys(report.pictures).length) hint.textContent = hints.nothing;
  return models;
}

function cases({ run, study }) {
  const all = [run && ["All keys, with their defaults", run], study && [`All keys${run ? " of the study" : ""}, with their defaults`, study]];
  return [heading(2, "The case", "case"), ...all.filter(Boolean).map(([text, { summary }]) =>
    element("details", {}, element("summary", {}, text), element("pre", {}, toml(summary.case))))];
}

function page(data) {
  const { run, study } = data;
  const { summary } = run || study;
  const name = summary.title || "Results of arcslip";
  document.title = `${name} – arcslip report`;
  const nav = element("nav", { "aria-label": "Sections" });
  const other = data.by === data.arcslip ? "" : `, reported by arcslip ${data.arcslip}`;
  const pictures = element("section", { id: "pictures" });
  const tables = element("section", { id: "tables" }, heading(2, "Tables"));
  const main = element("main", {}, ...answers(data), pictures, tables);
  document.body.prepend(element("header", {}, heading(1, name), element("p", {}, `Computed by arcslip ${data.by}${other}`), nav), main);

  const models = drawPictures(pictures, data);
  if (study) tables.append(...studyTables(study, models.study));
  if (run) {
    tables.append(heading(3, "Branches"), ...branchTable(run), heading(3, "Special points"), ...specialTable(run, models.run));
    main.append(...certificates(run), ...verification(run));
  }
  main.append(...cases(data));
  document.body.append(element("footer", {}, `arcslip ${data.arcslip}. Pictures by plotly.js (MIT licence), which this page holds; ` +
    "nothing is loaded from elsewhere."));
  const sections = { answer: "Answer", pictures: "Pictures", tables: "Tables", proven: "Proven", verified: "Solved anew", case: "Case" };
  for (const [id, text] of Object.entries(sections))
    if (document.getElementById(id)) nav.append(element("a", { href: `#${id}` }, text));
}

page(readData());
report.ready = Promise.all(Object.values(report.pictures).map((one) => one.ready));

let wasNarrow = narrow();
window.addEventListener("resize", () => {
  if (narrow() === wasNarrow) return;
  wasNarrow = narrow();
  for (const one of Object.values(report.pictures)) one.update();
});

// Paper is narrower than most screens, and pictures do not follow by themselves.
const paperWidth = 680;
window.addEventListener("beforeprint", () => Object.values(report.pictures).forEach(({ div }) =>
  Plotly.relayout(div, { autosize: false, width: Math.min(paperWidth, div.clientWidth) })));
window.addEventListener("afterprint", () => Object.values(report.pictures).forEach(({ div }) =>
  Plotly.relayout(div, { autosize: true, width: null })));
