//! Geometric algebra of any signature, typed values of 3-d space, and formulas.
//!
//! A geometric algebra is spanned by *blades*, products of distinct orthonormal generators
//! `e1 e2 … en`. Multiplying two blades needs two facts only: generators anticommute, and each squares
//! to +1, −1 or 0. [`table`] turns these facts into the product of any two blades by bit arithmetic.
//! **That table is the one definition of the algebra here**; every other product in this crate is a
//! faster way to the same numbers, and the tests prove it equal to the table.
//!
//! The algebra G3 of 3-d space has eight blades, always in the order
//!
//! ```text
//! 1 | e1 e2 e3 | e2e3 e3e1 e1e2 | I = e1e2e3
//! ```
//!
//! so that the three components of a bivector equal those of its dual axial vector: `e2e3 = I e1`.
//!
//! Modules: [`table`] (blades, signatures), [`product`] (the grades that each named product keeps), [`graded`]
//! (a value with its grades), [`g3`] (the typed values of 3-d space: `Vector`, `Bivector`, `Trivector`,
//! `Multivector`, rotors, Euler angles; inverse, exp, log, square root), [`general`] (the same functions in any
//! algebra; complements, join and meet), [`simd`] (lanes, double-double arithmetic, threads), [`rows`] (products and
//! functions over rows of numbers), [`formula`] (the language of the handout), [`error`] (errors of functions),
//! [`diagnostic`] (errors with a place in a text).
//!
//! Conventions: a rotor `R = exp(−Bθ/2)` turns by `θ` in the sense of the unit bivector `B`, actively,
//! `a' = R a ~R`; `S*R` applies `R` first. `dual(A) = A I⁻¹`, so the dual of `a∧b` is the cross product.
//!
//! # Example
//!
//! ```
//! use polhode_ga::product::Product;
//! use polhode_ga::{MathError, Multivector, Rotor, Vector};
//!
//! let (a, b) = (Vector([2.0, 0.0, 0.0]), Vector([1.0, 3.0, 0.0]));
//! let ab = Multivector::from(a).product(Product::Geometric, b.into());
//! assert_eq!(ab, Multivector::scalar(a.dot(b)) + a.wedge(b).into()); // ab = a·b + a∧b
//! assert_eq!(a.wedge(b).dual(), a.cross(b));
//!
//! let turn = Rotor::from_vectors(a, b)?; // the least rotation from the direction of a to that of b
//! assert!((turn.apply(a) / a.norm() - b / b.norm()).norm() < 1e-15);
//! # Ok::<(), MathError>(())
//! ```

pub mod diagnostic;
pub mod error;
pub mod formula;
pub mod g3;
pub mod general;
pub mod graded;
pub mod product;
pub mod rows;
pub mod simd;
pub mod table;

pub use error::MathError;
pub use g3::rotor::Rotor;
pub use g3::values::{Bivector, Multivector, Trivector, Vector};
pub use graded::Graded;

/// The examples of README.md, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
