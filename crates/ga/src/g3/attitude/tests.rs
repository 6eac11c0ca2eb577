use super::*;

const TRIPLES: [&str; 6] = ["xyz", "zyx", "yzx", "zxz", "xyx", "yzy"];

fn rotors() -> impl Iterator<Item = Rotor> {
    let numbers = |i: usize| std::array::from_fn(|k| ((i * 7919 + k * 104_729) % 1009) as f64 / 504.5 - 1.0);
    (1..200).map(move |i| Rotor::from_components(numbers(i)).expect("it is not 0"))
}

#[test]
fn euler_angles_give_the_attitude_back() {
    for letters in TRIPLES.iter().flat_map(|letters| [(*letters).to_owned(), letters.to_uppercase()]) {
        let sequence = EulerSequence::new(&letters).expect("it is a sequence");
        for rotor in rotors() {
            let angles = sequence.angles(rotor).expect("there are three axes");
            let back = sequence.rotor(&angles).expect("they are finite");
            assert!(rotor.distance(back) < 1e-14, "{letters} {rotor:?} {angles:?}");
        }
    }
}

#[test]
fn in_gimbal_lock_the_angle_named_last_is_zero() {
    for letters in ["zyx", "ZYX"] {
        let sequence = EulerSequence::new(letters).expect("it is a sequence");
        let rotor = sequence.rotor(&[0.3, FRAC_PI_2, 0.2]).expect("they are finite");
        let angles = sequence.angles(rotor).expect("there are three axes");
        assert!(angles[2].abs() < 1e-15, "{letters} {angles:?}");
        assert!(sequence.rotor(&angles).expect("they are finite").distance(rotor) < 1e-14);
    }
}

#[test]
fn other_letters_are_no_sequence() {
    for letters in ["", "xx", "xyzx", "xY", "abc", "321", "é"] {
        assert_eq!(EulerSequence::new(letters), None, "{letters}");
    }
    assert_eq!(EulerSequence::new("zy").expect("two axes").angles(Rotor::IDENTITY), None);
}

#[test]
fn slerp_goes_the_shorter_way_at_constant_rate() {
    for (r, s) in rotors().zip(rotors().skip(1)) {
        let distance = r.distance(s);
        for t in [0.0, 0.25, 0.5, 1.0] {
            let way = r.slerp(s, t).expect("they are finite");
            assert!((r.distance(way) - t * distance).abs() < 1e-14, "{r:?} {s:?} {t}");
        }
    }
    assert!(Rotor::IDENTITY.slerp(Rotor::IDENTITY, f64::NAN).is_err());
}

#[test]
fn distances_of_close_rotors_are_accurate() {
    for angle in [1e-300, 1e-20, 1e-9, 1.0, 3.0] {
        let turn = Rotor::from_plane_angle(Bivector([0.0, 0.0, 1.0]), angle).expect("it is finite");
        for other in [turn, -turn] {
            assert!((Rotor::IDENTITY.distance(other) / angle - 1.0).abs() < 1e-15, "{angle}");
            assert!((other.angle() / angle - 1.0).abs() < 1e-15, "{angle}");
        }
    }
}
