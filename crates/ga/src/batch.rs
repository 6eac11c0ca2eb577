//! Functions of two rows over many rows: any product, and `R X ~R`.
//!
//! Each function says what it does to a row, and the same arithmetic as one loop over the lanes of a block
//! of rows, which compilers vectorise.

use crate::product::{Engine, Grades, Plan, Term};
use crate::rotor::Rotor;
pub use crate::simd::{Element, multiply_adds};
use crate::simd::{Kernel, LANES, Lane, Path};
use crate::sweep::sweep;
use crate::threads::Threads;
use crate::values::{Vector, geometric};

impl Kernel for Plan {
    fn row(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for term in &self.terms {
            out[term.out] += f64::from(term.sign) * a[term.a] * b[term.b];
        }
    }

    #[inline(always)]
    fn block(&self, a: &[Lane], b: &[Lane], out: &mut [Lane]) {
        out.fill(Lane::filled(0.0));
        // The terms come in order of `out`; up to eight of a lane are added at a time, in registers.
        for terms in self.terms.chunk_by(|s, t| s.out == t.out).flat_map(|terms| terms.chunks(8)) {
            let lane = &mut out[terms[0].out];
            match terms.len() {
                1 => add::<1>(terms, a, b, lane),
                2 => add::<2>(terms, a, b, lane),
                3 => add::<3>(terms, a, b, lane),
                4 => add::<4>(terms, a, b, lane),
                5 => add::<5>(terms, a, b, lane),
                6 => add::<6>(terms, a, b, lane),
                7 => add::<7>(terms, a, b, lane),
                _ => add::<8>(terms, a, b, lane),
            }
        }
    }
}

/// Adds `N` terms to a lane of the product.
#[inline(always)]
fn add<const N: usize>(terms: &[Term], a: &[Lane], b: &[Lane], out: &mut Lane) {
    let signs: [f64; N] = std::array::from_fn(|t| f64::from(terms[t].sign));
    let xs: [&Lane; N] = std::array::from_fn(|t| &a[terms[t].a]);
    let ys: [&Lane; N] = std::array::from_fn(|t| &b[terms[t].b]);
    // A copy, which the compiler knows to be apart from the factors.
    let mut sums = out.0;
    for l in 0..LANES {
        for t in 0..N {
            sums[l] += signs[t] * xs[t].0[l] * ys[t].0[l];
        }
    }
    out.0 = sums;
}

/// The geometric product of all grades in 3-d space, written out.
struct Geometric<'a>(&'a Plan);

impl Kernel for Geometric<'_> {
    fn row(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        self.0.row(a, b, out);
    }

    #[inline(always)]
    fn block(&self, a: &[Lane], b: &[Lane], out: &mut [Lane]) {
        let (a, b, out) = (&a[..8], &b[..8], &mut out[..8]);
        for l in 0..LANES {
            let row = |lanes: &[Lane]| std::array::from_fn(|k| lanes[k].0[l]);
            let product = geometric(row(a), row(b));
            for k in 0..8 {
                // A sum that begins with 0, as in the plan, is never −0.
                out[k].0[l] = product[k] + 0.0;
            }
        }
    }
}

/// `R X ~R` for X that holds some grades: vector and bivector turn as three numbers each, scalar and
/// trivector stay.
struct Turn(Grades);

impl Turn {
    /// Where each part begins, and how many numbers it has.
    fn parts(&self) -> impl Iterator<Item = (usize, usize)> {
        let present = (0..4).filter(|&k| self.0.contains(k));
        present.map(|k| if k % 3 == 0 { 1 } else { 3 }).scan(0, |next, width| {
            *next += width;
            Some((*next - width, width))
        })
    }
}

impl Kernel for Turn {
    const FAST_ROWS: bool = true;

    fn row(&self, rotor: &[f64], value: &[f64], out: &mut [f64]) {
        let rotor = Rotor::from_unit_components(std::array::from_fn(|k| rotor[k]));
        for (at, width) in self.parts() {
            if width == 1 {
                out[at] = value[at];
            } else {
                let turned = rotor.apply(Vector([value[at], value[at + 1], value[at + 2]]));
                out[at..at + 3].copy_from_slice(&turned.0);
            }
        }
    }

