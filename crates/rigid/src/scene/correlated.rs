//! Reads the covariances of an ensemble, one table or a list of them.

use super::covariance;
use super::ensemble::{Attitudes, Ensemble, Nominal};
use super::initial::Initial;
use super::parameters::{PARAMETERS, Parameter};
use super::reader::{Reader, Value, nearest_path};
use super::spread::{Form, Spread, WIDEST_FACTOR};
use crate::laws::registry::Limit;
use polhode_ga::diagnostic::{list, quote};
use std::ops::Range;
use toml::de::DeValue;

/// The random parameters of the body and of its start.
const OWN: [&str; 5] = ["attitude", "spin", "moments", "position", "velocity"];

/// Reads `covariance` and gives the parameters in it their distributions.
pub fn read(reader: &mut Reader, value: &Value, nominal: &Nominal, ensemble: &mut Ensemble) -> Option<()> {
    let DeValue::Array(groups) = value.get_ref() else { return one(reader, value, nominal, ensemble) };
    let read: Vec<_> = groups.iter().map(|group| one(reader, group, nominal, ensemble)).collect();
    read.into_iter().collect()
}

/// A parameter of a covariance with its distribution.
struct Given {
    name: String,
    span: Range<usize>,
    /// The standard deviations of its numbers.
    spread: Spread,
    /// How far its numbers go at most, as widths of a distribution.
    widest: Spread,
}

/// Reads one covariance, and gives its parameters their distributions.
fn one(reader: &mut Reader, value: &Value, nominal: &Nominal, ensemble: &mut Ensemble) -> Option<()> {
    let mut places = Vec::new();
    let found = covariance::read(reader, value, |reader, item, name| {
        let size = size(reader, item, name, nominal)?;
        if ensemble.varied().iter().any(|varied| varied.name == name) {
            reader.report(item.span(), format!("`{name}` has a distribution already, give only one of them"));
            return None;
        }
        places.push((name.to_owned(), size, item.span()));
        Some(size)
    })?;
    let mut first = 0;
    for (name, size, span) in places {
        let [widths, reach] = found.widths(first, size);
        first += size;
        let form = if name == "moments" { Form::Relative } else { Form::Normal };
        let spread = Spread { form, widths, alike: size == 1 };
        let given = Given { name, span, spread, widest: Spread { widths: reach, ..spread } };
        give(reader, given, nominal, ensemble)?;
    }
    ensemble.covariances.push(found);
    Some(())
}

/// The number of random numbers of a parameter.
fn size(reader: &mut Reader, item: &Value, name: &str, nominal: &Nominal) -> Option<usize> {
    if OWN.contains(&name) {
        return Some(3);
    }
    let Some(parameter) = PARAMETERS.iter().find(|parameter| parameter.name() == name) else {
        reader.report(item.span(), unknown(name));
        return None;
    };
    let Ok(known) = nominal.numbers(parameter) else {
        let place = parameter.place();
        let message = format!("a random parameter needs a value in the scene, which has no {place}");
        reader.report(item.span(), message);
        return None;
    };
    // Equal numbers of all axes stay equal.
    Some(if known.is_some_and(|(_, one)| one) { 1 } else { parameter.size })
}

/// Gives a parameter its distribution, and checks the numbers that it may draw.
fn give(reader: &mut Reader, given: Given, nominal: &Nominal, ensemble: &mut Ensemble) -> Option<()> {
    let Given { name, span, spread, widest } = given;
    let start = |vector: fn(Initial) -> [f64; 3]| nominal.initial.map_or([0.0; 3], vector);
    match name.as_str() {
        "attitude" => {
            let turned = Attitudes::turned(spread);
            ensemble.attitude = Some(turned.map_err(|message| reader.report(span, message)).ok()?);
        }
        "moments" => {
            if let Some(width) = spread.widths.into_iter().find(|width| *width > WIDEST_FACTOR) {
                let message =
                    format!("the deviation of a logarithm must be from 0 to {WIDEST_FACTOR}, found {width}");
                reader.report(span, message);
                return None;
            }
            ensemble.moments = Some(spread);
        }
        "spin" => {
            ensemble.spin = Some(spread);
            widest.check(reader, span, &start(|initial| initial.spin.0), Limit::Finite);
        }
        "position" => {
            ensemble.position = Some(spread);
            widest.check(reader, span, &start(|initial| initial.center.position.0), Limit::Finite);
        }
        "velocity" => {
            ensemble.velocity = Some(spread);
            widest.check(reader, span, &start(|initial| initial.center.velocity.0), Limit::Finite);
        }
        _ => {
            let parameter = PARAMETERS.iter().find(|parameter| parameter.name() == name)?;
            if let Ok(Some((numbers, _))) = nominal.numbers(parameter) {
                widest.check(reader, span, &numbers[..parameter.size], parameter.limit);
            }
            ensemble.parameters.push((parameter, spread));
        }
    }
    Some(())
}

/// The error for a name that is not a random parameter.
fn unknown(name: &str) -> String {
    let names: Vec<String> =
        OWN.iter().map(|name| name.to_string()).chain(PARAMETERS.iter().map(Parameter::name)).collect();
    let expected = match nearest_path(name, &names) {
        Some(near) => format!("`{near}`"),
        None => format!("{}, or one of a law such as `torque.damping`", list(&OWN)),
    };
    format!("unknown parameter {}, expected {expected}", quote(name))
}
