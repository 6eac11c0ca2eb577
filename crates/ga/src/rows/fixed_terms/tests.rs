use crate::product::{Grades, Plan, Product};

/// The products that should be recognised are: by their names, not their terms.
#[test]
fn common_products_are_known() {
    let (vector, bivector, even) = (Grades::VECTOR, Grades::BIVECTOR, Grades::EVEN);
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
    ];
    for (product, ga, gb) in common {
        assert!(Plan::g3(product, ga, gb).fixed_terms.is_some(), "{product:?} {ga:?} {gb:?}");
    }
}
