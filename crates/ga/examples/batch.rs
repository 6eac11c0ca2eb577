//! Nanoseconds a row of the batch kernels, beside a copy of as many bytes in the same run.
//!
//! `cargo run --release -p polhode-ga --example batch [rows]`

use polhode_ga::batch::turn;
use polhode_ga::maps;
use polhode_ga::product::{Grades, Plan, Product};
use std::time::Instant;

const VECTOR: Grades = Grades(0b0010);

/// The best of many runs, in nanoseconds a row.
fn best(rows: usize, mut work: impl FnMut()) -> f64 {
    let runs = (20_000_000 / rows).clamp(15, 100_000);
    let mut least = f64::INFINITY;
    for _ in 0..runs {
        let start = Instant::now();
        work();
        least = least.min(start.elapsed().as_secs_f64());
    }
    1e9 * least / rows as f64
}

/// Numbers of either sign, none special.
fn numbers(count: usize) -> Vec<f64> {
    (0..count).map(|i| (i * 7919 % 1009) as f64 / 500.0 - 1.0).collect()
}

/// One line: `read` and `written` numbers a row, and the work between them.
fn line(what: &str, rows: usize, read: usize, written: usize, work: impl FnMut()) {
    let ours = best(rows, work);
    let half = (read + written) * rows / 2;
    let (from, mut to) = (numbers(half), vec![1.0; half]);
    let copy = best(rows, || to.copy_from_slice(std::hint::black_box(&from)));
    let rate = 8.0 * (read + written) as f64 / ours;
    println!("{what:<34}{ours:>8.2} ns{copy:>8.2} ns{:>7.0} %{rate:>7.1} GB/s", 100.0 * copy / ours);
}

/// A product of rows by rows, or by one row where `nb` is 1.
fn product(what: &str, rows: usize, ga: Grades, gb: Grades, rows_b: usize) {
    let plan = Plan::g3(Product::Geometric, ga, gb);
    let (na, nb, nout) = plan.sizes;
    let (a, b) = (numbers(rows * na), numbers(rows_b * nb));
    let mut out = vec![1.0; rows * nout];
    line(what, rows, na + if rows_b == 1 { 0 } else { nb }, nout, || plan.run(&a, &b, &mut out));
}

/// `R X ~R` for rows of vectors and rotors, one or many.
fn turning(what: &str, rows: usize, rotors: usize) {
    let (r, v) = (numbers(4 * rotors), numbers(3 * rows));
    let mut out = vec![1.0; 3 * rows];
    line(what, rows, 3 + if rotors == 1 { 0 } else { 4 }, 3, || turn(&r, &v, VECTOR, &mut out));
}

/// exp of bivectors up to a full turn and beyond, and log of the rotors that it gives.
fn exp_and_log(rows: usize) {
    let mut b: Vec<f64> = numbers(3 * rows).iter().map(|x| 4.0 * x).collect();
    let mut r = vec![1.0; 4 * rows];
    line("exp", rows, 3, 4, || maps::exp(&b, &mut r).expect("finite"));
    line("log", rows, 4, 3, || maps::log(&r, &mut b).expect("finite"));
}

fn main() {
    let asked = std::env::args().nth(1).and_then(|rows| rows.parse().ok());
    for rows in asked.map_or(vec![1_000_000, 1_000], |rows| vec![rows]) {
        println!("{:<34}{:>11}{:>11}{:>9}", format!("{rows} rows"), "ours", "copy", "of copy");
        product("full * full", rows, Grades::ALL, Grades::ALL, rows);
        product("full * one full", rows, Grades::ALL, Grades::ALL, 1);
        product("rotor * rotor", rows, Grades::EVEN, Grades::EVEN, rows);
        product("vector * vector", rows, VECTOR, VECTOR, rows);
        product("rotor * vector", rows, Grades::EVEN, VECTOR, rows);
        turning("R v ~R", rows, rows);
        turning("one R, many v", rows, 1);
        exp_and_log(rows);
    }
}
