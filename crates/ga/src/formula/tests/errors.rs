//! Every kind of error, with its message and place.

use super::*;

/// The message, and the text at its place.
fn error(text: &str) -> (String, String) {
    let (space, names) = (Space::g3(), names());
    let compiled = parse(text, space, &names).and_then(|tree| compile(&tree, space, &names));
    let error = compiled.expect_err(text);
    (error.message.clone(), text[error.span.start..error.span.end].to_owned())
}

#[test]
fn errors_have_messages_and_places() {
    let cases = [
        ("", "empty", ""),
        ("a∧q", "`q` has no value", "q"),
        ("inertai(B)", "did you mean `inertia`?", "inertai"),
        ("ab + aq", "read as adjacent letters, q has none", "aq"),
        ("a·b∧c", "`(a·b)∧c` or `a·(b∧c)`", "a·b∧c"),
        ("a∧b·c", "`(a∧b)·c` or `a∧(b·c)`", "a∧b·c"),
        ("a·b·c", "`(a·b)·c` or `a·(b·c)`", "a·b·c"),
        ("a×b|c", "ambiguous", "a×b|c"),
        ("x∧α v", "`(x∧α) v` or `x∧(α v)`", "x∧α v"),
        ("2 a∧b·c", "`(a∧b)·c` or `a∧(b·c)`", "a∧b·c"),
        ("a·2b", "`(a·2) b` or `a·(2 b)`", "a·2b"),
        ("B×½ C", "`(B×½) C` or `B×(½ C)`", "B×½ C"),
        ("a∧b∧ω_k f_k", "`(a∧b∧ω_k) f_k` or `a∧b∧(ω_k f_k)`", "a∧b∧ω_k f_k"),
        ("x∧v² a", "`(x∧v²) a` or `x∧(v² a)`", "x∧v² a"),
        ("x∧(a·b) v + a", "`(x∧(a·b)) v` or `x∧((a·b) v)`", "x∧(a·b) v"),
        ("x∧norm(v) (a + b)", "`(x∧norm(v)) (a + b)`", "x∧norm(v) (a + b)"),
        ("(a", "`(` is never closed", "("),
        ("exp(B = a", "`(` is never closed", "("),
        ("a)", "closes no bracket", ")"),
        ("a + ()", "or an opening bracket, got `)`", ")"),
        ("2(a, b)", "commas are allowed only between arguments", ","),
        ("|a|", "a magnitude is `norm(a)`", "|"),
        ("(a]", "`]` does not close `(`", "]"),
        ("⟨a)", "`)` does not close `⟨`", ")"),
        ("a +", "the formula ends", ""),
        ("a ∧ + b", "got `+`", "+"),
        ("a, b", "commas", ","),
        ("2 3", "two numbers", "2 3"),
        ("(a)2", "a number right after a bracket", "2"),
        ("α/2a", "ambiguous divisor", "α/2a"),
        ("1/2·a", "`(…/2)·a` or `…/(2·a)`", "1/2·a"),
        ("a/b∧c", "`(…/b)∧c` or `…/(b∧c)`", "a/b∧c"),
        ("R(a)", "looks like a function", "R(a)"),
        ("a^2.5", "a power must be a whole number", "2.5"),
        ("a^(1+1)", "a power must be a whole number", "(1+1)"),
        ("a²³²³²³²³²³²³²", "a power must be a whole number", "²³²³²³²³²³²³²"),
        ("a²^2", "a power of a power", "a²^2"),
        ("e^a²", "a power in an exponent", "a²"),
        ("e^-Bθ", "the end of the exponent is ambiguous", "e^-Bθ"),
        ("e^½B", "the end of the exponent is ambiguous", "e^½B"),
        ("2 30'", "two numbers", "2 30"),
        ("α 30'", "a prime means a derivative", "'"),
        ("a**2", "write a power as `A^2`", "**"),
        ("√2", "`sqrt(A)`", "√"),
        ("a & b", "join and meet are methods", "&"),
        ("⟨M⟩_4", "3-d space has grades 0 to 3", "4"),
        ("⟨M⟩_x", "expected a grade", "x"),
        ("e4", "the basis vectors are e1 to e3", "e4"),
        ("1e5", "`1e+5`", "e5"),
        ("2 2.5e6", "`2.5e+6`", "e6"),
        ("e2e5", "`1e+5`", "e5"),
        ("e11", "contains e1 twice", "e11"),
        ("e", "`e` has no value", "e"),
        ("exp B", "write its argument in brackets", "exp"),
        ("exp(a, b)", "takes 1 argument, got 2", "exp(a, b)"),
        ("cross(a)", "takes 2 arguments, got 1", "cross(a)"),
        ("wedge(a)", "takes 2 arguments or more, got 1", "wedge(a)"),
        ("inertia", "is a linear map", "inertia"),
        ("inertia(a)", "needs a bivector (grade 2); this has grade 1", "a"),
        ("inertia(a b)", "take its part `⟨…⟩_2`", "a b"),
        ("cross(a, B)", "needs a vector", "B"),
        ("sin(a)", "needs a number", "a"),
        ("a/0", "division by zero", "a/0"),
        ("0^-1", "division by zero", "0^-1"),
        ("a = B", "no common grade", "a = B"),
        ("f_k", "the index k is free", "f_k"),
        ("2(f_k e_k + f_k)", "the index k is free", "2(f_k e_k + f_k)"),
        ("1 + (f_k e_k)(e_k f_k)", "the index k occurs 4 times", "(f_k e_k)(e_k f_k)"),
        ("Σ a", "the sum has no index", "Σ"),
        ("(exp(B))'", "a prime is the derivative", "exp(B)"),
        ("(S)'", "`S'` has no value; a derivative in this formula needs it", "S"),
        ("a $ b", "`$` has no meaning", "$"),
        ("sin(90°)", "write 90 degrees as `90 π/180`", "°"),
        ("\\theta", "`\\theta` has no meaning in a formula; write `θ`", "\\theta"),
        ("a \\wedge b", "write `∧` or `^`", "\\wedge"),
        ("a\\cdot b", "write `·` or `|`", "\\cdot"),
        ("a\\times b", "a cross product as `cross(a, b)`", "\\times"),
        ("\\tilde R", "write a reverse as `~R`", "\\tilde"),
        ("R^\\dagger", "write a reverse as `~R`", "\\dagger"),
        ("\\frac12", "write a fraction as `½`", "\\frac"),
        ("\\mathbf{a}", "write the name alone, `a`", "\\mathbf"),
        ("\\left(a", "write the bracket alone", "\\left"),
        ("\\phi", "write `φ`", "\\phi"),
        ("a\\,b", "write a space", "\\,"),
        ("\\hat n", "with its mark, `n\u{302}`", "\\hat"),
        ("90^\\circ", "angles are in radians", "\\circ"),
        ("\\foo", "write plain text, `θ/2 e1∧e2`, not LaTeX", "\\foo"),
        ("\\", "write plain text, `θ/2 e1∧e2`, not LaTeX", "\\"),
        ("theta a", "did you mean `θ`?", "theta"),
        ("Omega_B", "did you mean `Ω_B`?", "Omega_B"),
        ("Ṙ a", "did you mean `R'`?", "Ṙ"),
        ("v̇", "did you mean `v'`?", "v̇"),
        ("a:=b", "`:=` has no meaning in a formula; write `=`", ":="),
        ("a:b", "divide with `/`", ":"),
        ("R a R*", "write a reverse as `~R`, `R~` or `R†`", ""),
        ("(R a R*)", "write a reverse as", ")"),
        ("R a R^*", "write a reverse as", "*"),
        ("R^†", "write a reverse as", "†"),
        ("R^~ + b", "write a reverse as", "+"),
        ("aΛb", "write a wedge as `∧` or `^`", "aΛb"),
        ("a⋏b", "write a wedge as `∧` or `^`", "⋏"),
        ("a — b", "write a minus as", "—"),
        ("a ＋ b", "it is the full-width U+FF0B: write `+`", "＋"),
        ("a ≠ b", "there are no other comparisons", "≠"),
        ("a ≈ b", "write an equation with `=`", "≈"),
        ("∞", "numbers are finite", "∞"),
        ("∇v", "the gradient of a formula", "∇"),
        ("∂v", "derivatives are primes", "∂"),
        ("abs(a)", "write a magnitude as `norm(a)`", "abs"),
        ("det(F)", "the determinant of a linear map F as `F(I)/I`", "det"),
        ("(1,2,3)", "write a vector as `1 e1 + 2 e2 + 3 e3`", ","),
        ("1,2,3", "write a vector as `1 e1 + 2 e2 + 3 e3`", ","),
        ("attitudea", "`attitudea` has no value; write `attitude a`", "attitudea"),
        ("Bcross(a, b)", "write `B cross(…)`", "Bcross"),
        ("Attitude", "`Attitude` has no value; did you mean `attitude`?", "Attitude"),
        ("qpi", "read as adjacent letters", "qpi"),
        ("api", "write `a pi`", "api"),
        ("Ω_Be_1", "write `Ω_B e_1`", "Ω_Be_1"),
        ("a_", "a subscript must be letters and digits", "_"),
        ("1e+999", "beyond the range", "1e+999"),
        ("1e400", "`e400` is not a basis element, and as a power of ten beyond the range", "e400"),
        ("‖a‖", "write a magnitude as `norm(a)`", "‖"),
        ("grade(a, 2)", "write the part of grade 2 as `⟨A⟩_2`", "grade"),
        ("\u{435}2", "`\u{435}` is the Cyrillic letter U+0435, not the Latin `e`: write `e2`", "\u{435}2"),
        ("2 \u{435}\u{445}\u{440}(B)", "not the Latin `e`: write `exp` in Latin", "\u{435}\u{445}\u{440}"),
        ("\u{392}", "the Greek letter U+0392, not the Latin `B`", "\u{392}"),
        ("a\0", "the invisible character U+0000 has no meaning in a formula; remove it", "\0"),
        ("a \u{202e}b", "the invisible character U+202E", "\u{202e}"),
        ("1_000 a", "write a number without signs between its digits, `1000`", "1_000"),
        ("2'000_000.5 a", "`2000000.5`", "2'000_000.5"),
        ("sum_ij e_i", "`sum_ij` has no value", "sum_ij"),
    ];
    for (text, message, place) in cases {
        let (found, at) = error(text);
        assert!(found.contains(message), "{text}: {found}");
        assert_eq!(at, place, "{text}: {found}");
    }
}

