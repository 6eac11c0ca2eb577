//! Every kind of mistake, and what is said of it.

use super::*;

/// The message, and the text it points at.
fn error(text: &str) -> (String, String) {
    let (space, names) = (Space::g3(), names());
    let compiled = parse(text, space, &names).and_then(|tree| compile(&tree, space, &names));
    let error = compiled.expect_err(text);
    (error.message.clone(), text[error.span.start..error.span.end].to_owned())
}

#[test]
fn mistakes_are_named_and_pointed_at() {
    let cases = [
        ("", "empty", ""),
        ("a∧q", "`q` has no value", "q"),
        ("inertai(B)", "is `inertia` meant?", "inertai"),
        ("ab + aq", "read as letters side by side, q has none", "aq"),
        ("a·b∧c", "`(a·b)∧c` or `a·(b∧c)`", "a·b∧c"),
        ("a∧b·c", "`(a∧b)·c` or `a∧(b·c)`", "a∧b·c"),
        ("a·b·c", "`(a·b)·c` or `a·(b·c)`", "a·b·c"),
        ("a×b|c", "ambiguous", "a×b|c"),
        ("(a", "`(` is never closed", "("),
        ("exp(B = a", "`(` is never closed", "("),
        ("a)", "closes no bracket", ")"),
        ("a + ()", "should stand here, not `)`", ")"),
        ("2(a, b)", "a comma only stands between the arguments", ","),
        ("|a|", "a magnitude is `norm(a)`", "|"),
        ("(a]", "`]` does not close `(`", "]"),
        ("⟨a)", "`)` does not close `⟨`", ")"),
        ("a +", "the formula ends", ""),
        ("a ∧ + b", "not `+`", "+"),
        ("a, b", "a comma", ","),
        ("2 3", "two numbers", "2 3"),
        ("(a)2", "a number right after a bracket", "2"),
        ("α/2a", "what is divided by?", "α/2a"),
        ("1/2·a", "`(…/2)·a` or `…/(2·a)`", "1/2·a"),
        ("a/b∧c", "`(…/b)∧c` or `…/(b∧c)`", "a/b∧c"),
        ("R(a)", "looks like a function", "R(a)"),
        ("a^2.5", "a power is a whole number", "2.5"),
        ("a^(1+1)", "a power is a whole number", "(1+1)"),
        ("a²³²³²³²³²³²³²", "a power is a whole number", "²³²³²³²³²³²³²"),
        ("a²^2", "a power of a power", "a²^2"),
        ("e^a²", "a power in an exponent", "a²"),
        ("e^-Bθ", "where does the exponent end?", "e^-Bθ"),
        ("e^½B", "where does the exponent end?", "e^½B"),
        ("2 30'", "two numbers", "2 30"),
        ("α 30'", "a prime means a derivative", "'"),
        ("a**2", "a power is written", "**"),
        ("⟨M⟩_4", "3-d space has grades 0 to 3", "4"),
        ("⟨M⟩_x", "a grade should stand here", "x"),
        ("e4", "the basis vectors are e1 to e3", "e4"),
        ("1e5", "`1e+5`", "e5"),
        ("e11", "e1 twice", "e11"),
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
        ("a = B", "no grade in common", "a = B"),
        ("f_k", "the index k is free", "f_k"),
        ("2(f_k e_k + f_k)", "the index k is free", "2(f_k e_k + f_k)"),
        ("1 + (f_k e_k)(e_k f_k)", "k stands here 4 times", "(f_k e_k)(e_k f_k)"),
        ("Σ a", "a sum over which index?", "Σ"),
        ("(exp(B))'", "a prime means the derivative", "exp(B)"),
        ("(S)'", "`S'` has no value, and a derivative here needs it", "S"),
        ("a $ b", "`$` has no meaning", "$"),
        ("\\theta", "write `θ/2 e1∧e2`, not LaTeX", "\\"),
        ("a_", "a subscript is letters and digits", "_"),
        ("1e+999", "beyond the range", "1e+999"),
        ("sum_ij e_i", "`sum_ij` has no value", "sum_ij"),
    ];
    for (text, message, place) in cases {
        let (found, at) = error(text);
        assert!(found.contains(message), "{text}: {found}");
        assert_eq!(at, place, "{text}: {found}");
    }
}

/// The language has an end: what is too long or too deep is refused where it becomes so, quickly.
#[test]
fn long_and_deep_formulas_are_refused() {
    let cases = [
        ("a".repeat(20_000), "more than 10000"),
        ("a ".repeat(20_000), "more than 10000"),
        ("a+".repeat(20_000) + "a", "more than 10000"),
        ("a∧".repeat(20_000) + "a", "more than 10000"),
        ("(".repeat(20_000), "more than 10000"),
        ("(".repeat(5_000) + "a" + &")".repeat(4_000), "more than 100 levels"),
        ("~".repeat(5_000) + "a", "more than 100 levels"),
        ("-".repeat(5_000) + "a", "more than 100 levels"),
        ("exp(".repeat(200) + "a" + &")".repeat(200), "more than 100 levels"),
        ("a".to_owned() + &"~".repeat(5_000), "more than 100 levels"),
        ("a".to_owned() + &"/2".repeat(4_000), "more than 100 levels"),
        ("Σ_k ".repeat(1_000) + "a", "more than 100 levels"),
        ("Σ_k ".repeat(20) + "e_k", "too long when they are written out"),
        ("e^".repeat(4_000) + "a", "more than 100 levels"),
        ("(v'".repeat(3_000), "more than 100 levels"),
        ("(".repeat(90) + "v v" + &")'".repeat(90), "too long when they are written out"),
        ("(".to_owned() + &"v".repeat(5_000) + ")'", "too long when they are written out"),
    ];
    for (text, message) in cases {
        let (found, _) = error(&text);
        assert!(found.contains(message), "{}…: {found}", text.chars().take(12).collect::<String>());
    }
    // Within the limits there is no trouble with the stack.
    program(&("(".repeat(99) + "a" + &")".repeat(99)));
    program(&("a".to_owned() + &" a".repeat(9_000)));
}

/// However many definitions call each other in turn, the stack holds.
#[test]
fn chains_of_definitions_have_an_end() {
    let space = Space::g3();
    let mut names = names();
    define("f0(x)", "x", space, &mut names).unwrap();
    for k in 1..600 {
        define(&format!("f{k}(x)"), &format!("f{}(x) + 1", k - 1), space, &mut names).unwrap();
    }
    let compiled = |text| compile(&parse(text, space, &names).unwrap(), space, &names);
    assert!(compiled("f99(a)").is_ok());
    assert!(compiled("f599(a)").unwrap_err().message.contains("more than 1000 levels"));
    let error = define("f0(x)", "f599(x)", space, &mut names).unwrap_err();
    assert!(error.message.contains("would call itself"));
}

#[test]
fn the_caret_stands_under_the_place() {
    let text = "R v ~R + (a∧b)·q";
    let error = parse(text, Space::g3(), &names()).unwrap_err();
    assert_eq!(error.shown(text).lines().last().unwrap(), "  |                ^");
}
