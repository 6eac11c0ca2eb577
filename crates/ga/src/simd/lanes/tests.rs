use super::*;
use crate::{Bivector, Rotor, Vector};

fn rotors() -> [[f64; 4]; 2] {
    [[0.5, -0.25, 0.75, 1.0], [-0.3, 0.8, 0.1, -0.6]].map(|c| Rotor::from_components(c).unwrap().components())
}

/// The work of the tests, by each path: all products of two rotors and two vectors.
#[derive(Clone, Copy)]
struct Products;

const VECTORS: [[f64; 3]; 2] = [[0.3, -1.25, 2.0], [1.5, 0.2, -0.7]];

impl Work for Products {
    type Output = Vec<[f64; 16]>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Vec<[f64; 16]> {
        let [s, r] = rotors().map(|r| r.map(Lanes::<16, FUSED>::all));
        let [a, b] = VECTORS.map(|v| v.map(Lanes::<16, FUSED>::all));
        let m = matrix(&s);
        let mut all = composed(&s, &r).to_vec();
        all.extend(mapped(&m, &a));
        all.extend(mapped_back(&m, &a));
        all.extend(cross(&a, &b));
        all.push(dot(&a, &b));
        all.iter().map(|lanes| lanes.0).collect()
    }
}

/// On every path they are those of the typed values, to a few roundings.
#[test]
fn products_match_single_values() {
    let [s, r] = rotors().map(Rotor::from_unit_components);
    let [a, b] = VECTORS.map(Vector);
    let mut expected = (s * r).components().to_vec();
    expected.extend(s.apply(a).0);
    expected.extend(s.reverse().apply(a).0);
    expected.extend(a.wedge(b).0);
    expected.push(a.dot(b));
    assert_eq!(s.apply_bivector(Bivector(a.0)).0, s.apply(a).0);
    for path in Path::available() {
        for (lanes, x) in path.run(Products).iter().zip(&expected) {
            assert!(lanes.iter().all(|y| (y - x).abs() <= 16.0 * f64::EPSILON), "{path:?}: {x} {lanes:?}");
        }
    }
}

/// The same results, except on the portable path.
#[test]
fn work_with_wide_instructions() {
    for path in Path::available() {
        let result = path.run_if_wide(Products);
        assert_eq!(result, (!path.is_portable()).then(|| path.run(Products)), "{path:?}");
    }
}

/// On every path within 2 ulps of the library's, from no angle to a quarter turn, and none for NaN.
#[test]
fn angles_match_the_standard_library() {
    #[derive(Clone, Copy)]
    struct Angles([f64; 16], [f64; 16]);

    impl Work for Angles {
        type Output = [f64; 16];

        #[inline(always)]
        fn run<const FUSED: bool>(self) -> [f64; 16] {
            Lanes::<16, FUSED>(self.0).angle(Lanes(self.1)).0
        }
    }

    let mut sizes: Vec<f64> = (0..=1000).map(|k| f64::from(k) / 1000.0).collect();
    sizes.extend([1e-300, 1e-160, 1e-20, 1e-9, 1e-4, 1e3, 1e20, f64::NAN]);
    for scalar in [1.0, -1.0, 0.3, -1e-3, 1e-12] {
        for sizes in sizes.chunks(16) {
            let mut lanes = [1.0; 16];
            lanes[..sizes.len()].copy_from_slice(sizes);
            for path in Path::available() {
                for (angle, size) in path.run(Angles(lanes, [scalar; 16])).iter().zip(lanes) {
                    let exact = size.atan2(f64::abs(scalar));
                    let near = (angle - exact).abs() <= 2.0 * f64::EPSILON * exact;
                    assert!(near || angle.is_nan() && size.is_nan(), "{path:?}: {size}, {scalar}: {angle}");
                }
            }
        }
    }
}
