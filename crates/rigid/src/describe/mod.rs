//! What is known of a motion, in words and numbers: its kind, regime, periods and bounds.
//!
//! The kind follows from the torques ([`Setup::kind`]), regime and periods of free motions and heavy symmetric tops from
//! the start ([`Setup::facts`]), and the rest from the states at the output times ([`Setup::describe`]).

mod samples;

use crate::exact::free::FreeMotion;
use crate::exact::lagrange::{LagrangeDescription, LagrangeTop};
use crate::exact::regime::{FreeDescription, Regime};
use crate::exact::symmetric::SymmetricTop;
use crate::facts::Facts;
use crate::laws::torque::{Argument, Orbit, Torque, wheel};
use crate::run::{Motion, Setup, States};
use polhode_ga::{Rotor, Vector};
use samples::{crossings, ends, mean_interval, mean_rate, range};
use std::f64::consts::{LN_2, PI};

/// The kind of a motion, by the torques.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// No torque.
    Free,
    /// Gravity on a body held at a point.
    Heavy,
    /// A wheel inside the body, and no torque.
    Gyrostat,
    /// A damping torque `−g L` alone.
    Damped,
    /// The gravity gradient, and any other torques.
    Satellite,
    /// Any other torques.
    Torqued,
}

impl Kind {
    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Free => "free",
            Kind::Heavy => "heavy",
            Kind::Gyrostat => "gyrostat",
            Kind::Damped => "damped",
            Kind::Satellite => "satellite",
            Kind::Torqued => "torqued",
        }
    }
}

/// Heavy bodies that have an integral of their own, by the name of the integral.
const INTEGRABLE: [(&str, &str); 2] = [
    ("kovalevskaya_integral", "Kovalevskaya's top about a fixed point"),
    ("goryachev_chaplygin_integral", "Goryachev's and Chaplygin's top about a fixed point"),
];

impl Setup {
    /// The kind of motion.
    pub fn kind(&self) -> Kind {
        let all = |is: fn(&Torque) -> bool| self.torques.iter().all(is);
        match () {
            () if self.torques.is_empty() => Kind::Free,
            () if self.orbit().is_some() => Kind::Satellite,
            () if all(|torque| matches!(torque, Torque::Heavy(_))) => Kind::Heavy,
            () if all(|torque| matches!(torque, Torque::Wheel(_))) => Kind::Gyrostat,
            () if all(|torque| matches!(torque, Torque::Damping(_))) => Kind::Damped,
            () => Kind::Torqued,
        }
    }

    /// `c = m g (centre of mass)` of a body held at a fixed point, in N m; none for others.
    pub fn weight(&self) -> Option<Vector> {
        let each = self.torques.iter().filter_map(|t| if let Torque::Heavy(c) = t { Some(*c) } else { None });
        each.reduce(|sum, c| sum + c)
    }

    /// The orbit of a satellite.
    fn orbit(&self) -> Option<&Orbit> {
        self.torques
            .iter()
            .find_map(|t| if let Torque::GravityGradient(orbit) = t { Some(orbit) } else { None })
    }

    /// What follows from the start of a free motion; none for others.
    pub fn free(&self) -> Option<FreeDescription> {
        self.torques.is_empty().then(|| self.turning()).flatten()
    }

    /// The free motion that starts so.
    fn turning(&self) -> Option<FreeDescription> {
        FreeMotion::new(&self.inertia, self.rotor, self.omega).ok().map(|motion| motion.describe())
    }

    /// What follows from the start of a heavy symmetric top; none for others.
    pub fn top(&self) -> Option<LagrangeDescription> {
        let weight = self.weight().filter(|_| self.kind() == Kind::Heavy)?;
        LagrangeTop::new(&self.inertia, self.rotor, self.omega, weight).ok().map(|top| top.describe())
    }

    /// What is known from the start alone: `held`, `heavy`, `free` and `top` of `About` in `viewer/src/core/core.ts`.
    pub fn facts(&self) -> Facts {
        let top = self.top().map(|top| {
            let mut facts = top.facts();
            facts.push(("tilt", [top.tilt_min, top.tilt_max].into()));
            facts
        });
        vec![
            ("held", self.weight().is_some().into()),
            ("heavy", self.weight().map(|c| c.0).into()),
            ("free", self.free().map(|free| free.facts()).into()),
            ("top", top.into()),
        ]
    }

