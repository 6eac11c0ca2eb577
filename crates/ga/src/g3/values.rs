//! The typed values of 3-d space, for code that knows its grades.
//!
//! | type | components | |
//! |---|---|---|
//! | [`Vector`] | e1, e2, e3 | directions, positions |
//! | [`Bivector`] | e2e3, e3e1, e1e2 | planes with a size; the numbers of the dual axial vector |
//! | [`Trivector`] | I | volumes |
//! | [`Multivector`] | 1, e1, e2, e3, e2e3, e3e1, e1e2, I | anything |
//!
//! (A [`crate::Rotor`] has its own module.) The products written out here are equal to the table's.

use crate::product::{Grades, Plan, Product};
use crate::simd::threads::Threads;
use crate::table::G3;
use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A vector `x e1 + y e2 + z e3`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vector(pub [f64; 3]);

/// A bivector `x e2e3 + y e3e1 + z e1e2`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bivector(pub [f64; 3]);

/// A trivector `x I`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trivector(pub f64);

/// A general element, components `1, e1, e2, e3, e2e3, e3e1, e1e2, I`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Multivector(pub [f64; 8]);

/// An operator of `std::ops` as a function of its one or two operands.
macro_rules! operator {
    ($trait:ident::$method:ident($a:ident: $left:ty $(, $b:ident: $right:ty)?) -> $output:ty $value:block) => {
        impl $trait$(<$right>)? for $left {
            type Output = $output;
            #[inline]
            fn $method(self $(, $b: $right)?) -> $output {
                let $a = self;
                $value
            }
        }
    };
}
pub(super) use operator;

/// The grade of each component of a multivector.
pub(crate) const GRADE: [usize; 8] = [0, 1, 1, 1, 2, 2, 2, 3];

/// Componentwise sum, difference, negative, and product with a number.
macro_rules! linear_space {
    ($type:ident) => {
        operator!(Add::add(a: $type, b: $type) -> $type { $type(from_fn(|i| a.0[i] + b.0[i])) });
        operator!(Sub::sub(a: $type, b: $type) -> $type { $type(from_fn(|i| a.0[i] - b.0[i])) });
        operator!(Neg::neg(a: $type) -> $type { $type(a.0.map(|x| -x)) });
        operator!(Mul::mul(a: $type, s: f64) -> $type { $type(a.0.map(|x| x * s)) });
        operator!(Mul::mul(s: f64, a: $type) -> $type { a * s });
        operator!(Div::div(a: $type, s: f64) -> $type { $type(a.0.map(|x| x / s)) });
        impl AddAssign for $type {
            fn add_assign(&mut self, other: $type) {
                *self = *self + other;
            }
        }
        impl $type {
            /// Sum of the squares of the components, `⟨A ~A⟩`.
            pub fn norm_squared(self) -> f64 {
                self.0.iter().map(|x| x * x).sum()
            }
            /// `√⟨A ~A⟩`, without intermediate overflow or underflow.
            pub fn norm(self) -> f64 {
                norm(&self.0)
            }
        }
    };
}

linear_space!(Vector);
linear_space!(Bivector);
linear_space!(Multivector);

/// The power of two next below the largest magnitude: dividing by it is exact, and makes squares safe.
/// 1 for zero; the largest magnitude itself for NaN and infinity.
pub(crate) fn scale_of(components: &[f64]) -> f64 {
    let largest = components.iter().fold(0.0, |m: f64, x| if x.is_nan() { *x } else { m.max(x.abs()) });
    if largest == 0.0 {
        1.0
    } else if largest < f64::MIN_POSITIVE {
        f64::MIN_POSITIVE
    } else if largest.is_finite() {
        f64::from_bits(largest.to_bits() & (0x7ff << 52))
    } else {
        largest
    }
}

/// Euclidean norm of the components over the whole range of floating point.
pub(crate) fn norm(components: &[f64]) -> f64 {
    let plain: f64 = components.iter().map(|x| x * x).sum();
    if (1e-290..1e290).contains(&plain) {
        return plain.sqrt();
    }
    if components.iter().any(|x| x.is_infinite()) {
        return f64::INFINITY;
    }
    let scale = scale_of(components);
    scale * components.iter().map(|x| (x / scale) * (x / scale)).sum::<f64>().sqrt()
}

