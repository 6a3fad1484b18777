# The panel whose place and axes are set: the points, thin in stick and thick in slip, and the special points of which
# is_marked(x) holds, kind after kind, each in white first.

special_y(s, k) = special_kinds[s] == k && is_marked(xs[special_points[s]]) ? ys[special_points[s]] : NaN
special_colour(s) = special_branches[s] > branches ? grey : colour(special_branches[s])
nth_kind(n) = (n + 1) / 2
is_backing(n) = n % 2

# A range in the very first entry would be taken for that of the panel. The quarters see to it that int(i) is each of
# the numbers from first to last, be it one only.
plot keyentry, \
  for [b = 1:branches] [i = first[b] + 0.25:last[b] + 0.75:1] '+' using (xs[int(i)]):(ys[int(i)]) \
    with lines linewidth thin linecolor rgb colour(b), \
  for [b = 1:branches] [i = first[b] + 0.25:last[b] + 0.75:1] '+' using (xs[int(i)]):(slip_ys[int(i)]) \
    with lines linewidth thick linecolor rgb colour(b), \
  for [n = 1:2 * kinds] [s = 1.25:specials + 1.75:1] '+' using (xs[special_points[int(s)]]): \
    (special_y(int(s), nth_kind(n))):(is_backing(n) ? 0xFFFFFF : special_colour(int(s))) \
    with points pointtype (is_backing(n) ? backing[nth_kind(n)] : symbol[nth_kind(n)]) \
    pointsize symbol_size(nth_kind(n)) * (is_backing(n) ? 1.35 : 1) linewidth frame linecolor rgb variable
