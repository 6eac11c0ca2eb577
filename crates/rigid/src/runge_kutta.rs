//! Explicit Runge–Kutta steps on the group of rotors.
//!
//! Within a step from the rotor `R0` the attitude is `R = exp(−½σ) R0` with a bivector σ of space, and
//! `R' = −½Ω_S R` becomes, with the axial vectors of σ and `ω = Ω_S` (the inverse of the exponential's differential,
//! in closed form for rotations),
//!
//! ```text
//! σ' = ω − ½ σ x ω + c(θ) σ x (σ x ω),   c(θ) = (1 − ½θ cot ½θ)/θ²,   θ = |σ|,
//! L' = N_S,   Ω_S = R I⁻¹(~R L R) ~R.
//! ```
//!
//! σ and the angular momentum L *in space* live in vector spaces, where any Runge–Kutta method has its full order
//! (Munthe-Kaas 1999). Whatever the step, |R| = 1, a steady rotation is exact, and what is linear in L is conserved as
//! by the law: L itself without a torque, L about e3 under gravity. A fast top spins in R but its Ω_S and L change
//! slowly, which lets the steps be long.
//!
//! The centre of mass is stepped along where forces move it: `x' = v`, `v' = F/m`.
//!
//! Bodies are stepped side by side in lanes, each by its own step; a single body is lanes of one.

mod tableau;

use crate::classical::{Acting, Bodies, Exert, Place, renormalize};
use crate::force::{Center, Translation};
use crate::phase::{Gyrostat, Phase};
use crate::simulate_error::SimulateError;
use crate::torque::Torque;
use polhode_ga::lanes::{Lanes, One, composed, cross, dot, mapped, mapped_back, matrix};
use polhode_ga::{Bivector, Rotor, Vector};
pub use tableau::{DOP853, Tableau};

/// Beyond this angle in rad of one step the exponential's differential comes near its pole at 2π.
const LARGEST_TURN: f64 = 3.0;

/// A point of the motion as the steps carry it.
#[derive(Clone, Copy, Debug)]
pub struct Carried {
    /// The point.
    pub phase: Phase,
    /// L in space, kg m²/s.
    pub momentum_space: Bivector,
    /// The centre of mass, where forces move it.
    pub center: Center,
}

impl Carried {
    /// From a point of the motion.
    pub fn new(phase: Phase, center: Center) -> Carried {
        Carried { phase, momentum_space: phase.rotor.apply_bivector(phase.momentum), center }
    }
}

/// Where bodies are, side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Points<const W: usize, const F: bool> {
    /// From principal axes to space.
    pub rotor: [Lanes<W, F>; 4],
    /// L in space, kg m²/s.
    pub momentum: [Lanes<W, F>; 3],
    /// Place and velocity of the centre of mass: m and m/s.
    pub center: [Lanes<W, F>; 6],
    /// In s.
    pub time: Lanes<W, F>,
}

impl<const W: usize, const F: bool> Points<W, F> {
    /// Nowhere yet.
    pub const NONE: Self = Points {
        rotor: [Lanes::ZERO; 4],
        momentum: [Lanes::ZERO; 3],
        center: [Lanes::ZERO; 6],
        time: Lanes::ZERO,
    };

    /// Puts a body's point into a lane.
    #[inline(always)]
    pub fn set(&mut self, l: usize, at: &Carried) {
        let (rotor, Center { position, velocity }) = (at.phase.rotor.components(), at.center);
        for k in 0..4 {
            self.rotor[k].0[l] = rotor[k];
        }
        for k in 0..3 {
            self.momentum[k].0[l] = at.momentum_space.0[k];
            self.center[k].0[l] = position.0[k];
            self.center[3 + k].0[l] = velocity.0[k];
        }
        self.time.0[l] = at.phase.time;
    }

