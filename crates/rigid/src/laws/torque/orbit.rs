//! Kepler orbit of a body in the field of a planet.

use crate::error::TorqueError;
use crate::numerics::double_double::DoubleDouble;
use crate::state::point::{Function, Seen};
use polhode_ga::{Bivector, Vector};
use std::f64::consts::{PI, TAU};

/// An orbit in the plane e1e2 of space, from e1 towards e2, with the periapsis on e1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    rate: f64,
    eccentricity: f64,
    anomaly: f64,
}

impl Orbit {
    /// A circle at the rate n in rad/s, at time 0 on e1.
    pub fn circular(rate: f64) -> Orbit {
        Orbit { rate, eccentricity: 0.0, anomaly: 0.0 }
    }

    /// An ellipse with the mean motion n in rad/s and, at time 0, this mean anomaly in rad.
    pub fn new(rate: f64, eccentricity: f64, anomaly: f64) -> Result<Orbit, TorqueError> {
        if !(0.0..1.0).contains(&eccentricity) {
            return Err(TorqueError(format!(
                "eccentricity is {eccentricity}; that of a closed orbit must be at least 0 and below 1"
            )));
        }
        if let Some(value) = [rate, anomaly].into_iter().find(|x| !x.is_finite()) {
            return Err(TorqueError(format!("mean motion or mean anomaly is {value}; both must be finite")));
        }
        Ok(Orbit { rate, eccentricity, anomaly })
    }

    /// The mean motion, in rad/s.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// The eccentricity.
    pub fn eccentricity(&self) -> f64 {
        self.eccentricity
    }

    /// The mean anomaly at time 0, in rad.
    pub fn anomaly(&self) -> f64 {
        self.anomaly
    }

    /// Whether it is a circle.
    pub fn is_circular(&self) -> bool {
        self.eccentricity == 0.0
    }

    /// The direction u from planet to body, and `(a/r)³`.
    ///
    /// With the eccentric anomaly E: `r/a = 1 − e cos E`, and
    /// `u = ((cos E − e) e1 + √(1−e²) sin E e2) a/r`. Both differences are small near the periapsis of a
    /// long orbit; with `v = 2 sin²(E/2) = 1 − cos E` they are `(1−e) + e v` and `(1−e) − v`, whose `1 − e`
    /// is exact there.
    pub fn place(&self, time: f64) -> (Vector, f64) {
        let (e, mean) = (self.eccentricity, self.mean_anomaly(time));
        if e == 0.0 {
            let (sin, cos) = sin_cos(mean);
            return (Vector([cos, sin, 0.0]), 1.0);
        }
        let (direction, distance) = on_ellipse(mean, e);
        (direction, 1.0 / (distance * distance * distance))
    }

    /// The direction u, and `r/a`.
    fn at(&self, time: f64) -> (Vector, f64) {
        on_ellipse(self.mean_anomaly(time), self.eccentricity)
    }

    /// `(a/r)³` at the periapsis.
    pub(crate) fn largest_nearness(&self) -> f64 {
        (1.0 - self.eccentricity).powi(-3)
    }

    /// `M = n t + M0` in double-double precision: in double, n t loses a digit with every ten turns.
    fn mean_anomaly(&self, time: f64) -> DoubleDouble {
        DoubleDouble::two_product(self.rate, time) + self.anomaly.into()
    }
}

/// The direction u, and `r/a`, see [`Orbit::place`].
fn on_ellipse(mean: DoubleDouble, e: f64) -> (Vector, f64) {
    let anomaly = eccentric_anomaly(reduced(mean), e);
    let versine = 2.0 * (0.5 * anomaly).sin() * (0.5 * anomaly).sin();
    let distance = (1.0 - e) + e * versine;
    let along = (1.0 - e) - versine;
    let across = ((1.0 - e) * (1.0 + e)).sqrt() * anomaly.sin();
    (Vector([along / distance, across / distance, 0.0]), distance)
}

/// An orbit with its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeplerOrbit {
    orbit: Orbit,
    axis: f64,
}

