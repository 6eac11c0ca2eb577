use super::*;

#[test]
fn names_are_canonical() {
    let cases = [
        ("a₁", "a1"),
        ("a_1", "a1"),
        ("e_{12}", "e12"),
        ("Ω_B", "Ω_B"),
        ("fₖ'", "f_k'"),
        ("f′_k", "f_k'"),
        ("a∥", "a∥"),
        ("a_⊥", "a⊥"),
        ("omega_body", "omega_body"),
        ("x_0", "x0"),
        ("𝑅", "R"),
        ("R(0)", "R(0)"),
        ("R( t )", "R(t)"),
        ("n̂", "n\u{302}"),
        ("x\u{307}", "ẋ"),
        ("Ω_B\u{307}", "Ω_Ḃ"),
        ("Ω_Ḃ", "Ω_Ḃ"),
        ("x_nΩ\u{307}", "x_nΩ\u{307}"),
        ("xₙΩ\u{307}", "x_nΩ\u{307}"),
        ("R(xₙΩ\u{307})", "R(x_nΩ\u{307})"),
        ("x_1\u{307}", "ẋ1"),
        ("a_{1x}", "a1x"),
        ("a_1x", "a1x"),
        ("a₁ₓ", "a1x"),
        ("a_B_{1x}", "a_B_1x"),
        ("xₙ'Ω\u{307}", "x_n'Ω\u{307}"),
        ("x₁Ω\u{307}", "x1Ω\u{307}"),
    ];
    for (name, expected) in cases {
        assert_eq!(canonical(name).as_deref(), Some(expected), "{name}");
        assert_eq!(canonical(expected).as_deref(), Some(expected), "{name}");
    }
    for name in ["", "1", "a b", "R̃", "a+b", "a^2", "f(a, b)", "a_"] {
        assert_eq!(canonical(name), None, "{name}");
    }
}

#[test]
fn numbers_end_where_basis_vectors_begin() {
    let kinds = |text: &str| -> Vec<String> {
        let show = |t: Token| match t.item {
            Item::Number(n) => n.to_string(),
            Item::Word(atoms) => joined(&atoms).unwrap(),
            other => format!("{other:?}"),
        };
        tokens(text).unwrap().into_iter().map(show).collect()
    };
    assert_eq!(kinds("2e1"), ["2", "e1"]);
    assert_eq!(kinds("2e-1"), ["0.2"]);
    assert_eq!(kinds("2E1 x"), ["20", "x"]);
    assert_eq!(kinds(".5e12"), ["0.5", "e12"]);
    assert_eq!(kinds("½ΩR"), ["0.5", "ΩR"]);
}
