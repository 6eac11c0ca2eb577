//! Facts of a motion besides its states: `About` in `viewer/src/core/core.ts`.

use crate::opened::Opened;
use polhode_rigid::facts::{Fact, Facts};
use polhode_rigid::{Solid, facts};
use serde_json::{Map, Value};

/// The facts of a motion as a JSON object.
pub fn about(of: &Opened) -> Value {
    let (scene, certificate) = (&of.scene, &of.motion.certificate);
    let setup = &of.setup;
    let conserved = certificate.drifts.iter();
    let conserved =
        conserved.map(|(kept, value, drift)| facts! { name: kept.name(), value: *value, drift: *drift });
    let horizon = of.motion.horizons().map(|[past, future]| past.min(future)).filter(|h| h.is_finite());
    let start = facts! {
        rotor: setup.rotor.components(), omega_body: setup.omega.0, time: setup.time,
    };
    let mut facts = facts! {
        title: scene.title.clone(), caption: scene.caption.clone(), body: body(of), start: start,
        laws: of.laws.iter().map(|law| law.facts()).collect::<Vec<_>>(),
        duration: scene.run.duration, samples: scene.run.samples,
        method: certificate.method, exact: of.motion.horizons().is_some(), horizon: horizon,
        steps: certificate.steps as usize, error_estimate: certificate.error_estimate,
        conserved: conserved.collect::<Vec<_>>(), norm_drift: certificate.norm_drift,
        ensemble: scene.ensemble.as_ref().map(|ensemble| ensemble.number),
    };
    facts.extend(setup.facts());
    json(facts.into())
}

fn body(of: &Opened) -> Facts {
    let inertia = of.scene.ruling_inertia(&of.body);
    facts! {
        mass: of.scene.has_mass().then_some(of.body.mass), center_of_mass: of.body.center_of_mass.0,
        moments: inertia.principal_moments(), frame: inertia.principal_frame().components(),
        solid: of.scene.solid().map(|solid| solid.facts()), solid_at: of.scene.shift().0,
        mesh: of.surface.is_some() && of.scene.solid().is_none(),
    }
}

/// A solid as JSON, with the field names of a scene.
pub fn solid(solid: Solid) -> Value {
    json(solid.facts().into())
}

/// A fact as JSON, with `null` for numbers that are not finite.
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
