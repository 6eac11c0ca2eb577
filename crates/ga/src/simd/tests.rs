use super::short::{GROUP, Short, Source};
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

/// `a − b`
struct Difference;

impl<const N: usize> Short<N, N, N> for Difference {
    fn value(a: [f64; N], b: [f64; N]) -> [f64; N] {
        std::array::from_fn(|k| a[k] - b[k])
    }
}

/// `b − (a − b)` of rows as a chain, to a place `offset` after the beginning of a cache line.
fn chained<T: Element + PartialEq + std::fmt::Debug, const N: usize>(
    rows: usize,
    offset: usize,
    streamed: bool,
) {
    let [a, b] = [3, 5].map(|step| -> Vec<T> {
        (0..rows * N).map(|i| T::nearest(f64::from((step * i as u32) % 101))).collect()
    });
    let whole = rows / GROUP * GROUP;
    for path in Path::available() {
        let mut lanes = vec![Lane::<GROUP>::filled(f64::NAN); 2 * N];
        let (a_rows, b_rows) = (Source::Rows(&a[..]), Source::Rows(&b[..]));
        let links = [
            path.link::<Difference, T, N, N, N, GROUP>([a_rows, b_rows], N),
            path.link::<Difference, T, N, N, N, GROUP>([b_rows, Source::Lanes(N)], 0),
        ];
        let Some(links) = links.into_iter().collect::<Option<Vec<_>>>() else {
            assert!(!path.has_short_blocks());
            continue;
        };
        let unchanged = T::nearest(0.5);
        let mut all = vec![unchanged; rows * N + 32];
        let first = to_next_line(&all) + offset;
        let done = path.chain(&links, &mut lanes, (0, N), &mut all[first..first + rows * N], streamed);
        assert!(done == whole || streamed && done == 0, "{path:?}");
        for (i, &x) in all.iter().enumerate() {
            let within = (first..first + done * N).contains(&i);
            let k = i.wrapping_sub(first);
            let expected = if within { T::nearest(2.0 * b[k].into() - a[k].into()) } else { unchanged };
            assert_eq!(x, expected, "{path:?}, {rows} rows of {N}, number {k}");
        }
    }
}

#[test]
fn chains_compute_whole_groups() {
    for rows in [0, 15, 16, 17, 50] {
        for (offset, streamed) in [(0, false), (3, false), (0, true), (5, true)] {
            chained::<f64, 1>(rows, offset, streamed);
            chained::<f64, 3>(rows, offset, streamed);
            chained::<f64, 4>(rows, offset, streamed);
            chained::<f32, 3>(rows, offset, streamed);
        }
    }
}

/// Links that would read or write past the rows or the lanes, or write the lanes that they read.
#[test]
fn links_that_do_not_fit_are_refused() {
    let rows = [1.0; 3 * GROUP];
    let refused = |from: [Source<f64>; 2], to: usize, groups: usize| {
        let Some(link) = Path::best().link::<Difference, f64, 3, 3, 3, GROUP>(from, to) else { return true };
        !link.fits(groups, 6)
    };
    let (some, first) = (Source::Rows(&rows[..]), Source::Lanes(0));
    for (from, to, groups) in [
        ([some, some], 0, 2),
        ([some, some], 4, 1),
        ([some, first], 2, 1),
        ([Source::Lanes(4), some], 0, 1),
        ([some, Source::Lanes(usize::MAX)], 0, 1),
        ([some, some], usize::MAX, 1),
    ] {
        assert!(refused(from, to, groups));
    }
    assert!(!Path::best().has_short_blocks() || !refused([some, first], 3, 1));
}
