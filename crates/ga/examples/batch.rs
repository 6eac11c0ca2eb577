//! Nanoseconds a row of the batch kernels, beside a copy of as many bytes in the same run.
//!
//! `cargo run --release -p polhode-ga --example batch [rows]`

use polhode_ga::product::{Grades, Plan, Product};
use polhode_ga::rows::product::{Element, turn};
use polhode_ga::rows::rotor_functions;
use polhode_ga::simd::lanes::{Work, fastest};
use polhode_ga::simd::threads::Threads;
use polhode_ga::table::{Algebra, Signature};
use std::hint::black_box;
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
fn numbers<T: Element>(count: usize) -> Vec<T> {
    (0..count).map(|i| T::nearest((i * 7919 % 1009) as f64 / 500.0 - 1.0)).collect()
}

/// One line: `read` and `written` numbers a row, and the work between them.
fn line<T: Element>(what: &str, rows: usize, read: usize, written: usize, work: impl FnMut()) {
    let ours = best(rows, work);
    let half = (read + written) * rows / 2;
    let (from, mut to) = (numbers::<T>(half), numbers::<T>(half));
    let copy = best(rows, || to.copy_from_slice(black_box(&from)));
    let rate = (size_of::<T>() * (read + written)) as f64 / ours;
    println!("{what:<34}{ours:>8.2} ns{copy:>8.2} ns{:>7.0} %{rate:>7.1} GB/s", 100.0 * copy / ours);
}

/// A product of rows by rows, or by one row where `nb` is 1.
fn product<T: Element>(what: &str, rows: usize, ga: Grades, gb: Grades, rows_b: usize, threads: Threads) {
    let plan = Plan::g3(Product::Geometric, ga, gb);
    let (na, nb, nout) = plan.sizes;
    let (a, b) = (numbers::<T>(rows * na), numbers::<T>(rows_b * nb));
    let mut out = numbers::<T>(rows * nout);
    line::<T>(what, rows, na + if rows_b == 1 { 0 } else { nb }, nout, || {
        plan.run(threads, &a, &b, &mut out);
    });
}

/// `R X ~R` for rows of vectors and rotors, one or many.
fn turning<T: Element>(what: &str, rows: usize, rotors: usize) {
    let (r, v) = (numbers::<T>(4 * rotors), numbers::<T>(3 * rows));
    let mut out = numbers::<T>(3 * rows);
    line::<T>(what, rows, 3 + if rotors == 1 { 0 } else { 4 }, 3, || {
        turn(Threads::ONE, &r, &v, VECTOR, &mut out)
    });
}

/// `N` independent chains of products and sums in registers.
struct Chains<const N: usize>;

impl<const N: usize> Work for Chains<N> {
    type Output = f64;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> f64 {
        let x = black_box(0.999);
        let mut chains: [f64; N] = std::array::from_fn(|i| x + i as f64);
        for _ in 0..1000 {
            for z in &mut chains {
                *z = if FUSED { z.mul_add(x, x) } else { *z * x + x };
            }
        }
        chains.iter().sum()
    }
}

/// The multiply-adds that the machine can do in a nanosecond: 48 chains fit the registers of AVX2, 96 hide the latency
/// of AVX-512.
fn peak() -> f64 {
    fn rate<const N: usize>() -> f64 {
        1.0 / best(1000 * N, || _ = black_box(fastest(Chains::<N>)))
    }
    rate::<48>().max(rate::<96>())
}

/// Full products in a larger algebra, beside the multiply-adds that they take.
fn full(rows: usize, peak: f64, p: usize, q: usize, r: usize) {
    let algebra = Algebra::new(Signature { p, q, r }).expect("few enough generators");
    let all = Grades((1 << (p + q + r + 1)) - 1);
    let plan = Plan::new(&algebra, Product::Geometric, all, all);
    let count = rows * plan.sizes.0;
    let (a, b, mut out) = (numbers::<f64>(count), numbers::<f64>(count), numbers::<f64>(count));
    let ours = best(rows, || plan.run(Threads::ONE, &a, &b, &mut out));
    let share = 100.0 * plan.terms.len() as f64 / ours / peak;
    println!("{:<34}{ours:>8.2} ns{share:>20.0} % of the peak", format!("full * full, Cl({p},{q},{r})"));
}

/// exp of bivectors up to a full turn and beyond, and log of the rotors that it gives.
fn exp_and_log(rows: usize) {
    let mut b: Vec<f64> = numbers::<f64>(3 * rows).iter().map(|x| 4.0 * x).collect();
    let mut r = vec![1.0; 4 * rows];
    line::<f64>("exp", rows, 3, 4, || rotor_functions::exp(Threads::ONE, &b, &mut r).expect("finite"));
    line::<f64>("log", rows, 4, 3, || rotor_functions::log(Threads::ONE, &r, &mut b).expect("finite"));
}

fn main() {
    let asked = std::env::args().nth(1).and_then(|rows| rows.parse().ok());
    for rows in asked.map_or(vec![1_000_000, 1_000], |rows| vec![rows]) {
        println!("{:<34}{:>11}{:>11}{:>9}", format!("{rows} rows"), "ours", "copy", "of copy");
        product::<f64>("full * full", rows, Grades::ALL, Grades::ALL, rows, Threads::ONE);
        let all = Threads::available();
        product::<f64>("full * full, all threads", rows, Grades::ALL, Grades::ALL, rows, all);
        product::<f32>("full * full, f32", rows, Grades::ALL, Grades::ALL, rows, Threads::ONE);
        product::<f64>("full * one full", rows, Grades::ALL, Grades::ALL, 1, Threads::ONE);
        product::<f64>("rotor * rotor", rows, Grades::EVEN, Grades::EVEN, rows, Threads::ONE);
        product::<f64>("vector * vector", rows, VECTOR, VECTOR, rows, Threads::ONE);
        product::<f64>("rotor * vector", rows, Grades::EVEN, VECTOR, rows, Threads::ONE);
        turning::<f64>("R v ~R", rows, rows);
        turning::<f32>("R v ~R, f32", rows, rows);
        turning::<f64>("one R, many v", rows, 1);
        exp_and_log(rows);
    }
    let peak = peak();
    println!("1000 rows, peak {:.0} GFLOP/s", 2.0 * peak);
    for (p, q, r) in [(3, 0, 1), (4, 1, 0), (4, 4, 0)] {
        full(1000, peak, p, q, r);
    }
}
