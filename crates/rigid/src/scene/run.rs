//! The tables `[run]` and `[method]`: duration, output times and integrator.

use super::reader::{Reader, Table, Value};
use crate::methods::methods;
use crate::units::Quantity;
use toml::de::DeTable;

const DEFAULT_SAMPLES: usize = 1001;
const MOST_SAMPLES: usize = 10_000_000;
/// Relative tolerance of a duration that must be a whole number of intervals, as decimals are rounded.
const INTERVAL_TOLERANCE: f64 = 1e-9;

/// The duration and the output times of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// In seconds.
    pub duration: f64,
    /// The number of output times, the first and the last included.
    pub samples: usize,
    /// The second time in seconds, if later times follow in geometric progression.
    pub first: Option<f64>,
    /// The integrator.
    pub choice: Choice,
    /// The maximum relative drift of conserved quantities of a successful run.
    pub drift_bound: Option<f64>,
}

impl Run {
    /// The output times from the start, `i · duration / (samples − 1)`; or 0 and
    /// `first · (duration / first)^((i − 1) / (samples − 2))`.
    pub fn offsets(&self) -> Vec<f64> {
        let last = self.samples.saturating_sub(1).max(1);
        let even = |i: usize| i as f64 * self.duration / last as f64;
        let time = |i: usize| match self.first {
            _ if i == 0 => 0.0,
            _ if i == last => self.duration,
            None => even(i),
            Some(first) => first * (self.duration / first).powf((i - 1) as f64 / (last - 1) as f64),
        };
        (0..self.samples).map(time).collect()
    }
}

/// The choice of an integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The name of one of [`methods`], or `auto`.
    pub method: String,
    /// A fixed step in seconds.
    pub step: Option<f64>,
    /// The relative tolerance.
    pub rtol: Option<f64>,
    /// The absolute tolerance, of rotors and of rates relative to the largest.
    pub atol: Option<f64>,
    /// The maximum step in seconds.
    pub max_step: Option<f64>,
    /// The maximum number of steps of a pass.
    pub max_steps: Option<f64>,
}

fn method_names() -> Vec<&'static str> {
    std::iter::once("auto").chain(methods().map(|method| method.name())).collect()
}

/// `[run]`, and `[method]` if there is one.
pub fn read(reader: &mut Reader, table: &Table, method: Option<&Table>) -> Option<Run> {
    reader
        .only(table, &["duration", "samples", "interval", "first", "method", "step", "rtol", "drift_bound"]);
    let duration = reader.field(table, "duration", duration);
    let samples = match reader.at_most_one(table, &["samples", "interval"]) {
        Some("samples") => reader.field(table, "samples", samples),
        Some(_) => reader.field(table, "interval", |reader, value| interval(reader, value, duration)),
        None => Some(DEFAULT_SAMPLES),
    };
    let first = reader.optional(table, "first", |reader, value| first(reader, value, duration, samples));
    // Equal intervals, or a geometric progression.
    reader.at_most_one(table, &["interval", "first"]);
    let choice = choice(reader, table, method);
    let drift_bound = reader.optional(table, "drift_bound", |reader, value| {
        let bound = reader.number(value)?;
        reader.check_positive(value, bound)
    });
    Some(Run {
        duration: duration?,
        samples: samples?,
        first: first?,
        choice: choice?,
        drift_bound: drift_bound?,
    })
}

