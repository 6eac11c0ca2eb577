//! Common products of factors with three or four components, whose terms are known at compile time.
//!
//! A product is recognised by its terms, so one kernel serves several products and algebras.

use crate::simd::short::{Numbers, Short};
use crate::simd::{Element, Lane, Path, by_lanes};

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

            /// Multiplies the first rows in registers; returns their number.
            pub fn in_registers<T: Element>(
                self,
                path: Path,
                a: &[T],
                b: &[T],
                out: &mut [T],
                streamed: bool,
            ) -> usize {
                match self {
                    $(FixedTerms::$name => path.short::<$name, T, $a, $b, $out>(a, b, out, streamed),)*
                }
            }

            /// Multiplies a block of whole rows in registers, as [`Path::short_block`].
            pub fn block_in_registers<T: Element, const W: usize>(
                self,
                path: Path,
                a: Numbers<T, W>,
                b: Numbers<T, W>,
                out: &mut [Lane<W>],
            ) {
                match self {
                    $(FixedTerms::$name => path.short_block::<$name, T, $a, $b, $out, W>(a, b, out),)*
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
