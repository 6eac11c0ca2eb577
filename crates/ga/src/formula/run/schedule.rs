//! Assignment of values to lanes, and the evaluation of tasks for a block of rows.

use super::single::Runner;
use super::steps::{Given, Ready, Work};
use super::tasks::{Lanes, Schedule, Task};
use crate::MathError;
use crate::formula::compile::program::Id;
use crate::graded::{Graded, size};
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
        let mut planner = Planner::new(self, part, fixed, stay);
        planner.hold_values(&values);
        planner.hold_given();
        planner.hold_maps(known);
        if stay {
            planner.hold_inputs(known);
        }
        (0..self.steps.len()).for_each(|id| planner.plan(id));
        Ok(planner.finish())
    }

    /// Does the tasks for a block of rows, `count` of which matter; false if some row may have no value. `own` is called with
    /// each task, and returns whether it did the task: it reads all inputs.
    pub(crate) fn do_all<const W: usize>(
        &self,
        tasks: &[Task],
        (path, count): (Path, usize),
        lanes: &mut [Lane<W>],
        own: impl FnMut(&Task, &mut [Lane<W>]) -> bool,
    ) -> bool {
        path.run(Tasks { runner: self, tasks, path, count, lanes, own })
    }
}

/// Plans the tasks of a part of a program, step by step.
struct Planner<'a> {
    runner: &'a Runner,
    part: &'a Part,
    /// Whether inputs keep lanes of their own.
    stay: bool,
    /// The steps with one value for all rows.
    fixed: Vec<bool>,
    /// The last step that uses the value of each step; `usize::MAX` for values that keep their lanes.
    last: Vec<Id>,
    /// The inputs that are read for one step alone, which can do without lanes.
    direct: Vec<Option<usize>>,
    lanes: Lanes,
    /// The lanes of the values of steps, and of inputs that are maps.
    places: Vec<Range<usize>>,
    maps: Vec<Range<usize>>,
    schedule: Schedule,
}

impl<'a> Planner<'a> {
    fn new(runner: &'a Runner, part: &'a Part, fixed: Vec<bool>, stay: bool) -> Planner<'a> {
        let steps = runner.steps.len();
        let (mut last, mut uses) = (vec![0; steps], vec![0; steps]);
        let computed = |id: Id| part.steps[id] && !fixed[id];
        for (id, step) in runner.steps.iter().enumerate().filter(|(id, _)| computed(*id)) {
            for &operand in step.operands() {
                last[operand] = id;
                uses[operand] += 1;
            }
        }
        part.results.iter().chain(&part.given).for_each(|&id| last[id] = usize::MAX);
        let direct = |id: Id| match runner.steps[id].work {
            Work::Input(input) if !stay && computed(id) && uses[id] == 1 => {
                runner.steps.get(last[id]).is_some_and(Ready::is_short).then_some(input)
            }
            _ => None,
        };
        let direct = (0..steps).map(direct).collect();
        let (places, maps) = (vec![0..0; steps], vec![0..0; runner.inputs.len()]);
        let schedule = Schedule { inputs: maps.clone(), ..Schedule::default() };
        Planner { runner, part, stay, fixed, last, direct, lanes: Lanes::default(), places, maps, schedule }
    }

    /// Lanes of its own for the value of a step.
    fn place(&mut self, id: Id) -> Range<usize> {
        self.places[id] = self.lanes.take(size(self.runner.steps[id].grades));
        self.places[id].clone()
    }

    /// Lanes for the values common to all rows.
    fn hold_values(&mut self, values: &[Graded]) {
        for id in (0..values.len()).filter(|&id| self.fixed[id] && self.last[id] > 0).collect::<Vec<_>>() {
            let first = self.place(id).start;
            self.schedule.fixed.push((first, values[id].components().to_vec()));
        }
    }

    /// Lanes for the values that the caller gives.
    fn hold_given(&mut self) {
        for &id in &self.part.given {
            let place = self.place(id);
            self.schedule.given.push(place);
        }
    }

    /// Lanes for the known maps.
    fn hold_maps(&mut self, known: &[Option<Given>]) {
        for (input, given) in known.iter().enumerate() {
            if let Some(map @ (Given::Matrix(_) | Given::Determinant(_))) = given {
                self.maps[input] = self.lanes.take(map.numbers().len());
                self.schedule.fixed.push((self.maps[input].start, map.numbers().to_vec()));
            }
        }
    }

    /// Lanes for the inputs that the caller fills.
    fn hold_inputs(&mut self, known: &[Option<Given>]) {
        for input in (0..known.len()).filter(|&input| known[input].is_none()) {
            let place = self.lanes.take(self.runner.inputs[input].size());
            self.schedule.inputs[input] = place.clone();
            self.maps[input] = place;
        }
    }

    /// The task of a step, if it has one.
    fn plan(&mut self, id: Id) {
        let step = &self.runner.steps[id];
        // The reverse of a rotor that only turns back is not computed.
        let is_unused = self.last[id] == 0 && matches!(step.work, Work::Selection(_));
        if !self.part.steps[id] || self.fixed[id] || is_unused {
            return;
        }
        match step.work {
            Work::Input(input) if self.stay && !self.part.results.contains(&id) => {
                self.places[id] = self.schedule.inputs[input].clone();
                self.last[id] = usize::MAX;
                return;
            }
            Work::Input(input) => {
                let (to, direct) = (self.place(id), self.direct[id].is_some());
                self.schedule.tasks.push(Task::Read { input, to, direct });
            }
            _ => self.plan_work(id),
        }
        for &operand in step.operands() {
            if self.last[operand] == id && !self.fixed[operand] {
                self.lanes.free(self.places[operand].clone());
            }
        }
    }

    /// The task of a step that is not an input.
    fn plan_work(&mut self, id: Id) {
        let step = &self.runner.steps[id];
        let (mut operands, mut rows) = ([0..0, 0..0], [None; 2]);
        for (k, &operand) in step.operands().iter().enumerate() {
            (operands[k], rows[k]) = (self.places[operand].clone(), self.direct[operand]);
        }
        if let Work::Map(input) = step.work {
            operands[1] = self.map(input);
        }
        let to = self.place(id);
        self.schedule.tasks.push(Task::Do { step: id, operands, rows, to });
    }

    /// The lanes of a map, which is read before its first use.
    fn map(&mut self, input: usize) -> Range<usize> {
        if self.maps[input].is_empty() {
            let to = self.lanes.take(self.runner.inputs[input].size());
            self.maps[input] = to.clone();
            self.schedule.tasks.push(Task::Read { input, to, direct: false });
        }
        self.maps[input].clone()
    }

    fn finish(mut self) -> Schedule {
        self.schedule.results = self.part.results.iter().map(|&id| self.places[id].start).collect();
        self.schedule.lanes = self.lanes.count();
        self.schedule
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

impl<F: FnMut(&Task, &mut [Lane<W>]) -> bool, const W: usize> lanes::Work for Tasks<'_, F, W> {
    type Output = bool;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> bool {
        let Tasks { runner, tasks, path, count, lanes, mut own } = self;
        let mut known = true;
        for task in tasks {
            if !own(task, lanes)
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
