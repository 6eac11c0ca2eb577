//! Output arrays of one body.

use crate::laws::conserved::{energy, momentum};
use crate::laws::torque::Torque;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::{Bivector, Rotor};

/// Output arrays of one body.
#[derive(Debug)]
pub(crate) struct BodyOutput<'a> {
    pub rotors: &'a mut [f64],
    pub omegas: &'a mut [f64],
    pub momenta: &'a mut [f64],
    pub energies: &'a mut [f64],
    pub centers: Option<[&'a mut [f64]; 2]>,
}

impl BodyOutput<'_> {
    /// Writes a point in principal axes, `frame` leading from them to the body's.
    pub fn write(
        &mut self,
        index: usize,
        (frame, body, torques): (Rotor, &Gyrostat, &[Torque]),
        phase: &Phase,
        center: &Center,
    ) {
        let momentum = phase.rotor.apply_bivector(momentum(torques, phase));
        let omega = frame.apply_bivector(body.omega(phase.momentum));
        self.put(index, phase.rotor * frame.reverse(), omega, momentum, energy(body, torques, phase));
        self.place(index, center);
    }

    /// Writes a point: rotor from body axes to space, angular velocity in body axes, momentum in space, and energy.
    pub fn put(&mut self, index: usize, rotor: Rotor, omega: Bivector, momentum: Bivector, energy: f64) {
        self.rotors[4 * index..][..4].copy_from_slice(&rotor.components());
        self.omegas[3 * index..][..3].copy_from_slice(&omega.0);
        self.momenta[3 * index..][..3].copy_from_slice(&momentum.0);
        self.energies[index] = energy;
    }

    /// Writes the centre of mass.
    pub fn place(&mut self, index: usize, center: &Center) {
        if let Some([places, velocities]) = &mut self.centers {
            places[3 * index..][..3].copy_from_slice(&center.position.0);
            velocities[3 * index..][..3].copy_from_slice(&center.velocity.0);
        }
    }

    /// Writes NaN.
    pub fn unknown(&mut self, index: usize) {
        self.rotors[4 * index..][..4].fill(f64::NAN);
        self.omegas[3 * index..][..3].fill(f64::NAN);
        self.momenta[3 * index..][..3].fill(f64::NAN);
        self.energies[index] = f64::NAN;
        for rows in self.centers.iter_mut().flatten() {
            rows[3 * index..][..3].fill(f64::NAN);
        }
    }
}
