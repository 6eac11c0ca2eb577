//! Errors of functions without a value.

use std::fmt;

/// Largest deviation `max |MᵀM − 1|` of a matrix that is accepted as a rotation.
pub const MATRIX_TOLERANCE: f64 = 1e-4;

/// The error type: each reason with its number, if it has one, and its message.
macro_rules! reasons {
    ($($(#[$doc:meta])* $name:ident $({ $(#[$field_doc:meta])* $field:ident })? $message:literal,)*) => {
        /// Why a function has no value.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum MathError {
            $($(#[$doc])* $name $({ $(#[$field_doc])* $field: f64 })?,)*
        }

        impl fmt::Display for MathError {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self {
                    $(MathError::$name $({ $field })? => write!(f, $message),)*
                }
            }
        }
    };
}

reasons! {
    /// A component is NaN or infinite.
    NotFinite "a component is NaN or infinite; remove such values first",
    /// A rotor needs a component that is not zero.
    ZeroRotor "all components are zero, which is not a rotor; give the identity as 1, 0, 0, 0",
    /// A plane of zero or non-finite size has no direction.
    NoPlane "a bivector of zero or non-finite size spans no plane; give a nonzero one",
    /// A vector of zero or non-finite length has no direction.
    NoDirection "a vector of zero or non-finite length has no direction; give a nonzero one",
    /// The matrix is not orthogonal within the tolerance.
    NotOrthogonal {
        /// `max |MᵀM − 1|`.
        deviation
    } "not a rotation matrix: max |MᵀM − 1| = {deviation:.3e}, more than {MATRIX_TOLERANCE:e}; orthogonalize it first",
    /// The matrix is orthogonal with determinant −1.
    Reflection "the matrix has determinant −1, a reflection; a rotation has +1; swap or flip an axis",
    /// No inverse: `|M M̄| / |M|²`, M̄ the Clifford conjugate, is zero to rounding.
    Singular {
        /// That ratio.
        ratio
    } "no inverse: the multivector is singular to rounding (|M M̄|/|M|² = {ratio:.1e}, M̄ its Clifford conjugate)",
    /// No logarithm: an eigenvalue is zero to rounding.
    NoLogarithm "no logarithm: the multivector is singular to rounding",
    /// No square root: the two eigenvalues' roots cancel.
    NoSquareRoot "no square root: the multivector is singular to rounding",
    /// No inverse: the condition number of multiplication by the multivector is beyond rounding.
    IllConditioned {
        /// Its reciprocal.
        reciprocal_condition
    } "no inverse: singular to rounding (reciprocal condition {reciprocal_condition:.1e})",
    /// Not a number times an even versor.
    NotVersor {
        /// The larger of its odd part and the nonscalar part of `M~M`, relative to `|M|` and `|M|²`.
        deviation
    } "not an even versor (a product of an even number of vectors): M ~M is not a number, or M is not even \
       (relative deviation {deviation:.1e}); only versors have a logarithm or square root here",
    /// No bivector was found whose exponential is this versor.
    NoBivectorLogarithm "no logarithm: found no bivector whose exponential is this versor",
    /// The angle is so large that its rounding exceeds a turn.
    AngleTooLarge "the angle exceeds 2^52, where rounding exceeds a turn; reduce it first",
    /// A metric with null generators has no `I⁻¹`.
    DegenerateMetric
        "no dual: a generator squares to zero, so the pseudoscalar has no inverse; take the complement",
    /// Zero does not represent a subspace.
    NoSubspace "zero does not represent a subspace; give a nonzero blade",
    /// Not a wedge product of vectors.
    NotBlade {
        /// The part outside the nearest blade, relative to `|M|`.
        deviation
    } "not a blade (a wedge product of vectors): relative deviation {deviation:.1e}; give a wedge of vectors",
    /// The result is beyond the range of floating point.
    Overflow "the result is beyond the range of floating point (1.8e308); scale the argument down",
    /// Division by 0.
    DivisionByZero "division by zero; give a nonzero divisor",
}

impl std::error::Error for MathError {}
