use super::*;

fn stops(law: impl Fn(f64) -> f64) -> Vec<usize> {
    let value = |k: usize| Bivector([0.0, 0.0, law(k as f64 / SAMPLES as f64)]);
    let values: Vec<Bivector> = (0..=SAMPLES).map(value).collect();
    let mut found = Vec::new();
    bisect(&values, 0..SAMPLES, DEVIATION, &mut found);
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
