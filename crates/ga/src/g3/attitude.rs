//! Attitudes: the turns between rotors, and Euler angles.
//!
//! Euler angles are named as in SciPy: lower-case axes are fixed in space, upper-case axes turn with the body.
//!
//! In quaternions, whose units e_i, e_j, e_k are those of the axes, a turn about i, then j, then i again is
//! `q = q_i(θ3) q_j(θ2) q_i(θ1)`. Because `q_i(θ) e_j = e_j q_i(−θ)`, its parts are the complex numbers
//! `q_0 + i q_i = cos(θ2/2) exp(i(θ3 + θ1)/2)` and `q_j + i ε q_k = sin(θ2/2) exp(i(θ3 − θ1)/2)`, with ε = ±1 as i, j, k
//! are right- or left-handed (Bernardes & Viollet, PLoS ONE 17 (2022)). Their product has the angle θ3, the product of the
//! first and the conjugate of the second θ1.
//!
//! Where the three axes i, j, k differ, a quarter turn about j, `(1 + e_j) q/√2`, carries i to ±k: it is such a product, of
//! the angles θ1, θ2 + π/2 and ε θ3.

use super::rotor::Rotor;
use super::values::Bivector;
use crate::MathError;
use crate::rows::rotor_functions;
use std::f64::consts::FRAC_PI_2;

/// Rounding errors in a sum of four products of rounded numbers, whose magnitudes add up to at most 1.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl Rotor {
    /// `exp(t log R)`: turns t times as far. NaN if t is not finite.
    pub fn power(self, t: f64) -> Rotor {
        Rotor::from_unit_components(rotor_functions::power_one(self.components(), t))
    }

    /// The angle of the rotation in [0, π]: the same for R and −R.
    pub fn angle(self) -> f64 {
        let [s, x, y, z] = self.components();
        2.0 * Bivector([x, y, z]).norm().atan2(s.abs())
    }

    /// R or −R: that of a turn of at most π, with a scalar part >= 0. Of half turns, the one whose first component of
    /// `(e2e3, e3e1, e1e2)` that is not 0 is negative, that of its quaternion positive.
    pub fn canonical(self) -> Rotor {
        let [s, x, y, z] = self.components();
        let first = [x, y, z].into_iter().find(|&part| part != 0.0);
        let flips = s < 0.0 || s == 0.0 && first.is_some_and(|part| part > 0.0);
        if flips { -self } else { self }
    }

    /// The angle in [0, π] of the rotation from this attitude to the other, accurate for close attitudes, too.
    ///
    /// Half of it has the cosine `|⟨~R S⟩|` and the sine `|⟨~R S⟩₂| = |⟨~R (S ∓ R)⟩₂|`, since `~R R` is a scalar; between
    /// close attitudes that difference has no rounding.
    pub fn distance(self, other: Rotor) -> f64 {
        let back = self.reverse();
        let [cosine, ..] = (back * other).components();
        let nearer = if cosine < 0.0 { -other } else { other };
        let (from, to) = (self.components(), nearer.components());
        let difference = Rotor::from_unit_components(std::array::from_fn(|k| to[k] - from[k]));
        let [_, x, y, z] = (back * difference).components();
        2.0 * Bivector([x, y, z]).norm().atan2(cosine.abs())
    }

    /// A fraction t of the way to another rotor at constant rate, the shorter way round: `R (~R S)^t`, with the sign of S
    /// that makes it so. Half a turn apart, to rounding, S keeps its sign.
    ///
    /// Fails if t or a rotor is not finite.
    pub fn slerp(self, other: Rotor, t: f64) -> Result<Rotor, MathError> {
        if !t.is_finite() {
            return Err(MathError::NotFinite);
        }
        let step = self.reverse().compose(other);
        let [scalar, ..] = step.components();
        let shorter = if scalar < -ROUNDING { -step } else { step };
        Ok(self.compose(Rotor::from_components(shorter.components())?.power(t)))
    }
}

