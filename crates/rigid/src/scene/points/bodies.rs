//! The bodies of an ensemble, each with the scene of its point.

use super::Points;
use super::cursor::{Cursor, Point};
use crate::body::Body;
use crate::body::inertia::Inertia;
use crate::body::mesh::{MeshError, MeshProblem};
use crate::ensemble::{self, Rows, Start};
use crate::laws::force::{Force, Push};
use crate::laws::torque::Torque;
use crate::scene::{DrawError, Ensemble, Law, Scene};
use polhode_ga::diagnostic::Diagnostic;
use std::mem::discriminant;
use std::ops::Range;
use std::path::PathBuf;

impl Scene {
    /// A range of the bodies of an ensemble, from the body and the laws of [`Scene::build`]; the torques of thrusts follow
    /// these laws. An error only for values of points that do not fit together, and for numbers beyond the range of floats.
    pub fn bodies(
        &self,
        ensemble: &Ensemble,
        built: (&Body, &[Law]),
        bodies: Range<usize>,
    ) -> Result<ensemble::Ensemble, DrawError> {
        let Some(points) = &ensemble.points else { return self.drawn(ensemble, built, bodies) };
        let mut cursor = Cursor::new(points, &self.text);
        let mut rows = Collected::default();
        for index in bodies {
            let failed = |message| DrawError { body: index, message };
            let point = cursor.read(index % points.number).map_err(|problems| {
                failed(problems.into_iter().map(|(_, message)| message).collect::<Vec<_>>().join("; "))
            })?;
            let (scene, body, laws) = self.at_point(point, built).map_err(failed)?;
            rows.add(scene.drawn(ensemble, (&body, &laws), index..index + 1)?);
        }
        Ok(rows.ensemble(&self.shared(ensemble, points, built)))
    }

    /// Checks the bodies and the laws of all points.
    pub(in crate::scene) fn check_points(&self, built: (&Body, &[Law])) -> Result<(), Vec<Diagnostic>> {
        let Some(points) = self.ensemble.as_ref().and_then(|ensemble| ensemble.points.as_ref()) else {
            return Ok(());
        };
        if !points.vary(&["body", "gravity", "torque", "force", "define"]) {
            return Ok(());
        }
        let mut cursor = Cursor::new(points, &self.text);
        for point in 0..points.number {
            // Errors of single values have been reported.
            let Ok(own) = cursor.read(point) else { continue };
            if let Err(why) = self.at_point(own, built) {
                let message = format!("{}: {why}", points.describe(&self.text, point));
                return Err(vec![self.diagnose(&format!("ensemble.{}", points.form), message)]);
            }
        }
        Ok(())
    }

    /// The scene of a point, its body and its laws.
    fn at_point(&self, point: Point, (body, _): (&Body, &[Law])) -> Result<(Scene, Body, Vec<Law>), String> {
        let mut scene = Scene {
            title: None,
            caption: None,
            body: point.body.unwrap_or_else(|| self.body.clone()),
            attitude: self.attitude,
            spin: self.spin,
            spin_frame: self.spin_frame,
            center: self.center,
            time: self.time,
            gravity: point.gravity.or(self.gravity),
            torques: self.torques.clone(),
            forces: self.forces.clone(),
            run: self.run.clone(),
            ensemble: None,
            path: PathBuf::new(),
            text: String::new(),
        };
        if let Some(initial) = point.initial {
            (scene.attitude, scene.spin, scene.spin_frame) =
                (initial.attitude, initial.spin, initial.spin_frame);
            scene.center = initial.center;
        }
        for law in point.laws {
            replace(
                &mut scene.torques,
                law,
                |law| law.name,
                |a, b| discriminant(&a.torque) == discriminant(&b.torque),
            )?;
        }
        for push in point.forces {
            replace(&mut scene.forces, push, force_name, |a, b| {
                discriminant(&a.force) == discriminant(&b.force)
            })?;
        }
        let pivot = |scene: &Scene| scene.gravity.map(|gravity| gravity.pivot);
        let built = if scene.body != self.body || pivot(&scene) != pivot(self) {
            let unread = |path: &std::path::Path| {
                let problem =
                    MeshProblem::Mesh("a mesh and its pivot are the same for all bodies".to_owned());
                Err(MeshError { name: path.display().to_string(), problem })
            };
            scene.build_with(&unread)
        } else {
            scene.with_laws(*body)
        };
        let (body, laws) = built.map_err(|problems| {
            problems.into_iter().map(|problem| problem.message).collect::<Vec<_>>().join("; ")
        })?;
        Ok((scene, body, laws))
    }

