//! Bodies of an ensemble, for display.

use super::{GoOn, Opened};
use crate::recorded::between;
use polhode_ga::Rotor;
use polhode_rigid::SimulateError;
use polhode_rigid::ensemble::Ensemble;
use polhode_rigid::run::Motion;

/// Number of stored frames of bodies without a closed form.
const FRAMES: usize = 241;

/// Computed bodies.
pub enum Crowd {
    /// Known at any time.
    Exact(Vec<Motion>),
    /// Rotors at equally spaced times from the start on; NaN for a body that failed.
    Stepped {
        /// In s.
        start: f64,
        /// In s.
        duration: f64,
        /// Bodies by frames.
        rotors: Vec<[f64; 4]>,
    },
}

impl Crowd {
    /// The first bodies of the scene's ensemble, at most `count`.
    pub fn new(of: &Opened, count: usize, go_on: GoOn) -> Result<Crowd, String> {
        let Some(ensemble) = &of.scene.ensemble else {
            return Err("this scene has no table [ensemble]".to_owned());
        };
        let count = count.clamp(1, ensemble.number);
        let bodies = of.scene.bodies(ensemble, (&of.body, &of.laws), 0..count);
        let bodies = bodies.map_err(|error| error.to_string())?;
        if of.motion.horizons().is_some() {
            let options = of.scene.options();
            let times = [of.scene.time];
            let follow = |body| bodies.problem(body).simulate(&times, options.clone(), &mut |_| go_on());
            let motions: Result<Vec<Motion>, _> = (0..count).map(follow).collect();
            return motions.map(Crowd::Exact).map_err(|error| error.to_string());
        }
        Ok(Crowd::stepped(&bodies, of, go_on))
    }

    /// One by one, since a browser has no SIMD lanes for many. Bodies beyond the time limit are left out.
    fn stepped(bodies: &Ensemble, of: &Opened, go_on: GoOn) -> Crowd {
        let (start, duration) = (of.scene.time, of.scene.run.duration);
        let times: Vec<f64> =
            (0..FRAMES).map(|k| start + duration * k as f64 / (FRAMES - 1) as f64).collect();
        let mut rotors = Vec::new();
        for body in 0..bodies.starts.len() {
            match bodies.problem(body).simulate(&times, of.scene.options(), &mut |_| go_on()) {
                Ok(motion) => rotors.extend(motion.states().rotors.iter().map(|rotor| rotor.components())),
                Err(SimulateError::Interrupted) => break,
                Err(_) => rotors.extend([[f64::NAN; 4]; FRAMES]),
            }
        }
        Crowd::Stepped { start, duration, rotors }
    }

    /// The rotors at a time. Those of stepped bodies are interpolated between frames, for display only.
    pub fn at(&self, time: f64) -> Vec<[f64; 4]> {
        match self {
            Crowd::Exact(motions) => motions.iter().map(|motion| exactly(motion, time)).collect(),
            Crowd::Stepped { start, duration, rotors } => {
                let frame = ((time - start) / duration).clamp(0.0, 1.0) * (FRAMES - 1) as f64;
                let (k, part) = ((frame as usize).min(FRAMES - 2), frame - frame.floor());
                let part = if frame as usize > k { 1.0 } else { part };
                rotors.chunks_exact(FRAMES).map(|body| turned(body[k], body[k + 1], part)).collect()
            }
        }
    }
}

fn exactly(motion: &Motion, time: f64) -> [f64; 4] {
    let states = motion.exactly(&[time]).and_then(Result::ok);
    states.map_or([f64::NAN; 4], |states| states.rotors[0].components())
}

fn turned(a: [f64; 4], b: [f64; 4], part: f64) -> [f64; 4] {
    if a.iter().chain(&b).any(|x| x.is_nan()) {
        return [f64::NAN; 4];
    }
    between(Rotor::from_unit_components(a), Rotor::from_unit_components(b), part).components()
}
