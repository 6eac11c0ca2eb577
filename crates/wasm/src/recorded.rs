//! Recorded motions: rows of states that were computed elsewhere.

use crate::rows::ROW;
use polhode_ga::Rotor;
use std::cmp::Ordering;

/// Rows of states at increasing times.
pub struct Recorded {
    rows: Vec<[f64; ROW]>,
}

impl Recorded {
    /// From consecutive rows, with increasing times.
    pub fn new(numbers: &[f64]) -> Result<Recorded, String> {
        let (rows, rest) = numbers.as_chunks::<ROW>();
        if rows.is_empty() || !rest.is_empty() {
            return Err(format!(
                "rows of a recorded motion have {ROW} numbers, got {} numbers",
                numbers.len()
            ));
        }
        let fall =
            rows.windows(2).position(|pair| pair[0][0].partial_cmp(&pair[1][0]) != Some(Ordering::Less));
        if let Some(k) = fall {
            return Err(format!(
                "times of a recorded motion must increase, but row {} is not after row {k}",
                k + 1
            ));
        }
        Ok(Recorded { rows: rows.to_vec() })
    }

    /// Rows at times from the first to the last. Between rows, for display only, rotors are interpolated by a uniform
    /// turn and all else linearly.
    pub fn states(&self, times: &[f64]) -> Result<Vec<[f64; ROW]>, String> {
        times.iter().map(|&time| self.at(time)).collect()
    }

    fn at(&self, time: f64) -> Result<[f64; ROW], String> {
        let (first, last) = (self.rows[0][0], self.rows[self.rows.len() - 1][0]);
        if !(first..=last).contains(&time) {
            return Err(format!("the motion is recorded from {first} s to {last} s, not at {time} s"));
        }
        let after = self.rows.partition_point(|row| row[0] <= time);
        let (a, Some(b)) = (&self.rows[after - 1], self.rows.get(after)) else {
            return Ok(self.rows[after - 1]);
        };
        let part = (time - a[0]) / (b[0] - a[0]);
        let mut row: [f64; ROW] = std::array::from_fn(|k| a[k] + part * (b[k] - a[k]));
        row[0] = time;
        row[1..5].copy_from_slice(&between(rotor(a), rotor(b), part).components());
        Ok(row)
    }
}

fn rotor(row: &[f64; ROW]) -> Rotor {
    Rotor::from_unit_components([row[1], row[2], row[3], row[4]])
}

/// Interpolates along the shorter way between two rotors: `R (~R S)^part`.
pub fn between(r: Rotor, s: Rotor, part: f64) -> Rotor {
    let turn = r.reverse() * s;
    let [scalar, ..] = turn.components();
    let turn = if scalar < 0.0 { Rotor::from_unit_components(turn.components().map(|x| -x)) } else { turn };
    r * Rotor::exp(turn.log() * part)
}
