//! What acts on a body: `Acting` in `viewer/src/core/core.ts`.

use crate::about::json;
use crate::opened::Opened;
use crate::rows::ROW;
use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::describe::acting::Source;
use polhode_rigid::facts;
use polhode_rigid::state::point::Seen;
use serde_json::Value;

/// The torque in space, the vectors that the laws depend on, and the thrusts, in the state of a row of states.
pub fn acting(of: &Opened, row: [f64; ROW]) -> Result<Value, String> {
    let [time, s, x, y, z, a, b, c, .., px, py, pz, u, v, w] = row;
    let state = Seen {
        time,
        rotor: Rotor::from_unit_components([s, x, y, z]),
        omega: Bivector([a, b, c]),
        position: Vector([px, py, pz]),
        velocity: Vector([u, v, w]),
    };
    let torque = of.setup.torque_in_space(&state).map_err(|error| error.message)?;
    let thrusts = of.scene.thrusts(&of.body).map(|(force, at)| facts! { along: force.0, at: at.0 });
    let facts = facts! {
        torque: torque.0,
        sources: of.setup.sources(time).iter().map(Source::facts).collect::<Vec<_>>(),
        thrusts: thrusts.collect::<Vec<_>>(),
    };
    Ok(json(facts.into()))
}
