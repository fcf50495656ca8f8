//! Decides whether an item reaches no farther from a place than so: in plain arithmetic where that can tell, exactly where not.
//!
//! *Problem.* w·|p − c| compared with ρ = Σ ρₖ, all of them `f64`.
//! *Idea.* With u = 2⁻⁵³, S = Σ (w·(pⱼ − cⱼ)·2ᵏ)² in `f64` and eight partial sums is w²|p − c|²4ᵏ up to a factor between
//! (1 − κ)² and (1 + κ)² for κ ≥ mu/2 + 4u, m = d/8 + 16 roundings a square; κ = (m + 24)u also covers the rounding of the
//! thresholds with which S is compared, and what underflows: less than 2⁻⁷⁰⁰ where 2ᵏ brings the reach to [1, 2), for
//! weights between 2⁻²⁰⁰ and 2²⁰⁰, and for others where w·2ᵏ is no subnormal number. A reach of 0, and one less than any
//! two places are apart, asks for equal coordinates. The second stage is the same in whole numbers of any length, for the
//! few items about which S says nothing.
//! *Guarantee.* No item is misjudged, so no answer depends on the order of a sum.

use std::cmp::Ordering;

use taut_points::Cancelled;

use super::meter::Meter;
use crate::arithmetic::{Integer, Ring, U, parts};

const LANES: usize = 8;

/// A coordinate takes this many steps in whole numbers.
const EXACT_STEPS: usize = 60;

/// A multiplication by the power of two that brings a length near 1; exact, but for what underflows beside it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    pub(super) up: f64,
}

impl Scale {
    /// Brings `length` to [1, 4), but for 0 and the least subnormal numbers.
    pub(super) fn of(length: f64) -> Self {
        let exponent = (1023 - (length.to_bits() >> 52 & 0x7ff) as i64).clamp(-1022, 1000);
        if length == 0.0 {
            return Scale { up: 1.0 };
        }
        Scale { up: f64::from_bits(((exponent + 1023) as u64) << 52) }
    }
}

/// (p − q)·2ᵏ of one coordinate, also where p − q itself is beyond the range.
pub(super) fn difference(p: f64, q: f64, scale: Scale) -> f64 {
    let plain = p - q;
    // Halves of numbers so large are exact.
    if plain.is_finite() { plain * scale.up } else { (0.5 * p - 0.5 * q) * (2.0 * scale.up) }
}

/// κ of the head, for positions of `dim` coordinates.
pub(super) fn kappa(dim: usize) -> f64 {
    ((dim / LANES + 16) + 24) as f64 * U
}

/// Returns what differences are multiplied by, one after the other: 2ᵏ and the weight, or for a weight far from 1 their product,
/// which is exact. `None` where that leaves the range, so that S cannot be trusted.
#[inline(always)]
pub(super) fn factors(weight: f64, scale: Scale) -> Option<[f64; 2]> {
    const WEIGHT_MIN: f64 = f64::from_bits((1023 - 200) << 52);
    const WEIGHT_MAX: f64 = f64::from_bits((1023 + 200) << 52);
    if (WEIGHT_MIN..=WEIGHT_MAX).contains(&weight) {
        return Some([scale.up, weight]);
    }
    let product = scale.up * weight;
    product.is_normal().then_some([product, 1.0])
}

/// S of the head.
#[inline(always)]
pub(super) fn square<A, B>(p: &[A], c: &[B], factors: [f64; 2]) -> f64
where
    A: Copy + Into<f64>,
    B: Copy + Into<f64>,
{
    let square = |x: A, c: B| {
        let difference = (x.into() - c.into()) * factors[0] * factors[1];
        difference * difference
    };
    let (head, rest) = p.as_chunks::<LANES>();
    let (center_head, center_rest) = c.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for (x, c) in head.iter().zip(center_head) {
        for lane in 0..LANES {
            sums[lane] += square(x[lane], c[lane]);
        }
    }
    let [a, b, c, d, e, f, g, h] = sums;
    let head = ((a + e) + (c + g)) + ((b + f) + (d + h));
    rest.iter().zip(center_rest).fold(head, |sum, (&x, &c)| sum + square(x, c))
}

