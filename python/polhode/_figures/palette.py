"""Colours and labels of the figures."""

# The axes have colours of Okabe and Ito's palette, safe for colour-blind readers; Ω and L have others, and
# the paths of Ω have that of Ω. The same as in viewer/src/palette.ts.
BLUE, ORANGE, GREEN, BLACK = "#0072B2", "#D55E00", "#009E73", "#222222"
AXES = (BLUE, ORANGE, GREEN)
OMEGA = POLHODE = HERPOLHODE = "#B07A00"
MOMENTUM, TRACE = "#7B3F98", "#CC79A7"
FAINT, WEIGHT = "#8A94A3", "#5B6675"
# Neighbouring motions.
OTHERS = "#B8B8B8"

# Labels of planes and axes.
PLANES = (r"$e_2\wedge e_3$", r"$e_3\wedge e_1$", r"$e_1\wedge e_2$")
SPACE_AXES = ("$e_1$", "$e_2$", "$e_3$")
