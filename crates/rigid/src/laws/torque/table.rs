//! Torques interpolated in a table of times.

use super::Axes;
use crate::error::TorqueError;
use polhode_ga::{Bivector, Rotor};

/// How a table is interpolated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Piecewise linearly.
    Linear,
    /// By the cubic spline with "not a knot" ends; the parabola through three rows, the line through two.
    Cubic,
    /// Held from each time to the next, where it jumps; the last row ends the table.
    Previous,
}

impl Kind {
    /// The names of all kinds, the default first.
    pub const NAMES: &[&str] = &["linear", "cubic", "previous"];

    /// The kind of this name.
    pub fn from_name(name: &str) -> Option<Kind> {
        [Kind::Linear, Kind::Cubic, Kind::Previous].into_iter().find(|kind| kind.name() == name)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Linear => "linear",
            Kind::Cubic => "cubic",
            Kind::Previous => "previous",
        }
    }
}

/// Torques at increasing times, interpolated by polynomials of degree 3 at most.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The axes of the torques.
    pub axes: Axes,
    /// How it is interpolated.
    pub kind: Kind,
    times: Vec<f64>,
    torques: Vec<Bivector>,
    /// Derivatives at the times, of a spline.
    slopes: Option<Vec<Bivector>>,
}

impl Table {
    /// At least two rows at increasing times.
    pub fn new(
        times: Vec<f64>,
        torques: Vec<Bivector>,
        axes: Axes,
        kind: Kind,
    ) -> Result<Table, TorqueError> {
        let wrong = |message: String| Err(TorqueError::new(message));
        if times.len() != torques.len() {
            return wrong(format!("{} times for {} torques; give one for each", times.len(), torques.len()));
        }
        if times.len() < 2 {
            return wrong(format!("a table of {} rows; it needs at least 2", times.len()));
        }
        if let Some(i) = times.iter().position(|t| !t.is_finite()) {
            return wrong(format!("times[{i}] is {}; the times of a table must be finite", times[i]));
        }
        if let Some(i) = (1..times.len()).find(|&i| times[i] <= times[i - 1]) {
            let (before, time) = (times[i - 1], times[i]);
            return wrong(format!(
                "times[{i}] = {time} is not after times[{}] = {before}; sort the rows",
                i - 1
            ));
        }
        if let Some(i) = torques.iter().position(|n| !n.0.iter().all(|x| x.is_finite())) {
            return wrong(format!(
                "torques[{i}] is {:?}; the torques of a table must be finite",
                torques[i].0
            ));
        }
        let slopes = (kind == Kind::Cubic && times.len() > 2).then(|| spline_slopes(&times, &torques));
        Ok(Table { axes, kind, times, torques, slopes })
    }

    /// The first and the last time.
    fn span(&self) -> (f64, f64) {
        (self.times[0], self.times[self.times.len() - 1])
    }

    /// Whether a time is between them. A step to the last time may end a rounding after it.
    fn covers(&self, time: f64) -> bool {
        let (first, last) = self.span();
        let rounding = 4.0 * f64::EPSILON * first.abs().max(last.abs());
        (first - rounding..=last + rounding).contains(&time)
    }

    /// The torque at a time between the first and the last; at a jump, that after it.
    pub fn at(&self, time: f64) -> Result<Bivector, TorqueError> {
        self.within(time, time)
    }

    /// The torque at a time of a step whose middle is given. A step ends at a jump at the latest, and a held torque is
    /// that of its middle for all stages, which may lie beyond its ends.
    pub(crate) fn within(&self, time: f64, middle: f64) -> Result<Bivector, TorqueError> {
        let time = if self.kind == Kind::Previous { middle } else { time };
        if !self.covers(time) {
            let (first, last) = self.span();
            return Err(TorqueError::new(format!(
                "the table of torques spans {first} s to {last} s; add rows for all times of the simulation"
            )));
        }
        if self.kind == Kind::Previous {
            let row = self.times.partition_point(|t| *t <= time).max(1) - 1;
            return Ok(self.torques[row]);
        }
        let (first, last) = self.span();
        let time = time.clamp(first, last);
        let i = self.times.partition_point(|t| *t <= time).clamp(1, self.times.len() - 1) - 1;
        let (h, x) =
            (self.times[i + 1] - self.times[i], (time - self.times[i]) / (self.times[i + 1] - self.times[i]));
        let (a, b) = (self.torques[i], self.torques[i + 1]);
        // From the nearer end, so that the rows are reproduced exactly.
        let line = if x < 0.5 { a + (b - a) * x } else { b - (b - a) * (1.0 - x) };
        let Some(slopes) = &self.slopes else { return Ok(line) };
        // The cubic Hermite polynomial: the line, and the differences of both slopes from that of the line.
        let steep = b - a;
        let (p, q) = (slopes[i] * h - steep, slopes[i + 1] * h - steep);
        Ok(line + (p * (1.0 - x) - q * x) * (x * (1.0 - x)))
    }

