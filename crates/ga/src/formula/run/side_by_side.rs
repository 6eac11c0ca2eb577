//! Programs on lanes that the caller fills repeatedly, for bodies stepped side by side.

use super::schedule::Part;
use super::single::Runner;
use super::steps::Given;
use super::tasks::{Schedule, Task};
use crate::formula::compile::program::Id;
use crate::graded::size;
use crate::simd::lanes::PerLane;
use crate::simd::lookahead::Lookahead;
use crate::simd::short::{Chain, Source};
use crate::simd::{Lane, Path};
use std::ops::Range;

/// A program with memory for `W` rows, a multiple of 8, as lanes. Steps common to all rows and times are computed once.
pub struct SideBySide<'r, const W: usize> {
    runner: &'r Runner,
    path: Path,
    schedule: Schedule,
    /// The tasks, if all of them are short.
    chain: Option<Chain<W>>,
    /// The inputs common to all rows and times.
    known: Vec<Option<Given>>,
    /// Whether each step belongs to the program, or to the part of one that does not depend on values from outside.
    steps: Vec<bool>,
    /// The steps that are results, and their lanes.
    results: Vec<(Id, Range<usize>)>,
    lanes: Vec<Lane<W>>,
    parameter: Option<Box<Parameter<'r, W>>>,
}

/// An input of one number that rows mostly share, such as the time, and the steps that depend on it alone. These are
/// computed when it changes; for announced numbers, `W` of them at once.
struct Parameter<'r, const W: usize> {
    input: usize,
    /// The steps, with numbers as rows.
    steps: SideBySide<'r, W>,
    /// The parameter to which the values of the program belong.
    now: Option<PerLane<W>>,
    /// Whether some row has no value now.
    missing: bool,
    lookahead: Lookahead,
    /// The values for these, one row after the other, of this number of components.
    values: Vec<f64>,
    count: usize,
}

impl Runner {
    /// Prepares the lanes. `known` are the inputs common to all rows and times, `parameter` an input of one number that rows
    /// mostly share; `None` if a step that depends only on known inputs has no value.
    ///
    /// # Panics
    /// If the inputs are not of their kinds and grades.
    pub fn side_by_side<const W: usize>(
        &self,
        known: &[Option<Given>],
        parameter: Option<usize>,
    ) -> Option<SideBySide<'_, W>> {
        assert_eq!(known.len(), self.inputs.len(), "an entry for each input");
        let Some(input) = parameter else { return self.part(known, self.whole()) };
        let [own, others] = self.parts_by(input, known);
        if own.results.is_empty() {
            return self.part(known, self.whole());
        }
        let count = own.results.iter().map(|&id| size(self.steps[id].grades)).sum();
        let parameter = Parameter {
            input,
            count,
            steps: self.part(known, own)?,
            now: None,
            missing: false,
            lookahead: Lookahead::default(),
            values: Vec::new(),
        };
        Some(SideBySide { parameter: Some(Box::new(parameter)), ..self.part(known, others)? })
    }

    fn part<const W: usize>(&self, known: &[Option<Given>], part: Part) -> Option<SideBySide<'_, W>> {
        let schedule = self.schedule(known, true, &part).ok()?;
        let of = |(&id, &first): (&Id, &usize)| (id, first..first + size(self.steps[id].grades));
        let path = Path::best();
        let input = |number: usize| {
            let lanes = &schedule.inputs[number];
            (Source::Lanes(lanes.start), lanes.len())
        };
        let links = self.chain(path, &schedule, input);
        Some(SideBySide {
            runner: self,
            path,
            chain: links.map(|links| Chain::new(links, schedule.lanes)),
            known: known.to_vec(),
            results: part.results.iter().zip(&schedule.results).map(of).collect(),
            steps: part.steps,
            lanes: schedule.filled(),
            schedule,
            parameter: None,
        })
    }
}

