//! Torques, forces and events that are formulas: `-c ∧ (~R e3 R)`.
//!
//! A formula is compiled and its grades are checked once. Then it is evaluated on the values that the motion defines for
//! its names.

mod motion;
pub(crate) mod side_by_side;

use motion::given;
pub(crate) use motion::{Motion, given_names};
pub(crate) use side_by_side::Formulas;

use crate::error::TorqueError;
use crate::laws::torque::lanes::seen;
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::Point;
use polhode_ga::formula::{Error, Given, Input, Names, Op, Program, Runner, Space, Span, compile, parse};
use polhode_ga::product::Grades;
use polhode_ga::simd::lanes::One;
use polhode_ga::simd::threads::Threads;
use polhode_ga::table::G3;
use polhode_ga::{Bivector, Graded, Rotor};
use std::cell::RefCell;
use std::fmt;
use std::sync::Arc;

const VECTOR: Grades = Grades(0b0010);

/// The axes of the components of a torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// Those of the body.
    Body,
    /// Those of space.
    Space,
}

/// The meaning of the value of a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A torque in these axes.
    Torque(Axes),
    /// A force in space.
    Force,
    /// A number that crosses zero at an event.
    Event,
}

/// The source of an input.
#[derive(Clone, Copy, Debug)]
enum Source {
    Motion(Motion),
    Known(Given),
}

impl Source {
    fn at(&self, point: &Point, frame: Rotor) -> Given {
        match self {
            Source::Motion(motion) => motion.at(point, frame),
            Source::Known(given) => *given,
        }
    }
}

/// A formula evaluated along a motion.
#[derive(Clone)]
pub struct Formula {
    compiled: Arc<Compiled>,
    /// For each input of the program.
    sources: Arc<[Source]>,
    /// The rotor from the axes of the motion to those of the body.
    frame: Rotor,
}

struct Compiled {
    text: String,
    purpose: Purpose,
    program: Program,
    runner: Runner,
    /// The step that is its value.
    result: usize,
}

impl Purpose {
    fn grades(self) -> Grades {
        match self {
            Purpose::Torque(_) => Grades::BIVECTOR,
            Purpose::Force => VECTOR,
            Purpose::Event => Grades::SCALAR,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Purpose::Torque(_) => "a torque",
            Purpose::Force => "a force",
            Purpose::Event => "an event's quantity",
        }
    }

    /// The error message for a value of these grades.
    fn refusal(self, grades: Grades) -> String {
        let (wanted, grade) = match self {
            Purpose::Torque(_) => ("bivector", 2),
            Purpose::Force => ("vector", 1),
            Purpose::Event => ("scalar", 0),
        };
        let listed: Vec<String> = (0..4).filter(|&k| grades.contains(k)).map(|k| k.to_string()).collect();
        let s = if listed.len() == 1 { "" } else { "s" };
        let remedy = match (self, grades) {
            (Purpose::Torque(_), VECTOR) => "the torque with the axial vector v is `I v`".to_owned(),
            (Purpose::Force, Grades::BIVECTOR) => "the axial vector of a bivector B is `-I B`".to_owned(),
            (Purpose::Force, Grades(0b1010)) => {
                "`x` is the position, a cross product `cross(a, b)`; the vector part is `⟨…⟩_1`".to_owned()
            }
            _ if grades.contains(grade) => format!("its {wanted} part is `⟨…⟩_{grade}`"),
            (Purpose::Torque(_), _) => "write `a∧b`, or `I v` for an axial vector v".to_owned(),
            (Purpose::Force, _) => "write a vector such as `-k v`".to_owned(),
            (Purpose::Event, _) => "write a component, `x·e3`, or a size, `norm(v) - 2`".to_owned(),
        };
        let listed = listed.join(", ");
        format!("{} is a {wanted}, grade {grade}; this has the grade{s} {listed}; {remedy}", self.name())
    }
}

thread_local! {
    /// Buffers for inputs and steps, so that an evaluation does not allocate.
    static MEMORY: RefCell<(Vec<Given>, Vec<Graded>)> = const { RefCell::new((Vec::new(), Vec::new())) };
}

