use super::*;

const START: Center = Center { position: Vector([1.0, -2.0, 0.5]), velocity: Vector([-0.25, 3.0, 1.0]) };

const NO_SPRING: (f64, Vector) = (0.0, Vector([0.0; 3]));

/// A spring with its anchor at the origin, of a mass of 1 kg.
fn spring(drag: f64, stiffness: f64) -> CenterLaw {
    CenterLaw::new(Vector::default(), drag, (stiffness, Vector::default()), 1.0)
}

/// None, weak, oscillating, critical, nearly critical, strong and stiff.
fn laws() -> impl Iterator<Item = CenterLaw> {
    let drags = [0.0, 1e-9, 0.3, 2.0, 2.0 + 1e-12, 5.0, 1e6];
    let springs = [0.0, 1e-12, 0.04, 1.0, 1.0 + 1e-13, 400.0];
    let law = |drag, stiffness| {
        CenterLaw::new(Vector([0.5, 0.0, -9.0]), drag, (stiffness, Vector([0.0, 0.5, 0.0])), 1.0)
    };
    drags.into_iter().flat_map(move |drag| springs.map(|stiffness| law(drag, stiffness)))
}

/// Nothing amplifies the rounding of a motion that is damped: at most `ω t` of a phase, and ω of a velocity.
#[test]
fn times_add_up() {
    for law in laws() {
        let fastest = law.spring.sqrt().max(1.0);
        for (first, second) in [(0.1, 0.2), (1.0, 0.75), (2.0, 13.0), (0.0, 1.5), (40.0, 1e-3)] {
            let middle = law.after(&START, first.into());
            let end = law.after(&START, DoubleDouble::two_sum(first, second));
            let twice = law.after(&middle, second.into());
            let bound = 64.0 * f64::EPSILON * fastest * (1.0 + first + second);
            let size = end.position.norm().max(middle.position.norm()).max(3.0);
            assert!((twice.position - end.position).norm() <= bound * size, "{law:?} {first} {second}");
            let size = size * fastest;
            assert!((twice.velocity - end.velocity).norm() <= bound * size, "{law:?} {first} {second}");
        }
    }
}

#[test]
fn motion_backwards_returns() {
    for law in laws().filter(|law| law.drag <= 5.0) {
        let there = law.after(&START, 1.5.into());
        let back = law.after(&there, (-1.5).into());
        // Backwards the rounding grows by e^(γt).
        let bound = 64.0 * f64::EPSILON * f64::exp(1.5 * law.drag) * law.rate().max(1.0);
        assert!((back.position - START.position).norm() <= bound * there.position.norm().max(3.0), "{law:?}");
        let size = law.rate().max(1.0) * there.position.norm().max(3.0);
        assert!((back.velocity - START.velocity).norm() <= bound * size, "{law:?}");
    }
}

#[test]
fn the_start_is_kept_and_no_law_is_a_line() {
    for law in laws() {
        assert_eq!(law.after(&START, 0.0.into()), START);
    }
    let free = CenterLaw::default();
    assert!(free.is_zero());
    assert_eq!(free.after(&START, 1e200.into()).position, START.velocity * 1e200 + START.position);
}

#[test]
fn extreme_numbers_neither_overflow_nor_vanish() {
    let still = Center { velocity: Vector::default(), ..START };
    // m g/k, at once.
    let sinking = CenterLaw::new(Vector([0.0, 0.0, -9.0]), 1e300, NO_SPRING, 1.0);
    assert_eq!(sinking.after(&still, 1.0.into()).velocity, Vector([0.0, 0.0, -9e-300]));
    // A heavy spring turns by half a turn.
    for stiffness in [1e-300, 1e300] {
        let swing = spring(0.0, stiffness);
        let half = swing.after(&still, (std::f64::consts::PI / f64::sqrt(stiffness)).into());
        assert!((half.position + START.position).norm() <= 8.0 * f64::EPSILON, "{half:?}");
    }
    // Slow beside the drag: x' = −(κ/γ) x.
    let creeping = spring(1e160, 1.0);
    let later = creeping.after(&still, 1e160.into());
    assert!((later.position - START.position * f64::exp(-1.0)).norm() <= 8.0 * f64::EPSILON, "{later:?}");
    assert_eq!(spring(0.0, 1.0).horizon(), 2e17 * std::f64::consts::PI);
}
