//! Laws that are formulas: `-c ∧ (~R e3 R)`.
//!
//! A formula is read, compiled and checked once, when the law is made: its value must be a bivector by the
//! grades of what it is made of. Then it is run like any formula on single values, on what the motion gives
//! for its names.

use super::{Dependence, TorqueError};
use crate::phase::{Gyrostat, Phase};
use polhode_ga::formula::{
    Error, Given, Input, Meaning, Names, Program, Runner, Space, Span, Type, compile, parse,
};
use polhode_ga::product::Grades;
use polhode_ga::{Bivector, Graded, Rotor};
use std::array::from_fn;
use std::cell::RefCell;
use std::fmt;
use std::sync::Arc;

/// The axes of a torque that is given by its components, or by a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// Those of the body.
    Body,
    /// Those of space.
    Space,
}

/// What the motion gives to a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Motion {
    Rotor,
    Time,
    OmegaBody,
    OmegaSpace,
    MomentumBody,
    MomentumSpace,
    Inertia,
}

/// Where an input comes from.
#[derive(Clone, Copy, Debug)]
enum Source {
    Motion(Motion),
    Known(Given),
}

/// A law that is a formula.
#[derive(Clone)]
pub struct FormulaTorque {
    compiled: Arc<Compiled>,
    /// From the axes of the motion to those of the body.
    frame: Rotor,
}

struct Compiled {
    text: String,
    axes: Axes,
    program: Program,
    runner: Runner,
    sources: Vec<Source>,
    /// The step that is the torque.
    result: usize,
}

/// The names that the motion gives; `Ω` is the angular velocity in the axes of the law.
fn given(axes: Axes) -> [(&'static str, Motion); 11] {
    let own = match axes {
        Axes::Body => Motion::OmegaBody,
        Axes::Space => Motion::OmegaSpace,
    };
    [
        ("R", Motion::Rotor),
        ("t", Motion::Time),
        ("Ω", own),
        ("Ω_B", Motion::OmegaBody),
        ("Ω_S", Motion::OmegaSpace),
        ("Omega", own),
        ("Omega_B", Motion::OmegaBody),
        ("Omega_S", Motion::OmegaSpace),
        ("L", Motion::MomentumSpace),
        ("L_B", Motion::MomentumBody),
        ("I", Motion::Inertia),
    ]
}

/// The names that the motion gives to a formula.
pub fn given_names() -> impl Iterator<Item = &'static str> {
    given(Axes::Body).into_iter().map(|(name, _)| name)
}

impl Motion {
    fn meaning(self) -> Meaning {
        match self {
            Motion::Rotor => Meaning::Value(Type::ROTOR),
            Motion::Time => Meaning::Value(Type::SCALAR),
            Motion::Inertia => Meaning::Map { grade: 2 },
            _ => Meaning::Value(Type::of(Grades::BIVECTOR)),
        }
    }

    /// Whether it changes with the rate of turning, at a given attitude and time.
    fn is_rate(self) -> bool {
        !matches!(self, Motion::Rotor | Motion::Time | Motion::Inertia)
    }

    /// What it is at a point of the motion in principal axes, `frame` leading from them to the body's.
    fn at(self, body: &Gyrostat, state: &Phase, frame: Rotor) -> Given {
        let bivector = |b: Bivector| Given::Value(Graded::new(&b.0, Grades::BIVECTOR).unwrap_or_default());
        match self {
            Motion::Rotor => {
                let rotor =
                    if frame == Rotor::IDENTITY { state.rotor } else { state.rotor * frame.reverse() };
                Given::Value(Graded::new(&rotor.components(), Grades::EVEN).unwrap_or_default())
            }
            Motion::Time => Given::Value(Graded::default().map(|_| state.time)),
            Motion::OmegaBody => bivector(frame.apply_bivector(body.omega(state.momentum))),
            Motion::OmegaSpace => bivector(state.rotor.apply_bivector(body.omega(state.momentum))),
            Motion::MomentumBody => bivector(frame.apply_bivector(state.momentum)),
            Motion::MomentumSpace => bivector(state.rotor.apply_bivector(state.momentum)),
            Motion::Inertia => {
                let (f, i) = (frame.to_matrix(), body.moments);
                let entry = |j: usize, k: usize| (0..3).map(|a| f[j][a] * i[a] * f[k][a]).sum();
                Given::Matrix(from_fn(|n| entry(n / 3, n % 3)))
            }
        }
    }
}

thread_local! {
    /// Memory for the inputs and the steps of a formula, so that an evaluation allocates none.
    static MEMORY: RefCell<(Vec<Given>, Vec<Graded>)> = const { RefCell::new((Vec::new(), Vec::new())) };
}

