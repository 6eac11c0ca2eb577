//! Facts: named values for JSON and Python.

/// A value that JSON and Python can hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Fact {
    /// Not known, or not defined.
    None,
    /// Yes or no.
    Flag(bool),
    /// A whole number.
    Count(usize),
    /// A number in SI units.
    Number(f64),
    /// Text.
    Text(String),
    /// Values in order.
    List(Vec<Fact>),
    /// Named values.
    Table(Facts),
}

/// Values by name, in order.
pub type Facts = Vec<(&'static str, Fact)>;

/// Facts from names and values: `facts! { regime: "at rest", axis: 1 }`.
#[macro_export]
macro_rules! facts {
    ($($name:ident: $value:expr),* $(,)?) => {
        vec![$((stringify!($name), $crate::facts::Fact::from($value))),*]
    };
}

macro_rules! from {
    ($($given:ty => $variant:ident),*) => {
        $(impl From<$given> for Fact {
            fn from(value: $given) -> Fact {
                Fact::$variant(value.into())
            }
        })*
    };
}

from!(bool => Flag, usize => Count, f64 => Number, &str => Text, String => Text, Facts => Table);

impl<T: Into<Fact>> From<Option<T>> for Fact {
    fn from(value: Option<T>) -> Fact {
        value.map_or(Fact::None, Into::into)
    }
}

impl<const N: usize> From<[f64; N]> for Fact {
    fn from(row: [f64; N]) -> Fact {
        Fact::List(row.map(Fact::Number).to_vec())
    }
}

impl From<Vec<Facts>> for Fact {
    fn from(tables: Vec<Facts>) -> Fact {
        Fact::List(tables.into_iter().map(Fact::Table).collect())
    }
}
