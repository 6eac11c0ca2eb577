"""Every equation of the handout, in its notation and order.

The vector cross product, there a bold x, is ⨯; what is called parallel, a vector or a bivector is written as
an equation; an integral over a body is the sum over three points. Beside each stands a wrong version: a sign,
a factor or an order.
"""

from typing import NamedTuple

from handout_values import (
    angular_momentum,
    angular_momentum_in_the_plane,
    frame,
    free_body,
    heavy_body,
    in_plane,
    motion,
    parts,
    plane_algebra,
    planes,
    quaternions,
    spin,
    steady,
    sum_of_grades,
    symmetric_top,
    three_points,
    turn,
    turned_grades,
    turned_vector,
    two_turns,
    values,
)

KINDS = ("float", "batch", "Fraction", "SymPy")


class Equation(NamedTuple):
    """A line of the handout. Not exact over fractions are exponentials and angles, which leave them."""

    number: str
    text: str
    wrong: str
    names: object
    exact: bool = True


SECTION_1 = [
    Equation("1.1", "(e1∧e2) e3 = e1e2e3", "(e2∧e1) e3 = e1e2e3", frame),
    Equation("1.2", "(a∧b)∧c = a∧(b∧c)", "(a∧b)∧c = a∧(c∧b)", values),
    Equation("1.3", "a∧b∧c = −b∧a∧c = c∧a∧b", "a∧b∧c = b∧a∧c = c∧a∧b", values),
    Equation("1.3", "a∧b∧c = −b∧a∧c = c∧a∧b", "a∧b∧c = −b∧a∧c = −c∧a∧b", values),
    Equation("1.5", "(e1e2)² = (e2e3)² = (e3e1)² = −1", "(e1e2)² = (e2e3)² = (e3e1)² = 1", frame),
    Equation("1.6", "e1 (e1∧e2) = e2", "(e1∧e2) e1 = e2", frame),
    Equation("1.7", "a = a∥ + a⊥", "a = a∥ − a⊥", parts),
    Equation("1.7", "B = a∥∧b", "B = b∧a∥", parts),
    Equation("1.8", "a∥B = a∥² b", "a∥B = −a∥² b", parts),
    Equation("1.8", "a∥B = ⟨a∥B⟩_1", "a∥B = ⟨a∥B⟩_3", parts),
    Equation("1.9", "a⊥B = a⊥∧a∥∧b", "a⊥B = a∥∧a⊥∧b", parts),
    Equation("1.9", "a⊥B = ⟨a⊥B⟩_3", "a⊥B = ⟨a⊥B⟩_1", parts),
    Equation("1.10", "aB = a·B + a∧B", "aB = a·B − a∧B", values),
    Equation("1.10", "a·B = ⟨aB⟩_1", "a·B = ⟨Ba⟩_1", values),
    Equation("1.10", "a∧B = ⟨aB⟩_3", "a∧B = −⟨aB⟩_3", values),
    Equation("1.11", "a·B = −B·a", "a·B = B·a", values),
    Equation("1.12", "a∧B = B∧a", "a∧B = −B∧a", values),
    Equation("1.13", "a·B = ½(aB − Ba)", "a·B = ½(aB + Ba)", values),
    Equation("1.13", "a∧B = ½(aB + Ba)", "a∧B = aB + Ba", values),
    Equation("1.14", "(e1∧e2)(e2∧e3) = e1e3", "(e1∧e2)(e2∧e3) = e3e1", frame),
    Equation("1.15", "(e2∧e3)(e1∧e2) = −e1e3", "(e2∧e3)(e1∧e2) = e1e3", frame),
    Equation("1.16", "B1 = e2e3", "B1 = e3e2", planes),
    Equation("1.16", "B2 = e3e1", "B2 = e1e3", planes),
    Equation("1.16", "B3 = e1e2", "B3 = e1e3", planes),
    Equation("1.17", "Bi Bj − Bj Bi = −2 ε_ijk Bk", "Bi Bj − Bj Bi = 2 ε_ijk Bk", planes),
    Equation("1.17", "B_i B_j − B_j B_i = −2 Σ_k ε_ijk B_k", "B_i B_j − B_j B_i = −Σ_k ε_ijk B_k", planes),
    Equation("quaternions", "B_k² = −1", "B_k² = 1", planes),
    Equation("quaternions", "i = −B1", "i = B1", quaternions),
    Equation("quaternions", "j = −B2", "j = B2", quaternions),
    Equation("quaternions", "k = −B3", "k = B3", quaternions),
    Equation("quaternions", "ij = k", "ji = k", quaternions),
    Equation("quaternions", "ijk = −1", "ijk = 1", quaternions),
    Equation(
        "quaternions",
        "w + xi + yj + zk = w − xB1 − yB2 − zB3",
        "w + xi + yj + zk = w + xB1 + yB2 + zB3",
        quaternions,
    ),
    Equation("1.18", "I = e1e2e3", "I = e2e1e3", frame),
    Equation("1.19", "e1 I = I e1 = e2e3", "e1 I = I e1 = e3e2", frame),
    Equation("1.20", "e1e2 = I e3", "e1e2 = −I e3", frame),
    Equation("1.20", "e2e3 = I e1", "e2e3 = I e2", frame),
    Equation("1.20", "e3e1 = I e2", "e1e3 = I e2", frame),
    Equation("1.21", "aI = Ia = a·I", "aI = −Ia", values),
    Equation("1.21", "MI = IM", "MI = −IM", values),
    Equation("1.21", "aI = −Ia", "aI = Ia", plane_algebra),
    Equation("1.22", "I² = −1", "I² = 1", frame),
    Equation("1.23", "I (e1∧e2) = −e3", "I (e1∧e2) = e3", frame),
    Equation("1.24", "a ⨯ b = −I (a∧b) = −I a∧b", "a ⨯ b = I (a∧b)", values),
    Equation("1.25", "(e1e2)~ = −e1e2", "(e1e2)~ = e1e2", frame),
    Equation("1.26", "~I = −I", "~I = I", frame),
    Equation("1.27", "M = α + a + B + βI", "M = α + a + B − βI", sum_of_grades),
    Equation("1.28", "~M = α + a − B − βI", "~M = α + a − B + βI", sum_of_grades),
    Equation("1.29", "ei ej = δij + I ε_ijk ek", "ei ej = δij − I ε_ijk ek", frame),
    Equation("1.29", "e_i e_j = δ_ij + I Σ_k ε_ijk e_k", "e_i e_j = δ_ij − I Σ_k ε_ijk e_k", frame),
]

