use super::*;
use crate::rows::product::turn;
use crate::simd::threads::Threads;
use crate::table::G3;

fn numbers(seed: usize, count: usize) -> Vec<f64> {
    (0..count).map(|i| ((seed * 31 + i) as f64 * 0.7).sin()).collect()
}

/// Every product of every pair of sets of grades equals the batch kernels bit for bit.
#[test]
fn single_values_equal_the_batches() {
    for (ga, gb) in (1..16).flat_map(|a| (1..16).map(move |b| (Grades(a), Grades(b)))) {
        let (a, b) = (numbers(1, size(ga)), numbers(2, size(gb)));
        let (left, right) = (Graded::new(&a, ga).unwrap(), Graded::new(&b, gb).unwrap());
        for product in Product::ALL {
            let plan = Plan::g3(product, ga, gb);
            let mut expected = vec![0.0; plan.sizes.2];
            plan.run(Threads::ONE, &a, &b, &mut expected);
            let got = left.product(product, &right);
            assert_eq!(got.components(), expected, "{product:?} {ga:?} {gb:?}");
            assert_eq!(got.grades(), plan.grades);
        }
        let rotor = Rotor::from_components([0.3, -0.2, 0.9, 0.4]).unwrap();
        let mut expected = vec![0.0; b.len()];
        turn(Threads::ONE, &rotor.components(), &b, gb, &mut expected);
        assert_eq!(right.turned(rotor).components(), expected);
    }
}

/// A sum that begins with 0 is never −0: here all terms of the scalar part are −0.
#[test]
fn zeros_have_the_signs_of_the_batches() {
    let bits = |m: &[f64]| m.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    for grades in (1..16).map(Grades) {
        let square = |i: usize| if G3.blades()[i].grade() >= 2 { -1.0 } else { 1.0 };
        let a: Vec<f64> = grades.indices(&G3).into_iter().map(|i| -0.0 * square(i)).collect();
        let b = vec![1.0; size(grades)];
        let (left, right) = (Graded::new(&a, grades).unwrap(), Graded::new(&b, grades).unwrap());
        for product in Product::ALL {
            let plan = Plan::g3(product, grades, grades);
            let mut expected = vec![0.0; plan.sizes.2];
            plan.run(Threads::ONE, &a, &b, &mut expected);
            assert_eq!(
                bits(left.product(product, &right).components()),
                bits(&expected),
                "{product:?} {grades:?}"
            );
        }
    }
}

#[test]
fn parts_and_sums_follow_the_basis() {
    for grades in (1..16).map(Grades) {
        let value = Graded::new(&numbers(3, size(grades)), grades).unwrap();
        let full = value.full();
        for (x, i) in value.components().iter().zip(grades.indices(&G3)) {
            assert_eq!(*x, full[i]);
        }
        let all = value.with_grades(Grades::ALL);
        assert_eq!(all.components(), full);
        assert_eq!(all.with_grades(grades), value);
        let sum = value.zip(&Graded::new(&[1.0], Grades::SCALAR).unwrap(), |x, y| x + y);
        assert_eq!(sum.full()[0], full[0] + 1.0);
        for (i, x) in value.reverse().full().iter().enumerate() {
            assert_eq!(*x, if G3.blades()[i].grade() >= 2 { -full[i] } else { full[i] });
        }
    }
    assert_eq!(Graded::new(&[1.0, 2.0], Grades::SCALAR), None);
    assert_eq!(Graded::new(&[1.0], Grades(16)), None);
}

/// 3-d space has no grade above 3, also where a set of such grades would have no components.
#[test]
fn grades_above_three_are_refused() {
    for grades in [16, 17, 24, 0x8000] {
        for count in 0..=8 {
            assert_eq!(Graded::new(&vec![0.0; count], Grades(grades)), None, "{grades} {count}");
        }
    }
    assert!(Graded::new(&[1.0], Grades(8)).is_some());
}
