//! Why a function has no value.

use std::fmt;

/// How far a matrix may be from a rotation and still be read as one: `max |MᵀM − 1|`.
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
    /// No number times an even versor.
    NotVersor {
        /// The larger of its odd part and what in `M~M` is no number, relative to `|M|` and `|M|²`.
        deviation: f64,
    },
    /// No bivector has this versor as its exponential, or none was found.
    NoBivectorLogarithm,
    /// An angle so large that its rounding is more than a turn.
    AngleTooLarge,
    /// A metric with null generators has no `I⁻¹`.
    DegenerateMetric,
    /// Zero stands for no subspace.
    NoSubspace,
    /// No wedge product of vectors.
    NotBlade {
        /// The part that no blade accounts for, relative to `|M|`.
        deviation: f64,
    },
    /// The result is beyond the range of floating point.
    Overflow,
    /// A quotient by 0.
    DivisionByZero,
}

impl fmt::Display for MathError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MathError::NotFinite => write!(f, "a component is NaN or infinite; remove such values first"),
            MathError::ZeroRotor => {
                write!(f, "all components are zero, which is no rotor; give the identity as 1, 0, 0, 0")
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
                "not an even versor (a product of an even number of vectors): M ~M is no number, or M not even \
                 (relative deviation {deviation:.1e}); logarithm and square root are known for versors only"
            ),
            MathError::NoBivectorLogarithm => {
                write!(f, "no logarithm: no bivector was found that has this versor as its exponential")
            }
            MathError::AngleTooLarge => {
                write!(f, "an angle beyond 2^52, whose rounding is a turn; reduce it first")
            }
            MathError::DegenerateMetric => write!(
                f,
                "no dual: a generator squares to zero, so the pseudoscalar has no inverse; take the complement"
            ),
            MathError::NoSubspace => write!(f, "zero stands for no subspace; give a nonzero blade"),
            MathError::NotBlade { deviation } => write!(
                f,
                "not a blade (a wedge product of vectors): a part of {deviation:.1e} of it remains; give one grade, factored"
            ),
            MathError::Overflow => write!(
                f,
                "the result is beyond the range of floating point (1.8e308); scale the argument down"
            ),
            MathError::DivisionByZero => write!(f, "division by zero; give a divisor that is not 0"),
        }
    }
}

impl std::error::Error for MathError {}