    /// The times of the rows.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The times at which the torque jumps.
    pub(crate) fn jumps(&self) -> &[f64] {
        if self.kind == Kind::Previous { &self.times } else { &[] }
    }

    /// The torques at the times.
    pub fn torques(&self) -> &[Bivector] {
        &self.torques
    }

    /// The torques turned by a rotor.
    pub(crate) fn turned(&self, rotor: Rotor) -> Table {
        let turn = |rows: &[Bivector]| rows.iter().map(|row| rotor.apply_bivector(*row)).collect();
        Table {
            axes: self.axes,
            kind: self.kind,
            times: self.times.clone(),
            torques: turn(&self.torques),
            slopes: self.slopes.as_deref().map(turn),
        }
    }

    /// The largest torque of its rows.
    pub(crate) fn largest(&self) -> f64 {
        self.torques.iter().map(|n| n.norm()).fold(0.0, f64::max)
    }
}

/// The slopes of the spline.
///
/// With `h_i` the distances and `m_i` the mean slopes between the times, the second derivative is continuous at `t_i`
/// if
///
/// ```text
/// h_i s_(i−1) + 2 (h_(i−1) + h_i) s_i + h_(i−1) s_(i+1) = 3 (h_i m_(i−1) + h_(i−1) m_i),
/// ```
///
/// and the third is continuous at `t_1` if, with the equation above for `t_1`,
///
/// ```text
/// h_1 s_0 + (h_0 + h_1) s_1 = ((3 h_0 + 2 h_1) h_1 m_0 + h_0² m_1)/(h_0 + h_1),
/// ```
///
/// and likewise at the other end. Elimination from the first row on keeps all pivots positive.
fn spline_slopes(times: &[f64], torques: &[Bivector]) -> Vec<Bivector> {
    let n = times.len();
    let h: Vec<f64> = times.windows(2).map(|t| t[1] - t[0]).collect();
    let mean: Vec<Bivector> = (0..n - 1).map(|i| (torques[i + 1] - torques[i]) / h[i]).collect();
    if n == 3 {
        let bend = (mean[1] - mean[0]) / (h[0] + h[1]);
        return vec![mean[0] - bend * h[0], mean[0] + bend * h[0], mean[1] + bend * h[1]];
    }
    // The row of t_i: `lower s_(i−1) + diagonal s_i + upper s_(i+1) = right`.
    let end = |near: usize, far: usize| {
        let (a, b) = (h[near], h[far]);
        (b, a + b, (mean[near] * ((3.0 * a + 2.0 * b) * b) + mean[far] * (a * a)) / (a + b))
    };
    let (diagonal, upper, right) = end(0, 1);
    let mut rows = vec![(upper / diagonal, right / diagonal)];
    for i in 1..n {
        let (lower, diagonal, upper, right) = if i + 1 < n {
            let right = (mean[i - 1] * h[i] + mean[i] * h[i - 1]) * 3.0;
            (h[i], 2.0 * (h[i - 1] + h[i]), h[i - 1], right)
        } else {
            let (diagonal, lower, right) = end(n - 2, n - 3);
            (lower, diagonal, 0.0, right)
        };
        let (before, known) = rows[i - 1];
        let pivot = diagonal - lower * before;
        rows.push((upper / pivot, (right - known * lower) / pivot));
    }
    let mut slopes = vec![Bivector::default(); n];
    let mut next = Bivector::default();
    for (slope, (upper, right)) in slopes.iter_mut().zip(&rows).rev() {
        next = *right - next * *upper;
        *slope = next;
    }
    slopes
}
