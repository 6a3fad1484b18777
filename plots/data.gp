# What there is to draw. Every row is read once to see how much there is, and once for each quantity, by read.gp, into
# arrays from which the panels are drawn: the time grows with the rows, not with the rows times the branches.

set datafile separator comma
set datafile columnheaders

load style."/".rows_of."_rows.gp"

# How many rows there are, which of them are a branch, the regimes, the kinds of special points, the range of x.
array first[branches]
array last[branches]
array found[kinds]
do for [b = 1:branches] { first[b] = 0; last[b] = 0 }
do for [k = 1:kinds] { found[k] = 0 }
stick_found = 0
slip_found = 0
note_branch(b) = b > branches ? 0 : (first[b] == 0 ? first[b] = i : 0, last[b] = i)
note_regime(slip) = slip ? slip_found = 1 : (stick_found = 1)
note_kind(k) = k > 0 ? found[k] = found[k] + 1 : 0
ends_low = 1e300  # of x where branches start and end
ends_high = -1e300
note_end(x) = (ends_low = x < ends_low ? x : ends_low, ends_high = x > ends_high ? x : ends_high)
stats csv using (0) nooutput
rows = STATS_records
i = 0
note(row) = (i = i + 1, note_branch(branch(0)), note_regime(slips(0)), note_kind(kind(0)), \
             is_end(0) ? note_end(column(parameter)) : 0)
stats csv using (note(0), column(parameter)) nooutput
do for [b = 1:branches] { if (first[b] == 0) { first[b] = 1; last[b] = 1 } }  # a single point draws no line

# No wider than where branches start and end; beyond those there is room for what turns there.
bounds = spread(STATS_min, STATS_max)
x_low = real(word(bounds, 1))
x_high = real(word(bounds, 2))
has_room = strlen(lines_title) > 0 || rows_of eq "optimum"  # curves end anywhere, designs are marked
bounds = with_room(x_low, x_high, x_low < ends_low || has_room ? 0.04 : 0, x_high > ends_high || has_room ? 0.04 : 0)
x_low = real(word(bounds, 1))
x_high = real(word(bounds, 2))

# A point for each row; and which of them are special, with their kinds.
array xs[rows]
array ys[rows]
array slip_ys[rows]  # undefined where there is no slip
shown_y(i) = lines eq "envelope" ? slip_ys[i] : ys[i]
array counts[rows]   # of unstable eigenvalues, of the stretch that begins here
specials = int(sum [k = 1:kinds] found[k])
array special_points[specials + 1]  # one more, of no kind, since an array may not be empty
array special_kinds[specials + 1]
array special_branches[specials + 1]
do for [s = 1:specials + 1] { special_points[s] = 1; special_kinds[s] = 0; special_branches[s] = 1 }
