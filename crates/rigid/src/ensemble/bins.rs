//! Counts of numbers in bins of fixed relative width, and their quantiles.
//!
//! A bin holds the numbers with the same sign, exponent and first ten binary digits, so it is at most 1/1024 of its
//! numbers wide, and bins need no range. Counts of parts add up to those of the whole in any order: quantiles have the
//! same bits for any number of parts and threads.

use polhode_ga::simd::threads::{Threads, for_each};

/// Binary digits of a bin.
const DIGITS: u32 = 10;
/// Bins of a page: the numbers between two powers of 2.
const PAGE: usize = 1 << DIGITS;
/// Bins that are counted at a time.
const TILE: usize = 1 << 14;
/// The bin of NaN and infinities, which are not counted.
pub const UNKNOWN: i32 = i32::MIN;

/// Relative width of a bin.
pub const WIDTH: f64 = 1.0 / PAGE as f64;

/// The bin of a number. Bins rise with the numbers; bin 0 is that of 0.
pub fn bin(x: f64) -> i32 {
    if !x.is_finite() {
        return UNKNOWN;
    }
    let size = (x.abs().to_bits() >> (52 - DIGITS)) as i32;
    if x < 0.0 { -size } else { size }
}

/// The bounds of a bin, the one nearer to 0 first.
fn bounds(bin: i32) -> [f64; 2] {
    if bin == 0 {
        return [0.0; 2];
    }
    let size = u64::from(bin.unsigned_abs());
    let bound = |size: u64| f64::from_bits(size << (52 - DIGITS)).copysign(f64::from(bin));
    [bound(size), bound(size + 1)]
}

/// The counts of one column: pages by rising bins.
#[derive(Clone, Debug, Default)]
struct Column(Vec<(i32, Box<[u32; PAGE]>)>);

impl Column {
    /// The place of a page, which is made if there is none.
    fn page(&mut self, page: i32) -> usize {
        match self.0.binary_search_by_key(&page, |(own, _)| *own) {
            Ok(place) => place,
            Err(place) => {
                self.0.insert(place, (page, Box::new([0; PAGE])));
                place
            }
        }
    }

    fn add(&mut self, bins: impl Iterator<Item = (i32, u32)>) {
        let mut last = None;
        for (bin, count) in bins.filter(|(bin, _)| *bin != UNKNOWN) {
            let number = bin >> DIGITS;
            let place = match last {
                Some((page, place)) if page == number => place,
                _ => self.page(number),
            };
            last = Some((number, place));
            self.0[place].1[(bin & (PAGE as i32 - 1)) as usize] += count;
        }
    }

    /// The bins that hold numbers, by rising bins, and the counts.
    fn filled(&self) -> impl Iterator<Item = (i32, u32)> + '_ {
        let each = |(page, counts): &'_ (i32, Box<[u32; PAGE]>)| {
            let first = page << DIGITS;
            let bins = counts.iter().enumerate().filter(|(_, count)| **count > 0);
            bins.map(|(k, count)| (first + k as i32, *count)).collect::<Vec<_>>()
        };
        self.0.iter().flat_map(each)
    }

    /// The quantiles at rising levels from 0 to 1, linear between neighbours; NaN without numbers.
    fn quantiles(&self, levels: &[f64]) -> Vec<f64> {
        let mut before = 0_u64;
        let ends: Vec<(u64, i32, u32)> = self
            .filled()
            .map(|(bin, count)| {
                before += u64::from(count);
                (before, bin, count)
            })
            .collect();
        let quantile = |level: &f64| {
            let place = before.checked_sub(1)? as f64 * level;
            let rank = place as u64;
            let (low, high) = (at(&ends, rank)?, at(&ends, (rank + 1).min(before - 1))?);
            Some(low + (high - low) * (place - rank as f64))
        };
        levels.iter().map(|level| quantile(level).unwrap_or(f64::NAN)).collect()
    }
}

/// The number of a rank: the numbers of a bin are taken as equally spaced. Bins are given with the counts up to their end.
fn at(ends: &[(u64, i32, u32)], rank: u64) -> Option<f64> {
    let &(end, bin, count) = ends.get(ends.partition_point(|(end, ..)| *end <= rank))?;
    let [near, far] = bounds(bin);
    let after = (rank + u64::from(count) - end) as f64;
    let share = (after + 0.5) / f64::from(count);
    Some(near + (far - near) * if bin < 0 { 1.0 - share } else { share })
}

/// Counts of the numbers of columns.
#[derive(Clone, Debug)]
pub struct BinCounts(Vec<Column>);

impl BinCounts {
    /// No numbers yet.
    pub fn new(columns: usize) -> BinCounts {
        BinCounts(vec![Column::default(); columns])
    }

    /// The number of columns.
    pub fn columns(&self) -> usize {
        self.0.len()
    }

    /// Counts the bins of rows of one number for each column.
    ///
    /// # Panics
    /// If these are not whole rows.
    pub fn add(&mut self, bins: &[i32], threads: Threads) {
        let size = self.0.len();
        assert!(bins.len().is_multiple_of(size.max(1)), "one bin for each column");
        // Rows of a tile stay in the cache from column to column.
        let tile = size * (TILE / size.max(1)).max(16);
        let each = |first: usize, columns: &mut [Column]| {
            for rows in bins.chunks(tile.max(1)) {
                for (k, column) in columns.iter_mut().enumerate() {
                    column.add(rows.iter().skip(first + k).step_by(size).map(|bin| (*bin, 1)));
                }
            }
        };
        let mut rest = &mut self.0[..];
        let least = (1 << 14) * size / bins.len().max(1);
        let pieces = threads.ranges(size, least).map(|columns| {
            let piece = rest.split_off_mut(..columns.len()).expect("pieces fill the columns");
            (columns.start, piece)
        });
        for_each(pieces, |(first, piece)| each(first, piece));
    }

    /// The filled bins: column, bin and count of each, in this order.
    pub fn filled(&self) -> impl Iterator<Item = (u32, i32, u32)> + '_ {
        let columns = self.0.iter().enumerate();
        columns.flat_map(|(k, column)| column.filled().map(move |(bin, count)| (k as u32, bin, count)))
    }

    /// Adds the counts of others; false, without a change, if they have another number of columns.
    pub fn merge(&mut self, other: &BinCounts) -> bool {
        if other.columns() != self.columns() {
            return false;
        }
        for (column, more) in self.0.iter_mut().zip(&other.0) {
            column.add(more.filled());
        }
        true
    }

    /// Adds filled bins; false, without a change, if a column does not exist.
    pub fn add_filled(&mut self, columns: &[u32], bins: &[i32], counts: &[u32]) -> bool {
        if columns.iter().any(|column| *column as usize >= self.0.len()) {
            return false;
        }
        let rows = columns.iter().zip(bins).zip(counts);
        for ((column, bin), count) in rows {
            self.0[*column as usize].add([(*bin, *count)].into_iter());
        }
        true
    }

    /// The quantiles of each column at rising levels from 0 to 1; NaN without numbers.
    pub fn quantiles(&self, levels: &[f64]) -> Vec<Vec<f64>> {
        self.0.iter().map(|column| column.quantiles(levels)).collect()
    }
}

#[cfg(test)]
mod tests;
