//! Forces on the centre of mass, and its motion `x' = v`, `v' = F/m` (handout eq. 4.1: `y = R x ~R + x0`).

use super::formula::{Formula, Motion};
use crate::error::TorqueError;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::{Function, Point};
use polhode_ga::{Rotor, Vector};

/// A force on the centre of mass. Vectors of the body are in body axes.
#[derive(Clone, Debug)]
pub enum Force {
    /// Constant in space, in N.
    Constant(Vector),
    /// Constant in body axes, in N: a thruster. Off the centre of mass it also exerts the torque
    /// [`super::torque::Torque::ConstantBody`].
    Body(Vector),
    /// `−k v`, k in N s/m.
    Drag(f64),
    /// `−k |v| v`, k in N s²/m².
    QuadraticDrag(f64),
    /// `−k (x − anchor)`, k in N/m.
    Spring(f64, Vector),
    /// `−μ m x/|x|³`, attraction by a centre at the origin of space, μ in m³/s².
    Central(f64),
    /// A formula, in space, in N.
    Formula(Formula),
    /// A function of the caller, in space, in N.
    Function(Function<Vector>),
}

/// A force, and the point of the body at which it acts, in body axes, in metres; the centre of mass by default.
#[derive(Clone, Debug)]
pub struct Push {
    /// The force.
    pub force: Force,
    /// The point, for a thrust only.
    pub at: Option<Vector>,
}

impl From<Force> for Push {
    fn from(force: Force) -> Push {
        Push { force, at: None }
    }
}

/// The mass and the forces of a moving body.
#[derive(Clone, Debug)]
pub struct Translation {
    /// In kg.
    pub mass: f64,
    /// The forces.
    pub forces: Vec<Force>,
}

impl Force {
    /// The same force with its body components in other body axes: `x' = ~F x F`.
    pub fn in_axes(self, frame: Rotor) -> Force {
        match self {
            Force::Body(force) => Force::Body(frame.reverse().apply(force)),
            Force::Formula(law) => Force::Formula(law.in_axes(frame)),
            Force::Function(law) => Force::Function(law.in_axes(frame)),
            same @ (Force::Constant(_)
            | Force::Drag(_)
            | Force::QuadraticDrag(_)
            | Force::Spring(..)
            | Force::Central(_)) => same,
        }
    }

    /// Whether it is constant, or linear in position and velocity by a number: the centre of mass moves in closed form.
    pub fn is_linear(&self) -> bool {
        matches!(self, Force::Constant(_) | Force::Drag(_) | Force::Spring(..))
    }

    /// Whether the force is known to have kinks, such as `|v| v` at rest.
    pub(crate) fn has_kinks(&self) -> bool {
        match self {
            Force::QuadraticDrag(_) => true,
            Force::Formula(law) => law.has_kinks(),
            _ => false,
        }
    }

    /// Whether the force does not depend on time explicitly, as far as is known.
    pub fn is_autonomous(&self) -> bool {
        match self {
            Force::Formula(law) => !law.needs(|motion| motion == Motion::Time),
            Force::Function(_) => false,
            _ => true,
        }
    }

    /// The values at other times of a point; fails with the first time that has none.
    pub(crate) fn values(&self, at: &Point, times: &[f64]) -> Result<Vec<Vector>, (f64, TorqueError)> {
        if let Force::Formula(law) = self
            && let Some(numbers) = law.numbers_at(at, times)
        {
            return Ok(numbers.as_chunks().0.iter().map(|&force| Vector(force)).collect());
        }
        let value = |&time: &f64| {
            let phase = &Phase { time, ..*at.phase };
            self.value(&Point { phase, ..*at }).map_err(|error| (time, error))
        };
        times.iter().map(value).collect()
    }

    /// The force in space, in N.
    pub fn value(&self, at: &Point) -> Result<Vector, TorqueError> {
        let Point { mass, phase, center, .. } = *at;
        Ok(match self {
            Force::Constant(force) => *force,
            Force::Body(force) => phase.rotor.apply(*force),
            Force::Drag(k) => center.velocity * -k,
            Force::QuadraticDrag(k) => center.velocity * (-k * center.velocity.norm()),
            Force::Spring(k, anchor) => (center.position - *anchor) * -k,
            Force::Central(mu) => {
                let distance = center.position.norm();
                if distance == 0.0 {
                    return Err(TorqueError::undefined(
                        "the body is at the centre of attraction, where the force is infinite",
                    ));
                }
                center.position * (-mu * mass / distance / distance / distance)
            }
            Force::Formula(law) => Vector(law.value(at)?.components().try_into().unwrap_or_default()),
            Force::Function(law) => {
                let force = law.value(at)?;
                if !force.0.iter().all(|x| x.is_finite()) {
                    let Vector(force) = force;
                    return Err(TorqueError::undefined(format!(
                        "the force that the function returned is {force:?}; it must be finite"
                    )));
                }
                force
            }
        })
    }

    /// The rate of change of the velocity in 1/s, a scale for steps; 0 if unknown.
    fn rate(&self, mass: f64, start: &Center) -> f64 {
        match self {
            Force::Drag(k) => k.abs() / mass,
            Force::QuadraticDrag(k) => k.abs() * start.velocity.norm() / mass,
            Force::Spring(k, _) => (k.abs() / mass).sqrt(),
            Force::Central(mu) => {
                let distance = start.position.norm();
                if distance == 0.0 { 0.0 } else { (mu.abs() / distance).sqrt() / distance }
            }
            Force::Constant(_) | Force::Body(_) | Force::Formula(_) | Force::Function(_) => 0.0,
        }
    }
}

impl Translation {
    /// v', in m/s².
    pub fn acceleration(
        &self,
        body: &Gyrostat,
        phase: &Phase,
        center: &Center,
    ) -> Result<Vector, TorqueError> {
        let at = Point { body, mass: self.mass, phase, center };
        let mut force = Vector::default();
        for law in &self.forces {
            force += law.value(&at)?;
        }
        // The mass may be unknown where no force acts.
        Ok(if self.forces.is_empty() { force } else { force / self.mass })
    }

    /// The fastest rate of all forces, in 1/s.
    pub(crate) fn rate(&self, start: &Center) -> f64 {
        self.forces.iter().map(|force| force.rate(self.mass, start)).fold(0.0, f64::max)
    }
}
