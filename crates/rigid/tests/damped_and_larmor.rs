//! The damped body and the sphere in a field: against reference states and conservation laws.

use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::exact::damped::DampedTop;
use polhode_rigid::exact::free::FreeMotion;
use polhode_rigid::exact::larmor::LarmorSphere;
use polhode_rigid::laws::torque::Torque;
use polhode_rigid::run::{Options, Problem};
use polhode_rigid::{Inertia, SimulateError};

const EPS: f64 = f64::EPSILON;

fn start() -> Rotor {
    Rotor::from_components([4.0, -2.0, 1.0, 2.0]).unwrap()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()))
}

fn damped(g: f64) -> DampedTop {
    let inertia = Inertia::from_principal_moments([1.0, 2.0, 3.0]).unwrap();
    DampedTop::new(&inertia, start(), Bivector([0.5, 1.0, 0.25]), g).unwrap()
}

/// A Taylor series of the equations of motion to 40 digits, rounded. The rest is that of the free motion.
#[test]
fn damped_reference() {
    let cases = [
        (
            1.0,
            [0.7484841363798367, -0.654045098366818, -0.09634704891525349, 0.05209369496773225],
            [0.28593030944689196, 0.9443224221519156, 0.10500967085374024],
        ),
        (
            10.0,
            [-0.46506138998930496, 0.7129215929607061, -0.5065578542511573, -0.13733115497966294],
            [0.2718201672536549, 0.1694698939460003, -0.15138900324639526],
        ),
        (
            40.0,
            [0.49031013862301404, 0.8304344340703992, 0.24740771212170742, -0.09361646573311232],
            [0.005588076891978127, -0.0050520598623181555, -0.003076204790566054],
        ),
    ];
    for (t, rotor, omega) in cases {
        let (r, w) = damped(0.125).at(t);
        assert!(apart(&r.components(), &rotor) <= 8.0 * EPS);
        assert!(apart(&w.0, &omega) <= 8.0 * EPS * w.norm());
    }
}

/// `e^{gt} L` in space is constant, for either sign of g and t, from no motion left to e^{600} times as much.
#[test]
fn damped_momentum() {
    let inertia = Inertia::from_principal_moments([1.0, 2.0, 3.0]).unwrap();
    for g in [0.125, -0.125, 1e-9, 3.0] {
        let top = damped(g);
        let momentum = |t: f64| {
            let (r, w) = top.at(t);
            r.apply_bivector(inertia.apply(w))
        };
        let first = momentum(0.0);
        for t in [0.25, 1.0, 7.0, 100.0, -0.25, -1.0, -7.0] {
            let scaled = momentum(t) * (g * t).exp();
            // The exponential of a rounded product is off by its rounding.
            let bound = (32.0 + (g * t).abs()) * EPS * first.norm();
            assert!((scaled - first).norm() <= bound, "{g} {t}");
        }
    }
}

/// Weak damping for a long time: the phase is accurate beyond the rounding of τ.
#[test]
fn damped_phase() {
    let g = 1e-6;
    let inertia = Inertia::from_principal_moments([2.0, 2.0, 2.0]).unwrap();
    let top = DampedTop::new(&inertia, Rotor::IDENTITY, Bivector([0.0, 0.0, 1.0]), g).unwrap();
    // cos and sin of half of τ = (1 − e^{−gt})/g, to 40 digits for the g that 1e-6 is in floating point.
    let (r, _) = top.at(1e6);
    let [s, _, _, z] = r.components();
    assert!((s - -0.9392011885242678).abs() <= 4.0 * EPS && (z + -0.3433673360624197).abs() <= 4.0 * EPS);
}

#[test]
fn damped_limits() {
    // No damping.
    let (free, top) = (damped(0.0), damped(1e-30));
    for t in [-3.0, 0.0, 5.0, 1e6] {
        assert!(apart(&free.at(t).0.components(), &top.at(t).0.components()) <= 8.0 * EPS);
    }
    // All but at rest: the attitude is that at τ = 1/g.
    let top = damped(0.125);
    assert_eq!(top.horizons()[1], f64::INFINITY);
    let (last, still) = top.at(1e300);
    let inertia = Inertia::from_principal_moments([1.0, 2.0, 3.0]).unwrap();
    let free = FreeMotion::new(&inertia, start(), Bivector([0.5, 1.0, 0.25])).unwrap();
    assert!(apart(&last.components(), &free.at(8.0).0.components()) <= 8.0 * EPS);
    assert!(still.norm() < 1e-300);
    assert!(top.horizons()[0] < 6000.0);
    let bad = DampedTop::new(&inertia, start(), Bivector([1.0, 0.0, 0.0]), f64::NAN);
    assert!(matches!(bad, Err(SimulateError::BadValue { what: "the damping g", .. })));
}

