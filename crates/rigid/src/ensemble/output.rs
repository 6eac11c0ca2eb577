//! Where the points of the motions go.

use super::Failure;
use crate::laws::conserved::energy;
use crate::laws::torque::Torque;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::Rotor;

/// Room for the points of all bodies at all times, body by body: rows of four rotor components, of three of the angular
/// velocity in body axes, of three of the momentum in space, energies, and six of place and velocity, for which there
/// may be none.
#[derive(Debug)]
pub struct Outputs<'a> {
    /// Body axes to space.
    pub rotors: &'a mut [f64],
    /// In body axes, rad/s.
    pub omegas: &'a mut [f64],
    /// In space, those of wheels included, kg m²/s.
    pub momenta: &'a mut [f64],
    /// In J.
    pub energies: &'a mut [f64],
    /// Of the centres of mass, in m and m/s.
    pub centers: Option<[&'a mut [f64]; 2]>,
}

/// What is told of an ensemble besides its points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// For each body the name of its method.
    pub methods: Vec<&'static str>,
    /// For each body the steps of all its passes, and the evaluations of its torque.
    pub steps: Vec<[u64; 2]>,
    /// For each body its longest step in s.
    pub longest: Vec<f64>,
    /// For each body the estimate of its error, NaN where there is none.
    pub estimates: Vec<f64>,
    /// For each body its largest `abs(|R| − 1)`.
    pub norm_drifts: Vec<f64>,
    /// For each conserved quantity its name, and for each body its value at the start and its largest relative change;
    /// NaN for a body that does not conserve it.
    pub drifts: Vec<(&'static str, Vec<[f64; 2]>)>,
    /// By rising numbers of bodies.
    pub failures: Vec<Failure>,
    /// Each once: see [`crate::run::certificate::Certificate::warnings`].
    pub warnings: Vec<String>,
}

/// Room for the points of one body.
#[derive(Debug)]
pub(crate) struct Own<'a> {
    pub rotors: &'a mut [f64],
    pub omegas: &'a mut [f64],
    pub momenta: &'a mut [f64],
    pub energies: &'a mut [f64],
    pub centers: Option<[&'a mut [f64]; 2]>,
}

impl<'a> Outputs<'a> {
    /// The room of each body, for so many times.
    pub(crate) fn each(self, times: usize) -> impl Iterator<Item = Own<'a>> + Send {
        let mut centers = self.centers.map(|centers| centers.map(|rows| rows.chunks_mut(3 * times)));
        let own = self.rotors.chunks_mut(4 * times).zip(self.omegas.chunks_mut(3 * times));
        let own = own.zip(self.momenta.chunks_mut(3 * times)).zip(self.energies.chunks_mut(times));
        own.map(move |(((rotors, omegas), momenta), energies)| Own {
            rotors,
            omegas,
            momenta,
            energies,
            centers: centers
                .as_mut()
                .and_then(|[places, velocities]| Some([places.next()?, velocities.next()?])),
        })
    }
}

impl Own<'_> {
    /// Writes a point in principal axes, `frame` leading from them to the body's.
    pub fn write(
        &mut self,
        index: usize,
        (frame, body, torques): (Rotor, &Gyrostat, &[Torque]),
        phase: &Phase,
        center: &Center,
    ) {
        let momentum = phase.rotor.apply_bivector(phase.momentum);
        self.rotors[4 * index..][..4].copy_from_slice(&(phase.rotor * frame.reverse()).components());
        let omega = frame.apply_bivector(body.omega(phase.momentum));
        self.omegas[3 * index..][..3].copy_from_slice(&omega.0);
        self.momenta[3 * index..][..3].copy_from_slice(&momentum.0);
        self.energies[index] = energy(body, torques, phase);
        self.place(index, center);
    }

    /// Writes where the centre of mass is.
    pub fn place(&mut self, index: usize, center: &Center) {
        if let Some([places, velocities]) = &mut self.centers {
            places[3 * index..][..3].copy_from_slice(&center.position.0);
            velocities[3 * index..][..3].copy_from_slice(&center.velocity.0);
        }
    }

    /// Writes that nothing is known.
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
