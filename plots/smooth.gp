# x_at(i, part), y_at(i, part), slip_y_at(i, part): the branch a part of the way from row i to the next. If `refine` is
# above 1 it is a cubic in the arclength with the slopes of the parabolas through neighbouring rows, on a logarithmic
# axis in the logarithm; a curve then turns in a fold and meets in a cusp as it should.

if (refine > 1) {
  array x_slopes[rows]
  array y_slopes[rows]
  x_log = is_wide(from, to)
  y_log = is_wide(y_low, y_high)
  scaled_x(v) = x_log ? log(v) : v
  scaled_y(v) = y_log ? log(v) : v
  unscaled_x(v) = x_log ? exp(v) : v
  unscaled_y(v) = y_log ? exp(v) : v
  secant_x(i, k) = (scaled_x(xs[k]) - scaled_x(xs[i])) / (lengths[k] - lengths[i])
  secant_y(i, k) = (scaled_y(ys[k]) - scaled_y(ys[i])) / (lengths[k] - lengths[i])
  # No steeper than keeps to the rows' own order where they go one way, or stay where they are (Fritsch and Carlson 1980).
  smaller(a, b) = abs(a) < abs(b) ? abs(a) : abs(b)
  tame(slope, a, b) = abs(slope) > 3 * smaller(a, b) ? sgn(slope) * 3 * smaller(a, b) : slope
  parabola(before, after, d_before, d_after) = \
    tame((d_before * after + d_after * before) / (before + after), before > 0 ? d_before : 0, after > 0 ? d_after : 0)

  do for [b = 1:branches] {
    do for [i = first[b]:last[b] * (last[b] > first[b] + 1)] {
      # A row much nearer than the other neighbour tells little of the slope.
      p = i > first[b] ? i - 1 : i + 1
      n = i < last[b] ? i + 1 : i - 1
      while (p > first[b] && p < i && lengths[i] - lengths[p] < 0.05 * (lengths[n] - lengths[i])) { p = p - 1 }
      while (n < last[b] && n > i && lengths[n] - lengths[i] < 0.05 * (lengths[i] - lengths[p])) { n = n + 1 }
      if (p > i) { p = n; n = n < last[b] ? n + 1 : n }
      if (n < i) { n = p; p = p > first[b] ? p - 1 : p }
      x_slopes[i] = parabola(lengths[i] - lengths[p], lengths[n] - lengths[i], secant_x(p, i), secant_x(i, n))
      y_slopes[i] = parabola(lengths[i] - lengths[p], lengths[n] - lengths[i], secant_y(p, i), secant_y(i, n))
    }
    if (last[b] == first[b] + 1) {
      x_slopes[first[b]] = secant_x(first[b], last[b]); x_slopes[last[b]] = x_slopes[first[b]]
      y_slopes[first[b]] = secant_y(first[b], last[b]); y_slopes[last[b]] = y_slopes[first[b]]
    }
  }
  cubic(v, w, d, e, h, t) = v + t * h * d + t ** 2 * (3 * (w - v) - h * (2 * d + e)) + t ** 3 * (h * (d + e) - 2 * (w - v))
  stretch(i) = lengths[i + 1] - lengths[i]
  x_between(i, t) = unscaled_x(cubic(scaled_x(xs[i]), scaled_x(xs[i + 1]), x_slopes[i], x_slopes[i + 1], stretch(i), t))
  y_between(i, t) = unscaled_y(cubic(scaled_y(ys[i]), scaled_y(ys[i + 1]), y_slopes[i], y_slopes[i + 1], stretch(i), t))
}
x_at(i, t) = t == 0 ? xs[i] : x_between(i, t)
y_at(i, t) = t == 0 ? ys[i] : y_between(i, t)
slip_y_at(i, t) = t == 0 ? slip_ys[i] : slip_ys[i] == slip_ys[i] && slip_ys[i + 1] == slip_ys[i + 1] ? y_between(i, t) : NaN