/// Where I is the inertia, `I (B)` on paper is nonetheless the pseudoscalar times B.
#[test]
fn the_pseudoscalar_and_the_inertia_are_told_apart() {
    let mut names = names();
    names.bind("I".to_owned(), Meaning::Map { grade: 2 });
    let message = |text: &str| {
        let read = parse(text, Space::g3(), &names).and_then(|tree| compile(&tree, Space::g3(), &names));
        read.err().map(|error| error.message)
    };
    let ambiguous =
        "ambiguous with a space; write `I(a∧b)` for the value of `I`, `I*(a∧b)` with the pseudoscalar";
    assert_eq!(message("2 I (a∧b)").as_deref(), Some(ambiguous));
    assert!(message("I (M)").is_some_and(|message| message.contains("`I*(M)`")));
    for text in ["I(a∧b)", "I*(a∧b)", "I a∧b", "I B"] {
        assert_eq!(message(text), None, "{text}");
    }
    // Only one reading is possible.
    assert!(message("I (a)").is_some_and(|message| message.contains("needs a bivector")));
}

#[test]
fn a_name_whose_line_is_invalid_is_not_a_number() {
    let units = session::Units { quantities: |_, _| Ok(Vec::new()), near: |_| None };
    let mut session = session::Session::new(units);
    let mut message = |number, line: &str| session.run(number, line).err().map(|(_, error)| error.message);
    assert!(message(1, "a = e1 +").is_some());
    assert_eq!(message(2, "x = e1"), None);
    assert_eq!(message(3, "x∧a x").as_deref(), Some("`a` has no value, because line 1 has an error"));
}

