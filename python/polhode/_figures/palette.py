"""Colours and labels of the figures."""

# Okabe and Ito's palette, safe for colour-blind readers; the same as in viewer/src/palette.ts.
BLUE, ORANGE, GREEN, BLACK = "#0072B2", "#D55E00", "#009E73", "#222222"
AXES = (BLUE, ORANGE, GREEN)
OMEGA, MOMENTUM, TRACE, POLHODE, HERPOLHODE = ORANGE, BLUE, "#CC79A7", "#B07A00", GREEN
FAINT, WEIGHT = "#8A94A3", "#5B6675"
# Neighbouring motions.
OTHERS = "#B8B8B8"

# Labels of planes and axes.
PLANES = (r"$e_2\wedge e_3$", r"$e_3\wedge e_1$", r"$e_1\wedge e_2$")
SPACE_AXES = ("$e_1$", "$e_2$", "$e_3$")
