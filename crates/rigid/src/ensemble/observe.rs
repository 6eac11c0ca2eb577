//! Points of bodies in lanes, by the formulas for a single body, with the same bits.

use super::member::{Member, of};
use crate::laws::torque::lanes::in_lanes;
use crate::state::phase::Phase;
use polhode_ga::simd::lanes::{Lanes, Work, fastest};
use polhode_ga::{Bivector, Rotor};
use std::array::from_fn;

/// Lanes whose products and sums are not fused.
type Plain<const W: usize> = Lanes<W, false>;

/// Rotors and momenta in principal axes.
#[derive(Clone, Copy)]
pub(super) struct LanePhases<const W: usize> {
    pub rotor: [[f64; W]; 4],
    pub momentum: [[f64; W]; 3],
}

impl<const W: usize> LanePhases<W> {
    /// At the starts.
    pub fn starts(members: &[Member]) -> LanePhases<W> {
        let rotor: [Plain<W>; 4] = in_lanes(|l| of(members, l).start.rotor.components());
        let momentum: [Plain<W>; 3] = in_lanes(|l| of(members, l).start.momentum.0);
        LanePhases { rotor: rotor.map(|lanes| lanes.0), momentum: momentum.map(|lanes| lanes.0) }
    }

    /// Replaces that of one lane.
    pub fn set(&mut self, lane: usize, phase: &Phase) {
        for (lanes, x) in self.rotor.iter_mut().zip(phase.rotor.components()) {
            lanes[lane] = x;
        }
        for (lanes, x) in self.momentum.iter_mut().zip(phase.momentum.0) {
            lanes[lane] = x;
        }
    }

    /// Of one lane.
    pub fn phase(&self, lane: usize, time: f64) -> Phase {
        Phase {
            rotor: Rotor::from_unit_components(from_fn(|k| self.rotor[k][lane])),
            momentum: Bivector(from_fn(|k| self.momentum[k][lane])),
            time,
        }
    }
}

/// The bodies of the lanes.
pub(super) struct LaneBodies<const W: usize> {
    /// From principal axes to those of the body.
    frame: [Plain<W>; 4],
    moments: [Plain<W>; 3],
    wheel: [Plain<W>; 3],
}

/// What is known of the points of the lanes.
pub(super) struct LanePoints<const W: usize> {
    pub phases: LanePhases<W>,
    /// From body axes to space.
    pub rotor: [Plain<W>; 4],
    /// In body axes, rad/s.
    pub omega: [Plain<W>; 3],
    /// In space, kg m²/s.
    pub momentum: [Plain<W>; 3],
    /// Magnitude of the momentum.
    pub size: Plain<W>,
    /// Kinetic energies in J.
    pub kinetic: Plain<W>,
    /// `abs(|R| − 1)`.
    pub off_unit: Plain<W>,
}

impl<const W: usize> LanePoints<W> {
    /// The rotor from body axes to space, and the angular velocity in body axes, of a lane.
    pub fn in_body(&self, l: usize) -> (Rotor, Bivector) {
        let rotor = Rotor::from_unit_components(from_fn(|k| self.rotor[k].0[l]));
        (rotor, Bivector(from_fn(|k| self.omega[k].0[l])))
    }

    /// The squares of the angular velocities.
    pub fn squared_rates(&self) -> [f64; W] {
        let [x, y, z] = &self.omega;
        from_fn(|l| x.0[l] * x.0[l] + y.0[l] * y.0[l] + z.0[l] * z.0[l])
    }

    /// The momentum in space of a lane.
    pub fn momentum_of(&self, l: usize) -> Bivector {
        Bivector(from_fn(|k| self.momentum[k].0[l]))
    }
}

impl<const W: usize> LaneBodies<W> {
    pub fn new(members: &[Member]) -> Self {
        LaneBodies {
            frame: in_lanes(|l| of(members, l).frame.components()),
            moments: in_lanes(|l| of(members, l).gyrostat.moments),
            wheel: in_lanes(|l| of(members, l).gyrostat.wheel.0),
        }
    }

    /// Moments and momenta of wheels, lane by lane.
    pub fn numbers(&self) -> impl Iterator<Item = &[f64; W]> {
        self.moments.iter().chain(&self.wheel).map(|lanes| &lanes.0)
    }

    /// `m = I(Ω) + h`.
    pub fn momentum<const F: bool>(&self, omega: [Lanes<W, F>; 3]) -> [[f64; W]; 3] {
        let mut momentum = [[0.0; W]; 3];
        for k in 0..3 {
            momentum[k] = (self.moments[k] * Lanes(omega[k].0) + self.wheel[k]).0;
        }
        momentum
    }

