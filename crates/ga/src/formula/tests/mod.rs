//! Tests of parsing, types and errors of formulas.

use super::*;

pub(super) mod build;
mod errors;
mod laws;

/// Names of every kind.
pub(super) fn names() -> Names {
    let value = |grades| Meaning::Value(Type::of(Grades(grades)));
    let mut meanings = Vec::new();
    for (grades, names) in [
        (0b0001, "α β θ t i1 i3 ω1 ω2 ω3"),
        (0b0010, "a b c v x a∥ a⊥ f1 f2 f3 f1' f2' f3' v'"),
        (0b0100, "B C Ω Ω_B Ω_B' B1 B2 B3"),
        (0b0101, "R'"),
        (0b1111, "M N"),
    ] {
        meanings.extend(names.split(' ').map(|name| (name.to_owned(), value(grades))));
    }
    for name in ["R", "R0", "S", "R(0)", "attitude"] {
        meanings.push((name.to_owned(), Meaning::Value(Type::ROTOR)));
    }
    meanings.push(("inertia".to_owned(), Meaning::Map { grade: 2 }));
    meanings.push(("F".to_owned(), Meaning::Map { grade: 1 }));
    Names::new(meanings)
}

/// What a text does.
pub(super) fn program(text: &str) -> Program {
    let (space, names) = (Space::g3(), names());
    let compiled = parse(text, space, &names).and_then(|tree| compile(&tree, space, &names));
    compiled.unwrap_or_else(|error| panic!("{}", error.shown(text)))
}

/// The type of its value.
fn ty(text: &str) -> Type {
    let program = program(text);
    program.steps[program.results[0][0]].ty
}

#[test]
fn brackets_round_a_product_that_ends_in_a_number_are_kept() {
    let names = names();
    for text in ["(x∧α) v", "(x∧2) v", "x∧α", "(x∧v²) a/2", "v x∧α", "α·β a"] {
        assert_eq!(parse(text, Space::g3(), &names).unwrap().text(Style::Unicode), text);
    }
    let latex = |text| parse(text, Space::g3(), &names).unwrap().latex();
    assert_eq!(latex("(x∧α) v"), "(x{\\wedge}\\alpha)\\,v");
    assert_eq!(latex("(x∧2) v"), "(x \\wedge 2)\\,v");
}

/// Texts that are to be the same formula, step by step.
fn same(texts: &[&str]) {
    let first = program(texts[0]);
    let plain = |mut program: Program| {
        program.steps.iter_mut().for_each(|step| step.span = Span::default());
        program
    };
    let first = plain(first);
    for text in &texts[1..] {
        assert_eq!(plain(program(text)), first, "{text} is not {}", texts[0]);
    }
}

#[test]
fn wedge_and_dot_come_before_the_geometric_product() {
    same(&["I a∧b", "I (a∧b)", "I*(a^b)", "I wedge(a, b)"]);
    same(&["2 a·b", "2 (a|b)", "2dot(a,b)", "(2 a·b)"]);
    same(&["a b∧c", "a (b∧c)", "ab∧c"]);
    same(&["-a∧b", "-(a∧b)", "−a⋀b"]);
    same(&["~a b", "(~a) b"]);
    same(&["M × N", "commutator(M, N)", "M×N"]);
    same(&["M⌋N", "left_contraction(M, N)"]);
    same(&["M⌊N", "right_contraction(M, N)"]);
    same(&["a ⨯ b", "cross(a, b)", "dual(a∧b)"]);
    same(&["a·−b", "a·(−b)"]);
    same(&["θ/2 e1∧e2", "(θ/2) (e1∧e2)", "(θ/2)*(e1∧e2)"]);
    same(&["2·3 a", "6 a"]);
    same(&["α·β a", "(α·β) a"]);
    same(&["x∧α*v", "(x∧α) v", "(x∧α)*v", "(wedge(x, α)) v"]);
    same(&["v x∧α", "v (x∧α)"]);
    same(&["α/β/2 a", "((α/β)/2) a"]);
}

#[test]
fn letters_run_together() {
    same(&["aB", "a B", "a*B"]);
    same(&["RaR̃", "R a ~R", "R a R~", "R a R†", "R a reverse(R)"]);
    same(&["½Ω_B R", "½ Ω_B R", "(1/2) Ω_B R"]);
    same(&["e1e2e3", "e1 e2 e3", "e123", "I", "e₁₂₃"]);
    same(&["e_1e_2e_3", "e_{1}e_2 e_3", "I"]);
    same(&["ω_3R", "ω3 R"]);
    same(&["R_0e^{-Bθ/2}", "R0 exp(−B θ/2)"]);
    same(&["e21", "-e12"]);
    same(&["βI", "β I"]);
    same(&["attitude a", "attitude*a"]);
    same(&["R(0) a", "(R(0)) a"]);
    same(&["M~ N", "(~M) N"]);
    same(&["M~N", "M (~N)", "M ~N"]);
    same(&["Ã", "~A"].map(|text| if text == "Ã" { "M\u{303}" } else { "~M" }));
}

