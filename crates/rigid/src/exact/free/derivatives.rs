//! Derivatives of the flow of the free top in closed form.
//!
//! The variation of the rotor is a small bivector ε in space axes, `δR = −½ ε R`. A variation of the start's attitude
//! adds to ε unchanged. For the others L is constant: from `L = R m`, `m = I(Ω_B)`, in components of axial vectors,
//!
//! ```text
//! ε x L + R δm = R(0) δm(0)   ⇒   ε_⊥ = L x (R(0) δm(0) − R δm)/G².
//! ```
//!
//! Along L the rate is `ε' = R δω`, so `G ε_∥' = m·δω`. As the energy's change `δE = m·δω + ½ Σ ω_k² δi_k` is
//! constant,
//!
//! ```text
//! G ε_∥ = t δE − ½ Σ δi_k ∫ω_k² dt.
//! ```
//!
//! [`super::variation`] derives δω and the integrals of ω².

use super::variation::{Form, Tumbling, steady};
use super::{FreeMotion, power_of_two};
use polhode_ga::{Bivector, Rotor};
use std::array::from_fn;

/// Derivatives of rotor (four components) and body angular velocity (three), rows by component. Columns: a turn ε of the
/// initial attitude in space axes, `exp(−½ε) R(0)`; the initial angular velocity in body axes; the principal moments,
/// with the principal axes fixed in the body.
#[derive(Clone, Copy, Debug, Default)]
#[allow(missing_docs)]
pub struct FlowDerivatives {
    pub rotor_by_attitude: [[f64; 3]; 4],
    pub rotor_by_omega: [[f64; 3]; 4],
    pub rotor_by_moments: [[f64; 3]; 4],
    pub rotor_by_time: [f64; 4],
    pub omega_by_omega: [[f64; 3]; 3],
    pub omega_by_moments: [[f64; 3]; 3],
    pub omega_by_time: [f64; 3],
}

impl FlowDerivatives {
    /// Whether all derivatives are finite.
    pub fn is_finite(&self) -> bool {
        let rotor = [&self.rotor_by_attitude, &self.rotor_by_omega, &self.rotor_by_moments];
        let omega = [&self.omega_by_omega, &self.omega_by_moments];
        let mut matrices = rotor.into_iter().flatten().chain(omega.into_iter().flatten()).flatten();
        matrices.all(|x| x.is_finite())
            && self.rotor_by_time.iter().chain(&self.omega_by_time).all(|x| x.is_finite())
    }
}

/// A free motion prepared for derivatives.
#[derive(Clone, Debug)]
pub struct Differentiated {
    motion: FreeMotion,
    /// Power of two near the moments.
    size: f64,
    /// The motion in principal axes, from attitude 1, with moments and rates near 1.
    unit: FreeMotion,
    tumbling: Option<Box<Tumbling>>,
}

impl FreeMotion {
    /// Prepares derivatives at any time.
    pub fn differentiated(&self) -> Differentiated {
        let size = power_of_two(self.moments);
        let moments = self.moments.map(|i| i / size);
        let unit = FreeMotion::in_principal_axes(moments, Rotor::IDENTITY, self.omega / self.scale);
        Differentiated { motion: *self, size, unit, tumbling: Tumbling::new(&unit) }
    }
}

