//! Every path held to the table.

use super::*;
use crate::product::Product;
use crate::simd::traverse::STREAMED;
use crate::table::{Algebra, G3, Signature};
use crate::{Multivector, Rotor};

/// Around the widths of registers and blocks.
const ROWS: [usize; 11] = [0, 1, 7, 8, 9, 31, 63, 64, 65, 129, 200];

/// Equal bit for bit; any NaN equals any other.
fn assert_same(got: &[f64], expected: &[f64], what: &str) {
    assert_eq!(got.len(), expected.len());
    for (i, (x, y)) in got.iter().zip(expected).enumerate() {
        assert!(x.to_bits() == y.to_bits() || x.is_nan() && y.is_nan(), "{what}, number {i}: {x} {y}");
    }
}

/// Numbers whose products and sums round, or with signed zeros, infinities and NaN between them.
fn numbers(count: usize, special: bool) -> Vec<f64> {
    const SPECIAL: [f64; 7] = [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e308, 5e-324];
    let number =
        |i: usize| if special && i.is_multiple_of(3) { SPECIAL[i % 7] } else { (i as f64 * 0.7).sin() };
    (0..count).map(number).collect()
}

/// The sum over the table, in order of the left factor's components.
fn by_table(algebra: &Algebra, product: Product, plan: &Plan, a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut full = vec![0.0; algebra.blades().len()];
    for i in 0..a.len() {
        for j in 0..b.len() {
            let (sign, k) = product.of_basis(algebra, i, j);
            if sign != 0 {
                full[k] += f64::from(sign) * a[i] * b[j];
            }
        }
    }
    plan.grades.indices(algebra).iter().map(|&k| full[k]).collect()
}

fn assert_near(got: &[f64], expected: &[f64], bound: f64, what: &str) {
    for (i, (x, y)) in got.iter().zip(expected).enumerate() {
        assert!((x - y).abs() <= bound, "{what}, number {i}: {x} {y}");
    }
}

/// Each row on each path, one row against many both ways: the same numbers as the sum over the table,
/// bit for bit, or by tiles to the rounding of its terms.
fn check_table(algebra: &Algebra, product: Product, rows: &[usize]) {
    let all = Grades((1 << (algebra.signature().generators() + 1)) - 1);
    let size = algebra.blades().len();
    let plan = Plan::new(algebra, product, all, all);
    let (n, special) = (rows[rows.len() - 1], size == 8);
    let (a, b) = (numbers(n * size, special), numbers(n * size + 5, false).split_off(5));
    let row = |x: &[f64], i: usize| x[i * size..(i + 1) * size].to_vec();
    let pick = |i: usize, j: usize| by_table(algebra, product, &plan, &row(&a, i), &row(&b, j));
    let each: Vec<f64> = (0..n).flat_map(|i| pick(i, i)).collect();
    let one_a: Vec<f64> = (0..n).flat_map(|i| pick(0, i)).collect();
    let one_b: Vec<f64> = (0..n).flat_map(|i| pick(i, 0)).collect();
    // Two sums of at most `size` terms, none above 1, are each rounded by ε/2 at every term.
    let bound = (size * size) as f64 * f64::EPSILON;
    let tiles = matches!(plan.engine, Engine::Tiles(_));
    for path in Path::available() {
        for &rows in rows {
            let (many_a, many_b) = (&a[..rows * size], &b[..rows * size]);
            for (a, b, expected) in
                [(many_a, many_b, &each), (&a[..size], many_b, &one_a), (many_a, &b[..size], &one_b)]
            {
                let what = format!("{path:?} {:?} {product:?} {rows}", algebra.signature());
                let mut out = vec![0.5; rows * plan.sizes.2];
                plan.run_on(path, Threads::ONE, a, b, &mut out);
                let expected = &expected[..out.len()];
                if tiles {
                    assert_near(&out, expected, bound, &what);
                } else {
                    assert_same(&out, expected, &what);
                }
            }
        }
    }
}

/// Every signature of up to five generators.
#[test]
fn every_row_equals_the_table() {
    for n in 0..=5 {
        for p in 0..=n {
            for q in 0..=n - p {
                let algebra = Algebra::new(Signature { p, q, r: n - p - q }).unwrap();
                let known =
                    [(3, 0, 0), (2, 0, 0), (3, 0, 1), (4, 1, 0), (1, 3, 0)].contains(&(p, q, n - p - q));
                for product in Product::ALL {
                    check_table(&algebra, product, if known { &ROWS } else { &[1, 8, 9, 17] });
                }
            }
        }
    }
}

/// Those with e0 first, whose basis elements have signs.
#[test]
fn rows_of_plane_based_algebras_equal_the_table() {
    for n in 1..=5 {
        let algebra = Algebra::pga(n).unwrap();
        let all = Grades((1 << (n + 2)) - 1);
        let engine = Plan::new(&algebra, Product::Geometric, all, all).engine;
        assert_eq!(matches!(engine, Engine::Tiles(_)), n >= 3);
        for product in Product::ALL {
            check_table(&algebra, product, if n == 3 { &ROWS } else { &[1, 8, 9, 17] });
        }
    }
}

