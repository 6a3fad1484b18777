# A column of optimum.csv over the plane of two keys, in colours with contour lines. `panels` has, in double quotes, the
# second key and its title, the column and its title, the places of the values to be drawn along either axis among those
# of for_each, and how many values the second key has, which runs faster.

style = ARG1; csv = ARG2; picture = ARG3; format = ARG4; shared = ARG5; labels = ARG6; groups = ARG7; names = ARG8
panels = ARG9
load style."/style.gp"
y_column = word(panels, 1); y_title = word(panels, 2)
z_column = word(panels, 3); z_title = word(panels, 4)
x_places = word(panels, 5); y_places = word(panels, 6)
per_x = int(word(panels, 7))
x_count = words(x_places)
y_count = words(y_places)

# ---- What there is ----

set datafile separator comma
set datafile columnheaders
stats csv using (0) nooutput
rows = STATS_records
array row_x[rows]
array row_y[rows]
array row_z[rows]
is_flat(kind) = z_column eq "P_opt" && kind eq "flat"  # its preload is one of a range
note(i) = (row_x[i] = column(parameter), row_y[i] = column(y_column), row_z[i] = is_flat(strcol("kind")) ? NaN : column(z_column), \
           flat = flat || is_flat(strcol("kind")), failed = failed || strcol("kind") eq "failed")
flat = 0
failed = 0
i = 0
stats csv using (i = i + 1, note(i), 0) nooutput
unset datafile columnheaders

array xs[x_count]
array ys[y_count]
do for [i = 1:x_count] { xs[i] = row_x[(int(word(x_places, i)) - 1) * per_x + 1] }
do for [j = 1:y_count] { ys[j] = row_y[int(word(y_places, j))] }
array zs[x_count * y_count]
do for [i = 1:x_count] {
  from_row = (int(word(x_places, i)) - 1) * per_x
  do for [j = 1:y_count] { zs[(i - 1) * y_count + j] = row_z[from_row + int(word(y_places, j))] }
}
stats row_z using (row_z[int($1)]) nooutput
is_defined = exists("STATS_min")
bounds = is_defined ? spread(STATS_min, STATS_max) : "0.1 1"
z_low = real(word(bounds, 1))
z_high = real(word(bounds, 2))

# ---- The page ----

bottom = 0.95
top = bottom + 5.4
box_left = right_edge - 1.62
box_right = box_left + 0.3
map_right = box_left - 0.25
left_edge = 1.35
body = top + (flat || failed ? 0.75 : 0.35)
array regimes[2] = ["", ""]
array found[kinds]
do for [k = 1:kinds] { found[k] = 0 }
load style."/key.gp"

eval place_panel(left_edge, map_right, bottom, top)
is_labelled = 1
# An axis is logarithmic if the values along it are spaced so.
widened(ratio, first_step, last_step) = last_step > sqrt(ratio) * first_step ? 1.01 : 1e300
z_wide = wide
axis = "x"; low = xs[1]; high = xs[x_count]; length = map_right - left_edge
wide = low > 0 ? widened(1.0 * high / low, xs[2] - xs[1], xs[x_count] - xs[x_count - 1]) : wide
x_is_log = is_wide(low, high)
load style."/axis.gp"
axis = "y"; low = ys[1]; high = ys[y_count]; length = top - bottom
wide = low > 0 ? widened(1.0 * high / low, ys[2] - ys[1], ys[y_count] - ys[y_count - 1]) : wide
y_is_log = is_wide(low, high)
load style."/axis.gp"
wide = z_wide
axis = "cb"; low = z_low; high = z_high; length = top - bottom
load style."/axis.gp"
set xtics offset 0, 0.8 out nomirror
set ytics offset 0.6, 0 out nomirror
set cbtics offset -0.8, 0 out nomirror
if (flat || failed) {
  set object rectangle from screen across(left_edge), up(top + 0.3) to screen across(left_edge + 0.35), up(top + 0.52) \
    fillcolor rgb shade fillstyle solid noborder
  set label (flat ? "no single best preload" : "").(flat && failed ? ", " : "").(failed ? "not found" : "") \
    at screen across(left_edge + 0.5), up(top + 0.41)
}
set label x_title at screen across(0.5 * (left_edge + map_right)), up(0.22) center
set label y_title at screen across(0.25), up(0.5 * (bottom + top)) center rotate
set label z_title at screen across(width - 0.22), up(0.5 * (bottom + top)) center rotate

# ---- Colours, then lines of equal value ----

