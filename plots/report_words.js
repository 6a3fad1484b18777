// What columns, keys and types of points are called, and numbers as people read them.

const greek = { alpha: "α", beta: "β", gamma: "γ", delta: "δ", epsilon: "ε", zeta: "ζ", eta: "η", kappa: "κ",
  lambda: "λ", mu: "μ", nu: "ν", xi: "ξ", rho: "ρ", sigma: "σ", tau: "τ", omega: "ω", Omega: "Ω" };

// Of models with friction the unit of eta in SI, "" where it is relative to a natural frequency; from the page's data.
const frictionModels = {};

// Words, symbol and unit; "?" stands for the unit that the matrices of a sector have.
const quantities = {
  eta: ["frequency", "η", "Hz?"], frequency_Hz: ["frequency", "f", "Hz"],
  P: ["preload", "P", "?"], preload_N_per_m: ["preload", "p<sub>0</sub>", "N/m"],
  preload_low_N_per_m: ["lower end", "p<sub>0</sub>", "N/m"], preload_high_N_per_m: ["upper end", "p<sub>0</sub>", "N/m"],
  preload_N: ["preload", "P", "N"], preload_low_N: ["lower end", "P", "N"], preload_high_N: ["upper end", "P", "N"],
  R: ["relative amplitude", "R", "m?"], R_m: ["relative amplitude", "R", "m"],
  S: ["slip threshold", "S", "m?"], S_m: ["slip threshold", "S", "m"],
  R_over_S: ["relative amplitude over slip threshold", "R/S", "1"],
  Y: ["amplitude of the base", "Y", "m?"], Y_m: ["amplitude of the base", "Y", "m"],
  U: ["amplitude of the damper", "U", "m?"], U_m: ["amplitude of the damper", "U", "m"],
  beta: ["phase of the base", "β", "rad"], alpha: ["phase of the damper", "α", "rad"],
  psi: ["phase of the relative motion", "ψ", "rad"], lag: ["lag behind the load", "", "rad"],
  dissipated: ["energy lost per cycle and contact over k S<sup>2</sup>", "", "1"],
  dissipated_J: ["energy lost per cycle by the ring", "", "J"], energy_J: ["energy lost per cycle", "", "J"],
  energy: ["energy lost per cycle", "", "1"], zeta: ["damping ratio", "ζ", "1"], zeta_B: ["damping of the base", "ζ<sub>B</sub>", "1"],
  growth: ["growth of disturbances in a period", "", "1"], arclength: ["scaled arclength", "s", "1"],
  eta_peak: ["frequency of the peak", "η", "Hz?"], Y_max: ["height of the peak", "Y", "m?"],
  ratio: ["height over that of the free base", "Y/Y<sub>free</sub>", "1"],
  P_opt: ["best preload", "P", "?"], P_low: ["lower end", "P", "?"], P_high: ["upper end", "P", "?"],
  eta_opt: ["frequency of the peak", "η", "Hz?"], Y_opt: ["lowest highest peak", "Y", "m?"],
  ratio_opt: ["lowest highest peak over the free base", "Y/Y<sub>free</sub>", "1"],
  Y_nd_max: ["free base", "Y<sub>free</sub>", "m?"], Y_nd_max_m: ["free base", "Y<sub>free</sub>", "m"],
  zeta_eq: ["equivalent damping ratio of the base", "ζ<sub>eq</sub>", "1"],
  P_q95: ["best preload with scatter", "P", "?"], Y_q95: ["95 % quantile there", "Y", "m?"],
  Y_q95_m: ["95 % quantile there", "Y", "m"], Y_q95_opt: ["95 % quantile at the best preload without scatter", "Y", "m?"],
  ratio_q95: ["95 % quantile there over the free base", "", "1"],
  ratio_q95_opt: ["95 % quantile at the best preload without scatter, over the free base", "", "1"],
  mass_ratio: ["mass ratio", "M*", "1"], frequency_ratio: ["frequency ratio", "γ", "1"],
  slenderness: ["slenderness", "L/h<sub>D</sub>", "1"], interface_stiffness: ["interface stiffness", "K<sub>FD</sub>", "1"],
  F: ["force", "F", "?"], zeta_D: ["damping of the damper", "ζ<sub>D</sub>", "1"], K_FD: ["interface stiffness", "K<sub>FD</sub>", "1"],
  "M*": ["mass ratio", "M*", "1"], gamma: ["frequency ratio", "γ", "1"], preload: ["preload", "P", "?"], force: ["force", "F", "?"], wave_number: ["waves", "n", "1"],
  preload_per_length: ["preload", "p<sub>0</sub>", "N/m"], force_per_length: ["force", "f<sub>0</sub>", "N/m"],
  "damper.width": ["width of the damper", "", "m"], "damper.height": ["height of the damper", "", "m"],
  "base.width": ["width of the base", "", "m"], "base.height": ["height of the base", "", "m"], radius: ["radius", "r", "m"] };

