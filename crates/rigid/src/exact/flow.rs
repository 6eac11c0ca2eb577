//! A motion in closed form of any kind: its states at one time or at many.

use super::free::flow::Flow as FreeFlow;
use super::free::series::{Circular, Hyperbolic};
use super::lagrange::flow::Flow as LagrangeFlow;
use super::lagrange::series::{Circular as LagrangeCircular, Hyperbolic as LagrangeHyperbolic};
use super::{damped::flow::Flow as DampedFlow, larmor::flow::Flow as LarmorFlow};
use polhode_ga::rows::curve::{Curve, TOGETHER, sample, together, value};
use polhode_ga::simd::threads::Threads;
use polhode_ga::{Bivector, Rotor};

/// Rotor and angular velocity as functions of time, in the form that fits the motion.
#[derive(Clone, Copy, Debug)]
pub struct Flow(pub(super) Form);

/// Coefficients of one motion. In lanes, motions of a form share blocks: see [`super::many`].
// A box could not be copied.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    FreeCircular(FreeFlow<Circular>),
    FreeHyperbolic(FreeFlow<Hyperbolic>),
    LagrangeCircular(LagrangeFlow<LagrangeCircular>),
    LagrangeHyperbolic(LagrangeFlow<LagrangeHyperbolic>),
    DampedCircular(DampedFlow<Circular>),
    DampedHyperbolic(DampedFlow<Hyperbolic>),
    Larmor(LarmorFlow),
}

/// The same expression for the coefficients of any form.
macro_rules! with_coefficients {
    ($flow:expr, $coefficients:ident => $value:expr) => {
        match $flow {
            Form::FreeCircular($coefficients) => $value,
            Form::FreeHyperbolic($coefficients) => $value,
            Form::LagrangeCircular($coefficients) => $value,
            Form::LagrangeHyperbolic($coefficients) => $value,
            Form::DampedCircular($coefficients) => $value,
            Form::DampedHyperbolic($coefficients) => $value,
            Form::Larmor($coefficients) => $value,
        }
    };
}

impl Flow {
    /// Rotor and body angular velocity at time `t` in s, the same bits as [`Flow::at_many`].
    pub(super) fn at(&self, t: f64) -> (Rotor, Bivector) {
        let (rotor, omega) = with_coefficients!(&self.0, coefficients => value(coefficients, t));
        (Rotor::from_unit_components(rotor), Bivector(omega))
    }

    /// The same at many times: rows of four rotor components and of three components of the angular velocity.
    ///
    /// # Panics
    /// If the numbers of rows and times differ.
    pub(super) fn at_many(&self, threads: Threads, times: &[f64], rotors: &mut [f64], omegas: &mut [f64]) {
        with_coefficients!(&self.0, coefficients => sample(coefficients, threads, times, rotors, omegas));
    }

    /// The motion of the same body under the torque `−g L`, if it is that of a free body.
    pub(super) fn damped(self, g: f64) -> Option<Flow> {
        Some(Flow(match self.0 {
            Form::FreeCircular(free) => Form::DampedCircular(DampedFlow::new(free, [g])),
            Form::FreeHyperbolic(free) => Form::DampedHyperbolic(DampedFlow::new(free, [g])),
            _ => return None,
        }))
    }
}

/// States of motions in lanes, of which each is circular or hyperbolic, at times of their own.
pub(super) fn either(
    (circular, hyperbolic): (&impl Curve<4, 3>, &impl Curve<4, 3>),
    is_circular: &[bool; TOGETHER],
    times: &[f64; TOGETHER],
    rotors: &mut [[f64; 4]; TOGETHER],
    omegas: &mut [[f64; 3]; TOGETHER],
) {
    together(circular, times, rotors, omegas);
    if *is_circular != [true; TOGETHER] {
        let (mut r, mut w) = ([[0.0; 4]; TOGETHER], [[0.0; 3]; TOGETHER]);
        together(hyperbolic, times, &mut r, &mut w);
        for l in (0..TOGETHER).filter(|&l| !is_circular[l]) {
            (rotors[l], omegas[l]) = (r[l], w[l]);
        }
    }
}
