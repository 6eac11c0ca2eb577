//! The problem that a scene poses, and how to solve it.

use super::{DrawError, Law, Scene};
use crate::body::Body;
use crate::body::inertia::Inertia;
use crate::ensemble::{Ensemble, Rows, Start};
use crate::laws::force::Force;
use crate::laws::torque::Torque;
use crate::methods::Method;
use crate::run::{Options, Problem, Setup};
use crate::state::center::Center;
use polhode_ga::{Bivector, Rotor, Vector};
use std::ops::Range;

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

    /// How that body turns: its start, the laws made with it, and the torques of thrusts.
    pub fn setup(&self, body: &Body, laws: &[Law]) -> Setup {
        let laws = laws.iter().map(|law| law.torque.clone());
        Setup {
            inertia: self.ruling_inertia(body),
            rotor: self.attitude,
            omega: self.omega_body(),
            time: self.time,
            torques: laws.chain(self.thrust_torques(body)).collect(),
            has_forces: !self.forces.is_empty(),
        }
    }

    /// The motion of that body under the laws made with it, and under the forces.
    pub fn problem(&self, body: &Body, laws: &[Law]) -> Problem {
        Problem::of(&self.setup(body, laws)).with_center(self.center, body.mass, &self.pushes())
    }

    /// Some bodies of the scene's ensemble, with their laws and forces.
    pub fn bodies(
        &self,
        ensemble: &super::Ensemble,
        built: (&Body, &[Law]),
        bodies: Range<usize>,
    ) -> Result<Ensemble, DrawError> {
        let drawn = ensemble.draw(self, built, bodies)?;
        let starts = drawn.rotors.iter().zip(&drawn.omegas).zip(&drawn.centers);
        let starts = starts.map(|((rotor, omega), [x, y, z, u, v, w])| Start {
            time: self.time,
            rotor: Rotor::from_unit_components(*rotor),
            omega: Bivector(*omega),
            center: Center { position: Vector([*x, *y, *z]), velocity: Vector([*u, *v, *w]) },
        });
        let laws = drawn.laws.into_iter().chain(self.thrust_torques(built.0).map(|torque| vec![torque]));
        Ok(Ensemble {
            inertias: Rows::new(drawn.inertias),
            starts: starts.collect(),
            laws: laws.map(Rows::new).collect(),
            masses: Rows::new(vec![built.0.mass]),
            forces: self.pushes(),
        })
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
