//! Bodies of an ensemble, for display.

use super::{GoOn, Opened, in_words};
use crate::recorded::between;
use polhode_ga::Rotor;
use polhode_rigid::SimulateError;
use polhode_rigid::run::Motion;
use polhode_rigid::scene::Ensemble;
use std::ops::Range;

/// Number of stored frames of bodies without a closed form.
const FRAMES: usize = 241;

/// Computed bodies.
pub enum Crowd {
    /// Known at any time.
    Exact(Vec<Motion>),
    /// Known at some times, from the start on.
    Stepped {
        /// In s.
        start: f64,
        /// In s.
        duration: f64,
        /// The bodies.
        slice: Slice,
    },
}

/// Consecutive bodies without a closed form. A body never depends on the others, so the slices of several cores have the
/// same bits as one slice.
#[derive(Default)]
pub struct Slice {
    /// Rotors at equally spaced times, bodies by frames; NaN for bodies that are not known.
    pub rotors: Vec<[f64; 4]>,
    /// Why the first of these is not known, with its number; empty if all are.
    pub problem: String,
}

impl Crowd {
    /// The first bodies of the scene's ensemble, at most `count`.
    pub fn new(of: &Opened, count: usize, go_on: GoOn) -> Result<Crowd, String> {
        if of.motion.horizons().is_none() {
            return Ok(Crowd::of_slice(of, Slice::new(of, 0..count, go_on)?));
        }
        let ensemble = ensemble(of)?;
        let count = count.clamp(1, ensemble.number);
        let bodies = of.scene.bodies(ensemble, (&of.body, &of.laws), 0..count);
        let bodies = bodies.map_err(|error| error.to_string())?;
        let options = of.scene.options();
        let follow = |body| {
            let motion = bodies.problem(body).simulate(&[of.scene.time], options.clone(), &mut |_| go_on());
            motion.map_err(|error| problem(body, error))
        };
        (0..count).map(follow).collect::<Result<Vec<Motion>, String>>().map(Crowd::Exact)
    }

    /// The first bodies, computed by [`Slice::new`].
    pub fn of_slice(of: &Opened, slice: Slice) -> Crowd {
        Crowd::Stepped { start: of.scene.time, duration: of.scene.run.duration, slice }
    }

    /// See [`Slice::problem`].
    pub fn problem(&self) -> &str {
        match self {
            Crowd::Exact(_) => "",
            Crowd::Stepped { slice, .. } => &slice.problem,
        }
    }

    /// The rotors at a time. Those of stepped bodies are interpolated between frames, for display only.
    pub fn at(&self, time: f64) -> Vec<[f64; 4]> {
        match self {
            Crowd::Exact(motions) => motions.iter().map(|motion| exactly(motion, time)).collect(),
            Crowd::Stepped { start, duration, slice } => {
                let frame = ((time - start) / duration).clamp(0.0, 1.0) * (FRAMES - 1) as f64;
                let (k, part) = ((frame as usize).min(FRAMES - 2), frame - frame.floor());
                let part = if frame as usize > k { 1.0 } else { part };
                slice.rotors.chunks_exact(FRAMES).map(|body| turned(body[k], body[k + 1], part)).collect()
            }
        }
    }
}

impl Slice {
    /// Computes bodies of the scene's ensemble: one by one, because the code of lanes would add 0.8 MB to the core. Those beyond
    /// the time limit are not known.
    pub fn new(of: &Opened, bodies: Range<usize>, go_on: GoOn) -> Result<Slice, String> {
        let ensemble = ensemble(of)?;
        let bodies = bodies.start.min(ensemble.number)..bodies.end.min(ensemble.number);
        let (start, duration) = (of.scene.time, of.scene.run.duration);
        let times: Vec<f64> =
            (0..FRAMES).map(|k| start + duration * k as f64 / (FRAMES - 1) as f64).collect();
        let mut slice = Slice::default();
        match of.scene.bodies(ensemble, (&of.body, &of.laws), bodies.clone()) {
            Ok(drawn) => {
                for (k, body) in bodies.clone().enumerate() {
                    let found = drawn.problem(k).simulate(&times, of.scene.options(), &mut |_| go_on());
                    if !slice.add(body, found) {
                        break;
                    }
                }
            }
            Err(error) => slice.problem = error.to_string(),
        }
        slice.rotors.resize(bodies.len() * FRAMES, [f64::NAN; 4]);
        Ok(slice)
    }

    /// Adds the next body; false if the time is over.
    fn add(&mut self, body: usize, found: Result<Motion, SimulateError>) -> bool {
        match found {
            Ok(motion) => {
                self.rotors.extend(motion.states().rotors.iter().map(|rotor| rotor.components()));
                true
            }
            Err(error) => {
                let on_time = error != SimulateError::Interrupted;
                if self.problem.is_empty() {
                    self.problem = problem(body, error);
                }
                self.rotors.extend([[f64::NAN; 4]; FRAMES]);
                on_time
            }
        }
    }
}

fn ensemble(of: &Opened) -> Result<&Ensemble, String> {
    of.scene.ensemble.as_ref().ok_or_else(|| "this scene has no table [ensemble]".to_owned())
}

fn problem(body: usize, error: SimulateError) -> String {
    format!("body {body}: {}", in_words(error))
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
