use super::*;

fn basis(i: usize) -> Multivector {
    let mut m = Multivector::default();
    m.0[i] = 1.0;
    m
}

#[test]
fn written_out_product_equals_the_table() {
    for i in 0..8 {
        for j in 0..8 {
            let (sign, k) = G3.basis_product(i, j);
            assert_eq!(basis(i) * basis(j), basis(k) * f64::from(sign), "{i} {j}");
        }
    }
}

/// The typed products on all pairs of basis elements of their grades; they are bilinear.
#[test]
fn typed_products_equal_the_table() {
    for i in 0..3 {
        for j in 0..3 {
            let (a, b) = (basis(1 + i).vector_part(), basis(1 + j).vector_part());
            let (p, q) = (basis(4 + i).bivector_part(), basis(4 + j).bivector_part());
            let table = |product, x: Multivector, y: Multivector| x.product(product, y);
            let (ma, mb, mp, mq) = (a.into(), b.into(), p.into(), q.into());
            assert_eq!(Multivector::scalar(a.dot(b)), table(Product::Dot, ma, mb));
            assert_eq!(Multivector::from(a.wedge(b)), table(Product::Wedge, ma, mb));
            assert_eq!(Multivector::from(a.dot_bivector(q)), table(Product::Dot, ma, mq));
            assert_eq!(Multivector::from(a.wedge_bivector(q)), table(Product::Wedge, ma, mq));
            assert_eq!(Multivector::scalar(p.dot(q)), table(Product::Dot, mp, mq));
            assert_eq!(Multivector::from(p.commutator(q)), table(Product::Commutator, mp, mq));
            let minus_i = -basis(7);
            assert_eq!(Multivector::from(a.cross(b)), minus_i * table(Product::Wedge, ma, mb));
        }
    }
}

#[test]
fn dual_and_involutions_follow_their_definitions() {
    for i in 0..8 {
        let m = basis(i);
        assert_eq!(m.dual(), m * -basis(7));
        assert_eq!(m.undual(), m * basis(7));
        let r = G3.blades()[i].grade();
        let sign = |exponent: usize| if exponent.is_multiple_of(2) { 1.0 } else { -1.0 };
        assert_eq!(m.reverse(), m * sign(r * r.saturating_sub(1) / 2));
        assert_eq!(m.grade_involution(), m * sign(r));
        assert_eq!(m.clifford_conjugate(), m.reverse().grade_involution());
        assert_eq!(m.grade(r), m);
    }
}

#[test]
fn norm_spans_the_range_of_floats() {
    for scale in [5e-324, 1e-310, 1e-200, 1.0, 1e200, 1e307] {
        let norm = Vector([3.0 * scale, 4.0 * scale, 0.0]).norm();
        assert!((norm / (5.0 * scale) - 1.0).abs() < 4e-16, "{scale} {norm}");
    }
    assert_eq!(Vector([f64::NEG_INFINITY, 1.0, 0.0]).norm(), f64::INFINITY);
    assert!(Vector([f64::NAN, 1.0, 0.0]).norm().is_nan());
}
