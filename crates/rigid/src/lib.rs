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
