//! Functions of any multivector, in the algebra of any signature.
//!
//! A [`Calculus`] belongs to one [`Algebra`] and works on rows of all 2ⁿ components in its basis order.
//! Inside, components stand in *bit order*: component `b` belongs to the canonical blade with the
//! generators in the bits of `b`. There the product of blades `i` and `j` is the blade `i ^ j`, and one
//! table of signs is the whole algebra.
//!
//! [`inverse`](Calculus::inverse) solves a linear system; [`exp`](Calculus::exp) and [`log`](Calculus::log) use the
//! squares of bivectors (`pair`); `duals` has the complements, `subspaces` join and meet.

mod duals;
pub mod eigen;
mod exp;
mod inverse;
mod log;
mod pair;
pub(crate) mod sqrt;
mod subspaces;

use crate::error::MathError;
use crate::g3::functions::Function;
use crate::product::Grades;
use crate::table::Algebra;
use log::Tolerances;

pub use subspaces::SAME_DIRECTION;

/// The functions of one algebra.
#[derive(Clone, Debug)]
pub struct Calculus {
    generators: usize,
    /// The generators of square 0, as bits.
    null: usize,
    /// For each basis element its bits, and its sign against the canonical blade.
    order: Vec<(usize, f64)>,
    /// Sign of the product of canonical blades `i` and `j`, at `i · 2ⁿ + j`.
    signs: Vec<i8>,
    /// Tolerances for versors.
    tolerances: Tolerances,
}

impl Calculus {
    /// Computes the table of signs of `algebra`.
    pub fn new(algebra: &Algebra) -> Calculus {
        let generators = algebra.squares().len();
        let size = 1 << generators;
        let signs =
            (0..size * size).map(|x| algebra.blade_product((x / size) as u32, (x % size) as u32).0).collect();
        Calculus {
            generators,
            null: (0..generators).filter(|&i| algebra.squares()[i] == 0).map(|i| 1 << i).sum(),
            order: algebra.blades().iter().map(|b| (b.bits as usize, f64::from(b.sign))).collect(),
            signs,
            tolerances: Tolerances::new(f64::EPSILON),
        }
    }

    /// The same functions, of components that are rounded to a spacing `epsilon` of numbers at 1, as
    /// `f32::EPSILON`: it sets the tolerance for versors in logarithms and square roots.
    pub fn rounded_to(self, epsilon: f64) -> Calculus {
        Calculus { tolerances: Tolerances::new(epsilon), ..self }
    }

    /// Number of components of a multivector.
    pub fn size(&self) -> usize {
        self.order.len()
    }

    /// The value of `f` at `m`.
    ///
    /// # Panics
    /// As all methods here: if a row does not have 2ⁿ components.
    pub fn apply(&self, f: Function, m: &[f64]) -> Result<Vec<f64>, MathError> {
        match f {
            Function::Inverse => self.inverse(m),
            Function::Exp => self.exp(m),
            Function::Log => self.log(m),
            Function::Sqrt => self.sqrt(m),
        }
    }

    /// The grades of the value of `f` for an argument of grades `g`, whatever its components.
    ///
    /// Scalars with one kind of blade that always squares to a number are closed under products: vectors,
    /// their complements (grade n − 1) and the pseudoscalar. So are the even elements.
    pub fn grades(&self, f: Function, g: Grades) -> Grades {
        let n = self.generators;
        let all = Grades(((1u32 << (n + 1)) - 1) as u16);
        let even = Grades(all.0 & 0x5555);
        let odd = Grades(all.0 & 0xAAAA);
        let of = |k: usize| Grades(1 << k);
        let with_scalars = |k: usize| Grades(1 | 1 << k);
        let closed = [
            Grades::SCALAR,
            with_scalars(n.min(1)),
            with_scalars(n.saturating_sub(1)),
            with_scalars(n),
            even,
        ];
        let smallest = |sets: &[Grades]| sets.iter().copied().find(|&s| g.within(s)).unwrap_or(all);
        match f {
            Function::Exp => smallest(&closed),
            Function::Log => Grades(Grades::EVEN.0 & all.0),
            Function::Sqrt => even,
            // M⁻¹ is M̃ or M times something central and even: blades keep their grade, and so do
            // bivectors while B² has only one part besides the scalar.
            Function::Inverse => {
                let bivector = if n <= 5 { of(2) } else { Grades::SCALAR };
                let kept = [Grades::SCALAR, of(1), of(n.saturating_sub(1)), of(n), bivector];
                smallest(&[&kept[..], &closed[..], &[odd]].concat())
            }
        }
    }

