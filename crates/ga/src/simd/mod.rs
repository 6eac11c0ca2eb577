//! Lanes: rows of numbers transposed so that each component is contiguous, and kernels over them.
//!
//! The arithmetic of a `Kernel` is plain loops over lanes, compiled once for each `Path`. Products and sums are fused only
//! if a kernel asks for it (see `Kernel::fused_block`), so all paths give the same bits on any machine, except for
//! products of large algebras, where the portable path rounds once more at each term. Only the transposition of rows into
//! lanes and back is written by hand, because compilers do it badly.
//!
//! This module holds all the unsafe code of the crate.
#![allow(unsafe_code)]

pub mod double;
mod in_registers;
pub mod lanes;
pub mod lookahead;
pub(crate) mod map;
#[cfg(target_arch = "aarch64")]
mod neon;
pub(crate) mod payne_hanek;
pub(crate) mod short;
pub mod threads;
mod transpose;
pub(crate) mod traverse;
mod workers;
#[cfg(target_arch = "x86_64")]
mod x86;

use lanes::{Done, Work};
use map::{BUILT_WITH_FMA, Map};
use std::ops::Range;
use std::sync::OnceLock;

#[cfg(target_arch = "aarch64")]
use neon::Registers;
#[cfg(target_arch = "x86_64")]
use x86::Registers;

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
transpose::registers!();

/// Rows in a block: three operands of eight lanes stay in the first-level cache.
pub(crate) const LANES: usize = 64;

/// One component of a block of `W` rows, a multiple of eight.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Lane<const W: usize = LANES>(pub [f64; W]);

impl<const W: usize> Lane<W> {
    /// Whether lanes are whole registers; false does not compile.
    const WHOLE: () = assert!(W.is_multiple_of(8), "lanes are whole registers");

    /// The same number in every row.
    pub const fn filled(x: f64) -> Lane<W> {
        let () = Self::WHOLE;
        Lane([x; W])
    }

    /// The lanes as a flat slice of numbers.
    pub fn flat<T: Element>(lanes: &mut [Lane<W>]) -> &mut [T] {
        let () = Self::WHOLE;
        let count = lanes.len() * W;
        // SAFETY: whole registers fill a lane without padding, so the lanes are `count` initialized `f64`. A `T` is `f64`
        // or `f32` (others lack the private `Registers`): not larger, not more aligned, and any bits are valid.
        unsafe { std::slice::from_raw_parts_mut(lanes.as_mut_ptr().cast(), count) }
    }
}

/// Elements of rows: `f64`, or `f32`, which is widened when read and rounded when written.
/// The arithmetic between is that of `f64`.
pub trait Element: Copy + Send + Sync + Into<f64> + Registers {
    /// The spacing of its numbers at 1.
    const EPSILON: f64;

    /// `√EPSILON`, the spacing of half of the digits.
    const HALF_PRECISION: f64;

    /// The nearest of its numbers.
    fn nearest(x: f64) -> Self;
}

impl Element for f64 {
    const EPSILON: f64 = f64::EPSILON;
    const HALF_PRECISION: f64 = 1.0 / (1u64 << 26) as f64;

    fn nearest(x: f64) -> f64 {
        x
    }
}

impl Element for f32 {
    const EPSILON: f64 = f32::EPSILON as f64;
    const HALF_PRECISION: f64 = 3.452_669_830_012_439e-4;

    fn nearest(x: f64) -> f32 {
        x as f32
    }
}

/// A function of two rows, one by one: the numbers that it gives as a [`Kernel`].
pub(crate) trait ByRow: Sync {
    /// Whether single rows are so fast that lanes pay only with hand-written transposes.
    const FAST_ROWS: bool = false;

    /// Below this number of rows, transposing them into lanes does not pay.
    const FEW: usize = 8;

    /// Computes the first rows of `out` in registers, for a kernel that is [`Short`]; returns their number.
    fn in_registers<T: Element>(&self, _: Path, _: &[T], _: &[T], _out: &mut [T], _streamed: bool) -> usize {
        0
    }

    /// One row, with the bits of a block on this path. `out` may hold anything before.
    fn row(&self, path: Path, a: &[f64], b: &[f64], out: &mut [f64]);
}

