//! What acts on a body: `Acting` in `viewer/src/core/core.ts`.

use crate::about::json;
use crate::opened::Opened;
use polhode_ga::{Bivector, Rotor};
use polhode_rigid::describe::acting::Source;
use polhode_rigid::facts;
use serde_json::Value;

/// The torque in space, the vectors that the laws depend on, and the thrusts, at a time, attitude and angular velocity.
pub fn acting(of: &Opened, state: [f64; 8]) -> Result<Value, String> {
    let [time, s, x, y, z, omega @ ..] = state;
    let rotor = Rotor::from_unit_components([s, x, y, z]);
    let torque = of.setup.torque_in_space(time, rotor, Bivector(omega)).map_err(|error| error.message)?;
    let thrusts = of.scene.thrusts(&of.body).map(|(force, at)| facts! { along: force.0, at: at.0 });
    let facts = facts! {
        torque: torque.0,
        sources: of.setup.sources(time).iter().map(Source::facts).collect::<Vec<_>>(),
        thrusts: thrusts.collect::<Vec<_>>(),
    };
    Ok(json(facts.into()))
}
