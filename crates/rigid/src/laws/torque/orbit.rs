//! Kepler orbit of a body in the field of a planet.

pub(crate) mod kepler;

use crate::error::TorqueError;
use crate::state::point::{Function, Seen};
use kepler::Elements;
use polhode_ga::{Bivector, Vector};

/// An orbit in the plane e1e2 of space, from e1 towards e2, with the periapsis on e1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    rate: f64,
    eccentricity: f64,
    anomaly: f64,
    elements: Elements<1>,
}

impl Orbit {
    /// A circle at the rate n in rad/s, at time 0 on e1.
    pub fn circular(rate: f64) -> Orbit {
        Orbit::of(rate, 0.0, 0.0)
    }

    /// An ellipse with the mean motion n in rad/s and, at time 0, this mean anomaly in rad.
    pub fn new(rate: f64, eccentricity: f64, anomaly: f64) -> Result<Orbit, TorqueError> {
        if !(0.0..1.0).contains(&eccentricity) {
            return Err(TorqueError::new(format!(
                "eccentricity is {eccentricity}; that of a closed orbit must be at least 0 and below 1"
            )));
        }
        if let Some(value) = [rate, anomaly].into_iter().find(|x| !x.is_finite()) {
            return Err(TorqueError::new(format!(
                "mean motion or mean anomaly is {value}; both must be finite"
            )));
        }
        Ok(Orbit::of(rate, eccentricity, anomaly))
    }

    fn of(rate: f64, eccentricity: f64, anomaly: f64) -> Orbit {
        Orbit { rate, eccentricity, anomaly, elements: Elements::one(rate, eccentricity, anomaly) }
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
    pub fn place(&self, time: f64) -> (Vector, f64) {
        let [[x], [y], [nearness]] = self.elements.places::<false>(&[time]);
        (Vector([x, y, 0.0]), nearness)
    }

    /// Its constants, to compute places of several orbits in lanes.
    pub(crate) fn elements(&self) -> &Elements<1> {
        &self.elements
    }

    /// The rate of the direction u at the periapsis, `n √(1−e²)/(1−e)²`, in rad/s.
    pub(crate) fn fastest_turn(&self) -> f64 {
        let near = 1.0 - self.eccentricity;
        self.rate.abs() * ((1.0 + self.eccentricity) / near).sqrt() / near
    }

    /// `(a/r)³` at the periapsis.
    pub(crate) fn largest_nearness(&self) -> f64 {
        (1.0 - self.eccentricity).powi(-3)
    }
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
                return Err(TorqueError::new(format!("{name} is {value}; it must be positive and finite")));
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
        let [[x], [y], _] = self.orbit.elements.positions::<false>(&[time]);
        Vector([x, y, 0.0]) * self.axis
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
