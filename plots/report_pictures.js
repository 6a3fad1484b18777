// A picture: what may be chosen of it, plotly's drawing, and a key whose entries are switches.

const ink = "#1c2430";
const narrow = () => window.innerWidth < 641;
const byTouch = () => matchMedia("(pointer: coarse)").matches;

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === "html") made.innerHTML = value;
    else if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

const outlines = {
  circle: "M4 0A4 4 0 1 1-4 0A4 4 0 1 1 4 0Z", square: "M-4-4H4V4H-4Z", diamond: "M0-5 5 0 0 5-5 0Z",
  "triangle-up": "M0-5 5 4H-5Z", "triangle-down": "M0 5 5-4H-5Z",
  "triangle-left": "M-5 0 4-5V5Z", "triangle-right": "M5 0-4-5V5Z",
  cross: "M-1.6-5H1.6V-1.6H5V1.6H1.6V5H-1.6V1.6H-5V-1.6H-1.6Z", x: "M-5-3-3-5 0-2 3-5 5-3 2 0 5 3 3 5 0 2-3 5-5 3-2 0Z",
  star: "M0-6 1.6-2H6L2.4.8 4 5.5 0 2.6-4 5.5-2.4.8-6-2H-1.6Z",
  hexagram: "M0-6 2-3H5.5L4 0 5.5 3H2L0 6-2 3H-5.5L-4 0-5.5-3H-2Z",
  bowtie: "M-5-5 5 5V-5L-5 5Z", pentagon: "M0-5 5-1.5 3 4.5H-3L-5-1.5Z",
};

// A sample of a line, a marker, both or an area for the key.
function sample({ colour = ink, width = 0, dash = "", marker = "", hollow = false, fill = "" }) {
  const isWide = width > 0 || fill !== "";
  const area = fill ? `<rect x="2" y="1" width="28" height="12" fill="${fill}"/>` : "";
  const line = width
    ? `<line x1="1" x2="31" y1="7" y2="7" stroke="${colour}" stroke-width="${width}" stroke-dasharray="${dash}"/>` : "";
  const mark = marker
    ? `<path transform="translate(16 7)" d="${outlines[marker]}" stroke="${colour}" stroke-width="1.4" ` +
      `fill="${hollow ? "#fff" : colour}"/>` : "";
  return `<svg width="${isWide ? 32 : 14}" height="14" viewBox="${isWide ? "0 0 32 14" : "9 0 14 14"}" ` +
    `aria-hidden="true">${area}${line}${mark}</svg>`;
}

function extent(values) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value === null) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return [low, high];
}

function wantsLog(values) {
  const [low, high] = extent(values);
  return low > 0 && high / low > 30;
}

// ---- What may be chosen ----

function choice(label, options, value, change) {
  const list = element("select", { onchange: (event) => change(event.target.value) },
    ...options.map(([key, text]) => element("option", { value: key }, text)));
  list.value = value;
  return element("label", {}, label, list);
}

function tick(label, value, change) {
  const box = element("input", { type: "checkbox", onchange: (event) => change(event.target.checked) });
  box.checked = value;
  return element("label", {}, box, label);
}

// Both axes of a picture: [[column, text]] for each, and whether they are logarithmic.
function axisControls(state, update, { xs, ys, automatic }) {
  const set = (name) => (value) => {
    state[name] = value;
    if (name === "x" || name === "y") automatic(state);
    update();
  };
  return [choice("y", ys, state.y, set("y")), choice("x", xs, state.x, set("x")),
    tick("log y", state.logY, set("logY")), tick("log x", state.logX, set("logX"))];
}

// ---- Axes ----

// Labels at 2 and 5 where they have room; plotly would put 2 to 9.
const logTicks = ([low, high]) => (high - low > 0.7 && high - low < 3.5 ? "D2" : null);

// The range of a logarithmic axis, without what is `floor` times smaller than the largest value, as rounding errors are.
function logRange(panels, axis, floor = 1e-14) {
  let [low, high] = [Infinity, 0];
  for (const trace of panels.flatMap((panel) => panel.traces)) {
    for (const value of trace[axis]) {
      if (value > high) high = value;
      if (value > 0 && value < low) low = value;
    }
  }
  if (!(high > 0)) return {};
  const ends = [Math.log10(Math.max(low, floor * high)), Math.log10(high)];
  const margin = 0.04 * (ends[1] - ends[0]) || 0.1;
  const range = [ends[0] - margin, ends[1] + margin];
  return { range, dtick: logTicks(range) };
}

