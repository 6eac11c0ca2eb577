//! Motions of an ensemble reduced to a few numbers of each body.

use super::bins::bin;
use super::{Ensemble, Outputs};
use crate::exact::free::FreeMotion;
use crate::exact::regime::Regime;
use polhode_ga::simd::threads::{Threads, for_each};
use polhode_ga::{Rotor, Vector};
use std::f64::consts::{FRAC_PI_2, PI};

/// Numbers of a state that are reduced: the angle between the attitude and the nominal one, the tilt of the axis, both in
/// rad, `|Ω|` in rad/s and the energy in J.
pub const SERIES: usize = 4;
/// Series that are counted at each time, the first ones.
pub const COUNTED: usize = 3;
/// Numbers that are counted once for each body: energy and `|L|`, at the first and the last time of each.
pub const ENDS: usize = 4;
/// Numbers of a body: see [`Watch::reduce`].
pub const ROW: usize = 2 * SERIES + 5;
/// Angles from the nominal attitude of which the first time is recorded, in rad.
pub const BEYOND: [f64; 2] = [PI / 18.0, FRAC_PI_2];

/// What motions are compared with.
#[derive(Clone, Copy, Debug)]
pub struct Watch<'a> {
    /// In s.
    pub times: &'a [f64],
    /// The rotors of the nominal body at the times.
    pub nominal: &'a [[f64; 4]],
    /// A direction fixed in the body.
    pub axis: Vector,
    /// Directions in space from which its tilt is measured: one for all times, or one for each; none for L of each body.
    pub upright: &'a [[f64; 3]],
}

/// The states of one body at all times.
#[derive(Clone, Copy, Debug)]
struct BodyStates<'a> {
    rotors: &'a [[f64; 4]],
    omegas: &'a [[f64; 3]],
    momenta: &'a [[f64; 3]],
    energies: &'a [f64],
}

impl Watch<'_> {
    /// Reduces the motions of bodies, body by body.
    ///
    /// A row has the least and the largest of each of the [`SERIES`] over the times; then how often the tilt passes 90°
    /// between times, and the first and the last time of that; then the first times at which the angle from the nominal
    /// attitude is more than [`BEYOND`]. Times are interpolated linearly, in the cosine of the tilt and in the angle. States
    /// that are NaN, such as those of failed bodies, are left out; NaN where there is no such number or time.
    ///
    /// `bins`, if not empty, gets for each body the bins of the first [`COUNTED`] series, each at all times, and of the
    /// [`ENDS`].
    ///
    /// # Panics
    /// If lengths do not match.
    pub fn reduce(&self, states: &Outputs, threads: Threads, rows: &mut [[f64; ROW]], bins: &mut [i32]) {
        let n = self.times.len();
        let size = if bins.is_empty() { 0 } else { COUNTED * n + ENDS };
        assert!(bins.len() == size * rows.len() && self.nominal.len() == n, "rows of all bodies");
        let rotors = states.rotors.as_chunks::<4>().0;
        let (omegas, momenta) = (states.omegas.as_chunks::<3>().0, states.momenta.as_chunks::<3>().0);
        let (count, mut rows, mut bins) = (rows.len(), rows, bins);
        let pieces = threads.ranges(count, (1 << 10) / n.max(1) + 1).map(|bodies| {
            let own = rows.split_off_mut(..bodies.len()).expect("pieces fill the rows");
            let binned = bins.split_off_mut(..bodies.len() * size).expect("pieces fill the bins");
            (bodies, own, binned)
        });
        for_each(pieces, |(bodies, rows, bins)| {
            for (k, (body, row)) in bodies.zip(rows).enumerate() {
                let at = body * n..(body + 1) * n;
                let states = BodyStates {
                    rotors: &rotors[at.clone()],
                    omegas: &omegas[at.clone()],
                    momenta: &momenta[at.clone()],
                    energies: &states.energies[at],
                };
                *row = self.body(&states, &mut bins[k * size..(k + 1) * size]);
            }
        });
    }

    fn body(&self, states: &BodyStates, bins: &mut [i32]) -> [f64; ROW] {
        let n = self.times.len();
        let mut record = Record::default();
        for k in 0..n {
            let (numbers, cosine) = self.numbers(states, k);
            record.add(self.times, k, numbers, cosine);
            if !bins.is_empty() {
                for (series, x) in numbers[..COUNTED].iter().enumerate() {
                    bins[series * n + k] = bin(*x);
                }
            }
        }
        if let (false, Some(last)) = (bins.is_empty(), n.checked_sub(1)) {
            let momentum = |k: usize| Vector(states.momenta[k]).norm();
            let ends = [states.energies[0], states.energies[last], momentum(0), momentum(last)];
            bins[COUNTED * n..].copy_from_slice(&ends.map(bin));
        }
        record.row()
    }

    /// The series at a time, and the cosine of the tilt up to a positive factor.
    fn numbers(&self, states: &BodyStates, k: usize) -> ([f64; SERIES], f64) {
        let rotor = Rotor::from_unit_components(states.rotors[k]);
        let nominal = Rotor::from_unit_components(self.nominal[k]);
        let [scalar, x, y, z] = (rotor * nominal.reverse()).components();
        let from_nominal = 2.0 * Vector([x, y, z]).norm().atan2(scalar.abs());
        let axis = rotor.apply(self.axis);
        let upright = match self.upright {
            [] => Vector(states.momenta[k]),
            [one] => Vector(*one),
            each => Vector(each[k]),
        };
        let (across, along) = (axis.cross(upright).norm(), axis.dot(upright));
        // Without a direction there is no tilt.
        let defined = upright.norm() > 0.0;
        let (tilt, cosine) = if defined { (across.atan2(along), along) } else { (f64::NAN, f64::NAN) };
        ([from_nominal, tilt, Vector(states.omegas[k]).norm(), states.energies[k]], cosine)
    }
}

