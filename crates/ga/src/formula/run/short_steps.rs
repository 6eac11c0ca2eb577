//! Steps as functions of short rows in registers, and programs of such steps as chains.

use super::single::Runner;
use super::steps::{Ready, Selection, Sum, Work};
use super::tasks::{Schedule, Task};
use crate::product::Plan;
use crate::rows::compose::Compose;
use crate::rows::product::{Turn, TurnBack};
use crate::simd::short::{AsLink, Link, Numbers, Short, Source, WholeBlock, WithShort};
use crate::simd::{Element, Lane, Path};

/// `a + b`, or with `MINUS` `a − b`: the bits of `a + sign b`.
struct Plus<const MINUS: bool>;

impl<const MINUS: bool, const N: usize> Short<N, N, N> for Plus<MINUS> {
    #[inline(always)]
    fn value(a: [f64; N], b: [f64; N]) -> [f64; N] {
        std::array::from_fn(|k| if MINUS { a[k] - b[k] } else { a[k] + b[k] })
    }
}

/// The first row, with the components negated whose bits are set.
struct Signs<const NEGATIVE: u8>;

impl<const NEGATIVE: u8, const N: usize> Short<N, N, N> for Signs<NEGATIVE> {
    #[inline(always)]
    fn value(a: [f64; N], _: [f64; N]) -> [f64; N] {
        std::array::from_fn(|k| if NEGATIVE >> k & 1 == 1 { -a[k] } else { a[k] })
    }
}

/// Asks only whether there is a short function.
struct Exists;

impl WithShort for Exists {
    type Output = ();

    fn with<K: Short<A, B, OUT>, const A: usize, const B: usize, const OUT: usize>(self) {}
}

impl Ready {
    /// Does something with the step as a function of short rows, those of its operand twice if it has one; `None` if it
    /// is not short.
    fn short<U: WithShort>(&self, user: U) -> Option<U::Output> {
        match &self.work {
            Work::Turn if Turn(self.grades).is_short() => Some(user.with::<Turn, 4, 3, 3>()),
            Work::TurnBack if Turn(self.grades).is_short() => Some(user.with::<TurnBack, 4, 3, 3>()),
            Work::Compose => Some(user.with::<Compose, 4, 4, 4>()),
            Work::Product(Plan { fixed_terms, .. }) => Some(fixed_terms.as_ref()?.short(user)),
            Work::Sum(sum) => sum.short(user),
            Work::Selection(selection) => selection.short(user),
            _ => None,
        }
    }

    /// Whether [`Ready::in_registers`] can evaluate it.
    pub fn is_short(&self) -> bool {
        self.short(Exists).is_some()
    }

    /// Evaluates the step for a block of whole rows, which need not be in lanes, as [`Path::short_block`].
    ///
    /// # Panics
    /// If the step is not [short](Ready::is_short).
    pub fn in_registers<T: Element, const W: usize>(
        &self,
        path: Path,
        a: Numbers<T, W>,
        b: Numbers<T, W>,
        out: &mut [Lane<W>],
    ) {
        let b = if self.operands().len() == 1 { a } else { b };
        self.short(WholeBlock { path, a, b, out }).expect("a step of short values");
    }
}

impl Sum {
    fn short<U: WithShort>(&self, user: U) -> Option<U::Output> {
        let alike = |(k, place): (usize, &[Option<usize>; 2])| *place == [Some(k); 2];
        if !self.places.iter().enumerate().all(alike) {
            return None;
        }
        Some(match (self.places.len(), self.sign < 0.0) {
            (1, false) => user.with::<Plus<false>, 1, 1, 1>(),
            (1, true) => user.with::<Plus<true>, 1, 1, 1>(),
            (3, false) => user.with::<Plus<false>, 3, 3, 3>(),
            (3, true) => user.with::<Plus<true>, 3, 3, 3>(),
            (4, false) => user.with::<Plus<false>, 4, 4, 4>(),
            (4, true) => user.with::<Plus<true>, 4, 4, 4>(),
            _ => return None,
        })
    }
}

impl Selection {
    fn short<U: WithShort>(&self, user: U) -> Option<U::Output> {
        let mut negative = 0;
        for (k, place) in self.places.iter().enumerate() {
            match place {
                Some((sign, from)) if *from == k => negative |= u8::from(*sign < 0.0) << k,
                _ => return None,
            }
        }
        // Adding −0 changes nothing.
        let whole = self.start.is_sign_negative();
        Some(match (self.places.len(), negative) {
            (1, 0b1) if whole => user.with::<Signs<0b1>, 1, 1, 1>(),
            (3, 0b111) if whole => user.with::<Signs<0b111>, 3, 3, 3>(),
            (4, 0b1111) if whole => user.with::<Signs<0b1111>, 4, 4, 4>(),
            // The reverse of an even value.
            (4, 0b1110) if whole => user.with::<Signs<0b1110>, 4, 4, 4>(),
            _ => return None,
        })
    }
}

impl Runner {
    /// The tasks of a schedule as a chain, with the sources and sizes of inputs; `None` unless all of them are short.
    pub(super) fn chain<'a, T: Element, const W: usize>(
        &self,
        path: Path,
        schedule: &Schedule,
        input: impl Fn(usize) -> (Source<'a, T>, usize),
    ) -> Option<Vec<Link<'a, T, W>>> {
        let mut links = Vec::with_capacity(schedule.tasks.len());
        for task in &schedule.tasks {
            match task {
                Task::Read { direct: true, .. } => {}
                Task::Read { input: number, to, .. } => {
                    let link = AsLink { path, from: [input(*number); 2], to: to.clone() };
                    links.push(match to.len() {
                        1 => link.with::<Signs<0>, 1, 1, 1>()?,
                        3 => link.with::<Signs<0>, 3, 3, 3>()?,
                        4 => link.with::<Signs<0>, 4, 4, 4>()?,
                        _ => return None,
                    });
                }
                Task::Do { step, operands, rows: direct, to } => {
                    let step = &self.steps[*step];
                    let in_lanes = |k: usize| (Source::Lanes(operands[k].start), operands[k].len());
                    let source = |k: usize| direct[k].map_or(in_lanes(k), &input);
                    let second = if step.operands().len() == 1 { 0 } else { 1 };
                    let from = [source(0), source(second)];
                    links.push(step.short(AsLink { path, from, to: to.clone() })??);
                }
            }
        }
        Some(links)
    }
}
