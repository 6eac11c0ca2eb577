//! Torque laws; torques add up. A torque is a bivector; its components are those of the axial vector.

mod dependence;
mod gains;
pub(crate) mod lanes;
pub(crate) mod orbit;
mod scales;
mod table;
mod wheels;

pub use super::formula::Axes;
use super::formula::Formula;
use crate::error::{SimulateError, TorqueError};
use crate::state::phase::{Gyrostat, Phase};
use crate::state::point::{Function, Point};
pub use dependence::Dependence;
pub use gains::Gains;
use lanes::{gradient, quadratic, seen};
pub use orbit::{KeplerOrbit, Orbit, dipole_field, on_orbit};
use polhode_ga::simd::lanes::One;
use polhode_ga::{Bivector, Rotor, Vector};
use std::sync::Arc;
pub use table::{Kind, Table};
pub use wheels::{Wheel, Wheels};

pub(crate) const E3: Vector = Vector([0.0, 0.0, 1.0]);

/// A torque law. Vectors and bivectors of the body are in body axes, `Ω` is its angular velocity in body axes, `R` the
/// rotor from body axes to space.
#[derive(Clone, Debug)]
pub enum Torque {
    /// Uniform gravity along −e3 on a body held at the origin of its axes: `V = c·γ`, `γ = ~R e3 R`, where
    /// `c = m g (centre of mass)`, in N m. The torque is `γ∧c`.
    Heavy(Vector),
    /// The gradient of a central field along an orbit: with u from planet to body, `V = 3/2 n² (a/r)³ u·I(u)`
    /// and the axial torque `3n² (a/r)³ u x I(u)`.
    GravityGradient(Orbit),
    /// Constant in body axes, in N m.
    ConstantBody(Bivector),
    /// Constant in space, in N m.
    ConstantSpace(Bivector),
    /// `−g I(Ω)`, with g in 1/s.
    Damping(f64),
    /// `−k |Ω| Ω`, with k in N m s².
    QuadraticDamping(f64),
    /// `−d Ω`, with d in N m s.
    ViscousDamping(Gains),
    /// A dipole of the body, in A m², in a field fixed in space, in T: `V = −m·b`, `b = ~R B R`, torque
    /// `m∧b`, which is the axial vector `m x b`.
    Magnetic {
        /// m, in body axes.
        dipole: Vector,
        /// B, in space.
        field: Vector,
    },
    /// `V = ½ k θ²`, torque `−k Θ`, with `R = rest exp(−½Θ)` and `θ = |Θ| <= π`: see [`turn_from`].
    TorsionSpring {
        /// k, in N m.
        stiffness: f64,
        /// The attitude without torque.
        rest: Rotor,
    },
    /// A wheel inside the body with this constant momentum relative to it, kg m²/s: a part of the body
    /// ([`Gyrostat`]), not a torque.
    Wheel(Bivector),
    /// The reaction of wheels with motors.
    Wheels(Arc<Wheels>),
    /// `−kp Θ − kd Ω`, with `R = target exp(−½Θ)`, `|Θ| <= π`.
    Control {
        /// kp, in N m.
        stiffness: Gains,
        /// kd, in N m s.
        damping: Gains,
        /// The attitude to reach.
        target: Rotor,
    },
    /// The axial torque `L x b`, b in space, in rad/s, L the momentum in space: L turns about b at the rate
    /// −|b|.
    Larmor(Vector),
    /// Interpolated between the rows of a table.
    Tabulated(Arc<Table>),
    /// A formula of [`super::formula::Purpose::Torque`].
    Formula(Formula),
    /// A law of the registry that is computed by its formula.
    Registered(Box<FormulaLaw>),
    /// A function of the caller: the torque in body axes.
    Function(Function<Bivector>),
}

/// A law of the registry with the formulas of its torque and potential.
#[derive(Clone, Debug)]
pub struct FormulaLaw {
    pub(crate) name: &'static str,
    /// The numbers of its arguments, in the axes in which they were given.
    pub(crate) numbers: Vec<f64>,
    pub(crate) torque: Formula,
    /// The potential energy in J.
    pub(crate) potential: Option<Formula>,
    /// The largest torque in N m, and the largest size of the potential in J.
    pub(crate) size: f64,
    /// The axis of space about which there is no torque.
    pub(crate) axis: Option<Vector>,
}

