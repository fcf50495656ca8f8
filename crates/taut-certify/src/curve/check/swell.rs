//! Stretches of a curve along which its rows lie farther off, or closer together, than on both sides.
//!
//! *Problem.* A curve that runs forth, back and forth again within a few widths of its noise fills one band, and an answer straight through
//! that band is simple, closed and near to all rows. The band is wider there, and holds three times as many rows for its length.
//! *Idea.* Windows of consecutive rows are compared with the rows on both sides of them, as many on each: by the ratio v of the mean squares
//! of their offsets, and by the ratio d of the lengths that they take. Evidence is the logarithm of the likelihood ratio that both parts
//! have their own variance, and their own density; of the two sides the less favorable one counts.
//! *Guarantee.* None: thresholds are choices, calibrated on draws of known curves (the example `curve_rates` of `taut-reconstruct`).
//! O(n) for each of the window sizes.

use taut_points::OrderBy;

use super::super::CurveDoubt;
use super::sampling::Sample;

/// Rows of the windows, in steps of about √2: the longest is a stretch that bends of the curve no longer explain.
const WINDOWS: [usize; 12] = [8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384];

/// Both ratios are at least this, else one of them alone could carry the evidence: noise that widens, or density that varies.
const RATIO_MIN: f64 = 1.25;

/// The least ratio of mean squares that is called a swell.
const SPREAD_RATIO_MIN: f64 = 1.4;

/// The most evidence that honest draws give, but for about one in two hundred.
const EVIDENCE_MAX: f64 = 10.0;

/// Rows of the short windows whose spread is compared with the usual one, and the most that it may be of that.
const SPREADS: [(usize, f64); 2] = [(16, 3.4), (32, 2.9)];

/// The share of the offsets of a window that its spread is no less than.
const SPREAD_SHARE: f64 = 0.8;

/// The windows of a closed curve: the rows k to k + m, counted around.
struct Rows<'a> {
    samples: &'a [Sample],
    /// The length of the curve.
    length: f64,
    /// Sums of the squares of offsets before each row, twice around.
    squares: Vec<f64>,
}

impl Rows<'_> {
    fn length(&self, from: usize, rows: usize) -> f64 {
        let at = |k: usize| {
            let count = self.samples.len();
            self.samples[k % count].along + self.length * (k / count) as f64
        };
        at(from + rows) - at(from)
    }

    fn mean_square(&self, from: usize, rows: usize) -> f64 {
        (self.squares[from + rows] - self.squares[from]).max(0.0) / rows as f64
    }
}

/// Returns a stretch that is wider and denser than what is beside it, or much wider than usual.
pub(super) fn swell(curve: usize, samples: &[Sample], length: f64) -> Option<CurveDoubt> {
    let count = samples.len();
    let mut squares = vec![0.0];
    for k in 0..2 * count {
        squares.push(squares[k] + samples[k % count].offset.powi(2));
    }
    let rows = Rows { samples, length, squares };
    let mut worst = (EVIDENCE_MAX, None);
    for window in WINDOWS.into_iter().filter(|window| 3 * window <= count) {
        for start in (0..count).step_by(window / 4) {
            let Some((wider, denser)) = ratios(&rows, start, window) else { continue };
            let found = evidence(window as f64, wider, denser);
            if found > worst.0 && wider > SPREAD_RATIO_MIN {
                let vertex = samples[(start + window) % count].vertex;
                let wider = wider.sqrt();
                worst = (found, Some(CurveDoubt::Swollen { curve, vertex, wider, denser }));
            }
        }
    }
    worst.1.or_else(|| spread(curve, samples))
}

/// v and d of the rows `start + window` and on, each against the side that makes it less; none where either is not above
/// [`RATIO_MIN`].
fn ratios(rows: &Rows<'_>, start: usize, window: usize) -> Option<(f64, f64)> {
    let count = rows.samples.len();
    let at = |step: usize| (start + step * window) % count;
    let [left, inside, right] =
        [0, 1, 2].map(|step| (rows.mean_square(at(step), window), rows.length(at(step), window)));
    let wider = inside.0 / left.0.max(right.0);
    let denser = left.1.min(right.1) / inside.1;
    (wider > RATIO_MIN && wider.is_finite() && denser > RATIO_MIN && denser.is_finite())
        .then_some((wider, denser))
}