    /// The phases of rotors from body axes to space and angular velocities in body axes.
    pub fn phases(&self, rotors: &[[f64; 4]; W], omegas: &[[f64; 3]; W]) -> LanePhases<W> {
        fastest(InPrincipalAxes { bodies: self, rotors, omegas })
    }

    /// The same from principal axes.
    pub fn phases_in_principal_axes(&self, rotors: &[[f64; 4]; W], omegas: &[[f64; 3]; W]) -> LanePhases<W> {
        let (rotor, omega): ([Plain<W>; 4], [Plain<W>; 3]) =
            (in_lanes(|l| rotors[l]), in_lanes(|l| omegas[l]));
        LanePhases { rotor: rotor.map(|lanes| lanes.0), momentum: self.momentum(omega) }
    }

    /// The points at these rotors and momenta.
    pub fn points(&self, phases: LanePhases<W>) -> LanePoints<W> {
        let mut points = fastest(Observe { bodies: self, phases: &phases });
        for l in 0..W {
            // Beyond this the squares may overflow or vanish.
            if !(1e-140..1e140).contains(&points.size.0[l]) {
                points.size.0[l] = phases.phase(l, 0.0).momentum.norm();
            }
        }
        points
    }
}

struct InPrincipalAxes<'a, const W: usize> {
    bodies: &'a LaneBodies<W>,
    rotors: &'a [[f64; 4]; W],
    omegas: &'a [[f64; 3]; W],
}

impl<const W: usize> Work for InPrincipalAxes<'_, W> {
    type Output = LanePhases<W>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> LanePhases<W> {
        let InPrincipalAxes { bodies, rotors, omegas } = self;
        let [f, a, b, c] = bodies.frame;
        let rotor = product(in_lanes(|l| rotors[l]), bodies.frame).map(|lanes| lanes.0);
        let momentum = bodies.momentum(turned([f, -a, -b, -c], in_lanes(|l| omegas[l])));
        LanePhases { rotor, momentum }
    }
}

struct Observe<'a, const W: usize> {
    bodies: &'a LaneBodies<W>,
    phases: &'a LanePhases<W>,
}

impl<const W: usize> Work for Observe<'_, W> {
    type Output = LanePoints<W>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> LanePoints<W> {
        let Observe { bodies: LaneBodies { frame, moments, wheel }, phases } = self;
        let zero = Lanes::ZERO;
        let (mut rotor, mut m) = ([zero; 4], [zero; 3]);
        for k in 0..4 {
            rotor[k] = Lanes(phases.rotor[k]);
        }
        for k in 0..3 {
            m[k] = Lanes(phases.momentum[k]);
        }
        let [s, x, y, z] = rotor;
        let mut omega = [zero; 3];
        let mut terms = [zero; 3];
        for k in 0..3 {
            let carried = m[k] - wheel[k];
            omega[k] = carried / moments[k];
            let term = carried * carried / moments[k];
            for l in 0..W {
                terms[k].0[l] = if carried.0[l] == 0.0 { 0.0 } else { term.0[l] };
            }
        }
        let [f, a, b, c] = *frame;
        LanePoints {
            phases: *phases,
            rotor: product([s, x, y, z], [f, -a, -b, -c]),
            omega: turned(*frame, omega),
            momentum: turned(rotor, m),
            size: (m[0] * m[0] + m[1] * m[1] + m[2] * m[2]).sqrt(),
            kinetic: Lanes::all(0.5) * (terms[0] + terms[1] + terms[2]),
            off_unit: ((s * s + x * x + y * y + z * z).sqrt() - Lanes::all(1.0)).abs(),
        }
    }
}

/// The product of rotors, in the order of sums of [`Rotor`].
#[inline(always)]
fn product<const W: usize>([s, a, b, c]: [Plain<W>; 4], [t, x, y, z]: [Plain<W>; 4]) -> [Plain<W>; 4] {
    [
        s * t + -(a * x + b * y + c * z),
        x * s + a * t + (c * y - b * z),
        y * s + b * t + (a * z - c * x),
        z * s + c * t + (b * x - a * y),
    ]
}

#[inline(always)]
fn cross<const W: usize>([a, b, c]: [Plain<W>; 3], [x, y, z]: [Plain<W>; 3]) -> [Plain<W>; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// `R B ~R`, in the order of sums of [`Rotor::apply_bivector`].
#[inline(always)]
fn turned<const W: usize>([s, x, y, z]: [Plain<W>; 4], v: [Plain<W>; 3]) -> [Plain<W>; 3] {
    let q = [-x, -y, -z];
    let [a, b, c] = cross(q, v);
    let two = Lanes::all(2.0);
    let t = [a * two, b * two, c * two];
    let [a, b, c] = cross(q, t);
    [v[0] + t[0] * s + a, v[1] + t[1] * s + b, v[2] + t[2] * s + c]
}
