//! The blade table: the definition of the geometric algebra of any signature.
//!
//! A blade is a set of generators, written as bits: `0b101` is `e1e3`. To multiply two blades, write
//! their generators one after the other and sort: every swap of two different generators changes the
//! sign, and two equal ones meet and contract to their square. Nothing else is assumed.

use std::sync::LazyLock;

/// Most generators an [`Algebra`] may have; its tables then have 4⁸ entries.
pub const MAX_GENERATORS: usize = 8;

/// The numbers of generators with square +1, −1 and 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Signature {
    /// Generators with square +1.
    pub p: usize,
    /// Generators with square −1.
    pub q: usize,
    /// Generators with square 0.
    pub r: usize,
}

impl Signature {
    /// Number of generators.
    pub fn generators(self) -> usize {
        self.p + self.q + self.r
    }
}

/// A basis element: the generators in `bits`, in rising order, times `sign`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blade {
    /// Bit i stands for generator i.
    pub bits: u32,
    /// −1 where the basis element is minus the canonical blade: `e3e1 = −e1e3`.
    pub sign: i8,
}

impl Blade {
    /// Number of generators in the blade.
    pub fn grade(self) -> usize {
        self.bits.count_ones() as usize
    }
}

/// An algebra with a fixed metric and basis order.
///
/// Of [`Algebra::new`], the generators e1, e2, … square to +1, then to −1, then to 0. The basis is ordered by grade, then
/// by rising generators; with three generators the bivectors stand in the cyclic order e2e3, e3e1, e1e2.
///
/// Of [`Algebra::pga`], the generator e0 comes first and squares to 0, and basis elements `k` and `2ⁿ − 1 − k` are
/// complements, `E_k ∧ E_(2ⁿ−1−k) = I`.
#[derive(Clone, Debug)]
pub struct Algebra {
    signature: Signature,
    /// The square of each generator.
    squares: Vec<i8>,
    /// The number in the name of the first generator.
    first: usize,
    blades: Vec<Blade>,
    index_of_bits: Vec<usize>,
}

/// The algebra of 3-d space.
pub static G3: LazyLock<Algebra> = LazyLock::new(|| {
    Algebra::new(Signature { p: 3, q: 0, r: 0 }).expect("three generators are within the limit")
});

impl Algebra {
    /// The algebra of a signature, or `None` beyond [`MAX_GENERATORS`].
    pub fn new(signature: Signature) -> Option<Algebra> {
        let n = signature.generators();
        if n > MAX_GENERATORS {
            return None;
        }
        let Signature { p, q, r } = signature;
        let squares = [vec![1; p], vec![-1; q], vec![0; r]].concat();
        let mut blades = rising(n);
        if n == 3 {
            blades[4..7].copy_from_slice(&[
                Blade { bits: 0b110, sign: 1 },
                Blade { bits: 0b101, sign: -1 },
                Blade { bits: 0b011, sign: 1 },
            ]);
        }
        Some(Algebra::with_basis(squares, 1, blades))
    }

    /// The plane-based algebra Cl(n, 0, 1) of n-dimensional Euclidean space, with the generators e0, e1, …, en of which e0
    /// squares to 0; `None` beyond [`MAX_GENERATORS`].
    ///
    /// The basis is that of bivector.net. In three dimensions: 1, e0, e1, e2, e3, e01, e02, e03, e12, e31, e23, e021,
    /// e013, e032, e123, e0123. Its first half is in rising order, and the second half the complements of the first from
    /// the last to the first.
    pub fn pga(n: usize) -> Option<Algebra> {
        if n >= MAX_GENERATORS {
            return None;
        }
        let mut squares = vec![1; n + 1];
        squares[0] = 0;
        let mut blades = rising(n + 1);
        let last = blades.len() - 1;
        for k in 0..blades.len() / 2 {
            let bits = blades[last].bits ^ blades[k].bits;
            let sign = if swaps(blades[k].bits, bits).is_multiple_of(2) { 1 } else { -1 };
            blades[last - k] = Blade { bits, sign };
        }
        Some(Algebra::with_basis(squares, 0, blades))
    }

    fn with_basis(squares: Vec<i8>, first: usize, blades: Vec<Blade>) -> Algebra {
        let count = |square: i8| squares.iter().filter(|&&x| x == square).count();
        let signature = Signature { p: count(1), q: count(-1), r: count(0) };
        let mut index_of_bits = vec![0; blades.len()];
        for (i, blade) in blades.iter().enumerate() {
            index_of_bits[blade.bits as usize] = i;
        }
        Algebra { signature, squares, first, blades, index_of_bits }
    }

    /// Its signature.
    pub fn signature(&self) -> Signature {
        self.signature
    }

    /// The squares of the generators: +1, −1 or 0.
    pub fn squares(&self) -> &[i8] {
        &self.squares
    }

    /// The numbers in the names of the generators: from 1, or from 0 if e0 is the first.
    pub fn numbers(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.squares.len()
    }

    /// The product of two canonical blades (generators in rising order): sign (0 if it vanishes), blade.
    pub fn blade_product(&self, a: u32, b: u32) -> (i8, u32) {
        let mut sign = if swaps(a, b).is_multiple_of(2) { 1 } else { -1 };
        for (i, square) in self.squares.iter().enumerate() {
            if a & b & (1 << i) != 0 {
                sign *= square;
            }
        }
        (sign, a ^ b)
    }

    /// The basis elements in component order.
    pub fn blades(&self) -> &[Blade] {
        &self.blades
    }

    /// The product of basis elements `i` and `j`: sign (0 if it vanishes) and index.
    pub fn basis_product(&self, i: usize, j: usize) -> (i8, usize) {
        let (a, b) = (self.blades[i], self.blades[j]);
        let (sign, bits) = self.blade_product(a.bits, b.bits);
        let k = self.index_of_bits[bits as usize];
        (sign * a.sign * b.sign * self.blades[k].sign, k)
    }
}

/// All canonical blades of n generators, by grade, then by rising generators.
fn rising(n: usize) -> Vec<Blade> {
    let mut blades: Vec<Blade> = (0..1 << n).map(|bits| Blade { bits, sign: 1 }).collect();
    // Reversed bits compare like the lists of generators, the blade with the first generator first.
    blades.sort_by_key(|b| (b.grade(), std::cmp::Reverse(b.bits.reverse_bits())));
    blades
}

/// The swaps of neighbours that sort the product of two canonical blades.
pub(crate) fn swaps(a: u32, b: u32) -> u32 {
    // Each generator of b passes all the generators of a that stand to its right.
    let mut swaps = 0;
    let mut rest = a >> 1;
    while rest != 0 {
        swaps += (rest & b).count_ones();
        rest >>= 1;
    }
    swaps
}

#[cfg(test)]
mod tests;
