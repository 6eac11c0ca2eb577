//! Tests of errors in scenes and their places, and that no text panics.

use super::*;
use proptest::prelude::*;

#[test]
fn a_misspelt_field_is_shown_with_its_correction() {
    let shown = parse(&GOOD.replace("duration", "durration")).unwrap_err();
    assert_eq!(
        rendered(&shown),
        "x.toml:18:1: error: unknown field `durration`, expected `duration`\n   |\n\
         18 | durration = \"10 s\"\n   | ^^^^^^^^^\n"
    );
    let shown = parse(&GOOD.replace("\"5 rev/s\"", "\"5 m\"")).unwrap_err();
    assert_eq!(
        rendered(&shown),
        "x.toml:11:35: error: expected an angular rate such as `5 rev/s`, found a length (`5 m`)\n   |\n\
         11 | spin = { plane = \"-e2∧e3\", rate = \"5 m\", frame = \"space\" }\n   \
         |                                   ^^^^^\n"
    );
}

#[test]
fn all_errors_of_a_file_are_reported_in_order() {
    let text = "title = 3\ntilte = 1\n[body]\nsolid = 'bx'\n[initial]\nspin = { rate = '5 m' }\n[gravty]\n\
                [run]\nduration = -1\nsamples = 1\nmethod = 'euler'\nrtol = 2\n";
    assert_eq!(
        errors(text),
        [
            "1:9: expected a string, found an integer",
            "2:1: unknown field `tilte`, expected one of `title`, `caption`, `define`, `body`, `initial`, `gravity`, `torque`, \
             `force`, `run`, `method`, `ensemble`, `torque_body`, `torque_space`",
            "3:1: missing field in [body], expected one of `density`, `mass`",
            "4:9: unknown solid `bx`, expected one of `box`, `ellipsoid`, `sphere`, `hollow_sphere`, \
             `cylinder`, `cone`, `rod`, `disc`, `torus`, `capsule`",
            "6:8: missing field in `spin`, expected one of `plane`, `vector`, `bivector`, \
             `formula`",
            "7:2: unknown table `gravty`, expected `gravity`",
            "9:12: must be more than 0, found -1",
            "10:11: must be from 2 to 10000000, found 1",
            "11:10: unknown method `euler`, expected one of `auto`, `strang`, `yoshida4`, `yoshida6`, `kahan_li6`, \
             `kahan_li8`, `rkn6`, `rk4`, `dop853`, `midpoint`, `dmv`",
            "12:8: must be between 0 and 1, such as `1e-10`, found 2",
        ]
    );
}

#[test]
fn words_of_other_programs_have_their_names_here() {
    assert_eq!(
        errors_with("duration = 10", "duration = 10\ndt = 1\nmethod = 'RK45'"),
        ["7:1: unknown field `dt`, expected `interval`", "8:10: unknown method `RK45`, expected `dop853`"]
    );
    assert_eq!(
        errors_with("[run]", "rates = 1\n[torque]\ngravity = 9.81\nwheel = [1, 2, 3]\n[run]"),
        [
            "5:1: unknown field `rates`, expected `spin`",
            "7:1: unknown field `gravity`, expected `heavy`",
            "8:1: unknown field `wheel`, expected `gyrostat`"
        ]
    );
}

#[test]
fn fields_that_exclude_each_other_are_reported_at_the_second() {
    assert_eq!(
        errors_with("moments = [3, 2, 1]", "moments = [3, 2, 1]\nsolid = 'box'"),
        ["3:1: `solid` conflicts with `moments`, give only one of them"]
    );
    assert_eq!(
        errors_with("duration = 10", "interval = 1\nsamples = 3\nduration = 10"),
        ["7:1: `samples` conflicts with `interval`, give only one of them"]
    );
    assert_eq!(
        errors_with("[3, 2, 1]", "[3, 2, 1]\ndensity = 1"),
        ["3:1: `density` does not go with `moments`; fields that do: `mass`, `center_of_mass`"]
    );
    assert_eq!(
        errors_with("vector = [0, 0, 1]", "vector = [0, 0, 1], rate = 1"),
        ["4:30: `rate` does not go with `vector`; remove it"]
    );
    assert_eq!(
        errors_with("moments = [3, 2, 1]", "solid = 'box'\nlengths = [1, 1, 1]\nradius = 1\nmass = 1"),
        ["4:1: `radius` does not go with `box`; fields that do: `lengths`"]
    );
    assert_eq!(
        errors_with("moments = [3, 2, 1]", "solid = 'rod'\nlength = 1\nmass = 1\ndensity = 1"),
        ["5:1: `density` conflicts with `mass`, give only one of them"]
    );
}

