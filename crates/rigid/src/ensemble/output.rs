//! Output arrays and summary of an ensemble.

use super::Failure;
use crate::run::output::BodyOutput;
use std::mem;
use std::ops::Range;

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
    /// The names of the methods, in the order of the first bodies that have them.
    pub method_names: Vec<&'static str>,
    /// For each body the place of its method among the names.
    pub methods: Vec<u64>,
    /// For each body the steps of all its sweeps.
    pub steps: Vec<u64>,
    /// For each body the evaluations of its torque.
    pub evaluations: Vec<u64>,
    /// For each body its longest step in s.
    pub longest: Vec<f64>,
    /// For each body the estimate of its error, NaN where there is none.
    pub estimates: Vec<f64>,
    /// For each body its largest `abs(|R| − 1)`.
    pub norm_drifts: Vec<f64>,
    /// The changes of the quantities that bodies conserve.
    pub drifts: Vec<Drift>,
    /// By ascending body number.
    pub failures: Vec<Failure>,
    /// Each once: see [`crate::run::certificate::Certificate::warnings`].
    pub warnings: Vec<String>,
}

/// The change of a conserved quantity; NaN for bodies that do not conserve it.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// The name of the quantity.
    pub name: &'static str,
    /// For each body its value at the start.
    pub values: Vec<f64>,
    /// For each body its largest relative change.
    pub changes: Vec<f64>,
}

impl Summary {
    /// The name of the method of a body.
    ///
    /// # Panics
    /// If `body` is not less than the number of bodies.
    pub fn method(&self, body: usize) -> &'static str {
        self.method_names[self.methods[body] as usize]
    }
}

/// Successive bodies with their output arrays.
#[derive(Debug)]
pub(super) struct Share<'a> {
    bodies: Range<usize>,
    times: usize,
    arrays: BodyOutput<'a>,
}

impl<'a> Share<'a> {
    /// All bodies, for a number of times.
    pub fn all(outputs: Outputs<'a>, times: usize) -> Share<'a> {
        let Outputs { rotors, omegas, momenta, energies, centers } = outputs;
        let bodies = 0..energies.len().checked_div(times).unwrap_or(0);
        Share { bodies, times, arrays: BodyOutput { rotors, omegas, momenta, energies, centers } }
    }

    pub fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Takes the first bodies away; fewer if there are not as many.
    pub fn take_first(&mut self, count: usize) -> Share<'a> {
        let first = self.bodies.start;
        let bodies = first..first + count.min(self.bodies.len());
        self.bodies.start = bodies.end;
        let points = self.times * bodies.len();
        let arrays = BodyOutput {
            rotors: front(&mut self.arrays.rotors, 4 * points),
            omegas: front(&mut self.arrays.omegas, 3 * points),
            momenta: front(&mut self.arrays.momenta, 3 * points),
            energies: front(&mut self.arrays.energies, points),
            centers: match &mut self.arrays.centers {
                Some([places, velocities]) => {
                    Some([front(places, 3 * points), front(velocities, 3 * points)])
                }
                None => None,
            },
        };
        Share { bodies, times: self.times, arrays }
    }
}

impl<'a> Iterator for Share<'a> {
    type Item = (usize, BodyOutput<'a>);

    fn next(&mut self) -> Option<(usize, BodyOutput<'a>)> {
        let share = self.take_first(1);
        share.bodies.clone().next().map(|body| (body, share.arrays))
    }
}

/// Takes the first numbers away, or all if there are not as many.
fn front<'a>(numbers: &mut &'a mut [f64], count: usize) -> &'a mut [f64] {
    let (first, rest) = mem::take(numbers).split_at_mut_checked(count).unwrap_or_default();
    *numbers = rest;
    first
}
