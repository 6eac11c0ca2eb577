use super::*;

fn round_trip<T: Element + PartialEq + std::fmt::Debug, const W: usize>() {
    // Miri interprets, a thousand times slower.
    let sizes: Vec<usize> = if cfg!(miri) { vec![1, 3, 4, 9] } else { (1..=20).chain([32, 64]).collect() };
    for path in Path::available() {
        for &size in &sizes {
            for rows in (0..20).chain([31, 32, 33, 56, 57, 63, 64]).filter(|&rows| rows <= W) {
                let numbers: Vec<T> = (0..rows * size).map(|i| T::nearest(i as f64)).collect();
                let mut lanes = vec![Lane::<W>::filled(-1.0); size];
                path.gather(&numbers, &mut lanes);
                for (k, lane) in lanes.iter().enumerate() {
                    for (row, &x) in lane.0.iter().enumerate() {
                        let expected = if row < rows { (row * size + k) as f64 } else { -1.0 };
                        assert_eq!(x, expected, "{path:?}, {rows} rows of {size}");
                    }
                }
                let mut back = vec![T::nearest(f64::NAN); rows * size];
                path.scatter(&lanes, &mut back);
                assert_eq!(back, numbers, "{path:?}, {rows} rows of {size}");
            }
        }
    }
}

/// Numbers of rows around the widths of the registers, and every number of components.
#[test]
fn gather_and_scatter_round_trip() {
    round_trip::<f64, 8>();
    round_trip::<f32, 32>();
    if !cfg!(miri) {
        round_trip::<f64, 64>();
        round_trip::<f32, 64>();
    }
}

fn streamed<T: Element + PartialEq + std::fmt::Debug>() {
    let numbers: Vec<T> = (0..100).map(|i| T::nearest(f64::from(i))).collect();
    for path in Path::available() {
        let mut to = vec![T::nearest(0.0); 100];
        let first = to_next_line(&to);
        path.stream(&numbers[1..81], &mut to[first..first + 80]);
        path.fence();
        assert_eq!(to[first..first + 80], numbers[1..81]);
        assert!(to[..first].iter().chain(&to[first + 80..]).all(|&x| x.into() == 0.0));
    }
}

#[test]
fn streams_copy() {
    streamed::<f64>();
    streamed::<f32>();
}
