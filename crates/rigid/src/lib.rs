//! Rigid-body mechanics in geometric algebra.
//!
//! A body's attitude is a rotor `R` that carries body axes to space axes; its angular velocity and
//! angular momentum are bivectors, `L = R I(Ω_B) ~R` (handout eq. 4.19), where the inertia map `I`
//! takes the plane of rotation to the plane of angular momentum.
//!
//! Modules: [`body`] (mass, centre of mass, the inertia map; solids, triangle meshes and their files), [`state`] (a point
//! of a motion), [`laws`] (torques, forces, formulas, events, and what is conserved), [`exact`] (motions in closed form),
//! [`methods`] (steps), [`run`] (one motion at given times, with a certificate of what was conserved), [`ensemble`] (many
//! bodies at once), [`describe`] (properties of a motion as [`mod@facts`]), [`numerics`] (arithmetic of twice the
//! precision, elliptic integrals), [`error`]; [`units`] and [`scene`] (scene files).
//!
//! SI units; inertia is about the centre of mass, in body axes, unless a name says otherwise.
//!
//! # Example
//!
//! A top with three different moments, held at a point: it has no closed form, so it is integrated to a tolerance, and the
//! certificate reports what was conserved.
//!
//! ```
//! use polhode_ga::{Bivector, Rotor, Vector};
//! use polhode_rigid::laws::torque::Torque;
//! use polhode_rigid::run::{Options, Problem};
//! use polhode_rigid::{Inertia, SimulateError};
//!
//! let inertia = Inertia::from_principal_moments([0.3, 0.2, 0.1]).expect("moments of a body");
//! let weight = Torque::Heavy(Vector([0.0, 0.0, 0.5])); // m g (centre of mass), in N m
//! let problem = Problem::new(&inertia, Rotor::IDENTITY, Bivector([0.5, 0.0, 20.0]), &[weight]);
//! let motion = problem.simulate(&[0.0, 1.0, 2.0], Options::default(), &mut |_| true)?;
//! assert_eq!(motion.states().rotors.len(), 3);
//! // Energy, and the component of L about the vertical.
//! assert_eq!(motion.certificate.drifts.len(), 2);
//! assert!(motion.certificate.drifts.iter().all(|(_, _, drift)| *drift < 1e-12));
//! # Ok::<(), SimulateError>(())
//! ```

pub mod body;
pub mod describe;
pub mod ensemble;
pub mod error;
pub mod exact;
pub mod facts;
pub mod laws;
pub mod methods;
pub mod numerics;
mod random;
pub mod run;
pub mod scene;
pub mod state;
pub mod stepper;
pub mod units;

pub use body::Body;
pub use body::inertia::Inertia;
pub use body::mesh::TriangleMesh;
pub use body::solids::{Amount, Solid};
pub use body::surface::Surface;
pub use error::{BodyError, SimulateError};
pub use polhode_ga::diagnostic::Diagnostic;
pub use scene::Scene;

/// The examples of README.md, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
