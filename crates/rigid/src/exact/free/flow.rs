//! States of a free motion at any time: phases, series and frames.
//!
//! A flow holds coefficients of one motion, with times in the lanes, or of `C` motions, one in each lane. Both give the
//! same bits.

use super::series::{Circular, Hyperbolic, Series, State};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::lanes::{Phase, in_lane, sin_cos_turns};
use polhode_ga::Rotor;
use polhode_ga::rows::curve::Curve;

/// Rotor and angular velocity as functions of time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flow<S, const C: usize = 1> {
    /// Of time.
    pub scale: [f64; C],
    /// v.
    pub orbit: Phases<C>,
    /// νt/2.
    pub precession: Phases<C>,
    pub series: S,
    /// Rotor components that take the quaternion units of (e1, e2, d) to space and body axes.
    pub rotor: [[[f64; C]; 4]; 4],
    /// Components of the angular velocity in body axes for cn, sn and dn.
    pub omega: [[[f64; C]; 3]; 3],
}

/// A flow in either form.
#[derive(Clone, Copy, Debug)]
pub(super) enum AnyFlow {
    Circular(Flow<Circular>),
    Hyperbolic(Flow<Hyperbolic>),
}

/// The [`Phase`] of each motion by numbers: two of the rate, two of the start.
#[derive(Clone, Copy, Debug)]
pub(super) struct Phases<const C: usize>([[f64; C]; 4]);

impl<const C: usize> Phases<C> {
    #[inline(always)]
    fn of(&self, l: usize) -> Phase {
        let rate = DoubleDouble { hi: in_lane(&self.0[0], l), lo: in_lane(&self.0[1], l) };
        Phase { rate, start: [in_lane(&self.0[2], l), in_lane(&self.0[3], l)] }
    }
}

impl From<Phase> for Phases<1> {
    fn from(Phase { rate, start }: Phase) -> Phases<1> {
        Phases([[rate.hi], [rate.lo], [start[0]], [start[1]]])
    }
}

impl<S: Series<C>, const C: usize> Flow<S, C> {
    /// Zero coefficients in all lanes.
    pub fn empty() -> Flow<S, C> {
        let none = [0.0; C];
        let still = Phases([none; 4]);
        Flow {
            scale: none,
            orbit: still,
            precession: still,
            series: S::empty(),
            rotor: [[none; 4]; 4],
            omega: [[none; 3]; 3],
        }
    }

    /// Puts a motion into lane l.
    pub fn put(&mut self, l: usize, motion: &Flow<S::One>) {
        let mut motion = *motion;
        self.coefficients().zip(motion.coefficients()).for_each(|(lanes, one)| lanes[l] = one[0]);
    }

    /// The motion in lane l.
    pub fn take(mut self, l: usize) -> Flow<S::One> {
        let mut motion = Flow::empty();
        motion.coefficients().zip(self.coefficients()).for_each(|(one, lanes)| *one = [lanes[l]]);
        motion
    }

    fn coefficients(&mut self) -> impl Iterator<Item = &mut [f64; C]> {
        let phases = self.orbit.0.iter_mut().chain(&mut self.precession.0);
        let frames = self.rotor.as_flattened_mut().iter_mut().chain(self.omega.as_flattened_mut());
        phases.chain([&mut self.scale]).chain(frames).chain(self.series.coefficients())
    }

    /// `exp(½νt) Z`, up to its norm, as quaternion components; and the state.
    #[inline(always)]
    fn turned<const W: usize, const FMA: bool>(&self, times: &[f64; W]) -> ([[f64; W]; 4], State<W>) {
        let (mut v, mut v_rest, mut angle, mut angle_rest) = ([0.0; W], [0.0; W], [0.0; W], [0.0; W]);
        for l in 0..W {
            let t = times[l] * in_lane(&self.scale, l);
            (v[l], v_rest[l]) = self.orbit.of(l).turns::<FMA>(t);
            (angle[l], angle_rest[l]) = self.precession.of(l).turns::<FMA>(t);
        }
        let state = self.series.state::<W, FMA>(&v, &v_rest);
        let mut z = [[0.0; W]; 4];
        for l in 0..W {
            let (sin, cos) = sin_cos_turns::<FMA>(angle[l] + state.ahead[l], angle_rest[l]);
            let [z0, z1, z2, z3] = state.z.each_ref().map(|z| z[l]);
            z[0][l] = cos * z0 - sin * z3;
            z[1][l] = cos * z1 - sin * z2;
            z[2][l] = cos * z2 + sin * z1;
            z[3][l] = cos * z3 + sin * z0;
        }
        (z, state)
    }
}

impl<S: Series<1>> Flow<S> {
    /// Sets the frames: `units` are the rotors that stand for the quaternion units of (e1, e2, d).
    pub fn with_frames(mut self, start: Rotor, units: [Rotor; 4], to_body: Rotor) -> Flow<S> {
        let (z, _) = self.turned::<1, false>(&[0.0]);
        let sum = |i: usize| (0..4).map(|k| z[k][0] * units[k].components()[i]).sum();
        let first = Rotor::from_components(std::array::from_fn(sum)).unwrap_or(Rotor::IDENTITY);
        let to_space = start * first.reverse();
        let columns = units.map(|unit| (to_space * unit * to_body).components());
        self.rotor = std::array::from_fn(|i| columns.map(|c| [c[i]]));
        self
    }
}

impl<S: Series<C>, const C: usize> Curve<4, 3> for Flow<S, C> {
    #[inline(always)]
    fn values<const W: usize, const FMA: bool>(&self, times: &[f64; W]) -> ([[f64; W]; 4], [[f64; W]; 3]) {
        let (z, state) = self.turned::<W, FMA>(times);
        let (mut rotor, mut omega) = ([[0.0; W]; 4], [[0.0; W]; 3]);
        for l in 0..W {
            let mut r = [0.0; 4];
            for k in 0..4 {
                let [a, b, c, d] = &self.rotor[k];
                r[k] = (in_lane(a, l) * z[0][l] + in_lane(b, l) * z[1][l])
                    + (in_lane(c, l) * z[2][l] + in_lane(d, l) * z[3][l]);
            }
            let square = (r[0] * r[0] + r[1] * r[1]) + (r[2] * r[2] + r[3] * r[3]);
            let factor = 1.0 / square.sqrt();
            for k in 0..4 {
                rotor[k][l] = r[k] * factor;
            }
        }
        for l in 0..W {
            let factor = 1.0 / state.denominator[l];
            let f = state.functions.each_ref().map(|f| f[l] * factor);
            for k in 0..3 {
                let [x, y, z] = &self.omega[k];
                omega[k][l] = (in_lane(x, l) * f[0] + in_lane(y, l) * f[1]) + in_lane(z, l) * f[2];
            }
        }
        (rotor, omega)
    }
}
