//! Rotations as rotors: turn a vector, compose two turns, and go half of the way.
//!
//! `cargo run -p polhode-ga --example rotate`

use polhode_ga::{MathError, Rotor, Vector};

fn show(what: &str, Vector([x, y, z]): Vector) {
    println!("{what:<24}{x:>8.4} e1{y:>8.4} e2{z:>8.4} e3");
}

fn main() -> Result<(), MathError> {
    let [e1, e2, e3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector);
    let right = 90_f64.to_radians();

    // A plane and an angle define a rotor, R = exp(−Bθ/2); it acts as R a ~R.
    let first = Rotor::from_plane_angle(e1.wedge(e2), right)?;
    show("e1, turned in e1∧e2", first.apply(e1));

    // The product applies the right factor first: a turn in e1∧e2, then one in e2∧e3.
    let both = Rotor::from_plane_angle(e2.wedge(e3), right)? * first;
    show("then in e2∧e3", both.apply(e1));

    // The two turns are one, about the axis that the plane is dual to.
    let (plane, angle) = both.plane_angle();
    show("axis of both", plane.dual());
    println!("{:<24}{:>8.4}°", "angle of both", angle.to_degrees());

    // The logarithm is a bivector, which can be scaled.
    let half = Rotor::exp(both.log() * 0.5);
    show("e1, half of the way", half.apply(e1));

    // Quaternions are rotors with other names and signs.
    let [w, x, y, z] = both.to_quaternion_wxyz();
    println!("{:<24}{w:>8.4}   {x:>8.4}   {y:>8.4}   {z:>8.4}", "quaternion of both");
    Ok(())
}
