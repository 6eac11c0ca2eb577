//! Common products of factors with one, three or four components, whose terms are known at compile time.
//!
//! A product is recognised by its terms, so one kernel serves several products and algebras.

use crate::simd::short::{Short, WithShort};
use crate::simd::{Lane, by_lanes};

/// A term: the components of both factors and of the product, and the sign.
type Known = (usize, usize, usize, i8);

/// An enum of products of constant terms, and a type of each that multiplies rows.
macro_rules! fixed_terms {
    ($($(#[$doc:meta])* $name:ident($a:literal, $b:literal) -> $out:literal [$($term:expr),* $(,)?];)*) => {
        /// The products.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum FixedTerms {
            $($(#[$doc])* $name,)*
        }

        $(
            struct $name;

            impl Short<$a, $b, $out> for $name {
                #[inline(always)]
                fn value(a: [f64; $a], b: [f64; $b]) -> [f64; $out] {
                    let mut sums = [0.0; $out];
                    $({
                        const TERM: Known = $term;
                        let (i, j, k, sign) = TERM;
                        sums[k] += if sign > 0 { a[i] * b[j] } else { -a[i] * b[j] };
                    })*
                    sums
                }
            }
        )*

        impl FixedTerms {
            /// The product of factors of these sizes with these terms, in order.
            pub fn of(
                sizes: (usize, usize, usize),
                terms: impl Iterator<Item = Known> + Clone,
            ) -> Option<FixedTerms> {
                $(
                    if sizes == ($a, $b, $out) && terms.clone().eq([$($term),*]) {
                        return Some(FixedTerms::$name);
                    }
                )*
                None
            }

            /// Does something with the product as a short function.
            pub fn short<U: WithShort>(self, user: U) -> U::Output {
                match self {
                    $(FixedTerms::$name => user.with::<$name, $a, $b, $out>(),)*
                }
            }

            /// Multiplies lanes.
            #[inline(always)]
            pub fn block<const W: usize>(self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
                match self {
                    $(FixedTerms::$name => by_lanes(a, b, out, $name::value),)*
                }
            }
        }
    };
}

fixed_terms! {
    /// Two numbers.
    Scalars(1, 1) -> 1 [(0, 0, 0, 1)];
    /// A number times three components, or `I a` of a vector.
    TimesThree(1, 3) -> 3 [(0, 0, 0, 1), (0, 1, 1, 1), (0, 2, 2, 1)];
    /// Three components times a number, or `a I` of a vector.
    ThreeTimes(3, 1) -> 3 [(0, 0, 0, 1), (1, 0, 1, 1), (2, 0, 2, 1)];
    /// A number times an even value.
    TimesFour(1, 4) -> 4 [(0, 0, 0, 1), (0, 1, 1, 1), (0, 2, 2, 1), (0, 3, 3, 1)];
    /// An even value times a number.
    FourTimes(4, 1) -> 4 [(0, 0, 0, 1), (1, 0, 1, 1), (2, 0, 2, 1), (3, 0, 3, 1)];
    /// `a·b` of vectors.
    Dot(3, 3) -> 1 [(0, 0, 0, 1), (1, 1, 0, 1), (2, 2, 0, 1)];
    /// `A·B` of bivectors.
    MinusDot(3, 3) -> 1 [(0, 0, 0, -1), (1, 1, 0, -1), (2, 2, 0, -1)];
    /// `a∧b` of vectors.
    Cross(3, 3) -> 3 [(1, 2, 0, 1), (2, 1, 0, -1), (0, 2, 1, -1), (2, 0, 1, 1), (0, 1, 2, 1), (1, 0, 2, -1)];
    /// `A×B` of bivectors, `A·b` and `a·B`.
    MinusCross(3, 3) -> 3
        [(1, 2, 0, -1), (2, 1, 0, 1), (0, 2, 1, 1), (2, 0, 1, -1), (0, 1, 2, -1), (1, 0, 2, 1)];
    /// `ab` of vectors.
    Vectors(3, 3) -> 4 [
        (0, 0, 0, 1), (1, 1, 0, 1), (2, 2, 0, 1),
        (1, 2, 1, 1), (2, 1, 1, -1), (0, 2, 2, -1), (2, 0, 2, 1), (0, 1, 3, 1), (1, 0, 3, -1),
    ];
    /// `AB` of bivectors.
    Bivectors(3, 3) -> 4 [
        (0, 0, 0, -1), (1, 1, 0, -1), (2, 2, 0, -1),
        (1, 2, 1, -1), (2, 1, 1, 1), (0, 2, 2, 1), (2, 0, 2, -1), (0, 1, 3, -1), (1, 0, 3, 1),
    ];
    /// `AB` of even values.
    Even(4, 4) -> 4 [
        (0, 0, 0, 1), (1, 1, 0, -1), (2, 2, 0, -1), (3, 3, 0, -1),
        (0, 1, 1, 1), (1, 0, 1, 1), (2, 3, 1, -1), (3, 2, 1, 1),
        (0, 2, 2, 1), (1, 3, 2, 1), (2, 0, 2, 1), (3, 1, 2, -1),
        (0, 3, 3, 1), (1, 2, 3, -1), (2, 1, 3, 1), (3, 0, 3, 1),
    ];
    /// `Ab` of an even value and a vector.
    EvenVector(4, 3) -> 4 [
        (0, 0, 0, 1), (2, 2, 0, -1), (3, 1, 0, 1), (0, 1, 1, 1), (1, 2, 1, 1), (3, 0, 1, -1),
        (0, 2, 2, 1), (1, 1, 2, -1), (2, 0, 2, 1), (1, 0, 3, 1), (2, 1, 3, 1), (3, 2, 3, 1),
    ];
    /// `aB` of a vector and an even value.
    VectorEven(3, 4) -> 4 [
        (0, 0, 0, 1), (1, 3, 0, -1), (2, 2, 0, 1), (0, 3, 1, 1), (1, 0, 1, 1), (2, 1, 1, -1),
        (0, 2, 2, -1), (1, 1, 2, 1), (2, 0, 2, 1), (0, 1, 3, 1), (1, 2, 3, 1), (2, 3, 3, 1),
    ];
}

#[cfg(test)]
mod tests;