/// Large ones: of every number of positive generators among the first three, and of two alone.
#[test]
fn rows_of_large_algebras_equal_the_table() {
    for (p, q, r) in [(4, 2, 0), (0, 5, 1), (1, 2, 4), (2, 2, 2), (1, 1, 4), (4, 4, 0)] {
        let algebra = Algebra::new(Signature { p, q, r }).unwrap();
        let tiles = Plan::new(&algebra, Product::Geometric, Grades(511), Grades(511)).engine;
        assert_eq!(matches!(tiles, Engine::Tiles(_)), p + q >= 3);
        check_table(&algebra, Product::Geometric, &[1, 17]);
    }
}

/// One row or many, alone or among threads: tiles round a row in one way.
#[test]
fn tiles_round_the_same_for_any_number_of_rows() {
    let algebra = Algebra::new(Signature { p: 3, q: 0, r: 1 }).unwrap();
    let plan = Plan::new(&algebra, Product::Geometric, Grades(31), Grades(31));
    let rows = 80_003;
    let (a, b) = (numbers(rows * 16, false), numbers(rows * 16 + 3, false).split_off(3));
    for path in Path::available() {
        let mut expected = vec![0.5; rows * 16];
        plan.run_on(path, Threads::ONE, &a, &b, &mut expected);
        let mut out = vec![0.5; rows * 16];
        plan.run_on(path, Threads::new(7), &a, &b, &mut out);
        assert_same(&out, &expected, &format!("{path:?}"));
        for (row, expected) in expected.chunks(16).enumerate().take(40) {
            let place = row * 16..(row + 1) * 16;
            let mut out = [0.5; 16];
            plan.run_on(path, Threads::ONE, &a[place.clone()], &b[place.clone()], &mut out);
            assert_same(&out, expected, &format!("{path:?}, row {row}"));
            if path == Path::best() {
                plan.run_row(&a[place.clone()], &b[place], &mut out);
                assert_same(&out, expected, &format!("row {row} alone"));
            }
        }
    }
}

/// Every pair of sets of grades in 3-d space, so that lanes of every number from 1 to 8 occur.
#[test]
fn every_pair_of_grades_equals_its_rows() {
    let rows = 75;
    for (ga, gb) in (1..16).flat_map(|ga| (1..16).map(move |gb| (Grades(ga), Grades(gb)))) {
        let plan = Plan::g3(Product::Geometric, ga, gb);
        let (na, nb, nout) = plan.sizes;
        let (a, b) = (numbers(rows * na, false), numbers(rows * nb, true));
        let mut expected = vec![0.5; rows * nout];
        for (row, out) in expected.chunks_exact_mut(nout).enumerate() {
            plan.row(Path::best(), &a[row * na..(row + 1) * na], &b[row * nb..(row + 1) * nb], out);
        }
        for path in Path::available() {
            let mut out = vec![0.5; rows * nout];
            plan.run_on(path, Threads::ONE, &a, &b, &mut out);
            assert_same(&out, &expected, &format!("{path:?} {ga:?} {gb:?}"));
        }
    }
}

/// A result that goes past the caches, wherever it begins in a cache line, is that of small pieces.
#[test]
fn streamed_results_are_the_same() {
    let rows = STREAMED / 8 / 9 + 37;
    let (r, v) = (numbers(4 * rows, false), numbers(3 * rows, false));
    let piece = 1000;
    let mut expected = vec![0.0; 3 * rows];
    for (i, out) in expected.chunks_mut(3 * piece).enumerate() {
        let (first, last) = (i * piece, i * piece + out.len() / 3);
        turn(Threads::ONE, &r[4 * first..4 * last], &v[3 * first..3 * last], Grades(0b0010), out);
    }
    for path in Path::available() {
        for offset in 0..8 {
            let mut out = vec![0.5; 3 * rows + 9];
            turn_on(path, Threads::ONE, &r, &v, Grades(0b0010), &mut out[offset..offset + 3 * rows]);
            assert_same(&out[offset..offset + 3 * rows], &expected, &format!("{path:?} {offset}"));
            let around = out[..offset].iter().chain(&out[offset + 3 * rows..]);
            assert!(around.copied().all(|x| x == 0.5), "{path:?} {offset}");
        }
    }
}

/// Any number of threads gives the same bits, of one row against many both ways, streamed or not.
#[test]
fn threads_change_nothing() {
    let plan = Plan::g3(Product::Geometric, Grades::ALL, Grades::EVEN);
    for rows in [60_000, 200_001] {
        let (a, b) = (numbers(rows * 8, true), numbers(rows * 4, false));
        for (a, b) in [(&a[..], &b[..]), (&a[..8], &b[..]), (&a[..], &b[..4])] {
            let mut expected = vec![0.5; rows * 8];
            plan.run(Threads::ONE, a, b, &mut expected);
            for threads in [2, 3, 7] {
                let mut out = vec![0.5; rows * 8];
                plan.run(Threads::new(threads), a, b, &mut out);
                assert_same(&out, &expected, &format!("{threads} threads, {rows} rows"));
            }
        }
    }
}