// Where the panels stand, and what their axes are called. All have the same scale.
function panelLayout(panels, state, axes) {
  const several = panels.length > 1;
  const columns = !several || narrow() ? 1 : Math.min(3, panels.length);
  const rows = Math.ceil(panels.length / columns);
  const gap = columns > 1 ? 0.075 : 0;
  const width = (1 - gap * (columns - 1)) / columns;
  const layout = { annotations: [] };
  const isLong = several && axes.y && plainText(axes.y).length > 24;  // for the height of a panel
  const up = isLong ? axes.y.replace(" [", "<br>[") : axes.y;
  const common = { gridcolor: "#e3e7ec", linecolor: "#8a94a3", tickcolor: "#8a94a3", zeroline: false, mirror: true,
    ticks: "outside", ticklen: 4, exponentformat: "power", automargin: true };
  panels.forEach((panel, i) => {
    const [column, row] = [i % columns, Math.floor(i / columns)];
    const number = i ? i + 1 : "";
    layout[`xaxis${number}`] = { ...common, type: state.logX ? "log" : "linear", anchor: `y${number}`,
      domain: [column * (width + gap), column * (width + gap) + width], matches: i ? "x" : undefined,
      title: { text: i + columns >= panels.length ? axes.x : "", standoff: 8 }, nticks: columns > 1 ? 6 : undefined };
    layout[`yaxis${number}`] = { ...common, type: state.logY ? "log" : "linear", anchor: `x${number}`,
      domain: [1 - (row + 1 - (rows > 1 ? 0.16 : 0)) / rows, 1 - (row + (several ? 0.07 : 0)) / rows],
      matches: i ? "y" : undefined, title: { text: column ? "" : up || panel.title, standoff: 6 } };
    if (several) {
      layout.annotations.push({ text: `<b>${panel.short}</b>`, showarrow: false, x: 0, y: 1, xanchor: "left",
        yanchor: "bottom", xref: `x${number} domain`, yref: `y${number} domain` });
    }
  });
  for (const axis of ["xaxis", "yaxis"])
    if (layout[axis].type === "log") Object.assign(layout[axis], logRange(panels, axis[0], axes.floor));
  return { ...layout, height: several ? 60 + 270 * rows : narrow() ? 360 : 470 };
}

const settings = (name) => ({ responsive: true, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"],
  toImageButtonOptions: { format: "svg", filename: name } });

function commonLayout(state) {
  return { showlegend: false, hovermode: "closest", dragmode: byTouch() ? false : "zoom", margin: { l: 64, r: 14, t: 12, b: 46 },
    font: { family: getComputedStyle(document.body).fontFamily, size: narrow() ? 11 : 13, color: ink },
    paper_bgcolor: "#fff", plot_bgcolor: "#fff", hoverlabel: { bgcolor: "#fff", bordercolor: "#8a94a3", font: { color: ink, size: 12 } },
    uirevision: `${state.x} ${state.y} ${state.logX} ${state.logY}` };  // of the same axes what is enlarged stays so
}

// After a part has been enlarged.
function adaptTicks(plot) {
  const change = {};
  for (const [name, axis] of Object.entries(plot._fullLayout)) {
    if (!/^[xy]axis\d*$/.test(name) || axis.type !== "log") continue;
    const wanted = logTicks(axis.range);
    if ((plot.layout[name].dtick ?? null) !== wanted) change[`${name}.dtick`] = wanted;
  }
  if (Object.keys(change).length) Plotly.relayout(plot, change);
}

// ---- Pictures ----

// spec: name, title, note, state { x, y, logX, logY, ... }, hidden (keys that are off at first), controls(state, update),
// panels(state): [{ title, short, traces }], axes(state): { x, y, floor }, key(state): [[group, [{ key, label, sample }]]],
// scale(state): HTML above the key, tell(row, state): HTML below it. A trace has `keys`, of which none may be off for it to
// be drawn, and `rows`, the row of each of its points.
function picture(parent, spec) {
  const state = { hidden: new Set(spec.hidden || []), ...spec.state };
  const plot = element("div", { class: "plot", id: `plot-${spec.name}` });
  const controls = element("div", { class: "controls" });
  const key = element("div");
  const readout = element("output", { class: "readout" });
  const note = spec.note ? [element("p", { class: "note" }, spec.note)] : [];
  parent.append(element("figure", { id: `figure-${spec.name}` }, element("figcaption", {}, spec.title),
    controls, plot, key, readout, ...note));
  const made = { div: plot, traces: [] };
  report.pictures[spec.name] = made;

  const visible = (trace) => !trace.keys.some((name) => state.hidden.has(name));
  made.toggle = (name) => {
    state.hidden.has(name) ? state.hidden.delete(name) : state.hidden.add(name);
    for (const button of key.querySelectorAll(`[data-key="${CSS.escape(name)}"]`))
      button.setAttribute("aria-pressed", String(!state.hidden.has(name)));
    return Plotly.restyle(plot, { visible: made.traces.map(visible) });
  };
  const entry = ({ key: name, label, sample: look }) => element("button", { type: "button", "data-key": name,
    "aria-pressed": String(!state.hidden.has(name)), html: `${sample(look)}<span>${label}</span>`, onclick: () => made.toggle(name) });
  const drawKey = () => {
    const groups = spec.key(state).filter(([, entries]) => entries.length);
    key.replaceChildren(...(spec.scale ? [element("div", { class: "scale", html: spec.scale(state) })] : []),
      ...groups.map(([group, entries]) => element("div", { class: "key" }, element("span", {}, group), ...entries.map(entry))));
  };
  made.update = () => {
    const panels = spec.panels(state);
    made.traces = panels.flatMap((panel, i) => panel.traces.map((trace) =>
      ({ ...trace, xaxis: `x${i ? i + 1 : ""}`, yaxis: `y${i ? i + 1 : ""}`, visible: visible(trace) })));
    const data = made.traces.map(({ keys, rows, ...trace }) => ({ ...trace, customdata: rows }));
    controls.replaceChildren(...spec.controls(state, made.update));
    drawKey();
    return Plotly.react(plot, data, { ...commonLayout(state), ...panelLayout(panels, state, spec.axes(state)) }, settings(spec.name));
  };
  made.ready = made.update().then(() => {
    plot.on("plotly_relayout", () => adaptTicks(plot));
    plot.on("plotly_hover", ({ points: [{ customdata: row }] }) => {
      if (spec.tell && row !== undefined && row !== null) readout.innerHTML = spec.tell(row, state);
    });
  });
  return made;
}
