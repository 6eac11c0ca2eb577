//! The constant factors of the three functions of a heavy top, one top in each lane.

use super::flow::Flow;
use super::nutations::Nutations;
use super::series::Series;
use crate::numerics::lanes::hypotenuse;

impl<const W: usize> Nutations<W> {
    /// The constants A, B and C: their sizes from the bounds, their phases from the two of α, β and w that are relatively
    /// largest at the start.
    #[inline(always)]
    pub fn factors<S: Series<W>, const FMA: bool>(&self, flow: &Flow<S, W>) -> [[[f64; W]; 2]; 3] {
        let upper = flow.series.state::<W, FMA>(&[0.25; W], &[0.0; W]);
        let lower = flow.series.state::<W, FMA>(&[0.0; W], &[0.0; W]);
        let now = flow.turned::<W, FMA>(&[0.0; W]);
        let (mut units, mut shares, mut factors) = ([[[0.0; W]; 2]; 3], [[0.0; W]; 3], [[[0.0; W]; 2]; 3]);
        for k in 0..3 {
            let bound = if k == 0 { &upper } else { &lower };
            for l in 0..W {
                let (at_start, now) = (at(&self.state[k], l), at(&now.z[k], l));
                let unit = normalized(times(at_start, normalized(conjugate(now))));
                (units[k][0][l], units[k][1][l]) = (unit[0], unit[1]);
                // One that is always 0 is the smallest.
                let largest = self.sizes[k][l];
                shares[k][l] = if largest > 0.0 { size(at_start) / largest } else { -1.0 };
                factors[k][0][l] = largest * bound.denominator[l] / size(at(&bound.z[k], l));
            }
        }
        for l in 0..W {
            let [alpha, beta, across] = [at(&units[0], l), at(&units[1], l), at(&units[2], l)];
            let relation = at(&self.relations, l);
            // C = −iκ A* B at v = 0.
            let alpha_by_others = times(times(conjugate(across), beta), relation);
            let beta_by_others = times(times(across, alpha), conjugate(relation));
            let across_by_others = times(times(conjugate(alpha), beta), relation);
            let [a, b, c] = [shares[0][l], shares[1][l], shares[2][l]];
            let first = (a <= b) & (a <= c);
            let (second, third) = (!first & (b <= c), !first & (b > c));
            for part in 0..2 {
                units[0][part][l] = if first { alpha_by_others[part] } else { alpha[part] };
                units[1][part][l] = if second { beta_by_others[part] } else { beta[part] };
                units[2][part][l] = if third { across_by_others[part] } else { across[part] };
            }
        }
        for k in 0..3 {
            for l in 0..W {
                let factor = factors[k][0][l];
                (factors[k][0][l], factors[k][1][l]) = (units[k][0][l] * factor, units[k][1][l] * factor);
            }
        }
        factors
    }
}

/// The complex number of lane l.
#[inline(always)]
fn at<const W: usize>([re, im]: &[[f64; W]; 2], l: usize) -> [f64; 2] {
    [re[l], im[l]]
}

/// The product of complex numbers.
#[inline(always)]
fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

#[inline(always)]
fn conjugate([x, y]: [f64; 2]) -> [f64; 2] {
    [x, -y]
}

#[inline(always)]
fn size([x, y]: [f64; 2]) -> f64 {
    hypotenuse(x, y)
}

#[inline(always)]
fn normalized(z: [f64; 2]) -> [f64; 2] {
    let size = size(z);
    if size > 0.0 { [z[0] / size, z[1] / size] } else { [1.0, 0.0] }
}