/// A sequence of one to three axes, neighbours different.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EulerSequence {
    axes: [usize; 3],
    count: usize,
    /// Whether the axes turn with the body.
    turning: bool,
}

impl EulerSequence {
    /// Precession, tilt and spin of a top.
    pub const ZXZ: EulerSequence = EulerSequence { axes: [2, 0, 2], count: 3, turning: true };

    /// From its letters, such as `zyx` or `ZXZ`; `None` for others.
    pub fn new(letters: &str) -> Option<EulerSequence> {
        let (mut axes, mut count) = ([0; 3], 0);
        let turning = letters.starts_with(|first: char| first.is_ascii_uppercase());
        for letter in letters.chars() {
            let axis = (if turning { "XYZ" } else { "xyz" }).find(letter)?;
            if count > 0 && axes[count - 1] == axis {
                return None;
            }
            *axes.get_mut(count)? = axis;
            count += 1;
        }
        (count > 0).then_some(EulerSequence { axes, count, turning })
    }

    /// The number of its axes.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The rotor of one angle for each axis, in radians.
    ///
    /// # Panics
    /// If there are not as many.
    pub fn rotor(&self, angles: &[f64]) -> Result<Rotor, MathError> {
        assert_eq!(angles.len(), self.count, "an angle for each axis");
        let turn = |k: usize| {
            let mut plane = [0.0; 3];
            plane[self.axes[k]] = 1.0;
            Rotor::from_plane_angle(Bivector(plane), angles[k])
        };
        // Turns about axes of the body are the same turns about fixed axes in the opposite order.
        let in_order = |k: usize| if self.turning { self.count - 1 - k } else { k };
        let mut total = turn(in_order(0))?;
        for k in 1..self.count {
            total = turn(in_order(k))?.compose(total);
        }
        Ok(total)
    }

    /// The angles about three axes, in radians: the first and third in [−π, π]; the second in [0, π] if the first and
    /// third axes are the same, in [−π/2, π/2] if all differ. `None` for fewer axes.
    ///
    /// In gimbal lock, where only the sum or difference of the outer angles is known, the one named last is 0.
    pub fn angles(&self, rotor: Rotor) -> Option<[f64; 3]> {
        if self.count != 3 {
            return None;
        }
        let ([mut a, mut b, mut c, mut e], sign) = self.two_numbers(rotor.to_quaternion_wxyz());
        let (cosine, sine) = (length(a, b), length(c, e));
        // Equal to the other, or to its conjugate, the number in lock gives 0 for the angle named last.
        let free = if self.turning { 1.0 } else { -1.0 };
        if cosine <= ROUNDING {
            (a, b) = (c, free * e);
        }
        if sine <= ROUNDING {
            (c, e) = (a, free * b);
        }
        let mut middle = 2.0 * sine.atan2(cosine);
        let first = (b * c - a * e).atan2(a * c + b * e);
        let mut last = (b * c + a * e).atan2(a * c - b * e);
        if let Some(sign) = sign {
            (middle, last) = (middle - FRAC_PI_2, sign * last);
        }
        Some(if self.turning { [last, middle, first] } else { [first, middle, last] })
    }

    /// The real and imaginary parts of both complex numbers, and ε where the three axes differ.
    fn two_numbers(&self, q: [f64; 4]) -> ([f64; 4], Option<f64>) {
        let mut axes = self.axes;
        if self.turning {
            axes.reverse();
        }
        let [i, j, third] = axes;
        let k = 3 - i - j;
        let sign = if (j + 3 - i) % 3 == 1 { 1.0 } else { -1.0 };
        let (a, b, c, e) = (q[0], q[1 + i], q[1 + j], sign * q[1 + k]);
        if third == i { ([a, b, c, e], None) } else { ([a - c, b + e, c + a, e - b], Some(sign)) }
    }
}

/// The magnitude of a complex number; `hypot` takes several times as long as a root.
fn length(x: f64, y: f64) -> f64 {
    let square = x * x + y * y;
    if square > 1e-280 { square.sqrt() } else { x.hypot(y) }
}

#[cfg(test)]
mod tests;