/// The evidence of m rows for mean squares in the ratio v, and for densities in the ratio d: log-likelihoods of normal offsets, and of
/// rows that fall into the window or beside it as coins fall.
fn evidence(rows: f64, wider: f64, denser: f64) -> f64 {
    let bulge = rows / 2.0 * (2.0 * f64::midpoint(wider, 1.0).ln() - wider.ln());
    let crowd = rows * ((1.0 + denser).powi(2) / (4.0 * denser)).ln();
    bulge + crowd
}

/// A short window in which rows lie much farther off than they usually do.
fn spread(curve: usize, samples: &[Sample]) -> Option<CurveDoubt> {
    let (count, mut offsets) = (samples.len(), vec![]);
    for (window, most) in SPREADS.into_iter().filter(|(window, _)| 4 * window <= count) {
        let mut spreads: Vec<(f64, usize)> = vec![];
        for start in (0..count).step_by(window / 4) {
            offsets.clear();
            offsets.extend((start..start + window).map(|k| samples[k % count].offset.abs()));
            let at = (SPREAD_SHARE * window as f64) as usize;
            let (_, &mut spread, _) = offsets.select_nth_unstable_by(at, f64::total_cmp);
            spreads.push((spread, samples[start].vertex));
        }
        spreads.order_by(&|a, b| a.0.total_cmp(&b.0));
        let ((usual, _), (largest, vertex)) =
            (spreads[spreads.len() / 2], spreads[spreads.len() - 1]);
        if largest > most * usual {
            let times = largest / usual;
            return Some(CurveDoubt::Wide { curve, vertex, times });
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(state: &mut u64) -> f64 {
        *state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / 2f64.powi(53)
    }

    /// Rows along a curve of length 100; between 40 and 44 there are three times as many, on three strands.
    fn rows(strands: f64, apart: f64) -> Vec<Sample> {
        let mut state = 7;
        let mut samples: Vec<Sample> = (0..2000)
            .map(|row| {
                let place = random(&mut state) * (100.0 + 4.0 * (strands - 1.0));
                let (along, strand) = match place {
                    x if x < 40.0 => (x, 0.0),
                    x if x < 40.0 + 4.0 * strands => (
                        40.0 + (x - 40.0) / strands,
                        ((x - 40.0) / 4.0).floor() - (strands - 1.0) / 2.0,
                    ),
                    x => (x - 4.0 * (strands - 1.0), 0.0),
                };
                let offset = 2.0 * random(&mut state) - 1.0 + apart * strand;
                Sample { along, vertex: along as usize, offset, row }
            })
            .collect();
        samples.sort_by(|a, b| a.along.total_cmp(&b.along));
        samples
    }

    #[test]
    fn three_passes_are_a_swell_and_one_is_none() {
        assert_eq!(swell(0, &rows(1.0, 0.0), 100.0), None);
        let found = swell(0, &rows(3.0, 2.5), 100.0);
        let Some(CurveDoubt::Swollen { vertex, denser, .. }) = found else { panic!("{found:?}") };
        assert!((36..48).contains(&vertex) && denser > 2.0, "{found:?}");
    }

    /// Of equal halves nothing follows; of 16 rows on half the length 2.7, as (9/8)¹⁶ says.
    #[test]
    fn evidence_is_that_of_the_formulas() {
        assert_eq!(evidence(100.0, 1.0, 1.0), 0.0);
        assert!((evidence(16.0, 1.0, 2.0) - 16.0 * (9.0f64 / 8.0).ln()).abs() < 1e-12);
        assert!((evidence(16.0, 3.0, 1.0) - 8.0 * (4.0f64 / 3.0).ln()).abs() < 1e-12);
    }
}
