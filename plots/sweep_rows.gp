# What a row of sweep.csv tells, of the one that is being read. A peak that is followed in P is a branch, in the colour of
# its curve; what is "slip" of a response is here the highest of the peaks.

set datafile separator comma
set datafile columnheaders
stats csv using (column("curve")) nooutput
array branch_of[STATS_records]  # of a row
array curve_of[STATS_records]   # of a branch
branches = 0
last_curve = -1
last_peak = -1
begins(curve, peak) = curve != last_curve || peak != last_peak
note_peak(curve, peak) = (i = i + 1, branches = branches + begins(curve, peak), last_curve = curve, last_peak = peak, \
                          branch_of[i] = branches, curve_of[branches] = int(curve) + 1)
i = 0
stats csv using (note_peak(column("curve"), column("peak_branch")), 0) nooutput
branch_colour(b) = colour(curve_of[b])

branch(row) = branch_of[i]
kind(row) = kind_of(strcol("type"))
is_end(row) = strcol("type") eq "start" || strcol("type") eq "end"
slips(row) = column("is_global") == 1 || strcol("type") eq "exchange"  # there both peaks are as high
ends_slip(row) = 0
array regimes[2] = ["other peaks", "highest peak"]
