//! Description of a motion: its kind, regime, periods and bounds.
//!
//! The kind follows from the torques ([`Setup::kind`]), regime and periods of free motions and heavy symmetric tops from
//! the start ([`Setup::facts`]), and the rest from the states at the output times ([`Setup::describe`]).

pub mod acting;
mod samples;

use crate::exact::free::FreeMotion;
use crate::exact::lagrange::{LagrangeDescription, LagrangeTop};
use crate::exact::regime::{FreeDescription, Regime};
use crate::exact::symmetric::SymmetricTop;
use crate::facts;
use crate::facts::Facts;
use crate::laws::torque::{Orbit, Torque, wheel};
use crate::run::{Motion, Setup, States};
use polhode_ga::{Rotor, Vector};
use samples::{crossings, ends, mean_interval, mean_rate, range};
use std::f64::consts::{LN_2, PI};

impl Setup {
    /// The kind of motion by the torques: `free` without any; `heavy`, `gyrostat` or `damped` if all are weights, wheels or
    /// dampings `−g L`; `satellite` if one is a gravity gradient; else `torqued`.
    pub fn kind(&self) -> &'static str {
        let all = |is: fn(&Torque) -> bool| self.torques.iter().all(is);
        match () {
            () if self.torques.is_empty() => "free",
            () if self.orbit().is_some() => "satellite",
            () if all(|torque| matches!(torque, Torque::Heavy(_))) => "heavy",
            () if all(|torque| matches!(torque, Torque::Wheel(_))) => "gyrostat",
            () if all(|torque| matches!(torque, Torque::Damping(_))) => "damped",
            () => "torqued",
        }
    }

    /// `c = m g (centre of mass)` of a body held at a fixed point, in N m; none for others.
    pub fn weight(&self) -> Option<Vector> {
        let each = self.torques.iter().filter_map(|t| if let Torque::Heavy(c) = t { Some(*c) } else { None });
        each.reduce(|sum, c| sum + c)
    }

    /// The orbit of a satellite.
    fn orbit(&self) -> Option<&Orbit> {
        let mut torques = self.torques.iter();
        torques.find_map(|t| if let Torque::GravityGradient(orbit) = t { Some(orbit) } else { None })
    }

    /// The free motion from this start.
    fn free(&self) -> Option<FreeDescription> {
        FreeMotion::new(&self.inertia, self.rotor, self.omega).ok().map(|motion| motion.describe())
    }

    /// The motion of a heavy symmetric top; None for other bodies.
    fn top(&self) -> Option<LagrangeDescription> {
        let weight = self.weight().filter(|_| self.kind() == "heavy")?;
        LagrangeTop::new(&self.inertia, self.rotor, self.omega, weight).ok().map(|top| top.describe())
    }

    /// Facts that follow from the start: `held`, `heavy`, `free` and `top` of `About` in `viewer/src/core/core.ts`.
    pub fn facts(&self) -> Facts {
        let top = self.top().map(|top| [top.facts(), facts! { tilt: [top.tilt_min, top.tilt_max] }].concat());
        let free = self.free().filter(|_| self.torques.is_empty()).map(|free| free.facts());
        facts! { held: self.weight().is_some(), heavy: self.weight().map(|c| c.0), free: free, top: top }
    }

    /// Facts of the motion; `kind` determines which names there are. Angles are in rad.
    pub fn describe(&self, motion: &Motion) -> Facts {
        let states = motion.states();
        let mut facts = match self.kind() {
            "free" => self.describe_free(motion, &states),
            "heavy" => self.describe_heavy(motion, &states),
            "gyrostat" => self.describe_gyrostat(&states),
            "damped" => self.describe_damped(),
            "satellite" => self.describe_satellite(&states),
            kind => facts! { kind: kind, regime: "under torque" },
        };
        let target = self.torques.iter().find_map(|torque| match torque {
            Torque::TorsionSpring { rest: target, .. } | Torque::Control { target, .. } => Some(*target),
            _ => None,
        });
        if let Some(target) = target {
            let angle = |rotor: &Rotor| {
                let [scalar, x, y, z] = (target.reverse() * *rotor).components();
                2.0 * Vector([x, y, z]).norm().atan2(scalar.abs())
            };
            facts.extend(facts! { from_target: ends(states.rotors.iter().map(angle)) });
        }
        if self.torques.iter().any(|torque| !matches!(torque, Torque::Heavy(_) | Torque::Wheel(_))) {
            let rate = ends(states.omegas.iter().map(|omega| omega.norm()));
            let momentum = ends(states.momenta_space.iter().map(|l| l.norm()));
            facts.extend(facts! { changes: facts! { rate: rate, angular_momentum: momentum } });
        }
        let moves = states.centers.first().is_some_and(|center| center.velocity != Vector::default());
        if self.has_forces || moves {
            let position = ends(states.centers.iter().map(|center| center.position.0));
            let velocity = ends(states.centers.iter().map(|center| center.velocity.0));
            facts.extend(facts! { position: position, velocity: velocity });
        }
        facts
    }

    /// The free motion from this start; for a symmetric top also its wobbles per turn about the axis.
    fn describe_start(&self, kind: &str) -> Facts {
        let Some(free) = self.free() else { return facts! { kind: kind } };
        let mut facts = [facts! { kind: kind }, free.facts()].concat();
        if let (Regime::Symmetric, Some(rate)) = (free.regime, free.precession_rate) {
            let spin = self.inertia.principal_frame().reverse().apply_bivector(self.omega).0[free.axis];
            facts.extend(facts! { wobbles_per_turn: (spin != 0.0).then(|| (rate / spin).abs()) });
        }
        facts
    }

    fn describe_free(&self, motion: &Motion, states: &States) -> Facts {
        let flip = self.free().and_then(|free| free.flip_time());
        let flip = flip.filter(|flip| longest(&states.times) < 0.25 * flip);
        let reversals = facts! { reversals: flip.and_then(|_| self.reversals(states)) };
        let mut facts = [self.describe_start("free"), reversals].concat();
        let top = SymmetricTop::new(&self.inertia, self.rotor, self.omega);
        if let Some(top) = top.filter(|_| motion.horizons().is_none()) {
            let (mut most, mut most_omega) = (0.0_f64, 0.0_f64);
            for (k, time) in states.times.iter().enumerate() {
                let (rotor, omega) = top.at(time - self.time);
                let (a, b) = (rotor.components(), states.rotors[k].components());
                most = most.max((0..4).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt());
                most_omega = most_omega.max((omega - states.omegas[k]).norm());
            }
            let differences = facts! { largest_rotor_difference: most, largest_omega_difference: most_omega };
            facts.extend(facts! { closed_form: differences });
        }
        facts
    }

    /// How often the spin about the axis of the middle moment changes its sign, and the mean time between.
    fn reversals(&self, states: &States) -> Option<Facts> {
        let (middle, back) = (self.by_moment()[1], self.inertia.principal_frame().reverse());
        let spin: Vec<f64> =
            states.omegas.iter().map(|omega| back.apply_bivector(*omega).0[middle]).collect();
        let times = crossings(&states.times, &spin);
        Some(facts! { count: times.len(), mean_interval: mean_interval(&times)? })
    }

    /// The principal axes by rising moment.
    fn by_moment(&self) -> [usize; 3] {
        let moments = self.inertia.principal_moments();
        let mut axes = [0, 1, 2];
        axes.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
        axes
    }

    /// The angle between L, in body axes, and the axis of the wheel.
    fn describe_gyrostat(&self, states: &States) -> Facts {
        let h = wheel(&self.torques).dual();
        let momenta = states.rotors.iter().zip(&states.momenta_space);
        let momenta = momenta.map(|(rotor, l)| rotor.reverse().apply_bivector(*l).dual());
        let size = momenta.clone().next().map(|l| l.norm());
        let regime = "body with a wheel, no torque from outside";
        let mut facts = facts! { kind: "gyrostat", regime: regime, wheel: h.0, momentum_size: size };
        if h.norm() != 0.0 {
            let axis = h / h.norm();
            let angles = momenta.map(|l| l.cross(axis).norm().atan2(l.dot(axis)));
            facts.extend(facts! { from_wheel: range(angles) });
        }
        facts
    }

    /// The free motion from this start, with the rescaled time `(1 − e^(−gt))/g`.
    fn describe_damped(&self) -> Facts {
        let each = self.torques.iter().map(|t| if let Torque::Damping(g) = t { *g } else { 0.0 });
        let damping: f64 = each.sum();
        let after = |rate: f64| (rate > 0.0).then_some(LN_2 / rate);
        let facts = facts! { damping: damping, halved_after: after(damping), doubled_after: after(-damping) };
        [self.describe_start("damped"), facts].concat()
    }

    /// The motion of the line from the fixed point to the centre of mass.
    fn describe_heavy(&self, motion: &Motion, states: &States) -> Facts {
        let weight = self.weight().unwrap_or_default();
        let size = weight.norm();
        if let Some(top) = self.top().filter(|_| size != 0.0) {
            let spin = (weight / size).dot(self.omega.dual());
            let fast = Some(size / top.axial_momentum).filter(|rate| rate.is_finite());
            let own = facts! { kind: "lagrange", mgl: size, spin: spin, fast_top_precession_rate: fast };
            return [own, top.facts()].concat();
        }
        // Some heavy bodies have an integral of their own.
        let integrals = motion.certificate.drifts.iter().map(|(kept, ..)| kept.name());
        let regime = integrals.fold("heavy body about a fixed point", |regime, integral| match integral {
            "kovalevskaya_integral" => "Kovalevskaya's top about a fixed point",
            "goryachev_chaplygin_integral" => "Goryachev's and Chaplygin's top about a fixed point",
            _ => regime,
        });
        let mut facts = facts! { kind: "heavy", regime: regime, mgl: size };
        if size != 0.0 {
            let path: Vec<Vector> = states.rotors.iter().map(|rotor| rotor.apply(weight / size)).collect();
            let [least, most] = range(path.iter().map(|Vector([x, y, z])| x.hypot(*y).atan2(*z)));
            let rate = mean_rate(states, &path);
            facts.extend(facts! { tilt_min: least, tilt_max: most, precession_rate: rate });
        }
        facts
    }

    /// The axis of the least moment on a satellite's orbit: its parts along the orbit, on the normal e3 and up from the
    /// planet. None for a body that is not a satellite.
    pub fn long_axis(&self, states: &States) -> Option<Vec<[f64; 3]>> {
        let (orbit, normal) = (self.orbit()?, Vector([0.0, 0.0, 1.0]));
        let parts = |(axis, time): (Vector, &f64)| {
            let up = orbit.place(*time).0;
            [normal.cross(up).dot(axis), normal.dot(axis), up.dot(axis)]
        };
        Some(self.principal_axis(states, self.by_moment()[0]).zip(&states.times).map(parts).collect())
    }

    /// The direction of a principal axis in space.
    fn principal_axis<'a>(&self, states: &'a States, k: usize) -> impl Iterator<Item = Vector> + 'a {
        let mut axis = Vector::default();
        axis.0[k] = 1.0;
        let axis = self.inertia.principal_frame().apply(axis);
        states.rotors.iter().map(move |rotor| rotor.apply(axis))
    }

    /// How the axes of the least and the largest moment swing about the vertical and the normal.
    ///
    /// Small swings in the plane of a circular orbit, with the axes of the moments a < b < c up, along the orbit and on its
    /// normal, follow `θ'' = −3 n² (b − a)/c θ`.
    fn describe_satellite(&self, states: &States) -> Facts {
        let (Some(orbit), Some(parts)) = (self.orbit(), self.long_axis(states)) else { return Facts::new() };
        let sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
        let is_bound = parts.iter().all(|part| sign(part[2]) == sign(parts[0][2]));
        let along: Vec<f64> = parts.iter().map(|[along, _, up]| along * sign(*up)).collect();
        let swings = if is_bound { crossings(&states.times, &along) } else { Vec::new() };
        let libration = mean_interval(&swings).filter(|_| swings.len() > 2).map(|interval| 2.0 * interval);
        let moments = self.inertia.principal_moments();
        let [a, b, c] = self.by_moment().map(|k| moments[k]);
        let (rate, stiffness) = (orbit.rate().abs(), 3.0 * (b - a) / c);
        let period = |rate: f64| Some(2.0 * PI / rate).filter(|period| period.is_finite());
        let regime =
            if is_bound { "librating about the vertical" } else { "turning over, not held by the gradient" };
        let angle = |x: f64, y: f64, z: f64| x.hypot(y).atan2(z.abs());
        let normals = self.principal_axis(states, self.by_moment()[2]);
        facts! {
            kind: "satellite", regime: regime, orbital_period: period(rate), eccentricity: orbit.eccentricity(),
            from_vertical: range(parts.iter().map(|[along, across, up]| angle(*along, *across, *up))),
            from_normal: range(normals.map(|Vector([x, y, z])| angle(x, y, z))),
            libration_period: libration, small_libration_period: period(rate * stiffness.sqrt()),
        }
    }
}

/// The longest interval between times.
fn longest(times: &[f64]) -> f64 {
    times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
}

/// A law's name in scenes and its formula or numbers as text.
pub fn law_facts(name: &str, torque: &Torque, formula: Option<&str>) -> Facts {
    let argument = |numbers: &[f64]| match numbers {
        [x] => x.to_string(),
        row => format!("({})", row.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")),
    };
    let text = match (formula, torque.registered()) {
        (Some(formula), _) => formula.to_owned(),
        (None, Some((entry, numbers))) => {
            entry.split(&numbers).map(|(_, own)| argument(own)).collect::<Vec<_>>().join(", ")
        }
        (None, None) => if let Torque::Formula(law) = torque { law.text() } else { "" }.to_owned(),
    };
    facts! { name: name, text: text }
}
