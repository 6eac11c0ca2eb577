//! Full products in any algebra, by tiles of eight by eight blades.
//!
//! Write every blade as `l h`: `l` of the first three generators, `h` of the others. There are eight `l`,
//! and all the blades with one `h` are a *coset*. In the product of two blades
//!
//! ```text
//! l1 h1 l2 h2 = (−1)^(|h1| |l2|) (l1 l2) (h1 h2)
//! ```
//!
//! since `l2` passes `h1` and different generators anticommute. So a coset times a coset is a coset, with up to signs
//! the 8 × 8 products of the first three generators: a tile, written once. The signs are that of `h1 h2`, and one more
//! for odd `l2` if `h1` is odd. An algebra is then a short list of pairs of cosets.
//!
//! For this the generators are sorted: those of square +1 first, those of square 0 last. With at least three that do not
//! square to 0, the first three square to +1 or −1, and no product in a tile vanishes. Where the basis of the algebra is
//! in another order, as that of `Algebra::pga`, some basis elements are minus the sorted blades (`flips`).

use crate::simd::lanes::Work;
use crate::simd::{ByRow, Kernel, Lane, Path};
use crate::table::{Algebra, Signature, swaps};
use std::borrow::BorrowMut;

/// The sign of the product of two blades of three generators, the first `P` of which square to +1 and the
/// others to −1.
const fn sign<const P: usize>(l1: usize, l2: usize) -> i32 {
    // Each generator of l2 passes those of l1 to its right; equal ones meet, and may square to −1.
    let swaps = (l1 >> 1 & l2).count_ones() + (l1 >> 2 & l2).count_ones();
    let negative = (l1 & l2 & (0b111 << P)).count_ones();
    if (swaps + negative).is_multiple_of(2) { 1 } else { -1 }
}

/// A pair of cosets whose product is not zero.
#[derive(Clone, Debug)]
struct Pair {
    a: usize,
    b: usize,
    out: usize,
    /// The sign bits of the products with even and with odd `l2`.
    signs: [u64; 2],
}

/// The full product of an algebra of four generators or more, at least three of which do not square to 0.
#[derive(Clone, Debug)]
pub(crate) struct Tiles {
    /// The number of the first three generators with square +1.
    positive: usize,
    /// The components of each coset, in order of the bits of `l`.
    cosets: Vec<[usize; 8]>,
    /// The sign bits of the components of each coset against the sorted blades; empty if no sign differs.
    flips: Vec<[u64; 8]>,
    /// In order of `out`.
    pairs: Vec<Pair>,
}

/// A blade with its generators in sorted order: its bits there, and whether it is minus that blade.
fn sorted(bits: u32, place_of: &[usize]) -> (u32, bool) {
    let mut sorted = 0;
    let mut negative = false;
    for (_, &place) in place_of.iter().enumerate().filter(|(i, _)| bits >> i & 1 == 1) {
        negative ^= swaps(sorted, 1 << place) % 2 == 1;
        sorted |= 1 << place;
    }
    (sorted, negative)
}

impl Tiles {
    /// The tiles of an algebra, if it is of the kind that has them.
    pub fn new(algebra: &Algebra) -> Option<Tiles> {
        let signature = algebra.signature();
        let Signature { p, q, .. } = signature;
        if signature.generators() < 4 || p + q < 3 {
            return None;
        }
        let mut order: Vec<usize> = (0..signature.generators()).collect();
        // A stable sort by the squares 1, −1, 0.
        order.sort_by_key(|&i| [0, 2, 1][(1 - algebra.squares()[i]) as usize]);
        let mut place_of = order.clone();
        order.iter().enumerate().for_each(|(place, &i)| place_of[i] = place);
        let plain = Algebra::new(signature)?;
        let mut cosets = vec![[0; 8]; algebra.blades().len() / 8];
        let mut flips = vec![[0; 8]; cosets.len()];
        for (component, blade) in algebra.blades().iter().enumerate() {
            let (bits, negative) = sorted(blade.bits, &place_of);
            let (coset, l) = (bits as usize / 8, bits as usize % 8);
            cosets[coset][l] = component;
            flips[coset][l] = u64::from(negative != (blade.sign < 0)) << 63;
        }
        if flips.iter().flatten().all(|&flip| flip == 0) {
            flips.clear();
        } else if p < 3 {
            return None;
        }
        let mut pairs = Vec::new();
        for out in 0..cosets.len() {
            for a in 0..cosets.len() {
                let b = a ^ out;
                let (high, _) = plain.blade_product(8 * a as u32, 8 * b as u32);
                if high != 0 {
                    let even = high < 0;
                    let odd = even ^ (a.count_ones() % 2 == 1);
                    pairs.push(Pair { a, b, out, signs: [even, odd].map(|minus| u64::from(minus) << 63) });
                }
            }
        }
        Some(Tiles { positive: p.min(3), cosets, flips, pairs })
    }