impl<const W: usize> SideBySide<'_, W> {
    /// The numbers of an input other than the parameter, to be set before evaluation; they keep their values. None of an
    /// input that is known.
    #[inline]
    pub fn input(&mut self, number: usize) -> &mut [Lane<W>] {
        &mut self.lanes[self.schedule.inputs[number].clone()]
    }

    /// Sets the parameter of all rows.
    #[inline(always)]
    pub fn set_parameter(&mut self, input: usize, numbers: &PerLane<W>) {
        self.input(input)[0].0 = numbers.all();
        if let Some(parameter) = &mut self.parameter {
            parameter.set(numbers, &self.schedule.given, &mut self.lanes);
        }
    }

    /// Announces the next values of the parameter, in order. It may take others.
    pub fn foresee(&mut self, numbers: impl Iterator<Item = f64>) {
        if let Some(parameter) = &mut self.parameter {
            parameter.foresee(numbers);
        }
    }

    /// The numbers of a result.
    #[inline]
    pub fn result(&self, number: usize) -> &[Lane<W>] {
        &self.lanes[self.results[number].1.clone()]
    }

    /// Evaluates all rows, each with the bits of [`Runner::value`]; a row with a failing step has NaN as its results.
    pub fn run(&mut self) {
        if !self.do_tasks() || self.parameter.as_ref().is_some_and(|parameter| parameter.missing) {
            (0..W).for_each(|row| self.complete(row));
        }
    }

    /// Evaluates all steps; false if some row may have no value.
    fn do_tasks(&mut self) -> bool {
        if let Some(chain) = &self.chain {
            chain.apply(&mut self.lanes);
            return true;
        }
        let Schedule { inputs, tasks, .. } = &self.schedule;
        self.runner.do_all(tasks, (self.path, W), &mut self.lanes, |task, lanes| match task {
            Task::Read { input, to, .. } => {
                lanes.copy_within(inputs[*input].clone(), to.start);
                true
            }
            Task::Do { .. } => false,
        })
    }

    /// Evaluates one row, where another one failed in its block.
    #[cold]
    fn complete(&mut self, row: usize) {
        let runner = self.runner;
        let given = |i: usize| {
            let own = || {
                let lanes = &self.lanes[self.schedule.inputs[i].clone()];
                Given::new(runner.inputs[i], |k| lanes[k].0[row])
            };
            self.known[i].unwrap_or_else(own)
        };
        let values = runner.values(given, |id| self.steps[id] || self.parameter.is_some());
        for (id, lanes) in &self.results {
            if self.schedule.fixed.iter().any(|(fixed, _)| *fixed == lanes.start) {
                // Constant lanes keep their values.
                continue;
            }
            for (k, lane) in lanes.clone().enumerate() {
                let value = values.as_ref().map_or(f64::NAN, |values| values[*id].components()[k]);
                self.lanes[lane].0[row] = value;
            }
        }
        if let Some(parameter) = &mut self.parameter {
            // A result may depend on the parameter alone.
            parameter.now = None;
        }
    }
}

impl<const W: usize> Parameter<'_, W> {
    /// Fills the lanes with the values for these numbers.
    #[inline(always)]
    fn set(&mut self, numbers: &PerLane<W>, given: &[Range<usize>], lanes: &mut [Lane<W>]) {
        if let Some(now) = &self.now
            && now.has_bits_of(numbers)
        {
            return;
        }
        self.now = Some(numbers.clone());
        if let PerLane::Common(number) = numbers
            && let Some(place) = self.lookahead.find(*number)
        {
            self.missing = false;
            let mut values = self.values[place * self.count..(place + 1) * self.count].iter();
            for range in given {
                for (lane, &x) in lanes[range.clone()].iter_mut().zip(values.by_ref()) {
                    *lane = Lane::filled(x);
                    self.missing |= x.is_nan();
                }
            }
        } else {
            self.compute(numbers, given, lanes);
        }
    }

    /// The same for numbers that were not announced.
    #[inline(never)]
    fn compute(&mut self, numbers: &PerLane<W>, given: &[Range<usize>], lanes: &mut [Lane<W>]) {
        self.steps.set_parameter(self.input, numbers);
        self.steps.run();
        self.missing = false;
        for (number, range) in given.iter().enumerate() {
            let values = self.steps.result(number);
            lanes[range.clone()].copy_from_slice(values);
            self.missing |= values.iter().any(|lane| lane.0.iter().any(|x| x.is_nan()));
        }
    }

    fn foresee(&mut self, numbers: impl Iterator<Item = f64>) {
        let Parameter { input, steps, lookahead, values, count, .. } = self;
        let numbers = lookahead.announce(numbers);
        values.resize(numbers.len() * *count, 0.0);
        for (numbers, values) in numbers.chunks(W).zip(values.chunks_mut((W * *count).max(1))) {
            let mut rows = [numbers[0]; W];
            rows[..numbers.len()].copy_from_slice(numbers);
            steps.set_parameter(*input, &PerLane::Each(rows));
            steps.run();
            let mut first = 0;
            for number in 0..steps.results.len() {
                let lanes = steps.result(number);
                for (k, lane) in lanes.iter().enumerate() {
                    for (values, &x) in values.chunks_exact_mut(*count).zip(&lane.0) {
                        values[first + k] = x;
                    }
                }
                first += lanes.len();
            }
        }
    }
}
