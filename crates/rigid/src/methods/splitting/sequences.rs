//! Coefficients of symmetric splittings.

/// The sequence of kicks and free motions of a symmetric splitting.
#[derive(Debug)]
pub struct Sequence {
    /// Its name.
    pub name: &'static str,
    /// Its order of convergence.
    pub order: i32,
    coefficients: Coefficients,
}

#[derive(Debug)]
enum Coefficients {
    /// A composition `S(γ_1 h) … S(γ_s h)` of the second-order step: γ_1 … up to the middle one; the others mirror them.
    Composition(&'static [f64]),
    /// Kicks `b_i` and exact free drifts `a_i` in turn, kicks first and last: b_1 … and a_1 … up to the last before the
    /// middle is passed. Of its order because the kinetic energy is quadratic in the momentum, so that the commutator
    /// `[V, [V, [V, T]]]` is zero (Runge, Kutta, Nyström).
    Nystrom { kicks: &'static [f64], drifts: &'static [f64] },
}

const fn composition(name: &'static str, order: i32, half: &'static [f64]) -> Sequence {
    Sequence { name, order, coefficients: Coefficients::Composition(half) }
}

/// Every composition, in ascending order.
///
/// Coefficients: H. Yoshida, Phys. Lett. A 150 (1990) 262 (of order 6 his solution A); W. Kahan & R.-C. Li, Math.
/// Comp. 66 (1997) 1089, as printed in Hairer, Lubich & Wanner, *Geometric Numerical Integration*, V.3.
pub static COMPOSITIONS: [Sequence; 5] = [
    composition("strang", 2, &[1.0]),
    composition("yoshida4", 4, &[1.351_207_191_959_657_6, -1.702_414_383_919_315_3]),
    composition(
        "yoshida6",
        6,
        &[0.784_513_610_477_557_3, 0.235_573_213_359_358_13, -1.177_679_984_178_871, 1.315_186_320_683_911_2],
    ),
    composition(
        "kahan_li6",
        6,
        &[
            0.392_161_444_007_314_1,
            0.332_599_136_789_359_44,
            -0.706_246_172_557_639_4,
            0.082_213_596_293_550_8,
            0.798_543_990_934_829_9,
        ],
    ),
    composition(
        "kahan_li8",
        8,
        &[
            0.130_202_483_088_890_08,
            0.561_162_981_775_108_4,
            -0.389_474_962_644_847_3,
            0.158_841_906_555_155_6,
            -0.395_903_894_133_237_6,
            0.184_539_640_978_315_7,
            0.258_374_387_686_322_04,
            0.295_011_723_609_310_3,
            -0.605_508_533_830_034_5,
        ],
    ),
];

/// S. Blanes & P. C. Moan, J. Comput. Appl. Math. 142 (2002) 313, SRKN with 11 stages: their 15 digits, moved by less than
/// 1e-15 to the nearest solution of the order conditions.
pub static RKN6: Sequence = Sequence {
    name: "rkn6",
    order: 6,
    coefficients: Coefficients::Nystrom {
        kicks: &[
            0.041_464_998_518_262_84,
            0.198_128_671_918_066_55,
            -0.040_006_192_104_152_69,
            0.075_253_984_301_580_34,
            -0.011_511_387_420_687_77,
        ],
        drifts: &[
            0.123_229_775_946_271_14,
            0.290_553_797_799_558_26,
            -0.127_049_212_625_416_9,
            -0.246_331_761_062_075_4,
            0.357_208_872_795_927_7,
        ],
    },
};

/// Each is one static.
impl PartialEq for Sequence {
    fn eq(&self, other: &Sequence) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Sequence {
    /// Whether its free motions are exact.
    pub(crate) fn is_nystrom(&self) -> bool {
        matches!(self.coefficients, Coefficients::Nystrom { .. })
    }

    /// Kicks and drifts in turn, as fractions of a step, and the kick after the last.
    pub(crate) fn stages(&self) -> (Vec<(f64, f64)>, f64) {
        match self.coefficients {
            Coefficients::Composition(half) => {
                // Adjacent half kicks are merged.
                let mut kick = 0.0;
                let stage = |gamma: &f64| (std::mem::replace(&mut kick, 0.5 * gamma) + 0.5 * gamma, *gamma);
                (half.iter().chain(half.iter().rev().skip(1)).map(stage).collect(), kick)
            }
            Coefficients::Nystrom { kicks, drifts } => {
                // The middle coefficients complete the sums to 1.
                let kick = 0.5 - kicks.iter().sum::<f64>();
                let drift = 1.0 - 2.0 * drifts.iter().sum::<f64>();
                let last = 2 * kicks.len();
                let stage = |i: usize| {
                    let kick = kicks.get(i.min(last + 1 - i)).unwrap_or(&kick);
                    (*kick, *drifts.get(i.min(last - i)).unwrap_or(&drift))
                };
                ((0..=last).map(stage).collect(), kicks[0])
            }
        }
    }
}

#[cfg(test)]
mod tests;