#[test]
fn powers_parts_and_exponentials() {
    same(&["a²", "a^2", "a^{2}", "a^(2)", "a a"]);
    same(&["a⁻¹", "a^-1", "a^(−1)", "inverse(a)", "1/a"]);
    same(&["a^2∧b", "(a²)∧b"]);
    same(&["⟨MN⟩_2", "<M N>_2", "⟨MN⟩₂"]);
    same(&["⟨MN⟩", "⟨MN⟩_0"]);
    same(&["⟨MN⟩_{0,2}", "<MN>_{2, 0}"]);
    same(&["e^(−Bθ/2)", "exp(−B θ/2)", "e^{-Bθ/2}"]);
    same(&["e^B a", "exp(B) a"]);
    same(&["e²", "exp(2)"]);
    same(&["e3∧[(Ω_B∧e3) Ω_B]", "e3∧((Ω_B∧e3) Ω_B)"]);
}

#[test]
fn indices_are_summed_or_free() {
    same(&["Σ ω_k I e_k", "Σ_k ω_k I e_k", "ω_k I e_k", "sum_k ω_k I e_k", "ω1 I e1 + ω2 I e2 + ω3 I e3"]);
    assert_eq!(program("f_k = R e_k ~R").results.len(), 3);
    assert_eq!(program("ei ej = δij + I εijk ek").results.len(), 9);
    assert_eq!(program("B_i B_j − B_j B_i = −2 ε_ijk B_k").results.len(), 9);
    same(&["Σ_k f_k'", "f1' + f2' + f3'"]);
    // Each term of a sum has the index once: it is free.
    assert_eq!(program("(f_k + e_k) v = (e_k + f_k) v").results.len(), 3);
    // The sum is around what has the index, and nothing else.
    same(&["2(f_k·e_k + 5)", "2(Σ_k f_k·e_k + 5)"]);
    same(&["norm(ω_k e_k)", "norm(ω1 e1 + ω2 e2 + ω3 e3)"]);
    same(&["(ω_k ω_k)²", "(ω1 ω1 + ω2 ω2 + ω3 ω3)²"]);
    same(&["1/(f_k·f_k) a", "1/(Σ_k f_k·f_k) a"]);
    same(&["(f_k e_k)' + 2", "(Σ_k f_k e_k)' + 2"]);
    same(&["(ω_k f_k)·(ω_j e_j)", "(Σ_k ω_k f_k)·(Σ_j ω_j e_j)"]);
}

#[test]
fn primes_are_derivatives() {
    same(&["(~R)'", "~(R')"]);
    same(&["(R v ~R)'", "R' v ~R + R v' ~R + R v ~(R')"]);
    same(&["(2v + e1)'", "2v'"]);
    same(&["(R inertia(Ω_B) ~R)'", "R' inertia(Ω_B) ~R + R inertia(Ω_B') ~R + R inertia(Ω_B) ~(R')"]);
    same(&["(v²)'", "v'v + v v'"]);
    assert_eq!(program("f_k' = (R e_k R̃)'").results.len(), 3);
}

#[test]
fn grades_are_inferred() {
    let grades = |text| ty(text).grades.0;
    assert_eq!(grades("a∧b"), 0b0100);
    assert_eq!(grades("aB"), 0b1010);
    assert_eq!(grades("M v ~M"), 0b0011); // (M v ~M)~ = M v ~M
    assert_eq!(grades("R' v ~R'"), 0b0010);
    assert_eq!(grades("R I e3 ~R"), 0b0100);
    assert_eq!(grades("a² b"), 0b0010);
    assert_eq!(grades("a/b"), 0b0101);
    assert_eq!(grades("a/b²"), 0b0010);
    assert_eq!(grades("I/b"), 0b0100);
    assert_eq!(grades("dual(a)"), 0b0100);
    assert_eq!(grades("norm(M) a"), 0b0010);
    assert_eq!(grades("inertia(Ω)"), 0b0100);
    assert_eq!(grades("F(1 + a + B + I)"), 0b1111);
    assert_eq!(grades("cos(θ) − B sin(θ)"), 0b0101);
    assert_eq!(grades("log(R)"), 0b0100);
    assert_eq!(grades("F(I)/I"), 0b0001);
    assert_eq!(grades("e1∧e2∧e3∧a"), 0b0001); // vanishes
}

#[test]
fn rotors_stay_rotors() {
    for text in ["R S", "~R", "R^3", "R⁻¹", "exp(B)", "e^(-e1e2 θ/2)", "sqrt(R)", "R S ~R", "R(0)", "-R"]
    {
        assert!(ty(text).unit, "{text}");
    }
    for text in ["2R", "R + S", "exp(a)", "exp(M)", "R B"] {
        assert!(!ty(text).unit, "{text}");
    }
}