    /// What is known of the motion; its `kind` says which names there are. Angles are in rad.
    pub fn describe(&self, motion: &Motion) -> Facts {
        let states = motion.states();
        let kind = self.kind();
        let mut facts = match kind {
            Kind::Free => self.describe_free(motion, &states),
            Kind::Heavy => self.describe_heavy(motion, &states),
            Kind::Gyrostat => self.describe_gyrostat(&states),
            Kind::Damped => self.describe_damped(),
            Kind::Satellite => self.describe_satellite(&states),
            Kind::Torqued => vec![("regime", "under torque".into())],
        };
        if facts.iter().all(|(name, _)| *name != "kind") {
            facts.push(("kind", kind.name().into()));
        }
        let target = self.torques.iter().find_map(|torque| match torque {
            Torque::TorsionSpring { rest: target, .. } | Torque::Control { target, .. } => Some(*target),
            _ => None,
        });
        if let Some(target) = target {
            let angle = |rotor: &Rotor| {
                let [scalar, x, y, z] = (target.reverse() * *rotor).components();
                2.0 * Vector([x, y, z]).norm().atan2(scalar.abs())
            };
            facts.push(("from_target", ends(states.rotors.iter().map(angle)).into()));
        }
        if self.torques.iter().any(|torque| !matches!(torque, Torque::Heavy(_) | Torque::Wheel(_))) {
            let changes: Facts = vec![
                ("rate", ends(states.omegas.iter().map(|omega| omega.norm())).into()),
                ("angular_momentum", ends(states.momenta_space.iter().map(|l| l.norm())).into()),
            ];
            facts.push(("changes", changes.into()));
        }
        let moves = states.centers.first().is_some_and(|center| center.velocity != Vector::default());
        if self.has_forces || moves {
            facts.push(("position", ends(states.centers.iter().map(|center| center.position.0)).into()));
            facts.push(("velocity", ends(states.centers.iter().map(|center| center.velocity.0)).into()));
        }
        facts
    }

    /// The free motion at the start; of a symmetric top its wobbles for each turn about its axis too.
    fn describe_turning(&self) -> Facts {
        let Some(free) = self.turning() else { return Facts::new() };
        let mut facts = free.facts();
        if let (Regime::Symmetric, Some(rate)) = (free.regime, free.precession_rate) {
            let spin = self.inertia.principal_frame().reverse().apply_bivector(self.omega).0[free.axis];
            facts.push(("wobbles_per_turn", (spin != 0.0).then(|| (rate / spin).abs()).into()));
        }
        facts
    }

    fn describe_free(&self, motion: &Motion, states: &States) -> Facts {
        let mut facts = self.describe_turning();
        let flip = self.turning().and_then(|free| free.flip_time());
        let is_sampled = flip.is_some_and(|flip| longest(&states.times) < 0.25 * flip);
        facts.push(("reversals", is_sampled.then(|| self.reversals(states)).flatten().into()));
        if motion.horizons().is_some() {
            return facts;
        }
        if let Some(top) = SymmetricTop::new(&self.inertia, self.rotor, self.omega) {
            let mut most = [0.0_f64; 2];
            for (k, time) in states.times.iter().enumerate() {
                let (rotor, omega) = top.at(time - self.time);
                let (a, b) = (rotor.components(), states.rotors[k].components());
                let off = (0..4).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
                most = [most[0].max(off), most[1].max((omega - states.omegas[k]).norm())];
            }
            let differences: Facts = vec![
                ("largest_rotor_difference", most[0].into()),
                ("largest_omega_difference", most[1].into()),
            ];
            facts.push(("closed_form", differences.into()));
        }
        facts
    }

    /// How often the spin about the axis of the middle moment changes its sign, and the mean time between.
    fn reversals(&self, states: &States) -> Option<Facts> {
        let (middle, back) = (self.by_moment()[1], self.inertia.principal_frame().reverse());
        let spin: Vec<f64> =
            states.omegas.iter().map(|omega| back.apply_bivector(*omega).0[middle]).collect();
        let times = crossings(&states.times, &spin);
        let interval = mean_interval(&times)?;
        Some(vec![("count", times.len().into()), ("mean_interval", interval.into())])
    }

    /// The principal axes by rising moment.
    fn by_moment(&self) -> [usize; 3] {
        let moments = self.inertia.principal_moments();
        let mut axes = [0, 1, 2];
        axes.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
        axes
    }

    /// How far L, seen from the body, is from the axis of the wheel.
    fn describe_gyrostat(&self, states: &States) -> Facts {
        let h = wheel(&self.torques);
        let momenta: Vec<Vector> = states
            .rotors
            .iter()
            .zip(&states.momenta_space)
            .map(|(rotor, l)| rotor.reverse().apply_bivector(*l).dual())
            .collect();
        let mut facts: Facts = vec![
            ("regime", "body with a wheel, no torque from outside".into()),
            ("wheel", h.0.into()),
            ("momentum_size", momenta.first().map(|l| l.norm()).into()),
        ];
        if h.norm() != 0.0 {
            let axis = h.dual() / h.norm();
            facts.push((
                "from_wheel",
                range(momenta.iter().map(|l| l.cross(axis).norm().atan2(l.dot(axis)))).into(),
            ));
        }
        facts
    }

