use super::*;

#[test]
fn decimals_are_exact_where_they_can_be() {
    let ratio = |text| Number::decimal(text).unwrap().ratio;
    assert_eq!(ratio("0.25"), Some((1, 4)));
    assert_eq!(ratio("12"), Some((12, 1)));
    assert_eq!(ratio("1e-3"), Some((1, 1000)));
    assert_eq!(ratio("1.5e+2"), Some((150, 1)));
    assert_eq!(ratio("1e-30"), None);
    assert_eq!(Number::decimal("1e999"), None);
    assert_eq!(Number::decimal("1e-999"), None);
    assert_eq!(ratio("0.0e+999"), Some((0, 1)));
    assert_eq!(Number::decimal("1e-3").unwrap().value, 0.001);
}

#[test]
fn ratios_are_in_lowest_terms() {
    assert_eq!(Number::ratio(6, -4).unwrap().ratio, Some((-3, 2)));
    assert_eq!(Number::ratio(1, 0), None);
    let half = Number::ratio(1, 2).unwrap();
    assert_eq!(half.times(Number::whole(4)).ratio, Some((2, 1)));
    assert_eq!(Number::whole(1).over(Number::whole(3)).unwrap().ratio, Some((1, 3)));
    assert_eq!(half.over(Number::whole(0)), None);
}

#[test]
fn numbers_print_so_that_they_are_read_again() {
    for x in [0.1, 1.0 / 3.0, 1e-7, 1.5e300, 5e-324, f64::MAX, 2f64.powi(60)] {
        let text = Number::float(x).to_string();
        assert_eq!(Number::decimal(&text).unwrap().value, x, "{text}");
    }
    assert_eq!(Number::float(1e20).to_string(), "1e+20");
    // The first is the shortest text of the float, and another decimal fraction; the last are no ratios.
    for text in
        ["8.000000000000002", "8.000000000000001", "0.1", "0.100000000000000000001", "9007199254740993", "0"]
    {
        let number = Number::decimal(text).unwrap();
        assert_eq!(Number::decimal(&number.to_string()).unwrap(), number, "{text}");
    }
}
