//! Quantities of a motion from its states at the output times.

use super::longest;
use crate::facts;
use crate::facts::{Fact, Facts};
use crate::run::States;
use polhode_ga::Vector;
use std::f64::consts::PI;

/// Largest change of an angle between samples, in rad, for which its turns are counted.
const FOLLOWED: f64 = 2.0;

/// The first and the last value.
pub fn ends<T: Into<Fact>>(values: impl DoubleEndedIterator<Item = T> + Clone) -> Facts {
    facts! { start: values.clone().next(), end: values.clone().next_back() }
}

/// The smallest and the largest value.
pub fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| [least.min(x), most.max(x)])
}

/// The times at which values change their sign, by straight lines between samples.
pub fn crossings(times: &[f64], values: &[f64]) -> Vec<f64> {
    let at = |(t, v): (&[f64], &[f64])| t[0] + (t[1] - t[0]) * v[0] / (v[0] - v[1]);
    let pairs = times.windows(2).zip(values.windows(2));
    pairs.filter(|(_, v)| v[0] < 0.0 && v[1] > 0.0 || v[0] > 0.0 && v[1] < 0.0).map(at).collect()
}

/// The mean interval between times; none if there are fewer than two.
pub fn mean_interval(times: &[f64]) -> Option<f64> {
    let intervals = times.len().checked_sub(1).filter(|&count| count > 0)?;
    Some((times[intervals] - times[0]) / intervals as f64)
}

/// The mean rate about e3 of a path of directions fixed in the body; none if samples are too far apart to follow it.
pub fn mean_rate(states: &States, path: &[Vector]) -> Option<f64> {
    let rate = |k: usize| {
        let Vector([x, y, _]) = path[k];
        let spin = states.rotors[k].apply_bivector(states.omegas[k]).dual();
        // The azimuth's rate is at most the speed ω x n of the direction over its distance from the vertical.
        spin.cross(path[k]).norm() / x.hypot(y).max(f64::MIN_POSITIVE)
    };
    let fastest = (0..path.len()).map(rate).fold(0.0, f64::max);
    let duration = states.times.last()? - states.times.first()?;
    if fastest * longest(&states.times) > FOLLOWED {
        return None;
    }
    let azimuths: Vec<f64> = path.iter().map(|Vector([x, y, _])| y.atan2(*x)).collect();
    let turns = azimuths.windows(2).map(|pair| pair[1] - pair[0]);
    let turned: f64 = turns.map(|angle| angle - 2.0 * PI * (angle / (2.0 * PI)).round()).sum();
    Some(turned / duration)
}