SECTION_2 = [
    Equation(
        "2.1",
        "e^(−e1e2 θ) a = a e^(e1e2 θ) = e^(−e1e2 θ/2) a e^(e1e2 θ/2)",
        "e^(−e1e2 θ) a = a e^(−e1e2 θ)",
        in_plane,
        False,
    ),
    Equation("2.1", "R² a = a ~R² = R a ~R", "R² a = a R²", in_plane),
    Equation("2.2", "e^(−e1e2 θ) e3 = e3 e^(−e1e2 θ)", "e^(−e1e2 θ) e3 = e3 e^(e1e2 θ)", in_plane, False),
    Equation("2.3", "e^(−e1e2 θ/2) e3 e^(e1e2 θ/2) = e3", "e^(−e1e2 θ) e3 = e3", in_plane, False),
    Equation("2.4", "a' = R a ~R", "a' = ~R a R", turn, False),
    Equation("2.4", "a' = R a ~R", "a' = ~R a R", turned_vector),
    Equation("2.4", "R = e^(−Bθ/2)", "R = e^(Bθ/2)", turn, False),
    Equation("2.4", "B² = −1", "B² = 1", turn),
    Equation("2.5", "R ~R = ~R R = 1", "R R = 1", turned_grades),
    Equation("2.6", "B' = R B ~R", "B' = ~R B R", turned_grades),
    Equation("2.6", "M' = R M ~R", "M' = R M R", turned_grades),
]