    /// The point of a body in a lane.
    #[inline(always)]
    pub fn get(&self, l: usize) -> Carried {
        let [r, m, c] = [&self.rotor[..], &self.momentum, &self.center].map(|lanes| {
            let mut all = [0.0; 6];
            for (x, lanes) in all.iter_mut().zip(lanes) {
                *x = lanes.0[l];
            }
            all
        });
        let rotor = Rotor::from_unit_components([r[0], r[1], r[2], r[3]]);
        let momentum_space = Bivector([m[0], m[1], m[2]]);
        let momentum = rotor.reverse().apply_bivector(momentum_space);
        let center = Center { position: Vector([c[0], c[1], c[2]]), velocity: Vector([c[3], c[4], c[5]]) };
        Carried { phase: Phase { rotor, momentum, time: self.time.0[l] }, momentum_space, center }
    }

    /// Whether all is finite in a lane.
    #[inline(always)]
    pub fn is_finite(&self, l: usize) -> bool {
        let mut sum = 0.0;
        for lanes in self.rotor.iter().chain(&self.momentum).chain(&self.center) {
            sum += 0.0 * lanes.0[l];
        }
        sum == 0.0
    }

    /// Takes over the points of other bodies where the mask says so.
    #[inline(always)]
    pub fn take(&mut self, mask: &[bool; W], other: &Self) {
        for k in 0..4 {
            self.rotor[k] = other.rotor[k].or(mask, self.rotor[k]);
        }
        for k in 0..3 {
            self.momentum[k] = other.momentum[k].or(mask, self.momentum[k]);
        }
        for k in 0..6 {
            self.center[k] = other.center[k].or(mask, self.center[k]);
        }
        self.time = other.time.or(mask, self.time);
    }

    /// The sizes of the angular velocities, rad/s.
    #[inline(always)]
    pub fn rates(&self, bodies: &Bodies<W, F>) -> Lanes<W, F> {
        let momentum = mapped_back(&matrix(&self.rotor), &self.momentum);
        let omega = bodies.omega(&momentum);
        dot(&omega, &omega).sqrt()
    }
}

/// σ and the change of L, of six numbers; of twelve with those of place and velocity.
type Change<const N: usize, const W: usize, const F: bool> = [Lanes<W, F>; N];

/// One step of lengths `h`, which may be negative, and an estimate of its error: half the angle of a turn, or the
/// angular velocity relative to `fastest` (rad/s), whichever is larger; with N = 12 also the velocity relative to the
/// velocity, and the place relative to the distance or the way of the step. NaN where the step is too long to tell.
#[inline(always)]
pub(crate) fn step<const N: usize, const W: usize, const F: bool, E: Exert<W, F>>(
    tableau: &Tableau,
    bodies: &Bodies<W, F>,
    exert: &mut E,
    from: &Points<W, F>,
    h: Lanes<W, F>,
    fastest: Lanes<W, F>,
) -> (Points<W, F>, Lanes<W, F>) {
    let nothing = Lanes::all(f64::NAN);
    let mut slopes = [[Lanes::ZERO; N]; 12];
    let mut widest = Lanes::ZERO;
    for stage in 0..tableau.rows.len() {
        let change = combined(tableau.rows[stage], &slopes, h);
        let turned = part(&change, 0);
        let square = dot(&turned, &turned);
        widest = square.max(widest);
        if !any_within(&square) {
            return (*from, nothing);
        }
        let dt = Lanes::all(tableau.nodes[stage]) * h;
        slopes[stage] = slope(bodies, exert, from, &change, square, dt);
    }
    let change = combined(tableau.weights, &slopes, h);
    let mut to = moved(from, &change, h);
    let turned = part(&change, 0);
    let square = dot(&turned, &turned);
    widest = square.max(widest);
    to.rotor = composed(&exponential(&turned, square).0, &from.rotor);
    renormalize(&mut to.rotor);
    let back = matrix(&from.rotor);
    let fifth = size(bodies, from, &back, &combined(tableau.fifth, &slopes, h), h, fastest);
    let third = size(bodies, from, &back, &combined(tableau.third, &slopes, h), h, fastest);
    // As Hairer's code weighs the two: of order 8 where both are small.
    let square = fifth * fifth;
    let weighed = (third * third).times_plus(Lanes::all(0.01), square).sqrt();
    let mut error = square / weighed;
    for l in 0..W {
        if fifth.0[l] == 0.0 {
            error.0[l] = 0.0;
        }
        if widest.0[l] > LARGEST_TURN * LARGEST_TURN {
            error.0[l] = f64::NAN;
        }
    }
    (to, error)
}

