//! Typed, graded and planned products, rotors and functions of multivectors against the blade table.
#![no_main]

mod table;

use libfuzzer_sys::fuzz_target;
use polhode_ga::g3::functions::Function;
use polhode_ga::general::Calculus;
use polhode_ga::product::{Grades, Plan, Product};
use polhode_ga::rows::{compose, product as rows};
use polhode_ga::simd::threads::Threads;
use polhode_ga::table::{Algebra, G3, Signature};
use polhode_ga::{Graded, MathError, Multivector, Rotor};
use table::{assert_close, product};

/// Two multivectors of 3-d space, two sets of grades, and the signature and the number of rows of a product.
type Input = ([[i8; 2]; 8], [[i8; 2]; 8], [u8; 2], [u8; 3], u8);

fuzz_target!(|input: Input| {
    let (a, b, grades, signature, rows) = input;
    let (a, b) = (a.map(number), b.map(number));
    typed(Multivector(a), Multivector(b));
    graded(a, b, grades.map(|g| Grades(u16::from(g % 16))));
    rotors(a, b);
    functions(Multivector(a));
    if let Some(algebra) = small(signature) {
        planned(&algebra, &[a, b].concat(), grades, 1 + usize::from(rows % 70));
    }
});

/// A small integer times a power of two, small or of the whole range.
fn number([mantissa, exponent]: [i8; 2]) -> f64 {
    let exponent = i32::from(exponent);
    f64::from(mantissa) * f64::from(if exponent.abs() < 64 { exponent / 8 } else { 8 * exponent }).exp2()
}

/// The algebra of a signature with up to 5 generators.
fn small([p, q, r]: [u8; 3]) -> Option<Algebra> {
    let [p, q, r] = [p % 6, q % 6, r % 6].map(usize::from);
    Algebra::new(Signature { p, q, r }).filter(|algebra| algebra.blades().len() <= 32)
}

/// By the table, with the rounding of eight terms.
fn check(found: impl Into<Multivector>, kind: Product, a: Multivector, b: Multivector, what: &str) {
    assert_close(&found.into().0, &product(&G3, kind, &a.0, &b.0), 8, &format!("{what} of {a:?} and {b:?}"));
}

