# Range, scale and tics of the axis `axis` ("x" or "y") from `low` to `high`, which is `length` cm long and shows its
# labels if `is_labelled`. Tics are listed one by one: on a logarithmic axis gnuplot's own have no minor ones at the
# decades between two labels, on a linear one their labels would not fit where the numbers are long.
#
# A logarithmic axis is labelled by numbers if it is short, else by powers of ten; at 1, 2, 5 where there is room, else
# at each power of ten or every few. `common_power` is 0, or the k where labels are in units of 10^k.

eval sprintf("set %srange [%.15g:%.15g]", axis, low, high)
eval sprintf("set %stics ('' %.15g 1)", axis, low)
room = axis eq "x" ? 0.65 : 0.6  # cm for a label
common_power = 0
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
      text = !major || !is_labelled ? "" : plain ? sprintf("%g", m * 10.0 ** k) : m == 1 ? power : sprintf("%d·%s", m, power)
      eval sprintf("set %stics add ('%s' %.15g %d)", axis, text, m * 10.0 ** k, !major)
    }
  }
} else {
  eval sprintf("unset logscale %s", axis)
  largest = abs(low) > abs(high) ? abs(low) : abs(high)
  common_power = axis eq "y" && (largest < 0.05 || largest >= 1e4) ? int(floor(log10(largest))) : 0
  do for [attempt = 1:2] {
    step = (high - low) * room / length
    unit = 10.0 ** floor(log10(step) + 1e-9)
    per_unit = step <= 1.001 * unit ? 1 : step <= 2 * unit ? 2 : step <= 4 * unit ? 4 : step <= 5 * unit ? 5 : 10
    step = per_unit * unit
    text_of(j) = sprintf("%.9g", j * step / 10.0 ** common_power)
    longest = strlen(text_of(ceil(high / step - 0.5))) > strlen(text_of(floor(low / step + 0.5))) ? \
              strlen(text_of(ceil(high / step - 0.5))) : strlen(text_of(floor(low / step + 0.5)))
    if (axis eq "x" && 0.16 * longest + 0.2 > room) { room = 0.16 * longest + 0.2 }
  }
  parts = per_unit == 2 || per_unit == 4 ? per_unit : 5
  do for [j = floor(parts * low / step):ceil(parts * high / step)] {
    eval sprintf("set %stics add ('%s' %.15g %d)", axis, j % parts == 0 && is_labelled ? text_of(j / parts) : "", \
                 j * step / parts, j % parts != 0)
  }
}