    /// Which properties all bodies share.
    fn shared(&self, ensemble: &Ensemble, points: &Points, (_, laws): (&Body, &[Law])) -> Shared {
        let defines = points.vary(&["define"]);
        let bodies = defines || points.vary(&["body", "gravity.pivot"]);
        let law = |law: &Law| match law.name {
            _ if ensemble.parameters.iter().any(|(parameter, _)| parameter.law == law.name) => false,
            "gravity" => !bodies && !points.vary(&["gravity"]),
            name => !defines && !points.vary(&[&format!("torque.{name}")]),
        };
        let force = |push: &Push| !defines && !points.vary(&[&format!("force.{}", force_name(push))]);
        Shared {
            inertia: !bodies && ensemble.moments.is_none(),
            mass: !bodies,
            laws: laws.iter().map(law).collect(),
            thrusts: !bodies && !points.vary(&["force"]),
            forces: self.forces.iter().map(force).collect(),
        }
    }
}

fn force_name(push: &Push) -> &'static str {
    push.registered().map_or("", |(entry, _)| entry.name)
}

/// Replaces the law of the same name, by one of the same kind.
fn replace<T>(
    laws: &mut [T],
    own: T,
    name: impl Fn(&T) -> &'static str,
    alike: impl Fn(&T, &T) -> bool,
) -> Result<(), String> {
    let Some(place) = laws.iter_mut().find(|law| name(law) == name(&own)) else { return Ok(()) };
    if !alike(place, &own) {
        return Err(format!("`{}` is a law of another kind than in the scene", name(&own)));
    }
    *place = own;
    Ok(())
}

/// Whether all bodies share a property.
struct Shared {
    inertia: bool,
    mass: bool,
    laws: Vec<bool>,
    /// The torques of thrusts, which follow the laws.
    thrusts: bool,
    forces: Vec<bool>,
}

/// Properties of bodies, one after the other.
#[derive(Default)]
struct Collected {
    inertias: Vec<Inertia>,
    starts: Vec<Start>,
    laws: Vec<Vec<Torque>>,
    masses: Vec<f64>,
    forces: Vec<Vec<Force>>,
}

impl Collected {
    /// Adds an ensemble of one body.
    fn add(&mut self, one: ensemble::Ensemble) {
        self.inertias.push(*one.inertias.of(0));
        self.starts.extend(one.starts);
        self.masses.push(*one.masses.of(0));
        self.laws.resize_with(one.laws.len(), Vec::new);
        self.laws.iter_mut().zip(&one.laws).for_each(|(all, law)| all.push(law.of(0).clone()));
        self.forces.resize_with(one.forces.len(), Vec::new);
        self.forces.iter_mut().zip(&one.forces).for_each(|(all, force)| all.push(force.of(0).clone()));
    }

    /// All bodies; of shared properties one is kept.
    fn ensemble(self, shared: &Shared) -> ensemble::Ensemble {
        let each = |k: usize, known: &[bool], rest: bool| known.get(k).copied().unwrap_or(rest);
        let laws = self.laws.into_iter().enumerate();
        let forces = self.forces.into_iter().enumerate();
        ensemble::Ensemble {
            inertias: rows(self.inertias, shared.inertia),
            starts: self.starts,
            laws: laws.map(|(k, law)| rows(law, each(k, &shared.laws, shared.thrusts))).collect(),
            masses: rows(self.masses, shared.mass),
            forces: forces.map(|(k, force)| rows(force, each(k, &shared.forces, true))).collect(),
        }
    }
}

fn rows<T>(mut rows: Vec<T>, shared: bool) -> Rows<T> {
    if shared {
        rows.truncate(1);
    }
    Rows::new(rows)
}
