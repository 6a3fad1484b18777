# Relative amplitude over the slip threshold: slip above the line R = S, stick below it.

style = ARG1; csv = ARG2; picture = ARG3; format = ARG4; shared = ARG5; labels = ARG6; groups = ARG7; names = ARG8
load style."/style.gp"
load style."/data.gp"
quantity(row) = column("R_over_S")
y_title = "relative amplitude"
y_symbol = "{/:Italic R}/{/:Italic S}"
reference = 1
reference_title = r_equals_s
load style."/response.gp"
