//! The blade table: the definition of the geometric algebra of any signature.
//!
//! A blade is a set of generators, written as bits: `0b101` is `e1e3`. To multiply two blades, write
//! their generators one after the other and sort: every swap of two different generators changes the
//! sign, and two equal ones meet and contract to their square. Nothing else is assumed.

use std::sync::LazyLock;

/// Most generators an [`Algebra`] may have; its tables then have 4⁸ entries.
pub const MAX_GENERATORS: usize = 8;

/// The numbers of generators with square +1, −1 and 0, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Signature {
    /// Generators with square +1; they come first.
    pub p: usize,
    /// Generators with square −1.
    pub q: usize,
    /// Generators with square 0; they come last.
    pub r: usize,
}

impl Signature {
    /// Number of generators.
    pub fn generators(self) -> usize {
        self.p + self.q + self.r
    }

    /// The square of generator `i` (from 0): +1, −1 or 0.
    pub fn square(self, i: usize) -> i8 {
        if i < self.p {
            1
        } else if i < self.p + self.q {
            -1
        } else {
            0
        }
    }

    /// The product of two canonical blades (generators in rising order): sign (0 if it vanishes), blade.
    pub fn blade_product(self, a: u32, b: u32) -> (i8, u32) {
        // Each generator of b passes all the generators of a that stand to its right.
        let mut swaps = 0;
        let mut rest = a >> 1;
        while rest != 0 {
            swaps += (rest & b).count_ones();
            rest >>= 1;
        }
        let mut sign = if swaps % 2 == 0 { 1 } else { -1 };
        for i in 0..self.generators() {
            if a & b & (1 << i) != 0 {
                sign *= self.square(i);
            }
        }
        (sign, a ^ b)
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

/// An algebra with a fixed basis order: by grade, then by rising generators; with three generators
/// the bivectors stand in the cyclic order e2e3, e3e1, e1e2.
#[derive(Clone, Debug)]
pub struct Algebra {
    signature: Signature,
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
        let mut blades: Vec<Blade> = (0..1 << n).map(|bits| Blade { bits, sign: 1 }).collect();
        // Reversed bits compare like the lists of generators, the blade with e1 first.
        blades.sort_by_key(|b| (b.grade(), std::cmp::Reverse(b.bits.reverse_bits())));
        if n == 3 {
            blades[4..7].copy_from_slice(&[
                Blade { bits: 0b110, sign: 1 },
                Blade { bits: 0b101, sign: -1 },
                Blade { bits: 0b011, sign: 1 },
            ]);
        }
        let mut index_of_bits = vec![0; 1 << n];
        for (i, blade) in blades.iter().enumerate() {
            index_of_bits[blade.bits as usize] = i;
        }
        Some(Algebra { signature, blades, index_of_bits })
    }

    /// Its signature.
    pub fn signature(&self) -> Signature {
        self.signature
    }

    /// The basis elements in component order.
    pub fn blades(&self) -> &[Blade] {
        &self.blades
    }

    /// The product of basis elements `i` and `j`: sign (0 if it vanishes) and index.
    pub fn basis_product(&self, i: usize, j: usize) -> (i8, usize) {
        let (a, b) = (self.blades[i], self.blades[j]);
        let (sign, bits) = self.signature.blade_product(a.bits, b.bits);
        let k = self.index_of_bits[bits as usize];
        (sign * a.sign * b.sign * self.blades[k].sign, k)
    }
}

#[cfg(test)]
mod tests;
