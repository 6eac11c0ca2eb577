//! A single value of G3 with grades known at run time, as in dynamic languages.

use crate::g3::rotor::Rotor;
use crate::g3::values::{GRADE, Vector, geometric};
use crate::product::{Engine, Grades, Plan, Product};

/// The components of the grades present, in basis order; zeros follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Graded {
    components: [f64; 8],
    grades: Grades,
}

impl Default for Graded {
    /// The scalar 0.
    fn default() -> Graded {
        Graded { components: [0.0; 8], grades: Grades::SCALAR }
    }
}

impl Graded {
    /// From the components of some grades of G3; `None` if their number does not fit.
    pub fn new(components: &[f64], grades: Grades) -> Option<Graded> {
        if grades.0 >= 16 || components.len() != size(grades) {
            return None;
        }
        let mut held = [0.0; 8];
        held[..components.len()].copy_from_slice(components);
        Some(Graded { components: held, grades })
    }

    /// From the components `[1, e2e3, e3e1, e1e2]` of an even value.
    #[inline]
    pub fn even([s, x, y, z]: [f64; 4]) -> Graded {
        Graded { components: [s, x, y, z, 0.0, 0.0, 0.0, 0.0], grades: Grades::EVEN }
    }

    /// From the components `[e2e3, e3e1, e1e2]` of a bivector.
    #[inline]
    pub fn bivector([x, y, z]: [f64; 3]) -> Graded {
        Graded { components: [x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0], grades: Grades::BIVECTOR }
    }

    /// From the components of some grades of G3, each by its place.
    #[inline]
    pub(crate) fn from_fn(grades: Grades, component: impl FnMut(usize) -> f64) -> Graded {
        let mut held = Graded::default();
        held.fill(grades, component);
        held
    }

    /// Assigns [`Graded::from_fn`] in place.
    #[inline]
    pub(crate) fn fill(&mut self, grades: Grades, component: impl FnMut(usize) -> f64) {
        *self = Graded { components: [0.0; 8], grades };
        let places = self.components[..size(grades)].iter_mut();
        places.zip((0..8).map(component)).for_each(|(held, x)| *held = x);
    }

    /// Assigns another value field by field: a copy of the whole struct would stall on grades just written.
    #[inline]
    pub(crate) fn assign(&mut self, other: &Graded) {
        self.components = other.components;
        self.grades = other.grades;
    }

    /// The components of the grades present.
    pub fn components(&self) -> &[f64] {
        &self.components[..size(self.grades)]
    }

    /// The grades it holds.
    pub fn grades(&self) -> Grades {
        self.grades
    }

    /// The eight components, zeros for the grades it does not hold.
    pub fn full(&self) -> [f64; 8] {
        let mut full = [0.0; 8];
        places(self.grades).zip(self.components).for_each(|(place, x)| full[place] = x);
        full
    }

    /// Its part in some grades; zeros for those it does not hold.
    pub fn with_grades(&self, grades: Grades) -> Graded {
        if grades == self.grades {
            return *self;
        }
        let full = self.full();
        let mut part = Graded { components: [0.0; 8], grades };
        part.components.iter_mut().zip(places(grades)).for_each(|(slot, place)| *slot = full[place]);
        part
    }

    /// A named product, by the terms of the table, in their order.
    #[inline]
    pub fn product(&self, product: Product, other: &Graded) -> Graded {
        let mut out = Graded::default();
        out.set_product(Plan::g3(product, self.grades, other.grades), self, other);
        out
    }

    /// Assigns the product of two values by a plan of G3 for their grades. In place, since components just written one by
    /// one are slow to copy.
    #[inline]
    pub(crate) fn set_product(&mut self, plan: &Plan, a: &Graded, b: &Graded) {
        self.grades = plan.grades;
        if matches!(plan.engine, Engine::Geometric) {
            // A sum that begins with 0, as in the plan, is never −0.
            self.components = geometric(a.components, b.components).map(|x| x + 0.0);
            return;
        }
        self.components = [0.0; 8];
        for term in &plan.terms {
            // The masks let the compiler omit bounds checks.
            self.components[term.out & 7] +=
                f64::from(term.sign) * a.components[term.a & 7] * b.components[term.b & 7];
        }
    }

    /// Applies a function to each component.
    pub fn map(&self, f: impl Fn(f64) -> f64) -> Graded {
        let mut out = *self;
        for x in &mut out.components[..size(self.grades)] {
            *x = f(*x);
        }
        out
    }

    /// Combines components of two values, over the grades of both.
    pub fn zip(&self, other: &Graded, f: impl Fn(f64, f64) -> f64) -> Graded {
        if self.grades == other.grades {
            let mut sum = Graded { components: [0.0; 8], grades: self.grades };
            for i in 0..size(self.grades) {
                sum.components[i & 7] = f(self.components[i & 7], other.components[i & 7]);
            }
            return sum;
        }
        let union = Grades(self.grades.0 | other.grades.0);
        let (mut a, b) = (self.with_grades(union), other.with_grades(union));
        for (x, y) in a.components[..size(union)].iter_mut().zip(b.components) {
            *x = f(*x, y);
        }
        a
    }

    /// `~A`: grades 2 and 3 change sign.
    pub fn reverse(&self) -> Graded {
        let mut out = *self;
        let low = size(Grades(self.grades.0 & 0b0011));
        for x in &mut out.components[low..size(self.grades)] {
            *x = -*x;
        }
        out
    }

    /// `R A ~R`: vector and bivector each turn as three numbers, scalar and trivector stay.
    pub fn turned(&self, rotor: Rotor) -> Graded {
        let mut out = Graded::default();
        out.set_turned(rotor, self);
        out
    }

    /// Assigns `R A ~R`.
    #[inline]
    pub(crate) fn set_turned(&mut self, rotor: Rotor, value: &Graded) {
        *self = Graded { components: [0.0; 8], grades: value.grades };
        let mut next = 0;
        for k in (0..4).filter(|&k| value.grades.contains(k)) {
            if k % 3 == 0 {
                self.components[next & 7] = value.components[next & 7];
                next += 1;
                continue;
            }
            let Vector(turned) =
                rotor.apply(Vector([next, next + 1, next + 2].map(|i| value.components[i & 7])));
            for x in turned {
                self.components[next & 7] = x;
                next += 1;
            }
        }
    }
}

/// The places of the components of some grades among all eight.
fn places(grades: Grades) -> impl Iterator<Item = usize> {
    (0..8).filter(move |&i| grades.contains(GRADE[i]))
}

/// The number of components of some grades.
pub(crate) fn size(grades: Grades) -> usize {
    const SIZES: [u8; 16] = [0, 1, 3, 4, 3, 4, 6, 7, 1, 2, 4, 5, 4, 5, 7, 8];
    usize::from(SIZES[usize::from(grades.0 & 15)])
}

#[cfg(test)]
mod tests;
