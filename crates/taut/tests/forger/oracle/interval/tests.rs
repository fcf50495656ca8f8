//! Intervals contain what they must, and little more.

use super::Interval;
use super::functions::pi;

fn exact(value: f64) -> Interval {
    Interval::exact(value).unwrap()
}

/// Returns true if the interval contains the decimal number, and is narrow.
fn is_at(x: &Interval, decimal: &str) -> bool {
    let (whole, digits) = decimal.split_once('.').unwrap();
    let numerator: num_bigint::BigInt = format!("{whole}{digits}").parse().unwrap();
    let ten = Interval::integer(10);
    let scale = (0..digits.len()).fold(Interval::integer(1), |s, _| s.times(&ten));
    let number = Interval::of(numerator, 0, super::Radius::ZERO).over(&scale).unwrap();
    let off = x.minus(&number).absolute();
    // The decimals are good to one unit in their last place.
    let unit = Interval::integer(1).over(&scale).unwrap();
    off.at_most(&unit) == Some(true) && x.spread().scaled(230).at_most(&x.absolute()) == Some(true)
}

#[test]
fn constants_and_logarithms_are_those_of_tables() {
    assert!(is_at(pi(), "3.14159265358979323846264338327950288419716939937510582097494459"));
    let ln = |v: f64| exact(v).ln().unwrap();
    assert!(is_at(&ln(2.0), "0.693147180559945309417232121458176568075500134360255254120680009"));
    assert!(is_at(&ln(10.0), "2.302585092994045684017991454684364207601101488628772976033327901"));
    assert!(is_at(
        &exact(1.0).exp().unwrap(),
        "2.71828182845904523536028747135266249775724709369995957496696763"
    ));
    assert!(is_at(
        &exact(2.0).root().unwrap(),
        "1.41421356237309504880168872420969807856967187537694807317667974"
    ));
    assert!(is_at(
        &Interval::fraction(1, 3).unwrap(),
        "0.333333333333333333333333333333333333333333333333333333333"
    ));
    assert!(Interval::integer(1).ln().unwrap().is_zero());
}

/// Sums and products of `f64` at both ends of the range are exact; nothing over- or underflows.
#[test]
fn the_ends_of_the_range_are_no_limit() {
    let (small, large) = (exact(5e-324), exact(f64::MAX));
    assert!(small.is_positive());
    assert!(
        large.plus(&small).minus(&large).minus(&small).is_zero()
            || large.plus(&small).spread().is_positive()
    );
    let product = large.times(&large).times(&small).times(&small);
    let back = product.over(&large).and_then(|p| p.over(&large)).unwrap();
    assert!(
        back.minus(&small.square()).absolute().at_most(&small.square().scaled(-250)) == Some(true)
    );
    assert_eq!(large.rounded(), f64::MAX);
    assert_eq!(small.rounded(), 5e-324);
    assert_eq!(large.square().rounded(), f64::INFINITY);
    assert_eq!(exact(-1.5).rounded(), -1.5);
    assert!(Interval::exact(f64::NAN).is_none() && Interval::exact(f64::INFINITY).is_none());
    let log = large.ln().unwrap().rounded();
    assert_eq!(log, f64::MAX.ln());
    assert_eq!(small.ln().unwrap().rounded(), 5e-324f64.ln());
}

/// What depends on the choice of numbers is not decided.
#[test]
fn comparisons_of_intervals_that_overlap_are_undecided() {
    let third = Interval::fraction(1, 3).unwrap();
    let one = third.times(&Interval::integer(3));
    assert_eq!(one.at_most(&Interval::integer(1)), None);
    assert_eq!(one.minus(&Interval::integer(1)).sign(), None);
    assert!(Interval::integer(1).over(&one.minus(&Interval::integer(1))).is_none());
    assert!(one.minus(&Interval::integer(1)).ln().is_none());
    let root = one.minus(&Interval::integer(1)).root().unwrap();
    assert!(root.sign().is_none() && root.spread().rounded() < 1e-36);
    assert!(Interval::integer(-1).root().is_none());
    assert_eq!(exact(1.0).at_most(&exact(1.0)), Some(true));
    assert_eq!(exact(1.0 + f64::EPSILON).at_most(&exact(1.0)), Some(false));
}

/// Identities that hold for real numbers hold for some choice from the intervals, over numbers of many sizes.
#[test]
fn identities_are_contained() {
    let mut state = 20_260_726u64;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let unit = (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
        unit * 2f64.powi((state % 200) as i32 - 100)
    };
    let contains_zero = |x: &Interval| x.is_zero() || x.sign().is_none();
    for _ in 0..2000 {
        let (a, b, c) = (exact(next()), exact(next()), exact(next()));
        let quotient = a.over(&b).unwrap();
        assert!(contains_zero(&quotient.times(&b).minus(&a)));
        let left = quotient.plus(&c).square();
        let right = quotient.square().plus(&quotient.times(&c).scaled(1)).plus(&c.square());
        assert!(contains_zero(&left.minus(&right)));
        let root = a.absolute().root().unwrap();
        assert!(contains_zero(&root.square().minus(&a.absolute())));
        let (x, y) = (a.absolute(), quotient.absolute());
        let log = x.times(&y).ln().unwrap();
        assert!(contains_zero(&log.minus(&x.ln().unwrap()).minus(&y.ln().unwrap())));
        assert!(contains_zero(&y.ln().unwrap().exp().unwrap().minus(&y)));
        // The radius is not lost: bounds of a quotient that is off by it enclose the product.
        assert!(quotient.lower().at_most(&quotient.upper()) == Some(true));
    }
}
