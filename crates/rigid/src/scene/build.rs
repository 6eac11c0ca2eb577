//! Builds the body and the laws of a scene.

use super::{BodySpec, Gravity, Law, Scene};
use crate::body::Body;
use crate::body::inertia::Inertia;
use crate::body::mesh::{MeshError, MeshProblem, TriangleMesh};
use crate::body::solids::{Amount, Solid};
use crate::body::surface::Surface;
use crate::error::BodyError;
use crate::laws::torque::Torque;
use crate::state::checks::check_moments;
use polhode_ga::diagnostic::Diagnostic;
use polhode_ga::{Rotor, Vector};
use std::path::Path;

/// Loads a mesh by its path; relative paths start at the folder of the scene.
pub type MeshSource<'a> = &'a dyn Fn(&Path) -> Result<TriangleMesh, MeshError>;

impl Gravity {
    /// The law on a body whose fixed point is the origin of its axes.
    pub(super) fn law(&self, body: &Body) -> Law {
        let torque = Torque::Heavy(body.weight_moment(self.acceleration, Vector::default()));
        Law { name: "gravity", torque, formula: None }
    }
}

impl Scene {
    /// The body and its torque laws. Under gravity the body is shifted so that the fixed point is the origin of its axes;
    /// then `c = m g (centre of mass)`.
    pub fn build(&self) -> Result<(Body, Vec<Law>), Vec<Diagnostic>> {
        self.build_with(&TriangleMesh::read)
    }

    /// The same with another source of meshes, as in a browser, which has no files.
    pub fn build_with(&self, mesh: MeshSource<'_>) -> Result<(Body, Vec<Law>), Vec<Diagnostic>> {
        let body = self.body_with(mesh)?;
        let body = match self.gravity {
            None => body,
            Some(_) => {
                let body = body.moved(Rotor::IDENTITY, self.shift());
                body.map_err(|error| vec![self.diagnose("gravity.pivot", error.to_string())])?
            }
        };
        let (body, laws) = self.with_laws(body)?;
        self.check_points((&body, &laws))?;
        self.check_times().map_err(|error| vec![error])?;
        Ok((body, laws))
    }

    /// The body, whose origin is the fixed point if there is one, with its laws.
    pub(super) fn with_laws(&self, body: Body) -> Result<(Body, Vec<Law>), Vec<Diagnostic>> {
        let weight = self.gravity.map(|gravity| gravity.law(&body));
        let laws = weight.into_iter().chain(self.torques.iter().cloned()).collect();
        let held = self.is_held();
        if held && !self.forces.is_empty() {
            let message = "the body is held at a fixed point, where no force moves it; remove [force]";
            return Err(vec![self.diagnose("force", message)]);
        }
        self.check_weight(&body)?;
        let inertia = if held { body.inertia_about(Vector::default()) } else { Ok(body.inertia) };
        let inertia = inertia.map_err(|error| vec![self.diagnose("gravity.pivot", error.to_string())])?;
        check_moments(inertia.principal_moments())
            .map_err(|error| vec![self.diagnose(self.shape_field(), error.to_string())])?;
        Ok((body, laws))
    }

    /// The weight of `heavy` must act at the centre of mass. Moments without a centre of mass are about the fixed point and
    /// leave it open.
    fn check_weight(&self, body: &Body) -> Result<(), Vec<Diagnostic>> {
        let open = match self.body {
            BodySpec::Moments { center_of_mass, .. } | BodySpec::Inertia { center_of_mass, .. } => {
                center_of_mass == Vector::default()
            }
            BodySpec::Mesh { .. } | BodySpec::Solid { .. } => false,
        };
        for law in self.torques.iter().filter(|_| !open) {
            if let Torque::Heavy(c) = law.torque
                && !body.has_weight_moment(c)
            {
                let (Vector([a, b, c]), Vector([x, y, z])) = (c, body.center_of_mass);
                let message = format!(
                    "({a}, {b}, {c}) N m is not m g times the centre of mass, which is ({x}, {y}, {z}) m from the fixed point; use [gravity] with a pivot, or give the moments about the fixed point without a centre of mass"
                );
                return Err(vec![self.diagnose("torque.heavy", message)]);
            }
        }
        Ok(())
    }

    /// The output times must increase.
    fn check_times(&self) -> Result<(), Diagnostic> {
        if self.times().is_sorted_by(|a, b| a < b) {
            return Ok(());
        }
        let message = format!(
            "its output times in {} s are equal after rounding beside the start at {:e} s; start earlier",
            self.run.duration, self.time
        );
        Err(self.diagnose("initial.time", message))
    }

    /// The body alone, its mesh read from its file.
    pub fn build_body(&self) -> Result<Body, Vec<Diagnostic>> {
        self.body_with(&TriangleMesh::read)
    }