/// Whether any turn, given by its square, is short enough.
#[inline(always)]
fn any_within<const W: usize, const F: bool>(square: &Lanes<W, F>) -> bool {
    let mut any = false;
    for l in 0..W {
        any |= square.0[l] <= LARGEST_TURN * LARGEST_TURN;
    }
    any
}

/// σ' and L' at `from` changed by σ and ΔL.
#[inline(always)]
fn slope<const N: usize, const W: usize, const F: bool, E: Exert<W, F>>(
    bodies: &Bodies<W, F>,
    exert: &mut E,
    from: &Points<W, F>,
    change: &Change<N, W, F>,
    square: Lanes<W, F>,
    dt: Lanes<W, F>,
) -> Change<N, W, F> {
    let turned = part(change, 0);
    let (turn, cotangent) = exponential(&turned, square);
    let rotor = composed(&turn, &from.rotor);
    let at = moved(from, change, dt);
    let axes = matrix(&rotor);
    let momentum = mapped_back(&axes, &at.momentum);
    let omega = bodies.omega(&momentum);
    let place = Place { rotor, omega, time: at.time };
    let omega = mapped(&axes, &omega);
    let first = cross(&turned, &omega);
    let second = cross(&turned, &first);
    let mut slope = [Lanes::ZERO; N];
    for k in 0..3 {
        let straight = first[k].times_plus(Lanes::all(-0.5), omega[k]);
        slope[k] = cotangent.times_plus(second[k], straight);
    }
    if E::ACTS {
        let mut torque = exert.torque(&place);
        for k in 0..3 {
            let carried = momentum[k] - bodies.wheel[k];
            torque[k] = bodies.damping.times_from(carried, torque[k]);
        }
        let torque = mapped(&axes, &torque);
        for k in 0..3 {
            slope[3 + k] = torque[k];
        }
    }
    if N == 12 {
        let acceleration = exert.acceleration(&place, &at.center);
        for k in 0..3 {
            // The place beside that of the uniform motion from the start of the step.
            slope[6 + k] = change[9 + k];
            slope[9 + k] = acceleration[k];
        }
    }
    slope
}

/// How large a change is: in attitude, in angular velocity relative to `fastest`, in velocity relative to the velocity,
/// in place relative to the distance or the way of the step.
#[inline(always)]
fn size<const N: usize, const W: usize, const F: bool>(
    bodies: &Bodies<W, F>,
    at: &Points<W, F>,
    axes: &[[Lanes<W, F>; 3]; 3],
    change: &Change<N, W, F>,
    h: Lanes<W, F>,
    fastest: Lanes<W, F>,
) -> Lanes<W, F> {
    let mut omega = mapped_back(axes, &part(change, 3));
    for k in 0..3 {
        omega[k] = omega[k] * bodies.inverse[k];
    }
    let relative = relative(norm(&omega), fastest);
    let rotation = larger(Lanes::all(0.5) * norm(&part(change, 0)), relative);
    if N < 12 {
        return rotation;
    }
    let [x, y, z, u, v, w] = at.center;
    let (speed, distance) = (norm(&[u, v, w]), norm(&[x, y, z]));
    let way = distance.max(speed * h.abs());
    let place = self::relative(norm(&part(change, 6)), way);
    let velocity = self::relative(norm(&part(change, 9)), speed.max(way / h.abs()));
    larger(rotation, larger(place, velocity))
}

/// `part/whole`, 0 where there is no whole.
#[inline(always)]
fn relative<const W: usize, const F: bool>(part: Lanes<W, F>, whole: Lanes<W, F>) -> Lanes<W, F> {
    let mut ratio = part / whole;
    for l in 0..W {
        ratio.0[l] = if whole.0[l] > 0.0 { ratio.0[l] } else { 0.0 };
    }
    ratio
}

