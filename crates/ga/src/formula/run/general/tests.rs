//! Blocks of any width and path against products made one by one.

use super::RowRunner;
use crate::formula::{Meaning, Names, Space, Type, compile, parse};
use crate::general::Calculus;
use crate::product::{Grades, Plan, Product};
use crate::simd::Path;
use crate::simd::threads::Threads;
use crate::table::{Algebra, Signature};

const EVEN: Grades = Grades(0b10101);
const VECTOR: Grades = Grades(0b10);

#[test]
fn sandwiches_have_the_bits_of_products_on_every_path() {
    let algebra = Algebra::new(Signature { p: 3, q: 0, r: 1 }).unwrap();
    let calculus = Calculus::new(&algebra);
    let space = Space::new(&algebra, &calculus);
    let mut names = Names::new([]);
    names.bind("M".to_owned(), Meaning::Value(Type::of(EVEN)));
    names.bind("P".to_owned(), Meaning::Value(Type::of(VECTOR)));
    let program = compile(&parse("M P ~M", space, &names).unwrap(), space, &names).unwrap();
    let runner = RowRunner::new(&program, &algebra).unwrap();
    assert_eq!((runner.sizes(), runner.size_of_result()), (&[8, 4][..], 4));

    const ROWS: usize = 203;
    let numbers = |count: usize, seed: usize| -> Vec<f64> {
        (0..count).map(|i| ((i * 7919 + seed) % 1009) as f64 / 504.5 - 1.0).collect()
    };
    let p = numbers(4 * ROWS, 5);
    for m in [numbers(8 * ROWS, 3), numbers(8, 3)] {
        let reversed: Vec<f64> =
            m.iter().enumerate().map(|(i, x)| if (1..7).contains(&(i % 8)) { -x } else { *x }).collect();
        let left = Plan::new(&algebra, Product::Geometric, EVEN, VECTOR);
        let right = Plan::new(&algebra, Product::Geometric, left.grades, EVEN).part(&algebra, VECTOR);
        let (mut middle, mut expected) = (vec![0.0; left.sizes.2 * ROWS], vec![0.0; 4 * ROWS]);
        left.run(Threads::ONE, &m, &p, &mut middle);
        right.run(Threads::ONE, &middle, &reversed, &mut expected);
        for path in Path::available() {
            for rows in [0..ROWS, 0..5, 100..120] {
                let mut out = vec![0.0; 4 * ROWS];
                assert!(runner.run_on(path, Threads::new(2), &[&m, &p], &mut out, rows.clone()));
                let rows = 4 * rows.start..4 * rows.end;
                assert_eq!(out[rows.clone()], expected[rows], "{path:?}");
            }
        }
    }
}

#[test]
fn functions_are_left_to_the_caller() {
    let algebra = Algebra::new(Signature { p: 2, q: 0, r: 0 }).unwrap();
    let calculus = Calculus::new(&algebra);
    let space = Space::new(&algebra, &calculus);
    let mut names = Names::new([]);
    names.bind("a".to_owned(), Meaning::Value(Type::of(VECTOR)));
    names.bind("s".to_owned(), Meaning::Value(Type::SCALAR));
    let runner = |text| {
        let program = compile(&parse(text, space, &names).unwrap(), space, &names).unwrap();
        RowRunner::new(&program, &algebra)
    };
    assert!(runner("exp(a)").is_none());
    assert!(runner("a = 2a").is_none());
    let quotient = runner("a/s").unwrap();
    let mut out = [0.0; 4];
    assert!(quotient.run(Threads::ONE, &[&[1.0, 2.0], &[1.0, 2.0]], &mut out, 0..2));
    assert_eq!(out, [1.0, 2.0, 0.5, 1.0]);
    assert!(!quotient.run(Threads::ONE, &[&[1.0, 2.0], &[1.0, 0.0]], &mut out, 0..2));
}

#[test]
fn long_formulas_in_large_algebras_are_left_to_the_caller() {
    let algebra = Algebra::new(Signature { p: 8, q: 0, r: 0 }).unwrap();
    let calculus = Calculus::new(&algebra);
    let space = Space::new(&algebra, &calculus);
    let mut names = Names::new([]);
    for name in ["M", "N"] {
        names.bind(name.to_owned(), Meaning::Value(Type::of(Grades(0b1_1111_1111))));
    }
    let runner = |text: &str| {
        let program = compile(&parse(text, space, &names).unwrap(), space, &names).unwrap();
        RowRunner::new(&program, &algebra)
    };
    assert!(runner("M N").is_some());
    assert!(runner(&"M N ".repeat(9)).is_none());
}