impl Differentiated {
    /// At time `t` in s. Not finite if a change of an unstable motion has grown beyond floating point.
    pub fn at(&self, t: f64) -> FlowDerivatives {
        let FreeMotion { frame, scale, .. } = self.motion;
        let (rotor, omega) = self.motion.at(t);
        let (turn, change, rate) = self.in_principal_axes(t * scale);

        // From the unit motion to this one, and to body axes.
        let by_rate = |forms: [Form; 3], factor: f64| {
            let columns: [_; 3] = from_fn(|k| frame.apply_bivector(Bivector(forms.map(|f| f.0[k]))));
            let rows: [[f64; 3]; 3] = from_fn(|i| columns.map(|c| c.0[i] * factor));
            rows.map(|row| frame.apply_bivector(Bivector(row)).0)
        };
        let by_moment = |forms: [Form; 3], factor: f64| {
            let columns: [_; 3] = from_fn(|k| frame.apply_bivector(Bivector(forms.map(|f| f.0[k + 3]))));
            from_fn(|i| columns.map(|c| c.0[i] * factor))
        };
        let turned = |turns: [[f64; 3]; 3]| {
            let columns: [_; 3] = from_fn(|j| body_turn(rotor, Bivector(turns.map(|row| row[j]))));
            from_fn(|i| columns.map(|c| c[i]))
        };
        let axis = |j: usize| Bivector(from_fn(|k| f64::from(j == k)));
        let attitude: [_; 3] = from_fn(|j| body_turn(rotor, rotor.reverse().apply_bivector(axis(j))));
        FlowDerivatives {
            rotor_by_attitude: from_fn(|i| attitude.map(|c| c[i])),
            rotor_by_omega: turned(by_rate(turn, 1.0 / scale)),
            rotor_by_moments: turned(by_moment(turn, 1.0 / self.size)),
            rotor_by_time: body_turn(rotor, omega),
            omega_by_omega: by_rate(change, 1.0),
            omega_by_moments: by_moment(change, scale / self.size),
            omega_by_time: frame.apply_bivector(Bivector(rate) * scale * scale).0,
        }
    }

    /// The turn ε in the body, δω and ω' of the unit motion.
    fn in_principal_axes(&self, t: f64) -> ([Form; 3], [Form; 3], [f64; 3]) {
        let (i, start) = (self.unit.moments, self.unit.omega.0);
        let rotor = self.unit.at(t).0;
        let varied = self.tumbling.as_ref().map_or_else(|| steady(i, start, t), |tumbling| tumbling.at(t));
        let w = varied.omega;
        let m: [f64; 3] = from_fn(|k| i[k] * w[k]);
        let rate = from_fn(|x| {
            let (y, z) = ((x + 1) % 3, (x + 2) % 3);
            (i[y] - i[z]) / i[x] * w[y] * w[z]
        });
        let g2 = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
        if g2 == 0.0 {
            // At rest the turn is that by δω.
            return (varied.change.map(|change| change * t), varied.change, rate);
        }
        let change: [Form; 3] = from_fn(|k| Form::rate(k) * i[k] + Form::moment(k) * start[k]);
        let seen = in_body(rotor, change);
        let rest: [Form; 3] = from_fn(|k| seen[k] - varied.change[k] * i[k] - Form::moment(k) * w[k]);
        let along = (0..3).fold(Form::default(), |sum, k| {
            let moment = 0.5 * (start[k] * start[k] * t - varied.squares[k]);
            sum + Form::rate(k) * (i[k] * start[k] * t) + Form::moment(k) * moment
        });
        let turn = from_fn(|x| {
            let (y, z) = ((x + 1) % 3, (x + 2) % 3);
            (along * m[x] + rest[z] * m[y] - rest[y] * m[z]) * (1.0 / g2)
        });
        (turn, varied.change, rate)
    }
}

/// `−½ R ε`.
fn body_turn(rotor: Rotor, turn: Bivector) -> [f64; 4] {
    let [s, x, y, z] = rotor.components();
    let [a, b, c] = turn.0;
    // BE = −b·e − I(b x e) for bivectors.
    [
        0.5 * (x * a + y * b + z * c),
        -0.5 * (s * a - (y * c - z * b)),
        -0.5 * (s * b - (z * a - x * c)),
        -0.5 * (s * c - (x * b - y * a)),
    ]
}

/// `~R X R` for a bivector X with these components.
fn in_body(rotor: Rotor, x: [Form; 3]) -> [Form; 3] {
    let columns: [[f64; 3]; 6] =
        from_fn(|j| rotor.reverse().apply_bivector(Bivector(x.map(|form| form.0[j]))).0);
    from_fn(|k| Form(columns.map(|c| c[k])))
}
