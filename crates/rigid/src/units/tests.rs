use super::*;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// Within two roundings, one for the product with a unit's numerator, one for the quotient.
fn close(value: f64, expected: f64) -> bool {
    (value - expected).abs() <= 2.0 * f64::EPSILON * expected.abs()
}

#[test]
fn powers_of_ten_are_exact() {
    use Quantity::*;
    let table = [
        ("7.85 g/cm^3", Density, 7850.0),
        ("1 g/cm^3", Density, 1000.0),
        ("2.7 t/m^3", Density, 2700.0),
        ("5 ms", Time, 0.005),
        ("5e0 s", Time, 5.0),
        ("5e+003 s", Time, 5000.0),
        ("5E-03 s", Time, 0.005),
        ("7 us", Time, 7e-6),
        ("7 \u{b5}s", Time, 7e-6),
        ("7 \u{3bc}s", Time, 7e-6),
        ("9 ns", Time, 9e-9),
        ("0.3 mm", Length, 0.0003),
        ("12 km", Length, 12_000.0),
        ("450 nm", Length, 450e-9),
        ("3 mg", Mass, 3e-6),
        ("3 kg", Mass, 3.0),
        ("3 Mg", Mass, 3000.0),
        ("9.81 m/s^2", Acceleration, 9.81),
        ("9.81 m s^-2", Acceleration, 9.81),
        ("9.81 m·s⁻²", Acceleration, 9.81),
        ("9.81 m s**-2", Acceleration, 9.81),
        ("9.81 N/kg", Acceleration, 9.81),
        ("3 kg m^2", MomentOfInertia, 3.0),
        ("3 kg*m^2", MomentOfInertia, 3.0),
        ("3 kg·m²", MomentOfInertia, 3.0),
        ("3kg m²", MomentOfInertia, 3.0),
        ("0.02 N m s^2", MomentOfInertia, 0.02),
        ("0.02 J s²", MomentOfInertia, 0.02),
        ("4 g cm^2", MomentOfInertia, 4e-7),
        ("2 mN mm s^2", MomentOfInertia, 2e-6),
        ("5 mrad/s", AngularRate, 0.005),
        ("-2.5E-1 rad / s", AngularRate, -0.25),
        ("\u{2212}3 rad/s", AngularRate, -3.0),
        ("+.5 rad/s", AngularRate, 0.5),
        ("5. rad/s", AngularRate, 5.0),
        (" 2 rad 1/s ", AngularRate, 2.0),
        ("2 /s rad", AngularRate, 2.0),
        ("0", Length, 0.0),
        ("-0.0", Length, 0.0),
        ("0 mm", Length, 0.0),
        ("0e99999999999999999999 m", Length, 0.0),
    ];
    for (text, quantity, expected) in table {
        assert_eq!(parse(text, quantity), Ok(expected), "{text}");
    }
    assert_eq!(parse("1e310 nm", Quantity::Length), Ok(1e301), "the prefix brings the number into range");
}

#[test]
fn other_units_are_exact_where_their_definition_is() {
    use Quantity::*;
    let table = [
        ("1 lb", Mass, 0.453_592_37),
        ("1 ft", Length, 0.3048),
        ("1 inch", Length, 0.0254),
        ("1 au", Length, 149_597_870_700.0),
        ("1 t", Mass, 1000.0),
        ("2 min", Time, 120.0),
        ("2 h", Time, 7200.0),
        ("1 d", Time, 86_400.0),
        ("1 day", Time, 86_400.0),
        ("1 yr", Time, 31_557_600.0),
        ("1 rev/s", AngularRate, TAU),
        ("1 turn/s", AngularRate, TAU),
        ("60 rpm", AngularRate, TAU),
        ("1 deg/day", AngularRate, PI / 180.0 / 86_400.0),
        ("360 arcmin/h", AngularRate, 6.0 * PI / 180.0 / 3600.0),
        ("3600 arcsec", Angle, PI / 180.0),
        ("12°", Angle, PI / 15.0),
        ("1 kPa s^2 m", Mass, 1000.0),
    ];
    for (text, quantity, expected) in table {
        let value = parse(text, quantity).unwrap();
        assert!(close(value, expected), "{text} {value} {expected}");
    }
    for exact in &table[..12] {
        assert_eq!(parse(exact.0, exact.1), Ok(exact.2), "{}", exact.0);
    }
    assert_eq!(parse("180 deg", Angle), Ok(PI));
    assert_eq!(parse("90 deg", Angle), Ok(PI / 2.0));
    assert_eq!(parse("-45 deg", Angle), Ok(-PI / 4.0));
    assert_eq!(parse("360 deg", Angle), Ok(TAU));
}

