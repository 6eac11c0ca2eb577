use super::*;
use polhode_ga::formula::Agreement;

/// The outcome of each line: its value as text, `holds`, `differs`, or `!` and the error.
fn outcomes(text: &str) -> Vec<String> {
    let mut session = Session::new(UNITS);
    let outcome =
        |(i, line): (usize, &str)| match session.run(i + 1, line.split('#').next().unwrap_or_default()) {
            Ok(Outcome { value: Some((value, ty)), .. }) => {
                valued(&value, ty)["text"].as_str().expect("text").to_owned()
            }
            Ok(Outcome { agreement: Some(found), .. }) => {
                if found.holds() { "holds" } else { "differs" }.to_owned()
            }
            Ok(_) => String::new(),
            Err((_, error)) => format!("!{}", error.message),
        };
    text.split('\n').enumerate().map(outcome).collect()
}

fn agreement(line: &str) -> Agreement {
    Session::new(UNITS).run(1, line).ok().and_then(|outcome| outcome.agreement).expect("an equation")
}

#[test]
fn lines_give_values_to_names_for_later_lines() {
    let lines = "a = 2 e1 + e2  # a vector\n\nV(x) = ½ x·x\nV(a)\nθ = 30 deg\nR = exp(-θ/2 e12)\nR a ~R";
    assert_eq!(
        outcomes(lines),
        [
            "2 e1 + e2",
            "",
            "",
            "2.5",
            "0.52359878",
            "0.96592583 - 0.25881905 e1∧e2",
            "1.2320508 e1 + 1.8660254 e2"
        ]
    );
}

#[test]
fn equations_are_measured_as_python_measures_them() {
    assert_eq!(
        outcomes("a = 2 e1 + e2\nI a∧e3 = 3 e1\na∧e3 == -e3∧a\na = 1 = 1")[1..3],
        ["differs", "holds"]
    );
    // Residuals and sizes of polhode.evaluate.
    assert_eq!(agreement("2 = 3"), Agreement { residual: 1.0, size: 3.0 });
    assert_eq!(agreement("e1∧e2 + 2 e2∧e1 = 0"), Agreement { residual: 1.0, size: 3.0 });
    assert_eq!(agreement("(3 e1)^-1 = 0 e1"), Agreement { residual: 1.0 / 3.0, size: 1.0 / 3.0 });
    assert!(!agreement("e1 == e1 + 1.01e-9 e2").holds());
    assert!(agreement("e_i e_j = δ_ij + I ε_ijk e_k").holds());
    let lost = "x = 1e-20\n(1 + x) - 1 = 0";
    assert_eq!(outcomes(lost)[1], "holds");
}

#[test]
fn lines_that_need_an_invalid_line_name_it() {
    let lines = "a = 2 e1 +\nb = e2\nab\nV(x) = a x\nV(b)\nF(x) = (\nF(b)\na = e1\na∧b";
    let found = outcomes(lines);
    assert!(found[0].starts_with("!the formula ends"), "{found:?}");
    assert_eq!(found[2], "!`a` has no value, because line 1 has an error");
    assert_eq!(found[3], "!`a` has no value, because line 1 has an error");
    assert_eq!(found[4], "!`V` has no value, because line 4 has an error");
    assert_eq!(found[6], "!`F` has no value, because line 6 has an error");
    assert_eq!(found[8], "e1∧e2");
}

#[test]
fn an_invalid_line_removes_the_value_of_its_name() {
    let found = outcomes("a = e1\nf(x) = a x\na = 1/0\na\nf(e2)");
    assert_eq!(found[3], "!`a` has no value, because line 3 has an error");
    assert_eq!(found[4], "!`a` has no value, because line 3 has an error");
}

#[test]
fn definitions_cannot_call_themselves() {
    assert_eq!(outcomes("V(x) = V(x)"), ["!`V` would call itself; formulas have no recursion"]);
    let found = outcomes("f(x) = x\ng(x) = f(x)\nf(x) = g(x)");
    assert_eq!(found[2], "!`f` would call itself; formulas have no recursion");
}

#[test]
fn an_underscore_is_the_last_value() {
    let found = outcomes("_\ne1 + e2\na_1 = 3 _\n_·a_1\n_ == 18\n⟨_ e1⟩_1\nf(x) = _ x\nq");
    assert_eq!(found[0], "!`_` is the last value; there is none yet");
    assert_eq!(found[1..6], ["e1 + e2", "3 e1 + 3 e2", "18", "holds", "18 e1"]);
    assert_eq!(found[6], "!a function cannot use `_`, the last value");
    assert!(!found[7].contains("last_value"), "{found:?}");
}

#[test]
fn units_are_read_where_a_name_gets_a_value() {
    let found = outcomes("θ = 90 deg\n2 deg\nm = 2 kg\nF = 3 m\nx = 2 kgg");
    assert_eq!(found[0], "1.5707963");
    assert!(found[1].ends_with("Units are read where a name gets a value, as in `x = 2 deg`"), "{found:?}");
    assert_eq!(found[2], "2");
    assert!(found[3].contains("a unit and a name"), "{found:?}");
    assert!(found[4].ends_with("Did you mean the unit `kg`?"), "{found:?}");
}

#[test]
fn json_has_places_in_utf16() {
    // 𝛀 takes two units of UTF-16 and four bytes.
    assert!(evaluated("x = 𝛀 + 30 deg").contains(r#""start":4,"end":6"#));
    assert!(evaluated("x = (30 deg) (e1 + q) # 𝛀").contains(r#""start":19,"end":20"#));
}

#[test]
fn rotors_are_known_by_their_type_or_their_norm() {
    let json = |line: &str| evaluated(line);
    for line in ["exp(-e1∧e2)", "e1 (0.6 e1 + 0.8 e2)", "a = e2 (0.6 e1 + 0.8 e2)"] {
        assert!(json(line).contains(r#""rotor":true"#), "{line}");
    }
    for line in ["e1∧e2", "1", "2 e1 (0.6 e1 + 0.8 e2)", "e1"] {
        assert!(json(line).contains(r#""rotor":false"#), "{line}");
    }
}

#[test]
fn no_text_panics() {
    const PIECES: [&str; 64] = [
        "a", "b", "V", "θ", "R", "x", "e1", "e2", "e3", "e12", "I", "π", "2", "0.5", "½", "1e-3", "1e308",
        " ", " ", "=", "=", "==", "(", ")", "∧", "^", "·", "|", "×", "⨯", "⌋", "⌊", "~", "-", "−", "+", "/",
        "²", "⁻¹", "^2", "^-1", "^99", "'", "†", "\u{303}", "_", "_k", "Σ_k", "⟨", "⟩_2", "exp(", "log(",
        "sqrt(", "V(x) = ", "a = ", "V(", ",", " deg", " m", " rev/s", "\n", "\n", "#", "𝛀",
    ];
    let mut state = 7_u64;
    let mut next = move |n: usize| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize % n
    };
    for _ in 0..20_000 {
        let text: String = (0..1 + next(40)).map(|_| PIECES[next(PIECES.len())]).collect();
        evaluated(&text);
        let bytes: Vec<u8> = (0..next(40)).map(|_| next(256) as u8).collect();
        evaluated(&String::from_utf8_lossy(&bytes));
    }
    for piece in PIECES {
        evaluated(&piece.repeat(3000));
        evaluated(&format!("a = {}", piece.repeat(3000)));
    }
}
