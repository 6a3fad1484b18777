# The range of the values from `from` to `to` of the parameter, if there are any.

y_inside(i) = xs[i] >= from && xs[i] <= to ? shown_y(i) : NaN
set xrange [*:*]  # since stats keeps to the ranges that are set
set yrange [*:*]
unset logscale
stats xs using (y_inside(int($1))) nooutput
is_defined = exists("STATS_min")
bounds = is_defined ? spread(STATS_min, STATS_max) : "0.1 1"
y_low = real(word(bounds, 1))
y_high = real(word(bounds, 2))
