//! The axioms of the algebra and of rotors, over random values from the whole range of sizes.

use polhode_ga::g3::pauli;
use polhode_ga::product::Product;
use polhode_ga::{Bivector, Multivector, Rotor, Vector};
use proptest::prelude::*;
use std::f64::consts::PI;

const EPS: f64 = f64::EPSILON;

fn multivector() -> impl Strategy<Value = Multivector> {
    prop::array::uniform8(-10.0..10.0f64).prop_map(Multivector)
}

/// Components whose sums of products of up to four are exact in binary64.
fn integers() -> impl Strategy<Value = Multivector> {
    prop::array::uniform8(-100..100i32).prop_map(|c| Multivector(c.map(f64::from)))
}

fn rotor() -> impl Strategy<Value = Rotor> {
    prop::array::uniform4(-1.0..1.0f64).prop_filter_map("zero", |c| Rotor::from_components(c).ok())
}

/// A bivector whose size is 10^e, e from −300 to 2, or an angle near 0, π/2 or π.
fn exponent() -> impl Strategy<Value = Bivector> {
    let size = prop_oneof![
        (-300.0..2.0f64).prop_map(|e| 10f64.powf(e)),
        (-16.0..-1.0f64).prop_map(|e| PI - 10f64.powf(e)),
        (-16.0..-1.0f64).prop_map(|e| 0.5 * PI + 10f64.powf(e)),
        Just(PI),
    ];
    (size, prop::array::uniform3(-1.0..1.0f64)).prop_filter_map("no plane", |(size, c)| {
        let plane = Bivector(c);
        (plane.norm() > 1e-3).then(|| plane * (size / plane.norm()))
    })
}

fn difference(a: Multivector, b: Multivector) -> f64 {
    (a - b).norm()
}