/// The squares below and above which S tells that the item reaches less or more than `rho`, a sum rounded once; 0 and 0
/// where it is negative.
#[inline(always)]
pub(super) fn thresholds(rho: f64, kappa: f64, scale: Scale) -> (f64, f64) {
    let rho = (rho * scale.up).max(0.0);
    let (inside, beyond) = (rho * (1.0 - kappa), rho * (1.0 + kappa));
    (inside * inside, beyond * beyond)
}

/// w·|p − c| compared with Σ `rho`.
pub(super) fn compare<A, B>(
    p: &[A],
    c: &[B],
    weight: f64,
    rho: &[f64],
    scale: Scale,
    meter: &mut Meter<'_>,
) -> Result<Ordering, Cancelled>
where
    A: Copy + Into<f64>,
    B: Copy + Into<f64>,
{
    meter.spend(p.len())?;
    if let Some(plainly) = plainly(p, c, weight, rho, scale) {
        return Ok(plainly);
    }
    meter.spend(EXACT_STEPS * (p.len() + 1))?;
    Ok(exactly(p, c, weight, rho))
}

/// The same, where it can be told without whole numbers.
fn plainly<A, B>(p: &[A], c: &[B], weight: f64, rho: &[f64], scale: Scale) -> Option<Ordering>
where
    A: Copy + Into<f64>,
    B: Copy + Into<f64>,
{
    // The sum of two is rounded once: its sign is right.
    let sum: f64 = match rho {
        [_] | [_, _] => rho.iter().sum(),
        _ => return None,
    };
    if sum < 0.0 {
        return Some(Ordering::Greater);
    }
    // Different places are 2⁻¹⁰⁷⁴ apart or more, and what rounds to 0 is less.
    if sum / weight == 0.0 {
        let is_same = is_same_place(p, c);
        return match (is_same, sum == 0.0) {
            (true, true) => Some(Ordering::Equal),
            (true, false) => Some(Ordering::Less),
            (false, _) => Some(Ordering::Greater),
        };
    }
    let factors = factors(weight, scale)?;
    let (inside, beyond) = thresholds(sum, kappa(p.len()), scale);
    let square = square(p, c, factors);
    match () {
        // Beside less than this, and at infinity, what under- and overflows matters.
        () if inside < 1e-150 || square == f64::INFINITY => None,
        () if square < inside => Some(Ordering::Less),
        () if square > beyond => Some(Ordering::Greater),
        () => None,
    }
}

/// Returns true if two places are one, coordinate by coordinate.
#[inline(always)]
pub(super) fn is_same_place<A, B>(p: &[A], c: &[B]) -> bool
where
    A: Copy + Into<f64>,
    B: Copy + Into<f64>,
{
    p.iter().zip(c).all(|(&x, &c)| x.into() == c.into())
}

