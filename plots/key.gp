# Opens the picture, with `body` cm for the panels and, above them, the key: the colours by their labels, then what
# lines and symbols tell. It is set by hand, since gnuplot's own may lie over the curves.

sample = 0.45  # of a line, with the blank behind it
gap = 0.28     # between entries

# Estimated from the number of characters, markup left out.
italics(text) = sum [i = 1:strlen(text)] (text[i:i + 8] eq "{/:Italic")
text_width(text) = (strlen(text) - 11 * italics(text)) * 0.45 * type_size / 72 * 2.54

# ---- The branches, in columns ----

# Of many branches six are named, evenly chosen: the colours tell the order of the others.
named = strlen(word(labels, 1)) == 0 ? 0 : are_many ? 6 : colours
named_colour(i) = named < colours ? int(1 + (i - 1.0) * (colours - 1) / (named - 1) + 0.5) : i

column_width = 0
do for [i = 1:named] {
  entry = sample + text_width(word(labels, named_colour(i))) + gap
  column_width = entry > column_width ? entry : column_width
}
columns = named == 0 ? 1 : int((width - 0.2 + gap) / column_width)
columns = columns < 1 ? 1 : columns
branch_lines = ceil(1.0 * named / columns)
columns = named == 0 ? 1 : ceil(1.0 * named / branch_lines)  # lines of much the same length

# ---- What the lines and symbols tell: what there is of it, in lines filled one after the other ----

styles = 5
ways = styles + kinds
in_regime(regime) = strlen(lines_title) ? lines_title.blank."in".blank.regime : regime
array way_title[ways] = [in_regime(regimes[1]), in_regime(regimes[2]), "stable", "unstable", lines_title]
array way_start[ways]
array way_line[ways]
array line_width[ways]
array way_width[styles] = [thin, thick, medium, medium, medium]
stable_found = lines eq "stability" ? sum [i = 1:rows] (counts[i] == 0) : 0
unstable_found = lines eq "stability" ? sum [i = 1:rows] (counts[i] > 0) : 0
array style_found[styles] = [lines eq "regimes" && stick_found, lines eq "regimes" && slip_found, \
                             stable_found && unstable_found, unstable_found, lines eq "plain" && strlen(lines_title)]
do for [k = 1:kinds] { way_title[styles + k] = kind_title[k] }
is_shown(i) = i <= styles ? style_found[i] : found[i - styles] > 0
way_sample(i) = i <= styles ? sample : 0.25

way_lines = 1
line_width[1] = 0
do for [i = 1:ways] {
  entry = is_shown(i) ? way_sample(i) + 1.15 * text_width(way_title[i]) + gap : 0
  if (line_width[way_lines] + entry - gap > width - 0.2) {
    way_lines = way_lines + 1
    line_width[way_lines] = 0
  }
  way_start[i] = line_width[way_lines]
  way_line[i] = way_lines
  line_width[way_lines] = line_width[way_lines] + entry
}

if (line_width[1] == 0) { way_lines = 0 }

# ---- Setting it, by labels and arrows that the first panel draws ----

height = body + (branch_lines + way_lines) * line_height + 0.1
height_of_line(n) = height - 0.05 - (n - 0.5) * line_height

# Where a line starts that is `full` wide, with a gap at its end: centred over the panels, or else in the picture.
start(full) = 0.5 * (gap - full + (full - gap <= right_edge - left_edge ? left_edge + right_edge : width))

do for [i = 1:named] {
  x0 = start(columns * column_width) + (i - 1) % columns * column_width
  y0 = height_of_line((i - 1) / columns + 1)
  set arrow from screen across(x0), up(y0) to screen across(x0 + sample - 0.1), up(y0) \
    nohead linewidth 2 * thin linecolor rgb colour(named_colour(i))
  set label word(labels, named_colour(i)) at screen across(x0 + sample), up(y0)
}
do for [i = 1:ways] {
  if (is_shown(i)) {
    x0 = start(line_width[way_line[i]]) + way_start[i]
    y0 = height_of_line(branch_lines + way_line[i])
    if (i <= styles) {
      eval sprintf("set arrow from screen %.9g, %.9g to screen %.9g, %.9g nohead linewidth %g %s linecolor rgb grey", \
                   across(x0), up(y0), across(x0 + sample - 0.1), up(y0), way_width[i], i == 4 ? "dashtype ".dashes : "")
    } else {
      set label '' at screen across(x0 + 0.08), up(y0) \
        point pointtype symbol[i - styles] pointsize symbol_size(i - styles) linewidth frame linecolor rgb grey
    }
    set label way_title[i] at screen across(x0 + way_sample(i)), up(y0)
  }
}

eval sprintf("set terminal %s size %d,%d background '#ffffff' font 'Arial,%g' fontscale %g linewidth %g rounded", \
             is_svg ? "svg name 'arcslip'" : "pngcairo", pixels(width), pixels(height), type_size, type_scale, dot)
set output picture
set multiplot