impl Formula {
    /// Reads a formula whose value is a torque, a force or a number.
    ///
    /// The motion defines `R` (body axes to space), `t` in s, `Ω_B` and `Ω_S` (the angular velocity, a
    /// bivector in body axes and in space, or `Omega_B` and `Omega_S`; for a torque `Ω` is that in its axes),
    /// `L` and `L_B` (the momentum, that of a wheel included, in space and in body axes), the inertia
    /// map `I(…)` of the body, `x` and `v` (position and velocity of the centre of mass, vectors in space) and `m` (the
    /// mass in kg). In a torque, `x`, `v` and `m` in `names` hide those of the motion. All other names are in `names`;
    /// `value` returns the values of inputs.
    pub fn new(
        text: &str,
        purpose: Purpose,
        mut names: Names,
        mut value: impl FnMut(&Input) -> Option<Given>,
    ) -> Result<Formula, Error> {
        let whole = Span { start: 0, end: text.len() };
        let wrong = |span: Span, message: String| Error { message, span };
        let mut motions = given(purpose);
        if let Purpose::Torque(_) = purpose {
            motions.retain(|(name, motion)| {
                names.get(name).is_none() || !(motion.is_of_center() || *motion == Motion::Mass)
            });
        }
        for &(name, motion) in &motions {
            if names.bind(name.to_owned(), motion.meaning()).is_some() {
                let message = format!("`{name}` is given by the motion; rename your value");
                return Err(wrong(whole, message));
            }
        }
        let tree = parse(text, Space::g3(), &names)?;
        let program = compile(&tree, Space::g3(), &names)?;
        if program.is_equation() {
            let message = format!("an equation has no value; write one side, which is {}", purpose.name());
            return Err(wrong(whole, message));
        }
        let result = program.results[0][0];
        let step = &program.steps[result];
        if step.ty.grades != purpose.grades() {
            return Err(wrong(step.span, purpose.refusal(step.ty.grades)));
        }
        let mut sources = Vec::with_capacity(program.inputs.len());
        for input in &program.inputs {
            let motion = motions.iter().find(|(name, _)| *name == input.name);
            let known = || value(input).map(Source::Known);
            let source = motion.map(|(_, motion)| Source::Motion(*motion)).or_else(known);
            sources.push(source.ok_or_else(|| wrong(whole, format!("`{}` has no value", input.name)))?);
        }
        let runner =
            Runner::new(&program).ok_or_else(|| wrong(whole, "not a formula of 3-d space".to_owned()))?;
        let compiled = Compiled { text: text.to_owned(), purpose, program, runner, result };
        Ok(Formula { compiled: Arc::new(compiled), sources: sources.into(), frame: Rotor::IDENTITY })
    }

    /// The same compiled formula with other values, of the same kinds, for the inputs that `value` knows.
    pub fn with_values(&self, mut value: impl FnMut(&Input) -> Option<Given>) -> Formula {
        let inputs = self.compiled.program.inputs.iter().zip(&*self.sources);
        let sources = inputs.map(|(input, source)| match source {
            Source::Known(_) => value(input).map_or(*source, Source::Known),
            Source::Motion(_) => *source,
        });
        Formula { compiled: self.compiled.clone(), sources: sources.collect(), frame: self.frame }
    }

    /// The text of the formula.
    pub fn text(&self) -> &str {
        &self.compiled.text
    }

    /// The names that the motion does not define, with their values.
    pub fn known(&self) -> impl Iterator<Item = (&str, Given)> {
        self.compiled.program.inputs.iter().zip(&*self.sources).filter_map(|(input, source)| match source {
            Source::Known(given) => Some((input.name.as_str(), *given)),
            Source::Motion(_) => None,
        })
    }

    pub(crate) fn purpose(&self) -> Purpose {
        self.compiled.purpose
    }

    /// The axes of the value of a torque.
    pub fn axes(&self) -> Axes {
        if self.purpose() == Purpose::Torque(Axes::Space) { Axes::Space } else { Axes::Body }
    }

    /// The same of a body with this mass in kg; NaN leaves it unknown.
    pub(crate) fn with_mass(self, mass: f64) -> Formula {
        if mass.is_nan() || !self.needs(|motion| motion == Motion::Mass) {
            return self;
        }
        let known = |source: &Source| match source {
            Source::Motion(Motion::Mass) => Source::Known(Given::Value(Graded::default().map(|_| mass))),
            other => *other,
        };
        Formula { sources: self.sources.iter().map(known).collect(), ..self }
    }

    pub(crate) fn in_axes(self, frame: Rotor) -> Formula {
        Formula { frame: self.frame * frame, ..self }
    }