/// A function of two rows over lanes.
pub(crate) trait Kernel<const W: usize = LANES>: Sync {
    /// A block of rows. Implementations are `#[inline(always)]` down to the arithmetic, so that each path
    /// compiles them for its own instructions.
    fn block(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]);

    /// The same if `mul_add` is one instruction; otherwise it is a slow call. For sums of many terms, and for rounding
    /// errors of products.
    #[inline(always)]
    fn fused_block(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
        self.block(a, b, out);
    }
}

/// Applies a function of rows of constant lengths to each row of lanes.
#[inline(always)]
pub(crate) fn by_lanes<const A: usize, const B: usize, const OUT: usize, const W: usize>(
    a: &[Lane<W>],
    b: &[Lane<W>],
    out: &mut [Lane<W>],
    function: impl Fn([f64; A], [f64; B]) -> [f64; OUT],
) {
    let (a, b, out) = (&a[..A], &b[..B], &mut out[..OUT]);
    for l in 0..W {
        let value = function(std::array::from_fn(|k| a[k].0[l]), std::array::from_fn(|k| b[k].0[l]));
        for k in 0..OUT {
            out[k].0[l] = value[k];
        }
    }
}

/// Computes a lane from others, eight rows at a time. These are read before any is written: among work of several kernels
/// the compiler does not know that lanes do not overlap.
#[inline(always)]
pub(crate) fn by_eights<const N: usize, const W: usize>(
    from: [&Lane<W>; N],
    out: &mut Lane<W>,
    function: impl Fn([f64; N]) -> f64,
) {
    for i in 0..W / 8 {
        let x: [[f64; 8]; N] = std::array::from_fn(|k| from[k].0.as_chunks().0[i]);
        let mut values = [0.0; 8];
        for l in 0..8 {
            values[l] = function(std::array::from_fn(|k| x[k][l]));
        }
        out.0.as_chunks_mut().0[i] = values;
    }
}

/// A block of rows as work.
struct Block<'a, K, const W: usize> {
    kernel: &'a K,
    factors: [&'a [Lane<W>]; 2],
    out: &'a mut [Lane<W>],
}

impl<K: Kernel<W>, const W: usize> Work for Block<'_, K, W> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [a, b] = self.factors;
        if FUSED { self.kernel.fused_block(a, b, self.out) } else { self.kernel.block(a, b, self.out) }
    }
}

/// An instruction set that this machine has; it can only be obtained by detection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Path(Level);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
    #[cfg(target_arch = "aarch64")]
    Neon,
}

/// Calls a function of the module of a path, or does without. The caller ensures what the function demands of its
/// arguments.
macro_rules! by_path {
    ($path:expr, $function:ident($($argument:expr),*), $portable:expr) => {
        match $path.0 {
            Level::Portable => $portable,
            // SAFETY: a `Path` has instructions that were detected; the caller ensures the rest.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { x86::avx2::$function($($argument),*) },
            // SAFETY: a `Path` has instructions that were detected; the caller ensures the rest.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { x86::avx512::$function($($argument),*) },
            // SAFETY: a `Path` has instructions that were detected; the caller ensures the rest.
            #[cfg(target_arch = "aarch64")]
            Level::Neon => unsafe { neon::$function($($argument),*) },
        }
    };
}

