# The panel whose place and axes are set: quantity(0) over the parameter, thin in stick and thick in slip, and those
# special points of which is_marked(x) holds, kind after kind, each in white first.

nth_kind(i) = (i + 1) / 2
is_backing(i) = i % 2
mark(k) = column("kind") == k && is_marked(column("x")) ? column("y") : NaN
plot \
  for [b = 1:branches] csv every ::first_row[b]::last_row[b] using (column(parameter)):(quantity(0)) \
    with lines linewidth thin linecolor rgb colour(b), \
  for [b = 1:branches] csv every ::first_row[b]::last_row[b] \
    using (column(parameter)):(q = quantity(0), slips(0) || ends_slip(0) ? q : NaN) \
    with lines linewidth thick linecolor rgb colour(b), \
  for [i = 1:2 * kinds] $special \
    using (column("x")):(mark(nth_kind(i))):(is_backing(i) ? 0xFFFFFF : colour(int(column("branch")))) \
    with points pointtype (is_backing(i) ? backing[nth_kind(i)] : symbol[nth_kind(i)]) \
    pointsize symbol_size(nth_kind(i)) * (is_backing(i) ? 1.35 : 1) linewidth frame linecolor rgb variable