#[inline]
fn dot3(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The components of `a x b`; also of `a∧b`, and of `−A×B` for bivectors.
#[inline]
fn cross3(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

impl Vector {
    /// `a·b`.
    #[inline]
    pub fn dot(self, b: Vector) -> f64 {
        dot3(self.0, b.0)
    }

    /// `a∧b`, the oriented plane swept by `a` along `b`.
    pub fn wedge(self, b: Vector) -> Bivector {
        Bivector(cross3(self.0, b.0))
    }

    /// The vector cross product, `a x b = −I a∧b` (handout eq. 1.24).
    #[inline]
    pub fn cross(self, b: Vector) -> Vector {
        self.wedge(b).dual()
    }

    /// `a·B`, a vector: the part of `a` in the plane, turned by 90° in the sense of `B`, times `|B|`
    /// (handout eq. 1.8). With `B = I b` it is `−a x b`.
    pub fn dot_bivector(self, b: Bivector) -> Vector {
        b.dual().cross(self)
    }

    /// `a∧B`.
    pub fn wedge_bivector(self, b: Bivector) -> Trivector {
        Trivector(dot3(self.0, b.0))
    }

    /// `I a`, the plane perpendicular to `a` (handout eq. 1.20).
    #[inline]
    pub fn undual(self) -> Bivector {
        Bivector(self.0)
    }
}

impl Bivector {
    /// `A·B = ⟨AB⟩`: minus the dot product of the components, since planes square to −1.
    #[inline]
    pub fn dot(self, b: Bivector) -> f64 {
        -dot3(self.0, b.0)
    }

    /// `A×B = ½(AB − BA)` (handout eq. 1.17 and 4.21): not the cross product, but minus its components.
    #[inline]
    pub fn commutator(self, b: Bivector) -> Bivector {
        Bivector(cross3(b.0, self.0))
    }

    /// `B I⁻¹`, the axial vector: the dual of `a∧b` is `a x b`.
    #[inline]
    pub fn dual(self) -> Vector {
        Vector(self.0)
    }
}

impl Multivector {
    /// The number `x`.
    pub fn scalar(x: f64) -> Multivector {
        let mut m = Multivector::default();
        m.0[0] = x;
        m
    }

    /// The part of grade 2.
    pub fn bivector_part(self) -> Bivector {
        Bivector([self.0[4], self.0[5], self.0[6]])
    }

    /// The part of grade 1.
    pub fn vector_part(self) -> Vector {
        Vector([self.0[1], self.0[2], self.0[3]])
    }

    /// The part of grade `k`.
    pub fn grade(self, k: usize) -> Multivector {
        self.signed(|r| f64::from(u8::from(r == k)))
    }

    /// `~M`: grades 2 and 3 change sign (handout eq. 1.28).
    pub fn reverse(self) -> Multivector {
        self.signed(|r| if r >= 2 { -1.0 } else { 1.0 })
    }

    /// Odd grades change sign.
    pub fn grade_involution(self) -> Multivector {
        self.signed(|r| if r % 2 == 1 { -1.0 } else { 1.0 })
    }

    /// Reverse and grade involution: grades 1 and 2 change sign.
    pub fn clifford_conjugate(self) -> Multivector {
        self.signed(|r| if r == 1 || r == 2 { -1.0 } else { 1.0 })
    }

    /// `M I⁻¹`.
    #[inline]
    pub fn dual(self) -> Multivector {
        let m = self.0;
        Multivector([m[7], m[4], m[5], m[6], -m[1], -m[2], -m[3], -m[0]])
    }

    /// `M I`.
    #[inline]
    pub fn undual(self) -> Multivector {
        -self.dual()
    }

    /// Any named product, by the table.
    pub fn product(self, product: Product, other: Multivector) -> Multivector {
        let plan = Plan::g3(product, Grades::ALL, Grades::ALL);
        let mut out = vec![0.0; plan.sizes.2];
        plan.run(Threads::ONE, &self.0, &other.0, &mut out);
        let mut result = Multivector::default();
        for (&k, x) in plan.grades.indices(&G3).iter().zip(out) {
            result.0[k] = x;
        }
        result
    }

    fn signed(self, factor: impl Fn(usize) -> f64) -> Multivector {
        // A dropped part is 0 even if it is NaN.
        let part = |i: usize| match factor(GRADE[i]) {
            0.0 => 0.0,
            f => f * self.0[i],
        };
        Multivector(from_fn(part))
    }
}

impl From<Vector> for Multivector {
    fn from(Vector([x, y, z]): Vector) -> Multivector {
        Multivector([0.0, x, y, z, 0.0, 0.0, 0.0, 0.0])
    }
}

impl From<Bivector> for Multivector {
    fn from(Bivector([x, y, z]): Bivector) -> Multivector {
        Multivector([0.0, 0.0, 0.0, 0.0, x, y, z, 0.0])
    }
}

impl From<Trivector> for Multivector {
    fn from(Trivector(x): Trivector) -> Multivector {
        Multivector([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, x])
    }
}

operator!(Mul::mul(a: Multivector, b: Multivector) -> Multivector { Multivector(geometric(a.0, b.0)) });

/// The geometric product written out, terms in order of the left factor's blades; of numbers, or of several at once.
#[inline(always)]
pub(crate) fn geometric<X>(m: [X; 8], n: [X; 8]) -> [X; 8]
where
    X: Copy + Add<Output = X> + Sub<Output = X> + Mul<Output = X>,
{
    let [m0, m1, m2, m3, m4, m5, m6, m7] = m;
    let [n0, n1, n2, n3, n4, n5, n6, n7] = n;
    [
        m0 * n0 + m1 * n1 + m2 * n2 + m3 * n3 - m4 * n4 - m5 * n5 - m6 * n6 - m7 * n7,
        m0 * n1 + m1 * n0 - m2 * n6 + m3 * n5 - m4 * n7 - m5 * n3 + m6 * n2 - m7 * n4,
        m0 * n2 + m1 * n6 + m2 * n0 - m3 * n4 + m4 * n3 - m5 * n7 - m6 * n1 - m7 * n5,
        m0 * n3 - m1 * n5 + m2 * n4 + m3 * n0 - m4 * n2 + m5 * n1 - m6 * n7 - m7 * n6,
        m0 * n4 + m1 * n7 + m2 * n3 - m3 * n2 + m4 * n0 - m5 * n6 + m6 * n5 + m7 * n1,
        m0 * n5 - m1 * n3 + m2 * n7 + m3 * n1 + m4 * n6 + m5 * n0 - m6 * n4 + m7 * n2,
        m0 * n6 + m1 * n2 - m2 * n1 + m3 * n7 - m4 * n5 + m5 * n4 + m6 * n0 + m7 * n3,
        m0 * n7 + m1 * n4 + m2 * n5 + m3 * n6 + m4 * n1 + m5 * n2 + m6 * n3 + m7 * n0,
    ]
}

#[cfg(test)]
mod tests;
