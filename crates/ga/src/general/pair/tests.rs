use super::*;

/// Each of the few operations rounds once or twice.
#[test]
fn roots_and_inverses_undo() {
    for q in [-1.0, -1e-9, 0.0, 1e-9, 0.5, 1.0] {
        let ring = Ring { q };
        for (x, y) in [(2.0, 0.3), (1e-3, 1e-4), (1e300, -5e299), (1e-300, 0.0), (-1.0, 1.5), (-2.0, 0.0)] {
            let a = Pair { x, y };
            let size = x.abs() + y.abs();
            let near = |b: Pair, c: Pair, size: f64| {
                (b.x - c.x).abs() + (b.y - c.y).abs() <= 16.0 * f64::EPSILON * size
            };
            let inverse = ring.inverse(a);
            let condition = size * (inverse.x.abs() + inverse.y.abs());
            assert!(near(ring.mul(a, inverse), Pair::ONE, condition), "{q} {a:?}");
            // Numbers x ± y√q off the negative axis.
            let exists = if q < 0.0 { x > 0.0 || y != 0.0 } else { x > y.abs() * q.sqrt() };
            let root = ring.sqrt(a);
            assert_eq!(root.is_some(), exists, "{q} {a:?}");
            if let Some(root) = root {
                let size = size.max((root.x.abs() + root.y.abs()).powi(2));
                assert!(near(ring.mul(root, root), a, size), "{q} {a:?} {root:?}");
            }
        }
    }
}
