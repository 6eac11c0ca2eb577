//! The named products: each is the geometric product with a rule on grades.
//!
//! A product of blades of grades r and s has one grade k, and the rule says whether it is kept. The
//! handout's dot is the lowest grade, `abs(r − s)`, scalars included (`3·a = 3a`); its wedge the highest.

use crate::rows::fixed_terms::FixedTerms;
use crate::rows::tiles::Tiles;
use crate::table::{Algebra, G3};
use std::sync::OnceLock;

/// An enum whose variants have names.
macro_rules! named {
    ($(#[$doc:meta])* $type:ident: $count:literal { $($(#[$about:meta])* $variant:ident $name:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum $type {
            $($(#[$about])* $variant,)*
        }

        impl $type {
            /// Every one, in the order of the enum.
            pub const ALL: [$type; $count] = [$($type::$variant),*];

            /// The one of this name.
            pub fn from_name(name: &str) -> Option<$type> {
                $type::ALL.into_iter().find(|one| one.name() == name)
            }

            /// Its name.
            pub fn name(self) -> &'static str {
                match self {
                    $($type::$variant => $name,)*
                }
            }
        }
    };
}
pub(crate) use named;

named! {
    /// The products of the handout, and the contractions.
    Product: 8 {
        /// The geometric product `AB`: every grade.
        Geometric "geometric",
        /// `A∧B`: grade r + s.
        Wedge "wedge",
        /// `A·B`: grade abs(r − s).
        Dot "dot",
        /// `A×B = ½(AB − BA)`: the pairs of blades that anticommute.
        Commutator "commutator",
        /// Left contraction `A⌋B`: grade s − r.
        LeftContraction "left_contraction",
        /// Right contraction `A⌊B`: grade r − s.
        RightContraction "right_contraction",
        /// `⟨AB⟩`: grade 0.
        Scalar "scalar",
        /// The regressive product `A∨B`, the wedge of complements: grade r + s − n.
        Vee "vee",
    }
}

impl Product {
    /// Whether the grade-k product of blades of grades r and s is kept.
    fn keeps(self, r: usize, s: usize, k: usize, anticommute: bool) -> bool {
        match self {
            Product::Geometric => true,
            Product::Wedge | Product::Vee => k == r + s,
            Product::Dot => k == r.abs_diff(s),
            Product::Commutator => anticommute,
            Product::LeftContraction => k + r == s,
            Product::RightContraction => k + s == r,
            Product::Scalar => k == 0,
        }
    }

    /// The named product of basis elements `i` and `j`: sign (0 if it vanishes) and index.
    pub fn of_basis(self, algebra: &Algebra, i: usize, j: usize) -> (i8, usize) {
        if self == Product::Vee {
            return vee(algebra, i, j);
        }
        let (sign, k) = algebra.basis_product(i, j);
        let (reverse_sign, _) = algebra.basis_product(j, i);
        let grade = |index: usize| algebra.blades()[index].grade();
        let kept = self.keeps(grade(i), grade(j), grade(k), sign == -reverse_sign);
        (if kept { sign } else { 0 }, k)
    }
}

/// `E_i ∨ E_j = lc(rc(E_i) ∧ rc(E_j))`, with the complements `E ∧ rc(E) = I` and `lc(E) ∧ E = I`.
fn vee(algebra: &Algebra, i: usize, j: usize) -> (i8, usize) {
    let pseudoscalar = algebra.blades().len() - 1;
    // The index of the product with I is that of the complement, even where the product vanishes.
    let complement = |i: usize| algebra.basis_product(i, pseudoscalar).1;
    let right = |i: usize| (algebra.basis_product(i, complement(i)).0, complement(i));
    let ((si, ci), (sj, cj)) = (right(i), right(j));
    let (sign, k) = Product::Wedge.of_basis(algebra, ci, cj);
    let left = complement(k);
    (si * sj * sign * algebra.basis_product(left, k).0, left)
}

/// A set of grades, as bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Grades(pub u16);

impl Grades {
    /// The scalars alone.
    pub const SCALAR: Grades = Grades(1);
    /// The vectors alone.
    pub const VECTOR: Grades = Grades(2);
    /// The bivectors alone.
    pub const BIVECTOR: Grades = Grades(0b100);
    /// Scalars and bivectors, the grades of rotors.
    pub const EVEN: Grades = Grades(0b101);
    /// Every grade of 3-d space.
    pub const ALL: Grades = Grades(0b1111);

    /// Whether every grade of this set is in the other.
    pub fn within(self, other: Grades) -> bool {
        self.0 & !other.0 == 0
    }

    /// Whether grade `k` is in the set.
    pub fn contains(self, k: usize) -> bool {
        self.0 >> k & 1 == 1
    }

    /// Its odd grades, or its even ones.
    pub fn of_parity(self, odd: bool) -> Grades {
        Grades(self.0 & if odd { 0xaaaa } else { 0x5555 })
    }

    /// Indices of the basis elements of these grades, in basis order: the components of a value.
    pub fn indices(self, algebra: &Algebra) -> Vec<usize> {
        let blades = algebra.blades();
        (0..blades.len()).filter(|&i| self.contains(blades[i].grade())).collect()
    }
}

/// `out[out] += sign · a[a] · b[b]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Term {
    /// Component of the left factor.
    pub a: usize,
    /// Component of the right factor.
    pub b: usize,
    /// Component of the product.
    pub out: usize,
    /// +1 or −1.
    pub sign: i8,
}

