//! What is known of a motion besides its states: `About` in `viewer/src/core/core.ts`.

use crate::opened::Opened;
use polhode_rigid::facts::{Fact, Facts};
use serde_json::{Map, Value};

/// The facts of a motion as a JSON object.
pub fn about(of: &Opened) -> Value {
    let (scene, certificate) = (&of.scene, &of.motion.certificate);
    let setup = scene.setup(&of.body, &of.laws);
    let conserved = certificate.drifts.iter().map(|(quantity, value, drift)| {
        vec![("name", quantity.name().into()), ("value", (*value).into()), ("drift", (*drift).into())]
    });
    let horizon = of.motion.horizons().map(|[past, future]| past.min(future)).filter(|h| h.is_finite());
    let start: Facts = vec![
        ("rotor", setup.rotor.components().into()),
        ("omega_body", setup.omega.0.into()),
        ("time", setup.time.into()),
    ];
    let mut facts = vec![
        ("title", scene.title.clone().into()),
        ("body", body(of).into()),
        ("laws", of.laws.iter().map(|law| law.facts()).collect::<Vec<_>>().into()),
        ("start", start.into()),
        ("duration", scene.run.duration.into()),
        ("samples", scene.run.samples.into()),
        ("method", certificate.method.into()),
        ("exact", of.motion.horizons().is_some().into()),
        ("horizon", horizon.into()),
        ("steps", (certificate.steps as usize).into()),
        ("error_estimate", certificate.error_estimate.into()),
        ("conserved", conserved.collect::<Vec<_>>().into()),
        ("norm_drift", certificate.norm_drift.into()),
        ("ensemble", scene.ensemble.as_ref().map(|ensemble| ensemble.number).into()),
    ];
    facts.extend(setup.facts());
    json(facts.into())
}

fn body(of: &Opened) -> Facts {
    let inertia = of.scene.ruling_inertia(&of.body);
    vec![
        ("mass", of.scene.has_mass().then_some(of.body.mass).into()),
        ("center_of_mass", of.body.center_of_mass.0.into()),
        ("moments", inertia.principal_moments().into()),
        ("frame", inertia.principal_frame().components().into()),
        ("solid", of.scene.solid().map(|solid| solid.facts()).into()),
        ("solid_at", of.scene.shift().0.into()),
        ("mesh", of.mesh().is_some().into()),
    ]
}

/// A fact as JSON, in which numbers that are not finite are `null`.
pub fn json(fact: Fact) -> Value {
    match fact {
        Fact::None => Value::Null,
        Fact::Flag(flag) => flag.into(),
        Fact::Count(count) => count.into(),
        Fact::Number(x) => x.into(),
        Fact::Text(text) => text.into(),
        Fact::List(facts) => facts.into_iter().map(json).collect(),
        Fact::Table(facts) => Value::Object(
            facts.into_iter().map(|(name, fact)| (name.to_owned(), json(fact))).collect::<Map<_, _>>(),
        ),
    }
}
