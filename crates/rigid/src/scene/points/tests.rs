//! Tests of grids, lists and tables of points.

use crate::ensemble::Ensemble;
use crate::scene::{Given, Scene};
use std::ops::Range;
use std::path::Path;

const BASE: &str = "[define]\nk = 2\n[body]\nmoments = [3, 2, 1]\nmass = 2\n\
    [initial]\nattitude = { plane = 'e1e2', angle = '30 deg' }\n\
    spin = { vector = [0, '1 rev/s', 0.1], frame = 'space' }\n\
    [torque]\ntorque_body = '-k/100 Ω_B'\nviscous_damping = 0.1\n\
    magnetic = { dipole = [0, 0, 1], field = [0, 1e-5, 0] }\n\
    [force]\ndrag = 0.5\nconstant = [0, 0, 1]\n\
    [run]\nduration = 10\n";

/// A table of points.
fn table(path: &Path) -> Result<String, String> {
    match path.to_str() {
        Some("folder/good.csv") => {
            Ok("\u{feff}initial.spin.vector[1], torque.viscous_damping,body.moments\r\n\
            1e0,\"0.2 N m s/rad\", \"[3, 2, 2]\"\r\n\n 2.5 ,+.3,\"[4,3,2]\"\n"
                .to_owned())
        }
        Some("folder/cells.csv") => {
            Ok("initial.spin.vector[1],torque.viscous_damping\n1,2\n3,5,6\n".to_owned())
        }
        Some("folder/empty.csv") => Ok("initial.spin.vector[1],torque.viscous_damping\n1,\n".to_owned()),
        Some("folder/rows.csv") => Ok("initial.spin.vector[1]\n".to_owned()),
        Some("folder/quote.csv") => Ok("initial.spin.vector[1]\n\"1\n".to_owned()),
        Some("folder/blank.csv") => Ok("torque.viscous_damping\n\n1\n".to_owned()),
        Some("folder/semicolons.csv") => Ok("torque.viscous_damping;force.drag\n1;2\n".to_owned()),
        Some("folder/index.csv") => Ok(",torque.viscous_damping\n0,1\n".to_owned()),
        Some("folder/level.csv") => Ok("__index_level_0__,torque.viscous_damping\n0,1\n".to_owned()),
        Some("folder/id.csv") => Ok("\nid,torque.viscous_damping\n0,1\n".to_owned()),
        Some("folder/near.csv") => Ok("torque.viscous_damp\n1\n".to_owned()),
        Some("folder/twice.csv") => Ok("force.drag,force.drag\n1,2\n".to_owned()),
        Some("folder/infinite.csv") => Ok("force.drag\n-Infinity\n1e999\nNaN\n".to_owned()),
        Some("folder/rows.parquet") => Ok("force.drag\n1\n1 m\n".to_owned()),
        Some("folder/id.parquet") => Ok("index,force.drag\n0,1\n".to_owned()),
        Some("folder/end.csv") => Ok("force.drag\n1\n2\n\n\n".to_owned()),
        Some("folder/units.csv") => Ok("torque.viscous_damping\n2\n2 m\n-1\n".to_owned()),
        _ => Err("no such file".to_owned()),
    }
}

fn parse(text: &str) -> Result<Scene, Vec<String>> {
    let brief = |error: &crate::Diagnostic| match error.position {
        Some((line, column)) => format!("{line}:{column}: {}", error.message),
        None => error.message.clone(),
    };
    let briefs = |errors: Vec<crate::Diagnostic>| errors.iter().map(brief).collect::<Vec<_>>();
    let scene = Scene::parse_with(text, Path::new("folder/x.toml"), &table).map_err(briefs)?;
    scene.build().map_err(briefs)?;
    Ok(scene)
}

fn scene(text: &str) -> Scene {
    parse(text).unwrap_or_else(|errors| panic!("{text}\n{errors:?}"))
}

fn with(ensemble: &str) -> String {
    format!("{BASE}[ensemble]\n{ensemble}\n")
}

fn bodies(scene: &Scene, range: Range<usize>) -> Ensemble {
    let (body, laws) = scene.build().unwrap();
    scene.bodies(scene.ensemble.as_ref().unwrap(), (&body, &laws), range).unwrap()
}

