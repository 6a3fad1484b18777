# A panel from `from` to `to` of the parameter, its edges at `l`, `r`, `b` and `t` cm, with the values that are there.

eval place_panel(l, r, b, t)
y_inside(i) = xs[i] >= from && xs[i] <= to ? ys[i] : NaN
set xrange [*:*]  # since stats keeps to the ranges that are set
set yrange [*:*]
unset logscale
stats xs using (y_inside(int($1))) nooutput
if (exists("STATS_min")) {
  y_low = STATS_min < STATS_max ? STATS_min : 0.9 * STATS_min
  y_high = STATS_min < STATS_max ? STATS_max : 1.1 * STATS_max
} else {
  y_low = 0.1
  y_high = 1
}

is_labelled = 1
axis = "x"; low = from; high = to; count = (r - l) / 0.65
load style."/axis.gp"
axis = "y"; low = value_at(y_low, y_high, -0.05); high = value_at(y_low, y_high, 1.07); count = (t - b) / 0.65
load style."/axis.gp"
if (exists("reference") && low < reference && reference < high) {
  set arrow from graph 0, first reference to graph 1, first reference nohead back linewidth frame dashtype (10, 8)
  if (from == x_low) { set label reference_title at graph 0.02, first reference offset 0, 0.5 }
}
load style."/curves.gp"