proptest! {
    #[test]
    fn the_product_is_associative_and_distributive(a in integers(), b in integers(), c in integers()) {
        prop_assert_eq!((a * b) * c, a * (b * c));
        prop_assert_eq!(a * (b + c), a * b + a * c);
        prop_assert_eq!((a * b).reverse(), b.reverse() * a.reverse());
        prop_assert_eq!((a * b).grade_involution(), a.grade_involution() * b.grade_involution());
    }

    #[test]
    fn the_named_products_are_parts_of_it(a in integers(), b in integers()) {
        prop_assert_eq!(a.product(Product::Geometric, b), a * b);
        let commutator = (a * b - b * a) * 0.5;
        prop_assert_eq!(a.product(Product::Commutator, b), commutator);
        prop_assert_eq!(a.product(Product::Scalar, b), (a * b).grade(0));
        for r in 0..4 {
            for s in 0..4 {
                let product = a.grade(r) * b.grade(s);
                let part = |k: Option<usize>| k.map_or(Multivector::default(), |k| product.grade(k));
                let named = |p: Product| a.grade(r).product(p, b.grade(s));
                prop_assert_eq!(named(Product::Dot), part(Some(r.abs_diff(s))));
                prop_assert_eq!(named(Product::Wedge), part((r + s < 4).then_some(r + s)));
                prop_assert_eq!(named(Product::LeftContraction), part(s.checked_sub(r)));
                prop_assert_eq!(named(Product::RightContraction), part(r.checked_sub(s)));
            }
        }
    }

    /// The inverse's relative error is the condition number |M||M⁻¹| times a few roundings.
    #[test]
    fn the_inverse_undoes(m in multivector(), e in -140.0..140.0f64) {
        let m = m * 10f64.powf(e);
        if let Ok(inverse) = m.inverse() {
            let condition = m.norm() * inverse.norm();
            prop_assert!(difference(m * inverse, Multivector::scalar(1.0)) <= 16.0 * EPS * condition);
        }
    }

    #[test]
    fn exp_of_log_returns(m in multivector()) {
        if let (Ok(log), Ok(inverse)) = (m.log(), m.inverse()) {
            let condition = m.norm() * inverse.norm() * (1.0 + log.norm());
            prop_assert!(difference(log.exp().unwrap(), m) <= 16.0 * EPS * condition * m.norm());
        }
    }

    /// Rounding the angle turns by half an ulp of it; everything else is a few roundings.
    #[test]
    fn log_of_exp_returns_up_to_half_a_turn(b in exponent()) {
        if b.norm() <= PI {
            let back = Rotor::exp(b).log();
            // Near π the log's size is π to rounding, the plane is known to rounding over sin.
            let error = (back - b).norm();
            let known = b.norm().sin().abs().max(1e-300);
            prop_assert!(error <= 4.0 * EPS * b.norm() * (1.0 + 1.0 / known.min(1.0) * b.norm() / PI), "{error}");
        }
        let c = Rotor::exp(b).components();
        prop_assert!((c.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() <= 4.0 * EPS);
    }

    #[test]
    fn rotors_are_a_group_that_acts(r in rotor(), s in rotor(), m in multivector()) {
        let unit = |r: Rotor| (r.components().iter().map(|x| x * x).sum::<f64>() - 1.0).abs();
        prop_assert!(unit(r * s) <= 8.0 * EPS);
        let sandwich = Multivector::from(r) * m * Multivector::from(r.reverse());
        prop_assert!(difference(r.apply_multivector(m), sandwich) <= 16.0 * EPS * m.norm());
        let composed = (s * r).apply_multivector(m);
        prop_assert!(difference(composed, s.apply_multivector(r.apply_multivector(m))) <= 24.0 * EPS * m.norm());
        prop_assert!((r * r.reverse()).components()[0] - 1.0 <= 4.0 * EPS);
    }

    /// The angle is 2 atan2; its rounding, and that of the plane, are a few ulps.
    #[test]
    fn plane_and_angle_give_the_rotor_back(r in rotor()) {
        let (plane, angle) = r.plane_angle();
        let back = Rotor::from_plane_angle(plane, angle).unwrap();
        prop_assert!((0.0..=2.0 * PI).contains(&angle));
        prop_assert!(difference(back.into(), r.into()) <= 8.0 * EPS);
    }

    #[test]
    fn matrices_turn_as_their_rotors(r in rotor(), x in prop::array::uniform3(-1.0..1.0f64)) {
        let m = r.to_matrix();
        let turned = [0, 1, 2].map(|i| m[i][0] * x[0] + m[i][1] * x[1] + m[i][2] * x[2]);
        prop_assert!((r.apply(Vector(x)) - Vector(turned)).norm() <= 16.0 * EPS);
        let back = Rotor::from_matrix(m).unwrap();
        let sign = if r.components()[0] < 0.0 { -1.0 } else { 1.0 };
        prop_assert!(difference(back.into(), Multivector::from(r) * sign) <= 16.0 * EPS);
    }

    /// One vector goes into the other, for nearly opposite ones too: a, and −a off by 10^e.
    #[test]
    fn vectors_turn_into_each_other(
        a in prop::array::uniform3(-1.0..1.0f64),
        off in prop::array::uniform3(-1.0..1.0f64),
        e in -20.0..1.0f64,
    ) {
        let a = Vector(a);
        prop_assume!(a.norm() > 1e-3);
        let b = -a + Vector(off) * 10f64.powf(e);
        prop_assume!(b.norm() > 1e-3);
        let r = Rotor::from_vectors(a, b).unwrap();
        prop_assert!((r.apply(a / a.norm()) - b / b.norm()).norm() <= 16.0 * EPS);
    }

    #[test]
    fn pauli_matrices_are_a_faithful_picture(m in multivector()) {
        prop_assert!(difference(pauli::from_pauli(pauli::to_pauli(m)), m) <= 2.0 * EPS * m.norm());
    }
}

#[test]
fn minus_one_is_on_the_double_cover() {
    let minus_one = Rotor::from_components([-1.0, 0.0, 0.0, 0.0]).unwrap();
    assert_eq!(minus_one.log(), Bivector([0.0, 0.0, PI]));
    assert_eq!(minus_one.plane_angle(), (Bivector([0.0, 0.0, 1.0]), 2.0 * PI));
    assert!(difference(Rotor::exp(minus_one.log()).into(), minus_one.into()) <= EPS);
}

#[test]
fn null_elements_have_no_inverse() {
    for null in [[1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]] {
        let null = Multivector(null);
        for scale in [1e-200, 1.0, 1.0 / 3.0, 1e200] {
            assert!((null * scale).inverse().is_err(), "{null:?}");
            assert!((null * scale).log().is_err());
        }
    }
    assert!(Multivector::default().inverse().is_err());
    assert!(Multivector([f64::NAN; 8]).inverse().is_err());
}