#[test]
fn missing_fields_are_reported_at_their_table() {
    assert_eq!(
        errors_with("moments = [3, 2, 1]", "solid = 'cylinder'"),
        [
            "1:1: missing field `radius` in [body]",
            "1:1: missing field `height` in [body]",
            "1:1: missing field in [body], expected one of `density`, `mass`"
        ]
    );
    assert_eq!(errors_with("vector = [0, 0, 1]", "plane = 'e1e2'"), ["4:8: missing field `rate` in `spin`"]);
    assert_eq!(
        errors_with("spin", "attitude = { quaternion = [1, 0, 0, 0] }\nspin"),
        ["4:12: missing field `order` in `attitude`"]
    );
    assert_eq!(
        errors("title = 'x'  \n\n"),
        ["1:12: missing table [body]", "1:12: missing table [initial]", "1:12: missing table [run]"]
    );
}

#[test]
fn fields_with_a_suggested_name_are_not_missing() {
    let table = [
        ("spin = { vector", "omega = { vector", "4:1: unknown table `omega`, expected `spin`"),
        ("vector = [0", "vectr = [0", "4:10: unknown field `vectr`, expected `vector`"),
        ("[run]", "[rum]", "5:2: unknown table `rum`, expected `run`"),
        ("moments = [3", "moment = [3", "2:1: unknown field `moment`, expected `moments`"),
    ];
    for (old, new, message) in table {
        assert_eq!(errors_with(old, new), [message]);
    }
    // Only the suggested one of two, and only in the same table.
    assert_eq!(
        errors_with("moments = [3, 2, 1]", "solid = 'cylinder'\nradus = 1\nmass = 1"),
        ["1:1: missing field `height` in [body]", "3:1: unknown field `radus`, expected `radius`"]
    );
    let other = errors_with("[run]", "[run]\n[force]\ndrag = 1");
    assert_eq!(other[0], "5:1: missing field `duration` in [run]");
    assert!(other[1].starts_with("8:1: unknown field `duration`"), "{other:?}");
}

#[test]
fn text_in_utf_16_without_a_mark_is_named() {
    let text: String = LEAST.chars().flat_map(|c| [c, '\0']).collect();
    assert_eq!(errors(&text), ["1:2: byte 1 is zero, not text; save the file as UTF-8"]);
}

#[test]
fn wrong_types_and_sizes_are_named() {
    let table = [
        ("moments = [3, 2, 1]", "moments = 3", "2:11: expected an array of 3 numbers, found an integer"),
        ("moments = [3, 2, 1]", "moments = [3, 2]", "2:11: expected 3 numbers, found 2"),
        (
            "[3, 2, 1]",
            "[3, true, 1]",
            "2:15: expected a moment of inertia such as `\"3 kg m^2\"`, found a boolean",
        ),
        ("[3, 2, 1]", "[3, nan, 1]", "2:15: `nan` is not a finite number"),
        ("[3, 2, 1]", "[3, 1e999, 1]", "2:15: `1e999` is not a finite number"),
        (
            "[3, 2, 1]",
            "[3, 9007199254740993, 1]",
            "2:15: the integer is beyond 2^53; write it with a decimal point",
        ),
        (
            "moments = [3, 2, 1]",
            "inertia = [[1, 0, 0], 0, [0, 0, 1]]",
            "2:23: expected an array of 3 numbers, found an integer",
        ),
        (
            "moments = [3, 2, 1]",
            "mesh = ''\nmass = 1",
            "2:8: expected the path of a mesh file, relative to the scene file",
        ),
        ("moments = [3, 2, 1]", "mesh = 'a'\nmass = 0", "3:8: must be more than 0, found 0"),
        ("duration = 10", "duration = 10\nsamples = 1e3", "7:11: expected a whole number, found a float"),
        (
            "duration = 10",
            "duration = 1979-05-27",
            "6:12: expected a time such as `\"10 s\"`, found a date or time",
        ),
        (
            "duration = 10",
            "duration = '10'",
            "6:12: expected a time such as `10 s`, found `10` without a unit",
        ),
        (
            "duration = 10",
            "duration = 1e305",
            "6:12: a duration of 1e305 s is too long to divide into samples",
        ),
        ("{ vector = [0, 0, 1] }", "3", "4:8: expected the table `spin`, found an integer"),
        ("[run]", "[[run]]", "5:1: expected the table [run], found an array"),
    ];
    for (old, new, message) in table {
        assert_eq!(errors_with(old, new), [message]);
    }
    // A row that holds several errors shows each.
    assert_eq!(errors_with("[3, 2, 1]", "['x', 2, '1 m']").len(), 2);
}

