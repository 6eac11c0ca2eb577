//! Rotations and kicks of a splitting, for bodies in lanes; a single body is one lane.

use crate::laws::forcing::{Forcing, Place};
use crate::methods::classical::{Bodies, renormalize};
use crate::numerics::sinc::cosine_and_sinc;
use crate::state::phase::{Gyrostat, Phase};
use polhode_ga::simd::lanes::{Lanes, One, PerLane, composed, cross, dot, mapped, matrix};
use polhode_ga::{Bivector, Rotor};

/// Rotors and momenta in principal axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spin<const W: usize, const F: bool> {
    pub rotor: [Lanes<W, F>; 4],
    pub momentum: [Lanes<W, F>; 3],
    /// Accumulated rounding of the kicks, added to the next one (Kahan 1965). Otherwise a steady torque would be rounded
    /// alike in every step, and the error would grow as the number of steps instead of its root.
    pub lost: [Lanes<W, F>; 3],
}

impl Spin<1, false> {
    /// Of a single body.
    pub fn alone(state: &Phase, lost: Bivector) -> Spin<1, false> {
        let rotor = One::each(state.rotor.components());
        Spin { rotor, momentum: One::each(state.momentum.0), lost: One::each(lost.0) }
    }

    pub fn one_rotor(&self) -> Rotor {
        Rotor::from_unit_components(One::alone(self.rotor))
    }

    pub fn one_momentum(&self) -> Bivector {
        Bivector(One::alone(self.momentum))
    }
}

/// A turn of a splitting: about the axis a or b, or about that of a wheel.
#[derive(Clone, Copy, Debug)]
enum Turn {
    About(usize),
    AboutWheel,
}

/// Bodies of one kind are turned about the same axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kind {
    /// a and b, and the one that is left out.
    axes: [usize; 3],
    symmetric: bool,
    wheel: bool,
}

impl Kind {
    pub fn of(body: &Gyrostat) -> Kind {
        let mut order = [0, 1, 2];
        order.sort_by(|&x, &y| body.moments[x].total_cmp(&body.moments[y]));
        let [a, p, b] = order;
        // A symmetric body does not turn about the second axis.
        let [a, b] = if kappa(body, a, p) == 0.0 { [b, a] } else { [a, b] };
        let wheel = body.wheel.0 != [0.0; 3];
        Kind { axes: [a, b, p], symmetric: kappa(body, b, p) == 0.0, wheel }
    }

    /// The turns other than that about L, each with its part of a step.
    fn order(self) -> &'static [(Turn, f64)] {
        use Turn::{About, AboutWheel};
        match (self.wheel, self.symmetric) {
            (true, _) => {
                &[(About(0), 0.5), (About(1), 0.5), (AboutWheel, 1.0), (About(1), 0.5), (About(0), 0.5)]
            }
            (false, true) => &[(About(0), 1.0)],
            (false, false) => &[(About(0), 0.5), (About(1), 1.0), (About(0), 0.5)],
        }
    }

    /// Whether one turn about an axis suffices.
    pub fn is_symmetric(self) -> bool {
        self.symmetric && !self.wheel
    }
}

/// `1/i_k − 1/i_p`, without subtracting nearly equal quotients.
fn kappa(body: &Gyrostat, k: usize, p: usize) -> f64 {
    let i = body.moments;
    (i[p] - i[k]) / (i[p] * i[k])
}

/// Kicks and turns of bodies of one kind.
#[derive(Clone, Debug)]
pub(crate) struct Turns<const W: usize, const F: bool> {
    kind: Kind,
    /// κ_a and κ_b; 1/i_p; `−I⁻¹h` of wheels.
    kappa: [Lanes<W, F>; 2],
    middle: Lanes<W, F>,
    against_wheel: [Lanes<W, F>; 3],
    /// For kicks.
    bodies: Bodies<W, F>,
    damped: bool,
    /// L, if it is constant.
    fixed: Option<Fixed<W, F>>,
}

/// L in space with its square and the inverse of that, 0 for L = 0.
#[derive(Clone, Copy, Debug)]
struct Fixed<const W: usize, const F: bool> {
    momentum: [Lanes<W, F>; 3],
    square: Lanes<W, F>,
    inverse: Lanes<W, F>,
}