    #[inline(always)]
    fn block(&self, rotors: &[Lane], values: &[Lane], out: &mut [Lane]) {
        let rotors = &rotors[..4];
        for (at, width) in self.parts() {
            if width == 1 {
                out[at] = values[at];
                continue;
            }
            let (values, out) = (&values[at..at + 3], &mut out[at..at + 3]);
            for l in 0..LANES {
                let rotor = Rotor::from_unit_components(std::array::from_fn(|k| rotors[k].0[l]));
                let turned = rotor.apply(Vector([values[0].0[l], values[1].0[l], values[2].0[l]]));
                for k in 0..3 {
                    out[k].0[l] = turned.0[k];
                }
            }
        }
    }
}

impl Plan {
    /// Multiplies row by row into `out`. A factor of a single row meets every row of the other.
    ///
    /// # Panics
    /// If a slice is not a whole number of rows, or the numbers of rows do not fit together.
    pub fn run<T: Element>(&self, a: &[T], b: &[T], out: &mut [T]) {
        self.run_threads(Threads::ONE, a, b, out);
    }

    /// [`Plan::run`] by several threads, where there are enough rows for it to pay.
    ///
    /// # Panics
    /// As [`Plan::run`].
    pub fn run_threads<T: Element>(&self, threads: Threads, a: &[T], b: &[T], out: &mut [T]) {
        self.run_on(Path::best(), threads, a, b, out);
    }

    fn run_on<T: Element>(&self, path: Path, threads: Threads, a: &[T], b: &[T], out: &mut [T]) {
        let (na, nb, nout) = self.sizes;
        let (a, b, out) = ((a, na), (b, nb), (out, nout));
        match &self.engine {
            Engine::Terms => sweep(path, threads, self, a, b, out),
            Engine::Geometric => sweep(path, threads, &Geometric(self), a, b, out),
            // Blocks of more rows leave the first-level cache; of few rows, one of eight is enough.
            Engine::Tiles(tiles) if out.0.len() > 8 * nout => {
                sweep::<_, 16, _>(path, threads, tiles, a, b, out)
            }
            Engine::Tiles(tiles) => sweep::<_, 8, _>(path, threads, tiles, a, b, out),
        }
    }
}

/// `R X ~R` for rows of rotor components and rows of values that hold `grades`. Scalar and trivector
/// stay; vector and bivector each turn as three numbers. One row of either meets every row of the other.
///
/// # Panics
/// If there are no grades, or the numbers of rows do not fit together.
pub fn turn<T: Element>(rotors: &[T], values: &[T], grades: Grades, out: &mut [T]) {
    turn_threads(Threads::ONE, rotors, values, grades, out);
}

/// [`turn`] by several threads, where there are enough rows for it to pay.
///
/// # Panics
/// As [`turn`].
pub fn turn_threads<T: Element>(threads: Threads, rotors: &[T], values: &[T], grades: Grades, out: &mut [T]) {
    turn_on(Path::best(), threads, rotors, values, grades, out);
}

fn turn_on<T: Element>(
    path: Path,
    threads: Threads,
    rotors: &[T],
    values: &[T],
    grades: Grades,
    out: &mut [T],
) {
    let turn = Turn(grades);
    let size = turn.parts().map(|(_, width)| width).sum();
    sweep(path, threads, &turn, (rotors, 4), (values, size), (out, size));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::product::Product;
    use crate::sweep::STREAMED;
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
                plan.run_on(path, Threads::ONE, &a[place.clone()], &b[place], &mut out);
                assert_same(&out, expected, &format!("{path:?}, row {row}"));
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
                plan.row(&a[row * na..(row + 1) * na], &b[row * nb..(row + 1) * nb], out);
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
            turn(&r[4 * first..4 * last], &v[3 * first..3 * last], Grades(0b0010), out);
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
                plan.run(a, b, &mut expected);
                for threads in [2, 3, 7] {
                    let mut out = vec![0.5; rows * 8];
                    plan.run_threads(Threads::new(threads), a, b, &mut out);
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
            plan.run(&wide(&a), &wide(&b), &mut expected);
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
            turn(&wide(&r), &wide(&x), Grades::ALL, &mut expected);
            assert_same(&wide(&out), &wide(&narrow(&expected)), &format!("{path:?}"));
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
}
