use super::*;

#[test]
fn compositions_are_consistent() {
    for method in &COMPOSITIONS {
        let gammas: Vec<f64> = method.stages().0.iter().map(|&(_, gamma)| gamma).collect();
        let sum: f64 = gammas.iter().sum();
        assert!((sum - 1.0).abs() < 4e-16, "{} {sum}", method.name);
        // Order > 2 needs Σγ³ = 0, order > 4 Σγ⁵ = 0.
        let power = |k: i32| gammas.iter().map(|g| g.powi(k)).sum::<f64>();
        assert!(method.order == 2 || power(3).abs() < 4e-15, "{} {}", method.name, power(3));
        assert!(method.order < 6 || power(5).abs() < 4e-14, "{} {}", method.name, power(5));
    }
}

#[test]
fn kicks_and_drifts_sum_to_one() {
    let (stages, last) = RKN6.stages();
    assert_eq!(stages.len(), 11);
    let kicks: f64 = stages.iter().map(|s| s.0).sum::<f64>() + last;
    let drifts: f64 = stages.iter().map(|s| s.1).sum();
    assert!((kicks - 1.0).abs() < 1e-15 && (drifts - 1.0).abs() < 1e-15, "{kicks} {drifts}");
    for i in 0..11 {
        assert_eq!(stages[i].1, stages[10 - i].1);
        assert_eq!(if i == 0 { last } else { stages[11 - i].0 }, stages[i].0);
    }
}
