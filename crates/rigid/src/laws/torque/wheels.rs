//! Reaction wheels: their momenta as functions of time, and their reaction on the body.
//!
//! Wheel k spins about the unit axis a_k of the body, with the moment J_k about it and the speed Ω_k relative to the
//! body. It is symmetric, so that its momentum about its axis, `H_k = J_k (Ω_k + a_k·ω)`, changes by the torque u_k of its
//! motor alone: `H_k' = u_k`. With the inertia I of the body and its wheels, the momentum of all is
//!
//! ```text
//! m = I ω + Σ J_k Ω_k a_k = I* ω + h,   I* = I − Σ J_k a_k a_kᵀ,   h = Σ H_k a_k,
//! ```
//!
//! (P. C. Hughes, Spacecraft Attitude Dynamics, 1986, sec. 6.1; H. Schaub and J. L. Junkins, Analytical Mechanics of Space
//! Systems, sec. 4.5). Torques that depend on time alone make h a known function of time, and `m' = m x ω + N` becomes for
//! `p = I* ω`
//!
//! ```text
//! p' = p x ω + N + h x ω − Σ u_k a_k.
//! ```
//!
//! The last two terms are the torque of the law on a body of the inertia I*. Methods that carry the momentum in space
//! carry that of all, which the wheels do not change. The rotation has the energy `½ ω·I*ω + Σ H_k²/(2 J_k)`.
//!
//! Commanded torques are held from each time to the next. A motor exerts no more than its largest torque, and none that
//! would take H_k beyond J_k times the largest speed: so H_k is piecewise linear.

use crate::error::TorqueError;
use polhode_ga::{Bivector, Rotor, Vector};
use std::array::from_fn;

/// A wheel in the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wheel {
    /// The unit axis in body axes.
    pub axis: Vector,
    /// The moment J about it, in kg m².
    pub inertia: f64,
    /// The largest torque of its motor in N m, infinite without a limit.
    pub max_torque: f64,
    /// The largest `|H|/J` in rad/s, infinite without a limit.
    pub max_speed: f64,
}

/// The momentum of a wheel from a time on, and the torque of its motor, until the next of these.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    from: f64,
    momentum: f64,
    torque: f64,
}

/// Wheels with the commanded torques of their motors.
#[derive(Clone, Debug, PartialEq)]
pub struct Wheels {
    wheels: Vec<Wheel>,
    /// Those of each wheel; the first is at the first time, before which the motors are off.
    pieces: Vec<Vec<Piece>>,
    breaks: Vec<f64>,
}

impl Wheels {
    /// Wheels with speeds relative to a body of this angular velocity at the first time, and rows of torques, one for each wheel, that are held from each time to
    /// the next, the last for ever.
    pub fn new(
        wheels: Vec<Wheel>,
        speeds: &[f64],
        omega: Bivector,
        times: &[f64],
        torques: &[Vec<f64>],
    ) -> Result<Wheels, TorqueError> {
        let wrong = |message: String| Err(TorqueError::new(message));
        if let Some(i) = (1..times.len()).find(|&i| times[i] <= times[i - 1]) {
            let (before, time) = (times[i - 1], times[i]);
            return wrong(format!(
                "times[{i}] = {time} is not after times[{}] = {before}; sort the rows",
                i - 1
            ));
        }
        let momentum =
            |(wheel, speed): (&Wheel, &f64)| wheel.inertia * (speed + wheel.axis.dot(omega.dual()));
        let momenta: Vec<f64> = wheels.iter().zip(speeds).map(momentum).collect();
        for (k, (wheel, momentum)) in wheels.iter().zip(&momenta).enumerate() {
            let speed = momentum.abs() / wheel.inertia;
            if speed > wheel.max_speed * (1.0 + 4.0 * f64::EPSILON) {
                return wrong(format!(
                    "wheel {k} starts at {speed} rad/s in space, beyond its max_speed of {} rad/s",
                    wheel.max_speed
                ));
            }
        }
        Ok(Wheels::from_momenta(wheels, &momenta, times, torques))
    }

    fn from_momenta(wheels: Vec<Wheel>, momenta: &[f64], times: &[f64], torques: &[Vec<f64>]) -> Wheels {
        let each = |k: usize| {
            let own: Vec<f64> = torques.iter().map(|row| row[k]).collect();
            pieces(&wheels[k], momenta[k], times, &own)
        };
        let pieces: Vec<Vec<Piece>> = (0..wheels.len()).map(each).collect();
        let mut breaks: Vec<f64> = pieces.iter().flatten().map(|piece| piece.from).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        Wheels { wheels, pieces, breaks }
    }

    /// The same wheels, whose motors are commanded these torques from a time on.
    pub fn commanded(&self, time: f64, torques: &[f64]) -> Wheels {
        Wheels::from_momenta(self.wheels.clone(), &self.momenta(time), &[time], &[torques.to_vec()])
    }

    /// The number of wheels.
    pub fn count(&self) -> usize {
        self.wheels.len()
    }

    /// The momenta `H_k` about the axes at a time.
    pub fn momenta(&self, time: f64) -> Vec<f64> {
        self.pieces.iter().map(|pieces| momentum(pieces, time)).collect()
    }

