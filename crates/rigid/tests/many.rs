//! Motions in closed form of many bodies in lanes: the bits of single motions, under every law and in every regime.

use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::Inertia;
use polhode_rigid::exact::damped::DampedTop;
use polhode_rigid::exact::free::{FreeBody, FreeMotion};
use polhode_rigid::exact::lagrange::{HeavyTop, LagrangeTop};
use polhode_rigid::exact::larmor::LarmorSphere;
use polhode_rigid::exact::many::{TILE, Tile, Times, at_each};
use polhode_rigid::exact::motion::ExactMotion;

fn start() -> Rotor {
    Rotor::from_components([4.0, -2.0, 1.0, 2.0]).unwrap()
}

fn moments(moments: [f64; 3]) -> Inertia {
    Inertia::from_principal_moments(moments).unwrap()
}

fn free() -> Vec<FreeMotion> {
    let tilted = |k: usize| {
        let x = k as f64 % 91.0 / 64.0;
        FreeMotion::in_principal_axes([1.0, 1.0 + x, 2.0], start(), Bivector([0.25, x, 1.0 - x]))
    };
    (0..TILE + 90).map(tilted).collect()
}

/// Near the unstable axis, on the separatrix, at rest, steady and tumbling; damped, growing and without damping.
fn damped_starts() -> Vec<(Inertia, Rotor, Bivector, f64)> {
    let omegas = [[0.001, 1.0, 0.001], [0.375, 0.5, 0.5], [0.0; 3], [0.0, 0.0, 2.0], [0.25, -0.5, 1.0]];
    let gs = [0.3, -0.01, 0.0, 1e-20, 1e-310, 1e-3];
    let one = |k: usize| (moments([1.0, 2.0, 2.25]), start(), Bivector(omegas[k % 5]), gs[k % 6]);
    (0..TILE + 70).map(one).collect()
}

fn damped() -> Vec<DampedTop> {
    damped_starts().into_iter().map(|(i, r, w, g)| DampedTop::new(&i, r, w, g).unwrap()).collect()
}

