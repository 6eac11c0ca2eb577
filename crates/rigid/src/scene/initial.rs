//! The table `[initial]`: the initial state.

use super::formulas;
use super::reader::{Form, Reader, Table, Value};
use crate::state::center::Center;
use crate::units::Quantity;
use polhode_ga::product::Grades;
use polhode_ga::{Bivector, MathError, Rotor, Vector};
use std::borrow::Cow;
use toml::de::DeValue;

/// The axes of a spin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpinFrame {
    /// Body axes.
    Body,
    /// Space axes.
    Space,
}

const ATTITUDES: [Form; 4] = [
    Form { field: "plane", with: &[&["angle"]] },
    Form { field: "rotor", with: &[] },
    Form { field: "quaternion", with: &[&["order"]] },
    Form { field: "rotation_vector", with: &[] },
];

const SPINS: [Form; 4] = [
    Form { field: "plane", with: &[&["rate"]] },
    Form { field: "vector", with: &[] },
    Form { field: "bivector", with: &[] },
    Form { field: "formula", with: &[] },
];

/// The initial state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Initial {
    /// The rotor that carries body axes to space axes.
    pub attitude: Rotor,
    /// The angular velocity in rad/s, in the axes of `spin_frame`.
    pub spin: Bivector,
    /// The axes of `spin`.
    pub spin_frame: SpinFrame,
    /// The centre of mass, or the fixed point if there is one, in space.
    pub center: Center,
    /// The initial time in s.
    pub time: f64,
}

/// The attitude, the spin and the centre of mass.
pub fn read(reader: &mut Reader, table: &Table) -> Option<Initial> {
    reader.only(table, &["attitude", "spin", "position", "velocity", "time"]);
    let attitude = reader.optional(table, "attitude", |reader, value| attitude(reader, value, "`attitude`"));
    let spin = reader.field(table, "spin", |reader, value| {
        if let DeValue::String(_) = value.get_ref() {
            return Some((bivector(reader, value)?, SpinFrame::Body));
        }
        let table = reader.table(value, "`spin`")?;
        spin(reader, &table)
    });
    let mut place = |name, quantity| {
        reader.optional(table, name, |reader, value| formulas::vector(reader, value, quantity))
    };
    let (position, velocity) = (place("position", Quantity::Length), place("velocity", Quantity::Speed));
    let time = reader.optional(table, "time", |reader, value| reader.quantity(value, Quantity::Time));
    let (spin, spin_frame) = spin?;
    Some(Initial {
        attitude: attitude?.unwrap_or(Rotor::IDENTITY),
        spin,
        spin_frame,
        center: Center { position: position?.unwrap_or_default(), velocity: velocity?.unwrap_or_default() },
        time: time?.unwrap_or(0.0),
    })
}

/// An attitude in any of its forms; `title` names its table in messages.
pub fn attitude(reader: &mut Reader, value: &Value, title: impl Into<Cow<'static, str>>) -> Option<Rotor> {
    if let DeValue::String(_) = value.get_ref() {
        let components = formulas::components(reader, value, Grades::EVEN, "a rotor")?;
        return checked(reader, value, Rotor::from_components(components));
    }
    let table = &reader.table(value, title)?;
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
    checked(reader, value, rotor)
}

fn checked(reader: &mut Reader, value: &Value, rotor: Result<Rotor, MathError>) -> Option<Rotor> {
    rotor.map_err(|error| reader.report(value.span(), error.to_string())).ok()
}

/// The bivector value of a formula.
fn bivector(reader: &mut Reader, value: &Value) -> Option<Bivector> {
    formulas::components(reader, value, Grades::BIVECTOR, "a bivector").map(Bivector)
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
        "bivector" => Bivector(reader.quantities(value, Quantity::AngularRate)?),
        _ => bivector(reader, value)?,
    };
    let frame = match frame? {
        Some("space") => SpinFrame::Space,
        _ => SpinFrame::Body,
    };
    Some((spin, frame))
}

/// A plane as a unit bivector: `"e1e2"`, `"-e2∧e3"` or any other formula, or three numbers (e2e3, e3e1, e1e2).
fn plane(reader: &mut Reader, value: &Value) -> Option<Bivector> {
    let components = match value.get_ref() {
        DeValue::String(_) => bivector(reader, value)?.0,
        DeValue::Array(_) => reader.numbers(value)?,
        _ => {
            let message = "expected a plane as a string or an array, such as `\"e1e2\"` or `[0, 0, 1]`";
            reader.report(value.span(), message);
            return None;
        }
    };
    let plane = unit(components);
    if plane.is_none() {
        reader.report(
            value.span(),
            "a zero bivector does not define a plane, expected one such as `\"e1e2\"` or `[0, 0, 1]`",
        );
    }
    plane
}

/// The unit bivector of finite components; scaled first to avoid overflow.
fn unit(components: [f64; 3]) -> Option<Bivector> {
    let largest = components.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let scaled = Bivector(components.map(|x| x / largest));
    (largest > 0.0).then(|| scaled / scaled.norm())
}
