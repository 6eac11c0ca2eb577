//! Versors act as products of the table do, on any path, in any number of rows.

use super::*;
use crate::table::Signature;

/// Uniform numbers in (−1, 1), always the same.
fn numbers(count: usize, mut state: u64) -> Vec<f64> {
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| next()).collect()
}

fn all(algebra: &Algebra) -> Grades {
    Grades((2 << algebra.signature().generators()) - 1)
}

fn product(algebra: &Algebra, a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; a.len()];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            let (sign, k) = algebra.basis_product(i, j);
            out[k] += f64::from(sign) * x * y;
        }
    }
    out
}

fn grades_of(algebra: &Algebra) -> Vec<usize> {
    algebra.blades().iter().map(|blade| blade.grade()).collect()
}

/// A product of `count` vectors of square 1, as a value of all grades.
fn versor(algebra: &Algebra, count: usize, seed: u64) -> Vec<f64> {
    let positive = algebra.squares().iter().position(|&square| square == 1).unwrap();
    let mut versor = vec![0.0; algebra.blades().len()];
    versor[0] = 1.0;
    for i in 0..count {
        let mut vector = vec![0.0; versor.len()];
        for (k, x) in numbers(algebra.squares().len(), seed + i as u64).into_iter().enumerate() {
            vector[1 + k] = 0.3 * x;
        }
        vector[1 + positive] += 1.0;
        versor = product(algebra, &versor, &vector);
    }
    versor
}

/// `V X̂ ~V/(V ~V)` by the table.
fn expected(algebra: &Algebra, v: &[f64], odd: bool, x: &[f64]) -> Vec<f64> {
    let grades = grades_of(algebra);
    let reverse: Vec<_> = v.iter().zip(&grades).map(|(x, k)| if k % 4 > 1 { -x } else { *x }).collect();
    let hat: Vec<_> = x.iter().zip(&grades).map(|(x, k)| if odd && k % 2 == 1 { -x } else { *x }).collect();
    let square = product(algebra, v, &reverse)[0];
    let moved = product(algebra, &product(algebra, v, &hat), &reverse);
    moved.iter().map(|x| x / square).collect()
}

fn algebras() -> Vec<Algebra> {
    let of = |(p, q, r)| Algebra::new(Signature { p, q, r }).unwrap();
    let mut algebras: Vec<_> =
        [(1, 0, 0), (2, 0, 0), (3, 0, 0), (1, 3, 0), (3, 0, 1), (4, 1, 0)].map(of).into();
    algebras.push(Algebra::pga(3).unwrap());
    algebras
}

#[test]
fn versors_act_as_by_the_table() {
    for algebra in algebras() {
        let size = algebra.blades().len();
        let action = |odd| Action::new(&algebra, all(&algebra), odd, all(&algebra)).unwrap();
        for count in 0..4 {
            let odd = count % 2 == 1;
            let action = action(odd);
            for rows in [1, 7, 64, 131] {
                let v: Vec<_> = (0..rows).flat_map(|row| versor(&algebra, count, row)).collect();
                let x = numbers(rows as usize * size, 3);
                for path in Path::available() {
                    let mut out = vec![0.5; x.len()];
                    assert!(action.run_on(path, Threads::new(3), &v, &x, &mut out), "{path:?}");
                    for ((v, x), out) in v.chunks(size).zip(x.chunks(size)).zip(out.chunks(size)) {
                        // Four products of up to `size` terms each, with factors of at most 2^count in size.
                        for (a, b) in out.iter().zip(expected(&algebra, v, odd, x)) {
                            assert!((a - b).abs() < 64.0 * size as f64 * f64::EPSILON, "{a} {b} {path:?}");
                        }
                        let mut alone = vec![0.5; size];
                        assert!(action.run_row(v, x, &mut alone));
                        assert_eq!(alone, out);
                    }
                }
            }
        }
    }
}

/// One versor for all values, and one value for all versors.
#[test]
fn single_rows_are_broadcast() {
    let algebra = Algebra::pga(3).unwrap();
    let (even, points) = (Grades(0b10101), Grades(0b1000));
    let action = Action::new(&algebra, even, false, points).unwrap();
    let v: Vec<_> = (0..150)
        .flat_map(|row| {
            let full = versor(&algebra, 2, row);
            even.indices(&algebra).into_iter().map(move |i| full[i])
        })
        .collect();
    let x = numbers(150 * 4, 5);
    for (v, x) in [(&v[..8], &x[..]), (&v[..], &x[..4])] {
        let mut out = vec![0.0; 150 * 4];
        assert!(action.run(Threads::ONE, v, x, &mut out));
        for (row, out) in out.chunks(4).enumerate() {
            let v = if v.len() == 8 { v } else { &v[8 * row..8 * row + 8] };
            let x = if x.len() == 4 { x } else { &x[4 * row..4 * row + 4] };
            let mut alone = [0.0; 4];
            assert!(action.run_row(v, x, &mut alone));
            assert_eq!(alone, out);
        }
    }
}

#[test]
fn other_values_are_not_versors() {
    let algebra = Algebra::pga(3).unwrap();
    let action = Action::new(&algebra, Grades(0b10101), false, Grades(0b10)).unwrap();
    let good = [1.0, 0.2, -0.1, 0.3, 0.0, 0.0, 0.0, 0.0];
    let x = numbers(200 * 4, 6);
    for (bad, place) in [(0.0, 0), (f64::NAN, 3), (f64::INFINITY, 0), (1e200, 0), (1e-3, 7)] {
        for row in [0, 63, 64, 199] {
            let mut v = good.repeat(200);
            if bad == 0.0 {
                v[8 * row..8 * row + 8].fill(0.0);
            }
            v[8 * row + place] = bad;
            let mut out = vec![0.0; x.len()];
            assert!(!action.run(Threads::new(4), &v, &x, &mut out), "{bad} in row {row}");
            assert!(!action.run_row(&v[8 * row..8 * row + 8], &x[..4], &mut out[..4]));
        }
    }
    // To half of the digits of the type.
    for (part, double, single) in [(1e-10, true, true), (1e-6, false, true), (1e-3, false, false)] {
        let mut v = good;
        v[7] = part / 2.0;
        let (v32, x32) = (v.map(|x| x as f32), x.iter().map(|&x| x as f32).collect::<Vec<_>>());
        assert_eq!(action.run(Threads::ONE, &v, &x[..4], &mut [0.0; 4]), double);
        assert_eq!(action.run(Threads::ONE, &v32, &x32[..4], &mut [0.0; 4]), single);
    }
}

#[test]
fn large_algebras_are_left_to_others() {
    let large = Algebra::new(Signature { p: 6, q: 0, r: 0 }).unwrap();
    assert!(Action::new(&large, Grades(1), false, Grades(2)).is_none());
}
