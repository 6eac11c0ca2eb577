use super::*;

fn stops(law: impl Fn(f64) -> f64) -> Vec<usize> {
    let value = |k: usize| Bivector([0.0, 0.0, law(k as f64 / SAMPLES as f64)]);
    let values: Vec<Bivector> = (0..=SAMPLES).map(value).collect();
    let (mut found, mut finest) = (Vec::new(), Vec::new());
    bisect(&values, 0..SAMPLES, DEVIATION, &mut found, &mut finest);
    found
}

#[test]
fn a_smooth_law_has_no_stops() {
    assert!(stops(|x| x.sin() + x * x).is_empty());
}

#[test]
fn stops_surround_a_pulse() {
    let found = stops(|x| (-((x - 0.3) / 1e-3).powi(2)).exp());
    let near = found.iter().filter(|&&k| (k as f64 / SAMPLES as f64 - 0.3).abs() < 5e-3).count();
    assert!(near >= 4 && found.len() < 60, "{near} of {}", found.len());
    assert!(found.windows(2).all(|pair| pair[0] < pair[1]));
}

/// The stops of a law in the finest interval of the samples around a change at 0.3.
fn finer_stops(law: impl Fn(f64) -> f64) -> Vec<f64> {
    let values = |times: &[f64]| Some(times.iter().map(|&t| Bivector([0.0, 0.0, law(t)])).collect());
    let (finer, mut left) = (Finer { values: &values, allowed: DEVIATION, least: LEAST }, MOST_FINER_EACH);
    let mut found = Vec::new();
    finer.bisect([0.2995, 0.3005], &mut left, &mut found);
    assert!(left > 0 && found.is_sorted());
    found
}

#[test]
fn stops_surround_a_jump_closely() {
    let found = finer_stops(|x| (x - 0.3 - 1e-5_f64.sqrt() * 1e-2).signum());
    let jump = 0.3 + 1e-5_f64.sqrt() * 1e-2;
    let (before, after) = found.split_at(found.partition_point(|&x| x < jump));
    assert!(after[0] - before[before.len() - 1] <= 2.0 * LEAST, "{found:?}");
    assert!(found.len() < 40, "{}", found.len());
}

#[test]
fn stops_resolve_a_change_that_is_sharper_than_the_samples() {
    let width = 1e-6;
    let found = finer_stops(|x| (x - 0.3) / ((x - 0.3).powi(2) + width * width).sqrt());
    let near: Vec<f64> = found.iter().map(|x| x - 0.3).filter(|x| x.abs() < 3.0 * width).collect();
    assert!(near.len() >= 4, "{near:?}");
    assert!(finer_stops(|x| x.sin()).is_empty());
}
