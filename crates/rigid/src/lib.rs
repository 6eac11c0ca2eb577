//! Rigid-body mechanics in the language of geometric algebra.
//!
//! A body's attitude is a rotor `R` that carries body axes to space axes; its angular velocity and
//! angular momentum are bivectors, `L = R I(Ω_B) ~R` (handout eq. 4.19), where the inertia map `I`
//! takes the plane of rotation to the plane of angular momentum.
//!
//! Rooms: [`inertia`] (the map), [`body`] (mass, centre of mass, inertia; composition), [`solids`]
//! (closed forms), [`mesh`] (triangle meshes and their files); [`free`] (the free top, exact), [`regime`], [`elliptic`],
//! [`symmetric_top`],
//! [`torque`] (laws and what they conserve), [`splitting`] (steps), [`simulate`] (runs), [`certificate`] (what they conserved); [`units`] and
//! [`scene`] (what a person writes in a scene file).
//!
//! SI units; inertia is about the centre of mass, in body axes, unless a name says otherwise.

pub mod body;
pub mod certificate;
pub mod classical;
mod closed_form;
pub mod conserved;
mod converge;
mod course;
pub mod damped;
pub mod dmv;
mod double_double;
mod eigen;
pub mod elliptic;
pub mod ensemble;
pub mod event;
mod exact;
mod exert;
pub mod force;
pub mod formula;
pub mod free;
pub mod inertia;
mod kicks;
pub mod lagrange;
pub mod larmor;
pub mod mesh;
pub mod method;
pub mod midpoint;
mod noise;
pub mod phase;
pub mod point;
mod quaternion;
mod random;
pub mod regime;
pub mod runge_kutta;
pub mod scene;
pub mod simulate;
mod simulate_error;
pub mod solids;
pub mod splitting;
mod stops;
mod stride;
mod sum;
pub mod symmetric_top;
pub mod torque;
mod turn;
pub mod units;
mod walk;
mod wide;

pub use body::{Body, BodyError};
pub use inertia::Inertia;
pub use mesh::TriangleMesh;
pub use polhode_ga::diagnostic::Diagnostic;
pub use scene::Scene;
pub use simulate_error::SimulateError;
pub use solids::{Amount, Size, Solid};
