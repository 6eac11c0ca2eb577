"""Colours and labels of the figures."""

# Okabe and Ito's palette, safe for colour-blind readers; the same as in viewer/src/palette.ts.
BLUE, ORANGE, GREEN, BLACK = "#0072B2", "#D55E00", "#009E73", "#222222"
AXES = (BLUE, ORANGE, GREEN)
OMEGA, MOMENTUM, TRACE, POLHODE, HERPOLHODE = ORANGE, BLUE, "#CC79A7", "#B07A00", GREEN
FAINT, WEIGHT = "#8A94A3", "#5B6675"
# Neighbouring motions.
OTHERS = "#B8B8B8"

# Labels of planes and axes.
PLANES = ("e₂∧e₃", "e₃∧e₁", "e₁∧e₂")
SPACE_AXES = ("e₁", "e₂", "e₃")
