# What a row of optimum.csv tells, of the one that is being read: one branch with a point for each design, or, where
# their values of the parameter are in no order, as many branches as designs.

branch(row) = branches == 1 ? 1 : i
kind(row) = branches == 1 && rows > 60 ? 0 : kind_of("optimum ".strcol("kind"))
is_end(row) = 1
slips(row) = 0
ends_slip(row) = 0
array regimes[2] = ["", ""]