SECTION_3 = [
    Equation("3.1", "dual(L) = x ⨯ p", "dual(L) = p ⨯ x", angular_momentum),
    Equation("3.2", "L = x∧p", "L = p∧x", angular_momentum),
    Equation("3.2", "L = x∧p", "L = p∧x", angular_momentum_in_the_plane),
]

SECTION_4 = [
    Equation("4.1", "y(t) = R(t) x ~R(t) + x0(t)", "y(t) = R(t) x ~R(t) − x0(t)", motion),
    Equation("4.2", "f_k = R e_k ~R", "f_k = ~R e_k R", motion),
    Equation("4.3", "f_k' = ω ⨯ f_k = −I ω∧f_k = (−Iω)·f_k", "f_k' = f_k ⨯ ω", motion),
    Equation("4.3", "f_k' = (−Iω)·f_k", "f_k' = (Iω)·f_k", motion),
    Equation("4.4", "Ω_S = Iω", "Ω_S = −Iω", motion),
    Equation("4.4", "Iω = +e1∧e2", "Iω = −e1∧e2", spin),
    Equation("4.5", "f_k' = R' e_k ~R + R e_k (~R)'", "f_k' = R' e_k ~R − R e_k (~R)'", motion),
    Equation("4.5", "f_k' = (R e_k ~R)'", "f_k' = (~R e_k R)'", motion),
    Equation("4.6, 4.7", "R' ~R = −R (~R)'", "R' ~R = R (~R)'", motion),
    Equation("4.7", "R' ~R = ⟨R' ~R⟩_2", "R' ~R = ⟨R' ~R⟩_0", motion),
    Equation("4.8", "f_k' = (2R'~R)·f_k", "f_k' = (R'~R)·f_k", motion),
    Equation("4.9", "2R'~R = −Ω_S", "2R'~R = Ω_S", motion),
    Equation("4.10", "R' = −½ Ω_S R", "R' = −½ R Ω_S", motion),
    Equation("4.11", "(~R)' = ½ ~R Ω_S", "(~R)' = −½ ~R Ω_S", motion),
    Equation("4.12", "Ω_S = R Ω_B ~R", "Ω_B = R Ω_S ~R", motion),
    Equation("4.13", "R' = −½ Ω_S R = −½ R Ω_B", "R' = −½ Ω_S R = −½ Ω_B R", motion),
    Equation("4.13", "(~R)' = ½ Ω_B ~R", "(~R)' = ½ ~R Ω_B", motion),
    Equation("4.14", "R(t) = e^(−Ω_S t/2) R(0)", "R(t) = R(0) e^(−Ω_S t/2)", steady, False),
    Equation("4.15", "Σ_k m_k = m", "Σ_k m_k = 2m", three_points),
    Equation("4.15", "Σ_k m_k x_k = 0", "Σ_k m_k y_k = 0", three_points),
    Equation("4.16", "v(t) = R x·Ω_B ~R + v0", "v(t) = R Ω_B·x ~R + v0", motion),
    Equation("4.17", "L = Σ_k m_k (y_k − x0)∧v_k", "L = Σ_k m_k v_k∧(y_k − x0)", three_points),
    Equation("4.18", "I(B) = Σ_k m_k x_k∧(x_k·B)", "I(B) = Σ_k m_k x_k∧(B·x_k)", three_points),
    Equation("4.18", "A·I(B) = I(A)·B", "A·I(B) = −I(A)·B", three_points),
    Equation("4.19", "L = R I(Ω_B) ~R", "L = ~R I(Ω_B) R", three_points),
    Equation("4.20", "L' = T", "L' = −T", heavy_body),
    Equation(
        "4.20",
        "R' I(Ω_B) ~R + R I(Ω_B') ~R + R I(Ω_B) (~R)' = T",
        "R' I(Ω_B) ~R + R I(Ω_B') ~R − R I(Ω_B) (~R)' = T",
        heavy_body,
    ),
    Equation(
        "4.20",
        "R [I(Ω_B') − Ω_B × I(Ω_B)] ~R = T",
        "R [I(Ω_B') + Ω_B × I(Ω_B)] ~R = T",
        heavy_body,
    ),
    Equation("4.21", "A × B = ½(AB − BA)", "A × B = AB − BA", three_points),
    Equation("4.22", "I(Ω_B') = Ω_B × I(Ω_B)", "I(Ω_B') = I(Ω_B) × Ω_B", free_body),
    Equation("4.23", "Ω_B = Σ ω_k I e_k", "Ω_B = −Σ ω_k I e_k", heavy_body),
    Equation("4.23", "Ω_S = Σ ω_k I f_k", "Ω_S = Σ ω_k I e_k", heavy_body),
    Equation("4.24", "I(Ω_B) = Σ i_k ω_k I e_k", "I(Ω_B) = Σ ω_k I e_k", heavy_body),
    Equation("4.24", "i1 ω1' = (i2 − i3) ω2 ω3", "i1 ω1' = (i3 − i2) ω2 ω3", free_body),
    Equation("4.24", "i2 ω2' = (i3 − i1) ω3 ω1", "i2 ω2' = (i1 − i3) ω3 ω1", free_body),
    Equation("4.24", "i3 ω3' = (i1 − i2) ω1 ω2", "i3 ω3' = (i2 − i1) ω1 ω2", free_body),
    Equation("4.25", "I(B) = i1 B + (i3 − i1)(B∧e3) e3", "I(B) = i1 B + (i3 − i1)(B∧e1) e1", symmetric_top),
    Equation(
        "4.26",
        "I(Ω_B') = (i3 − i1) Ω_B × [(Ω_B∧e3) e3]",
        "I(Ω_B') = (i1 − i3) Ω_B × [(Ω_B∧e3) e3]",
        symmetric_top,
    ),
    Equation("4.27", "B × (Ia) = ½(B I a − I a B) = −a∧(IB)", "B × (Ia) = a∧(IB)", values),
    Equation(
        "4.28",
        "I(Ω_B') = −(i3 − i1) e3∧[(Ω_B∧e3) Ω_B]",
        "I(Ω_B') = (i3 − i1) e3∧[(Ω_B∧e3) Ω_B]",
        symmetric_top,
    ),
    Equation("4.29", "e3∧I(Ω_B') = 0", "e3∧I(Ω_B) = 0", symmetric_top),
    Equation("4.29", "ω3' = 0", "ω2' = 0", symmetric_top),
    Equation(
        "4.30",
        "i1 Ω_B = I(Ω_B) + (i1 − i3) ω3 I e3",
        "i1 Ω_B = I(Ω_B) + (i3 − i1) ω3 I e3",
        symmetric_top,
    ),
    Equation(
        "4.31",
        "Ω_S = L/i1 + ((i1 − i3)/i1) ω3 R I e3 ~R",
        "Ω_S = L/i1 + ((i1 − i3)/i1) ω3 I e3",
        symmetric_top,
    ),
    Equation(
        "4.32",
        "R' = −½ (L/i1 + ((i1 − i3)/i1) ω3 R I e3 ~R) R",
        "R' = −½ (L/i1 − ((i1 − i3)/i1) ω3 R I e3 ~R) R",
        symmetric_top,
    ),
    Equation("4.33", "Ω_l = L/i1", "Ω_l = L/i3", symmetric_top),
    Equation("4.33", "Ω_r = ((i1 − i3)/i1) ω3 I e3", "Ω_r = ((i3 − i1)/i1) ω3 I e3", symmetric_top),
    Equation("4.34", "R' = −½ Ω_l R − ½ R Ω_r", "R' = −½ R Ω_l − ½ Ω_r R", symmetric_top),
    Equation(
        "4.35",
        "R(t) = exp(−½Ω_l t) R(0) exp(−½Ω_r t)",
        "R(t) = exp(−½Ω_r t) R(0) exp(−½Ω_l t)",
        two_turns,
        False,
    ),
]

EQUATIONS = [*SECTION_1, *SECTION_2, *SECTION_3, *SECTION_4]
