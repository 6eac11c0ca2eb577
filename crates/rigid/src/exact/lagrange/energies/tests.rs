use crate::body::inertia::Inertia;
use crate::exact::lagrange::HeavyTop;
use crate::exact::lagrange::nutations::Nutations;
use crate::numerics::wide::Wides;
use polhode_ga::{Bivector, Rotor, Vector};
use std::f64::consts::PI;

/// The energy of a motion is kept, and not with other rates or tilts: at any tilt from either pole.
#[test]
fn of_motions() {
    let inertia = Inertia::from_principal_moments([1.0, 1.0, 0.5]).expect("a body's");
    for (tilt, spin) in [(0.5, 4.0), (1.5, 0.0), (1e-3, 20.0), (1e-140, 8.0), (3.0, 3.0), (PI - 1e-4, 0.1)] {
        let rotor = Rotor::exp(Bivector([-0.5 * tilt, 0.0, 0.0]));
        let from_pole = f64::min(tilt, PI - tilt);
        let omega = Bivector([0.2 * from_pole, 0.1 * from_pole, spin]);
        let top = HeavyTop::new(&inertia, rotor, omega, Vector([0.0, 0.0, 2.0])).expect("symmetric");
        let energies = Nutations::<1>::of::<Wides<1, false>, false>(&[top]).0.energies;
        let motion = top.motion().expect("resolved");
        let kept = |t: f64, tilted: f64, faster: f64| {
            let (rotor, Bivector(omega)) = motion.at(t);
            let mut components = rotor.components();
            // Those of the distance from the nearer pole.
            for k in if tilt < 1.57 { [1, 2] } else { [0, 3] } {
                components[k] *= tilted;
            }
            let omega = [omega[0] * faster, omega[1] * faster, omega[2]];
            let (rotor, omega) = (components.map(|x| [x]), omega.map(|x| [x]));
            energies.are_kept::<false>(&rotor, &omega, &[top.scale])[0]
        };
        for t in [0.0, 0.3, 1.7] {
            assert!(kept(t, 1.0, 1.0), "{tilt} {spin} {t}");
            // Rates below the rounding of the spin are arbitrary.
            let is_known = tilt > 1e-9;
            assert_eq!(kept(t, 1.0 + 1e-5, 1.0), !is_known, "{tilt} {spin} {t}");
            assert_eq!(kept(t, 1.0, 1.0 + 1e-5), !is_known, "{tilt} {spin} {t}");
        }
    }
}
