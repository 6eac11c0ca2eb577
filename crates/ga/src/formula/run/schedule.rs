//! Assignment of values to lanes, and the evaluation of tasks for a block of rows.

use super::single::Runner;
use super::steps::{Given, Ready, Work};
use super::tasks::{Lanes, Schedule, Task};
use crate::MathError;
use crate::formula::compile::program::Id;
use crate::graded::size;
use crate::simd::{Lane, Path, lanes};
use std::ops::Range;

/// A part of a program.
pub(crate) struct Part {
    /// For each step, whether it belongs to the part.
    pub steps: Vec<bool>,
    /// Steps outside, whose values the caller puts into lanes.
    pub given: Vec<Id>,
    /// Steps whose values are wanted.
    pub results: Vec<Id>,
}

impl Runner {
    /// Marks the steps with one value for all rows, given the inputs that have one.
    pub(crate) fn fixed(&self, one: &[bool]) -> Vec<bool> {
        let mut fixed: Vec<bool> = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            let own = match step.work {
                Work::Input(i) | Work::Map(i) => one[i],
                _ => true,
            };
            fixed.push(own && step.operands().iter().all(|&id| fixed[id]));
        }
        fixed
    }

    /// The whole program.
    pub(crate) fn whole(&self) -> Part {
        Part { steps: vec![true; self.steps.len()], given: Vec::new(), results: self.results.clone() }
    }

    /// The steps that depend on one input and otherwise only on known ones, and all other steps.
    pub(super) fn parts_by(&self, input: usize, known: &[Option<Given>]) -> [Part; 2] {
        let fixed = self.fixed(&known.iter().map(Option::is_some).collect::<Vec<_>>());
        let follow: Vec<bool> = (0..known.len()).map(|i| known[i].is_some() || i == input).collect();
        let follow = self.fixed(&follow);
        // Inputs stay where the caller sets them.
        let is_input = |id: Id| matches!(self.steps[id].work, Work::Input(_));
        let own = |id: Id| follow[id] && !fixed[id] && !is_input(id);
        let [mut inside, mut outside] = [vec![false; self.steps.len()], vec![false; self.steps.len()]];
        for (id, step) in self.steps.iter().enumerate() {
            let used = if own(id) { &mut inside } else { &mut outside };
            step.operands().iter().for_each(|&operand| used[operand] = true);
        }
        self.results.iter().for_each(|&id| outside[id] = true);
        let ids = || 0..self.steps.len();
        let given: Vec<Id> = ids().filter(|&id| own(id) && (outside[id] || !inside[id])).collect();
        let others = ids().map(|id| !own(id)).collect();
        [
            Part { steps: follow, given: Vec::new(), results: given.clone() },
            Part { steps: others, given, results: self.results.clone() },
        ]
    }

    /// Lanes for the values of steps, and for inputs that are maps; `known` are the inputs that are the same for all rows.
    /// Lanes are reused after the last use of their value, so that all stay in the first-level cache. Fails if a step that
    /// depends only on known inputs has no value.
    ///
    /// With `stay` the other inputs have lanes of their own, filled by the caller; tasks only read those that are results.
    pub(crate) fn schedule(
        &self,
        known: &[Option<Given>],
        stay: bool,
        part: &Part,
    ) -> Result<Schedule, (Id, MathError)> {
        let fixed = self.fixed(&known.iter().map(Option::is_some).collect::<Vec<_>>());
        let given = |i: usize| known[i].unwrap_or(Given::Determinant(f64::NAN));
        let values = self.values(given, |id| fixed[id])?;
        let computed = |id: Id| part.steps[id] && !fixed[id];
        let (mut last, mut uses) = (vec![0; self.steps.len()], vec![0; self.steps.len()]);
        for (id, step) in self.steps.iter().enumerate().filter(|(id, _)| computed(*id)) {
            for &operand in step.operands() {
                last[operand] = id;
                uses[operand] += 1;
            }
        }
        part.results.iter().chain(&part.given).for_each(|&id| last[id] = usize::MAX);
        // The inputs that are read for one step alone, which can do without lanes.
        let direct = |id: Id| match self.steps[id].work {
            Work::Input(input) if !stay && computed(id) && uses[id] == 1 => {
                self.steps.get(last[id]).is_some_and(Ready::is_short).then_some(input)
            }
            _ => None,
        };
        let direct: Vec<_> = (0..self.steps.len()).map(direct).collect();
        let mut lanes = Lanes::default();
        let mut schedule = Schedule {
            fixed: Vec::new(),
            tasks: Vec::new(),
            results: Vec::new(),
            inputs: vec![0..0; self.inputs.len()],
            given: Vec::new(),
            lanes: 0,
        };
        let mut places = vec![0..0; self.steps.len()];
        let mut of_maps = vec![0..0; self.inputs.len()];
        // Values common to all rows keep their lanes.
        for id in (0..self.steps.len()).filter(|&id| fixed[id] && last[id] > 0) {
            places[id] = lanes.take(size(self.steps[id].grades));
            schedule.fixed.push((places[id].start, values[id].components().to_vec()));
        }
        for &id in &part.given {
            places[id] = lanes.take(size(self.steps[id].grades));
            schedule.given.push(places[id].clone());
        }
        for (input, given) in known.iter().enumerate() {
            if let Some(map @ (Given::Matrix(_) | Given::Determinant(_))) = given {
                of_maps[input] = lanes.take(map.numbers().len());
                schedule.fixed.push((of_maps[input].start, map.numbers().to_vec()));
            }
        }
        if stay {
            for input in (0..known.len()).filter(|&input| known[input].is_none()) {
                schedule.inputs[input] = lanes.take(self.inputs[input].size());
                of_maps[input] = schedule.inputs[input].clone();
            }
        }
        for (id, step) in self.steps.iter().enumerate().filter(|(id, _)| computed(*id)) {
            // The reverse of a rotor that only turns back.
            if last[id] == 0 && matches!(step.work, Work::Selection(_)) {
                continue;
            }
            if let Work::Input(input) = step.work
                && stay
                && !part.results.contains(&id)
            {
                places[id] = schedule.inputs[input].clone();
                last[id] = usize::MAX;
                continue;
            }
            let mut operands = [0..0, 0..0];
            for (place, &operand) in operands.iter_mut().zip(step.operands()) {
                *place = places[operand].clone();
            }
            if let Work::Map(input) = step.work {
                if of_maps[input].is_empty() {
                    of_maps[input] = lanes.take(self.inputs[input].size());
                    let to = of_maps[input].clone();
                    schedule.tasks.push(Task::Read { input, to, direct: false });
                }
                operands[1] = of_maps[input].clone();
            }
            let to = lanes.take(size(step.grades));
            places[id] = to.clone();
            schedule.tasks.push(match step.work {
                Work::Input(input) => Task::Read { input, to, direct: direct[id].is_some() },
                _ => {
                    let mut of = step.operands().iter().map(|&operand| direct[operand]);
                    let rows = std::array::from_fn(|_| of.next().flatten());
                    Task::Do { step: id, operands, rows, to }
                }
            });
            for &operand in step.operands().iter().filter(|&&operand| last[operand] == id && !fixed[operand])
            {
                lanes.free(places[operand].clone());
            }
        }
        schedule.results = part.results.iter().map(|&id| places[id].start).collect();
        schedule.lanes = lanes.count();
        Ok(schedule)
    }

    /// Does the tasks for a block of rows, `count` of which matter; false if some row may have no value. `own` is called with
    /// each task and its number, and returns whether it did the task: it reads all inputs.
    pub(crate) fn do_all<const W: usize>(
        &self,
        tasks: &[Task],
        (path, count): (Path, usize),
        lanes: &mut [Lane<W>],
        own: impl FnMut(usize, &Task, &mut [Lane<W>]) -> bool,
    ) -> bool {
        path.run(Tasks { runner: self, tasks, path, count, lanes, own })
    }
}

