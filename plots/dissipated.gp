# Energy lost to friction per cycle and contact point, over the stiffness of the contact.

style = ARG1; csv = ARG2; picture = ARG3; format = ARG4; shared = ARG5; labels = ARG6; groups = ARG7; names = ARG8
load style."/style.gp"
load style."/data.gp"
quantity(row) = column("R_over_S") > 1 + 1e-5 ? column("dissipated") * column("S") ** 2 : NaN
y_title = "dissipated"
y_symbol = "4{/:Italic S}".blank."({/:Italic R}".blank."−".blank."{/:Italic S})"
stick_found = 0  # nothing is lost in stick, nor at its ends
found[kind_of("switch")] = 0
load style."/response.gp"
