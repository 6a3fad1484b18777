# Range, scale and tics of the axis `axis` ("x" or "y") from `low` to `high`, which is `length` cm long and shows its
# labels if `is_labelled`. Tics are listed one by one: on a logarithmic axis gnuplot's own have no minor ones at the
# decades between two labels, and on a linear one they do not make room for long numbers.
#
# A logarithmic axis is labelled by numbers if it is short, else by powers of ten: at 1, 2, 5 where there is room, else
# at each power or every few. `common_power` is the k of the 10^k in which the labels are counted, 0 mostly.

eval sprintf("set %srange [%.15g:%.15g]", axis, low, high)
eval sprintf("set %stics ('' %.15g 1)", axis, low)
room = axis eq "x" ? 0.65 : 0.6  # cm for a label
common_power = 0
longest_label = 0  # in characters, but for powers of ten

if (is_wide(low, high)) {
  eval sprintf("set logscale %s", axis)
  decades = log10(1.0 * high / low)
  plain = decades <= 3 && low >= 1e-3 && high < 1e4
  fine = (plain || decades < 1.5) && 3 * decades <= length / room + 1
  every = ceil(decades * room / length)
  do for [k = floor(log10(low)):ceil(log10(high))] {
    do for [m = 1:(every > 1 ? 1 : 9)] {
      major = m == 1 ? k % every == 0 : fine && (m == 2 || m == 5)
      power = sprintf("10^{%s%d}", k < 0 ? "−" : "", abs(k))
      text = plain ? sprintf("%g", m * 10.0 ** k) : m == 1 ? power : sprintf("%d·%s", m, power)
      is_inside = m * 10.0 ** k >= low && m * 10.0 ** k <= high
      longest_label = plain && major && is_inside && strlen(text) > longest_label ? strlen(text) : longest_label
      eval sprintf("set %stics add ('%s' %.15g %d)", axis, major && is_labelled ? text : "", m * 10.0 ** k, !major)
    }
  }
}

if (!is_wide(low, high)) {
  eval sprintf("unset logscale %s", axis)
  largest = abs(low) > abs(high) ? abs(low) : abs(high)
  common_power = axis eq "y" && (largest < 0.05 || largest >= 1e4) ? int(floor(log10(largest))) : 0
  text_of(v) = (v < 0 ? "−" : "").sprintf("%.9g", abs(v) / 10.0 ** common_power)
  labels_of(step) = floor(high / step) - ceil(low / step) + 1
  text_room(v) = axis eq "x" && 0.2 + 0.15 * strlen(text_of(v)) > room ? 0.2 + 0.15 * strlen(text_of(v)) : room
  fits(step) = labels_of(step) * text_room(ceil(low / step) * step) <= length

  # The smallest round step whose labels fit, but two labels at least.
  array round_steps[4] = [5, 4, 2, 1]
  chosen = 0
  do for [i = 0:11] {
    step = round_steps[i % 4 + 1] * 10.0 ** (floor(log10(high - low)) - i / 4)
    if (labels_of(step) > 1 && (chosen == 0 || (fits(step) && i % 4 != 1))) {
      chosen = step
      parts = i % 4 == 2 ? 2 : i % 4 == 1 ? 4 : 5
    }
  }
  do for [j = floor(parts * low / chosen):ceil(parts * high / chosen)] {
    text = j % parts == 0 && is_labelled ? text_of(j / parts * chosen) : ""
    longest_label = strlen(text) > longest_label ? strlen(text) : longest_label
    eval sprintf("set %stics add ('%s' %.15g %d)", axis, text, j * chosen / parts, j % parts != 0)
  }
}
