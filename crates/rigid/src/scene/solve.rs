//! From a scene that is built to what there is to solve.

use super::{Law, Scene};
use crate::body::Body;
use crate::body::inertia::Inertia;
use crate::laws::force::Force;
use crate::laws::torque::Torque;
use crate::methods::Method;
use crate::run::{Options, Problem};
use polhode_ga::Vector;

impl Scene {
    /// The inertia that rules the rotation of a body that [`Scene::build`] made: about the fixed point, where there
    /// is one, which is then the origin of its axes.
    pub fn ruling_inertia(&self, body: &Body) -> Inertia {
        // `build` has refused a body for which there is none.
        if self.is_held() {
            body.inertia_about(Vector::default()).unwrap_or(body.inertia)
        } else {
            body.inertia
        }
    }

    /// The motion of that body under the laws made with it, and under the forces.
    pub fn problem(&self, body: &Body, laws: &[Law]) -> Problem {
        let laws = laws.iter().map(|law| law.torque.clone());
        let torques: Vec<Torque> = laws.chain(self.thrust_torques(body)).collect();
        Problem::new(&self.ruling_inertia(body), self.attitude, self.omega_body(), &torques)
            .with_center(self.center, body.mass, &self.pushes())
            .starting_at(self.time)
    }

    /// Where the origin that the scene speaks of is in the axes of the built body: under gravity the pivot becomes
    /// their origin.
    pub fn shift(&self) -> Vector {
        self.gravity.map_or(Vector::default(), |gravity| -gravity.pivot)
    }

    /// The forces.
    pub fn pushes(&self) -> Vec<Force> {
        self.forces.iter().map(|push| push.force.clone()).collect()
    }

    /// The torques of thrusts that do not act at the centre of mass: `(x − c) ∧ F`.
    pub fn thrust_torques<'a>(&'a self, body: &'a Body) -> impl Iterator<Item = Torque> + 'a {
        self.forces.iter().filter_map(move |push| match (&push.force, push.at) {
            (Force::Body(thrust), Some(at)) => {
                Some(Torque::ConstantBody((at - body.center_of_mass).wedge(*thrust)))
            }
            _ => None,
        })
    }

    /// How to solve it. Both tolerances measure the same scaled difference, so the larger one rules.
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