#[test]
fn an_attitude_of_zero_is_reported_at_its_value() {
    let message = "4:22: all components are zero, which is not a rotor; give the identity as 1, 0, 0, 0";
    assert_eq!(errors_with("spin", "attitude = { rotor = [0, 0, 0, 0] }\nspin"), [message]);
    let message =
        "4:22: a zero bivector does not define a plane, expected one such as `\"e1e2\"` or `[0, 0, 1]`";
    assert_eq!(errors_with("spin", "attitude = { plane = [0, 0, 0], angle = 1 }\nspin"), [message]);
}

#[test]
fn an_interval_must_divide_the_duration() {
    let with = |run: &str| errors_with("duration = 10", &format!("duration = 10\n{run}"));
    let message = "7:12: does not divide the duration of 10 s, write `samples = 4` instead";
    assert_eq!(with("interval = 3"), [message]);
    let message = "7:12: does not divide the duration of 10 s, write `samples = 2` instead";
    assert_eq!(with("interval = 30"), [message]);
    let message = "7:12: gives more than 10000000 samples in 10 s, make it longer";
    assert_eq!(with("interval = '1 us'"), [message]);
    assert_eq!(with("interval = 1e-320"), [message]);
}

#[test]
fn syntax_errors_have_a_place() {
    assert_eq!(errors("[body\n"), ["1:6: unclosed table, expected `]`"]);
    assert_eq!(errors("a = 1\na = 2\n"), ["2:1: duplicate key `a`, which this table has already"]);
    for (line, remedy) in [
        ("duration = 10 s", "write `\"10 s\"`, because a value with a unit needs quotes"),
        ("moments = [3 2 1]", "separate numbers by commas, `3, 2, 1`"),
        ("moments = 3 2 1", "separate numbers by commas, `[3, 2, 1]`"),
        ("order = wxyz", "write `\"wxyz\"`"),
        ("order = None", "write `\"None\"`"),
        ("order = true-north", "write `\"true-north\"`"),
        ("duration =", "write a value after `=`"),
        ("mesh = \"a\\q.obj\"", "write a path with `/`, or in single quotes"),
        ("mesh = \"C:\\Users\\q.obj\"", "write a path with `/`, or in single quotes"),
    ] {
        let [error] = &errors(line)[..] else { panic!("one error") };
        assert!(error.ends_with(&format!("; {remedy}")), "{error}");
    }
    assert_eq!(errors("a = \"x\ty\u{1}\"\n").len(), 1);
    assert_eq!(errors(" \r\n "), ["the file is empty, a scene needs the tables [body], [initial] and [run]"]);
    for deep in ["[", "{a=", "[{a="] {
        assert_eq!(errors(&format!("a = {}", deep.repeat(5000))).len(), 1);
    }
    assert_eq!(errors(&format!("a{} = 1", ".a".repeat(5000))).len(), 1);
}

#[test]
fn the_number_of_reported_errors_is_limited() {
    let text: String = (0..100_000).map(|i| format!("a{i} = 1\n")).collect();
    let errors = errors(&text);
    assert_eq!((errors.len(), errors[100].as_str()), (101, "and 99903 more"));
}