/// The larger of two; NaN where one is.
#[inline(always)]
fn larger<const W: usize, const F: bool>(a: Lanes<W, F>, b: Lanes<W, F>) -> Lanes<W, F> {
    let mut larger = b;
    for l in 0..W {
        // A NaN of b is not less; one of a is no number.
        larger.0[l] = if a.0[l] <= b.0[l] || b.0[l].is_nan() { b.0[l] } else { a.0[l] };
    }
    larger
}

/// Three of the numbers.
#[inline(always)]
fn part<const N: usize, const W: usize, const F: bool>(
    change: &Change<N, W, F>,
    from: usize,
) -> [Lanes<W, F>; 3] {
    [change[from], change[from + 1], change[from + 2]]
}

/// All but the rotor a time dt after `from`.
#[inline(always)]
fn moved<const N: usize, const W: usize, const F: bool>(
    from: &Points<W, F>,
    change: &Change<N, W, F>,
    dt: Lanes<W, F>,
) -> Points<W, F> {
    let mut to = *from;
    to.time = from.time + dt;
    for k in 0..3 {
        to.momentum[k] = from.momentum[k] + change[3 + k];
    }
    if N == 12 {
        for k in 0..3 {
            to.center[k] = from.center[k] + from.center[3 + k].times_plus(dt, change[6 + k]);
            to.center[3 + k] = from.center[3 + k] + change[9 + k];
        }
    }
    to
}

/// `h Σ a_j k_j`.
#[inline(always)]
fn combined<const N: usize, const W: usize, const F: bool>(
    row: &[(usize, f64)],
    slopes: &[Change<N, W, F>; 12],
    h: Lanes<W, F>,
) -> Change<N, W, F> {
    let mut sum = [Lanes::ZERO; N];
    for &(stage, a) in row {
        let (slope, a) = (&slopes[stage], Lanes::all(a));
        for k in 0..N {
            sum[k] = slope[k].times_plus(a, sum[k]);
        }
    }
    for k in 0..N {
        sum[k] = h * sum[k];
    }
    sum
}

/// `exp(−½σ)` and `c(θ)` for `θ² = square`, to a few roundings up to the longest turn.
///
/// With `x = ½θ` and `z = x²` two series have all that is needed, `s = sin x/x` and `p = (s − cos x)/z`:
/// `cos x = s − z p` and `c = (1 − x cot x)/4z = p/4s`. Nothing cancels in `c`. Terms left out are below 1e-19.
#[inline(always)]
fn exponential<const W: usize, const F: bool>(
    turn: &[Lanes<W, F>; 3],
    square: Lanes<W, F>,
) -> ([Lanes<W, F>; 4], Lanes<W, F>) {
    let z = Lanes::all(0.25) * square;
    let (sinc, rest) = (series(&SINC, z), series(&REST, z));
    let cos = z.times_from(rest, sinc);
    let half = Lanes::all(-0.5) * sinc;
    let rotor = [cos, half * turn[0], half * turn[1], half * turn[2]];
    (rotor, Lanes::all(0.25) * rest / sinc)
}

/// Of `sin x/x` by powers of x²: `(−1)ⁿ/(2n+1)!`.
const SINC: [f64; 12] = coefficients(false);

/// Of `(sin x/x − cos x)/x²`: `(−1)ⁿ (2n+2)/(2n+3)!`.
const REST: [f64; 12] = coefficients(true);

const fn coefficients(rest: bool) -> [f64; 12] {
    let mut all = [0.0; 12];
    // (2n+1)!, exact up to 22! and rounded once or twice beyond.
    let (mut n, mut factorial, mut sign) = (0, 1.0, 1.0);
    while n < 12 {
        let next = factorial * ((2 * n + 2) * (2 * n + 3)) as f64;
        all[n] = sign * if rest { (2 * n + 2) as f64 / next } else { 1.0 / factorial };
        (n, factorial, sign) = (n + 1, next, -sign);
    }
    all
}