    /// The free motion at the start, which goes on in the time `(1 − e^(−gt))/g`.
    fn describe_damped(&self) -> Facts {
        let damping: f64 =
            self.torques.iter().map(|t| if let Torque::Damping(g) = t { *g } else { 0.0 }).sum();
        let mut facts = self.describe_turning();
        facts.push(("damping", damping.into()));
        facts.push(("halved_after", (damping != 0.0).then_some(LN_2 / damping).into()));
        facts
    }

    /// How the line from the fixed point to the centre of mass moves.
    fn describe_heavy(&self, motion: &Motion, states: &States) -> Facts {
        let weight = self.weight().unwrap_or_default();
        let size = weight.norm();
        let mut facts: Facts = vec![("mgl", size.into())];
        if let Some(top) = self.top().filter(|_| size != 0.0) {
            let (spin, axial) = ((weight / size).dot(self.omega.dual()), top.axial_momentum);
            facts.extend(top.facts());
            facts.push(("kind", "lagrange".into()));
            facts.push(("spin", spin.into()));
            facts.push(("fast_top_precession_rate", (axial != 0.0).then_some(size / axial).into()));
            return facts;
        }
        let is_kept =
            |integral: &str| motion.certificate.drifts.iter().any(|(kept, ..)| kept.name() == integral);
        let known = INTEGRABLE.iter().find(|(integral, _)| is_kept(integral));
        facts.push(("regime", known.map_or("heavy body about a fixed point", |(_, name)| name).into()));
        if size != 0.0 {
            let path: Vec<Vector> = states.rotors.iter().map(|rotor| rotor.apply(weight / size)).collect();
            let [least, most] = range(path.iter().map(|Vector([x, y, z])| x.hypot(*y).atan2(*z)));
            facts.push(("tilt_min", least.into()));
            facts.push(("tilt_max", most.into()));
            facts.push(("precession_rate", mean_rate(states, &path).into()));
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
        let [_, _, largest] = self.by_moment();
        let sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
        let is_bound = parts.iter().all(|part| sign(part[2]) == sign(parts[0][2]));
        let along: Vec<f64> = parts.iter().map(|[along, _, up]| along * sign(*up)).collect();
        let swings = if is_bound { crossings(&states.times, &along) } else { Vec::new() };
        let rate = orbit.rate().abs();
        let [a, b, c] = self.by_moment().map(|k| self.inertia.principal_moments()[k]);
        let stiffness = 3.0 * (b - a) / c;
        let small = 2.0 * PI / (rate * stiffness.sqrt());
        let regime =
            if is_bound { "librating about the vertical" } else { "turning over, not held by the gradient" };
        let angle = |x: f64, y: f64, z: f64| x.hypot(y).atan2(z.abs());
        let normal = self.principal_axis(states, largest);
        vec![
            ("regime", regime.into()),
            ("orbital_period", (rate != 0.0).then_some(2.0 * PI / rate).into()),
            ("eccentricity", orbit.eccentricity().into()),
            (
                "from_vertical",
                range(parts.iter().map(|[along, across, up]| angle(*along, *across, *up))).into(),
            ),
            ("from_normal", range(normal.map(|Vector([x, y, z])| angle(x, y, z))).into()),
            ("libration_period", mean_interval(&swings).filter(|_| swings.len() > 2).map(|t| 2.0 * t).into()),
            ("small_libration_period", (rate != 0.0 && stiffness != 0.0).then_some(small).into()),
        ]
    }
}

/// The longest interval between times.
fn longest(times: &[f64]) -> f64 {
    times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
}

/// A law's name in scenes and, as text, its formula or its numbers.
pub fn law_facts(name: &'static str, torque: &Torque, formula: Option<&str>) -> Facts {
    let argument = |argument: &Argument| match argument {
        Argument::One(x) => x.to_string(),
        Argument::Row(row) => {
            let row: Vec<String> = row.iter().map(f64::to_string).collect();
            format!("({})", row.join(", "))
        }
    };
    let text = match (formula, torque) {
        (Some(formula), _) => formula.to_owned(),
        (None, Torque::Formula(law)) => law.text().to_owned(),
        (None, _) => {
            let numbers = torque.call().map_or(Vec::new(), |(_, arguments)| arguments);
            numbers.iter().map(argument).collect::<Vec<_>>().join(", ")
        }
    };
    vec![("name", name.into()), ("text", text.into())]
}
