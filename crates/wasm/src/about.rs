//! What is known of a motion besides its states: `About` in `viewer/src/core/core.ts`.

use crate::json::Json;
use crate::opened::Opened;
use polhode_rigid::exact::free::FreeMotion;
use polhode_rigid::exact::lagrange::{LagrangeDescription, LagrangeTop};
use polhode_rigid::exact::regime::FreeDescription;
use polhode_rigid::laws::torque::Torque;
use polhode_rigid::scene::Law;
use polhode_rigid::{Size, Solid};

fn count(n: usize) -> Json {
    Json::Number(n as f64)
}

fn numbers(row: &[f64]) -> Json {
    Json::list(row.iter().copied())
}

/// As a JSON object.
pub fn about(of: &Opened) -> Json {
    let (scene, certificate) = (&of.scene, &of.motion.certificate);
    let conserved = certificate.drifts.iter().map(|(quantity, value, drift)| {
        Json::Object(vec![
            ("name", quantity.name().into()),
            ("value", (*value).into()),
            ("drift", (*drift).into()),
        ])
    });
    let horizon = of.motion.horizons().map(|[past, future]| past.min(future)).filter(|h| h.is_finite());
    let heavy = of.laws.iter().find_map(|law| match law.torque {
        Torque::Heavy(c) => Some(c),
        _ => None,
    });
    Json::Object(vec![
        ("title", Json::or_null(scene.title.clone())),
        ("body", body(of)),
        ("held", scene.is_held().into()),
        ("heavy", Json::or_null(heavy.map(|c| numbers(&c.0)))),
        ("laws", Json::List(of.laws.iter().map(law).collect())),
        (
            "start",
            Json::Object(vec![
                ("rotor", numbers(&scene.attitude.components())),
                ("omega_body", numbers(&scene.omega_body().0)),
                ("time", scene.time.into()),
            ]),
        ),
        ("duration", scene.run.duration.into()),
        ("samples", count(scene.run.samples)),
        ("method", certificate.method.into()),
        ("exact", of.motion.horizons().is_some().into()),
        ("horizon", Json::or_null(horizon)),
        ("steps", Json::Number(certificate.steps as f64)),
        ("error_estimate", Json::or_null(certificate.error_estimate)),
        ("conserved", Json::List(conserved.collect())),
        ("norm_drift", certificate.norm_drift.into()),
        ("free", Json::or_null(free(of).map(described))),
        ("top", Json::or_null(top(of).map(top_described))),
        ("ensemble", Json::or_null(scene.ensemble.as_ref().map(|ensemble| count(ensemble.number)))),
    ])
}

fn body(of: &Opened) -> Json {
    let inertia = of.scene.ruling_inertia(&of.body);
    Json::Object(vec![
        ("mass", Json::or_null(of.scene.tells_mass().then_some(of.body.mass))),
        ("center_of_mass", numbers(&of.body.center_of_mass.0)),
        ("moments", numbers(&inertia.principal_moments())),
        ("frame", numbers(&inertia.principal_frame().components())),
        ("solid", Json::or_null(of.scene.solid().map(solid))),
        ("solid_at", numbers(&of.scene.shift().0)),
        ("mesh", (of.surface.is_some() && of.scene.solid().is_none()).into()),
    ])
}

/// A solid by the names that scenes give its sizes.
pub fn solid(solid: Solid) -> Json {
    let (kind, sizes) = solid.sizes();
    let size = |(name, size): (&'static str, Size)| match size {
        Size::One(length) => (name, length.into()),
        Size::Three(lengths) => (name, numbers(&lengths)),
    };
    Json::Object([("kind", kind.into())].into_iter().chain(sizes.into_iter().map(size)).collect())
}

/// A law by its name, and its formula as in the scene or its numbers.
fn law(law: &Law) -> Json {
    let argument = |(_, own): (_, &[f64])| match own {
        [x] => x.to_string(),
        own => format!("({})", own.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")),
    };
    let text = match (&law.formula, law.torque.registered()) {
        (Some(formula), _) => formula.clone(),
        (None, Some((entry, numbers))) => entry.split(&numbers).map(argument).collect::<Vec<_>>().join(", "),
        (None, None) => String::new(),
    };
    Json::Object(vec![("name", law.name.into()), ("text", text.into())])
}

/// What the invariants of a free motion tell.
fn free(of: &Opened) -> Option<FreeDescription> {
    let turned = !of.laws.is_empty() || of.scene.thrust_torques(&of.body).next().is_some();
    if turned {
        return None;
    }
    let inertia = of.scene.ruling_inertia(&of.body);
    FreeMotion::new(&inertia, of.scene.attitude, of.scene.omega_body()).ok().map(|motion| motion.describe())
}

/// What the invariants of a symmetric top under its weight alone tell.
fn top(of: &Opened) -> Option<LagrangeDescription> {
    let [Law { torque: Torque::Heavy(c), .. }] = of.laws[..] else { return None };
    let inertia = of.scene.ruling_inertia(&of.body);
    LagrangeTop::new(&inertia, of.scene.attitude, of.scene.omega_body(), c).ok().map(|top| top.describe())
}

fn top_described(top: LagrangeDescription) -> Json {
    Json::Object(vec![
        ("regime", top.regime.to_string().into()),
        ("tilt", numbers(&[top.tilt_min, top.tilt_max])),
        ("nutation_period", Json::or_null(top.nutation_period)),
        ("precession_rate", Json::or_null(top.precession_rate)),
        ("critical_spin", top.critical_spin.into()),
        ("sleeps", top.sleeps.into()),
    ])
}

fn described(free: FreeDescription) -> Json {
    Json::Object(vec![
        ("regime", free.regime.to_string().into()),
        ("modulus", free.modulus.into()),
        ("axis", count(free.axis + 1)),
        ("period", Json::or_null(free.period)),
        ("precession_period", Json::or_null(free.precession_period())),
        ("flip_time", Json::or_null(free.flip_time())),
    ])
}
