//! Programs of any algebra over many rows: those of sums, products and quotients.
//!
//! Each step has the bits of the operator: a product adds the same terms in the same order, and full products of large
//! algebras go through the same tiles. Values stay in lanes between the steps, so only inputs and results meet the memory.

use super::LANES_OF_32;
use super::schedule::apart;
use super::steps::{Divide, Selection, Sum};
use super::tasks::Lanes;
use crate::formula::compile::program::{Id, InputKind, Op, Program, Step};
use crate::product::{Engine, Grades, Plan};
use crate::simd::threads::{Threads, for_each};
use crate::simd::traverse::{Factor, SHARED, Target, by_blocks};
use crate::simd::{Lane, Path};
use crate::table::Algebra;
use std::f64::consts::PI;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, Ordering};

/// From this many bytes on, inputs and results together, results bypass the caches.
const STREAMED: usize = 8 << 20;

/// This many lanes of 64 rows fit in the first-level cache.
const MANY_LANES: usize = 64;

/// Up to this many lanes, blocks of 32 rows pay where results bypass the caches (see [`LANES_OF_32`]). The products of more
/// lanes take so long that reading matters less than the overhead of a block.
const MOST_LANES_OF_32: usize = 40;

/// A program over rows of float64.
pub struct RowRunner {
    /// The numbers in a row of each input.
    sizes: Vec<usize>,
    nodes: Vec<Node>,
    result: usize,
}

/// A step, or part of one.
struct Node {
    work: Work,
    operands: Vec<usize>,
    size: usize,
}

enum Work {
    Read(usize),
    Constant(Vec<f64>),
    Sum(Sum),
    Selection(Selection),
    Product(Plan),
    Divide,
}

/// A node at its lanes.
struct Task<'a> {
    node: &'a Node,
    operands: [Range<usize>; 2],
    to: Range<usize>,
    /// Whether its value is the same for all rows.
    common: bool,
}

/// Collects the nodes of a program.
struct Builder<'a> {
    program: &'a Program,
    algebra: &'a Algebra,
    nodes: Vec<Node>,
    /// The node of each step.
    places: Vec<usize>,
    /// The terms of all products.
    terms: usize,
}

/// Maximum number of terms of all products, 32 bytes each.
const MAX_TERMS: usize = 1 << 20;

impl RowRunner {
    /// Prepares a program; `None` for an equation, if a step is a function, and if products have too many terms.
    pub fn new(program: &Program, algebra: &Algebra) -> Option<RowRunner> {
        let [sides] = &program.results[..] else { return None };
        let &[result] = &sides[..] else { return None };
        let mut sizes = Vec::new();
        for input in &program.inputs {
            let InputKind::Value(ty) = input.kind else { return None };
            sizes.push(ty.grades.indices(algebra).len());
        }
        let mut builder = Builder { program, algebra, nodes: Vec::new(), places: Vec::new(), terms: 0 };
        for step in &program.steps {
            let place = builder.step(step)?;
            builder.places.push(place);
        }
        Some(RowRunner { sizes, result: builder.places[result], nodes: builder.nodes })
    }

    /// The numbers in a row of each input.
    pub fn sizes(&self) -> &[usize] {
        &self.sizes
    }

    /// The numbers in a row of the result.
    pub fn size_of_result(&self) -> usize {
        self.nodes[self.result].size
    }

    /// The work for a row, in units of reading or writing a number.
    pub fn weight(&self) -> usize {
        self.nodes.iter().map(|node| node.size).sum::<usize>() + self.sizes.iter().sum::<usize>()
    }

    /// Evaluates a range of rows; each input has one row for all, or one for each. False if some row may have no value, as
    /// after a division by zero; the result is then unspecified.
    ///
    /// # Panics
    /// If the numbers of rows do not fit together.
    pub fn run(&self, threads: Threads, inputs: &[&[f64]], out: &mut [f64], rows: Range<usize>) -> bool {
        self.run_on(Path::best(), threads, inputs, out, rows)
    }

