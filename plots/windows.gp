# Finds the ranges where peaks crowd, or a single branch slips, too narrow to be seen in the whole: `windows` of them, two
# at most, from left to right, from window_low[n] to window_high[n].

bins = 500
crowd = 35  # bins: 7 % of the axis
array peaks[bins]
array leftmost[bins]
array rightmost[bins]
do for [i = 1:bins] { peaks[i] = 0; leftmost[i] = 1; rightmost[i] = 0 }
bin(s) = s <= 0 ? 1 : s >= 1 ? bins : int(s * bins) + 1
do for [i = 1:specials] {
  if (special_kinds[i] == kind_of("peak")) {
    s = place_of(x_low, x_high, xs[special_points[i]])
    j = bin(s)
    peaks[j] = peaks[j] + 1
    leftmost[j] = s < leftmost[j] ? s : leftmost[j]
    rightmost[j] = s > rightmost[j] ? s : rightmost[j]
  }
}

# Takes what lies between the places `low` and `high` for the next window, with a margin, and the peaks there for seen.
add_window = "\
  margin = 0.6 * (high - low) > 0.004 ? 0.6 * (high - low) : 0.004; \
  low = low - margin < 0 ? 0 : low - margin; \
  high = high + margin > 1 ? 1 : high + margin; \
  do for [j = bin(low):bin(high)] { peaks[j] = 0; leftmost[j] = 1; rightmost[j] = 0 }; \
  windows = windows + 1; \
  window_low[windows] = value_at(x_low, x_high, low); \
  window_high[windows] = value_at(x_low, x_high, high)"

windows = 0
array window_low[2] = [0, 0]
array window_high[2] = [0, 0]
do for [n = 1:2] {
  most = 1
  do for [i = 1:bins - crowd + 1] {
    count = sum [j = i:i + crowd - 1] peaks[j]
    if (count > most) { most = count; begin = i }
  }
  if (most > 1) {
    low = 1
    high = 0
    do for [j = begin:begin + crowd - 1] {
      low = leftmost[j] < low ? leftmost[j] : low
      high = rightmost[j] > high ? rightmost[j] : high
    }
    eval add_window
  }
}

# A single branch has no crowds; of it the narrow stretches of slip are shown.
slips_at(i) = slip_ys[i] == slip_ys[i]
if (branches == 1 && windows == 0) {
  begin = 0
  do for [i = 1:rows] {
    if (slips_at(i) && begin == 0) { begin = i }
    if (begin > 0 && (i == rows || !slips_at(i + 1))) {
      low = place_of(x_low, x_high, xs[begin])
      high = place_of(x_low, x_high, xs[i])
      if (high < low) { swapped = low; low = high; high = swapped }
      if (windows < 2 && i > begin && high - low < 0.05) { eval add_window }
      begin = 0
    }
  }
}
if (windows == 2 && window_low[1] > window_low[2]) {
  low = window_low[1]; window_low[1] = window_low[2]; window_low[2] = low
  high = window_high[1]; window_high[1] = window_high[2]; window_high[2] = high
}
if (windows == 2 && window_high[1] > window_low[2]) {
  window_low[2] = 0.5 * (window_high[1] + window_low[2])
  window_high[1] = window_low[2]
}
in_window(v) = sum [n = 1:windows] (v >= window_low[n] && v <= window_high[n])

# How a panel of the whole range shows the windows: by shaded bands with the letters of their own panels over them.
letter(n) = sprintf("{/:Bold %c}", 97 + n)
shade_window(n) = sprintf("set object rectangle from first %.15g, graph 0 to first %.15g, graph 1 behind ", \
                          window_low[n], window_high[n])."fillcolor rgb shade fillstyle solid noborder"
letter_window(n, top) = sprintf("set label letter(%d) at first %.15g, screen up(%g) center", n, \
                                value_at(window_low[n], window_high[n], 0.5), top + 0.2)