/// The fields that choose the integrator, of `[run]` or `[method]` but not both.
fn choice(reader: &mut Reader, run: &Table, method: Option<&Table>) -> Option<Choice> {
    let none = DeTable::new();
    let own = Table { title: "[method]".into(), span: run.span.clone(), fields: &none };
    let own = method.unwrap_or(&own);
    reader.only(own, &["name", "step", "rtol", "atol", "max_step", "max_steps"]);
    for (field, same) in [("name", "method"), ("step", "step"), ("rtol", "rtol")] {
        if run.get(same).is_some()
            && let Some(span) = own.name_span(field)
        {
            let message = format!("`{field}` of [method] is `{same}` of [run], give only one of them");
            reader.report(span, message);
        }
    }
    let word = |reader: &mut Reader, value: &Value| reader.word(value, "method", &method_names());
    let mut from = |table: &Table, name| reader.optional(table, name, word);
    let (name, older) = (from(own, "name"), from(run, "method"));
    let mut step = |table: &Table| {
        reader.optional(table, "step", |reader, value| reader.positive(value, Quantity::Time))
    };
    let steps = (step(own), step(run));
    let max_step = reader.optional(own, "max_step", |reader, value| reader.positive(value, Quantity::Time));
    let max_steps = reader.optional(own, "max_steps", |reader, value| {
        let count = reader.number(value)?;
        if count >= 1.0 {
            return Some(count);
        }
        reader.report(value.span(), format!("must be at least 1, found {count}"));
        None
    });
    let mut part = |table: &Table, name| reader.optional(table, name, fraction);
    let (rtol, older_rtol, atol) = (part(own, "rtol"), part(run, "rtol"), part(own, "atol"));
    Some(Choice {
        method: name?.or(older?).unwrap_or("auto").to_owned(),
        step: steps.0?.or(steps.1?),
        rtol: rtol?.or(older_rtol?),
        atol: atol?,
        max_step: max_step?,
        max_steps: max_steps?,
    })
}

fn duration(reader: &mut Reader, value: &Value) -> Option<f64> {
    let duration = reader.positive(value, Quantity::Time)?;
    if (duration * MOST_SAMPLES as f64).is_finite() {
        return Some(duration);
    }
    reader.report(value.span(), format!("a duration of {duration:e} s is too long to divide into samples"));
    None
}

fn fraction(reader: &mut Reader, value: &Value) -> Option<f64> {
    let fraction = reader.number(value)?;
    if 0.0 < fraction && fraction < 1.0 {
        return Some(fraction);
    }
    reader.report(value.span(), format!("must be between 0 and 1, such as `1e-10`, found {fraction}"));
    None
}

fn samples(reader: &mut Reader, value: &Value) -> Option<usize> {
    let samples = reader.integer(value)?;
    match usize::try_from(samples) {
        Ok(samples) if (2..=MOST_SAMPLES).contains(&samples) => Some(samples),
        _ => {
            reader.report(value.span(), format!("must be from 2 to {MOST_SAMPLES}, found {samples}"));
            None
        }
    }
}

/// The first time after 0 of a geometric progression.
fn first(reader: &mut Reader, value: &Value, duration: Option<f64>, samples: Option<usize>) -> Option<f64> {
    let first = reader.positive(value, Quantity::Time)?;
    let (duration, samples) = (duration?, samples?);
    if first >= duration {
        reader.report(value.span(), format!("must be before the end of the run after {duration} s"));
        return None;
    }
    if !(duration / first).is_finite() {
        let message = format!("is lost to rounding beside the duration of {duration} s, make it longer");
        reader.report(value.span(), message);
        return None;
    }
    if samples < 3 {
        reader.report(
            value.span(),
            format!("needs at least 3 samples (0, the first time and the end), found {samples}"),
        );
        return None;
    }
    Some(first)
}

/// The number of samples. Both ends of the run are samples, so the interval must divide the duration.
fn interval(reader: &mut Reader, value: &Value, duration: Option<f64>) -> Option<usize> {
    let interval = reader.positive(value, Quantity::Time)?;
    let duration = duration?;
    let intervals = (duration / interval).round();
    if intervals > (MOST_SAMPLES - 1) as f64 {
        let problem = format!("gives more than {MOST_SAMPLES} samples in {duration} s, make it longer");
        reader.report(value.span(), problem);
        return None;
    }
    if intervals < 1.0 || (duration / interval - intervals).abs() > INTERVAL_TOLERANCE * intervals {
        let near = intervals.max(1.0) + 1.0;
        let problem =
            format!("does not divide the duration of {duration} s, write `samples = {near}` instead");
        reader.report(value.span(), problem);
        return None;
    }
    // From 1 to MOST_SAMPLES − 1 by the tests above.
    Some(intervals as usize + 1)
}