impl<const W: usize, const F: bool> Turns<W, F> {
    /// From bodies of one kind, their damping g, and L in space if constant, which it is for all or none.
    pub fn new(bodies: [(Gyrostat, f64, Option<[f64; 3]>); W]) -> Turns<W, F> {
        let kind = Kind::of(&bodies[0].0);
        let [a, b, p] = kind.axes;
        let zero = Lanes::ZERO;
        let mut turns = Turns {
            kind,
            kappa: [zero; 2],
            middle: zero,
            against_wheel: [zero; 3],
            bodies: Bodies::new(bodies.map(|(body, damping, _)| (body, damping))),
            damped: bodies.iter().any(|(_, damping, _)| *damping != 0.0),
            fixed: None,
        };
        for (l, (body, _, fixed)) in bodies.iter().enumerate() {
            turns.kappa[0].0[l] = kappa(body, a, p);
            turns.kappa[1].0[l] = kappa(body, b, p);
            turns.middle.0[l] = 1.0 / body.moments[p];
            for k in 0..3 {
                turns.against_wheel[k].0[l] = -body.wheel.0[k] / body.moments[k];
            }
            if let Some(momentum) = fixed {
                let none = Fixed { momentum: [zero; 3], square: zero, inverse: zero };
                let all = turns.fixed.get_or_insert(none);
                let square: f64 = momentum.iter().map(|x| x * x).sum();
                all.square.0[l] = square;
                all.inverse.0[l] = if square > 0.0 { 1.0 / square } else { 0.0 };
                for k in 0..3 {
                    all.momentum[k].0[l] = momentum[k];
                }
            }
        }
        turns
    }

    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// One step of length h by kicks and drifts in turn, as fractions of it, and a kick after the last.
    #[inline(always)]
    pub fn step<E: Forcing<W, F>>(
        &self,
        (stages, last): (&[(f64, f64)], f64),
        forcing: &mut E,
        spin: &mut Spin<W, F>,
        time: f64,
        h: f64,
    ) {
        forcing.begin(Lanes::all(time + 0.5 * h));
        // A turn about a constant L commutes with the rest of the step.
        if self.fixed.is_some() {
            self.about_momentum(spin, h);
        }
        let mut now = time;
        for k in 0..=stages.len() {
            let (kick, drift) = if k < stages.len() { stages[k] } else { (last, 0.0) };
            if self.fixed.is_none() {
                self.kick(forcing, spin, now, kick * h);
            }
            if k < stages.len() {
                if self.fixed.is_none() {
                    self.about_momentum(spin, drift * h);
                }
                self.about_axes(spin, drift * h);
                now += drift * h;
            }
        }
        self.finish(spin);
    }

    /// Removes the rounding of a step from |R|, and if L is constant from |m| and the direction of `R m ~R`, to first
    /// order. The direction of m is unchanged, so a zero component on an unstable axis stays zero.
    #[inline(always)]
    pub fn finish(&self, spin: &mut Spin<W, F>) {
        renormalize(&mut spin.rotor);
        let Some(fixed) = &self.fixed else { return };
        let m = &mut spin.momentum;
        // Adding rounds shrinking and growing alike; multiplying by 1 + x would not.
        let half = Lanes::all(0.5) * fixed.inverse;
        let missing = (fixed.square - dot(m, m)) * half;
        for k in 0..3 {
            m[k] = m[k].times_plus(missing, m[k]);
        }
        let drifted = mapped(&matrix(&spin.rotor), m);
        // exp(−½ a∧b/|a||b|) turns the axial vector a into b; the first term suffices for so small a turn.
        let [x, y, z] = cross(&fixed.momentum, &drifted);
        let turn = [Lanes::all(1.0), x * half, y * half, z * half];
        spin.rotor = composed(&turn, &spin.rotor);
    }

    /// Solves `m' = N − g (m − h)` for a time t: `m − h` becomes `(m − h) e^(−gt) + N (1 − e^(−gt))/g`.
    #[inline(always)]
    pub fn kick<E: Forcing<W, F>>(&self, forcing: &mut E, spin: &mut Spin<W, F>, time: f64, h: f64) {
        let m = &mut spin.momentum;
        let omega = self.bodies.omega(m);
        let place = Place { rotor: spin.rotor, omega, time: PerLane::Common(time) };
        let torque = forcing.torque(&place, &[Lanes::ZERO; 6]);
        let mut impulse = Lanes::all(h);
        if self.damped {
            let lost;
            (lost, impulse) = decayed(&self.bodies.damping, h);
            for k in 0..3 {
                // Multiplying m by e^(−gt) would round alike at every step.
                m[k] = (m[k] - self.bodies.wheel[k]).times_plus(lost, m[k]);
            }
        }
        for k in 0..3 {
            let kick = torque[k].times_plus(impulse, spin.lost[k]);
            let sum = m[k] + kick;
            spin.lost[k] = kick - (sum - m[k]);
            m[k] = sum;
        }
    }

