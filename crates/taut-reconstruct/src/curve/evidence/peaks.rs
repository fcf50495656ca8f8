//! Whether offsets across a band come from a density with one peak: else samples of two curves are taken for those of one.
//!
//! *Idea.* In a histogram, a run of bins that is sparser than what is beside it on the left, and than what is beside it on the right,
//! by more than chance makes of a density that falls to both sides. Runs are compared with sides once, twice, four times as long.
//! *Guarantee.* The definition is that of the checker: the claim keeps some room to its threshold.

/// One in this many offsets is left out at either end.
const OFFSETS_PER_TAIL: usize = 128;
/// Fewest and most bins, of eight offsets each between those.
const BINS: [usize; 2] = [8, 48];
/// Runs that are denser than this beside all bins are no valleys; a little more than the checker looks at.
const VALLEY_DENSITY_RATIO: f64 = 0.751;
/// Roundings of an offset, in widths of the band.
const ROUNDING: f64 = 1e-9;
/// A run is doubled at most this often to make a side.
const DOUBLINGS_MAX: usize = 6;

/// Whether no run of bins has evidence of more than `most` against it, for ascending offsets.
pub(super) fn has_one_peak(offsets: &[f64], most: f64) -> bool {
    let tail = offsets.len() / OFFSETS_PER_TAIL;
    let (first, last) = (offsets[tail], offsets[offsets.len() - 1 - tail]);
    let bins = (offsets.len() / 8).clamp(BINS[0], BINS[1]);
    // Offsets of the checker differ by roundings: what lies on a border of bins may lie on either side, so a run holds what is surely in
    // it, and its sides what may be in them.
    let mut below = [[0u32; BINS[1] + 1]; 2];
    for (below, room) in below.iter_mut().zip([-ROUNDING, ROUNDING]) {
        let mut at = 0;
        for (bin, below) in below.iter_mut().enumerate().take(bins + 1) {
            let border = first + (last - first) * (bin as f64 / bins as f64 + room);
            while at < offsets.len() && offsets[at] < border {
                at += 1;
            }
            *below = at as u32;
        }
    }
    let surely = |from: usize, to: usize| f64::from(below[0][to].saturating_sub(below[1][from]));
    let maybe = |from: usize, to: usize| f64::from(below[1][to] - below[0][from]);
    let dense = VALLEY_DENSITY_RATIO * maybe(0, bins) / bins as f64;
    for length in 1..bins - 1 {
        for from in 1..bins - length {
            let (to, wide) = (from + length, length as f64);
            let inside = surely(from, to);
            if inside > dense * wide {
                continue;
            }
            let stands_out = |side: usize, is_left: bool| {
                let beside = if is_left { maybe(from - side, from) } else { maybe(to, to + side) };
                against_one_peak(inside, beside, wide / (wide + side as f64)) > most
            };
            let any = |room: usize, is_left: bool| {
                (0..DOUBLINGS_MAX).any(|k| stands_out((length << k).min(room), is_left))
            };
            if any(from, true) && any(bins - to, false) {
                return false;
            }
        }
    }
    true
}

/// How little chance would make of `inside` or fewer of all counts if each fell inside with at least `probability`: −ln of Chernoff's bound.
fn against_one_peak(inside: f64, beside: f64, probability: f64) -> f64 {
    let all = inside + beside;
    if inside >= probability * all {
        return 0.0;
    }
    let outside = beside * (beside / (all * (1.0 - probability))).ln();
    match inside > 0.0 {
        true => outside + inside * (inside / (all * probability)).ln(),
        false => outside,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_told_from_one_by_their_numbers() {
        let even = |count: usize| (0..count).map(move |k| k as f64 / count as f64);
        let split = |count: usize| even(count).map(|x| if x < 0.5 { x } else { x + 0.1 });
        for count in [130, 700, 5000] {
            assert!(has_one_peak(&even(count).collect::<Vec<_>>(), 1.0), "{count}");
            let bands: Vec<f64> = split(count).collect();
            assert!(has_one_peak(&bands, 0.2 * count as f64), "{count}");
            assert!(!has_one_peak(&bands, 0.04 * count as f64), "{count}");
        }
        assert!(has_one_peak(&[3.0; 64], 1.0));
    }
}
