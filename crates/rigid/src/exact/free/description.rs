//! Description of a free motion by its invariants, and the curves of its angular velocity: polhode in the body,
//! herpolhode in space.
//!
//! **Phase.** In one period T of the angular velocity m circles d once, and the body turns about L. With the energy
//! `2E = (G² + sP)/c` and ν of [`super`], `ν − 2E/G = −s A/T` with
//!
//! ```text
//! A = (TP/cG) (1 − ½ S(k²/n)) = 2π + T (G|b−a| S(n)/2ab − Q/aG),   νT = 2ET/G − s A:
//! ```
//!
//! the angle is `2ET/G` less the solid angle A that L sweeps around the encircled axis in the body (Montgomery, Am. J.
//! Phys. 59 (1991) 394).
//!
//! **Wobble.** The tangent of the angle between L and that axis is `√(m1² + m2²)/m3`, least where sn = 0, `aA_a/cA_c`,
//! largest where cn = 0, `bA_b/(cA_c k')`.

use super::FreeMotion;
use super::orbit::Invariants;
use crate::body::inertia::equal;
use crate::error::SimulateError;
use crate::exact::regime::{FreeDescription, Regime};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elliptic::Means;
use crate::numerics::wide::Wide;
use crate::state::checks::check_horizons;
use crate::state::phase::Gyrostat;
use polhode_ga::Bivector;
use std::f64::consts::PI;

/// Half the range of u drawn on the separatrix: sech 20 = 4e-9 of the way from pole to pole is missing.
const NEARLY_ALL: f64 = 20.0;

/// Parameter 1 − k²/n above which the other form of A is used; A is then nearly 2π.
const FAR: f64 = 1e4;

impl FreeMotion {
    /// Period of the angular velocity in the body, 4K/λ, in s; None if ω is constant or does not repeat.
    pub fn period(&self) -> Option<f64> {
        let orbit = self.orbit.as_ref()?;
        let turn = orbit.lambda * orbit.mean?;
        Some(2.0 * PI / turn.value() / self.scale).filter(|x| x.is_finite())
    }

    /// The description by the invariants.
    pub fn describe(&self) -> FreeDescription {
        let (i, w) = (self.moments, self.omega.0);
        let body = Gyrostat::rigid(i);
        let momentum = body.momentum(self.omega);
        let largest = |x: &usize, y: &usize| w[*x].abs().total_cmp(&w[*y].abs());
        let axis = (0..3).max_by(largest).unwrap_or(0);
        let rest = w == [0.0; 3];
        let still = FreeDescription {
            regime: if rest { Regime::Rest } else { Regime::Steady },
            energy: body.kinetic(momentum),
            angular_momentum: momentum.norm(),
            modulus: 0.0,
            axis,
            period: None,
            precession_rate: None,
            solid_angle: None,
            wobble: (!rest).then_some([0.0, 0.0]),
            wobble_period: self.small_wobble(axis),
        };
        let Some(orbit) = &self.orbit else { return still };
        let [a, b, c] = orbit.axes;
        let regime = match orbit.mean {
            None => Regime::Separatrix,
            Some(_) if equal(i[a], i[b]) => Regime::Symmetric,
            Some(_) if orbit.s > 0.0 => Regime::ShortAxis,
            Some(_) => Regime::LongAxis,
        };
        let m: [f64; 3] = std::array::from_fn(|k| i[orbit.axes[k]] * orbit.amplitudes[k].abs());
        let moving = FreeDescription {
            regime,
            modulus: orbit.k2.sqrt(),
            axis: c,
            wobble: Some([m[0].atan2(m[2]), m[1].atan2(m[2] * orbit.kc.value())]),
            wobble_period: None,
            ..still
        };
        let Some(mean) = orbit.mean else { return moving };
        // ν leaves out one turn in each period.
        let rate = orbit.precession + orbit.lambda * mean * orbit.s.into();
        FreeDescription {
            period: self.period(),
            precession_rate: Some(rate.value() * self.scale).filter(|x| x.is_finite()),
            solid_angle: self.solid_angle(),
            ..moving
        }
    }

