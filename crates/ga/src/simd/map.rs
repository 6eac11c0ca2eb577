//! A function of a row as a kernel over rows.
//!
//! Branch-free arithmetic computes many rows at once. NaN marks rows that need the long method, which computes them one
//! by one. The bits are the same on every machine and path, for one row or many.

use super::threads::Threads;
use super::traverse::{FEW_ROWS, sweep};
use super::{ByRow, Element, Kernel, LANES, Lane, Path};
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether every machine of this build has fused multiply-add.
pub(crate) const BUILT_WITH_FMA: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

/// A function of a row of `A` numbers and one of `B`.
pub(crate) trait Map<const A: usize, const B: usize, const OUT: usize>: Sync {
    /// Its values for `W` rows, given by components; the first number is NaN if the row needs the long method. No
    /// branches.
    fn short<const W: usize, const FMA: bool>(&self, a: [&[f64; W]; A], b: [&[f64; W]; B])
    -> [[f64; W]; OUT];

    /// Its value for any finite row; the first number is NaN if there is none.
    fn long(&self, a: [f64; A], b: [f64; B]) -> [f64; OUT];

    /// Its value; NaN if the row is not finite.
    fn value(&self, a: [f64; A], b: [f64; B]) -> [f64; OUT]
    where
        Self: Sized,
    {
        let value = Path::best().alone(self, a, b);
        if !value[0].is_nan() {
            value
        } else if a.iter().chain(&b).all(|x| x.is_finite()) {
            self.long(a, b)
        } else {
            [f64::NAN; OUT]
        }
    }
}

/// A row as lanes of one.
pub(crate) fn lanes_of_one<const N: usize>(row: &[f64; N]) -> [&[f64; 1]; N] {
    row.each_ref().map(std::array::from_ref)
}

/// The row of lanes of one.
pub(crate) fn alone<const N: usize>(lanes: [[f64; 1]; N]) -> [f64; N] {
    lanes.map(|[x]| x)
}

/// A map as a kernel, which remembers whether it met a row without a value.
struct Mapped<M, const A: usize, const B: usize, const OUT: usize> {
    map: M,
    failed: AtomicBool,
}

impl<M: Map<A, B, OUT>, const A: usize, const B: usize, const OUT: usize> Mapped<M, A, B, OUT> {
    fn value(&self, a: [f64; A], b: [f64; B]) -> [f64; OUT] {
        let value = self.map.value(a, b);
        if value[0].is_nan() {
            self.failed.store(true, Ordering::Relaxed);
        }
        value
    }

    /// Rows `N` at a time, so that intermediate results stay in registers.
    #[inline(always)]
    fn lanes<const FMA: bool, const N: usize, const W: usize>(
        &self,
        a: &[Lane<W>],
        b: &[Lane<W>],
        out: &mut [Lane<W>],
    ) {
        debug_assert!(W.is_multiple_of(N), "{W} rows by {N}");
        let (a, b, out) = (&a[..A], &b[..B], &mut out[..OUT]);
        let mut largest = 0;
        for i in 0..W / N {
            let part = |lane: &Lane<W>| lane.0.as_chunks::<N>().0[i];
            let x: [[f64; N]; A] = std::array::from_fn(|k| part(&a[k]));
            let y: [[f64; N]; B] = std::array::from_fn(|k| part(&b[k]));
            let values = self.map.short::<N, FMA>(x.each_ref(), y.each_ref());
            for k in 0..OUT {
                out[k].0.as_chunks_mut::<N>().0[i] = values[k];
            }
            // As an integer, NaN is larger than any number.
            for x in values[0] {
                largest = largest.max(x.abs().to_bits());
            }
        }
        if f64::from_bits(largest).is_nan() {
            self.complete(a, b, out);
        }
    }

    /// Computes the rows that are missing.
    #[cold]
    fn complete<const W: usize>(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
        for l in 0..W {
            if !out[0].0[l].is_nan() {
                continue;
            }
            let value = self.value(std::array::from_fn(|k| a[k].0[l]), std::array::from_fn(|k| b[k].0[l]));
            for k in 0..OUT {
                out[k].0[l] = value[k];
            }
        }
    }
}

impl<M: Map<A, B, OUT>, const A: usize, const B: usize, const OUT: usize> ByRow for Mapped<M, A, B, OUT> {
    fn row(&self, _: Path, a: &[f64], b: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&self.value(std::array::from_fn(|k| a[k]), std::array::from_fn(|k| b[k])));
    }
}

impl<M, const A: usize, const B: usize, const OUT: usize, const W: usize> Kernel<W> for Mapped<M, A, B, OUT>
where
    M: Map<A, B, OUT>,
{
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
        if W < 32 {
            self.lanes::<BUILT_WITH_FMA, W, W>(a, b, out)
        } else {
            self.lanes::<BUILT_WITH_FMA, 32, W>(a, b, out)
        }
    }

    #[inline(always)]
    fn fused_block(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
        if W < 32 { self.lanes::<true, W, W>(a, b, out) } else { self.lanes::<true, 32, W>(a, b, out) }
    }
}

/// A block of rows: whether each has a value.
pub(crate) fn block<M: Map<A, B, OUT>, const A: usize, const B: usize, const OUT: usize, const W: usize>(
    map: M,
    path: Path,
    a: &[Lane<W>],
    b: &[Lane<W>],
    out: &mut [Lane<W>],
) -> bool {
    let kernel = Mapped::<M, A, B, OUT> { map, failed: AtomicBool::new(false) };
    path.apply(&kernel, a, b, out);
    !kernel.failed.into_inner()
}

/// Sweeps a map over rows. Fails with the first row that has no value.
pub(crate) fn run<T: Element, M: Map<A, B, OUT>, const A: usize, const B: usize, const OUT: usize>(
    map: M,
    (path, threads): (Path, Threads),
    a: &[T],
    b: &[T],
    out: &mut [T],
) -> Result<(), usize> {
    let kernel = Mapped::<M, A, B, OUT> { map, failed: AtomicBool::new(false) };
    let (x, y) = ((a, A), (b, B));
    // Lanes without rows are computed too.
    if out.len() <= FEW_ROWS * OUT {
        sweep::<_, FEW_ROWS, _>(path, threads, &kernel, x, y, (&mut *out, OUT));
    } else {
        sweep::<_, LANES, _>(path, threads, &kernel, x, y, (&mut *out, OUT));
    }
    if !kernel.failed.into_inner() {
        return Ok(());
    }
    let is_missing = |row: &[T]| Into::<f64>::into(row[0]).is_nan();
    out.chunks_exact(OUT).position(is_missing).map_or(Ok(()), Err)
}
