//! States at any time: phases, series, and the frames between which they stand.

use super::lanes::{Phase, sin_cos_turns};
use super::series::{Circular, Hyperbolic, Series, State};
use polhode_ga::Rotor;
use polhode_ga::curve::Curve;

/// Rotor and angular velocity as functions of time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flow<S> {
    /// Of time.
    pub scale: f64,
    /// v.
    pub orbit: Phase,
    /// νt/2.
    pub precession: Phase,
    pub series: S,
    /// Rotor components of what turns the quaternion units of (e1, e2, d) into space and into body axes.
    pub rotor: [[f64; 4]; 4],
    /// Components of the angular velocity in body axes for cn, sn and dn.
    pub omega: [[f64; 3]; 3],
}

/// In one form or the other.
#[derive(Clone, Copy, Debug)]
pub(super) enum AnyFlow {
    Circular(Flow<Circular>),
    Hyperbolic(Flow<Hyperbolic>),
}

impl<S: Series> Flow<S> {
    /// `exp(½νt) Z`, up to its norm, as quaternion components; and the state.
    #[inline(always)]
    fn turned<const W: usize, const FMA: bool>(&self, times: &[f64; W]) -> ([[f64; W]; 4], State<W>) {
        let (mut v, mut v_rest, mut angle, mut angle_rest) = ([0.0; W], [0.0; W], [0.0; W], [0.0; W]);
        for l in 0..W {
            let t = times[l] * self.scale;
            (v[l], v_rest[l]) = self.orbit.turns::<FMA>(t);
            (angle[l], angle_rest[l]) = self.precession.turns::<FMA>(t);
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

    /// Sets the frames: `units` are the rotors that stand for the quaternion units of (e1, e2, d).
    pub fn with_frames(mut self, start: Rotor, units: [Rotor; 4], to_body: Rotor) -> Flow<S> {
        let (z, _) = self.turned::<1, false>(&[0.0]);
        let sum = |i: usize| (0..4).map(|k| z[k][0] * units[k].components()[i]).sum();
        let first = Rotor::from_components(std::array::from_fn(sum)).unwrap_or(Rotor::IDENTITY);
        let to_space = start * first.reverse();
        let columns = units.map(|unit| (to_space * unit * to_body).components());
        self.rotor = std::array::from_fn(|i| columns.map(|c| c[i]));
        self
    }
}

impl<S: Series> Curve<4, 3> for Flow<S> {
    #[inline(always)]
    fn values<const W: usize, const FMA: bool>(&self, times: &[f64; W]) -> ([[f64; W]; 4], [[f64; W]; 3]) {
        let (z, state) = self.turned::<W, FMA>(times);
        let (mut rotor, mut omega) = ([[0.0; W]; 4], [[0.0; W]; 3]);
        for l in 0..W {
            let r = self.rotor.map(|m| (m[0] * z[0][l] + m[1] * z[1][l]) + (m[2] * z[2][l] + m[3] * z[3][l]));
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
                let [x, y, z] = self.omega[k];
                omega[k][l] = (x * f[0] + y * f[1]) + z * f[2];
            }
        }
        (rotor, omega)
    }
}
