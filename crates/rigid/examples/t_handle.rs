//! A T-handle in free flight: it turns over again and again, and its motion is exact at any time.
//!
//! `cargo run -p polhode-rigid --example t_handle`

use polhode_ga::{Bivector, Rotor, Vector};
use polhode_rigid::exact::free::FreeMotion;
use polhode_rigid::{Amount, Solid};
use std::f64::consts::{FRAC_PI_2, TAU};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A bar along e1 and a stem along e2, both of steel. A cylinder has its axis along e3, so each is turned.
    let steel = Amount::Density(7850.0); // kg/m³
    let to_e1 = Rotor::from_plane_angle(Bivector([0.0, 1.0, 0.0]), FRAC_PI_2)?;
    let to_e2 = Rotor::from_plane_angle(Bivector([1.0, 0.0, 0.0]), -FRAC_PI_2)?;
    let bar = Solid::Cylinder { radius: 0.008, height: 0.12 }.body(steel)?.moved(to_e1, Vector::default())?;
    let stem = Solid::Cylinder { radius: 0.008, height: 0.06 }.body(steel)?;
    let body = bar.combine(&stem.moved(to_e2, Vector([0.0, 0.038, 0.0]))?)?;

    // Five turns a second about the stem, the axis of the middle moment, and a thousandth of it about the others.
    let spin = Bivector([0.005, 5.0, 0.005]) * TAU;
    let motion = FreeMotion::new(&body.inertia, Rotor::IDENTITY, spin)?;
    let facts = motion.describe();
    let flip = facts.flip_time().ok_or("the spin has no component off the middle axis")?;
    println!("{:.3} kg of steel, {}: turns over every {flip:.4} s\n", body.mass, facts.regime);

    println!("  t in s      Ω in the body, turns/s    stem in space           change of |L|");
    for eighth in 0..=8 {
        let time = 0.25 * f64::from(eighth) * flip;
        let (rotor, omega) = motion.at(time);
        let ([x, y, z], [u, v, w]) = ((omega / TAU).0, rotor.apply(Vector([0.0, 1.0, 0.0])).0);
        let change = body.inertia.apply(omega).norm() / facts.angular_momentum - 1.0;
        println!("{time:8.4}  {x:8.3}{y:8.3}{z:8.3}    {u:6.3}  {v:6.3}  {w:6.3}  {change:14.1e}");
    }
    Ok(())
}