    /// Whether it needs the inertia or a momentum.
    pub(crate) fn needs_inertia(&self) -> bool {
        self.needs(|motion| matches!(motion, Motion::Inertia | Motion::MomentumBody | Motion::MomentumSpace))
    }

    /// Whether it may have kinks: a norm has one where its operand vanishes.
    pub(crate) fn has_kinks(&self) -> bool {
        self.compiled.program.steps.iter().any(|step| matches!(step.op, Op::Norm(_)))
    }

    /// Whether it depends on position or velocity of the centre of mass.
    pub(crate) fn reads_center(&self) -> bool {
        self.needs(Motion::is_of_center)
    }

    pub(crate) fn needs(&self, what: impl Fn(Motion) -> bool) -> bool {
        self.sources.iter().any(|source| matches!(source, Source::Motion(motion) if what(*motion)))
    }

    /// The value of a formula of numbers that needs no motion.
    pub(crate) fn constant(&self) -> Result<f64, TorqueError> {
        let body = Gyrostat { moments: [1.0; 3], wheel: Bivector::default() };
        let phase = Phase { rotor: Rotor::IDENTITY, momentum: Bivector::default(), time: 0.0 };
        Ok(self.value(&Point::at_rest(&body, &phase))?.components().first().copied().unwrap_or(f64::NAN))
    }

    /// The numbers of its values at other times of a point, finite; `None` if some have no value.
    pub(crate) fn numbers_at(&self, at: &Point, times: &[f64]) -> Option<Vec<f64>> {
        // In the browser one by one: rows in lanes would make the page 4 % larger.
        if cfg!(target_family = "wasm") {
            return None;
        }
        let Compiled { runner, result, program, .. } = &*self.compiled;
        let given: Vec<Given> = self.sources.iter().map(|source| source.at(at, self.frame)).collect();
        let is_time = |source: &Source| matches!(source, Source::Motion(Motion::Time));
        let inputs = self.sources.iter().zip(&given);
        let inputs = inputs.map(|(source, given)| if is_time(source) { times } else { given.numbers() });
        let size = program.steps[*result].ty.grades.indices(&G3).len();
        let mut numbers = vec![0.0; size * times.len()];
        let rows = 0..times.len();
        runner.run(Threads::ONE, &inputs.collect::<Vec<_>>(), &mut [&mut numbers], rows).ok()?;
        numbers.iter().all(|x| x.is_finite()).then_some(numbers)
    }

    /// Its value, finite, of the grades of its purpose.
    pub(crate) fn value(&self, at: &Point) -> Result<Graded, TorqueError> {
        let Compiled { runner, result, .. } = &*self.compiled;
        if at.mass.is_nan() && self.needs(|motion| motion == Motion::Mass) {
            return Err(TorqueError::new("`m` is not known: an Inertia has no mass; simulate a Body"));
        }
        MEMORY.with_borrow_mut(|(inputs, values)| {
            inputs.clear();
            inputs.extend(self.sources.iter().map(|source| source.at(at, self.frame)));
            if let Err((step, error)) = runner.value_to(inputs, values) {
                return Err(self.failed(step, &error.to_string()));
            }
            let finite = |value: &Graded| value.components().iter().all(|x| x.is_finite());
            let value = values[*result];
            if !finite(&value) {
                let first = values.iter().position(|value| !finite(value)).unwrap_or(*result);
                return Err(self.failed(first, "NaN or infinite"));
            }
            Ok(value)
        })
    }

    /// The torque in principal axes, by the three numbers of its value.
    pub(crate) fn torque(&self, rotor: Rotor, numbers: &[f64]) -> Bivector {
        let value = numbers.try_into().unwrap_or_default();
        let from = match self.axes() {
            Axes::Space => rotor,
            Axes::Body if self.frame == Rotor::IDENTITY => return Bivector(value),
            Axes::Body => self.frame,
        };
        Bivector(One::alone(seen(&One::each(from.components()), &One::each(value))))
    }

    /// The error of a step without a value, which names its part of the formula.
    fn failed(&self, step: usize, why: &str) -> TorqueError {
        let Span { start, end } = self.compiled.program.steps[step].span;
        let text = &self.compiled.text;
        let part = text.get(start..end).unwrap_or(text);
        let within = if part == text { String::new() } else { format!(" in the formula `{text}`") };
        TorqueError::undefined(format!("`{part}`{within} has no value: {why}"))
    }
}

impl fmt::Debug for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Formula({:?}, {:?})", self.compiled.text, self.compiled.purpose)
    }
}
