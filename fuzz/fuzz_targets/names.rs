//! Names that the formulas may use: one of each kind.

use polhode_ga::formula::{Meaning, Names, Space, Type, define};
use polhode_ga::product::Grades;
use std::sync::LazyLock;

pub static BOUND: LazyLock<Names> = LazyLock::new(|| {
    let vectors = ["a", "b", "x", "a∥", "f1", "f2", "f3"].map(|name| (name, Grades(0b0010)));
    let others = [("B", Grades::BIVECTOR), ("M", Grades::ALL), ("θ", Grades::SCALAR), ("a'", Grades::ALL)];
    let values = vectors.into_iter().chain(others).map(|(name, grades)| (name, Type::of(grades)));
    let values = values.chain(["R", "spin", "R(0)"].map(|name| (name, Type::ROTOR)));
    let mut names = Names::new(values.map(|(name, ty)| (name.to_owned(), Meaning::Value(ty))));
    names.bind("I".to_owned(), Meaning::Map { grade: 2 });
    names.bind("F".to_owned(), Meaning::Map { grade: 1 });
    define("c", "0.1 e3", Space::g3(), &mut names).expect("a formula");
    define("V(x)", "½ x·x + c", Space::g3(), &mut names).expect("a formula");
    names
});
