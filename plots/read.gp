# Reads quantity(0), a formula of the row, into the arrays of data.gp.

set datafile columnheaders
set xrange [*:*]  # since stats keeps to the ranges that are set
set yrange [*:*]
unset logscale
note_point(i, y) = (xs[i] = column(parameter), ys[i] = y, slip_ys[i] = slips(0) || ends_slip(0) ? y : NaN, \
                    counts[i] = unstable(0))

# Of a point at which the stability changes, the count may be either: that of the next one counts.
is_between(type) = type eq "start" || type eq "fold" || type eq "corner_fold" || type eq "hopf" || type eq "branch_point" \
                   || type eq "neimark_sacker" || type eq "period_doubling" || type eq "symmetry_breaking"
unstable(row) = lines ne "stability" ? 0 : is_between(strcol("type")) ? -1 : int(column("unstable"))
note_special(i, k) = k == 0 ? 0 : \
  (s = s + 1, special_points[s] = i, special_kinds[s] = k, special_branches[s] = branch(0))
s = 0
i = 0
stats csv using (i = i + 1, note_point(i, quantity(0)), note_special(i, kind(0)), 0) nooutput
unset datafile columnheaders  # else the first point of whatever is drawn is taken for one
if (lines eq "stability") {
  do for [n = 1 - rows:-1] {
    if (counts[-n] < 0) { counts[-n] = counts[1 - n] }
  }
}
