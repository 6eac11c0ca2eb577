//! Functions of two rows over many rows: any product, and `R X ~R`, each for single rows and for lanes.

use crate::g3::rotor::Rotor;
use crate::g3::values::{Vector, geometric};
use crate::product::{Engine, Grades, Plan, Term};
pub use crate::simd::Element;
use crate::simd::lanes::Lanes;
use crate::simd::short::{FirstRows, Short};
use crate::simd::threads::Threads;
use crate::simd::traverse::{beyond_caches, sweep};
use crate::simd::{ByRow, Kernel, LANES, Lane, Path, by_lanes};

impl ByRow for Plan {
    fn row(&self, _: Path, a: &[f64], b: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        // Sums in registers: through memory, each term would wait for the one before.
        for terms in self.terms.chunk_by(|s, t| s.out == t.out) {
            let products = terms.iter().map(|term| f64::from(term.sign) * a[term.a] * b[term.b]);
            out[terms[0].out] = products.fold(0.0, |sum, x| sum + x);
        }
    }

    fn in_registers<T: Element>(&self, path: Path, a: &[T], b: &[T], out: &mut [T], streamed: bool) -> usize {
        self.fixed_terms.map_or(0, |fixed| fixed.short(FirstRows { path, a, b, out, streamed }))
    }
}

impl<const W: usize> Kernel<W> for Plan {
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
        if let Some(fixed) = self.fixed_terms {
            return fixed.block(a, b, out);
        }
        out.fill(Lane::filled(0.0));
        // The terms come in order of `out`; up to eight of a lane are added at a time, in registers.
        for terms in self.terms.chunk_by(|s, t| s.out == t.out).flat_map(|terms| terms.chunks(8)) {
            let lane = &mut out[terms[0].out];
            match terms.len() {
                1 => add::<1, W>(terms, a, b, lane),
                2 => add::<2, W>(terms, a, b, lane),
                3 => add::<3, W>(terms, a, b, lane),
                4 => add::<4, W>(terms, a, b, lane),
                5 => add::<5, W>(terms, a, b, lane),
                6 => add::<6, W>(terms, a, b, lane),
                7 => add::<7, W>(terms, a, b, lane),
                _ => add::<8, W>(terms, a, b, lane),
            }
        }
    }
}

/// Adds `N` terms to a lane of the product.
#[inline(always)]
fn add<const N: usize, const W: usize>(terms: &[Term], a: &[Lane<W>], b: &[Lane<W>], out: &mut Lane<W>) {
    let signs: [f64; N] = std::array::from_fn(|t| f64::from(terms[t].sign));
    let xs: [&Lane<W>; N] = std::array::from_fn(|t| &a[terms[t].a]);
    let ys: [&Lane<W>; N] = std::array::from_fn(|t| &b[terms[t].b]);
    // A copy that does not alias the factors.
    let mut sums = out.0;
    for l in 0..W {
        for t in 0..N {
            sums[l] += signs[t] * xs[t].0[l] * ys[t].0[l];
        }
    }
    out.0 = sums;
}

/// The geometric product of all grades in 3-d space, written out.
pub(crate) struct Geometric<'a>(pub &'a Plan);

impl ByRow for Geometric<'_> {
    const FEW: usize = 5;

    fn row(&self, path: Path, a: &[f64], b: &[f64], out: &mut [f64]) {
        self.0.row(path, a, b, out);
    }
}

impl<const W: usize> Kernel<W> for Geometric<'_> {
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
        let (a, b, out) = (&a[..8], &b[..8], &mut out[..8]);
        for i in 0..W / 8 {
            let (mut x, mut y) = ([Lanes::<8, false>::ZERO; 8], [Lanes::ZERO; 8]);
            for k in 0..8 {
                (x[k].0, y[k].0) = (a[k].0.as_chunks().0[i], b[k].0.as_chunks().0[i]);
            }
            let product = geometric(x, y);
            for k in 0..8 {
                // A sum that begins with 0, as in the plan, is never −0.
                out[k].0.as_chunks_mut().0[i] = (product[k] + Lanes::ZERO).0;
            }
        }
    }
}

/// `R X ~R` for X of some grades: vector and bivector turn as three numbers each, scalar and trivector stay.
pub(crate) struct Turn(pub Grades);

impl Turn {
    /// Where each part begins, and how many numbers it has.
    fn parts(&self) -> impl Iterator<Item = (usize, usize)> {
        let present = (0..4).filter(|&k| self.0.contains(k));
        present.map(|k| if k % 3 == 0 { 1 } else { 3 }).scan(0, |next, width| {
            *next += width;
            Some((*next - width, width))
        })
    }

    /// Whether the values are of three numbers, which turn in registers.
    pub fn is_short(&self) -> bool {
        self.0 == Grades::VECTOR || self.0 == Grades::BIVECTOR
    }

    /// Turns each part in lanes. The function is an item, not a closure, which would not be compiled for the lanes.
    #[inline(always)]
    fn by_parts<const W: usize>(
        &self,
        rotors: &[Lane<W>],
        values: &[Lane<W>],
        out: &mut [Lane<W>],
        turned: impl Fn([f64; 4], [f64; 3]) -> [f64; 3] + Copy,
    ) {
        for (at, width) in self.parts() {
            if width == 1 {
                out[at] = values[at];
            } else {
                by_lanes(rotors, &values[at..], &mut out[at..], turned);
            }
        }
    }
}

