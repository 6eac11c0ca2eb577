//! Torque laws of bodies side by side.

use crate::exert::{Exert, Place};
use crate::phase::{Gyrostat, Phase};
use crate::torque::Torque;
use polhode_ga::lanes::{Lanes, cross, matrix};
use polhode_ga::{Bivector, Rotor};
use std::array;

/// Free bodies without wheels.
pub(super) struct Nothing;

impl<const W: usize, const F: bool> Exert<W, F> for Nothing {
    const ACTS: bool = false;

    #[inline(always)]
    fn torque(&mut self, _: &Place<W, F>) -> [Lanes<W, F>; 3] {
        [Lanes::ZERO; 3]
    }

    #[inline(always)]
    fn acceleration(&mut self, _: &Place<W, F>, _: &[Lanes<W, F>; 6]) -> [Lanes<W, F>; 3] {
        [Lanes::ZERO; 3]
    }
}

/// The laws of bodies side by side, in principal axes.
pub(super) struct Laws<'t, const W: usize, const F: bool> {
    gyrostats: [Gyrostat; W],
    /// `c` of all weights together.
    weight: Option<[Lanes<W, F>; 3]>,
    /// Others, lane by lane.
    others: Vec<[&'t Torque; W]>,
}

impl<'t, const W: usize, const F: bool> Laws<'t, W, F> {
    /// Every body has laws of the same kinds in the same order.
    pub fn new(gyrostats: [Gyrostat; W], torques: [&'t [Torque]; W]) -> Laws<'t, W, F> {
        let mut laws = Laws { gyrostats, weight: None, others: Vec::new() };
        for law in 0..torques[0].len() {
            let each: [&Torque; W] = array::from_fn(|l| &torques[l][law]);
            match each[0] {
                Torque::Damping(_) | Torque::Wheel(_) => {}
                Torque::Heavy(_) => {
                    let sum = laws.weight.get_or_insert([Lanes::ZERO; 3]);
                    for (l, law) in each.iter().enumerate() {
                        let Torque::Heavy(c) = law else { continue };
                        for k in 0..3 {
                            sum[k].0[l] += c.0[k];
                        }
                    }
                }
                _ => laws.others.push(each),
            }
        }
        laws
    }

    /// By the laws of single bodies; NaN where one has no torque.
    fn others(&self, at: &Place<W, F>) -> [Lanes<W, F>; 3] {
        let mut sum = [Lanes::ZERO; 3];
        for l in 0..W {
            let body = &self.gyrostats[l];
            let rotor = Rotor::from_unit_components(at.rotor.map(|lanes| lanes.0[l]));
            let momentum = body.momentum(Bivector(at.omega.map(|lanes| lanes.0[l])));
            let phase = Phase { rotor, momentum, time: at.time.0[l] };
            for law in &self.others {
                let torque = law[l].value(body, &phase).unwrap_or(Bivector([f64::NAN; 3]));
                for k in 0..3 {
                    sum[k].0[l] += torque.0[k];
                }
            }
        }
        sum
    }
}

impl<const W: usize, const F: bool> Exert<W, F> for Laws<'_, W, F> {
    const ACTS: bool = true;

    #[inline(always)]
    fn torque(&mut self, at: &Place<W, F>) -> [Lanes<W, F>; 3] {
        let mut torque = if self.others.is_empty() { [Lanes::ZERO; 3] } else { self.others(at) };
        if let Some(c) = &self.weight {
            // γ∧c: its axial vector is γ x c.
            let [_, _, vertical] = matrix(&at.rotor);
            let pull = cross(&vertical, c);
            for k in 0..3 {
                torque[k] += pull[k];
            }
        }
        torque
    }

    #[inline(always)]
    fn acceleration(&mut self, _: &Place<W, F>, _: &[Lanes<W, F>; 6]) -> [Lanes<W, F>; 3] {
        [Lanes::ZERO; 3]
    }
}
