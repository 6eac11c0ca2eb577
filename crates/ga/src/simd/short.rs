//! Functions of short rows in registers, where rows are transposed as they are read and written.

#[cfg(target_arch = "x86_64")]
use super::x86;
use super::{Element, Lane, Level, Path};

/// A function of two rows of three or four numbers each, the same bits as the kernel that it belongs to.
///
/// It is computed in registers, where rows are transposed as they are read and written: half the time of rows that go
/// through lanes in memory.
pub(crate) trait Short<const A: usize, const B: usize, const OUT: usize> {
    /// One row. `#[inline(always)]` down to the arithmetic.
    fn value(a: [f64; A], b: [f64; B]) -> [f64; OUT];

    /// `W` rows by their columns.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn values<const W: usize>(a: [[f64; W]; A], b: [[f64; W]; B]) -> [[f64; W]; OUT] {
        let mut out = [[0.0; W]; OUT];
        for l in 0..W {
            let value = Self::value(std::array::from_fn(|k| a[k][l]), std::array::from_fn(|k| b[k][l]));
            for k in 0..OUT {
                out[k][l] = value[k];
            }
        }
        out
    }
}

/// The numbers of a block of `W` rows.
#[derive(Clone, Copy)]
pub(crate) enum Numbers<'a, T, const W: usize> {
    /// Row by row.
    Rows(&'a [T]),
    /// Transposed.
    Lanes(&'a [Lane<W>]),
}

impl<T, const W: usize> Numbers<'_, T, W> {
    /// Whether they are rows of this size.
    fn are_of(&self, size: usize) -> bool {
        match self {
            Numbers::Rows(rows) => rows.len() == W * size,
            Numbers::Lanes(lanes) => lanes.len() == size,
        }
    }
}

impl Path {
    /// Applies a function to the first rows, in registers, past the caches if `streamed`; returns their number, 0 where
    /// the path cannot. A factor has one row for all, or as many as `out`.
    pub fn short<K: Short<A, B, OUT>, T: Element, const A: usize, const B: usize, const OUT: usize>(
        self,
        a: &[T],
        b: &[T],
        out: &mut [T],
        streamed: bool,
    ) -> usize {
        const { assert!(A / 5 + B / 5 + OUT / 5 == 0 && A > 2 && B > 2 && OUT > 2, "three or four numbers") };
        let total = out.len() / OUT;
        let one = [a.len() == A, b.len() == B];
        assert!((one[0] || a.len() == total * A) && (one[1] || b.len() == total * B), "rows fit together");
        #[cfg(not(target_arch = "x86_64"))]
        let _ = streamed;
        match self.0 {
            // SAFETY: the instructions were detected, and the numbers of rows fit.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { x86::avx2::short::<T, K, A, B, OUT>(a, b, one, out, streamed) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { x86::avx512::short::<T, K, A, B, OUT>(a, b, one, out, streamed) },
            _ => 0,
        }
    }

    /// Whether the path has [`Path::short_block`].
    pub fn has_short_blocks(self) -> bool {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 | Level::Avx512 => true,
            _ => false,
        }
    }

    /// Applies a function to a block of whole rows, in registers.
    ///
    /// # Panics
    /// If the numbers do not fit the block, and where the path cannot.
    pub fn short_block<
        K: Short<A, B, OUT>,
        T: Element,
        const A: usize,
        const B: usize,
        const OUT: usize,
        const W: usize,
    >(
        self,
        a: Numbers<T, W>,
        b: Numbers<T, W>,
        out: &mut [Lane<W>],
    ) {
        const { assert!(A / 5 + B / 5 == 0 && A > 2 && B > 2, "three or four numbers") };
        assert!(a.are_of(A) && b.are_of(B) && out.len() == OUT, "the numbers fit the block");
        match self.0 {
            // SAFETY: the instructions were detected, and the numbers fit.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { x86::avx2::short_block::<T, K, A, B, OUT, W>(a, b, out) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { x86::avx512::short_block::<T, K, A, B, OUT, W>(a, b, out) },
            _ => panic!("this path has no short blocks"),
        }
    }
}
