//! Whether numbers come from a density with one peak, or a valley lies between two.

/// One of this many numbers at either end is not looked at, so that none of them alone makes the range much wider.
const NUMBERS_PER_TAIL: usize = 128;

/// In how many parts of the range numbers are counted: so many that each holds eight, within bounds.
const NUMBERS_PER_PART: usize = 8;
const PARTS: [usize; 2] = [8, 48];

/// A valley is sparser than all numbers by this factor: less says little, and takes long to look at.
const VALLEY_DENSITY_RATIO: f64 = 0.75;

/// A side is at most this many times doubled as wide as the part: all parts, at the least.
const DOUBLINGS_MAX: usize = 6;

/// What is less than this of a bound is less than the bound for all that rounding does.
const ROUNDING: f64 = 1.0 - 1e-9;

/// A part of a range with fewer numbers than on either side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Valley {
    /// −ln of the most that chance could make of it, were the density to have one peak.
    pub(super) evidence: f64,
    /// How dense numbers are in it, over the sparser side.
    pub(super) density: f64,
}

/// The valley of ascending numbers for which there is most evidence.
///
/// A density with one peak falls from it to both sides, so on one side of any part it is no greater than within. Of the numbers
/// in the part and on that side the share in the part is then no less than its share in the width, but by chance.
pub(super) fn valley(numbers: &[f64]) -> Valley {
    let mut deepest = Valley { evidence: 0.0, density: 1.0 };
    let (count, edge) = (numbers.len(), numbers.len() / NUMBERS_PER_TAIL);
    let (low, high) = (numbers[edge], numbers[count - 1 - edge]);
    let parts = (count / NUMBERS_PER_PART).clamp(PARTS[0], PARTS[1]);
    let border = |part: usize| low + (high - low) * part as f64 / parts as f64;
    let below: Vec<usize> =
        (0..=parts).map(|part| numbers.partition_point(|&x| x < border(part))).collect();
    let within = |from: usize, to: usize| (below[to] - below[from]) as f64;
    let most = VALLEY_DENSITY_RATIO * within(0, parts) / parts as f64;
    for from in 1..parts {
        for to in from + 1..parts {
            let (inside, width) = (within(from, to), (to - from) as f64);
            if inside > most * width {
                continue;
            }
            // Sides as wide as the part, twice that, and so on: the best of each, if it is more than what was found so far.
            let least = deepest.evidence;
            let best = |side: &dyn Fn(usize) -> [usize; 2]| {
                let of = |doublings: usize| {
                    let [start, end] = side((to - from) << doublings);
                    let (beside, wide) = (within(start, end), (end - start) as f64);
                    (evidence_above(least, [inside, beside], [width, wide]), beside / wide)
                };
                (0..DOUBLINGS_MAX)
                    .map(of)
                    .fold((0.0, 1.0), |best, one| if one.0 > best.0 { one } else { best })
            };
            let left = best(&|wide| [from.saturating_sub(wide), from]);
            if left.0 <= least {
                continue;
            }
            let right = best(&|wide| [to, parts.min(to + wide)]);
            if left.0.min(right.0) > deepest.evidence {
                deepest = Valley {
                    evidence: left.0.min(right.0),
                    density: inside / width / left.1.min(right.1),
                };
            }
        }
    }
    deepest
}

/// −ln of the most that chance would make of so few of all numbers in the first of two intervals, if they were as dense there as in the
/// second (Chernoff's bound for binomial distributions).
pub(super) fn evidence(counts: [f64; 2], widths: [f64; 2]) -> f64 {
    let (all, width) = (counts[0] + counts[1], widths[0] + widths[1]);
    let expected = widths.map(|part| all * part / width);
    if counts[0] >= expected[0] {
        return 0.0;
    }
    let term = |k: usize| match counts[k] > 0.0 {
        true => counts[k] * (counts[k] / expected[k]).ln(),
        false => 0.0,
    };
    term(0) + term(1)
}

/// The [`evidence`], or 0 where χ² shows that it is no more than `least`: ln x ≤ x − 1, so χ² is an upper bound.
///
/// Logarithms of hopeless parts took most of the time of this module.
fn evidence_above(least: f64, counts: [f64; 2], widths: [f64; 2]) -> f64 {
    let all = counts[0] + counts[1];
    let surplus = counts[1] * widths[0] - counts[0] * widths[1];
    let is_hopeless = surplus * surplus < ROUNDING * least * all * widths[0] * widths[1];
    if is_hopeless { 0.0 } else { evidence(counts, widths) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers at even quantiles of densities.
    fn spread(count: usize, quantile: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..count).map(|k| quantile((k as f64 + 0.5) / count as f64)).collect()
    }

    #[test]
    fn densities_with_one_peak_have_no_valley() {
        let triangle =
            |q: f64| if q < 0.5 { (2.0 * q).sqrt() } else { 2.0 - (2.0 - 2.0 * q).sqrt() };
        for count in [64, 130, 5000] {
            for quantile in [&|q| q, &triangle as &dyn Fn(f64) -> f64, &|q| q * q * q] {
                let found = valley(&spread(count, quantile));
                assert!(found.evidence < 0.5, "{count}: {found:?}");
            }
        }
        assert_eq!(valley(&[1.0; 64]).evidence, 0.0);
    }

    #[test]
    fn an_empty_tenth_is_a_valley_by_as_much_as_numbers_are_many() {
        let bands = |q: f64| if q < 0.5 { q } else { q + 0.1 };
        let found = [100, 200, 400, 800].map(|count| valley(&spread(count, bands)));
        assert!(found.iter().all(|valley| valley.density < 0.5), "{found:?}");
        assert!(found[0].evidence > 2.5 && found[3].evidence > 40.0, "{found:?}");
        assert!(
            found.windows(2).all(|pair| pair[1].evidence > 1.4 * pair[0].evidence),
            "{found:?}"
        );
    }

    #[test]
    fn what_is_not_above_is_nothing() {
        for low in 0..30u32 {
            for [own, other] in [[1.0, 1.0], [1.0, 4.0], [5.0, 2.0]] {
                let (counts, widths) = ([f64::from(low), 30.0], [own, other]);
                let all = evidence(counts, widths);
                for least in [0.0, 0.1, 0.5, 0.9, 0.999].map(|share| share * all) {
                    assert_eq!(evidence_above(least, counts, widths), all);
                }
                let found = evidence_above(all, counts, widths);
                assert!(found == all || found == 0.0);
            }
        }
        assert_eq!(evidence_above(9.0, [20.0, 30.0], [1.0, 1.0]), 0.0);
    }

    /// Of 20 numbers none fall within the half of the width: 2⁻²⁰.
    #[test]
    fn chance_is_that_of_coins() {
        let found = evidence([0.0, 20.0], [1.0, 1.0]);
        assert!((found - 20.0 * 2f64.ln()).abs() < 1e-12);
        assert_eq!(evidence([5.0, 5.0], [1.0, 1.0]), 0.0);
        assert_eq!(evidence([0.0, 0.0], [1.0, 1.0]), 0.0);
    }
}
