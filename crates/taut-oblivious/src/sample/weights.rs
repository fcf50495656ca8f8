//! Binomial and hypergeometric numbers.
//!
//! *Idea.* From the mode outwards, each probability is the one before times a ratio of small products. Their sum over all
//! that matters makes a proper distribution of them, so neither factorials nor logarithms are needed, and nothing
//! cancels for a population of 2⁶⁴.
//! *Guarantee.* Probabilities are right to a relative 2⁻⁴⁰ while the variance is below 2⁴⁰; what is left out on both sides
//! is below 2⁻⁶⁰ of the whole. O(√variance) time. Addition, multiplication and division only, so that all machines agree.
//! *Trap.* Logarithms of factorials of 2⁴⁰ are 10¹³, of which double precision leaves two digits behind the point.
//! *Reference.* L. Devroye, *Non-Uniform Random Variate Generation*, 1986, chapter X (inversion from the mode).

use super::random::Random;

/// Weights below this share of the mode's no longer count.
const WEIGHT_RATIO_MIN: f64 = 1e-22;

/// Returns how many of `draws` numbers without replacement from `population` are among the first `first` of them.
pub(super) fn hypergeometric(random: &mut Random, population: u64, first: u64, draws: u64) -> u64 {
    let low = draws.saturating_sub(population - first);
    let high = draws.min(first);
    // As a fraction, (draws + 1)(first + 1) / (population + 2).
    let top = (u128::from(draws) + 1) * (u128::from(first) + 1);
    let mode = (top / (u128::from(population) + 2)) as u64;
    // P(x + 1) / P(x)
    let up = |x: u64| {
        // population − first − draws + x + 1, which is positive for x from `low`.
        let other = (population - first) as i128 - i128::from(draws) + i128::from(x) + 1;
        ((draws - x) as f64 * (first - x) as f64) / ((x + 1) as f64 * other as f64)
    };
    walk(random, low, high, mode.clamp(low, high), up)
}

/// Returns how many of `n` events of probability `p` happen.
pub(super) fn binomial(random: &mut Random, n: u64, p: f64) -> u64 {
    if p <= 0.0 || n == 0 {
        return 0;
    }
    if p >= 1.0 {
        return n;
    }
    let odds = p / (1.0 - p);
    let mode = ((n as f64 + 1.0) * p) as u64;
    let up = |x: u64| (n - x) as f64 / (x as f64 + 1.0) * odds;
    walk(random, 0, n, mode.min(n), up)
}

/// A number from `low` to `high` whose weights have the ratios `up(x)` = weight(x + 1) / weight(x) and a peak near `mode`.
fn walk(random: &mut Random, low: u64, high: u64, mode: u64, up: impl Fn(u64) -> f64) -> u64 {
    let mut sum = 1.0;
    let (mut weight, mut x) = (1.0, mode);
    while x < high && weight > WEIGHT_RATIO_MIN {
        weight *= up(x);
        sum += weight;
        x += 1;
    }
    let top = x;
    (weight, x) = (1.0, mode);
    while x > low && weight > WEIGHT_RATIO_MIN {
        x -= 1;
        weight /= up(x);
        sum += weight;
    }
    let bottom = x;
    // The same numbers in the same order, taken off one by one until the lot falls.
    let mut lot = random.unit() * sum - 1.0;
    if lot <= 0.0 {
        return mode;
    }
    weight = 1.0;
    for x in mode..top {
        weight *= up(x);
        lot -= weight;
        if lot <= 0.0 {
            return x + 1;
        }
    }
    weight = 1.0;
    for x in (bottom..mode).rev() {
        weight /= up(x);
        lot -= weight;
        if lot <= 0.0 {
            return x;
        }
    }
    // Rounding left a crumb of some 2⁻⁴⁵, which goes to the end that was looked at last.
    bottom
}