#[test]
fn a_wrong_quantity_says_what_was_expected() {
    let table = [
        ("5 m", Quantity::AngularRate, "expected an angular rate such as `5 rev/s`, found a length (`5 m`)"),
        (
            "5 Hz",
            Quantity::AngularRate,
            "expected an angular rate such as `5 rev/s`, found a frequency (`5 Hz`); write rev/s or rad/s",
        ),
        (
            "5 1/s",
            Quantity::AngularRate,
            "expected an angular rate such as `5 rev/s`, found a frequency (`5 1/s`); write rev/s or rad/s",
        ),
        ("5 deg/s", Quantity::Angle, "expected an angle such as `30 deg`, found an angular rate (`5 deg/s`)"),
        ("0 kg", Quantity::Length, "expected a length such as `5 cm`, found a mass (`0 kg`)"),
        ("3 rad^7", Quantity::Time, "expected a time such as `10 s`, found another quantity (`3 rad^7`)"),
        ("5", Quantity::Time, "expected a time such as `10 s`, found `5` without a unit"),
        ("fast", Quantity::Time, "expected a time such as `10 s`, found `fast`"),
        ("", Quantity::Time, "expected a time such as `10 s`, found ``"),
        ("inf s", Quantity::Time, "expected a time such as `10 s`, found `inf s`"),
        ("-nan", Quantity::Time, "expected a time such as `10 s`, found `-nan`"),
    ];
    for (text, quantity, message) in table {
        assert_eq!(parse(text, quantity).unwrap_err(), message);
    }
}

#[test]
fn unknown_units_get_a_suggestion() {
    let near = |text| {
        let message = parse(text, Quantity::Time).unwrap_err();
        let start = format!("unknown unit `{}` in `{text}`, ", &text[text.rfind([' ', '/']).unwrap() + 1..]);
        let hint = message.strip_prefix(&start).unwrap_or_else(|| panic!("{message}"));
        hint.strip_prefix("did you mean `").and_then(|hint| hint.strip_suffix("`?")).map(str::to_owned)
    };
    let assert_near = |text, unit: Option<&str>| assert_eq!(near(text).as_deref(), unit, "{text}");
    assert_near("5 sec", Some("s"));
    assert_near("5 seconds", Some("s"));
    assert_near("5 days", Some("day"));
    assert_near("5 S", Some("s"));
    assert_near("5 KG", Some("kg"));
    assert_near("5 Nm", Some("N m"));
    assert_near("5 degs", Some("deg"));
    assert_near("5 ft/z", None);
    assert_eq!(
        parse("5 rev/sec", Quantity::AngularRate).unwrap_err(),
        "unknown unit `sec` in `5 rev/sec`, did you mean `s`?"
    );
    assert_eq!(
        parse("5 ft/z", Quantity::Length).unwrap_err(),
        "unknown unit `z` in `5 ft/z`, expected a length such as `5 cm`"
    );
}

#[test]
fn words_have_a_near_unit() {
    let table =
        [("deg", Some("deg")), ("km", Some("km")), ("degrees", Some("deg")), ("1", Some("1")), ("x", None)];
    for (word, unit) in table {
        assert_eq!(near(word).as_deref(), unit, "{word}");
    }
}

#[test]
fn syntax_errors_are_reported() {
    let table = [
        ("3,5 m", "unexpected `,` (a decimal point is written `.`) in `3,5 m`"),
        ("5 m/", "a unit is missing at the end in `5 m/`"),
        ("5 m*/s", "unexpected `/` in `5 m*/s`"),
        ("5 m2", "unexpected `2` (a power is written `^2`) in `5 m2`"),
        ("5 m^", "a power must be a whole number from -9 to 9 and not 0 in `5 m^`"),
        ("5 m^0", "a power must be a whole number from -9 to 9 and not 0 in `5 m^0`"),
        ("5 m^99999999999", "a power must be a whole number from -9 to 9 and not 0 in `5 m^99999999999`"),
        ("5 m⁻", "a power must be a whole number from -9 to 9 and not 0 in `5 m⁻`"),
        ("5 J/(kg m)", "parentheses are not supported (write `/` before each divisor) in `5 J/(kg m)`"),
        ("5 m 6", "unexpected `6` (a power is written `^6`) in `5 m 6`"),
    ];
    for (text, message) in table {
        assert_eq!(parse(text, Quantity::Length).unwrap_err(), message);
    }
}

#[test]
fn values_out_of_range_are_errors() {
    for text in ["1e309 m", "1e400 m", "1e99999999999999999999 m", "-1e308 km", "1e300 au"] {
        let message = format!("`{text}` is beyond the range of floating point, about 1.8e308");
        assert_eq!(parse(text, Quantity::Length), Err(message));
    }
    for text in ["1e-324 m", "-1e-99999999999999999999 m", "1e-320 nm"] {
        let message = format!("`{text}` is below the range of floating point, about 5e-324; write 0");
        assert_eq!(parse(text, Quantity::Length), Err(message));
    }
}

#[test]
fn a_unit_alone_has_a_value() {
    assert_eq!(parse_unit("mm", Quantity::Length), Ok(0.001));
    assert_eq!(parse_unit(" inch ", Quantity::Length), Ok(0.0254));
    for text in ["", "kg", "5 mm", "mmm"] {
        assert!(parse_unit(text, Quantity::Length).is_err(), "{text}");
    }
}

#[test]
fn the_examples_and_si_units_of_messages_are_right() {
    for &quantity in Quantity::ALL {
        assert!(parse(quantity.example(), quantity).is_ok(), "{quantity}");
        assert_eq!(parse_unit(quantity.si_unit(), quantity), Ok(1.0), "{quantity}");
    }
}

