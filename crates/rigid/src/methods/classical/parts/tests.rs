use super::*;
use crate::laws::torque::lanes::in_lanes;
use crate::methods::classical::step;
use crate::state::phase::Gyrostat;
use polhode_ga::Bivector;

/// A torque of attitude, angular velocity and time.
struct Driven;

impl<const W: usize, const F: bool> Forcing<W, F> for Driven {
    const ACTS: bool = true;

    fn torque(&mut self, at: &Place<W, F>, _: &[Lanes<W, F>; 6]) -> [Lanes<W, F>; 3] {
        let time = Lanes(at.time.all());
        std::array::from_fn(|k| at.rotor[k + 1].times_plus(time, at.omega[k]) * Lanes::all(0.1))
    }
}

fn same_bits_as_whole_steps<const W: usize, const F: bool>() {
    let share = |l: usize| (l + 1) as f64 / W as f64;
    let body =
        |l: usize| Gyrostat { moments: [1.0 + share(l), 2.0, 2.5], wheel: Bivector([0.1, share(l), -0.2]) };
    let bodies = Bodies::<W, F>::new(std::array::from_fn(|l| (body(l), 0.01 * share(l))));
    let mut whole: State<7, W, F> = in_lanes(|l| [0.6, 0.0, 0.8 * share(l), 0.1, 0.3, share(l), -0.5]);
    let mut parts = Parts::new(&bodies, &whole);
    for k in 0..5 {
        let (time, length) = (0.1 * f64::from(k), [0.1, 0.1 / 6.0]);
        step(&bodies, &mut Driven, &mut whole, time, length);
        parts.step(&mut Driven, time, length);
        let bits = |state: &State<7, W, F>| state.map(|lanes| lanes.0.map(f64::to_bits));
        assert_eq!(bits(parts.state()), bits(&whole), "{W} bodies, step {k}");
    }
}

#[test]
fn parts_have_the_bits_of_whole_steps() {
    same_bits_as_whole_steps::<8, false>();
    same_bits_as_whole_steps::<32, false>();
    same_bits_as_whole_steps::<32, true>();
}

/// A register of the widest instructions is in one cache line.
#[test]
fn parts_begin_at_cache_lines() {
    let bodies =
        Bodies::<32, false>::new([(Gyrostat { moments: [1.0; 3], wheel: Bivector::default() }, 0.0); 32]);
    let parts = Parts::new(&bodies, &[Lanes::ZERO; 7]);
    let places = [&parts.bodies.inverse, &parts.torque, &parts.at.omega].map(|lanes| lanes.as_ptr().addr());
    let places = places.into_iter().chain([parts.state.as_ptr().addr(), parts.sum.as_ptr().addr()]);
    assert!(places.into_iter().all(|place| place.is_multiple_of(64)));
}
