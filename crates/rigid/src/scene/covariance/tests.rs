//! Tests of correlated variations.

use super::factor;
use crate::scene::Scene;
use std::path::Path;

const BASE: &str = "[body]\nmoments = [3, 2, 1]\n[initial]\nspin = { vector = [0.1, 0, 1] }\n\
    [torque]\ndamping = 1\n[run]\nduration = 10\n[ensemble]\nseed = 4\n";

fn parse(ensemble: &str) -> Result<Scene, String> {
    Scene::parse(&format!("{BASE}{ensemble}\n"), Path::new("x.toml"))
        .map_err(|errors| errors.iter().map(|error| error.message.clone()).collect::<Vec<_>>().join("\n"))
}

/// Angular velocities and damping of the bodies.
fn drawn(ensemble: &str, number: usize) -> Vec<[f64; 4]> {
    let scene = parse(&format!("number = {number}\n{ensemble}")).unwrap();
    let (body, laws) = scene.build().unwrap();
    let all = scene.bodies(scene.ensemble.as_ref().unwrap(), (&body, &laws), 0..number).unwrap();
    let row = |k: usize| {
        let [x, y, z] = all.starts[k].omega.0;
        [x, y, z, all.laws[0].of(k).registered().unwrap().1[0]]
    };
    (0..number).map(row).collect()
}

#[test]
fn a_diagonal_matrix_gives_the_draws_of_single_widths() {
    let apart = "spin = { normal = [0.1, 0.2, 0] }\ntorque.damping = { normal = 0.03 }";
    let matrix = format!(
        "[[{:?}, 0, 0, 0], [0, {:?}, 0, 0], [0, 0, 0, 0], [0, 0, 0, {:?}]]",
        0.1 * 0.1,
        0.2 * 0.2,
        0.03 * 0.03
    );
    let joint = format!("covariance = {{ of = ['spin', 'torque.damping'], matrix = {matrix} }}");
    assert_eq!(drawn(apart, 100), drawn(&joint, 100));
    // In the other order, and in two groups.
    let groups = format!(
        "covariance = [{{ of = ['torque.damping'], matrix = [[{:?}]] }}, {{ of = ['spin'], matrix = \
         [[{:?}, 0, 0], [0, {:?}, 0], [0, 0, 0]] }}]",
        0.03 * 0.03,
        0.1 * 0.1,
        0.2 * 0.2
    );
    assert_eq!(drawn(apart, 100), drawn(&groups, 100));
}

#[test]
fn samples_have_the_covariance() {
    // The damping follows from the first two: the matrix is singular.
    let (a, b) = (0.01, 0.02);
    let t = [[0.1, 0.0, 0.0], [0.05, 0.1, 0.0], [-0.02, 0.01, 0.05], [a, b, 0.0]];
    let c: Vec<Vec<f64>> =
        t.iter().map(|x| t.iter().map(|y| x.iter().zip(y).map(|(x, y)| x * y).sum()).collect()).collect();
    let n = 20_000;
    let rows = drawn(&format!("covariance = {{ of = ['spin', 'torque.damping'], matrix = {c:?} }}"), n);
    let nominal = [0.1, 0.0, 1.0, 1.0];
    let mean = |f: &dyn Fn(&[f64; 4]) -> f64| rows.iter().map(f).sum::<f64>() / n as f64;
    for i in 0..4 {
        // Five standard errors: √(C_ii/n) of a mean, √((C_ii C_jj + C_ij²)/n) of a product.
        let error = mean(&|row| row[i] - nominal[i]).abs();
        assert!(error < 5.0 * (c[i][i] / n as f64).sqrt(), "{i} {error}");
        for j in 0..4 {
            let found = mean(&|row| (row[i] - nominal[i]) * (row[j] - nominal[j]));
            let usual = ((c[i][i] * c[j][j] + c[i][j] * c[i][j]) / n as f64).sqrt();
            assert!((found - c[i][j]).abs() < 5.0 * usual, "{i} {j} {found} {}", c[i][j]);
        }
    }
    // Solved for the normals, the last component has no noise of its own.
    for row in &rows {
        let u = (row[0] - 0.1) / 0.1;
        let v = (row[1] - 0.05 * u) / 0.1;
        // The semidefinite matrix is rounded: its least variance is known to 1e-12 of the largest.
        assert!((row[3] - 1.0 - a * u - b * v).abs() < 1e-5);
    }
}

#[test]
fn the_factor_of_a_matrix_is_lower_triangular() {
    let names = ["a", "b"].map(str::to_owned);
    let found = factor(&[vec![4.0, 2.0], vec![2.0, 5.0]], &names).unwrap();
    assert_eq!(found, [vec![2.0], vec![1.0, 2.0]]);
    let singular = factor(&[vec![1.0, -2.0], vec![-2.0, 4.0]], &names).unwrap();
    assert_eq!(singular, [vec![1.0], vec![-2.0, 0.0]]);
    let zero = factor(&[vec![0.0, 0.0], vec![0.0, 4.0]], &names).unwrap();
    assert_eq!(zero, [vec![0.0], vec![0.0, 2.0]]);
}

#[test]
fn errors_in_covariances() {
    let table = [
        (
            "{ of = ['torque.damping'], matrix = [[-1]] }",
            "the variance of torque.damping must not be negative, found -1",
        ),
        (
            "{ of = ['torque.damping', 'spin'], matrix = [[1, 2, 0, 0], [2, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]] }",
            "its covariances with the numbers before it need a variance of spin[0] of at least 4, found 1",
        ),
        (
            "{ of = ['spin'], matrix = [[0, 1, 0], [1, 1, 0], [0, 0, 1]] }",
            "spin[0] follows from the numbers before it, so its covariance with spin[1] must be 0, found 1",
        ),
        (
            "{ of = ['spin'], matrix = [[1, 1, 0], [0, 1, 0], [0, 0, 1]] }",
            "the matrix is not symmetric: 0 for spin[1] and spin[0], but 1",
        ),
        (
            "{ of = ['spin'], matrix = [[1, 0], [0, 1]] }",
            "expected 3 rows of 3 numbers, for spin[0], spin[1], spin[2]; found 2 rows",
        ),
        ("{ of = ['spin', 'spin'], matrix = [[1]] }", "`spin` is named twice"),
        ("{ of = ['spins'], matrix = [[1]] }", "unknown parameter `spins`"),
        ("{ of = ['torque.larmor'], matrix = [[1]] }", "which has no `larmor` in [torque]"),
        ("{ of = ['spin'] }", "missing field `matrix`"),
        (
            "{ of = ['attitude'], matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 20]] }",
            "turns by more than half a turn",
        ),
        (
            "{ of = ['moments'], matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 2000]] }",
            "the deviation of a logarithm must be from 0 to 10",
        ),
    ];
    for (covariance, message) in table {
        let found = parse(&format!("number = 2\ncovariance = {covariance}"))
            .map(|_| panic!("{covariance}"))
            .unwrap_err();
        assert!(found.contains(message), "{covariance}\n{found}");
    }
    let both = "number = 2\nspin = { normal = 1 }\ncovariance = { of = ['spin'], matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }";
    assert!(parse(both).unwrap_err().contains("`spin` has a distribution already"));
}
