//! The torque against the change of L, and the vectors of laws.

use super::*;
use crate::laws::torque::Orbit;
use crate::{Inertia, Scene};
use polhode_ga::Rotor;
use std::path::Path;

fn setup(laws: Vec<Torque>) -> Setup {
    // Principal axes that are not the body axes.
    let frame = Rotor::exp(Bivector([0.2, -0.4, 0.1]));
    let inertia = Inertia::from_principal_moments([1.0, 2.0, 2.5]).unwrap().rotated(frame);
    let (rotor, omega) = (Rotor::exp(Bivector([0.3, 0.1, -0.2])), Bivector([0.5, 1.0, -0.7]));
    Setup { inertia, rotor, omega, time: 0.0, torques: laws, mass: f64::NAN, has_forces: false }
}

/// `dL/dt` by a symmetric difference over ±h of a motion solved to rounding: off by about `L''' h²/6`.
#[test]
fn torque_is_the_rate_of_change_of_momentum() {
    let h = 1e-4;
    let laws = [
        Torque::ConstantBody(Bivector([0.1, 0.2, -0.3])),
        Torque::Magnetic { dipole: Vector([0.2, 0.0, 0.1]), field: Vector([0.0, 1.0, 2.0]) },
        Torque::GravityGradient(Orbit::circular(0.5)),
        Torque::Damping(0.3),
        Torque::Wheel(Bivector([0.1, 0.7, 0.0])),
        Torque::Larmor(Vector([0.3, 0.2, 0.1])),
    ];
    // Damping and Larmor's torque are of the whole momentum, which a wheel shares.
    for chosen in [&laws[..3], &laws[3..4], &laws[4..5], &laws[5..]] {
        let setup = setup(chosen.to_vec());
        let motion =
            crate::run::Problem::of(&setup).simulate(&[0.0, h, 2.0 * h], Default::default(), &mut |_| true);
        let states = motion.unwrap().states();
        let change = (states.momenta_space[2] - states.momenta_space[0]) * (0.5 / h);
        let (rotor, omega) = (states.rotors[1], states.omegas[1]);
        let [position, velocity] = [Vector::default(); 2];
        let torque = setup.torque_in_space(&Seen { time: h, rotor, omega, position, velocity }).unwrap();
        assert!((change - torque).norm() < 1e-6, "{chosen:?}: {change:?} {torque:?}");
    }
}

#[test]
fn sources_are_the_vectors_of_laws() {
    let kinds = |setup: &Setup| setup.sources(0.0).iter().map(|source| source.kind).collect::<Vec<_>>();
    let sun = "radiation_pressure = { area = 1, offset = [0.1, 0, 0], sun = [0, 2, 0] }";
    let text = format!(
        "[body]\nmoments = [1, 2, 3]\n[initial]\nspin = {{ vector = [1, 0, 0] }}\n[torque]\n{sun}\n\
         gyrostat = [0, 1, 0]\n[run]\nduration = 1\n"
    );
    let scene = Scene::parse(&text, Path::new("test.toml")).unwrap();
    let (body, laws) = scene.build().unwrap();
    let setup = scene.setup(&body, &laws);
    assert_eq!(kinds(&setup), ["sun", "wheel"]);
    assert_eq!(setup.sources(0.0)[0].along, Vector([0.0, 1.0, 0.0]));
    let orbit = self::setup(vec![Torque::GravityGradient(Orbit::circular(0.5)), Torque::Damping(0.1)]);
    // At time 0 the body is along e1 from the planet.
    assert_eq!(orbit.sources(0.0)[0].along, Vector([-1.0, -0.0, -0.0]));
    assert_eq!(kinds(&orbit), ["planet"]);
}
