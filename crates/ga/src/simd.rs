//! Lanes: rows of numbers turned so that each component is contiguous, and the widest instructions of
//! the machine to work on them.
//!
//! The arithmetic of a [`Kernel`] is plain loops over lanes, compiled once for each [`Path`]. No path
//! fuses a product with a sum where that changes the result (see [`Kernel::block_fma`]), so all of them
//! give the same numbers bit for bit, on any machine. Only the turning of rows into lanes and back is
//! written by hand, because compilers do it badly.
//!
//! This module holds all the unsafe code of the crate.
#![allow(unsafe_code)]

#[cfg(target_arch = "x86_64")]
mod x86;

/// Rows in a block: three operands of eight lanes stay in the first-level cache.
pub(crate) const LANES: usize = 64;

/// One component of a block of rows.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Lane(pub [f64; LANES]);

impl Lane {
    /// The same number in every row.
    pub const fn filled(x: f64) -> Lane {
        Lane([x; LANES])
    }

    /// The numbers of lanes, one lane after the other.
    pub fn flat(lanes: &mut [Lane]) -> &mut [f64] {
        let count = lanes.len() * LANES;
        // SAFETY: a lane is an array of `LANES` numbers and nothing else.
        unsafe { std::slice::from_raw_parts_mut(lanes.as_mut_ptr().cast(), count) }
    }
}

/// A function of two rows. Both ways of computing it give the same numbers.
pub(crate) trait Kernel {
    /// Whether rows are so fast one by one that lanes pay only where they are made by hand.
    const FAST_ROWS: bool = false;

    /// One row. `out` may hold anything before.
    fn row(&self, a: &[f64], b: &[f64], out: &mut [f64]);

    /// A block of rows. Implementations are `#[inline(always)]` down to the arithmetic, so that each path
    /// compiles them for its own instructions.
    fn block(&self, a: &[Lane], b: &[Lane], out: &mut [Lane]);

    /// The same where fused multiply-add is an instruction, for kernels that find by it what they find
    /// otherwise in more steps: the rounding errors of products.
    #[inline(always)]
    fn block_fma(&self, a: &[Lane], b: &[Lane], out: &mut [Lane]) {
        self.block(a, b, out);
    }
}

/// A set of instructions that this machine has. There is no other way to make one than to detect it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Path(Level);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
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
            std::is_x86_feature_detected!("avx512f").then_some(Level::Avx512),
        ]
        .into_iter()
        .flatten()
        .map(Path)
    }

    /// The widest instructions of this machine.
    pub fn best() -> Path {
        Path::available().next_back().unwrap_or(Path(Level::Portable))
    }

    /// Whether rows are turned into lanes by hand.
    pub fn is_portable(self) -> bool {
        self.0 == Level::Portable
    }

    /// Applies a kernel to a block.
    pub fn apply<K: Kernel>(self, kernel: &K, a: &[Lane], b: &[Lane], out: &mut [Lane]) {
        match self.0 {
            Level::Portable => kernel.block(a, b, out),
            // SAFETY: the instructions were detected.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { x86::apply_avx2(kernel, a, b, out) },
            // SAFETY: the instructions were detected.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { x86::apply_avx512(kernel, a, b, out) },
        }
    }

    /// Turns at most [`LANES`] rows of `lanes.len()` numbers into lanes. Places beyond the rows keep what
    /// they held.
    pub fn gather(self, rows: &[f64], lanes: &mut [Lane]) {
        assert!(!lanes.is_empty() && rows.len() <= lanes.len() * LANES);
        let done = match self.0 {
            Level::Portable => 0,
            // SAFETY: the instructions were detected, and the numbers fit the lanes.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { x86::gather_avx2(rows, lanes) },
            // SAFETY: the instructions were detected, and the numbers fit the lanes.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { x86::gather_avx512(rows, lanes) },
        };
        let size = lanes.len();
        for (row, values) in rows[done * size..].chunks_exact(size).enumerate() {
            for (lane, &x) in lanes.iter_mut().zip(values) {
                lane.0[done + row] = x;
            }
        }
    }

    /// Turns lanes into rows: the inverse of [`Path::gather`].
    pub fn scatter(self, lanes: &[Lane], rows: &mut [f64]) {
        assert!(!lanes.is_empty() && rows.len() <= lanes.len() * LANES);
        let done = match self.0 {
            Level::Portable => 0,
            // SAFETY: the instructions were detected, and the numbers fit the lanes.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { x86::scatter_avx2(lanes, rows) },
            // SAFETY: the instructions were detected, and the numbers fit the lanes.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { x86::scatter_avx512(lanes, rows) },
        };
        let size = lanes.len();
        for (row, values) in rows[done * size..].chunks_exact_mut(size).enumerate() {
            for (x, lane) in values.iter_mut().zip(lanes) {
                *x = lane.0[done + row];
            }
        }
    }

    /// Copies whole cache lines past the caches, where the path can: faster for what would be driven out
    /// of them before it is read. [`Path::fence`] completes it.
    pub fn stream(self, from: &[f64], to: &mut [f64]) {
        assert!(from.len() == to.len() && to.len().is_multiple_of(8) && to_next_line(to) == 0);
        match self.0 {
            Level::Portable => to.copy_from_slice(from),
            // SAFETY: the instructions were detected; lengths and alignment are as they must be.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { x86::stream_avx2(from, to) },
            // SAFETY: the instructions were detected; lengths and alignment are as they must be.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { x86::stream_avx512(from, to) },
        }
    }

    /// Completes what was streamed, before anything that follows.
    pub fn fence(self) {
        #[cfg(target_arch = "x86_64")]
        x86::fence();
    }
}

/// How many numbers stand before the next cache line begins, 0 to 7.
pub(crate) fn to_next_line(numbers: &[f64]) -> usize {
    (numbers.as_ptr().addr() / 8).wrapping_neg() % 8
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of rows around the widths of the registers, and every number of components.
    #[test]
    fn lanes_hold_the_rows_and_give_them_back() {
        for path in Path::available() {
            for size in (1..=20).chain([32, 64]) {
                for rows in (0..20).chain([31, 32, 33, 56, 57, 63, LANES]) {
                    let numbers: Vec<f64> = (0..rows * size).map(|i| i as f64).collect();
                    let mut lanes = vec![Lane::filled(-1.0); size];
                    path.gather(&numbers, &mut lanes);
                    for (k, lane) in lanes.iter().enumerate() {
                        for (row, &x) in lane.0.iter().enumerate() {
                            let expected = if row < rows { (row * size + k) as f64 } else { -1.0 };
                            assert_eq!(x, expected, "{path:?}, {rows} rows of {size}");
                        }
                    }
                    let mut back = vec![f64::NAN; rows * size];
                    path.scatter(&lanes, &mut back);
                    assert_eq!(back, numbers, "{path:?}, {rows} rows of {size}");
                }
            }
        }
    }

    #[test]
    fn streams_copy() {
        let numbers: Vec<f64> = (0..100).map(f64::from).collect();
        for path in Path::available() {
            let mut to = vec![0.0; 100];
            let first = to_next_line(&to);
            path.stream(&numbers[1..81], &mut to[first..first + 80]);
            path.fence();
            assert_eq!(to[first..first + 80], numbers[1..81]);
            assert!(to[..first].iter().chain(&to[first + 80..]).all(|&x| x == 0.0));
        }
    }
}
