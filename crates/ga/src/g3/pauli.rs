//! G3 as 2×2 complex matrices: `e_k ↦ σ_k`, hence `I ↦ i` (handout eq. 1.29).

use super::values::Multivector;

/// A 2×2 complex matrix, row by row, each entry `[real, imaginary]`.
pub type PauliMatrix = [[[f64; 2]; 2]; 2];

/// `M = ζ + Σ (a_k + I b_k) e_k ↦ ζ 1 + Σ (a_k + i b_k) σ_k`.
pub fn to_pauli(m: Multivector) -> PauliMatrix {
    let [s, a1, a2, a3, b1, b2, b3, t] = m.0;
    [[[s + a3, t + b3], [a1 + b2, b1 - a2]], [[a1 - b2, b1 + a2], [s - a3, t - b3]]]
}

/// The multivector of any 2×2 complex matrix; inverse of [`to_pauli`].
pub fn from_pauli(p: PauliMatrix) -> Multivector {
    let [[[p00, q00], [p01, q01]], [[p10, q10], [p11, q11]]] = p;
    let half_sum = |x: f64, y: f64| 0.5 * x + 0.5 * y;
    Multivector([
        half_sum(p00, p11),
        half_sum(p01, p10),
        half_sum(q10, -q01),
        half_sum(p00, -p11),
        half_sum(q01, q10),
        half_sum(p01, -p10),
        half_sum(q00, -q11),
        half_sum(q00, q11),
    ])
}