impl Path {
    /// The paths this machine can take, the widest last.
    pub fn available() -> impl DoubleEndedIterator<Item = Path> {
        [
            Some(Level::Portable),
            #[cfg(target_arch = "x86_64")]
            (std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma"))
                .then_some(Level::Avx2),
            #[cfg(target_arch = "x86_64")]
            (std::is_x86_feature_detected!("avx512f") && std::is_x86_feature_detected!("fma"))
                .then_some(Level::Avx512),
            #[cfg(target_arch = "aarch64")]
            std::arch::is_aarch64_feature_detected!("neon").then_some(Level::Neon),
        ]
        .into_iter()
        .flatten()
        .map(Path)
    }

    /// The widest instructions of this machine.
    #[inline]
    pub fn best() -> Path {
        static BEST: OnceLock<Path> = OnceLock::new();
        *BEST.get_or_init(|| Path::available().next_back().unwrap_or(Path(Level::Portable)))
    }

    /// Whether this is the portable path, without hand-written transposes.
    pub fn is_portable(self) -> bool {
        self.0 == Level::Portable
    }

    /// Whether it can write past the caches.
    pub fn streams(self) -> bool {
        cfg!(target_arch = "x86_64") && !self.is_portable()
    }

    /// Applies a kernel to a block.
    pub fn apply<const W: usize, K: Kernel<W>>(
        self,
        kernel: &K,
        a: &[Lane<W>],
        b: &[Lane<W>],
        out: &mut [Lane<W>],
    ) {
        self.run(Block { kernel, factors: [a, b], out });
    }

    /// Does work that is compiled for this path.
    pub fn run<T: Work>(self, work: T) -> T::Output {
        by_path!(self, run(work), work.run::<BUILT_WITH_FMA>())
    }

    /// The same; None on the portable path.
    pub fn run_if_wide<T: Work>(self, work: T) -> Option<T::Output> {
        by_path!(self, run(Done(work)), Done(work).left_undone())
    }

    /// The short method of a map for one row. Rounding errors of products take one instruction where it is compiled for
    /// fused multiply-add, else seventeen.
    #[inline]
    pub fn alone<M: Map<A, B, OUT>, const A: usize, const B: usize, const OUT: usize>(
        self,
        map: &M,
        a: [f64; A],
        b: [f64; B],
    ) -> [f64; OUT] {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 | Level::Avx512 => {
                // In registers: a row read back from memory in other parts than it was just written would stall.
                let mut x = [0.0; 8];
                x[..A].copy_from_slice(&a);
                x[A..A + B].copy_from_slice(&b);
                // SAFETY: both levels have fused multiply-add.
                unsafe { x86::alone(map, x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7]) }
            }
            _ => map::alone(map.short::<1, BUILT_WITH_FMA>(map::lanes_of_one(&a), map::lanes_of_one(&b))),
        }
    }

    /// Transposes at most `W` rows of `lanes.len()` numbers into lanes; places beyond the rows are unchanged.
    pub fn gather<T: Element, const W: usize>(self, rows: &[T], lanes: &mut [Lane<W>]) {
        assert!(!lanes.is_empty() && rows.len() <= lanes.len() * W);
        // Safe: there is a lane, and the numbers fit the lanes.
        let done = by_path!(self, gather(rows, lanes), 0);
        let size = lanes.len();
        for (row, values) in rows[done * size..].chunks_exact(size).enumerate() {
            for (lane, &x) in lanes.iter_mut().zip(values) {
                lane.0[done + row] = x.into();
            }
        }
    }

    /// Prefetches some cache lines from an address on, which need not be valid.
    #[inline(always)]
    pub fn prefetch<T>(self, from: *const T, lines: Range<usize>) {
        #[cfg(target_arch = "x86_64")]
        lines.for_each(|line| x86::prefetch(from.wrapping_byte_add(64 * line)));
        #[cfg(not(target_arch = "x86_64"))]
        let _ = (from, lines);
    }

    /// Turns lanes into rows: the inverse of [`Path::gather`].
    pub fn scatter<T: Element, const W: usize>(self, lanes: &[Lane<W>], rows: &mut [T]) {
        assert!(!lanes.is_empty() && rows.len() <= lanes.len() * W);
        // Safe: there is a lane, and the numbers fit the lanes.
        let done = by_path!(self, scatter(lanes, rows), 0);
        let size = lanes.len();
        for (row, values) in rows[done * size..].chunks_exact_mut(size).enumerate() {
            for (x, lane) in values.iter_mut().zip(lanes) {
                *x = T::nearest(lane.0[done + row]);
            }
        }
    }

    /// Copies whole cache lines past the caches if the path can, faster for data that would be evicted before it is read.
    /// [`Path::fence`] completes it.
    pub fn stream<T: Element>(self, from: &[T], to: &mut [T]) {
        assert!(from.len() == to.len() && to.len().is_multiple_of(in_line::<T>()));
        assert!(to.is_empty() || to_next_line(to) == 0);
        // Safe: the lengths and the alignment are asserted above.
        by_path!(self, stream(from, to), to.copy_from_slice(from));
    }

    /// Completes what was streamed, before anything that follows.
    pub fn fence(self) {
        #[cfg(target_arch = "x86_64")]
        x86::fence();
    }
}

/// Numbers in a cache line.
pub(crate) const fn in_line<T>() -> usize {
    64 / size_of::<T>()
}

/// The number of elements before the next cache line.
pub(crate) fn to_next_line<T>(numbers: &[T]) -> usize {
    (numbers.as_ptr().addr() / size_of::<T>()).wrapping_neg() % in_line::<T>()
}

#[cfg(test)]
mod tests;