/// The phase is that of the free body at `τ = (1 − e^{−gt})/g`, so it is accurate while |τ| is within the free body's horizon
/// T: for `t` from `−ln(1 + gT)/g` to `−ln(1 − gT)/g`, and forever if g T > 1.
#[test]
fn damped_horizons() {
    let [past, most] = damped(0.0).horizons();
    assert!(past == most && most.is_finite());
    for part in [1e-6, 0.5, 0.999] {
        let g = part / most;
        let expected = [part.ln_1p() / g, -(-part).ln_1p() / g];
        let reversed = [expected[1], expected[0]];
        for (found, expected) in [(damped(g).horizons(), expected), (damped(-g).horizons(), reversed)] {
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found / expected - 1.0).abs() <= 1e-12, "{part} {found:e} {expected:e}");
            }
        }
    }
    assert_eq!(damped(1.5 / most).horizons()[1], f64::INFINITY);
    assert_eq!(damped(-1.5 / most).horizons()[0], f64::INFINITY);
}

fn sphere() -> LarmorSphere {
    let inertia = Inertia::from_principal_moments([2.0; 3]).unwrap();
    LarmorSphere::new(&inertia, start(), Bivector([0.5, 1.0, 0.25]), Vector([0.125, 0.5, 1.0])).unwrap()
}

#[test]
fn states_of_the_sphere_at_many_times_are_those_at_each() {
    let times: Vec<f64> = (-20..20).map(|k| 0.7 * f64::from(k)).collect();
    let (mut rotors, mut omegas) = (vec![0.0; 4 * times.len()], vec![0.0; 3 * times.len()]);
    sphere().at_many(Threads::new(2), &times, &mut rotors, &mut omegas);
    for (k, &t) in times.iter().enumerate() {
        let (rotor, omega) = sphere().at(t);
        assert_eq!(
            (&rotors[4 * k..4 * k + 4], &omegas[3 * k..3 * k + 3]),
            (&rotor.components()[..], &omega.0[..])
        );
    }
}

#[test]
fn larmor_reference() {
    let cases = [
        (
            1.0,
            [0.8206870715504845, -0.5647347837522221, -0.0008816350785613962, -0.08687103849850814],
            [-0.11657609079074494, 0.9570767164872738, 0.6188005929327206],
        ),
        (
            10.0,
            [-0.06364802068058288, 0.29059112298879447, 0.8116595647290051, 0.5027071510208277],
            [-0.17882436894410988, 0.9731462587550634, 0.5775016918960186],
        ),
        (
            40.0,
            [0.7003554775379395, -0.5139569039244042, -0.29682247107091525, -0.39654372603585747],
            [-0.3107881868279029, 1.0373792857783335, 0.3738380937869482],
        ),
    ];
    for (t, rotor, omega) in cases {
        let (r, w) = sphere().at(t);
        assert!(apart(&r.components(), &rotor) <= 4.0 * EPS);
        assert!(apart(&w.0, &omega) <= 4.0 * EPS);
    }
}

/// Rates of any size, whose squares overflow or vanish: the same motion in another unit of time.
#[test]
fn larmor_scales() {
    let inertia = Inertia::from_principal_moments([2.0; 3]).unwrap();
    let scaled = |x: f64| {
        let (omega, b) = (Bivector([0.5 * x, x, 0.25 * x]), Vector([0.125 * x, 0.5 * x, x]));
        LarmorSphere::new(&inertia, start(), omega, b).unwrap()
    };
    for exponent in [-990, -600, -500, 500] {
        let unit = 2f64.powi(exponent);
        for t in [1.0, 40.0, 1e9] {
            let ((r, w), (expected, spin)) = (scaled(unit).at(t / unit), sphere().at(t));
            assert!(apart(&r.components(), &expected.components()) <= 4.0 * EPS, "{exponent} {t}");
            assert!(apart(&(w / unit).0, &spin.0) <= 4.0 * EPS, "{exponent} {t}");
        }
    }
}

/// At 1.7e8 s to a few roundings, for a sphere in turned axes too; by quaternions of 60 digits.
#[test]
fn larmor_at_long_times() {
    let turn = Rotor::from_components([3.0, 1.0, -2.0, 0.5]).unwrap();
    let plain = Inertia::from_principal_moments([2.0; 3]).unwrap();
    let matrix = [[2.0, 2e-16, -1e-16], [2e-16, 2.0 + 4.0 * EPS, 3e-16], [-1e-16, 3e-16, 2.0]];
    for inertia in [plain, plain.rotated(turn), Inertia::from_matrix(matrix).unwrap()] {
        assert_eq!(inertia.principal_frame(), Rotor::IDENTITY);
        let (omega, b) = (Bivector([0.5, 1.0, 0.25]), Vector([0.125, 0.5, 1.0]));
        let problem = Problem::new(&inertia, start(), omega, &[Torque::Larmor(b)]);
        let motion = problem.simulate(&[1.7e8], Options::default(), &mut |_| true).unwrap();
        let states = motion.states();
        let rotor = [-0.7354205155713058, 0.4749581112791768, 0.46161525647353346, 0.1431181777337376];
        let rate = [0.32690529109327066, 0.926850106909191, 0.5887119923847697];
        assert!(apart(&states.rotors[0].components(), &rotor) <= 4.0 * EPS);
        assert!(apart(&states.omegas[0].0, &rate) <= 4.0 * EPS);
    }
}

