//! The problem and the options of a scene.

use super::{Law, Scene};
use crate::body::Body;
use crate::body::inertia::Inertia;
use crate::laws::force::Force;
use crate::laws::torque::Torque;
use crate::methods::Method;
use crate::run::{Options, Problem};
use polhode_ga::Vector;

impl Scene {
    /// The inertia for the rotation of a body of [`Scene::build`]: about the fixed point, if there is one, which is then the
    /// origin of its axes.
    pub fn ruling_inertia(&self, body: &Body) -> Inertia {
        // `build` has rejected a body for which there is none.
        if self.is_held() {
            body.inertia_about(Vector::default()).unwrap_or(body.inertia)
        } else {
            body.inertia
        }
    }

    /// The motion of that body under its torque laws and the forces.
    pub fn problem(&self, body: &Body, laws: &[Law]) -> Problem {
        let laws = laws.iter().map(|law| law.torque.clone());
        let torques: Vec<Torque> = laws.chain(self.thrust_torques(body)).collect();
        Problem::new(&self.ruling_inertia(body), self.attitude, self.omega_body(), &torques)
            .with_center(self.center, body.mass, &self.pushes())
            .starting_at(self.time)
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
