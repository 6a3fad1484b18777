# Both parameters turn where a curve has a cusp, which is all that is marked there.

turns(k) = kind_type[k] eq "fold" || kind_type[k] eq "peak" || kind_type[k] eq "trough"
x_place(s) = place_of(x_low, x_high, xs[special_points[s]])
y_place(s) = place_of(y_low, y_high, ys[special_points[s]])
do for [s = 1:specials] {
  if (special_kinds[s] == kind_of("cusp")) {
    do for [other = 1:specials] {
      k = special_kinds[other]
      if (k > 0 && abs(x_place(s) - x_place(other)) < 2e-3 && abs(y_place(s) - y_place(other)) < 2e-3) {
        if (turns(k)) { special_kinds[other] = 0; found[k] = found[k] - 1 }
      }
    }
  }
}
