//! Errors of functions without a value.

use std::fmt;

/// Largest deviation `max |MᵀM − 1|` of a matrix that is accepted as a rotation.
pub const MATRIX_TOLERANCE: f64 = 1e-4;

/// Why a function has no value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MathError {
    /// A component is NaN or infinite.
    NotFinite,
    /// A rotor needs a component that is not zero.
    ZeroRotor,
    /// A plane of zero or non-finite size has no direction.
    NoPlane,
    /// A vector of zero or non-finite length has no direction.
    NoDirection,
    /// The matrix is not orthogonal within the tolerance.
    NotOrthogonal {
        /// `max |MᵀM − 1|`.
        deviation: f64,
    },
    /// The matrix is orthogonal with determinant −1.
    Reflection,
    /// No inverse: `|M M̄| / |M|²`, M̄ the Clifford conjugate, is zero to rounding.
    Singular {
        /// That ratio.
        ratio: f64,
    },
    /// No logarithm: an eigenvalue is zero to rounding.
    NoLogarithm,
    /// No square root: the two eigenvalues' roots cancel.
    NoSquareRoot,
    /// No inverse: the condition number of multiplication by the multivector is beyond rounding.
    IllConditioned {
        /// Its reciprocal.
        reciprocal_condition: f64,
    },
    /// Not a number times an even versor.
    NotVersor {
        /// The larger of its odd part and the nonscalar part of `M~M`, relative to `|M|` and `|M|²`.
        deviation: f64,
    },
    /// No bivector was found whose exponential is this versor.
    NoBivectorLogarithm,
    /// The angle is so large that its rounding exceeds a turn.
    AngleTooLarge,
    /// A metric with null generators has no `I⁻¹`.
    DegenerateMetric,
    /// Zero does not represent a subspace.
    NoSubspace,
    /// Not a wedge product of vectors.
    NotBlade {
        /// The part outside the nearest blade, relative to `|M|`.
        deviation: f64,
    },
    /// The result is beyond the range of floating point.
    Overflow,
    /// Division by 0.
    DivisionByZero,
}

impl fmt::Display for MathError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MathError::NotFinite => write!(f, "a component is NaN or infinite; remove such values first"),
            MathError::ZeroRotor => {
                write!(f, "all components are zero, which is not a rotor; give the identity as 1, 0, 0, 0")
            }
            MathError::NoPlane => {
                write!(f, "a bivector of zero or non-finite size spans no plane; give a nonzero one")
            }
            MathError::NoDirection => {
                write!(f, "a vector of zero or non-finite length has no direction; give a nonzero one")
            }
            MathError::NotOrthogonal { deviation } => write!(
                f,
                "not a rotation matrix: max |MᵀM − 1| = {deviation:.3e}, more than {MATRIX_TOLERANCE:e}; orthogonalize it first"
            ),
            MathError::Reflection => write!(
                f,
                "the matrix has determinant −1, a reflection; a rotation has +1; swap or flip an axis"
            ),
            MathError::Singular { ratio } => write!(
                f,
                "no inverse: the multivector is singular to rounding (|M M̄|/|M|² = {ratio:.1e}, M̄ its Clifford conjugate)"
            ),
            MathError::NoLogarithm => write!(f, "no logarithm: the multivector is singular to rounding"),
            MathError::NoSquareRoot => write!(f, "no square root: the multivector is singular to rounding"),
            MathError::IllConditioned { reciprocal_condition } => write!(
                f,
                "no inverse: singular to rounding (reciprocal condition {reciprocal_condition:.1e})"
            ),
            MathError::NotVersor { deviation } => write!(
                f,
                "not an even versor (a product of an even number of vectors): M ~M is not a number, or M is not even \
                 (relative deviation {deviation:.1e}); only versors have a logarithm or square root here"
            ),
            MathError::NoBivectorLogarithm => {
                write!(f, "no logarithm: found no bivector whose exponential is this versor")
            }
            MathError::AngleTooLarge => {
                write!(f, "the angle exceeds 2^52, where rounding exceeds a turn; reduce it first")
            }
            MathError::DegenerateMetric => write!(
                f,
                "no dual: a generator squares to zero, so the pseudoscalar has no inverse; take the complement"
            ),
            MathError::NoSubspace => write!(f, "zero does not represent a subspace; give a nonzero blade"),
            MathError::NotBlade { deviation } => write!(
                f,
                "not a blade (a wedge product of vectors): relative deviation {deviation:.1e}; give a wedge of vectors"
            ),
            MathError::Overflow => write!(
                f,
                "the result is beyond the range of floating point (1.8e308); scale the argument down"
            ),
            MathError::DivisionByZero => write!(f, "division by zero; give a nonzero divisor"),
        }
    }
}

impl std::error::Error for MathError {}
