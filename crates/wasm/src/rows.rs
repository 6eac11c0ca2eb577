//! Rows of numbers for states, in the order of `State` in `viewer/src/core/core.ts`.

use polhode_rigid::run::States;

/// Numbers in a row: time 1, R 4, Ω_B 3, Ω_S 3, L_B 3, L_S 3, energy 1, position 3, velocity 3.
pub const ROW: usize = 24;

/// The rows of states.
pub fn rows(states: &States) -> Vec<[f64; ROW]> {
    let row = |k: usize| {
        let (rotor, omega, momentum) = (states.rotors[k], states.omegas[k], states.momenta_space[k]);
        let parts: [&[f64]; 9] = [
            &[states.times[k]],
            &rotor.components(),
            &omega.0,
            &rotor.apply_bivector(omega).0,
            &rotor.reverse().apply_bivector(momentum).0,
            &momentum.0,
            &[states.energies[k]],
            &states.centers[k].position.0,
            &states.centers[k].velocity.0,
        ];
        let mut row = [0.0; ROW];
        row.iter_mut().zip(parts.into_iter().flatten()).for_each(|(place, number)| *place = *number);
        row
    };
    (0..states.times.len()).map(row).collect()
}
