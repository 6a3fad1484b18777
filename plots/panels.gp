# One quantity or several over the parameter, in panels one above the other. `panels` has for each of them, in double
# quotes, its column and the title of its axis.

style = ARG1; csv = ARG2; picture = ARG3; format = ARG4; shared = ARG5; labels = ARG6; groups = ARG7; names = ARG8
panels = ARG9
load style."/style.gp"
wide = rows_of eq "branch" ? 20 : wide
load style."/data.gp"
number = words(panels) / 2
panel_column(n) = word(panels, 2 * n - 1)
panel_title(n) = word(panels, 2 * n)
quantity(row) = column(name)
from = x_low; to = x_high
is_marked(x0) = 1

# Room for the longest label.
bottom = 0.95
gap_between = 0.25
row = number == 1 ? 5.4 : number == 2 ? 3.6 : 2.8
longest = 3
has_power = 0
do for [n = 1:number] {
  name = panel_column(n)
  load style."/read.gp"
  load style."/height.gp"
  bounds = with_room(y_low, y_high, 0.05, 0.07)
  axis = "y"; low = real(word(bounds, 1)); high = real(word(bounds, 2)); length = row; is_labelled = 1
  load style."/axis.gp"
  longest = longest_label > longest ? longest_label : longest
  has_power = has_power || common_power
}
if (strlen(lines_title)) { load style."/cusps.gp" }
left_edge = 0.72 + 0.17 * longest
top = bottom + number * row + (number - 1) * gap_between
body = top + (has_power ? 0.4 : 0.15)
load style."/key.gp"

set label x_title at screen across(0.5 * (left_edge + right_edge)), up(0.22) center
do for [n = 1:number] {
  name = panel_column(n)
  if (number > 1) { load style."/read.gp" }
  is_lowest = n == number
  l = left_edge; r = right_edge; t = top - (n - 1) * (row + gap_between); b = t - row
  set label panel_title(n) at screen across(0.25), up(0.5 * (b + t)) center rotate
  load style."/panel.gp"
  unset label
  unset arrow
}
