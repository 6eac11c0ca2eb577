//! The bodies of an ensemble, for looking at.

use super::{GoOn, Opened};
use crate::recorded::between;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::SimulateError;
use polhode_rigid::ensemble::{Ensemble, Rows, Start};
use polhode_rigid::run::Motion;
use polhode_rigid::state::center::Center;

/// Frames that are kept of bodies that have to be stepped.
const FRAMES: usize = 241;

/// Followed bodies.
pub enum Crowd {
    /// Known at any time.
    Exact(Vec<Motion>),
    /// Rotors, frame by frame, at even times from the start on for a duration; NaN where a body could not be followed.
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
            return Err("this scene is one body, without a table [ensemble]".to_owned());
        };
        let count = count.clamp(1, ensemble.number);
        let drawn =
            ensemble.draw(&of.scene, (&of.body, &of.laws), 0..count).map_err(|error| error.to_string())?;
        let starts = drawn.rotors.iter().zip(&drawn.omegas).zip(&drawn.centers);
        let starts = starts.map(|((rotor, omega), [x, y, z, u, v, w])| Start {
            time: of.scene.time,
            rotor: Rotor::from_unit_components(*rotor),
            omega: Bivector(*omega),
            center: Center { position: Vector([*x, *y, *z]), velocity: Vector([*u, *v, *w]) },
        });
        let laws = drawn.laws.into_iter().chain(of.scene.thrust_torques(&of.body).map(|torque| vec![torque]));
        let bodies = Ensemble {
            inertias: Rows::new(drawn.inertias),
            starts: starts.collect(),
            laws: laws.map(Rows::new).collect(),
            masses: Rows::new(vec![of.body.mass]),
            forces: of.scene.pushes(),
        };
        if of.motion.horizons().is_some() {
            let options = of.scene.options();
            let times = [of.scene.time];
            let follow = |body| bodies.problem(body).simulate(&times, options.clone(), &mut |_| go_on());
            let motions: Result<Vec<Motion>, _> = (0..count).map(follow).collect();
            return motions.map(Crowd::Exact).map_err(|error| error.to_string());
        }
        Ok(Crowd::stepped(&bodies, of, go_on))
    }

    /// One by one: a browser has no lanes in which many would be quicker. Those for which there is no time left are not
    /// shown.
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

    /// The rotors at a time. Those of stepped bodies turn evenly between frames, which is for looking only.
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
