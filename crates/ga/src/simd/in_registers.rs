//! Functions of short rows with the instructions of a path.

use super::short::{GROUP, Link, Numbers, Short, Source};
use super::{Element, Lane, Path};
#[cfg(target_arch = "x86_64")]
use super::{Level, x86};

/// Whether rows of these sizes are transposed in registers.
const fn are_short(mut sizes: &[usize]) -> bool {
    while let [size, rest @ ..] = sizes {
        if !matches!(size, 1 | 3 | 4) {
            return false;
        }
        sizes = rest;
    }
    true
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
        const { assert!(are_short(&[A, B, OUT]), "one, three or four numbers") };
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
        const { assert!(are_short(&[A, B, OUT]), "one, three or four numbers") };
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

    /// A function at its place in a chain; `None` where the path has no chains.
    pub fn link<
        'a,
        K: Short<A, B, OUT>,
        T: Element,
        const A: usize,
        const B: usize,
        const OUT: usize,
        const W: usize,
    >(
        self,
        from: [Source<'a, T>; 2],
        to: usize,
    ) -> Option<Link<'a, T, W>> {
        const { assert!(are_short(&[A, B, OUT]), "one, three or four numbers") };
        #[cfg(not(target_arch = "x86_64"))]
        let _ = (from, to);
        #[cfg(target_arch = "x86_64")]
        let sizes = [A, B, OUT];
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => Some(Link { apply: x86::avx2::link::<T, K, A, B, OUT, W>, from, to, sizes }),
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => Some(Link { apply: x86::avx512::link::<T, K, A, B, OUT, W>, from, to, sizes }),
            _ => None,
        }
    }

    /// Applies a chain to whole groups of rows and writes its values, `size` lanes from `first` on, to `out`, past the
    /// caches if `streamed`. Returns the number of rows, 0 where the path cannot.
    ///
    /// # Panics
    /// If the links do not fit the rows or the lanes.
    pub fn chain<T: Element>(
        self,
        links: &[Link<T>],
        lanes: &mut [Lane<GROUP>],
        (first, size): (usize, usize),
        out: &mut [T],
        streamed: bool,
    ) -> usize {
        match size {
            1 => self.chain_of::<T, 1>(links, lanes, first, out, streamed),
            3 => self.chain_of::<T, 3>(links, lanes, first, out, streamed),
            4 => self.chain_of::<T, 4>(links, lanes, first, out, streamed),
            _ => 0,
        }
    }

    fn chain_of<T: Element, const OUT: usize>(
        self,
        links: &[Link<T>],
        lanes: &mut [Lane<GROUP>],
        first: usize,
        out: &mut [T],
        streamed: bool,
    ) -> usize {
        let groups = out.len() / (GROUP * OUT);
        assert!(first + OUT <= lanes.len() && links.iter().all(|link| link.fits(groups, lanes.len())));
        #[cfg(not(target_arch = "x86_64"))]
        let _ = streamed;
        match self.0 {
            // SAFETY: the instructions were detected, and all links fit the rows and the lanes.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { x86::avx2::chain::<T, OUT>(links, lanes, first, out, streamed) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { x86::avx512::chain::<T, OUT>(links, lanes, first, out, streamed) },
            _ => 0,
        }
    }
}
