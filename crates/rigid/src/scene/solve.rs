//! Problem, ensemble and options of a scene.

use super::{Law, Scene};
use crate::body::Body;
use crate::body::inertia::Inertia;
use crate::laws::force::Force;
use crate::laws::torque::Torque;
use crate::methods::Method;
use crate::run::{Options, Problem, Setup};
use polhode_ga::Vector;

impl Scene {
    /// The inertia of a body of [`Scene::build`] about the fixed point, the origin of its axes, or else about the centre of
    /// mass.
    pub fn ruling_inertia(&self, body: &Body) -> Inertia {
        // `build` has rejected a body for which there is none.
        if self.is_held() {
            body.inertia_about(Vector::default()).unwrap_or(body.inertia)
        } else {
            body.inertia
        }
    }

    /// The rotation of the body: its start, the laws built with it, and the torques of thrusts.
    pub fn setup(&self, body: &Body, laws: &[Law]) -> Setup {
        let laws = laws.iter().map(|law| law.torque.clone());
        Setup {
            inertia: self.ruling_inertia(body),
            rotor: self.attitude,
            omega: self.omega_body(),
            time: self.time,
            torques: laws.chain(self.thrust_torques(body)).collect(),
            mass: body.mass,
            has_forces: !self.forces.is_empty(),
        }
    }

    /// The problem of the body with the laws built with it and the forces.
    pub fn problem(&self, body: &Body, laws: &[Law]) -> Problem {
        Problem::of(&self.setup(body, laws)).with_center(self.center, body.mass, &self.pushes())
    }

    /// The origin of the axes of the scene in those of the built body, whose origin under gravity is the pivot.
    pub fn shift(&self) -> Vector {
        self.gravity.map_or(Vector::default(), |gravity| -gravity.pivot)
    }

    /// The forces.
    pub fn pushes(&self) -> Vec<Force> {
        self.forces.iter().map(|push| push.force.clone()).collect()
    }

    /// The torques of thrusts off the centre of mass: `(x − c) ∧ F`.
    pub fn thrust_torques<'a>(&'a self, body: &'a Body) -> impl Iterator<Item = Torque> + 'a {
        self.forces.iter().filter_map(move |push| match (&push.force, push.at) {
            (Force::Body(thrust), Some(at)) => {
                Some(Torque::ConstantBody((at - body.center_of_mass).wedge(*thrust)))
            }
            _ => None,
        })
    }

    /// Thrusts: the force, and the point at which it acts, in body axes.
    pub fn thrusts<'a>(&'a self, body: &'a Body) -> impl Iterator<Item = (Vector, Vector)> + 'a {
        self.forces.iter().filter_map(|push| match push.force {
            Force::Body(thrust) => Some((thrust, push.at.unwrap_or(body.center_of_mass))),
            _ => None,
        })
    }

    /// The options. Both tolerances bound the same scaled difference, so the larger one applies.
    pub fn options(&self) -> Options {
        let choice = &self.run.choice;
        let rtol = choice.rtol.into_iter().chain(choice.atol).reduce(f64::max);
        Options {
            method: Method::from_name(&choice.method),
            step: choice.step,
            rtol,
            max_step: choice.max_step,
            max_steps: choice.max_steps,
            ..Options::default()
        }
    }
}
