use super::*;

fn ellipse(body: usize) -> Orbit {
    let part = body as f64;
    Orbit::new(0.1 + 0.01 * part, 0.05 * part, 0.3 * part).unwrap()
}

fn assert_there(orbits: &mut Orbits<8>, each: &[Orbit; 8], time: PerLane<8>) {
    let one = Lanes::all(1.0);
    let rotor = [one, Lanes::ZERO, Lanes::ZERO, Lanes::ZERO];
    let at = Place::<8, false> { rotor, omega: [Lanes::ZERO; 3], time: time.clone() };
    orbits.torque(&[one; 3], &at);
    for l in 0..8 {
        let (u, nearness) = each[l].place(time.of(l));
        let strength = 3.0 * each[l].rate() * each[l].rate() * nearness;
        let found = [0, 1, 2].map(|k| orbits.places[k][l]);
        assert_eq!(found, [u.0[0], u.0[1], strength], "body {l} at {}", time.of(l));
    }
}

/// Foreseen or not, in order or not, the bits are those of the orbit.
#[test]
fn shared_orbits_are_found_at_any_time() {
    let each = [ellipse(3); 8];
    let law = Torque::GravityGradient(each[0]);
    let mut orbits = Orbits::<8>::new([&law; 8]).unwrap();
    assert_there(&mut orbits, &each, PerLane::Common(0.25));
    orbits.foresee((0..20).map(|k| 0.5 * f64::from(k)));
    for time in [0.0, 0.5, 0.5, 1.0, 7.25, 1.5, 4.0, -2.0, 9.5, 10.0] {
        assert_there(&mut orbits, &each, PerLane::Common(time));
        assert_there(&mut orbits, &each, PerLane::Each([time; 8]));
    }
    assert_there(&mut orbits, &each, PerLane::Each(std::array::from_fn(|l| l as f64)));
}

#[test]
fn own_orbits_are_not_foreseen() {
    let each: [Orbit; 8] = std::array::from_fn(ellipse);
    let laws = each.map(Torque::GravityGradient);
    let mut orbits = Orbits::<8>::new(laws.each_ref()).unwrap();
    orbits.foresee([0.0, 1.0].into_iter());
    for time in [0.0, 1.0, 2.5] {
        assert_there(&mut orbits, &each, PerLane::Common(time));
    }
    assert_there(&mut orbits, &each, PerLane::Each(std::array::from_fn(|l| 100.0 * l as f64)));
    assert_there(&mut orbits, &each, PerLane::Common(100.0));
}
