//! Reads a TOML tree and collects all errors with their places.

use super::definitions::Formulas;
use crate::laws::registry::{FORCES, TORQUES};
use crate::units::{self, Quantity};
use polhode_ga::diagnostic::{alternatives, list, nearest, quote};
use std::borrow::Cow;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Integers beyond 2⁵³ are not all representable as floats.
const LARGEST_INTEGER: i128 = 1 << 53;

/// A value in the file.
pub type Value<'t> = Spanned<DeValue<'t>>;

/// A table in the file; `title` is its name in messages.
#[derive(Clone)]
pub struct Table<'t> {
    pub title: Cow<'static, str>,
    pub span: Range<usize>,
    pub fields: &'t DeTable<'t>,
}

impl<'t> Table<'t> {
    pub fn get(&self, name: &str) -> Option<&'t Value<'t>> {
        self.fields.get(name)
    }

    /// The place of the name of a field.
    pub fn name_span(&self, name: &str) -> Option<Range<usize>> {
        self.fields.get_key_value(name).map(|(key, _)| key.span())
    }
}

/// One of several forms of a table: the field that selects it, and the fields that belong to it.
pub struct Form {
    pub field: &'static str,
    pub with: &'static [&'static [&'static str]],
}

impl Form {
    fn followers(&self) -> impl Iterator<Item = &'static str> {
        self.with.iter().flat_map(|group| group.iter().copied())
    }
}

/// The reader of a scene file.
#[derive(Default)]
pub struct Reader {
    /// The errors so far, with their bytes in the file.
    pub problems: Vec<(Range<usize>, String)>,
    /// The fields that unknown ones are suggested to be, with the bytes of their tables.
    suggested: Vec<(Range<usize>, String)>,
    /// The names that formulas may use.
    pub formulas: Formulas,
}

impl Reader {
    pub fn report(&mut self, span: Range<usize>, message: impl Into<String>) {
        self.problems.push((span, message.into()));
    }

    pub fn wrong_type(&mut self, value: &Value, expected: &str) {
        let found = match value.get_ref() {
            DeValue::String(_) => "a string",
            DeValue::Integer(_) => "an integer",
            DeValue::Float(_) => "a float",
            DeValue::Boolean(_) => "a boolean",
            DeValue::Datetime(_) => "a date or time",
            DeValue::Array(_) => "an array",
            DeValue::Table(_) => "a table",
        };
        self.report(value.span(), format!("expected {expected}, found {found}"));
    }

