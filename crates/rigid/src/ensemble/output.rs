//! Output arrays and summary of an ensemble.

use super::Failure;
use crate::run::output::BodyOutput;

/// Arrays for the states of all bodies at all times, body by body: rows of rotors (4), angular velocities in body axes
/// (3), momenta in space (3), energies (1) and, optionally, positions (3) and velocities (3).
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

/// Results of an ensemble besides its points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// For each body the name of its method.
    pub methods: Vec<&'static str>,
    /// For each body the steps of all its sweeps, and the evaluations of its torque.
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
    /// By ascending body number.
    pub failures: Vec<Failure>,
    /// Each once: see [`crate::run::certificate::Certificate::warnings`].
    pub warnings: Vec<String>,
}

impl<'a> Outputs<'a> {
    /// The arrays of each body, for a number of times.
    pub(crate) fn each(self, times: usize) -> impl Iterator<Item = BodyOutput<'a>> + Send {
        let mut centers = self.centers.map(|centers| centers.map(|rows| rows.chunks_mut(3 * times)));
        let own = self.rotors.chunks_mut(4 * times).zip(self.omegas.chunks_mut(3 * times));
        let own = own.zip(self.momenta.chunks_mut(3 * times)).zip(self.energies.chunks_mut(times));
        own.map(move |(((rotors, omegas), momenta), energies)| BodyOutput {
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
