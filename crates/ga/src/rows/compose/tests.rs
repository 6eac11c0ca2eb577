use super::*;

/// Rows of norm 1 to rounding, and some as far off as those of single precision.
fn rotors(count: usize, phase: f64) -> Vec<f64> {
    let rotor = |i: usize| {
        let c = std::array::from_fn(|k| ((4 * i + k) as f64 + phase).sin());
        let size = if i.is_multiple_of(5) { 1.0 + 3e-8 } else { 1.0 };
        Rotor::from_components(c).unwrap().components().map(|x| x * size)
    };
    (0..count).flat_map(rotor).collect()
}

/// Every path and any number of threads give the bits of single rotors, of norm 1.
#[test]
fn rows_equal_single_rotors() {
    let (s, r) = (rotors(150, 0.3), rotors(150, 1.1));
    let unit = |c: &[f64]| Rotor::from_unit_components(std::array::from_fn(|k| c[k]));
    for path in Path::available() {
        for (many_s, many_r) in [(1, 150), (150, 1), (150, 150), (5, 5), (1, 1)] {
            let rows = many_s.max(many_r);
            let mut out = vec![f64::NAN; 4 * rows];
            compose_on(path, Threads::new(3), &s[..4 * many_s], &r[..4 * many_r], &mut out);
            for (i, got) in out.chunks_exact(4).enumerate() {
                let (i, j) = (i.min(many_s - 1), i.min(many_r - 1));
                let expected = unit(&s[4 * i..]).compose(unit(&r[4 * j..])).components();
                assert_eq!(got, expected, "{path:?}");
                let norm = got.iter().map(|x| x * x).sum::<f64>().sqrt();
                assert!((norm - 1.0).abs() <= 4.0 * f64::EPSILON, "{norm}");
            }
        }
    }
}

#[test]
fn the_identity_changes_no_bit() {
    let one = Rotor::IDENTITY.components();
    let r = rotors(151, 0.7).split_off(4); // without the first, which is not a unit
    for c in r.chunks_exact(4).enumerate().filter(|(i, _)| i % 5 != 4).map(|(_, c)| c) {
        let mut out = [0.0; 4];
        compose(Threads::ONE, &one, c, &mut out);
        assert_eq!(out, c);
    }
}