    pub fn table<'t>(
        &mut self,
        value: &'t Value<'t>,
        title: impl Into<Cow<'static, str>>,
    ) -> Option<Table<'t>> {
        let title = title.into();
        match value.get_ref() {
            DeValue::Table(fields) => Some(Table { title, span: value.span(), fields }),
            _ => {
                self.wrong_type(value, &format!("the table {title}"));
                None
            }
        }
    }

    /// Reads a field; a missing one is reported at the table.
    pub fn field<'t, T>(
        &mut self,
        table: &Table<'t>,
        name: &str,
        read: impl FnOnce(&mut Reader, &'t Value<'t>) -> Option<T>,
    ) -> Option<T> {
        let Some(value) = table.get(name) else {
            self.missing(table, &[name], format!("missing field `{name}` in {}", table.title));
            return None;
        };
        read(self, value)
    }

    /// Reports at the table that it has none of these fields, unless an unknown field is suggested to be one of them.
    pub fn missing(&mut self, table: &Table, names: &[&str], message: impl Into<String>) {
        let mut suggested = self.suggested.iter().filter(|(span, _)| *span == table.span);
        if !suggested.any(|(_, name)| names.contains(&name.as_str())) {
            self.report(table.span.clone(), message);
        }
    }

    /// Reads an optional field: `Some(None)` without it, `None` if it is wrong.
    pub fn optional<'t, T>(
        &mut self,
        table: &Table<'t>,
        name: &str,
        read: impl FnOnce(&mut Reader, &'t Value<'t>) -> Option<T>,
    ) -> Option<Option<T>> {
        match table.get(name) {
            Some(value) => read(self, value).map(Some),
            None => Some(None),
        }
    }

    /// Reports every unknown field of the table. Call it before the fields are read: see [`Reader::missing`].
    pub fn only(&mut self, table: &Table, known: &[&str]) {
        for (key, value) in table.fields.iter() {
            let name: &str = key.get_ref();
            if known.contains(&name) {
                continue;
            }
            let what = if value.get_ref().is_table() { "table" } else { "field" };
            let message = match name.split_once('.') {
                Some((table, _)) if known.contains(&table) => {
                    format!("quotes make this a single name; write {name} without quotes")
                }
                _ => {
                    let near = suggestion(name, known);
                    self.suggested.extend(near.map(|near| (table.span.clone(), near.to_owned())));
                    unknown(what, name, known)
                }
            };
            self.report(key.span(), message);
        }
    }

    /// The field that is present; reports a second one at its place.
    pub fn at_most_one(&mut self, table: &Table, names: &[&'static str]) -> Option<&'static str> {
        let span = |name: &'static str| table.name_span(name).map(|span| (span.start, span.end, name));
        let mut given: Vec<_> = names.iter().filter_map(|name| span(name)).collect();
        given.sort_unstable();
        let (&(_, _, first), others) = given.split_first()?;
        for &(start, end, name) in others {
            self.report(start..end, format!("`{name}` conflicts with `{first}`, give only one of them"));
        }
        Some(first)
    }

    /// The field that is present; reports a missing one at the table, and a second one at its place.
    pub fn exactly_one(&mut self, table: &Table, names: &[&'static str]) -> Option<&'static str> {
        let given = self.at_most_one(table, names);
        if given.is_none() {
            let message = format!("missing field in {}, expected {}", table.title, alternatives(names));
            self.missing(table, names, message);
        }
        given
    }

    /// The field that selects a form; reports fields of other forms, except `always`.
    pub fn form(&mut self, table: &Table, forms: &[Form], always: &[&'static str]) -> Option<&'static str> {
        let choices: Vec<&'static str> = forms.iter().map(|form| form.field).collect();
        let mut followers: Vec<&'static str> = forms.iter().flat_map(Form::followers).collect();
        followers.sort_unstable();
        followers.dedup();
        self.only(table, &[&choices, &followers[..], always].concat());
        let before = self.problems.len();
        let chosen = self.exactly_one(table, &choices)?;
        if self.problems.len() > before {
            return Some(chosen);
        }
        let own: Vec<&str> =
            forms.iter().filter(|form| form.field == chosen).flat_map(Form::followers).collect();
        for follower in followers.iter().filter(|follower| !own.contains(follower)) {
            self.misplaced(table, follower, chosen, &own);
        }
        Some(chosen)
    }

    /// Reports the field, if present, as one that does not belong to `owner`.
    pub fn misplaced(&mut self, table: &Table, field: &str, owner: &str, own: &[&str]) {
        let Some(span) = table.name_span(field) else { return };
        let remedy = match own {
            [] => "remove it".to_owned(),
            own => format!("fields that do: {}", list(own)),
        };
        self.report(span, format!("`{field}` does not go with `{owner}`; {remedy}"));
    }

    pub fn string<'t>(&mut self, value: &'t Value<'t>) -> Option<&'t str> {
        let text = value.get_ref().as_str();
        if text.is_none() {
            self.wrong_type(value, "a string");
        }
        text
    }

    /// One of a few words.
    pub fn word(&mut self, value: &Value, what: &str, words: &[&'static str]) -> Option<&'static str> {
        let Some(text) = value.get_ref().as_str() else {
            self.wrong_type(value, &alternatives(words));
            return None;
        };
        let found = words.iter().copied().find(|word| *word == text);
        if found.is_none() {
            self.report(value.span(), unknown(what, text, words));
        }
        found
    }

    /// A whole number.
    pub fn integer(&mut self, value: &Value) -> Option<i128> {
        self.within(value, "the integer is beyond 2^53")
    }

    /// An integer; `beyond` is the message for one that is too large.
    fn within(&mut self, value: &Value, beyond: &str) -> Option<i128> {
        let DeValue::Integer(integer) = value.get_ref() else {
            self.wrong_type(value, "a whole number");
            return None;
        };
        match i128::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(integer) if integer.abs() <= LARGEST_INTEGER => Some(integer),
            _ => {
                self.report(value.span(), beyond);
                None
            }
        }
    }

    /// A bare number.
    pub fn number(&mut self, value: &Value) -> Option<f64> {
        match value.get_ref() {
            // At most 2^53 in magnitude, so exact.
            DeValue::Integer(_) => self
                .within(value, "the integer is beyond 2^53; write it with a decimal point")
                .map(|integer| integer as f64),
            DeValue::Float(float) => {
                let number = float.as_str().parse().ok().filter(|x: &f64| x.is_finite());
                if number.is_none() {
                    self.report(value.span(), format!("{} is not a finite number", quote(float.as_str())));
                }
                number
            }
            _ => {
                self.wrong_type(value, "a number");
                None
            }
        }
    }

    /// A bare number in SI units or a string with a unit.
    pub fn quantity(&mut self, value: &Value, expected: Quantity) -> Option<f64> {
        match value.get_ref() {
            DeValue::Integer(_) | DeValue::Float(_) => self.number(value),
            DeValue::String(text) => {
                let number = units::parse(text, expected);
                number.map_err(|error| self.report(value.span(), error)).ok()
            }
            _ => {
                self.wrong_type(value, &format!("{expected} such as `\"{}\"`", expected.example()));
                None
            }
        }
    }

    /// A positive quantity.
    pub fn positive(&mut self, value: &Value, expected: Quantity) -> Option<f64> {
        let number = self.quantity(value, expected)?;
        self.check_positive(value, number)
    }

    /// Reports a number that is not positive.
    pub fn check_positive(&mut self, value: &Value, number: f64) -> Option<f64> {
        if number <= 0.0 {
            self.report(value.span(), format!("must be more than 0, found {number}"));
            return None;
        }
        Some(number)
    }

    /// An array of N items.
    pub fn array<const N: usize, T: Copy + Default>(
        &mut self,
        value: &Value,
        what: &str,
        mut read: impl FnMut(&mut Reader, &Value) -> Option<T>,
    ) -> Option<[T; N]> {
        let Some(items) = value.get_ref().as_array() else {
            self.wrong_type(value, &format!("an array of {N} {what}"));
            return None;
        };
        if items.len() != N {
            self.report(value.span(), format!("expected {N} {what}, found {}", items.len()));
            return None;
        }
        let mut array = [T::default(); N];
        let mut complete = true;
        for (slot, item) in array.iter_mut().zip(items.iter()) {
            match read(self, item) {
                Some(found) => *slot = found,
                None => complete = false,
            }
        }
        complete.then_some(array)
    }

    /// An array of any length.
    pub fn list<T>(
        &mut self,
        value: &Value,
        what: &str,
        mut read: impl FnMut(&mut Reader, &Value) -> Option<T>,
    ) -> Option<Vec<T>> {
        let Some(items) = value.get_ref().as_array() else {
            self.wrong_type(value, &format!("an array of {what}"));
            return None;
        };
        // Read all items, so that all errors are reported.
        let read: Vec<Option<T>> = items.iter().map(|item| read(self, item)).collect();
        read.into_iter().collect()
    }

    /// An array of N bare numbers.
    pub fn numbers<const N: usize>(&mut self, value: &Value) -> Option<[f64; N]> {
        self.array(value, "numbers", |reader, item| reader.number(item))
    }

    /// An array of N quantities of one kind.
    pub fn quantities<const N: usize>(&mut self, value: &Value, expected: Quantity) -> Option<[f64; N]> {
        self.array(value, "numbers", |reader, item| reader.quantity(item, expected))
    }
}

/// Words of other programs and text books for names of a scene.
const OTHER_WORDS: [(&str, &str); 17] = [
    ("omega", "spin"),
    ("angular_velocity", "spin"),
    ("angular_rate", "spin"),
    ("rates", "spin"),
    ("orientation", "attitude"),
    ("quaternion", "attitude"),
    ("dt", "interval"),
    ("end", "duration"),
    ("t_end", "duration"),
    ("tmax", "duration"),
    ("com", "center_of_mass"),
    ("principal_moments", "moments"),
    ("dimensions", "lengths"),
    ("size", "lengths"),
    ("rk45", "dop853"),
    ("cube", "box"),
    ("cuboid", "box"),
];

/// `` unknown field `x` `` and the known name that is probably meant.
fn unknown(what: &str, name: &str, known: &[&str]) -> String {
    let expected = suggestion(name, known).map_or_else(|| alternatives(known), |near| format!("`{near}`"));
    format!("unknown {what} {}, expected {expected}", quote(name))
}

/// The known name that is probably meant. Laws are known by their labels too.
fn suggestion<'k>(name: &str, known: &[&'k str]) -> Option<&'k str> {
    let word = name.to_lowercase();
    let labels =
        TORQUES.iter().map(|law| (law.label, law.name)).chain(FORCES.iter().map(|law| (law.label, law.name)));
    let labelled = labels.map(|(label, law)| (label.to_lowercase().replace(' ', "_"), law));
    let words = OTHER_WORDS.iter().map(|&(other, ours)| (other.to_owned(), ours)).chain(labelled);
    let mut same = words.filter(|(other, _)| *other == word).map(|(_, ours)| ours);
    let same = same.find_map(|ours| known.iter().copied().find(|name| *name == ours));
    same.or_else(|| nearest(name, known.iter().copied()))
}

/// The path that `name` probably means, of its own or by the end of the path: `rate` of `initial.spin.rate`.
pub fn nearest_path<'p>(name: &str, paths: &'p [String]) -> Option<&'p str> {
    let ends = |path: &'p String| {
        let starts = path.match_indices('.').map(|(at, _)| at + 1);
        starts.map(move |start| (&path[start..], path.as_str()))
    };
    let whole = paths.iter().map(|path| (path.as_str(), path.as_str()));
    let named: Vec<(&str, &str)> = whole.chain(paths.iter().flat_map(ends)).collect();
    let near = nearest(name, named.iter().map(|(end, _)| *end))?;
    named.iter().find(|(end, _)| *end == near).map(|(_, path)| *path)
}
