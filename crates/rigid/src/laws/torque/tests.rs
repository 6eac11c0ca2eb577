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
            let each = times.iter().map(|&time| law.value(&BODY, &Phase { time, ..state() }));
            let each: Vec<Bivector> = each.collect::<Result<_, _>>().expect("a torque at any time");
            assert_eq!(law.values(&BODY, &state(), &times), Ok(each), "{text}");
        }
    }
}

#[test]
fn the_first_time_without_a_value_is_reported() {
    let law = formula("e1∧e2/(t - 3)", Axes::Body);
    let (time, error) = law.values(&BODY, &state(), &[1.0, 3.0, 3.0, 4.0]).expect_err("infinite at 3 s");
    assert!(time == 3.0 && error.0.contains("division by zero"), "{error:?}");
}
