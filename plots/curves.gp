# The panel whose place and axes are set: the points, thin in stick and thick in slip, and those special points of which
# is_marked(x) holds, kind after kind, each in white first.

special_y(s, k) = special_kinds[s] == k && is_marked(xs[special_points[s]]) ? ys[special_points[s]] : NaN
special_colour(s) = special_branches[s] > branches ? grey : colour(special_branches[s])
nth_kind(n) = (n + 1) / 2
is_backing(n) = n % 2

# The first entry is there since a range in the first would be taken for that of the panel. Half a step more than the
# last point makes a range of a single one.
plot keyentry, \
  for [b = 1:branches] [i = first[b]:last[b] + 0.5:1] '+' using (xs[round(i)]):(ys[round(i)]) \
    with lines linewidth thin linecolor rgb colour(b), \
  for [b = 1:branches] [i = first[b]:last[b] + 0.5:1] '+' using (xs[round(i)]):(slip_ys[round(i)]) \
    with lines linewidth thick linecolor rgb colour(b), \
  for [n = 1:2 * kinds] [s = 1:specials + 1.5:1] '+' using (xs[special_points[round(s)]]): \
    (special_y(round(s), nth_kind(n))):(is_backing(n) ? 0xFFFFFF : special_colour(round(s))) \
    with points pointtype (is_backing(n) ? backing[nth_kind(n)] : symbol[nth_kind(n)]) \
    pointsize symbol_size(nth_kind(n)) * (is_backing(n) ? 1.35 : 1) linewidth frame linecolor rgb variable