/// |p − q| compared with ρ/w + ρ/v.
///
/// The quotients and their sum are rounded once each; what underflows is nothing beside a sum of 1e-290 or more. In whole
/// numbers it is |p − q|·w·v that is compared with ρ·(w + v).
pub(super) fn compare_weighted(
    p: &[f64],
    q: &[f64],
    [w, v]: [f64; 2],
    rho: f64,
    meter: &mut Meter<'_>,
) -> Result<Ordering, Cancelled> {
    let sum = rho / w + rho / v;
    if (1e-290..=f64::MAX).contains(&sum) {
        let scale = Scale::of(sum);
        let (inside, beyond) = thresholds(sum, kappa(p.len()) + 4.0 * U, scale);
        let square = square(p, q, [scale.up, 1.0]);
        match () {
            () if square == f64::INFINITY => {}
            () if square < inside => return Ok(Ordering::Less),
            () if square > beyond => return Ok(Ordering::Greater),
            () => {}
        }
    }
    meter.spend(EXACT_STEPS * (p.len() + 4))?;
    let least = |values: &mut dyn Iterator<Item = &f64>| -> i32 {
        values.filter(|&&value| value != 0.0).map(|&value| parts(value).1).min().unwrap_or(0)
    };
    let of_places = least(&mut p.iter().chain(q));
    let of_weights = least(&mut [w, v].iter());
    let [w, v] = [w, v].map(|weight| Integer::scaled(weight, of_weights));
    let of_rho = parts(rho).1;
    let differences = p
        .iter()
        .zip(q)
        .map(|(&x, &y)| Integer::scaled(x, of_places).minus(&Integer::scaled(y, of_places)));
    let square = |value: &Integer| value.times(value);
    let distance = differences.fold(Integer::scaled(0.0, 0), |sum, d| sum.plus(&square(&d)));
    let left = distance.times(&square(&w.times(&v)));
    let right = square(&Integer::scaled(rho, of_rho).times(&w.plus(&v)));
    // Both are multiples of a power of four; the larger power is brought to the other.
    let shift = of_places + of_weights - of_rho;
    let power = |shift: i32| square(&Integer::scaled(1.0, -shift.max(0)));
    Ok(left.times(&power(shift)).minus(&right.times(&power(-shift))).sign())
}

