//! Wheels with motors among the laws of a body: the inertia that carries them, and their momentum.

use super::torque::Torque;
use crate::body::inertia::Inertia;
use crate::state::point::{Function, Seen};
use polhode_ga::{Bivector, Vector};
use std::array::from_fn;

/// The momentum `h` of all wheels with motors at a time; none without such wheels.
pub(crate) fn driven(torques: &[Torque], time: f64) -> Option<Bivector> {
    let each =
        torques.iter().filter_map(|t| if let Torque::Wheels(w) = t { Some(w.momentum(time)) } else { None });
    each.reduce(|a, b| a + b)
}

/// The inertia I* of a body without the moments of its wheels about their axes, and its laws: the gravity gradient, which
/// acts on all of I, has the part of the wheels added. A negative moment means that the wheels are heavier than the body.
pub(crate) fn carrier(inertia: &Inertia, torques: &[Torque]) -> (Inertia, Vec<Torque>) {
    let (mut matrix, mut laws) = (inertia.matrix(), torques.to_vec());
    for torque in torques {
        let Torque::Wheels(wheels) = torque else { continue };
        let own = wheels.about_axes();
        matrix = from_fn(|i| from_fn(|j| matrix[i][j] - own[i][j]));
        for other in torques {
            let Torque::GravityGradient(orbit) = other else { continue };
            let orbit = *orbit;
            let gradient = move |seen: &Seen| {
                let (u, nearness) = orbit.place(seen.time);
                let u = seen.rotor.reverse().apply(u);
                let mapped = Vector(from_fn(|i| (0..3).map(|j| own[i][j] * u.0[j]).sum()));
                let strength = 3.0 * orbit.rate() * orbit.rate() * nearness;
                Ok(Bivector((u.cross(mapped) * strength).0))
            };
            laws.push(Torque::Function(Function::new(gradient)));
        }
    }
    if laws.iter().any(|law| matches!(law, Torque::Wheels(_))) {
        (Inertia::from_symmetric(matrix).unwrap_or(*inertia), laws)
    } else {
        (*inertia, laws)
    }
}