hex(rgb) = sprintf("'#%06X'", rgb)
colours_of_scale = ""
do for [n = 1:|scale|] { colours_of_scale = colours_of_scale.(n > 1 ? ", " : "").sprintf("%d %s", n, hex(scale[n])) }
eval "set palette defined (".colours_of_scale.")"
set colorbox user origin screen across(box_left), up(bottom) size screen across(box_right - box_left), up(top - bottom) \
  border
set view map
finer(count) = count < 60 ? ceil(60.0 / count) : 1
eval sprintf("set pm3d map interpolate %d, %d", finer(x_count), finer(y_count))
set object rectangle from graph 0, graph 0 to graph 1, graph 1 behind fillcolor rgb shade fillstyle solid noborder
set samples x_count
set isosamples y_count
set zrange [*:*]
z_at(u, v) = zs[(round(u) - 1) * y_count + round(v)]
splot sample [u=1:x_count] [v=1:y_count] '++' using (xs[round(u)]):(ys[round(v)]):(z_at(u, v)) with pm3d notitle

# Lines at round values, named where they cross a line through the middle of the map or, if they do not, the one upright
# to it, unless there is another name.
array steps[3] = [1, 2, 5]
array levels[60]
number = 0
if (is_wide(z_low, z_high)) {
  many = log10(z_high / z_low) > 4
  do for [k = floor(log10(z_low)):ceil(log10(z_high))] {
    do for [m = 1:(many ? 1 : 3)] {
      v = steps[m] * 10.0 ** k
      if (v > z_low && v < z_high && number < 60) { number = number + 1; levels[number] = v }
    }
  }
} else {
  step = 10.0 ** floor(log10((z_high - z_low) / 2))
  step = step * ((z_high - z_low) / step > 12 ? 5 : (z_high - z_low) / step > 6 ? 2 : 1)
  do for [k = ceil(z_low / step):floor(z_high / step)] {
    if (k * step > z_low && k * step < z_high) { number = number + 1; levels[number] = k * step }
  }
}
unset label
unset arrow
unset object
unset colorbox
unset xtics
unset ytics
unset border
if (number) {
  level_list = ""
  do for [n = 1:number] { level_list = level_list.(n > 1 ? ", " : "").sprintf("%.9g", levels[n]) }
  eval "set cntrparam levels discrete ".level_list
  set cntrlabel onecolor
  set contour base
  unset surface
  unset pm3d

  across_map(v) = (map_right - left_edge) * place_between(xs[1], xs[x_count], v, x_is_log)
  up_map(v) = (top - bottom) * place_between(ys[1], ys[y_count], v, y_is_log)
  place_between(low, high, v, is_log) = is_log ? log(v / low) / log(1.0 * high / low) : 1.0 * (v - low) / (high - low)
  part(a, b, v) = a > 0 && b > 0 ? log(v / a) / log(b / a) : (v - a) / (b - a)
  crosses(a, b, v) = a == a && b == b && (a - v) * (b - v) <= 0 && a != b
  array name_x[60]
  array name_y[60]
  names = 0
  try_name = "\
    is_free = x > 0.4 && x < map_right - left_edge - 0.4 && y > 0.2 && y < top - bottom - 0.2; \
    do for [k = 1:names] { is_free = is_free && (abs(x - name_x[k]) > 0.75 || abs(y - name_y[k]) > 0.4) }; \
    if (is_free) { \
      names = names + 1; name_x[names] = x; name_y[names] = y; named = 1; \
      set label sprintf('%g', levels[n]) at screen across(left_edge + x), up(bottom + y) center front boxed font small \
    }"
  small = sprintf(",%g", 0.8 * type_size)
  set style textbox opaque fillcolor rgb '#FFFFFF' noborder margins 0.5, 0.4
  middle_x = (x_count + 1) / 2
  middle_y = (y_count + 1) / 2
  do for [n = 1:number] {
    named = 0
    do for [i = 1:x_count - 1] {
      a = z_at(i, middle_y); b = z_at(i + 1, middle_y)
      if (!named && crosses(a, b, levels[n])) {
        x = across_map(xs[i]) + part(a, b, levels[n]) * (across_map(xs[i + 1]) - across_map(xs[i])); y = up_map(ys[middle_y])
        eval try_name
      }
    }
    do for [j = 1:y_count - 1] {
      a = z_at(middle_x, j); b = z_at(middle_x, j + 1)
      if (!named && crosses(a, b, levels[n])) {
        y = up_map(ys[j]) + part(a, b, levels[n]) * (up_map(ys[j + 1]) - up_map(ys[j])); x = across_map(xs[middle_x])
        eval try_name
      }
    }
  }
  splot sample [u=1:x_count] [v=1:y_count] '++' using (xs[round(u)]):(ys[round(v)]):(z_at(u, v)) \
    with lines linecolor rgb 0xFFFFFF linewidth thin notitle
}