/// Tasks that are compiled together for each path: calls would take longer than most steps of a few rows.
struct Tasks<'a, F, const W: usize> {
    runner: &'a Runner,
    tasks: &'a [Task],
    path: Path,
    count: usize,
    lanes: &'a mut [Lane<W>],
    own: F,
}

impl<F: FnMut(usize, &Task, &mut [Lane<W>]) -> bool, const W: usize> lanes::Work for Tasks<'_, F, W> {
    type Output = bool;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> bool {
        let Tasks { runner, tasks, path, count, lanes, mut own } = self;
        let mut known = true;
        for (number, task) in tasks.iter().enumerate() {
            if !own(number, task, lanes)
                && let Task::Do { step, operands, to, .. } = task
            {
                let step = &runner.steps[*step];
                let of = runner.steps[step.operands()[0]].grades;
                known &= step.block(path, of, count, apart(lanes, operands, to));
            }
        }
        known
    }
}

/// The lanes of two operands to read, and others to write.
#[inline(always)]
pub(super) fn apart<'a, const W: usize>(
    lanes: &'a mut [Lane<W>],
    [a, b]: &[Range<usize>; 2],
    to: &Range<usize>,
) -> (&'a [Lane<W>], &'a [Lane<W>], &'a mut [Lane<W>]) {
    let (before, rest) = lanes.split_at_mut(to.start);
    let (out, after) = rest.split_at_mut(to.len());
    let (before, after) = (&*before, &*after);
    let place = |range: &Range<usize>| {
        if range.end <= to.start {
            &before[range.clone()]
        } else {
            &after[range.start - to.end..range.end - to.end]
        }
    };
    (place(a), place(b), out)
}
