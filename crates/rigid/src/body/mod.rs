//! Bodies: mass, centre of mass and inertia.
//!
//! The motion of a rigid body depends on its shape only through the mass, the centre of mass and the inertia map about
//! it (handout eq. 4.15, 4.18). About a point at `d` from the centre of mass (parallel axis theorem)
//!
//! ```text
//! I_P(B) = I(B) + m d∧(d·B).
//! ```

pub mod inertia;
pub mod mesh;
pub mod solids;
pub mod surface;

use crate::error::BodyError;
use crate::numerics::sum::{Sum, SymmetricSum};
use inertia::Inertia;
use polhode_ga::{Rotor, Vector};
use std::array::from_fn;

/// Largest angle in rad between a weight's moment and the centre of mass that counts as rounding.
const ALIGNED: f64 = 1e-6;
/// Larger accelerations in m/s² mean that the centre of mass is at the fixed point up to rounding.
const LARGEST_ACCELERATION: f64 = 1e6;

/// A rigid body: mass in kg, centre of mass in m, inertia about the centre of mass in kg m², all in body
/// axes. [`Body::new`] checks them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Mass, positive.
    pub mass: f64,
    /// Centre of mass in body axes.
    pub center_of_mass: Vector,
    /// The inertia map about the centre of mass.
    pub inertia: Inertia,
}

impl Body {
    /// A body of positive mass.
    pub fn new(mass: f64, inertia: Inertia, center_of_mass: Vector) -> Result<Body, BodyError> {
        check_mass(mass)?;
        if let Some(k) = center_of_mass.0.iter().position(|x| !x.is_finite()) {
            let what = format!("the centre of mass's component e{}", k + 1);
            return Err(BodyError::NotFinite { what, value: center_of_mass.0[k] });
        }
        Ok(Body { mass, center_of_mass, inertia })
    }

    /// A body with an extent; an error if its moments underflow to zero.
    pub(crate) fn extended(mass: f64, inertia: Inertia, center_of_mass: Vector) -> Result<Body, BodyError> {
        let largest = inertia.principal_moments().into_iter().fold(0.0, f64::max);
        if largest < f64::MIN_POSITIVE {
            return Err(BodyError::TooSmall { moment: largest });
        }
        Body::new(mass, inertia, center_of_mass)
    }

    /// The body made of point masses. Zero masses are allowed if the total is positive.
    pub fn from_points(masses: &[f64], positions: &[Vector]) -> Result<Body, BodyError> {
        check_points(masses, positions)?;
        let Some(&first) = positions.first() else { return Err(BodyError::NoPoints) };
        // Positions relative to the first point keep the digits of points far from the origin.
        let mut mass = Sum::default();
        let mut moment = [Sum::default(); 3];
        for (&m, &x) in masses.iter().zip(positions) {
            mass.add(m);
            moment.iter_mut().zip((x - first).0).for_each(|(sum, c)| sum.add(m * c));
        }
        let mass = mass.value();
        check_mass(mass)?;
        let center = Vector(moment.map(|sum| sum.value() / mass));
        let mut second = SymmetricSum::default();
        for (&m, &x) in masses.iter().zip(positions) {
            let d = (x - first - center).0;
            second.add(|i, j| m * d[i] * d[j]);
        }
        let inertia = Inertia::from_second_moment(second.matrix())?;
        let apart = positions.iter().zip(masses).any(|(x, m)| *m > 0.0 && *x != first + center);
        let body = if apart { Body::extended } else { Body::new };
        body(mass, inertia, first + center)
    }

    /// The inertia map about another point, in the same axes.
    pub fn inertia_about(&self, point: Vector) -> Result<Inertia, BodyError> {
        let shift = point_inertia(self.mass, self.center_of_mass - point);
        Inertia::from_symmetric(sum(self.inertia.matrix(), shift))
    }

    /// The [`weight_moment`] about a point.
    pub fn weight_moment(&self, acceleration: f64, point: Vector) -> Vector {
        weight_moment(self.mass, acceleration, self.center_of_mass - point)
    }

    /// Whether c is the moment of this body's weight about the origin for some acceleration `g >= 0`.
    pub fn has_weight_moment(&self, c: Vector) -> bool {
        let (size, distance) = (c.norm(), self.center_of_mass.norm());
        if size == 0.0 || size > LARGEST_ACCELERATION * self.mass * distance {
            return size == 0.0;
        }
        let (along, axis) = (c * size.recip(), self.center_of_mass * distance.recip());
        along.dot(axis) > 0.0 && along.wedge(axis).norm() <= ALIGNED
    }

    /// The body after `x ↦ R x ~R + position`.
    pub fn moved(&self, rotor: Rotor, position: Vector) -> Result<Body, BodyError> {
        Body::new(self.mass, self.inertia.rotated(rotor), rotor.apply(self.center_of_mass) + position)
    }

    /// The two bodies joined rigidly. Their inertias about the common centre of mass add, and that of the reduced mass
    /// `m1 m2/(m1 + m2)` at their distance.
    pub fn combine(&self, other: &Body) -> Result<Body, BodyError> {
        let mass = self.mass + other.mass;
        // From the heavier one, whose centre is the nearer, so that few digits of a long distance are added.
        let (heavy, light) = if self.mass >= other.mass { (self, other) } else { (other, self) };
        let distance = light.center_of_mass - heavy.center_of_mass;
        let share = light.mass / mass;
        let reduced = point_inertia(heavy.mass * share, distance);
        let matrix = sum(sum(self.inertia.matrix(), other.inertia.matrix()), reduced);
        Body::new(mass, Inertia::from_symmetric(matrix)?, heavy.center_of_mass + distance * share)
    }
}

/// The moment of a weight, `m g (centre of mass − pivot)`: the c of [`crate::laws::torque::Torque::Heavy`] on a body held at
/// the pivot.
pub fn weight_moment(mass: f64, acceleration: f64, arm: Vector) -> Vector {
    arm * (mass * acceleration)
}

/// The matrix of `B ↦ m d∧(d·B)`, `m (d² − d dᵀ)`.
fn point_inertia(m: f64, Vector([x, y, z]): Vector) -> [[f64; 3]; 3] {
    [
        [m * (y * y + z * z), -m * x * y, -m * x * z],
        [-m * x * y, m * (z * z + x * x), -m * y * z],
        [-m * x * z, -m * y * z, m * (x * x + y * y)],
    ]
}

fn sum(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    from_fn(|i| from_fn(|j| a[i][j] + b[i][j]))
}

fn check_mass(mass: f64) -> Result<(), BodyError> {
    if mass > 0.0 && mass.is_finite() { Ok(()) } else { Err(BodyError::Mass(mass)) }
}

fn check_points(masses: &[f64], positions: &[Vector]) -> Result<(), BodyError> {
    if masses.len() != positions.len() {
        return Err(BodyError::PointCount { masses: masses.len(), positions: positions.len() });
    }
    if let Some(index) = masses.iter().position(|m| !(*m >= 0.0 && m.is_finite())) {
        return Err(BodyError::PointMass { index, mass: masses[index] });
    }
    if let Some(index) = positions.iter().position(|x| !x.0.iter().all(|c| c.is_finite())) {
        return Err(BodyError::PointPosition { index, position: positions[index] });
    }
    Ok(())
}