    /// The body; impossible properties are reported at their field.
    ///
    /// A free motion does not depend on the mass, so a body given by its inertia alone has 1 kg; under gravity the mass is
    /// required.
    fn body_with(&self, mesh: MeshSource<'_>) -> Result<Body, Vec<Diagnostic>> {
        let body = match &self.body {
            BodySpec::Mesh { amount, .. } => self.mesh_body(mesh, *amount),
            BodySpec::Solid { solid, amount } => {
                solid.body(*amount).map_err(|error| self.body_error(&error, "body.solid", Some(*amount)))
            }
            BodySpec::Moments { moments, mass, center_of_mass } => {
                let inertia = Inertia::from_principal_moments(*moments);
                self.given_body(inertia, *mass, *center_of_mass, "body.moments")
            }
            BodySpec::Inertia { matrix, mass, center_of_mass } => {
                self.given_body(Inertia::from_matrix(*matrix), *mass, *center_of_mass, "body.inertia")
            }
        };
        body.map_err(|error| vec![error])
    }

    /// Whether the body is held at a fixed point.
    pub fn is_held(&self) -> bool {
        self.gravity.is_some() || self.torques.iter().any(|law| matches!(law.torque, Torque::Heavy(_)))
    }

    /// The field that gives the body.
    fn shape_field(&self) -> &'static str {
        match self.body {
            BodySpec::Mesh { .. } => "body.mesh",
            BodySpec::Solid { .. } => "body.solid",
            BodySpec::Moments { .. } => "body.moments",
            BodySpec::Inertia { .. } => "body.inertia",
        }
    }

    /// Whether the file gives the mass, or values that determine it.
    pub fn has_mass(&self) -> bool {
        !matches!(self.body, BodySpec::Moments { mass: None, .. } | BodySpec::Inertia { mass: None, .. })
    }

    /// The solid of the scene, if any.
    pub fn solid(&self) -> Option<Solid> {
        match self.body {
            BodySpec::Solid { solid, .. } => Some(solid),
            _ => None,
        }
    }

    /// The mesh of the body, in metres, if it has one.
    pub fn mesh_with(&self, mesh: MeshSource<'_>) -> Option<Result<TriangleMesh, MeshError>> {
        let BodySpec::Mesh { file, length_unit, .. } = &self.body else { return None };
        let path = self.path.parent().unwrap_or(Path::new("")).join(file);
        Some(mesh(&path).and_then(|mesh| mesh.scaled(*length_unit)))
    }

    /// The surface of the body's solid or mesh, in body axes in metres; None if the body has neither.
    pub fn surface_with(&self, mesh: MeshSource<'_>) -> Option<Result<Surface, MeshError>> {
        let surface = match self.solid() {
            Some(solid) => Ok(Surface::of_solid(solid)),
            None => self.mesh_with(mesh)?.map(|mesh| Surface::of_mesh(&mesh)),
        };
        Some(surface.map(|surface| surface.transformed(|x| x + self.shift())))
    }

    fn mesh_body(&self, mesh: MeshSource<'_>, amount: Amount) -> Result<Body, Diagnostic> {
        let none = || Err(self.diagnose("body", "has no mesh"));
        let Some(mesh) = self.mesh_with(mesh) else { return none() };
        mesh.and_then(|mesh| mesh.body(amount)).map_err(|error| match error {
            MeshError { problem: MeshProblem::Body(error), .. } => {
                self.body_error(&error, "body.mesh", Some(amount))
            }
            error => self.diagnose("body.mesh", error.to_string()),
        })
    }

    fn given_body(
        &self,
        inertia: Result<Inertia, BodyError>,
        mass: Option<f64>,
        center_of_mass: Vector,
        field: &str,
    ) -> Result<Body, Diagnostic> {
        let reason = match center_of_mass == Vector::default() {
            _ if self.gravity.is_some() => Some("gravity acts on the mass"),
            _ if !self.forces.is_empty() => Some("a force moves the mass"),
            false if self.is_held() => Some("the inertia about the fixed point depends on the mass"),
            _ => None,
        };
        if let (None, Some(reason)) = (mass, reason) {
            return Err(self.diagnose("body", format!("{reason}, add the field `mass`")));
        }
        let body = inertia.and_then(|inertia| Body::new(mass.unwrap_or(1.0), inertia, center_of_mass));
        body.map_err(|error| self.body_error(&error, field, None))
    }

    /// The error at the field that causes it, by default `field`.
    fn body_error(&self, error: &BodyError, field: &str, amount: Option<Amount>) -> Diagnostic {
        let cause = match (error, amount) {
            (BodyError::Mass(_), Some(Amount::Mass(_))) => "body.mass",
            (BodyError::Mass(_) | BodyError::NoVolume { .. }, _) => "body.density",
            (BodyError::InnerRadius { .. }, _) => "body.inner_radius",
            (BodyError::SpindleTorus { .. }, _) => "body.minor_radius",
            _ => field,
        };
        self.diagnose(cause, error.to_string())
    }
}