proptest! {
    #[test]
    fn a_formatted_value_parses_back(value in proptest::num::f64::NORMAL, i in 0usize..8) {
        let quantity = Quantity::ALL[i];
        prop_assert_eq!(parse(&format!("{value} {}", quantity.si_unit()), quantity), Ok(value));
        prop_assert_eq!(parse(&format!("{value:e} {}", quantity.si_unit()), quantity), Ok(value));
    }

    #[test]
    fn any_text_has_an_answer(text in "\\PC*") {
        let _ = parse(&text, Quantity::Density);
    }

    #[test]
    fn any_text_like_a_quantity_has_an_answer(text in "[-+0-9.eE]{1,5}[ */·^²⁻0-9kgms1°]{0,12}") {
        if let Ok(value) = parse(&text, Quantity::Length) {
            prop_assert!(value.is_finite());
        }
    }
}

/// The formula with each quantity replaced by its value in angle brackets.
fn within(text: &str, names: &[&str]) -> Result<String, String> {
    let found = quantities(text, &|name| names.contains(&name)).map_err(|error| error.message)?;
    let (mut shown, mut at) = (String::new(), 0);
    for (span, value) in found {
        shown.push_str(&format!("{}<{value}>", &text[at..span.start]));
        at = span.end;
    }
    Ok(shown + &text[at..])
}

#[test]
fn a_number_directly_before_a_unit_is_a_quantity_within_a_formula() {
    let table = [
        ("180deg", "<3.141592653589793>"),
        ("180°e1e2", "<3.141592653589793>e1e2"),
        ("-180 deg e1∧e2", "-<3.141592653589793> e1∧e2"),
        ("exp(-180deg/2 e1∧e2)", "exp(-<3.141592653589793>/2 e1∧e2)"),
        ("7.85 g/cm^3", "<7850>"),
        ("5 m/s e1 + 3 cm/s e2", "<5> e1 + <0.03> e2"),
        ("3 kg·m² e1∧e2", "<3> e1∧e2"),
        ("2 kg m^2 / s x", "<2> x"),
        ("2 m^-1 e1", "<2> e1"),
        ("5 km^e1", "<5000>^e1"),
        ("5 m/x", "<5>/x"),
        ("5 km*x", "<5000>*x"),
        ("1e-3 km", "<1>"),
        ("1e20 mm", "<100000000000000000>"),
        // No quantities: names, powers, grades, calls, numbers of names, and words that are no units.
        ("3 x", "3 x"),
        ("x^2 m", "x^2 m"),
        ("x1 m", "x1 m"),
        ("x₁ m", "x₁ m"),
        ("⟨M⟩_2 m", "⟨M⟩_2 m"),
        ("5 m2 e1", "5 m2 e1"),
        ("5 m_1", "5 m_1"),
        ("5 m' e1", "5 m' e1"),
        ("5 m(x)", "5 m(x)"),
        ("2e1 x", "2e1 x"),
        ("2e-1", "2e-1"),
        ("2 e1 m", "2 e1 m"),
        ("5 parsnip", "5 parsnip"),
        ("m a", "m a"),
        ("", ""),
    ];
    for (text, expected) in table {
        assert_eq!(within(text, &["x", "a"]).as_deref(), Ok(expected), "{text}");
    }
}

#[test]
fn ambiguous_quantities_in_a_formula_are_errors() {
    let table = [
        ("5 m e1", "`m` is a unit and a name here; for the name write `5*m`"),
        ("5 rev*m", "`m` is a unit and a name here; for the name write `(5 rev) m`"),
        (
            "5 cm/s t e1",
            "`t` may be a unit or a name; for the name write `(5 cm/s) t`, for the unit `5 cm/s*t`",
        ),
        ("5 ms", "`ms` is a unit and a name here; for the name write `5*ms`"),
        ("1/2 rev", "`/` before a quantity has two readings; put brackets around `2 rev`"),
        ("2e1 kg", "`2e1` has two readings; write `2e+1` for the number, `2 e1` for the product"),
        (" -2e1 ", "`2e1` has two readings; write `2e+1` for the number, `2 e1` for the product"),
        ("5 kg^10", "a power must be a whole number from -9 to 9 and not 0 after the unit `kg`"),
        ("1e400 kg", "`1e400 kg` is beyond the range of floating point, about 1.8e308"),
    ];
    for (text, message) in table {
        let names: &[&str] = if text == "5 ms" { &["m", "s"] } else { &["m"] };
        assert_eq!(within(text, names).unwrap_err(), message, "{text}");
    }
}

proptest! {
    #[test]
    fn quantities_lie_within_any_text_in_order(text in "[0-9.e+−^*/·a-zmskg°²∧()_' ]{0,30}|\\PC*") {
        if let Ok(found) = quantities(&text, &|name| name == "x") {
            let mut end = 0;
            for (span, value) in found {
                prop_assert!(end <= span.start && span.start < span.end && value.is_finite());
                prop_assert!(text.get(span.clone()).is_some());
                end = span.end;
            }
        }
    }
}