#[test]
fn later_errors_are_reported_at_their_field() {
    let scene = scene(GOOD);
    let at = |field| scene.diagnose(field, "m").position;
    assert_eq!(at("body.mesh"), Some((5, 8)));
    assert_eq!(at("body.density"), Some((7, 11)));
    assert_eq!(at("body.mass"), Some((4, 1)));
    assert_eq!(at("initial.spin.rate"), Some((11, 35)));
    assert_eq!(at("gravity.pivot"), Some((15, 9)));
    assert_eq!(
        scene.diagnose("body.mesh", "the surface is open").to_string(),
        "x.toml:5:8: error: the surface is open\n  |\n5 | mesh = \"parts/t-handle.stl\"\n  |        ^^^^^^^^^^^^^^^^^^^^"
    );
}

proptest! {
    #[test]
    fn no_text_panics(text in "(\\PC|[\t\r\n=\\[\\]{}\"'.,#])*") {
        let _ = parse(&text);
    }

    /// Bytes deleted, doubled or replaced, and the end cut off.
    #[test]
    fn no_mutation_of_a_scene_panics(
        edits in prop::collection::vec((0usize..GOOD.len(), 0u8..3, any::<u8>()), 0..4),
        end in 0usize..2 * GOOD.len(),
    ) {
        let mut bytes = GOOD.as_bytes().to_vec();
        for (at, edit, byte) in edits {
            let at = at.min(bytes.len() - 1);
            match edit {
                0 => { bytes.remove(at); }
                1 => bytes.insert(at, bytes[at]),
                _ => bytes[at] = byte,
            }
        }
        bytes.truncate(end);
        let text = String::from_utf8_lossy(&bytes);
        match parse(&text) {
            Ok(scene) => prop_assert_eq!(scene.times().len(), scene.run.samples),
            Err(errors) => {
                prop_assert!(!errors.is_empty());
                let lines = text.lines().count().max(1);
                for (line, _) in errors.iter().filter_map(|error| error.position) {
                    prop_assert!(line <= lines + 1);
                }
            }
        }
    }
}

#[test]
fn errors_in_formulas_have_a_place_in_the_file() {
    let table = [
        ("'fast'", "4:9: `fast` has no value as one name; read as adjacent letters, f, a, s, t have none"),
        ("'5 rev/s e1'", "4:8: expected a bivector, found a part of grade 1"),
        ("'5 rev/s e1∧q'", "4:20: `q` has no value"),
        ("'5 rev/s (e1∧e2'", "4:17: `(` is never closed"),
        ("'e12/0'", "4:9: division by zero"),
        ("'e12 = e21'", "4:9: an equation has no value, write one side"),
        ("'1e+300 1e+300 e12'", "4:9: two numbers side by side"),
        ("'1e+300*1e+300 e12'", "4:9: the value is not finite"),
        ("{ formula = 'e1e2 + 5 s/s e1' }", "4:20: expected a bivector, found a part of grade 1"),
    ];
    for (spin, message) in table {
        let found = errors_with("{ vector = [0, 0, 1] }", spin);
        assert_eq!(found.len(), 1, "{spin}: {found:?}");
        assert!(found[0].starts_with(message), "{spin}: {found:?}");
    }
    let message = "4:12: expected a rotor, found a part of grade 1";
    assert_eq!(errors_with("spin", "attitude = '1 + e1'\nspin"), [message]);
}

#[test]
fn errors_in_definitions_have_a_place() {
    let table = [
        ("a = 'b'\nb = 1", "2:6: `b` has no value; no names have values here"),
        ("'a b' = 1", "2:1: expected a name"),
        ("a1 = 1\na_1 = 2", "3:1: `a1` is defined twice"),
        ("'f(x)' = 1", "2:10: expected a string, found an integer"),
        ("'f(x)' = 'x + y'", "2:15: `y` has no value"),
        ("'f(x)' = 'f(x)'", "2:11: `f` has no value"),
        ("'f(t)' = '2 t e1'", "2:13: `t` is a unit and a name here"),
        ("a = true", "2:5: expected a string, found a boolean"),
    ];
    for (text, message) in table {
        let found = errors(&format!("[define]\n{text}\n{LEAST}"));
        assert!(found[0].starts_with(message), "{text}: {found:?}");
    }
}
