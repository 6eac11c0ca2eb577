use super::*;

fn grades_of(product: Product, ga: u16, gb: u16) -> u16 {
    Plan::new(&G3, product, Grades(ga), Grades(gb)).grades.0
}

#[test]
fn grades_follow_the_products() {
    assert_eq!(grades_of(Product::Geometric, 0b0010, 0b0010), 0b0101); // vector vector
    assert_eq!(grades_of(Product::Geometric, 0b0010, 0b0100), 0b1010); // vector bivector
    assert_eq!(grades_of(Product::Wedge, 0b0010, 0b0010), 0b0100);
    assert_eq!(grades_of(Product::Dot, 0b0001, 0b0010), 0b0010); // 3·a = 3a
    assert_eq!(grades_of(Product::LeftContraction, 0b0100, 0b0010), 0b0001); // vanishes
    assert_eq!(grades_of(Product::Commutator, 0b0100, 0b0100), 0b0100);
    assert_eq!(grades_of(Product::Wedge, 0b0100, 0b0100), 0b0001); // vanishes: the scalar 0
}

#[test]
fn names_round_trip() {
    for product in Product::ALL {
        assert_eq!(Product::from_name(product.name()), Some(product));
    }
    assert_eq!(Product::from_name("outer"), None);
}
