# Phases of base, damper and relative motion behind the excitation. Beside the whole range, where peaks crowd.

style = ARG1; csv = ARG2; picture = ARG3; format = ARG4; shared = ARG5; labels = ARG6; groups = ARG7; names = ARG8
load style."/style.gp"
load style."/data.gp"

load style."/turns.gp"
quantity(row) = followed(column(name), column("point") == 0)
array names[3] = ["beta", "alpha", "psi"]
array titles[3] = ["base", "damper", "relative"]
array symbols[3] = ["β", "α", "ψ"]

name = names[1]
load style."/read.gp"
load style."/windows.gp"

left_edge = 1.75
bottom = 0.95
row = 2.4
top = bottom + 3 * row
body = top + (windows ? 0.4 : 0.1)
load style."/key.gp"

# Columns: the whole range and the windows.
array column_left[3] = [left_edge, left_edge + (windows == 1 ? 3.4 : 2.8), right_edge - 1.68]
column_right(c) = c <= windows ? column_left[c + 1] - (c == 1 ? 0.3 : 0.15) : right_edge
column_from(c) = c == 1 ? x_low : window_low[c - 1]
column_to(c) = c == 1 ? x_high : window_high[c - 1]

# Labels at multiples of pi / 2, k being their number; where those are many, of a multiple of pi.
multiple(k, unit) = k == 0 ? "0" : (k < 0 ? "−" : "").(abs(k) == 1 ? "" : sprintf("%d", abs(k))).unit
angle(k) = k % 2 ? multiple(k, "π/2") : multiple(k / 2, "π")

set label "phase behind the excitation" at screen across(0.22), up(0.5 * (bottom + top)) center rotate
set label x_title at screen across(0.5 * (left_edge + right_edge)), up(0.22) center
do for [n = 1:3] {
  name = names[n]
  if (n > 1) { load style."/read.gp" }
  set xrange [*:*]  # since stats keeps to the ranges that are set
  set yrange [*:*]
  unset logscale
  stats ys using (ys[int($1)]) nooutput
  y_low = exists("STATS_min") ? floor(2 * STATS_min + 0.1) / 2.0 : 0  # at a label, but for rounding errors
  y_high = exists("STATS_max") ? ceil(2 * STATS_max - 0.1) / 2.0 : 1
  y_high = y_high > y_low ? y_high : y_low + 0.5
  every = y_high - y_low < 3 ? 1 : 2 * ceil((y_high - y_low) / 6)
  do for [c = 1:1 + windows] {
    l = column_left[c]; r = column_right(c); t = top - (n - 1) * row; b = t - row
    eval place_panel(l, r, b, t)
    axis = "x"; low = column_from(c); high = column_to(c); length = r - l; is_labelled = n == 3
    load style."/axis.gp"
    set yrange [y_low - 0.09 * (y_high - y_low):y_high + 0.09 * (y_high - y_low)]
    set ytics ("" 0)
    do for [k = round(2 * y_low):round(2 * y_high)] {
      set ytics add ((c == 1 && k % every == 0 ? angle(k) : "") 0.5 * k)
    }
    if (c == 1) {
      y_title = titles[n].blank.blank."{/:Italic ".symbols[n]."}"
      set label y_title at screen across(0.65), up(0.5 * (b + t)) center rotate
    }
    if (n == 1 && windows) {
      set label letter(c - 1) at screen across(c == 1 ? l + 0.1 : 0.5 * (l + r)), up(t + 0.2) center
    }
    is_marked(x0) = c > 1 || !in_window(x0)
    do for [w = 1:(c == 1 ? windows : 0)] { eval shade_window(w) }
    load style."/curves.gp"
    unset label
    unset arrow
    unset object
  }
}
