# The panel whose place and axes are set: the branches and the special points of which is_marked(x) holds, kind after
# kind, each in white first. The branches are lines through the points, thin in stick and thick in slip, or dashed where
# unstable.

has_shape(n) = !is_backing(n) || backing[nth_kind(n)]
special_y(s, k) = special_kinds[s] == k && is_marked(xs[special_points[s]]) ? shown_y(special_points[s]) : NaN
special_colour(s) = special_branches[s] > branches ? grey : branch_colour(special_branches[s])
nth_kind(n) = (n + 1) / 2
is_backing(n) = n % 2

# Of row i of branch b: whether it belongs to a stretch that is stable, or one that is not.
is_stable(i) = counts[i] == 0
touches(b, i, stable) = (i < last[b] && is_stable(i) == stable) || (i > first[b] && is_stable(i - 1) == stable)
upper_y(b, i) = last[b] == first[b] || lines eq "envelope" ? NaN : lines ne "stability" || touches(b, i, 1) ? ys[i] : NaN
lower_y(b, i) = last[b] == first[b] || lines eq "plain" ? NaN : \
                lines ne "stability" ? slip_ys[i] : touches(b, i, 0) ? ys[i] : NaN
row_of(b, j) = first[b] + int(j)
lower_dashes = lines eq "stability" ? "dashtype ".dashes : ""

# A range in the very first entry would be taken for that of the panel. The quarters see to it that int(j) is each of
# the numbers from 0 to the last, be it one only.
plot keyentry, \
  for [b = 1:branches] [j = 0.25:last[b] - first[b] + 0.75:1] '+' \
    using (xs[row_of(b, j)]):(upper_y(b, row_of(b, j))) \
    with lines linewidth (lines eq "regimes" ? thin : medium) linecolor rgb branch_colour(b), \
  for [b = 1:branches] [j = 0.25:last[b] - first[b] + 0.75:1] '+' \
    using (xs[row_of(b, j)]):(lower_y(b, row_of(b, j))) \
    with lines linewidth (lines eq "regimes" ? thick : medium) @lower_dashes linecolor rgb branch_colour(b), \
  for [n = 1:2 * kinds] [s = 1.25:specials + 1.75:1] '+' using (xs[special_points[int(s)]]): \
    (has_shape(n) ? special_y(int(s), nth_kind(n)) : NaN):(is_backing(n) ? 0xFFFFFF : special_colour(int(s))) \
    with points pointtype (is_backing(n) ? backing[nth_kind(n)] : symbol[nth_kind(n)]) \
    pointsize symbol_size(nth_kind(n)) * (is_backing(n) ? 1.35 : 1) linewidth frame linecolor rgb variable
