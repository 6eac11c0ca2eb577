use super::*;
use crate::simd::double::{sin_cos, two_product};

/// Sine, and square with its rounding error.
struct Sample;

impl Curve<1, 2> for Sample {
    #[inline(always)]
    fn values<const W: usize, const FMA: bool>(&self, x: &[f64; W]) -> ([[f64; W]; 1], [[f64; W]; 2]) {
        let (mut sin, mut square) = ([[0.0; W]], [[0.0; W]; 2]);
        for l in 0..W {
            let (hi, lo) = sin_cos::<FMA>(1, x[l], 0.0).0;
            sin[0][l] = hi + lo;
            (square[0][l], square[1][l]) = two_product::<FMA>(x[l], x[l]);
        }
        (sin, square)
    }
}

/// Its multiples by numbers of one curve or of one for each lane.
struct Multiples<const C: usize>([f64; C]);

impl<const C: usize> Curve<1, 2> for Multiples<C> {
    #[inline(always)]
    fn values<const W: usize, const FMA: bool>(&self, x: &[f64; W]) -> ([[f64; W]; 1], [[f64; W]; 2]) {
        let (mut first, mut second) = Sample.values::<W, FMA>(x);
        for l in 0..W {
            let factor = self.0[if C == 1 { 0 } else { l }];
            first[0][l] *= factor;
            second[0][l] *= factor;
            second[1][l] *= factor;
        }
        (first, second)
    }
}

#[test]
fn curves_side_by_side_give_the_same_bits() {
    let factors: [f64; TOGETHER] = std::array::from_fn(|l| 0.3 * l as f64 - 1.7);
    let arguments = factors.map(|x| 0.1 * x);
    for path in Path::available() {
        let (mut a, mut b) = ([[0.5]; TOGETHER], [[0.5; 2]; TOGETHER]);
        let (first, second) = (a.as_flattened_mut(), b.as_flattened_mut());
        blocks::<TOGETHER, 1, 2>(path, &Multiples(factors), &arguments, first, second);
        for l in 0..TOGETHER {
            assert_eq!((a[l], b[l]), value(&Multiples([factors[l]]), arguments[l]), "{path:?}");
        }
    }
}

#[test]
fn every_path_gives_the_same_bits() {
    let arguments: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.003_7 - 0.37).collect();
    for path in Path::available() {
        for count in [0, 1, 15, 16, 17, 63, 64, 65, 80, 81, 200] {
            let (mut a, mut b) = (vec![0.5; count], vec![0.5; 2 * count]);
            piece(path, &Sample, &arguments[..count], &mut a, &mut b);
            for (i, &x) in arguments[..count].iter().enumerate() {
                assert_eq!(([a[i]], [b[2 * i], b[2 * i + 1]]), value(&Sample, x), "{path:?}");
            }
        }
    }
    let many: Vec<f64> = arguments.iter().cycle().take(3 * SHARED).copied().collect();
    let (mut a, mut b) = (vec![0.0; many.len()], vec![0.0; 2 * many.len()]);
    sample(&Sample, Threads::new(3), &many, &mut a, &mut b);
    assert!(many.iter().enumerate().all(|(i, &x)| [a[i]] == value(&Sample, x).0));
}