/// A product between values that hold given grades, as a list of terms in order of `out`.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Components of the left factor, the right factor and the product.
    pub sizes: (usize, usize, usize),
    /// The grades of the product; a product that vanishes identically is the scalar 0.
    pub grades: Grades,
    /// The terms.
    pub terms: Vec<Term>,
    /// How it is run.
    pub(crate) engine: Engine,
    /// The same product with its terms known to the compiler.
    pub(crate) fixed_terms: Option<FixedTerms>,
}

/// The ways to run a plan.
#[derive(Clone, Debug)]
pub(crate) enum Engine {
    /// Term by term.
    Terms,
    /// Written out: the geometric product of all grades in 3-d space.
    Geometric,
    /// The geometric product of all grades in a larger algebra. Terms are summed in another order, and
    /// fused where the machine can, so that sums differ from the others' by a rounding for each term.
    Tiles(Tiles),
}

impl Plan {
    /// Plans `product` for factors that hold the grades `ga` and `gb`.
    pub fn new(algebra: &Algebra, product: Product, ga: Grades, gb: Grades) -> Plan {
        let (ia, ib) = (ga.indices(algebra), gb.indices(algebra));
        let mut found = Vec::new();
        let mut grades = 0;
        for (a, &i) in ia.iter().enumerate() {
            for (b, &j) in ib.iter().enumerate() {
                let (sign, k) = product.of_basis(algebra, i, j);
                if sign != 0 {
                    grades |= 1 << algebra.blades()[k].grade();
                    found.push(Term { a, b, out: k, sign });
                }
            }
        }
        let grades = if grades == 0 { Grades::SCALAR } else { Grades(grades) };
        let iout = grades.indices(algebra);
        for term in &mut found {
            term.out = iout.binary_search(&term.out).expect("its grade is in the set");
        }
        found.sort_by_key(|t| (t.out, t.a));
        let full = product == Product::Geometric
            && [ia.len(), ib.len()].iter().all(|&size| size == algebra.blades().len());
        let engine = if full && algebra.signature() == G3.signature() {
            Engine::Geometric
        } else {
            let tiles = if full { Tiles::new(algebra) } else { None };
            tiles.map_or(Engine::Terms, Engine::Tiles)
        };
        let sizes = (ia.len(), ib.len(), iout.len());
        Plan { sizes, grades, terms: found, engine, fixed_terms: None }.recognised()
    }

    /// The part of the product in some grades; zeros in those that it lacks.
    pub fn part(&self, algebra: &Algebra, grades: Grades) -> Plan {
        if grades == self.grades {
            return self.clone();
        }
        let (from, to) = (self.grades.indices(algebra), grades.indices(algebra));
        let kept = |term: &Term| Some(Term { out: to.binary_search(&from[term.out]).ok()?, ..*term });
        let terms = self.terms.iter().filter_map(kept).collect();
        let sizes = (self.sizes.0, self.sizes.1, to.len());
        Plan { sizes, grades, terms, engine: Engine::Terms, fixed_terms: None }.recognised()
    }

    /// The plan after a change of its terms.
    pub(crate) fn recognised(self) -> Plan {
        let terms = self.terms.iter().map(|t| (t.a, t.b, t.out, t.sign));
        Plan { fixed_terms: FixedTerms::of(self.sizes, terms), ..self }
    }

    /// The plan in [`G3`], made once for each product and pair of grades.
    ///
    /// # Panics
    /// If a set holds a grade above 3.
    pub fn g3(product: Product, ga: Grades, gb: Grades) -> &'static Plan {
        static PLANS: [OnceLock<Plan>; 8 * 16 * 16] = [const { OnceLock::new() }; 8 * 16 * 16];
        assert!(ga.0 < 16 && gb.0 < 16, "3-d space has grades 0 to 3");
        let index = (product as usize * 16 + usize::from(ga.0)) * 16 + usize::from(gb.0);
        PLANS[index].get_or_init(|| Plan::new(&G3, product, ga, gb))
    }
}

#[cfg(test)]
mod tests;