    /// The turn of all bodies about their L, which commutes with the other turns.
    #[inline(always)]
    pub fn about_momentum(&self, spin: &mut Spin<W, F>, h: f64) {
        let m = &spin.momentum;
        let half = self.middle * Lanes::all(0.5 * h);
        let (cos, sinc) = cosine_and_sinc(half * half * dot(m, m));
        let factor = -(half * sinc);
        let turn = [cos, m[0] * factor, m[1] * factor, m[2] * factor];
        spin.rotor = composed(&spin.rotor, &turn);
    }

    /// The other turns, in a loop so that their code is inlined once.
    #[inline(always)]
    pub fn about_axes(&self, spin: &mut Spin<W, F>, h: f64) {
        for &(which, part) in self.kind.order() {
            match which {
                Turn::About(which) => self.about_axis(spin, which, part * h),
                Turn::AboutWheel => self.about_wheel(spin, part * h),
            }
        }
    }

    #[inline(always)]
    fn about_wheel(&self, spin: &mut Spin<W, F>, h: f64) {
        let half = Lanes::all(-0.5 * h);
        let w = &self.against_wheel;
        let (cos, sinc) = cosine_and_sinc(half * half * dot(w, w));
        let factor = half * sinc;
        let turn = [cos, w[0] * factor, w[1] * factor, w[2] * factor];
        spin.rotor = composed(&spin.rotor, &turn);
        // ~q m q. The turn has the same rounding error in every step of one length. Adding the change, instead of mapping m,
        // multiplies |q|² − 1 by the small change only, so that the error does not grow with the number of steps.
        let v = [turn[1], turn[2], turn[3]];
        let once = cross(&v, &spin.momentum);
        let twice = cross(&v, &once);
        for k in 0..3 {
            let half_the_change = once[k].times_plus(cos, twice[k]);
            spin.momentum[k] += half_the_change + half_the_change;
        }
    }

    #[inline(always)]
    fn about_axis(&self, spin: &mut Spin<W, F>, which: usize, h: f64) {
        let rate = self.kappa[which] * Lanes::all(0.5 * h);
        // The axes k, i, j are cyclic; a match lets the compiler see them.
        match self.kind.axes[which] {
            0 => turn_about::<0, 1, 2, W, F>(spin, rate),
            1 => turn_about::<1, 2, 0, W, F>(spin, rate),
            _ => turn_about::<2, 0, 1, W, F>(spin, rate),
        }
    }
}

/// `R ← R q`, `m ← ~q m q` with `q = exp(−half I e_k)`, `half = rate m_k`, written out.
#[inline(always)]
fn turn_about<const K: usize, const I: usize, const J: usize, const W: usize, const F: bool>(
    spin: &mut Spin<W, F>,
    rate: Lanes<W, F>,
) {
    let half = rate * spin.momentum[K];
    let (cos, sinc) = cosine_and_sinc(half * half);
    let sin = half * sinc;
    let r = spin.rotor;
    spin.rotor[0] = r[K + 1].times_plus(sin, r[0] * cos);
    spin.rotor[K + 1] = r[0].times_from(sin, r[K + 1] * cos);
    spin.rotor[I + 1] = r[J + 1].times_plus(sin, r[I + 1] * cos);
    spin.rotor[J + 1] = r[I + 1].times_from(sin, r[J + 1] * cos);
    // ~q m q turns the other two components by −2 half. Adding the change avoids the constant stretch of rounded cosines
    // and sines in every step of a steady motion.
    let two = sin + sin;
    let (versine, sine) = (two * sin, two * cos);
    let (x, y) = (spin.momentum[I], spin.momentum[J]);
    spin.momentum[I] = x + versine.times_from(x, sine * y);
    spin.momentum[J] = y - versine.times_plus(y, sine * x);
}

/// The times of the kicks of a step.
pub(crate) fn stage_times(
    (stages, _): (&[(f64, f64)], f64),
    time: f64,
    h: f64,
) -> impl Iterator<Item = f64> + Clone {
    let mut now = time;
    let later = stages.iter().map(move |&(_, drift)| {
        now += drift * h;
        now
    });
    std::iter::once(time).chain(later)
}

/// `e^(−gh) − 1`, and the impulse per torque, `(1 − e^(−gh))/g`.
#[inline(always)]
fn decayed<const W: usize, const F: bool>(damping: &Lanes<W, F>, h: f64) -> (Lanes<W, F>, Lanes<W, F>) {
    let (mut lost, mut impulse) = (Lanes::ZERO, Lanes::all(h));
    for l in 0..W {
        let decay = -damping.0[l] * h;
        if l > 0 && damping.0[l] == damping.0[0] {
            (lost.0[l], impulse.0[l]) = (lost.0[0], impulse.0[0]);
        } else if decay != 0.0 {
            lost.0[l] = decay.exp_m1();
            impulse.0[l] = h * lost.0[l] / decay;
        }
    }
    (lost, impulse)
}
