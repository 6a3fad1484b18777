# What a row of curves.csv or branches.csv tells, of the one that is being read.

branch(row) = int(column("branch")) + 1
kind(row) = kind_of(strcol("type"))
is_end(row) = strcol("type") eq "start" || strcol("type") eq "end"
slips(row) = strcol("regime") eq "slip"
ends_slip(row) = strcol("type") eq "switch"  # the last point of a stretch of slip, though it enters stick
array regimes[2] = ["stick", "slip"]