/// Moments that differ by rounding count as equal; the certificate reports the neglected angle, and a tolerance below
/// it leads to steps.
#[test]
fn a_neglected_difference_of_moments_is_an_error_estimate() {
    let inertia = Inertia::from_principal_moments([2.0, 2.0, 2.0 * (1.0 + 4.0 * EPS)]).unwrap();
    let (omega, b) = (Bivector([0.5, 1.0, 0.25]), Vector([0.125, 0.5, 1.0]));
    let problem = Problem::new(&inertia, start(), omega, &[Torque::Larmor(b)]);
    let run = |rtol: Option<f64>, t: f64| {
        let options = Options { rtol, ..Options::default() };
        problem.simulate(&[t], options, &mut |_| true).unwrap().certificate
    };
    let long = run(None, 1e8);
    let neglected = 4.0 * EPS * omega.norm() * 1e8;
    assert_eq!(long.method, "exact");
    assert!(long.error_estimate.is_some_and(|x| x > 0.9 * neglected && x < 4.0 * neglected));
    assert_eq!(run(Some(1e-12), 1.0).method, "exact");
    // Steps may be refused too, but what is neglected is not returned as if it were less.
    let strict = Options { rtol: Some(3e-15), ..Options::default() };
    let stepped = problem.simulate(&[4.0], strict, &mut |_| true);
    assert!(stepped.map_or(true, |motion| motion.certificate.method != "exact"));
    let even = Inertia::from_principal_moments([2.0; 3]).unwrap();
    let problem = Problem::new(&even, start(), omega, &[Torque::Larmor(b)]);
    let motion = problem.simulate(&[1e8], Options::default(), &mut |_| true).unwrap();
    assert_eq!(motion.certificate.error_estimate, None);
}

/// `Ω_S·b` and |Ω| are constant at any time, and `R' = −½ R Ω_B`.
#[test]
fn larmor_laws() {
    let b = Vector([0.125, 0.5, 1.0]).undual();
    let along = |t: f64| {
        let (r, w) = sphere().at(t);
        (r.apply_bivector(w).dot(b), w.norm())
    };
    let first = along(0.0);
    for t in [0.3, -17.0, 1e6, 1e12, -1e15] {
        let now = along(t);
        assert!((now.0 - first.0).abs() <= 16.0 * EPS && (now.1 - first.1).abs() <= 8.0 * EPS, "{t}");
    }
    let h = 2f64.powi(-9);
    for t in [-3.0, 0.0, 0.7, 12.0] {
        let at = |k: f64| sphere().at(t + k * h).0.components();
        let (r, w) = sphere().at(t);
        let [x, y, z] = w.0;
        let spin = [0.0, x, y, z];
        let rate = product(r.components(), spin).map(|x| -0.5 * x);
        let (a, b, c, d) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
        let slope: [f64; 4] = std::array::from_fn(|k| (8.0 * (a[k] - b[k]) - (c[k] - d[k])) / (12.0 * h));
        // Truncation h⁴ |R⁽⁵⁾|/30 with rates up to 3/2, rounding over h.
        assert!(apart(&slope, &rate) <= h.powi(4) * 8.0 / 30.0 + 8.0 * EPS / h);
    }
}

/// Of rotor components.
fn product(p: [f64; 4], q: [f64; 4]) -> [f64; 4] {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] - p[2] * q[3] + p[3] * q[2],
        p[0] * q[2] + p[1] * q[3] + p[2] * q[0] - p[3] * q[1],
        p[0] * q[3] - p[1] * q[2] + p[2] * q[1] + p[3] * q[0],
    ]
}

#[test]
fn larmor_limits() {
    let inertia = Inertia::from_principal_moments([2.0; 3]).unwrap();
    let omega = Bivector([0.5, 1.0, 0.25]);
    let free = FreeMotion::new(&inertia, start(), omega).unwrap();
    let none = LarmorSphere::new(&inertia, start(), omega, Vector::default()).unwrap();
    for t in [-2.0, 0.0, 9.0, 1e9] {
        assert!(apart(&none.at(t).0.components(), &free.at(t).0.components()) <= 8.0 * EPS);
    }
    // At rest nothing acts: the two turns are opposite.
    let rest = LarmorSphere::new(&inertia, start(), Bivector::default(), Vector([1.0, 2.0, 3.0])).unwrap();
    assert!(apart(&rest.at(1e9).0.components(), &start().components()) <= 4.0 * EPS);
    let other = Inertia::from_principal_moments([2.0, 2.0, 2.5]).unwrap();
    let error = LarmorSphere::new(&other, start(), omega, Vector::default()).unwrap_err();
    assert!(error.to_string().contains("not a sphere"), "{error}");
}
