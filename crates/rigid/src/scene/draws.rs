//! Draws the bodies of an ensemble.
//!
//! The random numbers of a body depend on the seed and its index alone ([`crate::random`]): runs in blocks or threads,
//! longer runs, and runs with one more varied parameter have the same bodies.

use super::spread::Noise;
use super::{Attitudes, Ensemble, Gravity, Law, Parameter, Scene, SpinFrame, Spread};
use crate::body::Body;
use crate::body::inertia::Inertia;
use crate::ensemble::{self, Rows, Start};
use crate::laws::torque::Torque;
use crate::random::Words;
use crate::state::center::Center;
use polhode_ga::{Bivector, Rotor, Vector};
use std::fmt::Display;
use std::iter::Take;
use std::ops::Range;
use thiserror::Error;

impl Scene {
    /// A range of the bodies of an ensemble about the body and the laws of a scene; the torques of thrusts follow these
    /// laws. An error only for numbers beyond the range of floats.
    pub(super) fn drawn(
        &self,
        ensemble: &Ensemble,
        (body, laws): (&Body, &[Law]),
        bodies: Range<usize>,
    ) -> Result<ensemble::Ensemble, DrawError> {
        let draw = Draw { ensemble, bodies };
        let rotors = draw.rotors(self.attitude);
        let omegas = draw.omegas(self, &rotors);
        let places = draw.spread("position", ensemble.position, self.center.position);
        let velocities = draw.spread("velocity", ensemble.velocity, self.center.velocity);
        let start = |((rotor, omega), (position, velocity))| Start {
            time: self.time,
            rotor,
            omega,
            center: Center { position, velocity },
        };
        let starts = rotors.into_iter().zip(omegas).zip(places.into_iter().zip(velocities));
        let laws = laws.iter().map(|law| draw.law(law, body, self.gravity));
        let laws = laws.chain(self.thrust_torques(body).map(|torque| Ok(vec![torque])));
        Ok(ensemble::Ensemble {
            inertias: Rows::new(draw.inertias(body, self.is_held())?),
            starts: starts.map(start).collect(),
            laws: laws.map(|law| law.map(Rows::new)).collect::<Result<_, _>>()?,
            masses: Rows::new(vec![body.mass]),
            forces: self.pushes().into_iter().map(|force| Rows::new(vec![force])).collect(),
        })
    }
}

/// A range of the bodies of an ensemble.
struct Draw<'e> {
    ensemble: &'e Ensemble,
    bodies: Range<usize>,
}

impl<'e> Draw<'e> {
    /// The random words of this name for each body.
    fn words(&self, name: &str) -> Take<Words> {
        Words::new(self.ensemble.seed, name, self.bodies.start as u64).take(self.bodies.len())
    }

