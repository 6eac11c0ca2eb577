//! The table `[body]`.

use super::reader::{Form, Reader, Table, Value};
use crate::body::solids::{Amount, Solid};
use crate::units::{self, Quantity};
use polhode_ga::Vector;

/// The body of a scene.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum BodySpec {
    /// A closed surface in a mesh file; `length_unit` is that of its coordinates, in metres.
    Mesh { file: String, length_unit: f64, amount: Amount },
    /// A uniform solid.
    Solid { solid: Solid, amount: Amount },
    /// Principal moments about the centre of mass, in kg m².
    Moments { moments: [f64; 3], mass: Option<f64>, center_of_mass: Vector },
    /// The inertia matrix about the centre of mass in body axes, in kg m².
    Inertia { matrix: [[f64; 3]; 3], mass: Option<f64>, center_of_mass: Vector },
}

const AMOUNTS: [&str; 2] = ["density", "mass"];

/// All dimensions of solids, in metres.
const SIZES: [&str; 9] = [
    "lengths",
    "semi_axes",
    "radius",
    "outer_radius",
    "inner_radius",
    "height",
    "length",
    "major_radius",
    "minor_radius",
];

/// The solids and their dimensions.
const SOLIDS: [(&str, &[&str]); 10] = [
    ("box", &["lengths"]),
    ("ellipsoid", &["semi_axes"]),
    ("sphere", &["radius"]),
    ("hollow_sphere", &["outer_radius", "inner_radius"]),
    ("cylinder", &["radius", "height"]),
    ("cone", &["radius", "height"]),
    ("rod", &["length"]),
    ("disc", &["radius"]),
    ("torus", &["major_radius", "minor_radius"]),
    ("capsule", &["radius", "height"]),
];

const FORMS: [Form; 4] = [
    Form { field: "mesh", with: &[&["length_unit"], &AMOUNTS] },
    Form { field: "solid", with: &[&SIZES, &AMOUNTS] },
    Form { field: "moments", with: &[&["mass", "center_of_mass"]] },
    Form { field: "inertia", with: &[&["mass", "center_of_mass"]] },
];

pub fn read(reader: &mut Reader, table: &Table) -> Option<BodySpec> {
    match reader.form(table, &FORMS, &[])? {
        "mesh" => mesh(reader, table),
        "solid" => {
            let (solid, amount) = (solid(reader, table), amount(reader, table));
            Some(BodySpec::Solid { solid: solid?, amount: amount? })
        }
        "moments" => {
            let moments = reader
                .field(table, "moments", |reader, value| reader.quantities(value, Quantity::MomentOfInertia));
            let (mass, center_of_mass) = placed_mass(reader, table)?;
            Some(BodySpec::Moments { moments: moments?, mass, center_of_mass })
        }
        _ => {
            let row = |reader: &mut Reader, row: &Value| reader.quantities(row, Quantity::MomentOfInertia);
            let matrix = reader.field(table, "inertia", |reader, value| reader.array(value, "rows", row));
            let (mass, center_of_mass) = placed_mass(reader, table)?;
            Some(BodySpec::Inertia { matrix: matrix?, mass, center_of_mass })
        }
    }
}

fn mesh(reader: &mut Reader, table: &Table) -> Option<BodySpec> {
    let file = reader.field(table, "mesh", |reader, value| match reader.string(value)? {
        "" => {
            reader.report(value.span(), "expected the path of a mesh file, relative to the scene file");
            None
        }
        file => Some(file.to_owned()),
    });
    let length_unit = reader.optional(table, "length_unit", length_unit);
    let amount = amount(reader, table);
    Some(BodySpec::Mesh { file: file?, length_unit: length_unit?.unwrap_or(1.0), amount: amount? })
}

/// A unit of length, `mm`, or a length, `25.4 mm`.
fn length_unit(reader: &mut Reader, value: &Value) -> Option<f64> {
    match value.get_ref().as_str() {
        Some(name) if name.starts_with(char::is_alphabetic) => {
            let unit = units::parse_unit(name, Quantity::Length);
            unit.map_err(|error| reader.report(value.span(), error)).ok()
        }
        _ => reader.positive(value, Quantity::Length),
    }
}

fn solid(reader: &mut Reader, table: &Table) -> Option<Solid> {
    let names = SOLIDS.map(|(name, _)| name);
    let name = reader.field(table, "solid", |reader, value| reader.word(value, "solid", &names))?;
    let own = SOLIDS.iter().find(|(solid, _)| *solid == name).map_or(&[][..], |(_, sizes)| sizes);
    for size in SIZES.iter().filter(|size| !own.contains(size)) {
        reader.misplaced(table, size, name, own);
    }
    let length = |reader: &mut Reader, value: &Value| reader.positive(value, Quantity::Length);
    let lengths = match own {
        [name @ ("lengths" | "semi_axes")] => {
            let three = |reader: &mut Reader, value: &Value| reader.array::<3, _>(value, "lengths", length);
            reader.field(table, name, three)?.to_vec()
        }
        _ => {
            // Read all dimensions before returning at the first missing one, so that all errors are reported.
            let read = |name: &&str| match *name {
                // A hollow sphere may have an inner radius of 0.
                "inner_radius" => {
                    reader.field(table, name, |reader, value| reader.quantity(value, Quantity::Length))
                }
                _ => reader.field(table, name, length),
            };
            let lengths: Vec<Option<f64>> = own.iter().map(read).collect();
            lengths.into_iter().collect::<Option<_>>()?
        }
    };
    Solid::from_lengths(name, &lengths)
}

impl Solid {
    /// A solid from its name in scenes and its lengths in m, in the order of its fields; none if these do not fit.
    pub fn from_lengths(name: &str, lengths: &[f64]) -> Option<Solid> {
        Some(match (name, lengths) {
            ("box", &[x, y, z]) => Solid::Box { lengths: [x, y, z] },
            ("ellipsoid", &[x, y, z]) => Solid::Ellipsoid { semi_axes: [x, y, z] },
            ("sphere", &[radius]) => Solid::Sphere { radius },
            ("hollow_sphere", &[outer_radius, inner_radius]) => {
                Solid::HollowSphere { outer_radius, inner_radius }
            }
            ("cylinder", &[radius, height]) => Solid::Cylinder { radius, height },
            ("cone", &[radius, height]) => Solid::Cone { radius, height },
            ("rod", &[length]) => Solid::Rod { length },
            ("disc", &[radius]) => Solid::Disc { radius },
            ("torus", &[major_radius, minor_radius]) => Solid::Torus { major_radius, minor_radius },
            ("capsule", &[radius, height]) => Solid::Capsule { radius, height },
            _ => return None,
        })
    }
}

fn amount(reader: &mut Reader, table: &Table) -> Option<Amount> {
    let positive = |quantity| move |reader: &mut Reader, value: &Value| reader.positive(value, quantity);
    match reader.exactly_one(table, &AMOUNTS)? {
        "density" => reader.field(table, "density", positive(Quantity::Density)).map(Amount::Density),
        _ => reader.field(table, "mass", positive(Quantity::Mass)).map(Amount::Mass),
    }
}

/// The optional mass and centre of mass of a body given by its inertia.
fn placed_mass(reader: &mut Reader, table: &Table) -> Option<(Option<f64>, Vector)> {
    let mass = reader.optional(table, "mass", |reader, value| reader.positive(value, Quantity::Mass));
    let center =
        reader.optional(table, "center_of_mass", |reader, value| reader.quantities(value, Quantity::Length));
    Some((mass?, Vector(center?.unwrap_or_default())))
}
