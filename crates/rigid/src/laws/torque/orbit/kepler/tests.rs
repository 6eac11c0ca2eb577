use super::*;
use polhode_ga::simd::lanes::{Work, fastest};

/// In units of the distance.
fn error([x, y, r]: [f64; 3], exact: [f64; 3]) -> f64 {
    (x - exact[0]).hypot(y - exact[1]).max((r - exact[2]).abs()) / exact[2]
}

/// The start and the steps after it where nothing but them is wrong: for a chosen E the mean anomaly is `(1−e) E + e (E − sin E)`,
/// rounded, which moves E by no more.
#[test]
fn positions_are_those_of_the_eccentric_anomaly() {
    let mut worst = [0.0_f64; 2];
    for i in 0..200 {
        let e = if i < 100 { 1.0 - 0.7_f64.powi(i) } else { 0.01 * f64::from(i - 100) };
        let one = Elements::one(1.0, e, 0.0);
        for k in 0..400 {
            let anomaly = if k < 200 { PI * 0.8_f64.powi(k) } else { PI * f64::from(k - 199) / 201.0 };
            let (less_its_sine, v) = small_differences(anomaly);
            let mean = (1.0 - e) * anomaly + e * less_its_sine;
            let start = markley(mean, e, one.slope[0]);
            worst[0] = worst[0].max((start / anomaly - 1.0).abs());
            let exact = [(1.0 - e) - v, one.side[0] * anomaly.sin(), (1.0 - e) + e * v];
            let [[x], [y], [r]] = one.positions::<false>(&[mean]);
            worst[1] = worst[1].max(error([x, y, r], exact));
        }
    }
    assert!(worst[0] < 3.2e-4, "start: {}", worst[0]);
    assert!(worst[1] < 8.0 * f64::EPSILON, "{} roundings", worst[1] / f64::EPSILON);
}

/// The eccentricity, M at time 0, a time at n = 1, and the position: to 50 digits by mpmath, rounded.
#[test]
fn positions_are_those_of_high_precision() {
    const TABLE: [(f64, f64, f64, [f64; 3]); 21] = [
        (0.0, 0.3, 0.0, [0.955_336_489_125_606, 0.295_520_206_661_339_55, 1.0]),
        (0.0, -3.0, 1e9 + 0.1, [-0.682_960_703_667_602_2, -0.730_455_116_516_992_8, 1.0]),
        (1e-9, 1.0, 0.0, [0.540_302_304_160_066_3, 0.841_470_985_262_545_3, 0.999_999_999_459_697_6]),
        (0.1, -1e-300, 0.0, [0.9, -1.105_541_596_785_133_3e-300, 0.9]),
        (0.1, 2.0, 12_345.678, [0.152_402_854_464_038_65, 0.962_771_972_518_841_7, 0.974_759_714_553_596_1]),
        (0.5, 1e-9, 0.0, [0.5, 1.732_050_807_568_877_4e-9, 0.5]),
        (0.5, 0.7, -1e12, [-0.765_637_334_254_247_8, 0.834_911_734_848_494_5, 1.132_818_667_127_123_9]),
        (0.9, 3.0, 0.0, [-1.897_222_051_405_426_8, 0.032_467_741_471_235_53, 1.897_499_846_264_884]),
        (0.9, 0.3, 1e6, [0.002_665_124_784_168_559, -0.187_582_455_935_229_85, 0.187_601_387_694_248_25]),
        (
            0.99,
            0.0001,
            0.0,
            [0.009_950_164_466_933_309, 0.001_408_334_048_727_637_2, 0.010_049_337_177_736_041],
        ),
        (0.99, -2.0, 0.0, [-1.820_697_835_474_779_6, -0.078_535_520_703_287_95, 1.822_390_857_120_031_8]),
        (
            0.999_999,
            1e-9,
            0.0,
            [6.087_217_306_122_204e-7, 1.251_044_359_308_411e-6, 1.391_277_878_167_021_5e-6],
        ),
        (
            0.999_999,
            0.01,
            0.0,
            [-0.076_038_847_880_745_7, 0.000_540_920_630_316_782_7, 0.076_040_771_840_897_89],
        ),
        (
            0.999_999,
            1.5,
            77.25,
            [-1.994_471_755_425_173_2, -0.000_148_485_239_706_922_27, 1.994_471_760_952_417_8],
        ),
        (
            0.999_999_999_999,
            1e-15,
            0.0,
            [-1.621_025_100_641_825_2e-10, 2.554_203_436_075_447_5e-11, 1.641_024_658_205_791_7e-10],
        ),
        (
            0.999_999_999_999,
            0.0001,
            0.0,
            [-0.003_555_627_959_580_132_4, 1.191_507_985_489_232_2e-7, 0.003_555_627_961_576_533],
        ),
        (
            0.999_999_999_999,
            3.0,
            0.0,
            [-1.997_492_892_369_466_6, 1.000_781_583_201_840_7e-7, 1.997_492_892_369_469],
        ),
        (
            0.999_999_999_999_999_9,
            1e-20,
            0.0,
            [-7.629_803_733_555_474e-14, 5.825_155_699_209_43e-15, 7.652_008_194_047_976e-14],
        ),
        (
            0.999_999_999_999_999_9,
            0.4,
            0.0,
            [-0.812_602_346_210_060_1, 1.463_717_421_469_019_7e-8, 0.812_602_346_210_060_2],
        ),
        (0.7, 3.125, 0.0, [-1.699_952_367_202_868, 0.006_970_243_607_217_296, 1.699_966_657_042_007_8]),
        (0.3, 6.5, 1e15, [-1.104_054_343_139_596_4, 0.567_170_096_252_703_2, 1.241_216_302_941_878_8]),
    ];
    for (e, anomaly, time, exact) in TABLE {
        let [[x], [y], [r]] = Elements::one(1.0, e, anomaly).positions::<false>(&[time]);
        let error = error([x, y, r], exact);
        assert!(error <= 6.0 * f64::EPSILON, "e = {e}, M = {anomaly} + {time}: {x} {y} {r}, {exact:?}");
    }
}

