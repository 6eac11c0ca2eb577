//! The classical Runge–Kutta method of order 4 on the components of the rotor and of the angular velocity.
//!
//! In principal axes, with the axial vector ω of Ω_B, `m = I(Ω_B) + h` and a wheel of the momentum h,
//!
//! ```text
//! R' = −½ R Ω_B,      i1 ω1' = (i2 − i3) ω2 ω3 + h2 ω3 − h3 ω2 + N1 − g i1 ω1,   and cyclically,
//! ```
//!
//! With `a = −½ω` in the place of ω, `R' = R A` needs no factor, and `a1' = −2 (i2 − i3)/i1 a2 a3 + …`. Factors of powers of
//! two round nothing, so the bits are those of steps of ω.
//!
//! Each step renormalizes R. Nothing else is conserved by construction. The method has few operations, 134 in a step of
//! a free body, so bodies in lanes stay in registers.

pub(crate) mod parts;

use crate::error::SimulateError;
use crate::laws::force::Translation;
use crate::laws::forcing::{BodyForcing, Forcing, Place};
use crate::laws::torque::lanes::{part, some};
use crate::laws::torque::{Torque, damping_rate};
use crate::state::carried::Carried;
use crate::state::center::Center;
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::simd::lanes::{Lanes, One, PerLane};
use polhode_ga::{Bivector, Rotor};
use std::array;

/// Rotor and angular velocity in principal axes; optionally position and velocity of the centre of mass.
pub(crate) type State<const N: usize, const W: usize, const F: bool> = [Lanes<W, F>; N];

/// Bodies in lanes, in principal axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bodies<const W: usize, const F: bool> {
    /// 1/i_k.
    pub inverse: [Lanes<W, F>; 3],
    /// `−2 (i2 − i3)/i1`, and cyclically.
    coupling: [Lanes<W, F>; 3],
    /// h, in kg m²/s.
    pub wheel: [Lanes<W, F>; 3],
    /// The g of all dampings `−g I(Ω)`, in 1/s.
    pub damping: Lanes<W, F>,
}

impl<const W: usize, const F: bool> Bodies<W, F> {
    /// Bodies with the g of their dampings.
    pub fn new(bodies: [(Gyrostat, f64); W]) -> Bodies<W, F> {
        let mut all = Bodies {
            inverse: [Lanes::ZERO; 3],
            coupling: [Lanes::ZERO; 3],
            wheel: [Lanes::ZERO; 3],
            damping: Lanes::ZERO,
        };
        for (l, (body, damping)) in bodies.into_iter().enumerate() {
            all.set(l, &body, damping);
        }
        all
    }

    /// Puts a body with the g of its dampings into a lane.
    pub fn set(&mut self, l: usize, body: &Gyrostat, damping: f64) {
        for k in 0..3 {
            let [i, j, n] = [0, 1, 2].map(|next| body.moments[(k + next) % 3]);
            self.inverse[k].0[l] = 1.0 / i;
            self.coupling[k].0[l] = -2.0 * ((j - n) / i);
            self.wheel[k].0[l] = body.wheel.0[k];
        }
        self.damping.0[l] = damping;
    }

    /// `P` of the bodies, from `first` on.
    #[inline(always)]
    pub fn part<const P: usize>(&self, first: usize) -> Bodies<P, F> {
        let Bodies { inverse, coupling, wheel, damping } = self;
        Bodies {
            inverse: part(inverse, first),
            coupling: part(coupling, first),
            wheel: part(wheel, first),
            damping: some(damping, first),
        }
    }

    /// `Ω = I⁻¹(m − h)`.
    #[inline(always)]
    pub fn omega(&self, momentum: &[Lanes<W, F>; 3]) -> [Lanes<W, F>; 3] {
        self.omega_with_wheel(momentum, &self.wheel)
    }

    /// The same with this momentum h of wheels.
    #[inline(always)]
    pub fn omega_with_wheel(
        &self,
        momentum: &[Lanes<W, F>; 3],
        wheel: &[Lanes<W, F>; 3],
    ) -> [Lanes<W, F>; 3] {
        let mut omega = *momentum;
        for k in 0..3 {
            omega[k] = (momentum[k] - wheel[k]) * self.inverse[k];
        }
        omega
    }
}

/// The times of the stages of a step.
#[inline(always)]
pub(crate) fn stage_times(time: f64, h: f64) -> [f64; 3] {
    [time, time + 0.5 * h, time + h]
}