/// The same in whole numbers.
fn exactly<A, B>(p: &[A], c: &[B], weight: f64, rho: &[f64]) -> Ordering
where
    A: Copy + Into<f64>,
    B: Copy + Into<f64>,
{
    #[cfg(test)]
    tests::EXACTLY.set(tests::EXACTLY.get() + 1);
    let least = |values: &mut dyn Iterator<Item = f64>| -> Option<i32> {
        values.filter(|&value| value != 0.0).map(|value| parts(value).1).min()
    };
    let of_places = least(&mut p.iter().map(|&x| x.into()).chain(c.iter().map(|&x| x.into())));
    let of_weight = parts(weight).1;
    let of_rho = least(&mut rho.iter().copied());
    // The power of two that all lengths are multiples of.
    let unit = match (of_places, of_rho) {
        (Some(places), Some(rho)) => (places + of_weight).min(rho),
        (Some(places), None) => places + of_weight,
        (None, Some(rho)) => rho,
        (None, None) => return Ordering::Equal,
    };
    let zero = Integer::scaled(0.0, 0);
    let mut distance = zero.clone();
    for (&x, &c) in p.iter().zip(c) {
        let [x, c] = [x.into(), c.into()].map(|value| Integer::scaled(value, unit - of_weight));
        let difference = x.minus(&c);
        distance = distance.plus(&difference.times(&difference));
    }
    let weight = Integer::scaled(weight, of_weight);
    let distance = distance.times(&weight.times(&weight));
    let rho = rho.iter().fold(zero, |sum, &value| sum.plus(&Integer::scaled(value, unit)));
    match rho.sign() {
        Ordering::Less => Ordering::Greater,
        _ => distance.minus(&rho.times(&rho)).sign(),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::cell::Cell;

    use taut_points::Monitor;

    use super::*;

    thread_local! {
        /// The number of times that this thread took the second stage.
        pub(in super::super) static EXACTLY: Cell<u64> = const { Cell::new(0) };
    }

    fn compared(p: &[f64], c: &[f64], weight: f64, rho: &[f64]) -> Ordering {
        let scale = Scale::of(rho[0]);
        let mut meter = Meter::of(&Monitor::silent());
        let found = compare(p, c, weight, rho, scale, &mut meter).unwrap();
        assert_eq!(found, exactly(p, c, weight, rho), "{p:?} {c:?} {weight} {rho:?}");
        found
    }

    #[test]
    fn ties_and_ulps_are_told_at_every_scale() {
        for scale in [1.0, 2f64.powi(-900), 2f64.powi(900), 2f64.powi(-1060), 2f64.powi(1020)] {
            let (p, c) = ([3.0 * scale, 0.0], [0.0, 4.0 * scale]);
            assert_eq!(compared(&p, &c, 1.0, &[5.0 * scale]), Ordering::Equal);
            assert_eq!(compared(&p, &c, 1.0, &[(5.0 * scale).next_up()]), Ordering::Less);
            assert_eq!(compared(&p, &c, 1.0, &[(5.0 * scale).next_down()]), Ordering::Greater);
            assert_eq!(compared(&p, &c, 0.5, &[2.5 * scale]), Ordering::Equal);
            assert_eq!(compared(&p, &c, 1.0, &[6.0 * scale, -scale]), Ordering::Equal);
            assert_eq!(compared(&p, &c, 1.0, &[scale, -2.0 * scale]), Ordering::Greater);
        }
        assert_eq!(compared(&[1.0], &[1.0], 1.0, &[0.0]), Ordering::Equal);
        assert_eq!(compared(&[f64::MAX], &[-f64::MAX], 1.0, &[f64::MAX]), Ordering::Greater);
        assert_eq!(compared(&[f64::MAX], &[0.0], 1e-308, &[2.0]), Ordering::Less);
        assert_eq!(compared(&[5e-324], &[0.0], 1e308, &[5e-16]), Ordering::Less);
        assert_eq!(compared(&[5e-324], &[0.0], 1e308, &[4e-16]), Ordering::Greater);
        assert_eq!(compared(&[5e-324], &[0.0], 1e308, &[1e-300]), Ordering::Greater);
        assert_eq!(compared(&[1e-310], &[1e-310], 1e308, &[1e-300]), Ordering::Less);
        assert_eq!(compared(&[2.0], &[1.0], 1e250, &[1e250]), Ordering::Equal);
        assert_eq!(compared(&[1e200], &[0.0], 1e-250, &[1e-51]), Ordering::Greater);
    }

    #[test]
    fn weighted_points_are_told_apart_at_every_scale() {
        let apart = |distance: f64, weights: [f64; 2], rho: f64| {
            let mut meter = Meter::of(&Monitor::silent());
            let [first, other] = [[1.0, distance], [1.0, 0.0]];
            compare_weighted(&first, &other, weights, rho, &mut meter).unwrap()
        };
        // wvD/(w + v) = 2·1·3/(2 + 1).
        for power in [0, -300, -1000, 300, 1000] {
            let scale = 2f64.powi(power);
            assert_eq!(apart(3.0, [2.0 * scale, scale], 2.0 * scale), Ordering::Equal);
            assert_eq!(apart(3.0, [2.0 * scale, scale], (2.0 * scale).next_up()), Ordering::Less);
            assert_eq!(
                apart(3.0, [scale, 2.0 * scale], (2.0 * scale).next_down()),
                Ordering::Greater
            );
            assert_eq!(apart(3.0 * scale, [2.0, 1.0], 2.0 * scale), Ordering::Equal);
        }
        // The lighter item counts alone, whatever the other weighs.
        for heavy in [1e50, 1e150, 1e300] {
            assert_eq!(apart(3.0, [heavy, 1e-150], 2.99e-150), Ordering::Greater);
            assert_eq!(apart(3.0, [heavy, 1e-150], 3.01e-150), Ordering::Less);
            assert_eq!(apart(3.0, [heavy, 1e-150], 3e-150), Ordering::Less);
        }
        assert_eq!(apart(5e-324, [1e300, 1e-300], 1e-323), Ordering::Less);
        assert_eq!(apart(f64::MAX, [1e-300, 1e-300], 1e300), Ordering::Less);
    }
}
