//! Shape of the generated code; that it computes the formulas is tested from Python, where it is compiled.

use super::Language;
use crate::formula::{Meaning, Names, Space, Type, compile, is_function_name, parse};
use crate::general::Calculus;
use crate::product::Grades;
use crate::table::{Algebra, Signature};

const VECTOR: Type = Type { grades: Grades(0b10), unit: false };

fn written(language: Language, text: &str, names: &[(&str, Type)], space: Space) -> Result<String, String> {
    let mut bound = Names::new([]);
    names.iter().for_each(|&(name, ty)| drop(bound.bind(name.to_owned(), Meaning::Value(ty))));
    let program = compile(&parse(text, space, &bound).unwrap(), space, &bound).unwrap();
    let order: Vec<usize> = (0..program.inputs.len()).collect();
    language.code(&program, space.algebra, &order, ("f", text)).map_err(|error| error.message)
}

#[test]
fn equal_parts_occur_once_and_zeros_not_at_all() {
    let code =
        written(Language::C, "(a·b)² + (a·b) 0", &[("a", VECTOR), ("b", VECTOR)], Space::g3()).unwrap();
    assert!(
        code.ends_with(
            "double f(const double a[3], const double b[3]) {\n    \
         const double t1 = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];\n    \
         const double t2 = t1 * t1;\n    return t2;\n}\n"
        ),
        "{code}"
    );
}

#[test]
fn languages_differ_in_words() {
    let names = [("Ω_B", VECTOR), ("R'", Type::SCALAR)];
    let code = |language| written(language, "R' Ω_B", &names, Space::g3()).unwrap();
    assert!(
        code(Language::Python)
            .contains("def f(R_prime, Omega_B):\n    Omega_B = np.moveaxis(Omega_B, -1, 0)\n")
    );
    assert!(code(Language::Rust).contains("pub fn f(R_prime: f64, Omega_B: [f64; 3]) -> [f64; 3] {\n"));
    assert!(
        code(Language::Glsl)
            .contains("void f(in float R_prime, in float Omega_B[3], out float result[3]) {\n")
    );
    assert!(code(Language::C).contains("// Omega_B: grade 1, components e1, e2, e3\n"));
}

#[test]
fn what_has_no_formula_is_named() {
    let algebra = Algebra::new(Signature { p: 3, q: 0, r: 1 }).unwrap();
    let calculus = Calculus::new(&algebra);
    let space = Space::new(&algebra, &calculus);
    let bivector = [("B", Type::of(Grades::BIVECTOR))];
    let message = written(Language::C, "exp(B)", &bivector, space).unwrap_err();
    assert!(message.starts_with("`exp` of grade 2 in Cl(3,0,1) has no formula in numbers"), "{message}");
    assert!(written(Language::C, "exp(2 e12) B", &bivector, space).is_ok());
    assert!(!written(Language::C, "-⟨B B⟩_4 + B", &bivector, space).unwrap().contains("-0.0"));
    let message = written(Language::C, "B = 2 B", &bivector, space).unwrap_err();
    assert!(message.starts_with("an equation has no value"), "{message}");
}

#[test]
fn names_are_identifiers_of_all_languages() {
    for (name, free) in [
        ("turn", true),
        ("t", true),
        ("t1", false),
        ("loop", false),
        ("a__b", false),
        ("é", false),
        ("", false),
    ] {
        assert_eq!(is_function_name(name), free, "{name}");
    }
}