#[test]
fn the_small_differences_keep_their_digits() {
    // x − sin x and 1 − cos x at x = 1e-3, 1 and π, to 20 digits.
    for (x, exact) in [
        (1e-3, [1.666_666_583_333_335_3e-10, 4.999_999_583_333_347e-7]),
        (1.0, [0.158_529_015_192_103_5, 0.459_697_694_131_860_26]),
        (PI, [PI, 2.0]),
    ] {
        let (sine, cosine) = small_differences(x);
        assert!((sine / exact[0] - 1.0).abs() <= 4.0 * f64::EPSILON, "{x}: {sine}");
        assert!((cosine / exact[1] - 1.0).abs() <= 4.0 * f64::EPSILON, "{x}: {cosine}");
    }
}

#[test]
fn the_cube_root_is_good_enough_for_the_start() {
    for i in 0..30_000 {
        let x = 1e-45 * 1.01_f64.powi(i % 12_000) * (1.0 + 1e-6 * f64::from(i));
        let error = reciprocal_cube_root(x) * x.cbrt() - 1.0;
        assert!(error.abs() < 3e-5, "{x}: {error}");
    }
}

struct Places<'a>(&'a Elements<8>, [f64; 8]);

impl Work for Places<'_> {
    type Output = [[f64; 8]; 3];

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> [[f64; 8]; 3] {
        self.0.places::<FUSED>(&self.1)
    }
}

/// Circles, ellipses, and both together; a time that is not finite spoils its lane alone.
#[test]
fn lanes_have_the_bits_of_single_orbits() {
    for some in [0.0, 0.3, 0.95] {
        for others in [0.0, 0.6] {
            let of = |l: usize| {
                let e = if l.is_multiple_of(2) { some } else { others };
                Elements::one(0.1 + 0.01 * l as f64, e, 0.7 * l as f64)
            };
            let each: [Elements<1>; 8] = std::array::from_fn(of);
            let all = Elements::new(each.each_ref());
            for t in 0..100 {
                let times: [f64; 8] = std::array::from_fn(|l| 1.7f64.powi(t % 50) * (1.0 - 0.3 * l as f64));
                let mut spoiled = times;
                spoiled[3] = f64::INFINITY;
                let places = fastest(Places(&all, spoiled));
                for l in 0..8 {
                    let single = each[l].places::<false>(&[times[l]]);
                    for k in 0..2 {
                        let same = places[k][l].to_bits() == single[k][0].to_bits();
                        assert!(if l == 3 { places[k][l].is_nan() } else { same }, "{l} {k} at {}", times[l]);
                    }
                }
            }
        }
    }
}

/// Many turns only cost digits.
#[test]
fn directions_are_unit_at_any_time() {
    for e in [0.0, 0.4] {
        let one = Elements::one(0.3, e, 1.0);
        for t in [1e15, -1e18, 1e30, 1e100] {
            let [[x], [y], _] = one.places::<false>(&[t]);
            assert!((x.hypot(y) - 1.0).abs() < 1e-12, "{t}: {x} {y}");
        }
    }
}