#[test]
fn what_is_equal_is_computed_once() {
    let count = |text| program(text).steps.len();
    assert_eq!(count("(a∧b) c + (a∧b) c"), count("(a∧b) c") + 1);
    assert_eq!(count("R v ~R"), 3); // R and v, and one turn
    assert_eq!(count("R S v ~S ~R"), 5);
    assert_eq!(count("2*3 e1e2"), 1);
}

#[test]
fn the_inertia_may_be_called_i() {
    let mut names = names();
    names.bind("I".to_owned(), Meaning::Map { grade: 2 });
    let text = "i1 Ω_B = I(Ω_B) + (i1 − i3) ω3 I e3";
    let tree = parse(text, Space::g3(), &names).unwrap();
    let program = compile(&tree, Space::g3(), &names).unwrap();
    let maps = program.steps.iter().filter(|step| matches!(step.op, Op::Map { .. })).count();
    assert_eq!(maps, 1);
}

#[test]
fn definitions_are_written_out() {
    let mut names = names();
    let space = Space::g3();
    define("V(x)", "½ x·x", space, &mut names).unwrap();
    define("d", "a + b", space, &mut names).unwrap();
    define("W(x, y)", "V(x) − V(y) + d·x", space, &mut names).unwrap();
    let compiled = |text: &str, names: &Names| compile(&parse(text, space, names)?, space, names);
    let grades = |text: &str, names: &Names| {
        let program = compiled(text, names).unwrap();
        let mut grades: Vec<u16> = program.steps.iter().map(|step| step.ty.grades.0).collect();
        grades.sort_unstable();
        grades
    };
    assert_eq!(grades("W(a, b)", &names), grades("½ a·a − ½ b·b + (a + b)·a", &names));
    // A parameter hides a name of outside while the body is read, and no longer.
    assert_eq!(grades("x", &names), [0b0010]);
    // The derivative of a parameter is not an outer name.
    define("E(v)", "(v v)'", space, &mut names).unwrap();
    define("P(v, v')", "(v v)'", space, &mut names).unwrap();
    let error = compiled("E(a)", &names).unwrap_err();
    assert!(error.message.contains("`v'`, the derivative of a parameter"), "{}", error.message);
    assert_eq!(grades("P(a, b)", &names), grades("b a + a b", &names));
    for (head, body) in
        [("f(y)", "f(y)"), ("V(x)", "W(x, x)"), ("2", "a"), ("f(x, x)", "x"), ("f(", "a"), ("g", "a = b")]
    {
        assert!(define(head, body, space, &mut names).is_err(), "{head} = {body}");
    }
}

#[test]
fn names_may_be_open() {
    let names = Names::open();
    let compiled =
        |text: &str| parse(text, Space::g3(), &names).and_then(|tree| compile(&tree, Space::g3(), &names));
    let inputs = |text: &str| -> Vec<String> {
        compiled(text).unwrap().inputs.into_iter().map(|input| input.name).collect()
    };
    assert_eq!(inputs("R v ~R + (a∧b)·c"), ["R", "v", "a", "b", "c"]);
    assert_eq!(inputs("inertia(Ω) e1e2 + aB"), ["Ω", "inertia", "aB"]);
    assert_eq!(inputs("Σ_k ω_k e_k"), ["ω1", "ω2", "ω3"]);
    assert_eq!(inputs("xₙΩ\u{307}"), ["x_n", "Ω\u{307}"]);
    assert_eq!(inputs("ωₖΩ + Ωₛx"), ["ω_k", "Ω", "Ω_s", "x"]);
    for text in ["R(0) a", "V(x) + I(B)", "R'(t) = 2", "x_n Ω\u{307}"] {
        assert_eq!(parse(text, Space::g3(), &names).unwrap().text(Style::Unicode), text);
    }
    // Letters may run together, so their brackets stay.
    for text in [
        "(Iω)·f",
        "(ab)²",
        "a/(bc)",
        "~(ab) (Ωx)",
        "(ab)'",
        "−(ab)",
        "RaR~",
        "(ab~)²",
        "(ab²)·c",
        "~(ab~)",
        "(a_B)²",
    ] {
        let shown = text.replace("(a_B)", "a_B");
        assert_eq!(parse(text, Space::g3(), &names).unwrap().text(Style::Unicode), shown);
    }
    for (text, shown) in [("e^(-ab) c", "exp(−ab) c"), ("e^(ab)", "exp(ab)"), ("((ab)) c", "(ab) c")] {
        assert_eq!(parse(text, Space::g3(), &names).unwrap().text(Style::Unicode), shown);
    }
    let latex = |text| parse(text, Space::g3(), &names).unwrap().latex();
    assert_eq!(latex("RaR~ b"), "R a R^{\\sim}\\,b");
    assert_eq!(latex("(Iω)·f"), "(I \\omega) \\cdot f");
    assert_eq!(latex("(ab)² + exp((ab)/(cd))"), "(a b)^{2} + e^{\\frac{a b}{c d}}");
    assert!(compiled("cross(e1, a)").is_ok());
    assert!(compiled("cross(e1, e1e2)").is_err());
}