impl KeplerOrbit {
    /// An orbit with its semi-major axis in m about a centre with this gravitational parameter in m³/s².
    pub fn new(axis: f64, eccentricity: f64, anomaly: f64, mu: f64) -> Result<KeplerOrbit, TorqueError> {
        for (name, value) in [("semi_major_axis", axis), ("mu", mu)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(TorqueError(format!("{name} is {value}; it must be positive and finite")));
            }
        }
        let orbit = Orbit::new((mu / axis).sqrt() / axis, eccentricity, anomaly)?;
        Ok(KeplerOrbit { orbit, axis })
    }

    /// The mean motion `√(μ/a³)`, in rad/s.
    pub fn rate(&self) -> f64 {
        self.orbit.rate
    }

    /// The position relative to the centre, in m.
    pub fn position(&self, time: f64) -> Vector {
        let (direction, distance) = self.orbit.at(time);
        direction * (self.axis * distance)
    }
}

/// The torque `m∧(~R B R)` on a dipole m of the body in A m², in body axes, in a field B in space in T, a function of time
/// and of the position on an orbit.
pub fn on_orbit(
    dipole: Vector,
    orbit: KeplerOrbit,
    field: impl Fn(f64, Vector) -> Result<Vector, TorqueError> + Send + Sync + 'static,
) -> Function<Bivector> {
    Function::new(move |seen: &Seen| {
        let field = field(seen.time, orbit.position(seen.time))?;
        Ok(dipole.wedge(seen.rotor.reverse().apply(field)))
    })
}

/// The field of a dipole M in A m² at the origin: `μ0/4π (3 (M·u) u − M)/r³` at `x = r u`, in T.
pub fn dipole_field(moment: Vector, place: Vector) -> Vector {
    /// `μ0/4π` in T m/A.
    const STRENGTH: f64 = 1e-7;
    let distance = place.norm();
    let u = place / distance;
    (u * (3.0 * moment.dot(u)) - moment) * (STRENGTH / (distance * distance * distance))
}

/// An angle without its whole turns, in [−π, π].
fn reduced(angle: DoubleDouble) -> f64 {
    let turns = angle * DoubleDouble::OVER_TWO_PI;
    let part = turns - turns.hi.round().into();
    (part.value() * TAU).clamp(-PI, PI)
}

/// Sine and cosine of an angle. Those of the library reduce `hi` exactly; the square of `lo` is rounding below 1e-8.
fn sin_cos(angle: DoubleDouble) -> (f64, f64) {
    if angle.lo.abs() > 1e-8 {
        return reduced(angle).sin_cos();
    }
    let (sin, cos) = angle.hi.sin_cos();
    (sin + angle.lo * cos, cos - angle.lo * sin)
}

/// Kepler's equation `M = E − e sin E` for `|M| <= π`.
///
/// For M >= 0 the left side of `f(E) = (1−e) E + e (E − sin E) − M = 0` is convex on [0, π], so Newton's
/// steps from above fall to the root and stop where rounding ends them. It lies below `M + e`, below
/// `M/(1−e)`, and, since `E − sin E >= E³/π²` there, below `(π² M/e)^(1/3)`.
fn eccentric_anomaly(mean: f64, e: f64) -> f64 {
    let m = mean.abs();
    let mut anomaly = (m + e).min(m / (1.0 - e)).min((PI * PI * m / e).cbrt()).min(PI);
    for _ in 0..50 {
        let excess = (1.0 - e) * anomaly + e * less_its_sine(anomaly) - m;
        let half = (0.5 * anomaly).sin();
        let next = anomaly - excess / ((1.0 - e) + 2.0 * e * half * half);
        if next >= anomaly {
            break;
        }
        anomaly = next;
    }
    anomaly.copysign(mean)
}

/// `x − sin x` for x in [0, π], by its series where the difference would cancel.
fn less_its_sine(x: f64) -> f64 {
    if x > 1.0 {
        return x - x.sin();
    }
    // x³/6 (1 − x²/(4·5) (1 − x²/(6·7) (…))): the next factor would change it by less than 2⁻⁵³.
    const FACTORS: [f64; 8] = {
        let mut factors = [0.0; 8];
        let mut k = 0;
        while k < 8 {
            factors[k] = 1.0 / ((2 * k + 4) * (2 * k + 5)) as f64;
            k += 1;
        }
        factors
    };
    let square = x * x;
    let nested = FACTORS.iter().rev().fold(1.0, |inner, factor| 1.0 - square * factor * inner);
    x * square / 6.0 * nested
}

#[cfg(test)]
mod tests;