    /// The solid angle A.
    fn solid_angle(&self) -> Option<f64> {
        let orbit = self.orbit.as_ref()?;
        let mean = orbit.mean?;
        let size = super::power_of_two(self.moments);
        let in_units = |x: f64, unit: f64| Wide::from(x).in_units(&[unit]);
        let moments = orbit.axes.map(|k| in_units(self.moments[k], size));
        let rates = orbit.axes.map(|k| in_units(self.omega.0[k], self.scale));
        let Invariants { a, b, c, ab, ac, bc, p, q, g2 } = Invariants::new(moments, rates);
        let (g, turn, half) = (g2.sqrt(), Wide::from(orbit.lambda * mean), DoubleDouble::from(0.5));
        let means = Means::new(orbit.kc);
        // 1 − k²/n.
        let p2 = ac * g2 / (c * q);
        let part = if p2 < FAR.into() {
            let sum = means.single_sum(p2.narrow());
            (p / (c * g * turn)).narrow() * (DoubleDouble::ONE - sum * half)
        } else {
            let sum = means.single_sum((b * ac / (a * bc)).narrow());
            let first = (g * ab / (a * b * turn)).narrow() * sum * half;
            DoubleDouble::ONE + first - (q / (a * g * turn)).narrow()
        };
        Some(2.0 * PI * part.value()).filter(|x| x.is_finite())
    }

    /// Period of a small wobble about principal axis c of a body that turns about it: Euler's equations, linear in the
    /// other rates, are harmonic with squared rate `(c−a)(c−b) ω²/(ab)`. None if that is not positive, or the body turns
    /// about another axis.
    fn small_wobble(&self, c: usize) -> Option<f64> {
        let (a, b) = ((c + 1) % 3, (c + 2) % 3);
        let Bivector(w) = self.omega;
        let i = self.moments;
        let square = (i[c] - i[a]) / i[a] * ((i[c] - i[b]) / i[b]);
        let about = w[a] == 0.0 && w[b] == 0.0 && square > 0.0;
        Some(2.0 * PI / (square.sqrt() * w[c].abs())).filter(|period| about && period.is_finite())
    }

    /// Start and duration in s that cover the polhode: one period; on the separatrix from one end of the middle axis to
    /// the other; 0 if the rotation is steady.
    fn once_round(&self) -> (f64, f64) {
        let Some(orbit) = &self.orbit else { return (0.0, 0.0) };
        match orbit.mean {
            Some(_) => (0.0, self.period().unwrap_or(0.0)),
            None => {
                let rate = orbit.lambda.hi * self.scale;
                ((-NEARLY_ALL - orbit.start.1) / rate, 2.0 * NEARLY_ALL / rate)
            }
        }
    }

    /// `count` angular velocities in body axes along the polhode, at equal time steps from the start; the last equals
    /// the first, except on the separatrix, where the curve goes from pole to pole.
    pub fn polhode(&self, count: usize) -> Vec<Bivector> {
        let (start, length) = self.once_round();
        let step = length / count.saturating_sub(1).max(1) as f64;
        let mut curve: Vec<_> = (0..count).map(|k| self.at(start + step * k as f64).1).collect();
        if self.period().is_some()
            && let [first, .., last] = &mut curve[..]
        {
            *last = *first;
        }
        curve
    }

    /// `count` angular velocities in space axes over `periods` times the duration of the polhode.
    pub fn herpolhode(&self, count: usize, periods: f64) -> Result<Vec<Bivector>, SimulateError> {
        let (start, length) = self.once_round();
        let step = periods * length / count.saturating_sub(1).max(1) as f64;
        let times: Vec<f64> = (0..count).map(|k| start + step * k as f64).collect();
        check_horizons(0.0, &times, [self.horizon(); 2])?;
        let in_space = |&t: &f64| {
            let (rotor, omega) = self.at(t);
            rotor.apply_bivector(omega)
        };
        Ok(times.iter().map(in_space).collect())
    }
}