/// What is recorded of a body from time to time.
struct Record {
    extrema: [[f64; 2]; SERIES],
    flips: f64,
    flip_times: [f64; 2],
    beyond: [f64; 2],
    /// Number and value of the last angle, and of the last cosine that is not 0.
    angle: Option<(usize, f64)>,
    cosine: Option<(usize, f64)>,
}

impl Default for Record {
    fn default() -> Record {
        Record {
            extrema: [[f64::NAN; 2]; SERIES],
            flips: 0.0,
            flip_times: [f64::NAN; 2],
            beyond: [f64::NAN; 2],
            angle: None,
            cosine: None,
        }
    }
}

impl Record {
    fn add(&mut self, times: &[f64], k: usize, numbers: [f64; SERIES], cosine: f64) {
        for (extremes, x) in self.extrema.iter_mut().zip(numbers) {
            // The functions ignore NaN.
            *extremes = [extremes[0].min(x), extremes[1].max(x)];
        }
        let between = |before: usize, share: f64| times[before] + share * (times[k] - times[before]);
        let angle = numbers[0];
        if !angle.is_nan() {
            for (first, bound) in self.beyond.iter_mut().zip(BEYOND) {
                if first.is_nan() && angle > bound {
                    let passed =
                        |(before, from): (usize, f64)| between(before, (bound - from) / (angle - from));
                    *first = self.angle.map_or(times[k], passed);
                }
            }
            self.angle = Some((k, angle));
        }
        if !cosine.is_nan() && cosine != 0.0 {
            if let Some((before, from)) = self.cosine.filter(|(_, from)| (*from > 0.0) != (cosine > 0.0)) {
                let time = between(before, from / (from - cosine));
                self.flips += 1.0;
                self.flip_times = [if self.flips == 1.0 { time } else { self.flip_times[0] }, time];
            }
            self.cosine = Some((k, cosine));
        }
    }

    fn row(&self) -> [f64; ROW] {
        let mut row = [0.0; ROW];
        row[..2 * SERIES].copy_from_slice(self.extrema.as_flattened());
        row[2 * SERIES] = self.flips;
        row[2 * SERIES + 1..2 * SERIES + 3].copy_from_slice(&self.flip_times);
        row[2 * SERIES + 3..].copy_from_slice(&self.beyond);
        row
    }
}

/// Regime and periods of a free body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBody {
    /// None if the start is not valid.
    pub regime: Option<Regime>,
    /// Period of Ω in the body, in s; NaN without one.
    pub period: f64,
    /// Period of the mean precession about L, positive, in s; NaN without one.
    pub precession_period: f64,
}

impl Ensemble {
    /// Regime and periods of each body as a free one.
    pub fn describe_free(&self, threads: Threads) -> Vec<FreeBody> {
        let none = FreeBody { regime: None, period: f64::NAN, precession_period: f64::NAN };
        let mut bodies = vec![none; self.starts.len()];
        threads.for_each_piece(64, 1, &mut bodies, |rows, bodies| {
            for (body, found) in rows.zip(bodies) {
                let start = &self.starts[body];
                let is_known = start.omega.0.iter().all(|x| x.is_finite());
                let motion = FreeMotion::new(self.inertias.of(body), start.rotor, start.omega);
                let Ok(about) = motion.map(|motion| motion.describe()) else { continue };
                if !is_known {
                    continue;
                }
                *found = FreeBody {
                    regime: Some(about.regime),
                    period: about.period.map_or(f64::NAN, f64::abs),
                    precession_period: about.precession_period().map_or(f64::NAN, f64::abs),
                };
            }
        });
        bodies
    }
}

/// The regimes by their codes 0, 1, ...
pub const REGIMES: [Regime; 6] = [
    Regime::Rest,
    Regime::Steady,
    Regime::Symmetric,
    Regime::ShortAxis,
    Regime::LongAxis,
    Regime::Separatrix,
];

/// The code of a regime; −1 for none.
pub fn code(regime: Option<Regime>) -> i8 {
    REGIMES.iter().position(|known| Some(*known) == regime).map_or(-1, |place| place as i8)
}

/// The bins of the periods of free bodies: two for each.
pub fn bins_of_periods(bodies: &[FreeBody]) -> impl Iterator<Item = [i32; 2]> + '_ {
    bodies.iter().map(|body| [bin(body.period), bin(body.precession_period)])
}

#[cfg(test)]
mod tests;
