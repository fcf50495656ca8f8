//! Bands of several strands, told by all windows around a curve together.
//!
//! *Problem.* Strands of few rows each, such as the turns of a spiral that was answered as one loop: no window holds so many rows that their
//! valley alone is beyond chance, and where the curve runs across the strands, the valley shifts within the window.
//! *Idea.* In each of many short windows, offsets are sheared along the curve by several slopes, and the valley with most evidence is
//! taken. Chance gives one band some evidence here and there; several strands give all windows more of it, so the mean tells.
//! *Guarantee.* None: bounds are choices, calibrated on draws of known curves (the example `curve_rates` of `taut-reconstruct`). Few windows
//! scatter more: of simulated bands of uniform noise with 128, 200, 300, 500 and 1000 rows 32, 25, 19, 8 and 0.8 of a hundred are doubted,
//! of normal noise 4, 0.9, 0.2 and none. Bounds of 2.6 deviations of the mean doubt one in a hundred of any size, but let a spiral and a
//! pair of rings pass in 4600 draws, beside three other wrong answers.
//! O(n), and a bounded number of windows.

use super::super::CurveDoubt;
use super::sampling::Sample;
use super::valley::{Valley, valley};

/// A length of windows, and what they show at most on average where there is one band. Of 245 draws of `curve_rates` that are right and
/// dense half had less than three quarters of these bounds, and none more than 0.97.
struct Size {
    rows: usize,
    /// Evidence between offsets as they are.
    plain: f64,
    /// The most evidence between sheared ones.
    sheared: f64,
}

const SIZES: [Size; 2] =
    [Size { rows: 32, plain: 1.8, sheared: 2.9 }, Size { rows: 64, plain: 1.7, sheared: 2.5 }];

/// Most windows, spread evenly around the curve; it bounds the work.
const WINDOWS_MAX: usize = 512;

/// How far offsets are sheared from one end of a window to the other, over the width of the band there.
const SHEARS: [f64; 8] = [-1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0];

/// One of so many offsets at either end does not count for the width of the band.
const ROWS_PER_TAIL: usize = 32;

/// The window that tells most clearly, if windows around the curve show more than one strand.
pub(super) fn several_bands(curve: usize, samples: &[Sample]) -> Option<CurveDoubt> {
    SIZES.iter().find_map(|size| in_windows(curve, samples, size))
}

fn in_windows(curve: usize, samples: &[Sample], size: &Size) -> Option<CurveDoubt> {
    let count = samples.len();
    let windows = (count / size.rows).min(WINDOWS_MAX);
    let (mut plain, mut sheared) = (0.0, 0.0);
    let mut clearest = (Valley { evidence: 0.0, density: 1.0 }, 0);
    for window in 0..windows {
        let start = window * count / windows;
        let rows = &samples[start..start + size.rows];
        let found = valleys(rows);
        plain += found[0].evidence;
        sheared += found[1].evidence;
        if found[1].evidence > clearest.0.evidence {
            clearest = (found[1], samples[start].vertex);
        }
    }
    let (Valley { density: share, .. }, vertex) = clearest;
    let is_above = |sum: f64, mean: f64| sum > mean * windows as f64;
    (is_above(plain, size.plain) || is_above(sheared, size.sheared)).then_some(CurveDoubt::Split {
        curve,
        vertex,
        share,
    })
}

/// The valley with most evidence between the offsets of consecutive rows, and between the same sheared one way or the other.
fn valleys(rows: &[Sample]) -> [Valley; 2] {
    let sorted = |shear: f64| {
        let mut offsets: Vec<f64> =
            rows.iter().map(|row| row.offset - shear * (row.along - rows[0].along)).collect();
        offsets.sort_unstable_by(f64::total_cmp);
        offsets
    };
    let (offsets, tail) = (sorted(0.0), rows.len() / ROWS_PER_TAIL);
    let width = offsets[rows.len() - 1 - tail] - offsets[tail];
    let length = rows[rows.len() - 1].along - rows[0].along;
    let plain = valley(&offsets);
    let mut best = plain;
    for shear in SHEARS.into_iter().filter(|_| length > 0.0) {
        let found = valley(&sorted(shear * width / length));
        if found.evidence > best.evidence {
            best = found;
        }
    }
    [plain, best]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Independent rows in bands of width ½, denser in their middle, some distance apart, that drift by so much from one end of the
    /// curve to the other.
    fn rows(bands: u32, apart: f64, drift: f64) -> Vec<Sample> {
        let mut state = 5u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / 2f64.powi(53)
        };
        let mut row = |k: usize| {
            let band = (f64::from(bands) * random()).floor();
            let offset = apart * band + drift * k as f64 / 640.0 + 0.25 * (random() + random());
            Sample { along: k as f64, vertex: k, offset, row: k }
        };
        (0..640).map(&mut row).collect()
    }

    #[test]
    fn bands_are_told_though_the_curve_runs_across_them() {
        for drift in [0.0, 2.0, -2.0] {
            assert_eq!(several_bands(0, &rows(1, 1.0, drift)), None);
            let found = several_bands(3, &rows(3, 1.0, drift));
            let Some(CurveDoubt::Split { curve: 3, share, .. }) = found else {
                panic!("{drift}: {found:?}")
            };
            assert!(share < 0.5, "{share}");
        }
    }

    #[test]
    fn few_rows_and_rows_in_one_place_tell_nothing() {
        assert_eq!(several_bands(0, &rows(3, 1.0, 0.0)[..31]), None);
        let one = Sample { along: 1.0, vertex: 0, offset: 0.0, row: 0 };
        assert_eq!(several_bands(0, &[one; 200]), None);
    }
}
