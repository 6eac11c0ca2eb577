//! Nanoseconds a row of `R v ~R + (a∧b)·c` as one program, beside the same calls made one by one and a copy
//! of as many bytes, each in turn in the same run.
//!
//! `cargo run --release -p polhode-ga --example formula`

use polhode_ga::Graded;
use polhode_ga::formula::{Given, Input, InputKind, Op, Program, Runner, Span, Step, Type};
use polhode_ga::product::{Grades, Plan, Product};
use polhode_ga::rows::product::turn;
use polhode_ga::simd::threads::Threads;
use polhode_ga::table::Signature;
use std::hint::black_box;
use std::time::Instant;

const VECTOR: Grades = Grades(0b0010);

/// `R v ~R + (a∧b)·c`
fn program() -> Program {
    let (vector, bivector) = (Type::of(VECTOR), Type::of(Grades::BIVECTOR));
    let input = |name: &str, ty| Input { name: name.into(), kind: InputKind::Value(ty) };
    let steps = [
        (Op::Input(0), Type::ROTOR),
        (Op::Input(1), vector),
        (Op::Turn(0, 1), vector),
        (Op::Input(2), vector),
        (Op::Input(3), vector),
        (Op::Product(Product::Wedge, 3, 4), bivector),
        (Op::Input(4), vector),
        (Op::Product(Product::Dot, 5, 6), vector),
        (Op::Add(2, 7), vector),
    ];
    Program {
        signature: Signature { p: 3, q: 0, r: 0 },
        inputs: [("R", Type::ROTOR), ("v", vector), ("a", vector), ("b", vector), ("c", vector)]
            .map(|(name, ty)| input(name, ty))
            .to_vec(),
        steps: steps.map(|(op, ty)| Step { op, ty, span: Span::default() }).to_vec(),
        results: vec![vec![8]],
    }
}

/// Numbers of either sign, none special.
fn numbers(count: usize) -> Vec<f64> {
    (0..count).map(|i| (i * 7919 % 1009) as f64 / 500.0 - 1.0).collect()
}

/// The best of many runs of each, in turn, in nanoseconds for one of `count`.
fn best<const N: usize>(count: usize, mut works: [&mut dyn FnMut(); N]) -> [f64; N] {
    let mut least = [f64::INFINITY; N];
    for _ in 0..(30_000_000 / count).clamp(25, 10_000) {
        for (work, least) in works.iter_mut().zip(&mut least) {
            let start = Instant::now();
            work();
            *least = least.min(start.elapsed().as_secs_f64());
        }
    }
    least.map(|seconds| 1e9 * seconds / count as f64)
}

fn many(runner: &Runner, rows: usize) {
    let data = [4, 3, 3, 3, 3].map(|size| numbers(size * rows));
    let [r, v, a, b, c] = data.each_ref().map(Vec::as_slice);
    let wedge = Plan::g3(Product::Wedge, VECTOR, VECTOR);
    let dot = Plan::g3(Product::Dot, Grades::BIVECTOR, VECTOR);
    let [mut turned, mut plane, mut dotted, mut sum, mut out] = [0; 5].map(|_| numbers(3 * rows));
    let half = 19 * rows / 2;
    let (from, mut to) = (numbers(half), numbers(half));
    let [ours, separate, copy] = best(
        rows,
        [
            &mut || {
                runner.run(Threads::ONE, &[r, v, a, b, c], &mut [&mut out], 0..rows).expect("it has a value");
            },
            &mut || {
                turn(Threads::ONE, r, v, VECTOR, &mut turned);
                wedge.run(Threads::ONE, a, b, &mut plane);
                dot.run(Threads::ONE, &plane, c, &mut dotted);
                for ((sum, x), y) in sum.iter_mut().zip(&turned).zip(&dotted) {
                    *sum = x + y;
                }
            },
            &mut || to.copy_from_slice(black_box(&from)),
        ],
    );
    assert_eq!(out, sum);
    println!("{rows:>9} rows{ours:>9.2} ns{separate:>9.2} ns{copy:>9.2} ns{:>8.2}", separate / ours);
}

fn single(runner: &Runner) {
    let value = |grades, c: &[f64]| Graded::new(c, grades).expect("as many as it has");
    let r = value(Grades::EVEN, &[0.8, 0.0, 0.6, 0.0]);
    let vectors = [0.1, 0.2, 0.3, 0.4].map(|x| Given::Value(value(VECTOR, &[x, 1.0 - x, 2.0 * x])));
    let [v, a, b, c] = vectors;
    let given = [Given::Value(r), v, a, b, c];
    const TIMES: usize = 1000;
    let [ours] = best(
        TIMES,
        [&mut || {
            for _ in 0..TIMES {
                black_box(runner.value(black_box(&given))).expect("it has a value");
            }
        }],
    );
    println!("one value{ours:>13.1} ns");
}

fn main() {
    let runner = Runner::new(&program()).expect("it is of 3-d space");
    println!("{:>14}{:>12}{:>12}{:>12}{:>8}", "", "ours", "separate", "copy", "ratio");
    let only = std::env::args().nth(1).and_then(|rows| rows.parse().ok());
    for rows in only.map_or(vec![100, 1_000, 10_000, 100_000, 1_000_000], |rows| vec![rows]) {
        many(&runner, rows);
    }
    if only.is_none() {
        single(&runner);
    }
}
