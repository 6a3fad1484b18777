# quantity(0) over the parameter: the whole range in one panel and, below it, the ranges where peaks crowd. The
# vertical axis is called `y_title` and `y_symbol`. At `reference`, if there is one, a line is drawn, and called
# `reference_title`.

is_lowest = 1
load style."/read.gp"
load style."/windows.gp"

bottom = 0.95
below = windows ? bottom + 3.1 + 1.0 : bottom  # lower edge of the upper panel
top = below + (windows ? 4.2 : 5.4)
body = top + 0.4  # for the letters of the panels, or a power of ten
load style."/key.gp"

set label y_title.blank.blank.y_symbol at screen across(0.25), up(0.5 * (below + top)) center rotate
set label x_title at screen across(0.5 * (left_edge + right_edge)), up(0.22) center
if (windows) { set label letter(0) at screen across(0.25), up(top + 0.2) center }
do for [n = 1:windows] { eval shade_window(n); eval letter_window(n, top) }
from = x_low; to = x_high
l = left_edge; r = right_edge; b = below; t = top
is_marked(x0) = !in_window(x0)
load style."/panel.gp"

is_marked(x0) = 1
do for [n = 1:windows] {
  unset label
  unset arrow
  unset object
  from = window_low[n]; to = window_high[n]
  l = n == 1 ? left_edge : 5.55; r = n < windows ? 4.4 : right_edge; b = bottom; t = below - 1.0
  set label letter(n) at screen across(n == 1 ? 0.25 : l - 0.8), up(t + 0.2) center
  if (n == 1) { set label y_symbol at screen across(0.25), up(0.5 * (b + t)) center rotate }
  load style."/panel.gp"
}