/// A polynomial in z; adjacent terms are added first, so that many multiplications run at once.
#[inline(always)]
fn series<const W: usize, const F: bool>(c: &[f64; 12], z: Lanes<W, F>) -> Lanes<W, F> {
    let z2 = z * z;
    let z4 = z2 * z2;
    let mut quads = [Lanes::ZERO; 3];
    for (i, quad) in quads.iter_mut().enumerate() {
        let [a, b, c, d] = [
            Lanes::all(c[4 * i]),
            Lanes::all(c[4 * i + 1]),
            Lanes::all(c[4 * i + 2]),
            Lanes::all(c[4 * i + 3]),
        ];
        *quad = z2.times_plus(d.times_plus(z, c), b.times_plus(z, a));
    }
    z4.times_plus(z4.times_plus(quads[2], quads[1]), quads[0])
}

#[inline(always)]
fn norm<const W: usize, const F: bool>(a: &[Lanes<W, F>; 3]) -> Lanes<W, F> {
    dot(a, a).sqrt()
}

/// A body, what turns it, and how it is stepped alone.
#[derive(Clone, Debug)]
pub struct RungeKutta {
    body: Gyrostat,
    torques: Vec<Torque>,
    translation: Option<Translation>,
    alone: Bodies<1, false>,
    tableau: &'static Tableau,
}

impl RungeKutta {
    /// Moments must be positive; torques and forces in principal axes. Without a translation the centre of mass stays.
    pub fn new(
        body: Gyrostat,
        torques: Vec<Torque>,
        translation: Option<Translation>,
        tableau: &'static Tableau,
    ) -> RungeKutta {
        let damping = torques.iter().map(Torque::damping_rate).sum();
        RungeKutta { body, torques, translation, alone: Bodies::new([(body, damping)]), tableau }
    }

    /// The method.
    pub fn tableau(&self) -> &'static Tableau {
        self.tableau
    }

    /// One step of length `h`, which may be negative, and an estimate of its error: half the angle of a turn, or the
    /// angular velocity relative to `fastest` (rad/s), whichever is larger; NaN where the step is too long to tell.
    pub fn step(&self, from: &Carried, h: f64, fastest: f64) -> Result<(Carried, f64), SimulateError> {
        let fastest = Lanes([fastest.max(self.body.least_rate())]);
        let mut at = Points::NONE;
        at.set(0, from);
        let mut acting = Acting::new(&self.body, &self.torques, self.translation.as_ref());
        let (tableau, alone, h): (_, _, One) = (self.tableau, &self.alone, Lanes([h]));
        let (to, error) = match self.translation {
            None => step::<6, 1, false, _>(tableau, alone, &mut acting, &at, h, fastest),
            Some(_) => step::<12, 1, false, _>(tableau, alone, &mut acting, &at, h, fastest),
        };
        match acting.failure {
            Some(failure) => Err(failure),
            None => Ok((to.get(0), error.0[0])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponentials_are_those_of_the_library() {
        for i in 0..=3000 {
            let angle = f64::from(i) * 0.001;
            let turn = [0.6 * angle, 0.0, -0.8 * angle];
            let ([cos, x, y, z], cotangent) = exponential(&One::each(turn), Lanes([angle * angle]));
            let half = 0.5 * angle;
            assert!((cos.0[0] - half.cos()).abs() <= 4.0 * f64::EPSILON, "{angle}");
            let planes = [x, y, z].map(|lanes| lanes.0[0]);
            for (found, part) in planes.into_iter().zip([-0.6, 0.0, 0.8]) {
                assert!((found - part * half.sin()).abs() <= 4.0 * f64::EPSILON, "{angle}");
            }
            // The plain form loses what is 1/θ² of it.
            let plain = (1.0 - half * (half.cos() / half.sin())) / (angle * angle);
            if angle > 0.1 {
                let rounding = 4.0 * f64::EPSILON * (1.0 + 1.0 / (angle * angle));
                assert!((cotangent.0[0] - plain).abs() <= rounding, "{angle}");
            }
        }
        let still = exponential(&[One::ZERO; 3], One::ZERO).1.0[0];
        assert!((still - 1.0 / 12.0).abs() <= f64::EPSILON);
    }
}
