# The panel whose place and axes are set: the branches and the special points of which is_marked(x) holds, kind after
# kind, each in white first. The branches are lines through the points, thin in stick and thick in slip, or dashed where
# unstable. With `refine` above 1, smooth.gp puts that many pieces between two points.

has_shape(n) = !is_backing(n) || backing[nth_kind(n)]
special_y(s, k) = special_kinds[s] == k && is_marked(xs[special_points[s]]) ? shown_y(special_points[s]) : NaN
special_colour(s) = special_branches[s] > branches ? grey : branch_colour(special_branches[s])
nth_kind(n) = (n + 1) / 2
is_backing(n) = n % 2
load style."/smooth.gp"

# Of piece j of branch b, the row before it and how far it is to the next.
row_of(b, j) = first[b] + int(j) / refine
part_of(j) = 1.0 * (int(j) % refine) / refine
is_stable(i) = counts[i] == 0
touches(b, i, stable, part) = (i < last[b] && is_stable(i) == stable) || \
                              (part == 0 && i > first[b] && is_stable(i - 1) == stable)
upper_y(b, j) = last[b] == first[b] || lines eq "envelope" ? NaN : \
                lines ne "stability" || touches(b, row_of(b, j), 1, part_of(j)) ? y_at(row_of(b, j), part_of(j)) : NaN
lower_y(b, j) = last[b] == first[b] || lines eq "plain" ? NaN : \
                lines ne "stability" ? slip_y_at(row_of(b, j), part_of(j)) : \
                touches(b, row_of(b, j), 0, part_of(j)) ? y_at(row_of(b, j), part_of(j)) : NaN
lower_dashes = lines eq "stability" ? "dashtype ".dashes : ""

# A range in the very first entry would be taken for that of the panel. The quarters see to it that int(j) is each of
# the numbers from 0 to the last, be it one only.
plot keyentry, \
  for [b = 1:branches] [j = 0.25:refine * (last[b] - first[b]) + 0.75:1] '+' \
    using (x_at(row_of(b, j), part_of(j))):(upper_y(b, j)) \
    with lines linewidth (lines eq "regimes" ? thin : medium) linecolor rgb branch_colour(b), \
  for [b = 1:branches] [j = 0.25:refine * (last[b] - first[b]) + 0.75:1] '+' \
    using (x_at(row_of(b, j), part_of(j))):(lower_y(b, j)) \
    with lines linewidth (lines eq "regimes" ? thick : medium) @lower_dashes linecolor rgb branch_colour(b), \
  for [n = 1:2 * kinds] [s = 1.25:specials + 1.75:1] '+' using (xs[special_points[int(s)]]): \
    (has_shape(n) ? special_y(int(s), nth_kind(n)) : NaN):(is_backing(n) ? 0xFFFFFF : special_colour(int(s))) \
    with points pointtype (is_backing(n) ? backing[nth_kind(n)] : symbol[nth_kind(n)]) \
    pointsize symbol_size(nth_kind(n)) * (is_backing(n) ? 1.35 : 1) linewidth frame linecolor rgb variable
