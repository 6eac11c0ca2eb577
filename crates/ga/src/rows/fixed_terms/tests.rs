use crate::product::{Grades, Plan, Product};

/// The products that should be recognised are: by their names, not their terms.
#[test]
fn common_products_are_known() {
    let (scalar, vector, bivector, even) = (Grades::SCALAR, Grades::VECTOR, Grades::BIVECTOR, Grades::EVEN);
    let pseudoscalar = Grades(0b1000);
    let common = [
        (Product::Wedge, vector, vector),
        (Product::Commutator, bivector, bivector),
        (Product::Dot, bivector, vector),
        (Product::Dot, vector, bivector),
        (Product::Geometric, vector, vector),
        (Product::Geometric, bivector, bivector),
        (Product::Geometric, even, even),
        (Product::Geometric, even, vector),
        (Product::Geometric, vector, even),
        (Product::Geometric, scalar, scalar),
        (Product::Geometric, scalar, vector),
        (Product::Geometric, bivector, scalar),
        (Product::Geometric, vector, pseudoscalar),
        (Product::Geometric, scalar, even),
        (Product::Geometric, even, scalar),
        (Product::Dot, vector, vector),
        (Product::Dot, bivector, bivector),
    ];
    for (product, ga, gb) in common {
        assert!(Plan::g3(product, ga, gb).fixed_terms.is_some(), "{product:?} {ga:?} {gb:?}");
    }
}
