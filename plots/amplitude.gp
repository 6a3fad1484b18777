# Amplitude of the base.

style = ARG1; csv = ARG2; picture = ARG3; format = ARG4; shared = ARG5; labels = ARG6; groups = ARG7; names = ARG8
load style."/style.gp"
load style."/data.gp"
quantity(row) = column("Y")
y_title = "amplitude"
y_symbol = "{/:Italic Y}"
load style."/response.gp"
