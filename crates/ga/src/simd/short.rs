//! Functions of short rows in registers, where rows are transposed as they are read and written.

use super::Lane;

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
    pub fn are_of(&self, size: usize) -> bool {
        match self {
            Numbers::Rows(rows) => rows.len() == W * size,
            Numbers::Lanes(lanes) => lanes.len() == size,
        }
    }
}
