# A panel from `from` to `to` of the parameter, its edges at `l`, `r`, `b` and `t` cm, as high as the values there are.

eval place_panel(l, r, b, t)
load style."/height.gp"
if (!is_defined) { set label "nothing to show" at graph 0.5, graph 0.5 center }

is_labelled = is_lowest
axis = "x"; low = from; high = to; length = r - l
load style."/axis.gp"
is_labelled = 1
x_wide = wide
wide = exists("y_is_linear") ? 1e300 : wide
bounds = with_room(y_low, y_high, 0.05, 0.07)
axis = "y"; low = real(word(bounds, 1)); high = real(word(bounds, 2)); length = t - b
load style."/axis.gp"
wide = x_wide
if (common_power) {
  set label sprintf("×10^{%s%d}", common_power < 0 ? "−" : "", abs(common_power)) at screen across(l), up(t + 0.2)
}
if (exists("reference") && low < reference && reference < high) {
  set arrow from graph 0, first reference to graph 1, first reference nohead back linewidth frame dashtype (10, 8)
  if (from == x_low) {
    side = place_of(low, high, reference) < 0.85 ? 0.5 : -0.5  # above the line, if there is room
    set label reference_title at graph 0.02, first reference offset 0, side
  }
}
load style."/curves.gp"