/// A state for [`step`], with `a = −½ω` in the place of ω.
#[inline(always)]
pub(crate) fn halved<const N: usize, const W: usize, const F: bool>(y: &State<N, W, F>) -> State<N, W, F> {
    scaled(y, -0.5)
}

/// The inverse of [`halved`].
#[inline(always)]
pub(crate) fn doubled<const N: usize, const W: usize, const F: bool>(y: &State<N, W, F>) -> State<N, W, F> {
    scaled(y, -2.0)
}

#[inline(always)]
fn scaled<const N: usize, const W: usize, const F: bool>(y: &State<N, W, F>, x: f64) -> State<N, W, F> {
    let mut result = *y;
    for k in 4..7 {
        result[k] = y[k] * Lanes::all(x);
    }
    result
}

/// One step of length h, given with `h/6`, of a state with a in the place of ω.
#[inline(always)]
pub(crate) fn step<const N: usize, const W: usize, const F: bool, E: Forcing<W, F>>(
    bodies: &Bodies<W, F>,
    forcing: &mut E,
    y: &mut State<N, W, F>,
    time: f64,
    [h, sixth]: [f64; 2],
) {
    let (half, whole) = (Lanes::all(0.5 * h), Lanes::all(h));
    let (sixth, third) = (Lanes::all(sixth), Lanes::all(sixth + sixth));
    let [begin, middle, end] = stage_times(time, h);
    forcing.begin(Lanes::all(middle));
    let k = slope(bodies, forcing, y, begin);
    let mut sum = moved(y, &k, sixth);
    let k = slope(bodies, forcing, &moved(y, &k, half), middle);
    sum = moved(&sum, &k, third);
    let k = slope(bodies, forcing, &moved(y, &k, half), middle);
    sum = moved(&sum, &k, third);
    let k = slope(bodies, forcing, &moved(y, &k, whole), end);
    sum = moved(&sum, &k, sixth);
    renormalize(&mut sum);
    *y = sum;
}

/// `y + h k`.
#[inline(always)]
fn moved<const N: usize, const W: usize, const F: bool>(
    y: &State<N, W, F>,
    k: &State<N, W, F>,
    h: Lanes<W, F>,
) -> State<N, W, F> {
    let mut sum = *y;
    for i in 0..N {
        sum[i] = k[i].times_plus(h, y[i]);
    }
    sum
}

// Copying lanes one by one keeps them in registers.
#[allow(clippy::manual_memcpy)]
#[inline(always)]
fn slope<const N: usize, const W: usize, const F: bool, E: Forcing<W, F>>(
    bodies: &Bodies<W, F>,
    forcing: &mut E,
    y: &State<N, W, F>,
    time: f64,
) -> State<N, W, F> {
    let mut slope = free_slope(bodies, y);
    let at = place(y, time);
    let mut center = [Lanes::ZERO; 6];
    if N == 13 {
        center.copy_from_slice(&y[7..]);
    }
    if E::ACTS {
        let torque = forcing.torque(&at, &center);
        drive(bodies, E::WHEELS, y, torque, &mut slope);
    }
    if N == 13 {
        let acceleration = forcing.acceleration(&at, &center);
        slope[7..10].copy_from_slice(&y[10..]);
        slope[10..].copy_from_slice(&acceleration);
    }
    slope
}

/// The place of a state, with ω instead of a.
#[inline(always)]
fn place<const N: usize, const W: usize, const F: bool>(y: &State<N, W, F>, time: f64) -> Place<W, F> {
    let minus_two = Lanes::all(-2.0);
    let omega = [y[4] * minus_two, y[5] * minus_two, y[6] * minus_two];
    Place { rotor: [y[0], y[1], y[2], y[3]], omega, time: PerLane::Common(time) }
}

/// The slope of rotor and angular velocity without torque.
#[inline(always)]
fn free_slope<const N: usize, const W: usize, const F: bool>(
    bodies: &Bodies<W, F>,
    y: &State<N, W, F>,
) -> State<N, W, F> {
    let a = [y[4], y[5], y[6]];
    let mut slope = *y;
    slope[..4].copy_from_slice(&turn(&[y[0], y[1], y[2], y[3]], a));
    let products = [a[1] * a[2], a[2] * a[0], a[0] * a[1]];
    for k in 0..3 {
        slope[4 + k] = bodies.coupling[k] * products[k];
    }
    slope
}

