use super::*;
use crate::laws::formula::Purpose;
use polhode_ga::formula::Names;

const BODY: Gyrostat = Gyrostat { moments: [1.0, 2.0, 2.5], wheel: Bivector([0.1, -0.2, 0.3]) };

fn formula(text: &str, axes: Axes) -> Torque {
    let law = Formula::new(text, Purpose::Torque(axes), Names::new([]), |_| None);
    Torque::Formula(law.expect("a bivector of the names of the motion"))
}

fn state() -> Phase {
    let rotor = Rotor::from_unit_components([0.8, 0.0, 0.6, 0.0]);
    Phase { rotor, momentum: Bivector([0.3, -0.7, 1.1]), time: 5.0 }
}

#[test]
fn values_at_many_times_are_those_at_each() {
    let times: Vec<f64> = (0..100).map(|k| 0.37 * f64::from(k)).collect();
    let frame = Rotor::from_unit_components([0.6, 0.0, 0.0, 0.8]);
    for axes in [Axes::Body, Axes::Space] {
        for text in ["sin(3 t) Ω + I(L_B) + (~R e3 R)∧e1", "e1∧e2 + t L"] {
            let law = formula(text, axes).in_axes(frame);
            let each =
                times.iter().map(|&time| law.value(&Point::at_rest(&BODY, &Phase { time, ..state() })));
            let each: Vec<Bivector> = each.collect::<Result<_, _>>().expect("a torque at any time");
            assert_eq!(law.values(&Point::at_rest(&BODY, &state()), &times), Ok(each), "{text}");
        }
    }
}

#[test]
fn the_first_time_without_a_value_is_reported() {
    let law = formula("e1∧e2/(t - 3)", Axes::Body);
    let (time, error) =
        law.values(&Point::at_rest(&BODY, &state()), &[1.0, 3.0, 3.0, 4.0]).expect_err("infinite at 3 s");
    assert!(time == 3.0 && error.message.contains("division by zero"), "{error:?}");
}

/// Over all attitudes, here some thousand, a torque stays within its size and a potential within its range; those of single
/// fields and springs are reached.
#[test]
fn sizes_and_ranges_bound_torques_and_potentials() {
    let body = Gyrostat::rigid([1.0, 2.0, 2.5]);
    let rest = Rotor::from_components([1.0, 0.2, 0.3, -0.1]).expect("a rotor");
    let orbit = Orbit::new(3.0, 0.3, 0.0).expect("an ellipse");
    let laws = [
        (Torque::Heavy(Vector([0.5, 3.0, -1.0])), true),
        (Torque::Magnetic { dipole: Vector([0.1, 0.2, 2.5]), field: Vector([3.0, -0.5, 1.0]) }, true),
        (Torque::TorsionSpring { stiffness: -3.0, rest }, true),
        (Torque::GravityGradient(orbit), false),
    ];
    for (law, reached) in laws {
        let (mut most, mut low, mut high) = (0.0_f64, f64::INFINITY, f64::NEG_INFINITY);
        for k in 0..4000 {
            // Points of the unit 3-sphere with irrational steps.
            let [a, b, c] = [0.000_25, 0.618_034, 0.754_878].map(|step| (f64::from(k) + 0.5) * step % 1.0);
            let turn = std::f64::consts::TAU;
            let (s, t) = (a.sqrt(), (1.0 - a).sqrt());
            let components =
                [s * (turn * b).cos(), s * (turn * b).sin(), t * (turn * c).cos(), t * (turn * c).sin()];
            let rotor = Rotor::from_unit_components(components);
            // At the periapsis.
            let at = Phase { rotor, momentum: Bivector::default(), time: 0.0 };
            most = most.max(law.value(&Point::at_rest(&body, &at)).expect("a torque").norm());
            let potential = law.potential(&body, &at).unwrap_or(0.0);
            (low, high) = (low.min(potential), high.max(potential));
        }
        let (size, range) = (law.size(&body), law.potential_range());
        assert!(
            most <= size * (1.0 + 1e-12) && high - low <= range * (1.0 + 1e-12),
            "{most} {low} {high} {law:?}"
        );
        assert!(
            !reached || (most >= 0.97 * size && high - low >= 0.95 * range),
            "{most} {low} {high} {law:?}"
        );
    }
}

/// At the periapsis the direction turns fastest and the attraction is largest.
#[test]
fn the_periapsis_is_the_fastest_and_nearest_place() {
    for (rate, eccentricity) in [(1.2, 0.3), (-0.4, 0.7), (2.5, 0.0)] {
        let orbit = Orbit::new(rate, eccentricity, 0.0).expect("an orbit");
        let turn = |time: f64| {
            let h = 1e-4;
            let [u, v] = [time - h, time + h].map(|t| orbit.place(t).0);
            u.cross(v).norm() / (2.0 * h)
        };
        assert!((turn(0.0) / orbit.fastest_turn() - 1.0).abs() <= 1e-6, "{rate} {eccentricity}");
        assert!((orbit.place(0.0).1 / orbit.largest_nearness() - 1.0).abs() <= 1e-12);
        for k in 1..100 {
            let time = 0.1 * f64::from(k);
            assert!(turn(time) <= orbit.fastest_turn() * (1.0 + 1e-6));
            assert!(orbit.place(time).1 <= orbit.largest_nearness() * (1.0 + 1e-12));
        }
    }
}

/// The limit of a wheel's speed is one in space, whatever its moment, and the torque of the motors is what it exerts.
#[test]
fn wheels_start_within_their_limits() {
    let wheel =
        Wheel { axis: Vector([0.0, 0.0, 1.0]), inertia: 0.1, max_torque: f64::INFINITY, max_speed: 10.0 };
    let wheels = |speed: f64, omega: f64, torque: f64| {
        Wheels::new(vec![wheel], &[speed], Bivector([0.0, 0.0, omega]), &[0.0], &[vec![torque]])
    };
    for sign in [1.0, -1.0] {
        assert!(wheels(sign * 10.0, 0.0, 0.2).is_ok() && wheels(sign * 8.0, sign * 2.0, 0.2).is_ok());
        assert!(wheels(sign * 10.5, 0.0, 0.2).is_err() && wheels(sign * 8.0, sign * 2.5, 0.2).is_err());
    }
    let running = wheels(1.0, 0.0, -0.2).expect("within the limit");
    assert!(!running.is_idle() && wheels(1.0, 0.0, 0.0).expect("within the limit").is_idle());
    assert_eq!(Torque::Wheels(running.into()).size(&BODY), 0.2);
}

/// In other axes gains map what these see: `G'(B) = ~F G(F B ~F) F`, also where two of them are equal.
#[test]
fn gains_turn_with_the_axes() {
    let frame = Rotor::from_components([2.0, 1.0, -1.0, 0.5]).expect("a rotor");
    let b = Bivector([0.3, -0.7, 1.1]);
    for along in [[1.0, 1.0, 2.0], [1.0, 2.0, 2.0], [2.0, 1.0, 2.0], [3.0; 3], [1.0, 2.0, 3.0]] {
        let gains = Gains::new(along);
        let expected = frame.reverse().apply_bivector(gains.times(frame.apply_bivector(b)));
        assert!((gains.in_axes(frame).times(b) - expected).norm() <= 1e-14, "{along:?}");
    }
}
