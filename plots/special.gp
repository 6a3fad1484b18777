# Lists the special points in $special: the parameter, quantity(0), the kind and the branch of each.

set print $special
print "x,y,kind,branch"
set print
set table $special append separator comma
plot csv using (sprintf("%.15g", column(parameter))):(sprintf("%.15g", quantity(0))):(kind(0)):(branch(0)) \
  with table if (kind(0) > 0 && branch(0) <= branches)
unset table
