//! `V X V⁻¹` of versors V, products of vectors that have an inverse, over many rows.
//!
//! `s = V ~V` is a number, and `V⁻¹ = ~V/s`. For an odd number of vectors X is replaced by its grade involution, so that
//! a vector a maps X to its mirror image. Involution and reverse only change signs of components, and here those of terms.

use crate::product::{Grades, Plan, Product};
use crate::simd::lanes::Work;
use crate::simd::threads::Threads;
use crate::simd::traverse::{Factor, SHARED, Target, beyond_caches, by_blocks};
use crate::simd::{ByRow, Element, Kernel, LANES, Lane, Path};
use crate::table::Algebra;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

/// Most generators of an algebra where a value V is a versor if `V ~V` is a number.
const MOST_GENERATORS: usize = 5;

/// The action of versors on values.
#[derive(Clone, Debug)]
pub struct Action {
    /// `V X` or `V X̂`.
    moved: Plan,
    /// `V ~V` in the grades that do not vanish, the scalar first.
    square: Plan,
    /// The product of `V X` and V, reversed, in the grades of X.
    back: Plan,
}

/// The product with the signs of the components of some grades of the right factor reversed.
fn signed(plan: Plan, algebra: &Algebra, right: Grades, minus: impl Fn(usize) -> bool) -> Plan {
    let grade_of: Vec<_> = right.indices(algebra).iter().map(|&i| algebra.blades()[i].grade()).collect();
    let mut terms = plan.terms.clone();
    for term in terms.iter_mut().filter(|term| minus(grade_of[term.b])) {
        term.sign = -term.sign;
    }
    Plan { terms, ..plan }.recognised()
}

impl Action {
    /// The action of versors on values that hold these grades; of products of an `odd` number of vectors, or of an even
    /// one. `None` where `V ~V` may be a number without V being a versor.
    pub fn new(algebra: &Algebra, versor: Grades, odd: bool, value: Grades) -> Option<Action> {
        let n = algebra.signature().generators();
        if n > MOST_GENERATORS {
            return None;
        }
        let reverse = |k: usize| k % 4 > 1;
        // V ~V is its own reverse.
        let own = Grades((0..=n).filter(|&k| !reverse(k)).map(|k| 1 << k).sum());
        let product = |a, b| Plan::new(algebra, Product::Geometric, a, b);
        let moved = signed(product(versor, value), algebra, value, |k| odd && k % 2 == 1);
        let square = signed(product(versor, versor).part(algebra, own), algebra, versor, reverse);
        let back = signed(product(moved.grades, versor).part(algebra, value), algebra, versor, reverse);
        Some(Action { moved, square, back })
    }

    /// Acts row by row into `out`, by several threads where there are enough rows for it to pay; a single row is broadcast.
    /// Returns false if some row is not a versor to half of its digits; `out` is then unspecified.
    ///
    /// # Panics
    /// If a slice is not a whole number of rows, or the numbers of rows do not fit together.
    pub fn run<T: Element>(&self, threads: Threads, versors: &[T], values: &[T], out: &mut [T]) -> bool {
        self.run_on(Path::best(), threads, versors, values, out)
    }

    /// The action of one versor on one value, with the bits of [`Action::run`]; false if it is not a versor.
    ///
    /// # Panics
    /// If a slice is not a row.
    pub fn run_row(&self, versor: &[f64], value: &[f64], out: &mut [f64]) -> bool {
        let path = Path::best();
        let mut numbers = vec![0.0; self.scratch()];
        let (moved, rest) = numbers.split_at_mut(self.moved.sizes.2);
        let (inverse, square) = rest.split_at_mut(versor.len());
        self.moved.row(path, versor, value, moved);
        self.square.row(path, versor, versor, square);
        for (inverse, x) in inverse.iter_mut().zip(versor) {
            *inverse = x / square[0];
        }
        self.back.row(path, moved, inverse, out);
        let size = versor.iter().fold(0.0, |sum, x| sum + x * x);
        let rest = square[1..].iter().fold(0.0, |most, x| larger(most, x.abs()));
        Limits::of::<f64>().allow(square[0], rest, size)
    }

    /// Numbers that are needed on the way.
    fn scratch(&self) -> usize {
        self.moved.sizes.2 + self.square.sizes.0 + self.square.sizes.2
    }