/// Rows of `f32` give the numbers of `f64` rounded once, few or many or streamed, on every path.
#[test]
fn single_precision_is_double_rounded() {
    let streamed = STREAMED / 4 / 24 + 5;
    let narrow = |x: &[f64]| x.iter().map(|&x| x as f32).collect::<Vec<f32>>();
    let wide = |x: &[f32]| x.iter().map(|&x| x.into()).collect::<Vec<f64>>();
    for (plan, rows) in [(Grades::ALL, streamed), (Grades::EVEN, 200), (Grades(0b0010), 200)]
        .into_iter()
        .flat_map(|(g, most)| {
            let plan = Plan::g3(Product::Geometric, g, g);
            ROWS[..10].iter().copied().chain([most]).map(move |rows| (plan, rows))
        })
    {
        let (na, nb, nout) = plan.sizes;
        let (a, b) = (narrow(&numbers(rows * na, true)), narrow(&numbers(rows * nb, false)));
        let mut expected = vec![0.5; rows * nout];
        plan.run(Threads::ONE, &wide(&a), &wide(&b), &mut expected);
        for path in Path::available() {
            let mut out = vec![0.5_f32; rows * nout + 1];
            plan.run_on(path, Threads::ONE, &a, &b, &mut out[1..]);
            assert_same(&wide(&out[1..]), &wide(&narrow(&expected)), &format!("{path:?} {rows}"));
        }
    }
    for path in Path::available() {
        let (r, x) = (narrow(&numbers(4, false)), narrow(&numbers(8 * 70, false)));
        let (mut out, mut expected) = (vec![0.5_f32; 8 * 70], vec![0.5; 8 * 70]);
        turn_on(path, Threads::ONE, &r, &x, Grades::ALL, &mut out);
        turn(Threads::ONE, &wide(&r), &wide(&x), Grades::ALL, &mut expected);
        assert_same(&wide(&out), &wide(&narrow(&expected)), &format!("{path:?}"));
    }
}

/// Beyond the caches, in smaller blocks, full products are still those of the rows.
#[test]
fn large_full_products_are_the_same() {
    let plan = Plan::g3(Product::Geometric, Grades::ALL, Grades::ALL);
    let rows = STREAMED / 8 / 24 + 5;
    let (a, b) = (numbers(rows * 8, true), numbers(rows * 8 + 1, false).split_off(1));
    let mut expected = vec![0.5; rows * 8];
    for ((a, b), out) in a.chunks(8).zip(b.chunks(8)).zip(expected.chunks_mut(8)) {
        plan.row(Path::best(), a, b, out);
    }
    for path in Path::available() {
        let mut out = vec![0.5; rows * 8];
        plan.run_on(path, Threads::ONE, &a, &b, &mut out);
        assert_same(&out, &expected, &format!("{path:?}"));
    }
}

/// Every set of grades, one row against many both ways, on every path: the numbers of the typed
/// values bit for bit, and `R X ~R` by products to 8 roundings.
#[test]
fn turning_equals_the_sandwich() {
    let n = 70;
    let unit = |c: &[f64]| Rotor::from_components(std::array::from_fn(|k| c[k])).unwrap();
    let rotors: Vec<Rotor> = numbers(4 * n, false).chunks_exact(4).map(unit).collect();
    let r: Vec<f64> = rotors.iter().flat_map(|r| r.components()).collect();
    for grades in (1..16).map(Grades) {
        let indices = grades.indices(&G3);
        let size = indices.len();
        let x = numbers(size * n, false);
        for (many_r, many_x) in [(1, 1), (1, n), (n, 1), (n, n), (9, 9), (1, 9)] {
            let rows = many_r.max(many_x);
            let mut expected = Vec::new();
            for row in 0..rows {
                let mut full = Multivector::default();
                for (k, &i) in indices.iter().enumerate() {
                    full.0[i] = x[(if many_x == 1 { 0 } else { row }) * size + k];
                }
                let rotor = rotors[if many_r == 1 { 0 } else { row }];
                let typed = rotor.apply_multivector(full);
                let sandwich = Multivector::from(rotor) * full * Multivector::from(rotor.reverse());
                for &i in &indices {
                    let error = (typed.0[i] - sandwich.0[i]).abs();
                    assert!(error <= 8.0 * f64::EPSILON * full.norm(), "{grades:?} {error}");
                    expected.push(typed.0[i]);
                }
            }
            for path in Path::available() {
                let mut out = vec![f64::NAN; rows * size];
                turn_on(path, Threads::ONE, &r[..4 * many_r], &x[..size * many_x], grades, &mut out);
                assert_same(&out, &expected, &format!("{path:?} {grades:?} {many_r} {many_x}"));
            }
        }
    }
}