const types = { switch: ["switch of stick and slip", "circle"], peak: ["peak", "triangle-up"], trough: ["trough", "triangle-down"],
  fold: ["fold", "square"], corner_fold: ["fold at a corner", "pentagon"], branch_point: ["branch point", "x"],
  hopf: ["Hopf point", "star"], neimark_sacker: ["Neimark-Sacker point", "hexagram"], period_doubling: ["period doubling", "bowtie"],
  symmetry_breaking: ["symmetry breaking", "bowtie"], user: ["requested value", "cross"], cusp: ["cusp", "triangle-left"],
  bogdanov_takens: ["Bogdanov-Takens point", "hexagram"], zero_hopf: ["zero-Hopf point", "x"], hopf_hopf: ["double Hopf point", "bowtie"],
  generalized_hopf: ["generalised Hopf point", "diamond"], resonance_1_1: ["1:1 resonance", "triangle-down"],
  resonance_1_2: ["1:2 resonance", "triangle-down"], resonance_1_3: ["1:3 resonance", "triangle-down"], resonance_1_4: ["1:4 resonance", "triangle-down"],
  chenciner: ["Chenciner point", "diamond"], generalized_period_doubling: ["generalised period doubling", "diamond"], fold_flip: ["fold-flip point", "hexagram"], fold_neimark_sacker: ["fold-Neimark-Sacker point", "hexagram2"],
  flip_neimark_sacker: ["flip-Neimark-Sacker point", "hexagon"], double_neimark_sacker: ["double Neimark-Sacker point", "bowtie"],
  isola_centre: ["isola centre", "star"], simple_bifurcation: ["simple bifurcation", "x"],
  birth: ["birth of a peak", "triangle-right"], death: ["death of a peak", "triangle-left"], corner: ["corner", "pentagon"],
  exchange: ["exchange of two peaks", "x"], optimum: ["best preload", "star"], robust: ["best preload with scatter", "diamond"] };

// Heads of columns in tables, where a symbol alone would not tell them apart.
const heads = { P_opt: "best P", P_low: "P from", P_high: "P to", preload_N_per_m: "p<sub>0</sub> [N/m]", preload_low_N_per_m: "from [N/m]",
  preload_high_N_per_m: "to [N/m]", preload_N: "P [N]", preload_low_N: "from [N]", preload_high_N: "to [N]", eta_opt: "at η", Y_opt: "highest peak Y", Y_nd_max: "free base Y", Y_m: "Y [m]", Y_nd_max_m: "free base [m]",
  eta_peak: "at η", curve: "design", P_q95: "best P", Y_q95: "95 % below Y", Y_q95_m: "95 % below [m]", ratio_q95: "ratio",
  Y_q95_opt: "Y at P<sub>opt</sub>", ratio_q95_opt: "ratio at P<sub>opt</sub>", power_error: "error of power", motion_error: "error of motion" };

// The preload in SI units, of rings per length: its column among these, or undefined.
const preloadIn = (columns) => ["preload_N_per_m", "preload_N"].find((name) => name in columns);

// The unit of a column that is in one, after a space.
const unitOfColumn = (name) => (/_(m|J|Hz|N_per_m|N)$/.test(name) ? ` ${describe(name).unit}` : "");

