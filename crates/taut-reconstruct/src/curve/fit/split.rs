//! Whether the residuals of a window are those of two strands: a valley between them that chance does not leave.
//!
//! *Problem.* Two strands a few half-widths of noise apart lie in one window, which grows until it is flat beside both together.
//! *Idea.* A density with one peak falls from it to both sides, so it is no less in a part of the range than on one side of that part. How
//! little chance would leave of a part with so few residuals is bounded for either side (Chernoff); the valley is the part for which
//! the lesser of both bounds is most.
//! *Guarantee.* A function of the residuals, in any order; O(n), and a bounded number of parts. Sorting them took a tenth of the time of fits.

/// Fewest residuals that are asked. Chosen.
pub(super) const SPLIT_POINTS_MIN: usize = 24;

/// The evidence that is asked is no more than this. With 6, windows of honest bands of 20 000 points were split, and curves lost. Chosen.
const EVIDENCE_MAX: f64 = 9.0;

/// Parts of the range: each holds a few residuals.
const POINTS_PER_PART: usize = 6;
const PARTS: [usize; 2] = [6, 24];

/// A valley is sparser than all residuals by this factor.
const VALLEY_DENSITY_RATIO: f64 = 0.5;

/// What is less than this of a bound is less than the bound for all that rounding does.
const ROUNDING: f64 = 1.0 - 1e-9;

/// One of so many residuals at either end is not looked at.
const POINTS_PER_TAIL: usize = 64;

/// The least evidence for a valley in a window, where so many points are searched: −ln of the chance that is left to each of half as many
/// windows, so that about one of them is split by chance. Measured: half of the points rather than all of them, or a quarter, serve
/// circles and folds best.
pub(super) fn evidence_min(points: usize) -> f64 {
    (0.5 * points as f64).ln().min(EVIDENCE_MAX)
}

/// The middle of the valley of residuals, which change their order, if there is one with at least this much evidence.
pub(super) fn split(residuals: &mut [f64], least: f64) -> Option<f64> {
    let (count, tail) = (residuals.len(), residuals.len() / POINTS_PER_TAIL);
    if count < SPLIT_POINTS_MIN {
        return None;
    }
    let (low, high) = without_tails(residuals, tail);
    let parts = (count / POINTS_PER_PART).clamp(PARTS[0], PARTS[1]);
    let border = |part: usize| low + (high - low) * part as f64 / parts as f64;
    let borders: [f64; PARTS[1] + 1] = std::array::from_fn(border);
    let borders = &borders[..=parts];
    // How many are below each border: first those between it and the one before.
    let mut below = [0usize; PARTS[1] + 2];
    let per_part = parts as f64 / (high - low);
    for &x in residuals.iter() {
        // The first border above: nearly by arithmetic, then exactly.
        let mut above = (((x - low) * per_part) as usize).min(parts);
        while above <= parts && borders[above] <= x {
            above += 1;
        }
        while above > 0 && borders[above - 1] > x {
            above -= 1;
        }
        below[above] += 1;
    }
    (1..=parts).for_each(|part| below[part] += below[part - 1]);
    let within = |from: usize, to: usize| (below[to] - below[from]) as f64;
    let most = VALLEY_DENSITY_RATIO * within(0, parts) / parts as f64;
    // Of equal valleys the one next to the middle: the range has no sides.
    let mut best = (least, usize::MAX, None);
    for from in 1..parts {
        for to in from + 1..parts {
            let (inside, width) = (within(from, to), to - from);
            // Longer parts that begin here may be sparser, but hold no fewer.
            if inside > most * (parts - 1 - from) as f64 {
                break;
            }
            if inside > most * width as f64 {
                continue;
            }
            let side = |range: &dyn Fn(usize) -> [usize; 2]| {
                let of = |wide: usize| {
                    let [start, end] = range(wide);
                    let widths = [width as f64, (end - start) as f64];
                    evidence_above(best.0, [inside, within(start, end)], widths)
                };
                [width, 2 * width, 4 * width].map(of).into_iter().fold(0.0, f64::max)
            };
            let left = side(&|wide| [from.saturating_sub(wide), from]);
            if left < best.0 {
                continue;
            }
            let found = left.min(side(&|wide| [to, parts.min(to + wide)]));
            let aside = (from + to).abs_diff(parts);
            if found > best.0 || found == best.0 && aside < best.1 {
                best = (found, aside, Some(0.5 * (border(from) + border(to))));
            }
        }
    }
    best.2
}

/// The least and the greatest of numbers, which change their order, but for so many at either end.
///
/// Most windows have so few points that none or one is left out: then one pass finds both.
fn without_tails(numbers: &mut [f64], tail: usize) -> (f64, f64) {
    if tail > 1 {
        let last = numbers.len() - 1 - tail;
        let mut at = |k: usize| *numbers.select_nth_unstable_by(k, f64::total_cmp).1;
        return (at(tail), at(last));
    }
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for &x in &*numbers {
        if x < low[1] {
            low = if x < low[0] { [x, low[0]] } else { [low[0], x] };
        }
        if x > high[1] {
            high = if x > high[0] { [x, high[0]] } else { [high[0], x] };
        }
    }
    (low[tail], high[tail])
}

/// −ln of the most that chance would make of so few of all numbers in the first of two intervals, if they were as dense there as in the
/// second (Chernoff's bound for binomial distributions).
fn evidence(counts: [f64; 2], widths: [f64; 2]) -> f64 {
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

/// The [`evidence`], or 0 where χ² shows that it is less than `least`: ln x ≤ x − 1, so χ² is an upper bound.
fn evidence_above(least: f64, counts: [f64; 2], widths: [f64; 2]) -> f64 {
    let all = counts[0] + counts[1];
    let surplus = counts[1] * widths[0] - counts[0] * widths[1];
    let is_hopeless = surplus * surplus < ROUNDING * least * all * widths[0] * widths[1];
    if is_hopeless { 0.0 } else { evidence(counts, widths) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_are_left_out() {
        for tail in 0..4 {
            let mut numbers: Vec<f64> = (0..40u32).map(|k| f64::from(k * 17 % 40)).collect();
            let expected = (tail as f64, 39.0 - tail as f64);
            assert_eq!(without_tails(&mut numbers, tail), expected);
        }
        assert_eq!(without_tails(&mut [3.0, 3.0, 7.0], 1), (3.0, 3.0));
    }

    #[test]
    fn two_bands_are_split_between_them_and_one_is_not() {
        let even = |from: f64, to: f64, count: u32| {
            (0..count).map(move |k| from + (to - from) * (f64::from(k) + 0.5) / f64::from(count))
        };
        let mut two: Vec<f64> = even(-2.5, -0.5, 40).chain(even(0.5, 2.5, 40)).collect();
        assert_eq!(split(&mut two[30..50], 4.0), None);
        let found = split(&mut two, 9.0).expect("a valley");
        assert!(found.abs() < 0.3, "{found}");
        two.reverse();
        assert_eq!(split(&mut two, 9.0), Some(found), "in another order");
        assert_eq!(split(&mut even(-1.0, 1.0, 80).collect::<Vec<_>>(), 4.0), None);
        assert_eq!(split(&mut [0.0; 80], 4.0), None);
    }
}