#[inline(always)]
fn turned(rotor: [f64; 4], vector: [f64; 3]) -> [f64; 3] {
    Rotor::from_unit_components(rotor).apply(Vector(vector)).0
}

impl ByRow for Turn {
    const FAST_ROWS: bool = true;

    fn row(&self, _: Path, rotor: &[f64], value: &[f64], out: &mut [f64]) {
        let rotor = std::array::from_fn(|k| rotor[k]);
        for (at, width) in self.parts() {
            if width == 1 {
                out[at] = value[at];
            } else {
                out[at..at + 3].copy_from_slice(&turned(rotor, [value[at], value[at + 1], value[at + 2]]));
            }
        }
    }

    fn in_registers<T: Element>(&self, path: Path, r: &[T], v: &[T], out: &mut [T], streamed: bool) -> usize {
        if self.is_short() { path.short::<Turn, T, 4, 3, 3>(r, v, out, streamed) } else { 0 }
    }
}

impl Short<4, 3, 3> for Turn {
    #[inline(always)]
    fn value(rotor: [f64; 4], vector: [f64; 3]) -> [f64; 3] {
        turned(rotor, vector)
    }
}

impl<const W: usize> Kernel<W> for Turn {
    #[inline(always)]
    fn block(&self, rotors: &[Lane<W>], values: &[Lane<W>], out: &mut [Lane<W>]) {
        self.by_parts(rotors, values, out, turned);
    }
}

/// `~R X R`.
pub(crate) struct TurnBack(pub Turn);

#[inline(always)]
fn turned_back([s, x, y, z]: [f64; 4], vector: [f64; 3]) -> [f64; 3] {
    turned([s, -x, -y, -z], vector)
}

impl Short<4, 3, 3> for TurnBack {
    #[inline(always)]
    fn value(rotor: [f64; 4], vector: [f64; 3]) -> [f64; 3] {
        turned_back(rotor, vector)
    }
}

impl<const W: usize> Kernel<W> for TurnBack {
    #[inline(always)]
    fn block(&self, rotors: &[Lane<W>], values: &[Lane<W>], out: &mut [Lane<W>]) {
        self.0.by_parts(rotors, values, out, turned_back);
    }
}

impl Plan {
    /// Multiplies row by row into `out`, by several threads where there are enough rows for it to pay; a single row is
    /// broadcast.
    ///
    /// # Panics
    /// If a slice is not a whole number of rows, or the numbers of rows do not fit together.
    pub fn run<T: Element>(&self, threads: Threads, a: &[T], b: &[T], out: &mut [T]) {
        self.run_on(Path::best(), threads, a, b, out);
    }

    /// Multiplies one row, with the bits of [`Plan::run`], which takes some 100 ns more.
    ///
    /// # Panics
    /// If a slice is not a row.
    pub fn run_row(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        assert_eq!((a.len(), b.len(), out.len()), self.sizes, "rows of other sizes");
        match &self.engine {
            Engine::Terms | Engine::Geometric => self.row(Path::best(), a, b, out),
            Engine::Tiles(tiles) => tiles.row(Path::best(), a, b, out),
        }
    }

    fn run_on<T: Element>(&self, path: Path, threads: Threads, a: &[T], b: &[T], out: &mut [T]) {
        let (na, nb, nout) = self.sizes;
        let large = beyond_caches(a, b, out);
        let (a, b, out) = ((a, na), (b, nb), (out, nout));
        match &self.engine {
            Engine::Terms => sweep::<_, LANES, _>(path, threads, self, a, b, out),
            // Small blocks mix reading and writing memory with the arithmetic more finely.
            Engine::Geometric if out.0.len() <= 8 * nout => {
                sweep::<_, 8, _>(path, threads, &Geometric(self), a, b, out)
            }
            Engine::Geometric if large => sweep::<_, 32, _>(path, threads, &Geometric(self), a, b, out),
            Engine::Geometric => sweep::<_, 64, _>(path, threads, &Geometric(self), a, b, out),
            // Blocks of more rows leave the first-level cache; of few rows, one of eight is enough.
            Engine::Tiles(tiles) if out.0.len() > 8 * nout => {
                sweep::<_, 16, _>(path, threads, tiles, a, b, out)
            }
            Engine::Tiles(tiles) => sweep::<_, 8, _>(path, threads, tiles, a, b, out),
        }
    }
}

/// `R X ~R` for rows of rotor components and rows of values of these grades, by several threads where there are enough
/// rows for it to pay; a single row is broadcast.
///
/// # Panics
/// If there are no grades, or the numbers of rows do not fit together.
pub fn turn<T: Element>(threads: Threads, rotors: &[T], values: &[T], grades: Grades, out: &mut [T]) {
    turn_on(Path::best(), threads, rotors, values, grades, out);
}

fn turn_on<T: Element>(
    path: Path,
    threads: Threads,
    rotors: &[T],
    values: &[T],
    grades: Grades,
    out: &mut [T],
) {
    let turn = Turn(grades);
    let size = turn.parts().map(|(_, width)| width).sum();
    sweep::<_, LANES, _>(path, threads, &turn, (rotors, 4), (values, size), (out, size));
}

#[cfg(test)]
mod tests;
