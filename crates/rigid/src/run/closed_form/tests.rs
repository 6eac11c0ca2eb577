use super::*;

#[test]
fn drift_of_a_closed_form_is_an_error() {
    let drifts = |energy: f64| [(Conserved::AngularMomentum, 1e-15), (Conserved::Energy, energy)];
    assert_eq!(check_kept(drifts(1e-12)), Ok(()));
    let error = check_kept(drifts(4e22)).unwrap_err();
    assert!(error.to_string().starts_with("the energy of the closed form drifts by 4.0e22"));
    assert!(check_kept(drifts(f64::NAN)).is_err());
}