    fn run_on(
        &self,
        path: Path,
        threads: Threads,
        inputs: &[&[f64]],
        out: &mut [f64],
        rows: Range<usize>,
    ) -> bool {
        assert_eq!(inputs.len(), self.sizes.len(), "an array for each input");
        let size = self.size_of_result();
        let total = out.len() / size;
        assert_eq!(out.len(), total * size, "the result is not a whole number of rows");
        let bytes = inputs.iter().map(|x| size_of_val(*x)).sum::<usize>() + size_of_val(out);
        let factors = inputs.iter().zip(&self.sizes);
        let factors: Vec<_> =
            factors.map(|(data, &size)| Factor::new(data, size, total).piece(rows.clone())).collect();
        let (tasks, lanes, at) = self.schedule(&factors);
        let target = Target { data: &mut out[rows.start * size..rows.end * size], size, at };
        let sweep = Sweep {
            tasks,
            lanes,
            path,
            streamed: path.streams() && bytes >= STREAMED,
            least: SHARED / self.weight(),
            failed: AtomicBool::new(false),
        };
        match lanes {
            _ if rows.len() <= 8 => sweep.run::<8>(threads, &factors, target, rows.len()),
            LANES_OF_32..=MOST_LANES_OF_32 if sweep.streamed => {
                sweep.run::<32>(threads, &factors, target, rows.len());
            }
            0..=MANY_LANES => sweep.run::<64>(threads, &factors, target, rows.len()),
            _ => sweep.run::<16>(threads, &factors, target, rows.len()),
        }
        !sweep.failed.into_inner()
    }

    /// The tasks for each block of rows, the number of lanes, and the first lane of the result. Lanes are reused after the
    /// last use of their value, but for values common to all rows.
    fn schedule(&self, factors: &[Factor<f64>]) -> (Vec<Task<'_>>, usize, usize) {
        let mut last = vec![None; self.nodes.len()];
        last[self.result] = Some(usize::MAX);
        for (number, node) in self.nodes.iter().enumerate().rev() {
            if last[number].is_some() {
                node.operands.iter().for_each(|&operand| last[operand] = last[operand].max(Some(number)));
            }
        }
        let mut common: Vec<bool> = Vec::new();
        for node in &self.nodes {
            common.push(match node.work {
                Work::Read(input) => factors[input].one,
                _ => node.operands.iter().all(|&operand| common[operand]),
            });
        }
        let (mut lanes, mut tasks) = (Lanes::default(), Vec::new());
        let mut places = vec![0..0; self.nodes.len()];
        // Values common to all rows come first: no other task of a later block may write to their lanes.
        let (first, rest): (Vec<_>, Vec<_>) = (0..self.nodes.len())
            .filter(|&number| last[number].is_some())
            .partition(|&number| common[number]);
        for number in first.into_iter().chain(rest) {
            let node = &self.nodes[number];
            let to = lanes.take(node.size);
            places[number] = to.clone();
            let place = |k: usize| node.operands.get(k).map_or(0..0, |&operand| places[operand].clone());
            tasks.push(Task { node, operands: [place(0), place(1)], to, common: common[number] });
            for (k, &operand) in node.operands.iter().enumerate() {
                let again = node.operands[..k].contains(&operand);
                if last[operand] == Some(number) && !common[operand] && !again {
                    lanes.free(places[operand].clone());
                }
            }
        }
        (tasks, lanes.count(), places[self.result].start)
    }
}