impl Torque {
    /// The same law with its body components seen from other body axes: `x' = ~F x F`.
    pub fn in_axes(self, frame: Rotor) -> Torque {
        let back = frame.reverse();
        match self {
            Torque::Heavy(c) => Torque::Heavy(back.apply(c)),
            Torque::ConstantBody(n) => Torque::ConstantBody(back.apply_bivector(n)),
            Torque::Wheel(h) => Torque::Wheel(back.apply_bivector(h)),
            Torque::Wheels(wheels) => Torque::Wheels(Arc::new(wheels.turned(back))),
            Torque::ViscousDamping(d) => Torque::ViscousDamping(d.in_axes(frame)),
            Torque::Magnetic { dipole, field } => Torque::Magnetic { dipole: back.apply(dipole), field },
            Torque::TorsionSpring { stiffness, rest } => {
                Torque::TorsionSpring { stiffness, rest: rest * frame }
            }
            Torque::Control { stiffness, damping, target } => Torque::Control {
                stiffness: stiffness.in_axes(frame),
                damping: damping.in_axes(frame),
                target: target * frame,
            },
            Torque::Tabulated(table) => match table.axes {
                Axes::Body => Torque::Tabulated(Arc::new(table.turned(back))),
                Axes::Space => Torque::Tabulated(table),
            },
            Torque::Formula(law) => Torque::Formula(law.in_axes(frame)),
            Torque::Registered(law) => {
                let potential = law.potential.map(|potential| potential.in_axes(frame));
                let torque = law.torque.in_axes(frame);
                Torque::Registered(Box::new(FormulaLaw { torque, potential, ..*law }))
            }
            Torque::Function(law) => Torque::Function(law.in_axes(frame)),
            same @ (Torque::GravityGradient(_)
            | Torque::ConstantSpace(_)
            | Torque::Damping(_)
            | Torque::QuadraticDamping(_)
            | Torque::Larmor(_)) => same,
        }
    }

    /// The formula of a law that is computed by one.
    pub(crate) fn formula(&self) -> Option<&Formula> {
        match self {
            Torque::Formula(formula) => Some(formula),
            Torque::Registered(law) => Some(&law.torque),
            _ => None,
        }
    }

    /// The same on a body with this mass in kg; NaN leaves it unknown.
    pub(crate) fn with_mass(self, mass: f64) -> Torque {
        match self {
            Torque::Formula(law) => Torque::Formula(law.with_mass(mass)),
            other => other,
        }
    }

    /// The torque in principal axes, without the part `−g I(Ω)` ([`Torque::damping_rate`]) and that of a
    /// wheel. At a jump in time, that after it.
    pub fn value(&self, at: &Point) -> Result<Bivector, TorqueError> {
        self.value_within(at, at.phase.time)
    }

    /// The values at other times of a point, each with the bits of [`Torque::value`]; fails with the first time that has
    /// none.
    pub(crate) fn values(&self, at: &Point, times: &[f64]) -> Result<Vec<Bivector>, (f64, TorqueError)> {
        if let Some(formula) = self.formula()
            && let Some(numbers) = formula.numbers_at(at, times)
        {
            return Ok(numbers.chunks_exact(3).map(|row| formula.torque(at.phase.rotor, row)).collect());
        }
        let value = |&time: &f64| {
            let phase = &Phase { time, ..*at.phase };
            self.value(&Point { phase, ..*at }).map_err(|error| (time, error))
        };
        times.iter().map(value).collect()
    }

    /// The torque at a stage of a step whose middle is given, in s: at a jump, that on the side of the middle.
    pub(crate) fn value_within(&self, at: &Point, middle: f64) -> Result<Bivector, TorqueError> {
        let Point { body, phase: state, .. } = *at;
        let rotor = state.rotor;
        let r = One::each(rotor.components());
        let from_space = |b: Bivector| Bivector(One::alone(seen(&r, &One::each(b.0))));
        Ok(match self {
            Torque::Heavy(c) => state.vertical().wedge(*c),
            Torque::GravityGradient(orbit) => {
                let (Vector(u), nearness) = orbit.place(state.time);
                let strength = 3.0 * orbit.rate() * orbit.rate() * nearness;
                let u = seen(&r, &One::each(u));
                Bivector(One::alone(gradient(&One::each(body.moments), &u, One::all(strength))))
            }
            Torque::ConstantBody(torque) => *torque,
            Torque::ConstantSpace(torque) => from_space(*torque),
            Torque::Damping(_) | Torque::Wheel(_) => Bivector::default(),
            Torque::QuadraticDamping(k) => {
                let omega = One::each(body.omega(state.momentum).0);
                Bivector(One::alone(quadratic(One::all(*k), &omega)))
            }
            Torque::Wheels(wheels) => wheels.reaction(body.omega(state.momentum), state.time, middle),
            Torque::ViscousDamping(d) => -d.times(body.omega(state.momentum)),
            Torque::Magnetic { dipole, field } => dipole.wedge(from_space(field.undual()).dual()),
            Torque::TorsionSpring { stiffness, rest } => turn_from(*rest, rotor) * -stiffness,
            Torque::Control { stiffness, damping, target } => {
                let pull = stiffness.times(turn_from(*target, rotor));
                -(pull + damping.times(body.omega(state.momentum)))
            }
            Torque::Larmor(b) => state.momentum.dual().wedge(from_space(b.undual()).dual()),
            Torque::Tabulated(table) => {
                let torque = table.within(state.time, middle)?;
                match table.axes {
                    Axes::Body => torque,
                    Axes::Space => from_space(torque),
                }
            }
            Torque::Formula(_) | Torque::Registered(_) => {
                let Some(formula) = self.formula() else { return Ok(Bivector::default()) };
                formula.torque(rotor, formula.value(at)?.components())
            }
            Torque::Function(law) => {
                let torque = law.value(at)?;
                if !torque.0.iter().all(|x| x.is_finite()) {
                    let Bivector(torque) = torque;
                    return Err(TorqueError::undefined(format!(
                        "the torque that the function returned is {torque:?}; it must be finite"
                    )));
                }
                law.frame().reverse().apply_bivector(torque)
            }
        })
    }