#[test]
fn a_definition_cannot_use_itself() {
    let mut names = names();
    for (head, body, place) in
        [("V(y)", "y V(y − 1)", "V"), ("W(y)", "aW(y)", "aW"), ("fac(y)", "2 fac(y)", "fac")]
    {
        let error = define(head, body, Space::g3(), &mut names).unwrap_err();
        assert!(error.message.contains("in its own definition; formulas have no recursion"), "{error}");
        assert_eq!(&body[error.span.start..error.span.end], place);
    }
    assert!(define("V(y)", "q y", Space::g3(), &mut names).unwrap_err().message.contains("`q` has no value"));
}

/// Formulas that are too long or too deep are refused quickly, at the place where they become so.
#[test]
fn long_and_deep_formulas_are_refused() {
    let cases = [
        ("a".repeat(20_000), "more than 10000"),
        ("a ".repeat(20_000), "more than 10000"),
        ("a+".repeat(20_000) + "a", "more than 10000"),
        ("a∧".repeat(20_000) + "a", "more than 10000"),
        ("(".repeat(20_000), "more than 10000"),
        ("(".repeat(5_000) + "a" + &")".repeat(4_000), "more than 100 nested levels"),
        ("~".repeat(5_000) + "a", "more than 100 nested levels"),
        ("-".repeat(5_000) + "a", "more than 100 nested levels"),
        ("exp(".repeat(200) + "a" + &")".repeat(200), "more than 100 nested levels"),
        ("a".to_owned() + &"~".repeat(5_000), "more than 100 nested levels"),
        ("a".to_owned() + &"/2".repeat(4_000), "more than 100 nested levels"),
        ("Σ_k ".repeat(1_000) + "a", "more than 100 nested levels"),
        ("Σ_k ".repeat(20) + "e_k", "too long when its definitions, sums and derivatives are expanded"),
        ("e^".repeat(4_000) + "a", "more than 100 nested levels"),
        ("(v'".repeat(3_000), "more than 100 nested levels"),
        (
            "(".repeat(90) + "v v" + &")'".repeat(90),
            "too long when its definitions, sums and derivatives are expanded",
        ),
        (
            "(".to_owned() + &"v".repeat(5_000) + ")'",
            "too long when its definitions, sums and derivatives are expanded",
        ),
    ];
    for (text, message) in cases {
        let (found, _) = error(&text);
        assert!(found.contains(message), "{}…: {found}", text.chars().take(12).collect::<String>());
    }
    // Formulas within the limits do not overflow the stack.
    program(&("(".repeat(99) + "a" + &")".repeat(99)));
    program(&("a".to_owned() + &" a".repeat(9_000)));
}

/// Long chains of definitions do not overflow the stack.
#[test]
fn chains_of_definitions_are_limited() {
    let space = Space::g3();
    let mut names = names();
    define("f0(x)", "x", space, &mut names).unwrap();
    for k in 1..600 {
        define(&format!("f{k}(x)"), &format!("f{}(x) + 1", k - 1), space, &mut names).unwrap();
    }
    let compiled = |text| compile(&parse(text, space, &names).unwrap(), space, &names);
    assert!(compiled("f99(a)").is_ok());
    assert!(compiled("f599(a)").unwrap_err().message.contains("more than 1000 nested levels"));
    let error = define("f0(x)", "f599(x)", space, &mut names).unwrap_err();
    assert!(error.message.contains("would call itself"));
}

#[test]
fn the_caret_is_under_the_place() {
    let text = "R v ~R + (a∧b)·q";
    let error = parse(text, Space::g3(), &names()).unwrap_err();
    assert_eq!(error.shown(text).lines().last().unwrap(), "  |                ^");
}