    /// The product of `W` rows by their columns.
    #[inline(always)]
    fn multiply<const P: usize, const FLIPS: bool, const FUSED: bool, const W: usize, C>(
        &self,
        a: &[C],
        b: &[C],
        out: &mut [C],
    ) where
        C: BorrowMut<[f64; W]>,
    {
        for pairs in self.pairs.chunk_by(|s, t| s.out == t.out) {
            let mut sums = [[0.0; W]; 8];
            for pair in pairs {
                let xs = self.cosets[pair.a].map(|component| a[component].borrow());
                let ys = self.cosets[pair.b].map(|component| b[component].borrow());
                let flips = if FLIPS { [self.flips[pair.a], self.flips[pair.b]] } else { [[0; 8]; 2] };
                tile::<P, FLIPS, FUSED, W>(xs, ys, pair.signs, flips, &mut sums);
            }
            let coset = pairs[0].out;
            for (l, &component) in self.cosets[coset].iter().enumerate() {
                let column = out[component].borrow_mut();
                *column = sums[l];
                if FLIPS {
                    let mask = self.flips[coset][l];
                    for x in column {
                        // Adding 0 makes −0 to 0.
                        *x = flipped(*x, mask) + 0.0;
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn columns<const FUSED: bool, const W: usize, C>(&self, a: &[C], b: &[C], out: &mut [C])
    where
        C: BorrowMut<[f64; W]>,
    {
        match self.positive {
            0 => self.multiply::<0, false, FUSED, W, C>(a, b, out),
            1 => self.multiply::<1, false, FUSED, W, C>(a, b, out),
            2 => self.multiply::<2, false, FUSED, W, C>(a, b, out),
            _ if self.flips.is_empty() => self.multiply::<3, false, FUSED, W, C>(a, b, out),
            _ => self.multiply::<3, true, FUSED, W, C>(a, b, out),
        }
    }
}

/// Does something for each `$l`, a constant from 0 to 7.
macro_rules! each {
    ($l:ident, $do:block) => {
        each!(@ $l, $do, 0 1 2 3 4 5 6 7)
    };
    (@ $l:ident, $do:block, $($value:literal)*) => {
        $({
            const $l: usize = $value;
            $do
        })*
    };
}

/// A number with its sign bit changed by that of a mask.
#[inline(always)]
fn flipped(x: f64, mask: u64) -> f64 {
    f64::from_bits(x.to_bits() ^ mask)
}

/// Adds the product of two cosets.
#[inline(always)]
fn tile<const P: usize, const FLIPS: bool, const FUSED: bool, const W: usize>(
    a: [&[f64; W]; 8],
    b: [&[f64; W]; 8],
    signs: [u64; 2],
    flips: [[u64; 8]; 2],
    sums: &mut [[f64; W]; 8],
) {
    for row in 0..W {
        let mut sum = [0.0; 8];
        let mut y = [0.0; 8];
        each!(L, {
            sum[L] = sums[L][row];
            y[L] = flipped(b[L][row], signs[L.count_ones() as usize % 2] ^ flips[1][L]);
        });
        each!(L1, {
            let x = if FLIPS { flipped(a[L1][row], flips[0][L1]) } else { a[L1][row] };
            each!(L2, {
                let x = if const { sign::<P>(L1, L2) } > 0 { x } else { -x };
                sum[L1 ^ L2] = if FUSED { x.mul_add(y[L2], sum[L1 ^ L2]) } else { sum[L1 ^ L2] + x * y[L2] };
            });
        });
        each!(L, {
            sums[L][row] = sum[L];
        });
    }
}

impl<const W: usize> std::borrow::Borrow<[f64; W]> for Lane<W> {
    #[inline(always)]
    fn borrow(&self) -> &[f64; W] {
        &self.0
    }
}

impl<const W: usize> BorrowMut<[f64; W]> for Lane<W> {
    #[inline(always)]
    fn borrow_mut(&mut self) -> &mut [f64; W] {
        &mut self.0
    }
}

/// The product of one row as work, the same bits as in lanes.
struct Row<'a> {
    tiles: &'a Tiles,
    factors: [&'a [f64]; 2],
    out: &'a mut [f64],
}

impl Work for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [a, b] = self.factors.map(|row| row.as_chunks().0);
        self.tiles.columns::<FUSED, 1, [f64; 1]>(a, b, self.out.as_chunks_mut().0);
    }
}

impl ByRow for Tiles {
    /// As many rows take as long as a block of eight.
    const FEW: usize = 4;

    fn row(&self, path: Path, a: &[f64], b: &[f64], out: &mut [f64]) {
        path.run(Row { tiles: self, factors: [a, b], out });
    }
}

impl<const W: usize> Kernel<W> for Tiles {
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
        self.columns::<false, W, _>(a, b, out);
    }

    #[inline(always)]
    fn fused_block(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
        self.columns::<true, W, _>(a, b, out);
    }
}
