# How the pictures look: sizes, colours, symbols. A script names its arguments before it loads other files:
#
#   style      this folder
#   csv        branches.csv of `arcslip run`
#   picture    the file to write
#   format     png or svg
#   parameter  the continuation parameter, eta or P: the axis that the panels share
#   labels     one word in double quotes for each branch, "" for a branch without a name

set encoding utf8
set minussign
blank = "\302\240"  # unbreakable, since readers of SVG drop others beside markup

# ---- Sizes: lengths in cm from the lower left corner, type and lines in typographic points, whatever the format ----

width = 8.5  # a journal's column
left_edge = 1.4
right_edge = width - 0.32
line_height = 0.38
type_size = 8.5
branches = words(labels)
are_many = branches > 12  # branches that are many are drawn more finely, and only a few of them are named
frame = 0.5
thin = are_many ? 0.4 : 0.55
thick = are_many ? 0.9 : 1.4

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
colour(b) = branches <= |few| ? few[b] : on_scale((b - 1.0) / (branches - 1) * (|scale| - 1 - 1e-9))
grey = 0x606060
shade = 0xEAEAEA

# ---- Special points, in the order in which they are drawn, each over its own shape in white ----

kinds = 6
array kind_type[kinds] = ["switch", "user", "branch_point", "fold", "peak", "trough"]
r_equals_s = "{/:Italic R}".blank."=".blank."{/:Italic S}"
array kind_title[kinds] = [r_equals_s, "requested", "branch point", "fold", "peak", "trough"]
array symbol[kinds] = [6, 2, 13, 5, 9, 11]
array backing[kinds] = [7, 7, 13, 5, 9, 11]
symbol_size(k) = (are_many ? 0.6 : 1) * (is_svg ? 0.5 : symbol[k] == 9 || symbol[k] == 11 ? 1.5 : 1.25)
kind_of(type) = type eq "regular" ? 0 : sum [k = 1:kinds] (kind_type[k] eq type ? k : 0)

# ---- Ranges ----

is_wide(low, high) = low > 0 && high > 4 * low  # worth a logarithmic axis

# The place of a value on an axis, from 0 to 1, and the value at a place.
place_of(low, high, v) = is_wide(low, high) ? log(v / low) / log(1.0 * high / low) : 1.0 * (v - low) / (high - low)
value_at(low, high, s) = is_wide(low, high) ? low * (1.0 * high / low) ** s : low + s * (high - low)

# To be used as `eval place_panel(...)`.
place_panel(left, right, bottom, top) = sprintf("set margins at screen %g, screen %g, screen %g, screen %g", \
                                                across(left), across(right), up(bottom), up(top))