    fn run_on<T: Element>(&self, path: Path, threads: Threads, v: &[T], x: &[T], out: &mut [T]) -> bool {
        let (nv, nx, nout) = (self.moved.sizes.0, self.moved.sizes.1, self.back.sizes.2);
        let total = out.len() / nout;
        let streamed = path.streams() && beyond_caches(v, x, out);
        let (v, x) = (Factor::new(v, nv, total), Factor::new(x, nx, total));
        let (limits, failed) = (Limits::of::<T>(), AtomicBool::new(false));
        threads.for_each_piece(SHARED / (nv + nx + nout), nout, out, |rows, out| {
            let (v, x, total) = (v.piece(rows.clone()), x.piece(rows.clone()), rows.len());
            // Lanes beyond the last rows are computed too.
            let mut lanes = vec![Lane::<LANES>::filled(1.0); nv + nx + nout + self.scratch()];
            let mut target = [Target { data: out, size: nout, at: nv + nx }];
            by_blocks((path, streamed), total, &mut lanes, &mut target, |first, count, lanes| {
                let (versors, rest) = lanes.split_at_mut(nv);
                let (values, rest) = rest.split_at_mut(nx);
                let (out, scratch) = rest.split_at_mut(nout);
                v.load(path, first, count, versors);
                x.load(path, first, count, values);
                let block = Block { action: self, limits, versors, values, out, scratch };
                if path.run(block)[..count].iter().all(|&ok| ok) {
                    return ControlFlow::Continue(());
                }
                failed.store(true, Ordering::Relaxed);
                ControlFlow::Break(())
            });
        });
        !failed.into_inner()
    }
}

/// The least `|V ~V|`: products of the components of smaller versors lose digits to underflow.
const LEAST: f64 = f64::MIN_POSITIVE / f64::EPSILON;

/// What the components of `V ~V` may be beside the sum of the squares of V, for a versor to half of the digits.
#[derive(Clone, Copy)]
struct Limits {
    /// The maximum of the components other than the scalar.
    rest: f64,
    /// The minimum of the scalar.
    number: f64,
}

impl Limits {
    /// A scalar within the rounding of the sum is 0.
    const fn of<T: Element>() -> Limits {
        Limits { rest: T::HALF_PRECISION, number: 32.0 * T::EPSILON }
    }

    /// Whether `V ~V` is a number other than 0: the number, and the largest of the other components.
    #[inline(always)]
    fn allow(self, number: f64, rest: f64, size: f64) -> bool {
        let is_a_number = (rest <= self.rest * size) & (number.abs() > self.number * size);
        is_a_number & number.is_finite() & (number.abs() >= LEAST)
    }
}

/// The maximum, NaN if one of them is.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// A block of rows as work, whose result is whether each is a versor.
struct Block<'a, const W: usize> {
    action: &'a Action,
    limits: Limits,
    versors: &'a [Lane<W>],
    values: &'a [Lane<W>],
    out: &'a mut [Lane<W>],
    scratch: &'a mut [Lane<W>],
}

impl<const W: usize> Work for Block<'_, W> {
    type Output = [bool; W];

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> [bool; W] {
        let Block { action, versors, .. } = self;
        let (moved, rest) = self.scratch.split_at_mut(action.moved.sizes.2);
        let (inverse, square) = rest.split_at_mut(versors.len());
        action.moved.block(versors, self.values, moved);
        action.square.block(versors, versors, square);
        let (number, others) = square.split_first().expect("a versor has a scalar square");
        let mut size = [0.0; W];
        for (inverse, versor) in inverse.iter_mut().zip(versors) {
            for l in 0..W {
                inverse.0[l] = versor.0[l] / number.0[l];
                size[l] += versor.0[l] * versor.0[l];
            }
        }
        action.back.block(moved, inverse, self.out);
        let mut most = [0.0; W];
        for other in others {
            for l in 0..W {
                most[l] = larger(most[l], other.0[l].abs());
            }
        }
        let mut allowed = [false; W];
        for l in 0..W {
            allowed[l] = self.limits.allow(number.0[l], most[l], size[l]);
        }
        allowed
    }
}

#[cfg(test)]
mod tests;