impl FormulaTorque {
    /// Reads a formula whose value is the torque in these axes.
    ///
    /// The motion gives `R` (body axes to space), `t` in s, `Ω_B` and `Ω_S` (the angular velocity, a
    /// bivector in body axes and in space, or `Omega_B` and `Omega_S`; `Ω` is that in the axes of the law),
    /// `L` and `L_B` (the momentum, that of a wheel included, in space and in body axes), and the inertia
    /// map `I(…)` of the body. All other names stand for what `names` says; `value` tells the value of an
    /// input, of the kind it asks for.
    pub fn new(
        text: &str,
        axes: Axes,
        mut names: Names,
        mut value: impl FnMut(&Input) -> Option<Given>,
    ) -> Result<FormulaTorque, Error> {
        let whole = Span { start: 0, end: text.len() };
        let wrong = |span: Span, message: String| Error { message, span };
        for (name, motion) in given(axes) {
            if names.bind(name.to_owned(), motion.meaning()).is_some() {
                let message = format!("`{name}` is given by the motion; call your value otherwise");
                return Err(wrong(whole, message));
            }
        }
        let tree = parse(text, Space::g3(), &names)?;
        let program = compile(&tree, Space::g3(), &names)?;
        if program.is_equation() {
            return Err(wrong(whole, "an equation has no value; write one side, the torque".to_owned()));
        }
        let result = program.results[0][0];
        let step = &program.steps[result];
        if step.ty.grades != Grades::BIVECTOR {
            return Err(wrong(step.span, no_torque(step.ty.grades)));
        }
        let motions = given(axes);
        let mut sources = Vec::with_capacity(program.inputs.len());
        for input in &program.inputs {
            let motion = motions.iter().find(|(name, _)| *name == input.name);
            let known = || value(input).map(Source::Known);
            let source = motion.map(|(_, motion)| Source::Motion(*motion)).or_else(known);
            sources.push(source.ok_or_else(|| wrong(whole, format!("`{}` has no value", input.name)))?);
        }
        let runner =
            Runner::new(&program).ok_or_else(|| wrong(whole, "no formula of 3-d space".to_owned()))?;
        let compiled = Compiled { text: text.to_owned(), axes, program, runner, sources, result };
        Ok(FormulaTorque { compiled: Arc::new(compiled), frame: Rotor::IDENTITY })
    }

    /// The formula as it was given.
    pub fn text(&self) -> &str {
        &self.compiled.text
    }

    /// The axes of its value.
    pub fn axes(&self) -> Axes {
        self.compiled.axes
    }

    /// The names in it that the motion does not give, with their values.
    pub fn known(&self) -> impl Iterator<Item = (&str, Given)> {
        let Compiled { program, sources, .. } = &*self.compiled;
        program.inputs.iter().zip(sources).filter_map(|(input, source)| match source {
            Source::Known(given) => Some((input.name.as_str(), *given)),
            Source::Motion(_) => None,
        })
    }

    pub(super) fn in_axes(self, frame: Rotor) -> FormulaTorque {
        FormulaTorque { compiled: self.compiled, frame: self.frame * frame }
    }

    fn needs(&self, what: impl Fn(Motion) -> bool) -> bool {
        self.compiled.sources.iter().any(|source| matches!(source, Source::Motion(motion) if what(*motion)))
    }

    pub(super) fn needs_time(&self) -> bool {
        self.needs(|motion| motion == Motion::Time)
    }

    pub(super) fn dependence(&self) -> Dependence {
        if self.needs(Motion::is_rate) { Dependence::Rate } else { Dependence::Attitude }
    }

    pub(super) fn value(&self, body: &Gyrostat, state: &Phase) -> Result<Bivector, TorqueError> {
        let Compiled { axes, runner, sources, result, .. } = &*self.compiled;
        MEMORY.with_borrow_mut(|(inputs, values)| {
            inputs.clear();
            inputs.extend(sources.iter().map(|source| match source {
                Source::Motion(motion) => motion.at(body, state, self.frame),
                Source::Known(given) => *given,
            }));
            if let Err((step, error)) = runner.value_to(inputs, values) {
                return Err(self.failed(step, &error.to_string()));
            }
            let &[x, y, z] = values[*result].components() else {
                return Err(self.failed(*result, "no bivector"));
            };
            if !(x.is_finite() && y.is_finite() && z.is_finite()) {
                let finite = |value: &Graded| value.components().iter().all(|x| x.is_finite());
                let first = values.iter().position(|value| !finite(value)).unwrap_or(*result);
                return Err(self.failed(first, "NaN or infinite"));
            }
            let torque = Bivector([x, y, z]);
            Ok(match axes {
                Axes::Body if self.frame == Rotor::IDENTITY => torque,
                Axes::Body => self.frame.reverse().apply_bivector(torque),
                Axes::Space => state.rotor.reverse().apply_bivector(torque),
            })
        })
    }

    /// The error of a step without a value: names its part of the formula.
    fn failed(&self, step: usize, why: &str) -> TorqueError {
        let Span { start, end } = self.compiled.program.steps[step].span;
        let text = &self.compiled.text;
        let part = text.get(start..end).unwrap_or(text);
        let within = if part == text { String::new() } else { format!(" in the formula `{text}`") };
        TorqueError(format!("`{part}`{within} has no value: {why}"))
    }
}

/// Why a value of these grades is no torque, and what to do.
fn no_torque(grades: Grades) -> String {
    let listed: Vec<String> = (0..4).filter(|&k| grades.contains(k)).map(|k| k.to_string()).collect();
    let s = if listed.len() == 1 { "" } else { "s" };
    let remedy = if grades.0 == 0b0010 {
        "this is a vector; the torque with the axial vector v is the bivector `I v`"
    } else if grades.contains(2) {
        "its bivector part is `⟨…⟩_2`"
    } else {
        "such as `a∧b`, or `I v` for an axial vector v"
    };
    format!("a torque is a bivector, grade 2; this has the grade{s} {}: {remedy}", listed.join(", "))
}

impl fmt::Debug for FormulaTorque {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "FormulaTorque({:?}, {:?})", self.compiled.text, self.compiled.axes)
    }
}