/// Tops that precess, sleep, fall from near the upright and along the separatrix, hang, and turn without a torque.
fn heavy_starts() -> Vec<(Inertia, Rotor, Bivector, Vector)> {
    let tilt = |angle: f64| Rotor::exp(Bivector([-0.5 * angle, 0.0, 0.0]));
    let i = moments([1.0, 1.0, 0.5]);
    let up = Rotor::IDENTITY;
    // The next to last tends to the upright: ½ ω² = 2 from below.
    let kinds = [
        (i, tilt(0.5), [0.25, -0.5, 8.0], [0.0, 0.0, 2.0]),
        (i, tilt(1e-4), [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]),
        (i, tilt(1e-200), [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]),
        (i, up, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        (i, up, [0.0, 0.0, 3.0], [0.0, 0.0, 1.0]),
        (i, tilt(1e-9), [0.0, 0.0, 30.0], [0.0, 0.0, 1.0]),
        (i, start(), [0.5, 0.25, 3.0], [0.0, 0.0, 0.0]),
        (i, start(), [0.0, 0.0, 3.0], [0.0, 0.0, 0.0]),
        (i, tilt(3.0), [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        (i, Rotor::from_unit_components([0.0, 1.0, 0.0, 0.0]), [2.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        (moments([1.5, 1.0, 1.0]), start(), [4.0, 0.5, -0.5], [-2.0, 0.0, 0.0]),
    ];
    let one = |k: usize| {
        let (inertia, rotor, omega, c) = &kinds[k % kinds.len()];
        // The multiples of rates and torques by a power of two are other motions of the same regime.
        let unit = 2f64.powi((k / kinds.len() % 7) as i32);
        let (omega, c) = (omega.map(|w| w * unit), c.map(|c| c * unit * unit));
        (*inertia, *rotor, Bivector(omega), Vector(c))
    };
    (0..TILE + 50).map(one).collect()
}

fn heavy() -> Vec<LagrangeTop> {
    heavy_starts().into_iter().map(|(i, r, w, c)| LagrangeTop::new(&i, r, w, c).unwrap()).collect()
}

fn spheres() -> Vec<LarmorSphere> {
    let one = |k: usize| {
        let x = (k % 33) as f64 / 16.0;
        let (omega, b) = ([x, 1.0 - x, 0.25 * x], [0.0, x * x - 1.0, 1.0 - x]);
        LarmorSphere::new(&moments([2.0; 3]), start(), Bivector(omega), Vector(b)).unwrap()
    };
    (0..TILE + 40).map(one).collect()
}

/// Many bodies at many times, from any row to any other, by any number of threads; and one body in lanes of times.
fn check_bits<M: ExactMotion + Copy>(bodies: &[M]) {
    let new = |motions: &[M]| Tile::new(motions.iter().copied().map(Ok::<_, ()>)).unwrap();
    let tiles: Vec<Tile> = bodies.chunks(TILE).map(new).collect();
    for each in [1, 5, 70] {
        // Common times; own ones, twice for all bodies.
        let common: Vec<f64> = (0..each).map(|k| k as f64 * 12.5 - 100.0).collect();
        let own: Vec<f64> = (0..2 * each * bodies.len()).map(|k| k as f64 % 8192.0 * 0.125 - 100.0).collect();
        for (times, list) in [(Times::Common(&common), &common), (Times::Own(&own, each), &own)] {
            let all = list.len().max(bodies.len() * each);
            for (rows, threads) in [(0..all, 1), (0..all, 3), (all / 3..all - 1, 2), (7..7, 2)] {
                let (mut rotors, mut omegas) = (vec![0.0; 4 * rows.len()], vec![0.0; 3 * rows.len()]);
                at_each(Threads::new(threads), &tiles, times, rows.clone(), &mut rotors, &mut omegas);
                for (k, row) in rows.enumerate() {
                    let (body, time) = (row / each % bodies.len(), list[row % list.len()]);
                    let (rotor, omega) = bodies[body].at(time);
                    assert_eq!(rotor.components(), rotors[4 * k..4 * k + 4], "body {body} at {time}");
                    assert_eq!(omega.0, omegas[3 * k..3 * k + 3], "body {body} at {time}");
                }
            }
        }
    }
    let times: Vec<f64> = (0..300).map(|k| 0.37 * f64::from(k) - 40.0).collect();
    for body in &bodies[..40] {
        let (mut rotors, mut omegas) = (vec![0.0; 4 * times.len()], vec![0.0; 3 * times.len()]);
        body.at_many(Threads::new(2), &times, &mut rotors, &mut omegas);
        for (k, &t) in times.iter().enumerate() {
            let (rotor, omega) = body.at(t);
            assert_eq!(rotors[4 * k..4 * k + 4], rotor.components());
            assert_eq!(omegas[3 * k..3 * k + 3], omega.0);
        }
    }
}

#[test]
fn many_bodies_give_the_bits_of_single_ones() {
    check_bits(&free());
    check_bits(&damped());
    check_bits(&heavy());
    check_bits(&spheres());
}

const NUMBER: usize = TILE - 3;

/// A tile of this many motions has the bits of these.
fn same(tile: Tile, alone: &[impl ExactMotion]) {
    let times = [0.0, 3.75, -100.0];
    let (mut rotors, mut omegas) = (vec![0.0; 12 * NUMBER], vec![0.0; 9 * NUMBER]);
    let tiles = [tile];
    at_each(Threads::ONE, &tiles, Times::Common(&times), 0..3 * NUMBER, &mut rotors, &mut omegas);
    for (k, motion) in alone.iter().take(NUMBER).enumerate() {
        assert_eq!(tiles[0].horizons()[k], motion.horizons(), "body {k}");
        for (j, &t) in times.iter().enumerate() {
            let ((rotor, omega), row) = (motion.at(t), 3 * k + j);
            assert_eq!(rotor.components(), rotors[4 * row..4 * row + 4], "body {k} at {t}");
            assert_eq!(omega.0, omegas[3 * row..3 * row + 3], "body {k} at {t}");
        }
    }
}

/// Motions that are set up together, in groups of which the last is not full, have the bits that they have alone.
#[test]
fn motions_set_up_in_lanes_are_those_set_up_alone() {
    let starts = damped_starts().into_iter().take(NUMBER);
    let free = starts.clone().map(|(i, r, w, _)| FreeBody::new(&i, r, w));
    let alone: Vec<FreeMotion> = free.clone().map(|body| body.unwrap().motion()).collect();
    same(Tile::free(free).unwrap(), &alone);
    let bodies = starts.map(|(i, r, w, g)| {
        DampedTop::body(&i, r, w, g).map(|body| (body, g)).map_err(|error| error.to_string())
    });
    same(Tile::damped(bodies).unwrap(), &damped());
    let tops = heavy_starts().into_iter().take(NUMBER);
    let tops = tops.map(|(i, r, w, c)| HeavyTop::new(&i, r, w, c).map_err(|error| error.to_string()));
    same(Tile::lagrange(tops).unwrap(), &heavy());
}

/// A number that varies irregularly with k: 0, or of either sign and of a size down to 10 to a negative power.
fn irregular(k: usize, least: i32) -> f64 {
    let part = (k as f64 * 0.618_033_988_749_894_8).fract();
    let size = 10f64.powf(f64::from(least) * (part * 37.0).fract()) * (0.5 + part);
    if k % 7 == 3 {
        0.0
    } else if k.is_multiple_of(2) {
        size
    } else {
        -size
    }
}

/// The same where all bodies of a group have invariants in the range of floats, and beyond it: in some groups rates and tilts
/// down to 1e-14 and moments that are equal, nearly so or far apart, in others rates down to 1e-40.
#[test]
fn sets_up_by_floats_what_it_sets_up_alone_beyond_their_range() {
    let least = |k: usize| if k / 16 % 3 == 2 { -40 } else { -14 };
    let rates = |k: usize| [0, 1, 2].map(|j| irregular(3 * k + j, least(k)));
    let bodies = (0..NUMBER).map(|k| {
        let x = [0.0, 3.0 * f64::EPSILON, 1e-9, 0.25][k % 4];
        let i = match k % 5 {
            0 => [1.0, 1.0 + x, 1.0],
            1 => [2e-6, 1.0, 1.0 + 1e-6 * x],
            _ => [1.0 + x, 1.5, 1.5 - x],
        };
        FreeBody::new(&moments(i.map(|i| i * 1e20)), start(), Bivector(rates(k).map(|w| w * 1e-30)))
    });
    let alone: Vec<FreeMotion> = bodies.clone().map(|body| body.unwrap().motion()).collect();
    same(Tile::free(bodies).unwrap(), &alone);

    let turned = Rotor::from_components([1.0, 1e-77, -3e-75, 0.0]).unwrap();
    let top = |k: usize| {
        let tilt = [1.0, irregular(k, least(k)), irregular(k + 1, least(k)), 0.25];
        let rotor =
            Rotor::from_components(if k.is_multiple_of(3) { tilt } else { [tilt[1], 1.0, 0.25, tilt[2]] });
        let c = Vector([0.0, 0.0, irregular(k + 2, least(k)) * 1e10]);
        let i = moments([1e4, 1e4, 1e4 * [0.25, 1.0, 1.5][k % 3]]);
        HeavyTop::new(&i, rotor.unwrap(), Bivector(rates(k).map(|w| w * 1e3)), c).unwrap()
    };
    // Tops about axes that are nearly those of the body, and spheres with the centre of mass nearly on an axis.
    let upright = |k: usize| {
        let w = Bivector([0.0, 0.0, 1.0 + k as f64]);
        HeavyTop::new(&moments([1.0, 1.0, 0.5]).rotated(turned), Rotor::IDENTITY, w, Vector([0.0, 0.0, 2.0]))
    };
    let sphere = |k: usize| {
        let (w, c) = (Bivector([0.0, 0.5, 1.0 + k as f64]), Vector([0.5, 1e-170, 2.0]));
        HeavyTop::new(&moments([1.0; 3]), Rotor::IDENTITY, w, c)
    };
    let all = (0..NUMBER)
        .map(top)
        .chain((0..64).map(|k| upright(k).unwrap()))
        .chain((0..64).map(|k| sphere(k).unwrap()));
    let resolved: Vec<HeavyTop> = all.filter(|top| top.motion().is_ok()).collect();
    assert!(resolved.len() > NUMBER + 88, "only {} are resolved", resolved.len());
    for tops in [&resolved[..NUMBER], &resolved[resolved.len() - NUMBER..]] {
        let alone: Vec<LagrangeTop> = tops.iter().map(|top| top.motion().unwrap()).collect();
        same(Tile::lagrange(tops.iter().copied().map(Ok::<_, String>)).unwrap(), &alone);
    }
}

/// Tops in special motions, none of which has a tilt beyond the range of floats.
#[test]
fn sets_up_special_motions_of_tops_by_floats() {
    let kinds = heavy_starts().into_iter().enumerate().filter(|(k, _)| k % 11 != 2).map(|(_, start)| start);
    let tops: Vec<HeavyTop> =
        kinds.cycle().take(NUMBER).map(|(i, r, w, c)| HeavyTop::new(&i, r, w, c).unwrap()).collect();
    let alone: Vec<LagrangeTop> = tops.iter().map(|top| top.motion().unwrap()).collect();
    same(Tile::lagrange(tops.into_iter().map(Ok::<_, String>)).unwrap(), &alone);
}

/// A tile takes the first motions, and reports the first error.
#[test]
fn tiles_report_the_first_error() {
    let body = free()[0];
    let made = |bad: usize| (0..2 * TILE).map(move |k| if k >= bad { Err(k) } else { Ok(body) });
    assert_eq!(Tile::new(made(TILE)).map(|tile| tile.horizons().len()), Ok(TILE));
    assert_eq!(Tile::new(made(17)).map(|_| ()), Err((17, 17)));
}
