//! Random distributions of numbers about their values in a scene.

use super::reader::{Reader, Table, Value};
use crate::laws::registry::Limit;
use crate::random::{LARGEST_NORMAL, exp, normal, uniform};
use crate::units::Quantity;
use std::array::from_fn;
use std::ops::Range;
use toml::de::DeValue;

/// Maximum deviation of the logarithm of a factor: e¹⁰ is 22026.
pub const WIDEST_FACTOR: f64 = 10.0;

/// The distribution of one or three numbers about those of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The distribution.
    pub form: Form,
    /// The standard deviation or the half width of each number.
    pub widths: [f64; 3],
    /// Whether one random number is shared by all numbers.
    pub alike: bool,
}

/// The distribution of a number x of width w.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// `x + w n`, n standard normal.
    Normal,
    /// `x + w u`, u uniform in [−1, 1].
    Uniform,
    /// `x exp(w n)`, n standard normal: x keeps its sign.
    Relative,
}

/// Random numbers of a body.
pub enum Noise {
    /// Random words.
    Words([u64; 8]),
    /// Correlated normal numbers with their standard deviations.
    Normals([f64; 3]),
}

impl Noise {
    /// Standard normal numbers.
    pub fn normals<const N: usize>(&self) -> [f64; N] {
        match self {
            Noise::Words(words) => from_fn(|k| normal(words[k])),
            Noise::Normals(normals) => from_fn(|k| normals[k]),
        }
    }
}

/// The names of the distributions.
pub const FORMS: [&str; 3] = ["normal", "uniform", "relative"];

impl Form {
    /// Its name in a scene.
    pub fn name(self) -> &'static str {
        match self {
            Form::Normal => FORMS[0],
            Form::Uniform => FORMS[1],
            Form::Relative => FORMS[2],
        }
    }

    fn of(name: &str) -> Form {
        match name {
            "normal" => Form::Normal,
            "uniform" => Form::Uniform,
            _ => Form::Relative,
        }
    }
}

impl Spread {
    /// The numbers drawn from random ones.
    pub(super) fn draw(&self, numbers: [f64; 3], noise: &Noise) -> [f64; 3] {
        from_fn(|k| {
            let (x, w) = (numbers[k], self.widths[k]);
            let at = if self.alike { 0 } else { k };
            match (self.form, noise) {
                (Form::Normal, Noise::Words(words)) => x + w * normal(words[at]),
                (Form::Uniform, Noise::Words(words)) => x + w * uniform(words[at]),
                (Form::Relative, Noise::Words(words)) => x * exp(w * normal(words[at])),
                (Form::Relative, Noise::Normals(normals)) => x * exp(normals[at]),
                (_, Noise::Normals(normals)) => x + normals[at],
            }
        })
    }

    /// The smallest and the largest possible draw.
    fn reach(&self, number: f64, width: f64) -> [f64; 2] {
        match self.form {
            Form::Normal => [-1.0, 1.0].map(|side| number + side * LARGEST_NORMAL * width),
            Form::Uniform => [-1.0, 1.0].map(|side| number + side * width),
            Form::Relative => [-1.0, 1.0].map(|side| number * exp(side * LARGEST_NORMAL * width)),
        }
    }

    /// Reports draws that the limit excludes. Draws are never repeated or clipped, so that the distribution is exactly the
    /// one in the file.
    pub fn check(&self, reader: &mut Reader, span: Range<usize>, numbers: &[f64], limit: Limit) {
        if self.form == Form::Relative && numbers.iter().all(|x| *x == 0.0) {
            let message = "any multiple of 0 is 0; write `normal` or `uniform`";
            return reader.report(span, message);
        }
        for (number, width) in numbers.iter().zip(self.widths) {
            for end in self.reach(*number, width) {
                if let Some(why) = limit.refuses(end) {
                    let message = format!("may draw {end:.2e}, but it {why}; make it narrower");
                    return reader.report(span, message);
                }
            }
        }
    }
}

/// The widths that a parameter has.
#[derive(Clone, Copy)]
pub struct Shape {
    /// What a width measures, except for a factor; `None` for a pure number.
    pub quantity: Option<Quantity>,
    /// The count of numbers.
    pub size: usize,
    /// Whether a single width means one random number for all, as a factor always does.
    pub alike: bool,
}

/// The table of a distribution.
pub fn table<'t>(reader: &mut Reader, value: &'t Value<'t>, example: &str) -> Option<Table<'t>> {
    match value.get_ref() {
        DeValue::Table(fields) => Some(Table { title: "the table".into(), span: value.span(), fields }),
        _ => {
            reader.wrong_type(value, example);
            None
        }
    }
}

/// The distribution in a table without other fields.
pub fn read(reader: &mut Reader, value: &Value, forms: &[&'static str], shape: Shape) -> Option<Spread> {
    let example = format!("a table such as `{{ {} = … }}`", forms[forms.len() - 1]);
    let table = &table(reader, value, &example)?;
    let form = form(reader, table, forms, forms)?;
    field(reader, table, form, shape)
}

/// The form that is present. A missing form is reported for an empty table only: other fields are allowed, or reported
/// as unknown.
pub fn form(
    reader: &mut Reader,
    table: &Table,
    forms: &[&'static str],
    fields: &[&'static str],
) -> Option<&'static str> {
    reader.only(table, fields);
    if table.fields.is_empty() { reader.exactly_one(table, fields) } else { reader.at_most_one(table, forms) }
}

/// The distribution in this field of a table.
pub fn field(reader: &mut Reader, table: &Table, form: &'static str, shape: Shape) -> Option<Spread> {
    let value = table.get(form)?;
    let form = Form::of(form);
    let single = value.get_ref().as_array().is_none();
    let widths = match (single, shape.size) {
        (false, 3) => reader.array(value, "numbers", |reader, item| width(reader, item, form, shape))?,
        _ => [width(reader, value, form, shape)?; 3],
    };
    Some(Spread { form, widths, alike: single && (shape.alike || form == Form::Relative) })
}

fn width(reader: &mut Reader, value: &Value, form: Form, shape: Shape) -> Option<f64> {
    let quantity = if form == Form::Relative { None } else { shape.quantity };
    let number = match quantity {
        Some(quantity) => reader.quantity(value, quantity)?,
        None => reader.number(value)?,
    };
    if number < 0.0 {
        reader.report(value.span(), format!("must not be negative, found {number}"));
        return None;
    }
    if form == Form::Relative && number > WIDEST_FACTOR {
        let message =
            format!("must be from 0 to {WIDEST_FACTOR}, the deviation of a logarithm, found {number}");
        reader.report(value.span(), message);
        return None;
    }
    Some(number)
}
