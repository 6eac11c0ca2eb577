//! The table `[initial]`: how the body stands and turns at the beginning.

use super::reader::{Form, Reader, Table, Value};
use crate::units::Quantity;
use polhode_ga::diagnostic::quote;
use polhode_ga::{Bivector, Rotor, Vector};
use toml::de::DeValue;

/// The axes in which a spin is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpinFrame {
    /// Turning with the body.
    Body,
    /// At rest.
    Space,
}

const ATTITUDES: [Form; 4] = [
    Form { field: "plane", with: &[&["angle"]] },
    Form { field: "rotor", with: &[] },
    Form { field: "quaternion", with: &[&["order"]] },
    Form { field: "rotation_vector", with: &[] },
];

const SPINS: [Form; 3] = [
    Form { field: "plane", with: &[&["rate"]] },
    Form { field: "vector", with: &[] },
    Form { field: "bivector", with: &[] },
];

/// The attitude and the spin.
pub fn read(reader: &mut Reader, table: &Table) -> Option<(Rotor, Bivector, SpinFrame)> {
    reader.only(table, &["attitude", "spin"]);
    let attitude = reader.optional(table, "attitude", |reader, value| {
        let table = reader.table(value, "`attitude`")?;
        attitude(reader, &table)
    });
    let spin = reader.field(table, "spin", |reader, value| {
        let table = reader.table(value, "`spin`")?;
        spin(reader, &table)
    });
    let (spin, frame) = spin?;
    Some((attitude?.unwrap_or(Rotor::IDENTITY), spin, frame))
}

fn attitude(reader: &mut Reader, table: &Table) -> Option<Rotor> {
    let form = reader.form(table, &ATTITUDES, &[])?;
    let value = table.get(form)?;
    let rotor = match form {
        "plane" => {
            let plane = plane(reader, value);
            let angle = reader.field(table, "angle", |reader, value| reader.quantity(value, Quantity::Angle));
            Rotor::from_plane_angle(plane?, angle?)
        }
        "rotor" => Rotor::from_components(reader.numbers(value)?),
        "quaternion" => {
            let components = reader.numbers::<4>(value);
            let orders = ["wxyz", "xyzw"];
            let order = reader.field(table, "order", |reader, value| reader.word(value, "order", &orders));
            let mut wxyz = components?;
            if order? == "xyzw" {
                wxyz.rotate_right(1);
            }
            Rotor::from_quaternion_wxyz(wxyz)
        }
        _ => Rotor::from_rotation_vector(Vector(reader.quantities(value, Quantity::Angle)?)),
    };
    rotor.map_err(|error| reader.report(value.span(), error.to_string())).ok()
}

fn spin(reader: &mut Reader, table: &Table) -> Option<(Bivector, SpinFrame)> {
    let frames = ["body", "space"];
    let frame = reader.optional(table, "frame", |reader, value| reader.word(value, "frame", &frames));
    let form = reader.form(table, &SPINS, &["frame"])?;
    let value = table.get(form)?;
    let spin = match form {
        "plane" => {
            let plane = plane(reader, value);
            let rate =
                reader.field(table, "rate", |reader, value| reader.quantity(value, Quantity::AngularRate));
            plane? * rate?
        }
        // The axial vector's dual plane has the same components.
        "vector" => Vector(reader.quantities(value, Quantity::AngularRate)?).undual(),
        _ => Bivector(reader.quantities(value, Quantity::AngularRate)?),
    };
    let frame = match frame? {
        Some("space") => SpinFrame::Space,
        _ => SpinFrame::Body,
    };
    Some((spin, frame))
}

/// A plane as a unit bivector: `"e1e2"`, `"-e2∧e3"`, or three numbers (e2e3, e3e1, e1e2).
fn plane(reader: &mut Reader, value: &Value) -> Option<Bivector> {
    let problem = match value.get_ref() {
        DeValue::String(text) => match named_plane(text) {
            Some(plane) => return Some(plane),
            None => format!("unknown plane {}", quote(text)),
        },
        DeValue::Array(_) => match unit(reader.numbers(value)?) {
            Some(plane) => return Some(plane),
            None => "a bivector of size zero spans no plane".to_owned(),
        },
        _ => "a plane is a string or an array".to_owned(),
    };
    reader.report(value.span(), format!("{problem}, expected one such as `\"e1e2\"` or `[0, 0, 1]`"));
    None
}

/// Two different basis vectors, `e1e2`, `e1∧e2` or `e1^e2`, perhaps after a minus sign.
fn named_plane(text: &str) -> Option<Bivector> {
    let compact: String = text.chars().filter(|c| *c != ' ').collect();
    let (sign, name) = match compact.strip_prefix(['-', '\u{2212}']) {
        Some(name) => (-1.0, name),
        None => (1.0, &compact[..]),
    };
    let (first, rest) = basis_vector(name)?;
    let (second, rest) = basis_vector(rest.strip_prefix(['∧', '^']).unwrap_or(rest))?;
    let plane = first.wedge(second) * sign;
    (rest.is_empty() && plane != Bivector::default()).then_some(plane)
}

/// `e1`, `e2` or `e3` at the beginning of the text.
fn basis_vector(text: &str) -> Option<(Vector, &str)> {
    ["e1", "e2", "e3"].iter().zip(0..).find_map(|(name, i)| {
        let mut vector = Vector::default();
        vector.0[i] = 1.0;
        Some((vector, text.strip_prefix(name)?))
    })
}

/// The direction of finite components; scaled first, so that no square leaves the range.
fn unit(components: [f64; 3]) -> Option<Bivector> {
    let largest = components.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let scaled = Bivector(components.map(|x| x / largest));
    (largest > 0.0).then(|| scaled / scaled.norm())
}