    /// The g of the part `−g I(Ω)`, in 1/s.
    pub fn damping_rate(&self) -> f64 {
        if let Torque::Damping(g) = self { *g } else { 0.0 }
    }

    /// The potential energy in J, of a law that has one; of wheels with motors the energy of their rotation.
    pub fn potential(&self, body: &Gyrostat, state: &Phase) -> Option<f64> {
        let back = state.rotor.reverse();
        match self {
            Torque::Heavy(c) => Some(state.vertical().dot(*c)),
            Torque::Magnetic { dipole, field } => Some(-dipole.dot(back.apply(*field))),
            Torque::TorsionSpring { stiffness, rest } => {
                Some(0.5 * stiffness * turn_from(*rest, state.rotor).norm_squared())
            }
            Torque::Wheel(_) => Some(0.0),
            Torque::Wheels(wheels) => Some(wheels.energy(state.time)),
            Torque::Registered(law) => law
                .potential
                .as_ref()?
                .value(&Point::at_rest(body, state))
                .ok()?
                .components()
                .first()
                .copied(),
            _ => None,
        }
    }
}

/// The bivector `Θ` of the shorter rotation from one attitude to another: `R = rest exp(−½Θ)`, `|Θ| <= π`.
///
/// `R` and `−R` are one attitude, so of `q = ±~rest R` the one with a scalar part >= 0 is taken. Along a
/// motion `q' = −½ q Ω` gives `θ θ' = Θ·Ω`: the torque `−k Θ` has the potential `½ k θ²`. At half a turn both
/// directions are equally short: Θ is discontinuous there, `θ²` is continuous.
pub fn turn_from(rest: Rotor, rotor: Rotor) -> Bivector {
    let [rest, rotor] = [rest, rotor].map(|r| One::each(r.components()));
    Bivector(One::alone(lanes::turn_from(&rest, &rotor)))
}

/// The sum of all laws at a stage of a step whose middle is given, without damping and wheels.
pub(crate) fn total_torque(torques: &[Torque], at: &Point, middle: f64) -> Result<Bivector, SimulateError> {
    let mut total = Bivector::default();
    for law in torques {
        total += law.value_within(at, middle).map_err(|error| error.at(at.phase.time))?;
    }
    Ok(total)
}

/// The g of all dampings together, in 1/s.
pub(crate) fn damping_rate(torques: &[Torque]) -> f64 {
    torques.iter().map(Torque::damping_rate).sum()
}

/// The momentum of all wheels together.
pub fn wheel(torques: &[Torque]) -> Bivector {
    torques.iter().fold(Bivector::default(), |sum, torque| match torque {
        Torque::Wheel(h) => sum + *h,
        _ => sum,
    })
}

/// The torque T of handout eq. (4.21), `I(Ω') − Ω × I(Ω) = T`, in principal axes: the sum of all laws, damping
/// `−g I(Ω)`, and the reaction `Ω × h` of the wheel.
pub fn total(torques: &[Torque], at: &Point) -> Result<Bivector, TorqueError> {
    let omega = at.body.omega(at.phase.momentum);
    Ok(omega.commutator(at.body.wheel) + external(torques, at)?)
}

/// The same without the reaction of the wheel: the rate of change of L in space, in principal axes.
pub fn external(torques: &[Torque], at: &Point) -> Result<Bivector, TorqueError> {
    let carried = at.body.carried(at.body.omega(at.phase.momentum));
    let mut sum = Bivector::default();
    for torque in torques {
        sum = sum + torque.value(at)? - carried * torque.damping_rate();
    }
    Ok(sum)
}

#[cfg(test)]
mod tests;