impl Builder<'_> {
    fn push(&mut self, work: Work, operands: &[usize], size: usize) -> usize {
        self.nodes.push(Node { work, operands: operands.to_vec(), size });
        self.nodes.len() - 1
    }

    fn grades(&self, id: Id) -> Grades {
        self.program.steps[id].ty.grades
    }

    fn size(&self, grades: Grades) -> usize {
        grades.indices(self.algebra).len()
    }

    /// The sign that reversal gives to a basis element.
    fn reversed(&self, index: usize) -> f64 {
        if self.algebra.blades()[index].grade() % 4 < 2 { 1.0 } else { -1.0 }
    }

    fn step(&mut self, step: &Step) -> Option<usize> {
        let grades = step.ty.grades;
        let size = self.size(grades);
        Some(match step.op {
            Op::Input(input) => self.push(Work::Read(input), &[], size),
            Op::Constant(number, index) => {
                let component = |k: usize| if k == index { number.value } else { 0.0 };
                let constant = grades.indices(self.algebra).into_iter().map(component).collect();
                self.push(Work::Constant(constant), &[], size)
            }
            Op::Pi => self.push(Work::Constant(vec![PI]), &[], 1),
            Op::Add(a, b) => self.sum(a, b, 1.0, grades),
            Op::Subtract(a, b) => self.sum(a, b, -1.0, grades),
            Op::Negate(a) => self.selected(self.places[a], self.grades(a), grades, |_| -1.0),
            Op::Part(a) => self.selected(self.places[a], self.grades(a), grades, |_| 1.0),
            Op::Reverse(a) => {
                let signs: Vec<f64> = (0..self.algebra.blades().len()).map(|k| self.reversed(k)).collect();
                self.selected(self.places[a], self.grades(a), grades, |k| signs[k])
            }
            Op::Product(product, a, b) => {
                let plan = Plan::new(self.algebra, product, self.grades(a), self.grades(b));
                self.terms += plan.terms.len();
                if self.terms > MAX_TERMS {
                    return None;
                }
                if matches!(plan.engine, Engine::Terms) {
                    return Some(self.product(plan.part(self.algebra, grades), [a, b]));
                }
                // Of a full product all is computed: a part, by terms, would round otherwise.
                let all = plan.grades;
                let product =
                    self.push(Work::Product(plan), &[self.places[a], self.places[b]], self.size(all));
                if all == grades { product } else { self.selected(product, all, grades, |_| 1.0) }
            }
            Op::Divide(a, s) => self.push(Work::Divide, &[self.places[a], self.places[s]], size),
            _ => return None,
        })
    }

    fn sum(&mut self, a: Id, b: Id, sign: f64, grades: Grades) -> usize {
        let held = [a, b].map(|id| self.grades(id).indices(self.algebra));
        let indices = grades.indices(self.algebra);
        let places = indices.iter().map(|k| held.each_ref().map(|held| held.binary_search(k).ok())).collect();
        self.push(Work::Sum(Sum { places, sign }), &[self.places[a], self.places[b]], indices.len())
    }

    /// Components of a value with signs; zeros for those that it lacks.
    fn selected(&mut self, node: usize, of: Grades, grades: Grades, sign: impl Fn(usize) -> f64) -> usize {
        let (held, indices) = (of.indices(self.algebra), grades.indices(self.algebra));
        let places: Vec<_> = indices.iter().map(|k| Some((sign(*k), held.binary_search(k).ok()?))).collect();
        let size = places.len();
        self.push(Work::Selection(Selection { places, start: -0.0 }), &[node], size)
    }

    /// A product by terms; a reversed factor is multiplied as it is, with the signs in the terms.
    fn product(&mut self, mut plan: Plan, factors: [Id; 2]) -> usize {
        let mut operands = factors.map(|id| self.places[id]);
        for (k, id) in factors.into_iter().enumerate() {
            if let Op::Reverse(x) = self.program.steps[id].op {
                operands[k] = self.places[x];
                let indices = self.grades(id).indices(self.algebra);
                for term in &mut plan.terms {
                    let component = if k == 0 { term.a } else { term.b };
                    if self.reversed(indices[component]) < 0.0 {
                        term.sign = -term.sign;
                    }
                }
            }
        }
        let size = plan.sizes.2;
        self.push(Work::Product(plan.recognised()), &operands, size)
    }
}

/// A sweep over all rows.
struct Sweep<'a> {
    tasks: Vec<Task<'a>>,
    lanes: usize,
    path: Path,
    streamed: bool,
    /// The least number of rows for a thread.
    least: usize,
    failed: AtomicBool,
}

impl Sweep<'_> {
    fn run<const W: usize>(
        &self,
        threads: Threads,
        factors: &[Factor<f64>],
        mut target: Target<f64>,
        total: usize,
    ) {
        let pieces = threads.ranges(total, self.least).map(|rows| {
            let piece = target.split_off(rows.len());
            (rows, piece)
        });
        for_each(pieces, |(rows, target)| {
            let factors: Vec<_> = factors.iter().map(|factor| factor.piece(rows.clone())).collect();
            self.piece::<W>(&factors, target, rows.len());
        });
    }

    fn piece<const W: usize>(&self, factors: &[Factor<f64>], target: Target<f64>, total: usize) {
        // Lanes beyond the last rows are computed too.
        let mut lanes = vec![Lane::<W>::filled(1.0); self.lanes];
        by_blocks((self.path, self.streamed), total, &mut lanes, &mut [target], |first, count, lanes| {
            for task in self.tasks.iter().filter(|task| first == 0 || !task.common) {
                let (a, b, out) = apart(lanes, &task.operands, &task.to);
                match &task.node.work {
                    Work::Read(input) => factors[*input].load(self.path, first, count, out),
                    Work::Constant(numbers) => {
                        out.iter_mut().zip(numbers).for_each(|(lane, &x)| *lane = Lane::filled(x));
                    }
                    Work::Sum(sum) => self.path.apply(sum, a, b, out),
                    Work::Selection(selection) => self.path.apply(selection, a, b, out),
                    Work::Product(plan) => match &plan.engine {
                        Engine::Tiles(tiles) => self.path.apply(tiles, a, b, out),
                        _ => self.path.apply(plan, a, b, out),
                    },
                    Work::Divide => {
                        self.path.apply(&Divide, a, b, out);
                        if b[0].0[..count].contains(&0.0) {
                            self.failed.store(true, Ordering::Relaxed);
                            return ControlFlow::Break(());
                        }
                    }
                }
            }
            ControlFlow::Continue(())
        });
    }
}

#[cfg(test)]
mod tests;