function symbolOf(name) {
  if (quantities[name]) return quantities[name][1];
  const [, stem, index] = name.match(/^([A-Za-z]+?)_?(\d*|[A-Z]{1,2})$/) || [null, name, ""];
  if (!greek[stem] && stem.length > 1) return harmless(name.replaceAll("_", " "));
  return (greek[stem] || stem) + (index ? `<sub>${index}</sub>` : "");
}

// { words, symbol, unit }: `system` is that of the case, by which the unit follows.
function describe(name, system) {
  const harmonic = name.match(/^([YUR])(?:_(\d+))?_(h(\d+)|peak)$/);
  if (harmonic) {
    const base = describe(harmonic[1], system);
    const which = harmonic[4] ? `harmonic ${harmonic[4]}` : "greatest value in time";
    return { ...base, words: `${base.words}${harmonic[2] ? " " + harmonic[2] : ""}, ${which}` };
  }
  const found = quantities[name] || ["", symbolOf(name), ""];
  const known = system && system.model in frictionModels;
  let unit = known || !/[?1]$/.test(found[2]) ? found[2] : "";
  if (unit.endsWith("?")) {
    const ofEta = frictionModels[system.model];
    unit = ofEta ? ({ "?": "N", "Hz?": ofEta }[unit] || unit.slice(0, -1)) + " of SI matrices" : "1";
  }
  return { words: found[0], symbol: found[1], unit };
}

// What to divide lengths and energies by for numbers that are read easily, and the unit's prefix.
function prefix(unit, largest) {
  if (!["m", "J"].includes(unit) || !(largest > 0)) return [1, unit];
  for (const [size, sign] of [[1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]]) {
    if (largest >= size) return [size, sign + unit];
  }
  return [1e-9, "n" + unit];
}

function title(words, unit) {
  const text = [words.words, words.symbol ? `<i>${words.symbol}</i>` : ""].filter(Boolean).join(" ");
  return unit ? `${text} [${unit}]` : text;
}

const harmless = (text) => text.replace(/[&<>"]/g, (sign) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[sign]);
const plainText = (html) => html.replace(/<[^>]*>/g, "");

function short(value, digits = 7) {
  if (value === null || value === undefined) return "–";
  if (typeof value !== "number") return String(value);
  if (value === 0 || (Math.abs(value) >= 1e-4 && Math.abs(value) < 1e7)) return String(Number(value.toPrecision(digits)));
  return String(Number(value.toPrecision(digits)).toExponential()).replace("e+", "e");
}

// "P = 0.1, M* = 5" of what for_each sets.
function labelOf(values, keys) {
  const parts = keys.filter((key) => key in values).map((key) => {
    const words = describe(key, null);
    const unit = (quantities[key] || [])[2];
    const value = typeof values[key] === "number" ? short(values[key], 6) : harmless(typeof values[key] === "string" ? values[key] : JSON.stringify(values[key]));
    return `${words.symbol || words.words} = ${value}${unit && !/[?1]$/.test(unit) ? " " + unit : ""}`;
  });
  return parts.join(", ");
}

// The case as its file could have had it.
function toml(value, path = []) {
  const isTable = (x) => x !== null && typeof x === "object" && !Array.isArray(x);
  const key = (x) => (/^[A-Za-z0-9_-]+$/.test(x) ? x : JSON.stringify(x));
  const inline = (x) => isTable(x) ? `{ ${Object.entries(x).map(([k, v]) => `${key(k)} = ${inline(v)}`).join(", ")} }`
    : Array.isArray(x) ? `[${x.map(inline).join(", ")}]` : JSON.stringify(x);
  const own = Object.entries(value).filter(([, v]) => !(isTable(v) && path.length === 0));
  const lines = own.map(([k, v]) => `${key(k)} = ${inline(v)}`);
  if (path.length) lines.unshift(`[${path.join(".")}]`);
  const tables = Object.entries(value).filter(([, v]) => isTable(v) && path.length === 0);
  return [lines.join("\n"), ...tables.map(([k, v]) => toml(v, [k]))].filter(Boolean).join("\n\n");
}