/// All numbers of a body's motion, as text, whose digits determine the bits.
fn of(ensemble: &Ensemble, body: usize) -> String {
    let laws: Vec<_> = ensemble.laws.iter().map(|law| law.of(body).registered().map(|(_, x)| x)).collect();
    let forces: Vec<_> = ensemble.forces.iter().map(|force| format!("{:?}", force.of(body))).collect();
    let (start, inertia) = (ensemble.starts[body], ensemble.inertias.of(body).matrix());
    format!("{start:?} {inertia:?} {laws:?} {forces:?} {}", ensemble.masses.of(body))
}

/// The same of the one body of a scene without points, in which texts are replaced.
fn alone(replaced: &[(&str, &str)]) -> String {
    let mut text = BASE.to_owned();
    for (old, new) in replaced {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    // A variation of width 0 is none.
    let crowd = scene(&format!("{text}[ensemble]\nnumber = 1\nspin = {{ uniform = 0 }}\n"));
    of(&bodies(&crowd, 0..1), 0)
}

fn all(scene: &Scene) -> Vec<String> {
    let number = scene.ensemble.as_ref().unwrap().number;
    let drawn = bodies(scene, 0..number);
    (0..number).map(|body| of(&drawn, body)).collect()
}

#[test]
fn a_grid_is_a_product_whose_last_field_varies_fastest() {
    let text = with(
        "grid.torque.viscous_damping = ['0.2 N m s/rad', [1, 2, 3]]\n\
         grid.initial.spin.vector = [[1, 2, 3], ['1 deg/s', 0, 0], [0, 0, 4]]",
    );
    let found = all(&scene(&text));
    let mut expected = Vec::new();
    for damping in ["'0.2 N m s/rad'", "[1, 2, 3]"] {
        for spin in ["[1, 2, 3]", "['1 deg/s', 0, 0]", "[0, 0, 4]"] {
            expected.push(alone(&[
                ("viscous_damping = 0.1", &format!("viscous_damping = {damping}")),
                ("[0, '1 rev/s', 0.1]", spin),
            ]));
        }
    }
    assert_eq!(found, expected);
}

#[test]
fn lists_are_side_by_side() {
    let text = with(
        "list.body = { moments = [[3, 2, 2], [4, 3, 2]], mass = ['1 kg', 3] }\n\
         list.force.drag = [1, 2]\nlist.initial.position = [[1, 2, 3], 'e1 + k e2']\n\
         list.initial.attitude = ['exp(-e12)', { plane = 'e1e2', angle = 1 }]",
    );
    let point = |moments: &str, mass: &str, drag: &str, place: &str, attitude: &str| {
        alone(&[
            ("moments = [3, 2, 1]", &format!("moments = {moments}")),
            ("mass = 2", &format!("mass = {mass}")),
            ("drag = 0.5", &format!("drag = {drag}")),
            ("{ plane = 'e1e2', angle = '30 deg' }", &format!("{attitude}\nposition = {place}")),
        ])
    };
    let expected = [
        point("[3, 2, 2]", "'1 kg'", "1", "[1, 2, 3]", "'exp(-e12)'"),
        point("[4, 3, 2]", "3", "2", "'e1 + k e2'", "{ plane = 'e1e2', angle = 1 }"),
    ];
    assert_eq!(all(&scene(&text)), expected);
}

#[test]
fn a_table_has_a_row_for_each_body() {
    let crowd = scene(&with("table = 'good.csv'"));
    let point = |spin: &str, damping: &str, moments: &str| {
        alone(&[
            ("moments = [3, 2, 1]", &format!("moments = {moments}")),
            ("'1 rev/s'", spin),
            ("viscous_damping = 0.1", &format!("viscous_damping = {damping}")),
        ])
    };
    assert_eq!(all(&crowd), [point("1", "0.2", "[3, 2, 2]"), point("2.5", "0.3", "[4, 3, 2]")]);
}

#[test]
fn ranges_have_equal_steps_or_ratios() {
    let text = with(
        "list.torque.viscous_damping = { from = 1e-3, to = 10, number = 5, spacing = 'log' }\n\
         list.'initial.spin.vector[0]' = { from = '1 deg/s', to = '3 deg/s', number = 5 }",
    );
    let crowd = scene(&text);
    let points = crowd.ensemble.as_ref().unwrap().points.as_ref().unwrap();
    let [(_, Given::Numbers(damping, 1, "")), (_, Given::Numbers(spins, 1, "rad/s"))] =
        &points.given(&crowd.text, 0..5)[..]
    else {
        panic!("{points:?}")
    };
    for k in 0..5 {
        // Some roundings each.
        assert!((damping[k] / (1e-3 * 10f64.powi(k as i32)) - 1.0).abs() < 1e-14);
        assert!((spins[k] / (1.0 + 0.5 * k as f64).to_radians() - 1.0).abs() < 1e-15);
    }
    assert_eq!((damping[0], damping[4]), (1e-3, 10.0));
}

#[test]
fn ranges_have_bounded_text() {
    let unit = "s ".repeat(4000);
    let range = format!("{{ from = '1 {unit}', to = '2 {unit}', number = 10_000_000 }}");
    let errors = parse(&with(&format!("grid.torque.viscous_damping = {range}"))).unwrap_err();
    assert!(errors[0].contains("more than 4 GB of text"), "{errors:?}");
}

#[test]
fn defined_values_vary_in_formulas() {
    let crowd = scene(&with("grid.define.k = [1, '3']"));
    let drawn = bodies(&crowd, 0..2);
    for (body, k) in [(0, "1"), (1, "3")] {
        let own = alone(&[("k = 2", &format!("k = {k}"))]);
        assert_eq!(of(&drawn, body), own);
        let text = BASE.replace("k = 2", &format!("k = {k}"));
        let one = scene(&text);
        let (built, laws) = one.build().unwrap();
        let times = [0.0, 1.0, 2.0];
        let peer = one.problem(&built, &laws).simulate(&times, one.options(), &mut |_| true).unwrap();
        let motion = drawn.problem(body).simulate(&times, one.options(), &mut |_| true).unwrap();
        assert_eq!(format!("{:?}", peer.states()), format!("{:?}", motion.states()));
    }
}

#[test]
fn blocks_have_the_bodies_of_the_whole() {
    let text = with(
        "number = 12\nseed = 3\ngrid.torque.viscous_damping = [1, 2]\ngrid.body.moments = [[3, 2, 2], [4, 3, 2]]\n\
         moments = { relative = 0.01 }\nspin = { normal = 0.1 }\ntorque.viscous_damping = { relative = 0.1 }",
    );
    let crowd = scene(&text);
    let whole = all(&crowd);
    let blocks = [0..1, 1..5, 5..12].into_iter().flat_map(|range| {
        let drawn = bodies(&crowd, range.clone());
        (0..range.len()).map(move |body| of(&drawn, body)).collect::<Vec<_>>()
    });
    assert_eq!(whole, blocks.collect::<Vec<_>>());
    let more = scene(&text.replace("number = 12", "number = 16"));
    assert_eq!(whole, all(&more)[..12]);
}

#[test]
fn random_parameters_vary_about_the_own_point() {
    let random = "seed = 5\nspin = { normal = 0.1 }\ntorque.viscous_damping = { relative = 0.1 }";
    let crowd = scene(&with(&format!("number = 4\n{random}\ngrid.torque.viscous_damping = [1, 2]")));
    for (body, found) in all(&crowd).into_iter().enumerate() {
        let text = BASE.replace("viscous_damping = 0.1", &format!("viscous_damping = {}", 1 + body % 2));
        let peer = scene(&format!("{text}[ensemble]\nnumber = 4\n{random}\n"));
        assert_eq!(found, all(&peer)[body]);
    }
}

#[test]
fn the_pivot_and_gravity_vary() {
    let held = BASE.replace("mass = 2\n", "mass = 2\ncenter_of_mass = [0, 0, 1]\n").replace(
        "[force]\ndrag = 0.5\nconstant = [0, 0, 1]\n",
        "[gravity]\nacceleration = 9.81\npivot = [0, 0, 0]\n",
    );
    let crowd = scene(&format!(
        "{held}[ensemble]\nlist.gravity.acceleration = [1, 2]\nlist.gravity.pivot = [[0, 0, -1], [1, 0, 0]]\n"
    ));
    let found = all(&crowd);
    for (body, (acceleration, pivot)) in [("1", "[0, 0, -1]"), ("2", "[1, 0, 0]")].into_iter().enumerate() {
        let text =
            held.replace("9.81", acceleration).replace("pivot = [0, 0, 0]", &format!("pivot = {pivot}"));
        let peer = scene(&format!("{text}[ensemble]\nnumber = 1\nspin = {{ uniform = 0 }}\n"));
        assert_eq!(found[body], all(&peer)[0]);
    }
}

#[test]
fn errors_name_the_point() {
    let table = [
        (
            "grid.torque.viscous_damping = [1, '2 m']",
            "19:35: expected a torque per angular rate such as `0.1 N m s`, found a length (`2 m`)",
        ),
        ("grid.torque.viscous_damping = [1, -1]", "must not be negative"),
        ("grid.body.moments = [[3, 2, 1], [9, 1, 1]]", "point 1, body.moments = [9, 1, 1]: "),
        ("grid.initial.spin.rate = [1]", "`rate` does not go with `vector`"),
        ("grid.run.duration = [1]", "`run` is the same for all bodies"),
        ("grid.initial.time = [1]", "the initial time is the same for all bodies"),
        ("grid.initial = [1]", "expected a value in [initial], such as `initial.name`"),
        ("grid.gravity.acceleration = [1]", "the scene has no `gravity`"),
        ("grid.torque.damping = [1]", "the scene has no `torque.damping`"),
        (
            "grid.torque.torque_body = ['0 e12']",
            "`torque_body` is the same for all bodies; values of [define]",
        ),
        (
            "grid.'initial.spin.vector[3]' = [1]",
            "the scene has no `initial.spin.vector[3]`; `initial.spin.vector` has 3 items, from [0]",
        ),
        ("grid.'initial.spin.vector[' = [1]", "expected the path of a scene value"),
        ("grid.'initial.spin.vector[0]' = [1]\ngrid.initial.spin.vector = [[1, 2, 3]]", "is given twice"),
        ("grid = {}", "no values; write lists at the paths of scene values"),
        ("grid.torque.viscous_damping = []", "no values; write at least one"),
        ("grid.torque.viscous_damping = 1", "expected an array of values, or a range"),
        ("grid.torque.viscous_damping = { from = 1, to = '2 N m s', number = 3 }", "must have the same unit"),
        (
            "grid.torque.viscous_damping = { from = 0, to = 2, number = 3, spacing = 'log' }",
            "equal ratios need",
        ),
        ("grid.torque.viscous_damping = { from = 1, to = 2, number = 1 }", "must be from 2 to"),
        ("grid.torque.viscous_damping = { from = 1, to = 2 }", "missing field `number`"),
        (
            "list.torque.viscous_damping = [1, 2]\nlist.force.drag = [1, 2, 3]",
            "lists must have equal lengths",
        ),
        ("list.force.drag = [1]\ngrid.force.drag = [1]", "conflicts with"),
        ("number = 3\nlist.force.drag = [1, 2]", "must be the number of points, 2, found 3"),
        ("number = 3\nlist.force.drag = [1, 2]\nspin = { normal = 1 }", "2, or a multiple of it, found 3"),
        (
            "list.initial.spin.vector = [[1, 2, 3], [0, 0, 0]]\nspin = { relative = 0.1 }",
            "any multiple of 0 is 0; write `normal` or `uniform` (point 1, ",
        ),
        (
            "table = 'units.csv'",
            "units.csv, line 3, column `torque.viscous_damping`: expected a torque per angular",
        ),
        ("table = 'units.csv'", "units.csv, line 4, column `torque.viscous_damping`: must not be negative"),
        ("table = 'cells.csv'", "cells.csv, line 3: expected 2 cells as in the header, found 3"),
        ("table = 'empty.csv'", "line 2, column `torque.viscous_damping`: the cell is empty"),
        (
            "table = 'blank.csv'",
            "19:9: blank.csv, line 2, column `torque.viscous_damping`: the cell is empty",
        ),
        (
            "table = 'semicolons.csv'",
            "semicolons.csv, line 1: the cells are separated by semicolons; separate",
        ),
        (
            "table = 'index.csv'",
            "index.csv, line 1: column 1 has no name; remove the column, or write the file by pandas with `index=False`",
        ),
        (
            "table = 'level.csv'",
            "level.csv, line 1: `__index_level_0__` is not the path of a scene value; remove the column, or write",
        ),
        (
            "table = 'id.csv'",
            "id.csv, line 2: `id` is not the path of a scene value; rename or remove the column",
        ),
        (
            "table = 'near.csv'",
            "near.csv, line 1: the scene has no `torque.viscous_damp`; did you mean `torque.viscous_damping`?",
        ),
        ("table = 'twice.csv'", "twice.csv, line 1: `force.drag` is given twice"),
        (
            "table = 'infinite.csv'",
            "infinite.csv, line 2, column `force.drag`: `-inf` is not a finite number",
        ),
        (
            "table = 'infinite.csv'",
            "infinite.csv, line 3, column `force.drag`: `1e999` is not a finite number",
        ),
        ("table = 'infinite.csv'", "infinite.csv, line 4, column `force.drag`: `nan` is not a finite number"),
        ("table = 'rows.parquet'", "rows.parquet, row 1 (from 0), column `force.drag`: expected a"),
        (
            "table = 'id.parquet'",
            "id.parquet: `index` is not the path of a scene value; remove the column, or",
        ),
        (
            "grid.vector = [[1, 2, 3]]",
            "`vector` is not the path of a scene value; did you mean `initial.spin.vector`?",
        ),
        (
            "list.froce.drag = [1]",
            "`froce.drag` is not the path of a scene value; did you mean `force.drag`?",
        ),
        ("grid.inital.spin.vector = [1]", "did you mean `initial.spin.vector`?"),
        ("grid.define.kk = [1]", "the scene has no `define.kk`; did you mean `define.k`?"),
        (
            "number = 2\ncovariance = { of = [], matrix = [] }",
            "no names; write at least one random parameter",
        ),
        (
            "number = 2\ncovariance = { of = ['spin'], matrix = [[1, 0, 0], [0, 1], [0, 0, 1]] }",
            "expected 3 rows of 3 numbers, for spin[0], spin[1], spin[2]; row 2 of them has 2 numbers",
        ),
        (
            "number = 2\ncovariance = { of = ['spin'], matrix = [[1, 0, 0]] }",
            "expected 3 rows of 3 numbers, for spin[0], spin[1], spin[2]; found 1 row",
        ),
        (
            "number = 2\ncovariance = { of = ['viscous_dampin'], matrix = [[1]] }",
            "unknown parameter `viscous_dampin`, expected `torque.viscous_damping`",
        ),
        (
            "number = 2\ncovariance = { of = ['id'], matrix = [[1]] }",
            "unknown parameter `id`, expected `attitude`, ",
        ),
        ("table = 'rows.csv'", "rows.csv has no rows"),
        ("table = 'quote.csv'", "has no closing quote"),
        ("table = 'none.csv'", "no such file"),
    ];
    for (ensemble, message) in table {
        let found = parse(&with(ensemble)).map(|_| panic!("{ensemble}")).unwrap_err();
        assert!(found.iter().any(|error| error.contains(message)), "{ensemble}\n{found:#?}\n{message}");
    }
    let mesh = BASE.replace("moments = [3, 2, 1]", "mesh = 'a.stl'");
    let errors =
        Scene::parse(&format!("{mesh}[ensemble]\ngrid.body.mass = [1]\n"), Path::new("x.toml")).unwrap_err();
    assert!(errors[0].message.contains("a mesh is the same for all bodies"), "{errors:?}");
}

#[test]
fn blank_lines_at_the_end_are_not_rows() {
    assert_eq!(scene(&with("table = 'end.csv'")).ensemble.unwrap().number, 2);
}

#[test]
fn texts_are_given_without_quotes() {
    let crowd = scene(&with("grid.initial.attitude = ['exp(-e12)', { plane = 'e1e2', angle = 1 }]"));
    let points = crowd.ensemble.as_ref().unwrap().points.as_ref().unwrap();
    let texts = ["exp(-e12)", "{ plane = 'e1e2', angle = 1 }"].map(str::to_owned).to_vec();
    assert_eq!(points.given(&crowd.text, 0..2), [("initial.attitude".to_owned(), Given::Texts(texts))]);
}

#[test]
fn an_error_of_many_points_is_reported_once() {
    let text =
        with("grid.torque.viscous_damping = [1, 'x']\ngrid.force.drag = { from = 1, to = 2, number = 1000 }");
    assert_eq!(parse(&text).map(|_| ()).unwrap_err().len(), 1);
}
