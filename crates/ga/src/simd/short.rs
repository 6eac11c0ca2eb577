//! Functions of short rows in registers, where rows are transposed as they are read and written.

use super::{Element, Lane, Path};
use std::ops::Range;

/// A function of two rows of one, three or four numbers each, the same bits as the kernel that it belongs to.
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

/// What is done with a short function whose type is known where it is chosen.
pub(crate) trait WithShort {
    type Output;

    fn with<K: Short<A, B, OUT>, const A: usize, const B: usize, const OUT: usize>(self) -> Self::Output;
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

/// Rows in a group: two registers of the widest instructions, so that little is in use at a time.
pub(crate) const GROUP: usize = 16;

/// Where a link finds the numbers of its groups.
#[derive(Clone, Copy)]
pub(crate) enum Source<'a, T> {
    /// Row by row.
    Rows(&'a [T]),
    /// In the lanes of the chain, from this one on.
    Lanes(usize),
}

#[cfg(target_arch = "x86_64")]
impl<'a, T> Source<'a, T> {
    /// The numbers of a group, `size` in a row.
    ///
    /// # Safety
    /// Rows: those of the group exist. Lanes: they exist, and nothing writes to them while the numbers are in use.
    #[inline(always)]
    pub(super) unsafe fn numbers<const W: usize>(
        self,
        group: usize,
        size: usize,
        lanes: *const Lane<W>,
    ) -> Numbers<'a, T, W> {
        match self {
            Source::Rows(rows) => {
                let place = W * size * group..W * size * (group + 1);
                // SAFETY: as the caller promises.
                Numbers::Rows(unsafe { rows.get_unchecked(place) })
            }
            Source::Lanes(first) => {
                // SAFETY: as the caller promises.
                Numbers::Lanes(unsafe { std::slice::from_raw_parts(lanes.add(first), size) })
            }
        }
    }
}

/// Applies the function of a link to the group of this number.
///
/// # Safety
/// The machine has the instructions. The pointer is to `n` lanes, and the link [fits](Link::fits) them and more groups than
/// the number.
pub(super) type Apply<T, const W: usize> = unsafe fn(&Link<T, W>, usize, *mut Lane<W>);

/// A short function within a chain: each group of `W` rows goes through all links before the next one, so that the values
/// between them stay in the first-level cache, and all inputs are read at the same pace.
pub(crate) struct Link<'a, T, const W: usize = GROUP> {
    pub(super) apply: Apply<T, W>,
    pub(super) from: [Source<'a, T>; 2],
    /// The first lane of the value.
    pub(super) to: usize,
    /// The numbers of both arguments and of the value.
    pub(super) sizes: [usize; 3],
}

impl<T, const W: usize> Link<'_, T, W> {
    /// Whether there are rows for so many groups, and the lanes that it needs, those of the value apart from the others.
    pub(super) fn fits(&self, groups: usize, lanes: usize) -> bool {
        let value = self.to..self.to.saturating_add(self.sizes[2]);
        let fits = |(source, size): (&Source<T>, usize)| match source {
            Source::Rows(rows) => rows.len() / (W * size) >= groups,
            Source::Lanes(first) => {
                let end = first.saturating_add(size);
                end <= lanes && (end <= value.start || value.end <= *first)
            }
        };
        self.from.iter().zip(self.sizes).all(fits) && value.end <= lanes
    }
}

/// Links from lanes to lanes, of which it is checked once that they fit.
pub(crate) struct Chain<const W: usize> {
    links: Vec<Link<'static, f64, W>>,
    lanes: usize,
}

impl<const W: usize> Chain<W> {
    /// Links for so many lanes.
    ///
    /// # Panics
    /// If a link does not fit them.
    pub fn new(links: Vec<Link<'static, f64, W>>, lanes: usize) -> Chain<W> {
        assert!(links.iter().all(|link| link.fits(1, lanes)), "links fit the lanes");
        Chain { links, lanes }
    }

    /// Applies the links one after the other.
    ///
    /// # Panics
    /// Unless there are exactly as many lanes as the chain is for.
    #[inline]
    pub fn apply(&self, lanes: &mut [Lane<W>]) {
        assert_eq!(lanes.len(), self.lanes, "the lanes of the chain");
        for link in &self.links {
            // SAFETY: links exist where the instructions were detected, and this one fits the lanes and one group.
            unsafe { (link.apply)(link, 0, lanes.as_mut_ptr()) };
        }
    }
}

/// A link from sources of these sizes to lanes, for [`Path::link`].
pub(crate) struct AsLink<'a, T, const W: usize = GROUP> {
    pub path: Path,
    pub from: [(Source<'a, T>, usize); 2],
    pub to: Range<usize>,
}

impl<'a, T: Element, const W: usize> WithShort for AsLink<'a, T, W> {
    type Output = Option<Link<'a, T, W>>;

    fn with<K: Short<A, B, OUT>, const A: usize, const B: usize, const OUT: usize>(self) -> Self::Output {
        let [(a, size_a), (b, size_b)] = self.from;
        assert_eq!([size_a, size_b, self.to.len()], [A, B, OUT], "the function is of these sizes");
        self.path.link::<K, T, A, B, OUT, W>([a, b], self.to.start)
    }
}

/// The first rows, for [`Path::short`].
pub(crate) struct FirstRows<'a, T> {
    pub path: Path,
    pub a: &'a [T],
    pub b: &'a [T],
    pub out: &'a mut [T],
    pub streamed: bool,
}

impl<T: Element> WithShort for FirstRows<'_, T> {
    type Output = usize;

    fn with<K: Short<A, B, OUT>, const A: usize, const B: usize, const OUT: usize>(self) -> usize {
        self.path.short::<K, T, A, B, OUT>(self.a, self.b, self.out, self.streamed)
    }
}

/// A block of whole rows, for [`Path::short_block`].
pub(crate) struct WholeBlock<'a, T, const W: usize> {
    pub path: Path,
    pub a: Numbers<'a, T, W>,
    pub b: Numbers<'a, T, W>,
    pub out: &'a mut [Lane<W>],
}

impl<T: Element, const W: usize> WithShort for WholeBlock<'_, T, W> {
    type Output = ();

    fn with<K: Short<A, B, OUT>, const A: usize, const B: usize, const OUT: usize>(self) {
        self.path.short_block::<K, T, A, B, OUT, W>(self.a, self.b, self.out);
    }
}