    /// From basis order to bit order; an error unless every component is finite.
    fn read(&self, m: &[f64]) -> Result<Vec<f64>, MathError> {
        if m.iter().all(|x| x.is_finite()) { Ok(self.to_bits(m)) } else { Err(MathError::NotFinite) }
    }

    /// From basis order to bit order.
    fn to_bits(&self, m: &[f64]) -> Vec<f64> {
        assert_eq!(m.len(), self.size(), "a multivector of this algebra has {} components", self.size());
        let mut out = vec![0.0; m.len()];
        for (&(bits, sign), x) in self.order.iter().zip(m) {
            out[bits] = sign * x;
        }
        out
    }

    /// From bit order to basis order.
    fn to_basis(&self, m: &[f64]) -> Vec<f64> {
        self.order.iter().map(|&(bits, sign)| sign * m[bits]).collect()
    }

    /// From bit order to basis order; an error if a component is beyond the range.
    fn write(&self, m: &[f64]) -> Result<Vec<f64>, MathError> {
        if m.iter().all(|x| x.is_finite()) { Ok(self.to_basis(m)) } else { Err(MathError::Overflow) }
    }

    fn product(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        let size = self.size();
        let mut out = vec![0.0; size];
        for (i, &x) in a.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            let signs = &self.signs[i * size..(i + 1) * size];
            for (j, (&sign, &y)) in signs.iter().zip(b).enumerate() {
                out[i ^ j] += f64::from(sign) * x * y;
            }
        }
        out
    }

    /// `⟨ab⟩`.
    fn scalar_product(&self, a: &[f64], b: &[f64]) -> f64 {
        (0..self.size()).map(|i| self.sign(i, i) * a[i] * b[i]).sum()
    }

    /// The sign of the product of canonical blades, 0 where it vanishes.
    fn sign(&self, i: usize, j: usize) -> f64 {
        f64::from(self.signs[i * self.size() + j])
    }

    fn scalar(&self, x: f64) -> Vec<f64> {
        let mut out = vec![0.0; self.size()];
        out[0] = x;
        out
    }

    /// Scales the generators of square 0 by a power of two, which is an automorphism, so that the largest component with
    /// such a generator is about 1 and far translations do not hide rotations. Returns the factor.
    fn balance(&self, m: &mut [f64]) -> f64 {
        // Even a component with all r of them must not leave the range.
        let limit = 900.0 / f64::from(self.null.count_ones().max(1));
        let exponent = (0..m.len())
            .filter(|bits| bits & self.null != 0 && m[*bits] != 0.0)
            .map(|bits| (-m[bits].abs().log2() / f64::from((bits & self.null).count_ones())).floor())
            .fold(f64::INFINITY, f64::min);
        if exponent == f64::INFINITY {
            return 1.0;
        }
        let factor = exponent.clamp(-limit, limit).floor().exp2();
        self.scale_null(m, factor);
        factor
    }

    /// Scales the generators of square 0 as [`balance`](Calculus::balance) does, but never up.
    fn balance_down(&self, m: &mut [f64]) -> f64 {
        let factor = self.balance(m);
        if factor > 1.0 {
            self.scale_null(m, 1.0 / factor);
        }
        factor.min(1.0)
    }

    /// Scales the generators of square 0 by `factor`.
    fn scale_null(&self, m: &mut [f64], factor: f64) {
        if factor != 1.0 {
            for (bits, x) in m.iter_mut().enumerate() {
                *x *= factor.powi((bits & self.null).count_ones() as i32);
            }
        }
    }
}

fn grade(bits: usize) -> u32 {
    bits.count_ones()
}

/// Negates the blades whose generators, written backwards, need an odd number of swaps: grades 2, 3, 6, 7.
fn reverse(m: &[f64]) -> Vec<f64> {
    m.iter().enumerate().map(|(bits, &x)| if grade(bits) & 2 == 0 { x } else { -x }).collect()
}

/// Reverse and grade involution together: negates grades 1, 2, 5, 6.
fn clifford_conjugate(m: &[f64]) -> Vec<f64> {
    m.iter().enumerate().map(|(bits, &x)| if (grade(bits) + 1) & 2 == 0 { x } else { -x }).collect()
}

/// The part of the grades that `keep` accepts.
fn part(m: &[f64], keep: impl Fn(u32) -> bool) -> Vec<f64> {
    m.iter().enumerate().map(|(bits, &x)| if keep(grade(bits)) { x } else { 0.0 }).collect()
}

fn scaled(m: &[f64], s: f64) -> Vec<f64> {
    m.iter().map(|x| x * s).collect()
}

fn add_scaled(a: &mut [f64], b: &[f64], s: f64) {
    for (x, y) in a.iter_mut().zip(b) {
        *x += s * y;
    }
}

/// The sum of products of components.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
