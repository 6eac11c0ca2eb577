use super::*;

/// Every component changes by the size of the noise, up or down with the same chance, and the rotor stays one; zeros stay.
#[test]
fn noise_changes_components_by_its_size_and_random_signs() {
    let size = 1e-6;
    let rotor = Rotor::from_unit_components([0.5, -0.5, 0.5, 0.5]);
    let phase = Phase { rotor, momentum: Bivector([2.0, 0.0, -3.0]), time: 1.0 };
    let center = Center { position: Vector([1.0, -2.0, 0.0]), velocity: Vector([0.0, 4.0, 5.0]) };
    let at = Carried::new(phase, center);
    let count = 400;
    let mut noise = Noise::new(size, false, 7);
    let mut raised = [0; 10];
    for _ in 0..count {
        let found = noise.perturb(&at);
        let norm = found.phase.rotor.components().iter().map(|x| x * x).sum::<f64>();
        assert!((norm - 1.0).abs() <= 4.0 * f64::EPSILON);
        let components = |c: &Carried| {
            let (m, x, v) = (c.phase.momentum.0, c.center.position.0, c.center.velocity.0);
            [m, x, v].concat()
        };
        for (k, (new, old)) in components(&found).into_iter().zip(components(&at)).enumerate() {
            assert!(
                (new - old).abs() <= 1.001 * size * old.abs()
                    && (new - old).abs() >= 0.999 * size * old.abs()
            );
            raised[k] += usize::from(new.abs() > old.abs());
        }
        let turned = (found.phase.rotor.components()[0] - 0.5).abs();
        assert!(turned <= 1.001 * size);
        raised[9] += usize::from(found.phase.rotor.components()[0] > 0.5);
    }
    // Six standard deviations of 400 throws of a coin are 60; of the rotor's part, after its norm is taken out, less often.
    for k in [0, 2, 3, 4, 7, 8] {
        assert!(raised[k].abs_diff(count / 2) <= 60, "{k}: {}", raised[k]);
    }
    assert!([1, 5, 6].iter().all(|&k| raised[k] == 0) && raised[9] > 0 && raised[9] < count);
}

/// Steps whose errors only add up are not magnified, and the margin is never lost.
#[test]
fn magnification_is_that_of_noise_over_root_n_steps() {
    let found = Magnification::new(5e-8, 1e-12, 100, f64::EPSILON);
    assert!((found.of_sums() / (SAFETY * 5e3) - 1.0).abs() < 1e-12);
    assert!((found.rounding_error(400) / (SAFETY * f64::EPSILON * 1e5) - 1.0).abs() < 1e-12);
    let still = Magnification::new(0.0, 1e-12, 100, f64::EPSILON);
    assert!(still.of_sums() == SAFETY && still.rounding_error(400) == SAFETY * f64::EPSILON);
}