    /// The random numbers of this name for each body: of its own words, or correlated with others.
    fn noise(&self, name: &str) -> Box<dyn Iterator<Item = Noise> + 'e> {
        let ensemble: &'e Ensemble = self.ensemble;
        match ensemble.covariances.iter().find_map(|covariance| covariance.find(name)) {
            None => Box::new(self.words(name).map(Noise::Words)),
            Some(joint) => {
                let mut streams: Vec<_> = joint.names().map(|name| self.words(name)).collect();
                let words = move || streams.iter_mut().filter_map(Iterator::next).collect::<Vec<_>>();
                Box::new(
                    std::iter::repeat_with(words)
                        .take(self.bodies.len())
                        .map(move |words| joint.noise(&words)),
                )
            }
        }
    }

    /// A draw for each body from the random numbers of this name; without `draw` the nominal value.
    fn each<T: Clone>(&self, name: &str, nominal: T, draw: Option<impl Fn(Noise) -> T>) -> Vec<T> {
        match draw {
            Some(draw) => self.noise(name).map(draw).collect(),
            None => vec![nominal; self.bodies.len()],
        }
    }

    /// Vectors distributed about one.
    fn spread(&self, name: &str, spread: Option<Spread>, vector: Vector) -> Vec<Vector> {
        self.each(name, vector, spread.map(|spread| move |noise| Vector(spread.draw(vector.0, &noise))))
    }

    /// The direction of four normal numbers is uniform on the 3-sphere, so that its rotor is a uniform attitude.
    fn rotors(&self, nominal: Rotor) -> Vec<Rotor> {
        let draw = |attitudes| {
            move |noise: Noise| match attitudes {
                Attitudes::Turned(spread) => {
                    nominal * Rotor::exp(Bivector(spread.draw([0.0; 3], &noise)) * -0.5)
                }
                Attitudes::Uniform => Rotor::from_unit_components(unit(noise.normals())),
            }
        };
        self.each("attitude", nominal, self.ensemble.attitude.map(draw))
    }

    /// Angular velocities in body axes.
    fn omegas(&self, scene: &Scene, rotors: &[Rotor]) -> Vec<Bivector> {
        let size = scene.spin.norm();
        let direction = |noise: Noise| unit(noise.normals()).map(|x| size * x);
        let directions = self.ensemble.directions.then_some(direction);
        let mut spins = self.each("spin.direction", scene.spin.0, directions);
        if let Some(spread) = self.ensemble.spin {
            let draw = |(spin, noise): (&mut [f64; 3], _)| *spin = spread.draw(*spin, &noise);
            spins.iter_mut().zip(self.noise("spin")).for_each(draw);
        }
        let omega = |(spin, rotor): ([f64; 3], &Rotor)| match scene.spin_frame {
            SpinFrame::Body => Bivector(spin),
            SpinFrame::Space => rotor.reverse().apply_bivector(Bivector(spin)),
        };
        spins.into_iter().zip(rotors).map(omega).collect()
    }

    /// Moments are physical if and only if no integral `c_k = ∫ x_k² dm` along the principal axes is negative; they are
    /// `i_1 = c_2 + c_3` and cyclically. Factors on the c_k keep moments physical, factors on the moments would not.
    fn inertias(&self, body: &Body, held: bool) -> Result<Vec<Inertia>, DrawError> {
        let about_the_point = |inertia: Inertia| match held {
            true => Body { inertia, ..*body }.inertia_about(Vector::default()),
            false => Ok(inertia),
        };
        let Some(spread) = self.ensemble.moments else {
            return Ok(vec![about_the_point(body.inertia).map_err(self.failed(0))?]);
        };
        let frame = body.inertia.principal_frame();
        let [a, b, c] = body.inertia.principal_moments();
        // For a flat body one is 0, or negative by rounding.
        let integrals = [b + c - a, c + a - b, a + b - c].map(|twice| (0.5 * twice).max(0.0));
        let inertia = |noise| {
            let [x, y, z] = spread.draw(integrals, &noise);
            let inertia = Inertia::from_principal_moments([y + z, z + x, x + y])?;
            about_the_point(if frame == Rotor::IDENTITY { inertia } else { inertia.rotated(frame) })
        };
        let noise = self.noise("moments").enumerate();
        noise.map(|(row, noise)| inertia(noise).map_err(self.failed(row))).collect()
    }

    /// The law of each body, or one law for all.
    fn law(&self, law: &Law, body: &Body, gravity: Option<Gravity>) -> Result<Vec<Torque>, DrawError> {
        let mut torques = vec![law.torque.clone()];
        for (parameter, spread) in self.ensemble.parameters.iter().filter(|(p, _)| p.law == law.name) {
            torques = match gravity {
                Some(gravity) if law.name == "gravity" => self.weights(parameter, *spread, body, gravity),
                _ => self.varied(parameter, *spread, torques)?,
            };
        }
        Ok(torques)
    }

    /// The laws of gravity with random accelerations.
    fn weights(&self, parameter: &Parameter, spread: Spread, body: &Body, gravity: Gravity) -> Vec<Torque> {
        let weight = |noise| {
            let [acceleration, ..] = spread.draw([gravity.acceleration, 0.0, 0.0], &noise);
            Gravity { acceleration, ..gravity }.law(body).torque
        };
        self.noise(&parameter.name()).map(weight).collect()
    }

    /// Laws, one for all or one for each body, with a random parameter.
    fn varied(
        &self,
        parameter: &Parameter,
        spread: Spread,
        torques: Vec<Torque>,
    ) -> Result<Vec<Torque>, DrawError> {
        let torque = |row: usize| torques.get(row).unwrap_or(&torques[0]);
        let draw = |(row, noise): (usize, Noise)| {
            let torque = torque(row);
            let Some((numbers, _)) = parameter.of(torque) else { return Ok(torque.clone()) };
            parameter.set(torque, spread.draw(numbers, &noise)).map_err(self.failed(row))
        };
        self.noise(&parameter.name()).enumerate().map(draw).collect()
    }

    /// The error of the body in this row.
    fn failed<E: Display>(&self, row: usize) -> impl Fn(E) -> DrawError {
        let body = self.bodies.start + row;
        move |error| DrawError { body, message: error.to_string() }
    }
}

/// A draw that is not a possible body or law.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("body {body}: {message}")]
pub struct DrawError {
    /// The index of the body, from 0.
    pub body: usize,
    /// The reason.
    pub message: String,
}

/// The direction of a vector of normal numbers, which are never 0 and never large.
fn unit<const N: usize>(numbers: [f64; N]) -> [f64; N] {
    let size = numbers.iter().map(|x| x * x).sum::<f64>().sqrt();
    numbers.map(|x| x / size)
}