fn typed(a: Multivector, b: Multivector) {
    for kind in Product::ALL {
        check(a.product(kind, b), kind, a, b, kind.name());
    }
    check(a * b, Product::Geometric, a, b, "*");
    let pseudoscalar = Multivector([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    check(a.undual(), Product::Geometric, a, pseudoscalar, "undual");
    check(a.dual(), Product::Geometric, a, -pseudoscalar, "dual");

    let (u, v) = (a.vector_part(), b.vector_part());
    let (left, right) = (a.bivector_part(), b.bivector_part());
    let [mu, mv]: [Multivector; 2] = [u.into(), v.into()];
    let [ml, mr]: [Multivector; 2] = [left.into(), right.into()];
    check(Multivector::scalar(u.dot(v)), Product::Dot, mu, mv, "dot");
    check(u.wedge(v), Product::Wedge, mu, mv, "wedge");
    check(u.cross(v).undual(), Product::Wedge, mu, mv, "I times cross");
    check(u.dot_bivector(right), Product::Dot, mu, mr, "dot_bivector");
    check(u.wedge_bivector(right), Product::Wedge, mu, mr, "wedge_bivector");
    check(Multivector::scalar(left.dot(right)), Product::Dot, ml, mr, "dot of bivectors");
    check(left.commutator(right), Product::Commutator, ml, mr, "commutator of bivectors");
}

fn graded(a: [f64; 8], b: [f64; 8], [ga, gb]: [Grades; 2]) {
    let part = |m: &[f64], g: Grades| -> Vec<f64> { g.indices(&G3).iter().map(|&k| m[k]).collect() };
    let [x, y] = [(&a, ga), (&b, gb)].map(|(m, g)| Graded::new(&part(m, g), g).expect("so many components"));
    for kind in Product::ALL {
        let (found, expected) = (x.product(kind, &y).full(), product(&G3, kind, &x.full(), &y.full()));
        assert_close(&found, &expected, 8, &format!("{} of {x:?}, {y:?}", kind.name()));
    }
    assert_eq!(Multivector(x.reverse().full()), Multivector(x.full()).reverse());
}

/// `R X ~R` and `SR` for rotors; both differ from the products by roundings of the sizes of the factors.
fn rotors(a: [f64; 8], b: [f64; 8]) {
    let rotor = |m: [f64; 8]| Rotor::from_components([m[0], m[4], m[5], m[6]]);
    let (Ok(r), Ok(s)) = (rotor(a), rotor(b)) else { return };
    let near = |found: Multivector, expected: Multivector, size: f64, what: &str| {
        let bound = 32.0 * (f64::EPSILON * size + f64::MIN_POSITIVE * f64::EPSILON);
        let close = found.0.iter().zip(expected.0).all(|(x, y)| (x - y).abs() <= bound);
        assert!(close || size > 1e-3 * f64::MAX, "{what}: {found:?}, by the table {expected:?}");
    };
    let by_table = |x: Multivector, y: Multivector| {
        Multivector(product(&G3, Product::Geometric, &x.0, &y.0).0.try_into().expect("eight components"))
    };
    let (mr, ms): (Multivector, Multivector) = (r.into(), s.into());
    near(s.compose(r).into(), by_table(ms, mr), 1.0, "composed");
    let m = Multivector(b);
    near(r.apply_multivector(m), by_table(by_table(mr, m), mr.reverse()), m.norm(), "turned");
    near(Rotor::exp(r.log()).into(), mr, 1.0, "exp log");

    let mut out = [0.0; 4];
    compose::compose(Threads::ONE, &s.components(), &r.components(), &mut out);
    assert_eq!(out, s.compose(r).components());
    let mut out = [0.0; 8];
    rows::turn(Threads::ONE, &r.components(), &b, Grades::ALL, &mut out);
    assert!(out.iter().zip(r.apply_multivector(m).0).all(|(x, y)| *x == y || x.is_nan() && y.is_nan()));
}

/// Functions of one multivector by the products that define them, in the range where squares are finite.
fn functions(m: Multivector) {
    let size = m.norm();
    if !(1e-140..1e140).contains(&size) {
        // Far values have a finite value or an error.
        return assert!(Function::ALL.iter().all(|f| f.apply(m).map_or(true, is_finite)), "{m:?}");
    }
    let near = |found: Multivector, expected: Multivector, bound: f64, what: &str| {
        let bound = f64::EPSILON * bound;
        let error = (found - expected).norm();
        assert!(error <= bound || !bound.is_finite(), "{what} of {m:?}: error {error:e}, bound {bound:e}");
    };
    if size <= 1.0 {
        let exp = m.exp().expect("a small exponent");
        let mut term = Multivector::scalar(1.0);
        let series = (1..30).fold(term, |sum, k| {
            term = term * m / f64::from(k);
            sum + term
        });
        near(exp, series, 64.0, "exp");
    }
    let Ok(inverse) = m.inverse() else { return };
    let condition = size * inverse.norm();
    near(m * inverse, Multivector::scalar(1.0), 16.0 * condition, "inverse");
    let calculus = Calculus::new(&G3);
    if let Ok(general) = calculus.inverse(&m.0) {
        let general = Multivector(general.try_into().expect("eight components"));
        near(inverse, general, 64.0 * condition * inverse.norm(), "inverse in any algebra");
    }
    if let Ok(root) = m.sqrt() {
        near(root * root, m, 64.0 * root.norm_squared() * condition, "sqrt");
    }
    match m.log().map(|log| (log, log.exp())) {
        Ok((log, Ok(exp))) => near(exp, m, 16.0 * condition * (1.0 + log.norm()) * size, "exp log"),
        Ok((log, Err(error))) => panic!("log of {m:?} is {log:?}, whose exp is an error: {error}"),
        Err(error) => assert!(matches!(error, MathError::NoLogarithm), "{m:?}: {error}"),
    }
}

fn is_finite(m: Multivector) -> bool {
    m.0.iter().all(|x| x.is_finite())
}

/// A planned product over rows, of values of some grades in any algebra; one row of the left factor for all.
fn planned(algebra: &Algebra, numbers: &[f64], grades: [u8; 2], count: usize) {
    let blades = algebra.blades().len();
    let all = (1 << (algebra.squares().len() + 1)) - 1;
    let [ga, gb] =
        grades.map(|g| Grades(u16::from(g) & all)).map(|g| if g.0 == 0 { Grades::SCALAR } else { g });
    let [ia, ib] = [ga, gb].map(|g| g.indices(algebra));
    let full = |indices: &[usize], row: usize| -> Vec<f64> {
        let component = |k| if indices.contains(&k) { numbers[(7 * k + row) % numbers.len()] } else { 0.0 };
        (0..blades).map(component).collect()
    };
    let packed = |indices: &[usize], row: usize| -> Vec<f64> {
        let m = full(indices, row);
        indices.iter().map(|&k| m[k]).collect()
    };
    let (left, right) = (packed(&ia, 0), (0..count).flat_map(|row| packed(&ib, row)).collect::<Vec<_>>());
    for kind in Product::ALL {
        let plan = Plan::new(algebra, kind, ga, gb);
        let indices = plan.grades.indices(algebra);
        let mut out = vec![f64::NAN; plan.sizes.2 * count];
        plan.run(Threads::ONE, &left, &right, &mut out);
        for (row, found) in out.chunks(plan.sizes.2).enumerate() {
            let mut components = vec![0.0; blades];
            indices.iter().zip(found).for_each(|(&k, &x)| components[k] = x);
            let expected = product(algebra, kind, &full(&ia, 0), &full(&ib, row));
            let what = format!("{} in {:?}, grades {ga:?}, {gb:?}", kind.name(), algebra.signature());
            assert_close(&components, &expected, blades, &what);
        }
    }
}
