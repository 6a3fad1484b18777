# Range, scale and tics of the axis `axis` ("x" or "y") from `low` to `high`, with no more than about `count` labels, if it
# `is_labelled`.
# A logarithmic axis is labelled by numbers if it is short, else by powers of ten; at 1, 2, 5 where there is room, else
# at each power of ten or every few. Its tics are listed: gnuplot's own have no minor ones at decades between labels.

eval sprintf("set %srange [%.15g:%.15g]", axis, low, high)
if (is_wide(low, high)) {
  decades = log10(1.0 * high / low)
  plain = decades <= 3 && low >= 1e-3 && high < 1e4
  fine = (plain || decades < 1.5) && 3 * decades <= count + 1
  every = ceil(decades / count)
  eval sprintf("set logscale %s; set %stics ('' %.15g 1)", axis, axis, low)
  do for [k = floor(log10(low)):ceil(log10(high))] {
    do for [m = 1:(every > 1 ? 1 : 9)] {
      major = m == 1 ? k % every == 0 : (m == 2 || m == 5) && fine
      power = sprintf("10^{%s%d}", k < 0 ? "−" : "", abs(k))
      text = !major || !is_labelled ? "" : plain ? sprintf("%g", m * 10.0 ** k) : m == 1 ? power : sprintf("%d·%s", m, power)
      eval sprintf("set %stics add ('%s' %.15g %d)", axis, text, m * 10.0 ** k, !major)
    }
  }
} else {
  step = 1.0 * (high - low) / count
  unit = 10.0 ** floor(log10(step))
  multiple_of_unit = step <= unit ? 1 : step <= 2 * unit ? 2 : step <= 5 * unit ? 5 : 10
  eval sprintf("unset logscale %s; set %stics autofreq %.15g; set m%stics %d", axis, axis, multiple_of_unit * unit, axis, \
               multiple_of_unit == 2 ? 2 : 5)
  eval sprintf("set format %s '%s'", axis, is_labelled ? "%g" : "")
}
