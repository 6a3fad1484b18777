# Phase of the damper behind the base: 0 where they move together, 1 where they move against each other.

style = ARG1; csv = ARG2; picture = ARG3; format = ARG4; shared = ARG5; labels = ARG6; groups = ARG7; names = ARG8
load style."/style.gp"
load style."/data.gp"
load style."/turns.gp"
quantity(row) = followed(column("alpha") - column("beta"), column("point") == 0)
y_title = "phase difference"
y_symbol = "({/:Italic α}".blank."−".blank."{/:Italic β})/π"
y_is_linear = 1
load style."/response.gp"