    /// The speeds `Ω_k` relative to a body with this angular velocity, at a time.
    pub fn speeds(&self, time: f64, omega: Bivector) -> Vec<f64> {
        let speed =
            |(wheel, momentum): (&Wheel, f64)| momentum / wheel.inertia - wheel.axis.dot(omega.dual());
        self.wheels.iter().zip(self.momenta(time)).map(speed).collect()
    }

    /// `h`, the momentum of the wheels beyond `I* ω`, at a time.
    pub fn momentum(&self, time: f64) -> Bivector {
        let each = self.wheels.iter().zip(&self.pieces);
        each.map(|(wheel, pieces)| axial(wheel.axis * momentum(pieces, time))).fold(Bivector::default(), plus)
    }

    /// `Σ u_k a_k` at the time of a step on the side of its middle.
    fn exerted(&self, middle: f64) -> Bivector {
        let each = self.wheels.iter().zip(&self.pieces);
        let torque = |pieces: &[Piece]| {
            let next = pieces.partition_point(|piece| piece.from <= middle);
            if next == 0 { 0.0 } else { pieces[next - 1].torque }
        };
        each.map(|(wheel, pieces)| axial(wheel.axis * torque(pieces))).fold(Bivector::default(), plus)
    }

    /// The torque on the body, `h x ω − Σ u_k a_k`, at a time of a step whose middle is given.
    pub(crate) fn reaction(&self, omega: Bivector, time: f64, middle: f64) -> Bivector {
        // B A − A B of bivectors is the cross product of their axial vectors.
        omega.commutator(self.momentum(time)) - self.exerted(middle)
    }

    /// `Σ H_k²/(2 J_k)`, in J.
    pub(crate) fn energy(&self, time: f64) -> f64 {
        let each = self.wheels.iter().zip(self.momenta(time));
        each.map(|(wheel, momentum)| 0.5 * momentum * momentum / wheel.inertia).sum()
    }

    /// Ascending times at which a torque of a motor jumps.
    pub(crate) fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// Whether no motor exerts a torque at any time.
    pub(crate) fn is_idle(&self) -> bool {
        self.pieces.iter().flatten().all(|piece| piece.torque == 0.0)
    }

    /// Bounds of the torque of all motors in N m, and of `|h|` up to the last break.
    pub(crate) fn sizes(&self) -> [f64; 2] {
        let most = |of: fn(&Piece) -> f64| -> f64 {
            self.pieces.iter().map(|own| own.iter().map(of).fold(0.0, f64::max)).sum()
        };
        [most(|piece| piece.torque.abs()), most(|piece| piece.momentum.abs())]
    }

    /// The same wheels in other body axes: `a' = ~F a F`.
    pub(crate) fn turned(&self, back: Rotor) -> Wheels {
        let turn = |wheel: &Wheel| Wheel { axis: back.apply(wheel.axis), ..*wheel };
        Wheels { wheels: self.wheels.iter().map(turn).collect(), ..self.clone() }
    }

    /// `Σ J_k a_k a_kᵀ`.
    pub(crate) fn about_axes(&self) -> [[f64; 3]; 3] {
        let entry = |i: usize, j: usize| {
            self.wheels.iter().map(|wheel| wheel.inertia * wheel.axis.0[i] * wheel.axis.0[j]).sum()
        };
        from_fn(|i| from_fn(|j| entry(i, j)))
    }
}

fn axial(Vector(a): Vector) -> Bivector {
    Bivector(a)
}

fn plus(a: Bivector, b: Bivector) -> Bivector {
    a + b
}

fn momentum(pieces: &[Piece], time: f64) -> f64 {
    let next = pieces.partition_point(|piece| piece.from <= time);
    if next == 0 {
        return pieces[0].momentum;
    }
    let piece = &pieces[next - 1];
    // The end of a piece from its own end, so that the limit is met exactly.
    match pieces.get(next) {
        Some(end) if 2.0 * time > piece.from + end.from => end.momentum - piece.torque * (end.from - time),
        _ => piece.momentum + piece.torque * (time - piece.from),
    }
}

/// The pieces of a wheel: commands within the limit of the motor, that end where the wheel reaches its largest speed.
fn pieces(wheel: &Wheel, momentum: f64, times: &[f64], torques: &[f64]) -> Vec<Piece> {
    let largest = wheel.inertia * wheel.max_speed;
    let (mut now, mut found) = (momentum, Vec::with_capacity(times.len()));
    for (i, (&from, &commanded)) in times.iter().zip(torques).enumerate() {
        let torque = commanded.clamp(-wheel.max_torque, wheel.max_torque);
        let end = times.get(i + 1).copied().unwrap_or(f64::INFINITY);
        let limit = largest.copysign(torque);
        // The way to the limit is negative where rounding has passed it.
        let rest = ((limit - now) * torque.signum()).max(0.0);
        let reached = if torque == 0.0 { f64::INFINITY } else { from + rest / torque.abs() };
        if reached <= from {
            found.push(Piece { from, momentum: now, torque: 0.0 });
            continue;
        }
        found.push(Piece { from, momentum: now, torque });
        if reached < end {
            found.push(Piece { from: reached, momentum: limit, torque: 0.0 });
            now = limit;
        } else if end.is_finite() {
            now += torque * (end - from);
        }
    }
    found
}
