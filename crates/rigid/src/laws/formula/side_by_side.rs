//! Torque formulas for bodies in lanes: one program with values for each body.

use super::motion::inertia;
use super::{Axes, Compiled, Formula, Motion, Purpose, Source};
use crate::laws::forcing::Place;
use crate::laws::torque::lanes::{Three, in_lanes, reversed, seen, turned};
use crate::state::phase::Gyrostat;
use polhode_ga::Rotor;
use polhode_ga::formula::{Given, SideBySide};
use polhode_ga::simd::lanes::{Lanes, composed};
use std::sync::Arc;

/// A torque for each body.
pub(crate) struct Formulas<'f, const W: usize, const F: bool> {
    program: SideBySide<'f, W>,
    /// The inputs that change along the motion.
    motions: Vec<(usize, Motion)>,
    /// From principal axes to those of the body; `None` if they are the same for all bodies.
    frame: Option<[Lanes<W, F>; 4]>,
    in_space: bool,
    moments: Three<W, F>,
    wheel: Three<W, F>,
}

impl<'f, const W: usize, const F: bool> Formulas<'f, W, F> {
    /// `None` if the programs differ, or if a step never has a value.
    pub fn new(each: [&'f Formula; W], bodies: &[Gyrostat; W]) -> Option<Formulas<'f, W, F>> {
        let Compiled { program, runner, purpose, .. } = &*each[0].compiled;
        let sources = &each[0].sources;
        let same = |other: &Formula| {
            Arc::ptr_eq(&other.compiled, &each[0].compiled)
                || other.compiled.program == *program && other.purpose() == *purpose
        };
        if !each.iter().all(|formula| same(formula)) {
            return None;
        }
        let still = |input: usize| -> Option<[Given; W]> {
            let mut values = [Given::Determinant(0.0); W];
            for l in 0..W {
                values[l] = match each[l].sources[input] {
                    Source::Known(given) => given,
                    Source::Motion(Motion::Inertia) => inertia(&bodies[l], each[l].frame),
                    Source::Motion(_) => return None,
                };
            }
            Some(values)
        };
        let still: Vec<Option<[Given; W]>> = (0..sources.len()).map(still).collect();
        let same = |values: &[Given; W]| values.iter().all(|value| value.numbers() == values[0].numbers());
        let known: Vec<Option<Given>> =
            still.iter().map(|values| values.as_ref().filter(|v| same(v)).map(|v| v[0])).collect();
        let is_time = |source: &Source| matches!(source, Source::Motion(Motion::Time));
        let mut program = runner.side_by_side(&known, sources.iter().position(is_time))?;
        for (input, values) in still.iter().enumerate().filter_map(|(i, v)| Some((i, v.as_ref()?))) {
            for (l, value) in values.iter().enumerate() {
                let lanes = program.input(input).iter_mut();
                lanes.zip(value.numbers()).for_each(|(lane, x)| lane.0[l] = *x);
            }
        }
        let motion = |(input, source): (usize, &Source)| match source {
            Source::Motion(Motion::Inertia) | Source::Known(_) => None,
            Source::Motion(motion) => Some((input, *motion)),
        };
        let frame = || in_lanes(|l| each[l].frame.components());
        Some(Formulas {
            program,
            motions: sources.iter().enumerate().filter_map(motion).collect(),
            frame: each.iter().any(|formula| formula.frame != Rotor::IDENTITY).then(frame),
            in_space: *purpose == Purpose::Torque(Axes::Space),
            moments: in_lanes(|l| bodies[l].moments),
            wheel: in_lanes(|l| bodies[l].wheel.0),
        })
    }

    /// Announces the next times, in order.
    pub fn foresee(&mut self, times: impl Iterator<Item = f64>) {
        self.program.foresee(times);
    }

    /// The torques in principal axes; NaN or infinite for a body without one.
    #[inline(always)]
    pub fn torque(&mut self, at: &Place<W, F>) -> Three<W, F> {
        for k in 0..self.motions.len() {
            let (input, motion) = self.motions[k];
            match (motion, &self.frame) {
                (Motion::Rotor, None) => self.give(input, &at.rotor),
                (Motion::Rotor, Some(frame)) => self.give(input, &composed(&at.rotor, &reversed(frame))),
                (Motion::Time, _) => self.program.set_parameter(input, &at.time),
                (Motion::OmegaSpace, _) => self.give(input, &turned(&at.rotor, &at.omega)),
                (Motion::MomentumSpace, _) => self.give(input, &turned(&at.rotor, &self.momentum(at))),
                (Motion::MomentumBody, None) => self.give(input, &self.momentum(at)),
                (Motion::MomentumBody, Some(frame)) => self.give(input, &turned(frame, &self.momentum(at))),
                (_, None) => self.give(input, &at.omega),
                (_, Some(frame)) => self.give(input, &turned(frame, &at.omega)),
            }
        }
        self.program.run();
        let [x, y, z] = self.program.result(0) else { return [Lanes::all(f64::NAN); 3] };
        let value = [Lanes(x.0), Lanes(y.0), Lanes(z.0)];
        match (&self.frame, self.in_space) {
            (_, true) => seen(&at.rotor, &value),
            (Some(frame), false) => seen(frame, &value),
            (None, false) => value,
        }
    }

    /// Sets the numbers of an input.
    #[inline(always)]
    fn give(&mut self, input: usize, numbers: &[Lanes<W, F>]) {
        for (lane, x) in self.program.input(input).iter_mut().zip(numbers) {
            lane.0 = x.0;
        }
    }

    /// `I(Ω)` and that of wheels, in principal axes.
    #[inline(always)]
    fn momentum(&self, at: &Place<W, F>) -> Three<W, F> {
        let mut momentum = self.wheel;
        for k in 0..3 {
            momentum[k] = self.moments[k].times_plus(at.omega[k], self.wheel[k]);
        }
        momentum
    }
}
