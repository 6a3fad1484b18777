# How the pictures look: sizes, colours, symbols. A script names its arguments before it loads other files:
#
#   style     this folder
#   csv       branches.csv of `arcslip run`, sweep.csv or optimum.csv of `arcslip study`
#   picture   the file to write
#   format    png or svg
#   shared    the continuation parameter, which is the axis that the panels share; and what the lines tell:
#             "regimes" (thin in stick, thick in slip), "stability" (dashed if unstable), "envelope" (the highest
#             peak alone) or "plain" (nothing); and whose rows these are, "branch", "sweep" or "optimum"
#   labels    one word in double quotes for each colour, "" for one without a name
#   groups    for each branch the number of its colour
#   names     words in double quotes: the title of the shared axis; what the lines are, or ""; then pairs of a type of
#             special points and its name here, "" if they are not to be marked

set encoding utf8
set minussign
blank = "\302\240"  # unbreakable, since readers of SVG drop others beside markup

# ---- Sizes: lengths in cm from the lower left corner, type and lines in typographic points, whatever the format ----

width = 8.5  # a journal's column
left_edge = 1.4
right_edge = width - 0.32
line_height = 0.38
type_size = 8.5
parameter = word(shared, 1)
lines = word(shared, 2)
rows_of = word(shared, 3)
branches = words(groups)
colours = words(labels)
are_many = colours > 12  # branches that are many are drawn more finely, and only a few of them are named
frame = 0.5
thin = are_many ? 0.4 : 0.55
thick = are_many ? 0.9 : 1.4
medium = are_many ? 0.55 : 1.0  # where lines do not tell of regimes
dashes = "(9, 6)"

is_svg = format eq "svg"
dot = is_svg ? 96 / 72.0 : 300 / 72.0  # for each point: CSS pixels, or 300 dots per inch
type_scale = is_svg ? dot : dot * 72 / 96  # pngcairo takes a point of type for 96/72 dots
round(v) = int(floor(v + 0.5))
pixels(cm) = round(cm / 2.54 * 72 * dot)
across(cm) = 1.0 * cm / width
up(cm) = 1.0 * cm / height

set border linewidth frame
set tics scale 0.7, 0.35
set xtics offset 0, 0.3
set ytics offset 0.6, 0
unset key

# ---- Colours that the colour-blind tell apart (Okabe and Ito 2008); the scale viridis where branches are many ----

array few[7] = [0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7, 0xE69F00, 0x56B4E9, 0x000000]
array scale[6] = [0x440154, 0x414487, 0x2A788E, 0x22A884, 0x7AD151, 0xB5DE2B]
channel(rgb, shift) = (rgb >> shift) & 255
mix(a, b, t, shift) = int(channel(a, shift) + t * (channel(b, shift) - channel(a, shift)) + 0.5) << shift
blend(a, b, t) = mix(a, b, t, 16) | mix(a, b, t, 8) | mix(a, b, t, 0)
on_scale(s) = blend(scale[int(s) + 1], scale[int(s) + 2], s - int(s))
colour(c) = colours <= |few| ? few[c] : on_scale((c - 1.0) / (colours - 1) * (|scale| - 1 - 1e-9))
branch_colour(b) = colour(int(word(groups, b)))
grey = 0x606060
shade = 0xEAEAEA

# ---- Special points, in the order in which they are drawn, each over its own shape in white ----

kinds = 26
array kind_type[kinds] = ["switch", "user", "event", "branch_point", "corner_fold", "hopf", "peak", "trough", "fold", \
                          "cusp", "bogdanov_takens", "zero_hopf", "hopf_hopf", "neimark_sacker", "period_doubling", \
                          "symmetry_breaking", "corner", "birth", "death", "exchange", "optimum", \
                          "optimum smooth", "optimum exchange", "optimum corner", "optimum flat", "optimum end"]
r_equals_s = "{/:Italic R}".blank."=".blank."{/:Italic S}"
array kind_title[kinds] = [r_equals_s, "requested", "event", "branch".blank."point", "corner".blank."fold", "Hopf", \
                           "peak", "trough", "fold", "cusp", "Bogdanov–Takens", "zero–Hopf", "double".blank."Hopf", \
                           "Neimark–Sacker", "period".blank."doubling", "symmetry".blank."breaking", \
                           r_equals_s, "birth", "death", "exchange", "optimum", \
                           "smooth", "exchange of peaks", "corner", "flat", "end of the range"]
array symbol[kinds] = [6, 2, 1, 13, 5, 7, 9, 11, 4, 12, 15, 14, 8, 7, 10, 12, 6, 9, 11, 13, 7, 7, 13, 6, 5, 2]
array backing[kinds] = [7, 7, 7, 13, 5, 7, 9, 11, 0, 13, 15, 15, 9, 7, 11, 13, 7, 9, 11, 13, 7, 7, 13, 7, 5, 7]  # 0: a fold may be a peak
is_triangle(k) = symbol[k] == 8 || symbol[k] == 9 || symbol[k] == 10 || symbol[k] == 11
enlarged(k) = symbol[k] == 4 ? 1.5 : is_triangle(k) && !is_svg ? 1.2 : symbol[k] > 11 ? 1.25 : 1
symbol_size(k) = (are_many ? 0.6 : 1) * (is_svg ? 0.5 : 1.25) * enlarged(k)
kind_of(type) = type eq "regular" ? 0 : sum [k = 1:kinds] (kind_type[k] eq type ? k : 0)

x_title = word(names, 1)
lines_title = word(names, 2)
do for [n = 3:words(names) - 1:2] {
  k = kind_of(word(names, n))
  kind_title[k] = word(names, n + 1)
  if (strlen(kind_title[k]) == 0) { kind_type[k] = "-" }
}

# ---- Ranges ----

wide = 4
is_wide(low, high) = low > 1e-17 * high && high > wide * low && low > 0  # worth a logarithmic axis

# The place of a value on an axis, from 0 to 1, and the value at a place.
place_of(low, high, v) = is_wide(low, high) ? log(v / low) / log(1.0 * high / low) : 1.0 * (v - low) / (high - low)
value_at(low, high, s) = is_wide(low, high) ? low * (1.0 * high / low) ** s : low + s * (high - low)

# The range from `low` to `high` with a part `s` of it added below and `t` above. A linear one that would turn wide by that
# grows by factors, too.
grown(low, high, s, t) = sprintf("%.17g %.17g", value_at(low, high, -s), value_at(low, high, 1 + t))
grown_by_factors(low, high, s, t) = sprintf("%.17g %.17g", low * (1.0 * high / low) ** -s, high * (1.0 * high / low) ** t)
stays_linear(low, high, s, t) = is_wide(low, high) || low <= 0 || !is_wide(low - s * (high - low), high + t * (high - low))
with_room(low, high, s, t) = stays_linear(low, high, s, t) ? grown(low, high, s, t) : grown_by_factors(low, high, s, t)

# The range of values that lie between `low` and `high`; about a single value, but for rounding errors, some room.
is_single(low, high) = high - low <= 1e-9 * (abs(low) + abs(high)) || (low <= 0 && high - low < 1e-12)
room_about(v) = abs(v) < 1e-12 ? 1 : 0.1 * abs(v)
spread(low, high) = is_single(low, high) ? sprintf("%.17g %.17g", low - room_about(low), high + room_about(high)) : \
                                           sprintf("%.17g %.17g", low, high)

# To be used as `eval place_panel(...)`.
place_panel(left, right, bottom, top) = sprintf("set margins at screen %g, screen %g, screen %g, screen %g", \
                                                across(left), across(right), up(bottom), up(top))