/// Adds the effect of a torque, of wheels where there may be some, and of damping.
#[inline(always)]
fn drive<const N: usize, const W: usize, const F: bool>(
    bodies: &Bodies<W, F>,
    wheels: bool,
    y: &State<N, W, F>,
    mut torque: [Lanes<W, F>; 3],
    slope: &mut State<N, W, F>,
) {
    let (minus_two, minus_half) = (Lanes::all(-2.0), Lanes::all(-0.5));
    let a = [y[4], y[5], y[6]];
    if wheels {
        let w = [a[0] * minus_two, a[1] * minus_two, a[2] * minus_two];
        let h = bodies.wheel;
        torque[0] += h[2].times_from(w[1], h[1] * w[2]);
        torque[1] += h[0].times_from(w[2], h[2] * w[0]);
        torque[2] += h[1].times_from(w[0], h[0] * w[1]);
    }
    for k in 0..3 {
        let driven = torque[k].times_plus(bodies.inverse[k] * minus_half, slope[4 + k]);
        slope[4 + k] = bodies.damping.times_from(a[k], driven);
    }
}

/// `R B` for a bivector B.
#[inline(always)]
fn turn<const W: usize, const F: bool>(
    [s, x, y, z]: &[Lanes<W, F>; 4],
    [a, b, c]: [Lanes<W, F>; 3],
) -> [Lanes<W, F>; 4] {
    [
        z.times_from(c, y.times_from(b, -(*x * a))),
        y.times_from(c, z.times_plus(b, *s * a)),
        z.times_from(a, x.times_plus(c, *s * b)),
        x.times_from(b, y.times_plus(a, *s * c)),
    ]
}

/// `R/|R|` to third order in |R|² − 1.
#[inline(always)]
pub(crate) fn renormalize<const N: usize, const W: usize, const F: bool>(y: &mut State<N, W, F>) {
    let mut square = y[0] * y[0];
    for k in 1..4 {
        square = y[k].times_plus(y[k], square);
    }
    let excess = square - Lanes::all(1.0);
    // Adding rounds shrinking and growing alike; multiplying by 1 + x would not.
    let missing = excess * excess.times_plus(Lanes::all(0.375), Lanes::all(-0.5));
    for k in 0..4 {
        y[k] = y[k].times_plus(missing, y[k]);
    }
}

/// A single body and its laws, stepped by the classical method.
#[derive(Clone, Debug)]
pub struct Classical {
    body: Gyrostat,
    torques: Vec<Torque>,
    translation: Option<Translation>,
    alone: Bodies<1, false>,
}

impl Classical {
    /// Moments must be positive; torques and forces in principal axes. Without a translation the centre of mass stays.
    pub fn new(body: Gyrostat, torques: Vec<Torque>, translation: Option<Translation>) -> Classical {
        let alone = Bodies::new([(body, damping_rate(&torques))]);
        Classical { body, torques, translation, alone }
    }

    /// One step of length `h`, which may be negative.
    pub fn step(&self, from: &Carried, h: f64) -> Result<Carried, SimulateError> {
        if self.translation.is_none() { self.step_of::<7>(from, h) } else { self.step_of::<13>(from, h) }
    }

    fn step_of<const N: usize>(&self, from: &Carried, h: f64) -> Result<Carried, SimulateError> {
        let (Phase { rotor, momentum, time }, Center { position, velocity }) = (from.phase, from.center);
        let (rotor, omega) = (rotor.components(), self.body.omega(momentum));
        let mut numbers = rotor.into_iter().chain(omega.0).chain(position.0).chain(velocity.0);
        let state = One::each(array::from_fn(|_| numbers.next().unwrap_or_default()));
        let mut state = halved(&state);
        let mut acting = BodyForcing::new(&self.body, &self.torques, self.translation.as_ref());
        step::<N, 1, false, _>(&self.alone, &mut acting, &mut state, time, [h, h / 6.0]);
        acting.finish()?;
        let state = One::alone(doubled(&state));
        let center = state[7..].try_into().map_or(from.center, |numbers: [f64; 6]| Center::from(numbers));
        Ok(Carried::new(phase(&self.body, &state, time + h), center))
    }
}

/// The point of a motion at rotor and angular velocity in principal axes.
pub(crate) fn phase(body: &Gyrostat, state: &[f64], time: f64) -> Phase {
    let omega = Bivector([state[4], state[5], state[6]]);
    let rotor = Rotor::from_unit_components([state[0], state[1], state[2], state[3]]);
    Phase { rotor, momentum: body.momentum(omega), time }
}
