//! Stretches of a curve with far fewer rows than those beside them.
//!
//! *Problem.* Where an arc is missing, the longest gap need not be long: outliers that happen to lie in the band of the answer, and noise
//! that reaches in at both ends, part it into several.
//! *Idea.* Of a few consecutive gaps, with the rows between them, the length is compared with that of as many rows beside them as
//! [`super::sampling`] takes for a single gap. Evidence is Chernoff's bound on the chance that so few of all those rows lie in a stretch of
//! that length, less the logarithm of how many stretches there are.
//! *Guarantee.* None: the threshold is a choice, calibrated on draws of known curves (the example `curve_rates` of `taut-reconstruct`).
//! O(n).

use super::super::CurveDoubt;
use super::sampling::Sample;
use super::valley::evidence;

/// The most rows within such a stretch. More are a curve that is sampled less densely.
const ROWS_MAX: usize = 12;

/// Rows on either side that it is compared with.
const ROWS_BESIDE: usize = 32;

/// The most evidence that honest draws give, but for two in a hundred curves, three where there are 5000 rows.
const EVIDENCE_MAX: f64 = 1.25;

/// The stretch for which there is most evidence that it is sampled less densely than what is beside it, if there is enough.
pub(super) fn vacancy(curve: usize, samples: &[Sample], length: f64) -> Option<CurveDoubt> {
    let count = samples.len();
    let place = |k: usize| samples[k % count].along + length * (k / count) as f64;
    let mut worst = (EVIDENCE_MAX, None);
    for rows in 1..=ROWS_MAX {
        let beside = ROWS_BESIDE.min(count.saturating_sub(rows + 2) / 2);
        if beside < rows {
            break;
        }
        let stretches = (count * ROWS_MAX) as f64;
        for before in beside..count + beside {
            let after = before + rows + 1;
            let inside = place(after) - place(before);
            let outside =
                place(before) - place(before - beside) + place(after + beside) - place(after);
            let found =
                evidence([rows as f64, (2 * beside) as f64], [inside, outside]) - stretches.ln();
            if found > worst.0 {
                let expected = inside / outside * (2 * beside) as f64;
                let vertex = samples[before % count].vertex;
                worst = (found, Some(CurveDoubt::Vacant { curve, vertex, rows, expected }));
            }
        }
    }
    worst.1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows a unit apart around a curve of 400, those of a stretch left out but for some.
    fn rows(start: usize, length: usize, kept: usize) -> Vec<Sample> {
        let at = |k: usize| Sample { along: k as f64 + 0.3, vertex: k, offset: 0.0, row: k };
        let within = |k: usize| (k + 400 - start) % 400;
        let is_kept = |k: usize| within(k) % 7 == 0 && within(k) / 7 < kept;
        (0..400).filter(|&k| within(k) >= length || is_kept(k)).map(at).collect()
    }

    #[test]
    fn few_rows_in_a_long_stretch_are_told_and_even_ones_are_not() {
        assert_eq!(vacancy(0, &rows(0, 0, 0), 400.0), None);
        for start in [100, 385] {
            let found = vacancy(0, &rows(start, 35, 4), 400.0);
            let Some(CurveDoubt::Vacant { rows, expected, .. }) = found else {
                panic!("{start}: {found:?}")
            };
            assert!(rows <= 5 && expected > 20.0, "{rows} {expected}");
        }
        assert_eq!(vacancy(0, &rows(100, 4, 0), 400.0), None);
        assert_eq!(vacancy(0, &rows(0, 398, 0), 400.0), None);
    }
}
