//! Genuine and impostor scores, and the rates at each threshold.

use crate::Error;

/// Scores of comparisons of one person with herself, and of different people; the larger, the more alike.
#[derive(Clone, Debug, PartialEq)]
pub struct ScoreSet {
    /// Ascending.
    genuine: Vec<f64>,
    impostor: Vec<f64>,
}

/// The rates at one threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetPoint {
    /// Comparisons with at least this score are accepted; infinite where none is.
    pub threshold: f64,
    /// The false match rate.
    pub fmr: f64,
    /// The false non-match rate.
    pub fnmr: f64,
}

impl ScoreSet {
    /// Takes scores in any order.
    ///
    /// # Errors
    /// [`Error::NoScores`] and [`Error::ScoreNan`].
    pub fn new(genuine: Vec<f64>, impostor: Vec<f64>) -> Result<Self, Error> {
        let sorted = |what, mut scores: Vec<f64>| {
            if scores.is_empty() {
                return Err(Error::NoScores { what });
            }
            if let Some(index) = scores.iter().position(|score| score.is_nan()) {
                return Err(Error::ScoreNan { what, index });
            }
            scores.sort_by(f64::total_cmp);
            Ok(scores)
        };
        Ok(ScoreSet {
            genuine: sorted("genuine", genuine)?,
            impostor: sorted("impostor", impostor)?,
        })
    }

    /// Genuine scores, ascending.
    pub fn genuine(&self) -> &[f64] {
        &self.genuine
    }

    /// Impostor scores, ascending.
    pub fn impostor(&self) -> &[f64] {
        &self.impostor
    }

    /// The share of impostor scores that are at least `threshold`.
    pub fn fmr(&self, threshold: f64) -> f64 {
        let accepted = self.impostor.len() - below(&self.impostor, threshold);
        accepted as f64 / self.impostor.len() as f64
    }

    /// The share of genuine scores that are below `threshold`.
    pub fn fnmr(&self, threshold: f64) -> f64 {
        below(&self.genuine, threshold) as f64 / self.genuine.len() as f64
    }

    /// The points of the detection error trade-off: one for each different score, ascending, and one that accepts nothing.
    ///
    /// The FMR falls from 1 to 0 along them, and the FNMR rises from 0 to 1.
    pub fn det(&self) -> Vec<DetPoint> {
        let counts = [self.genuine.len() as f64, self.impostor.len() as f64];
        let (mut genuine, mut impostor, mut points) = (0, 0, vec![]);
        loop {
            let next = [self.genuine.get(genuine), self.impostor.get(impostor)];
            let threshold = next.into_iter().flatten().fold(f64::INFINITY, |a, &b| a.min(b));
            points.push(DetPoint {
                threshold,
                fmr: (self.impostor.len() - impostor) as f64 / counts[1],
                fnmr: genuine as f64 / counts[0],
            });
            if threshold == f64::INFINITY {
                return points;
            }
            // By value, so that 0 and −0 are one.
            let passed = |scores: &[f64], from: usize| {
                scores[from..].iter().take_while(|&&score| score <= threshold).count()
            };
            genuine += passed(&self.genuine, genuine);
            impostor += passed(&self.impostor, impostor);
        }
    }

    /// At most `points_max` points of [`det`](Self::det), and at least 3 where there are as many, spread evenly by the logarithms of the
    /// rates: enough to draw it.
    pub fn curve(&self, points_max: usize) -> Vec<DetPoint> {
        thinned(&self.det(), points_max.max(3))
    }

    /// The rate at which FMR and FNMR are equal, on the straight line between the two points of [`det`](Self::det) where they cross.
    pub fn equal_error_rate(&self) -> f64 {
        equal_error_rate(&self.det())
    }

    /// The least threshold with an FMR of at most `fmr_max`.
    pub fn at_fmr(&self, fmr_max: f64) -> DetPoint {
        at_fmr(&self.det(), fmr_max)
    }

    /// The cost of the scores as natural logarithms of likelihood ratios, in bits (Brümmer and du Preez, 2006).
    pub fn cllr(&self) -> f64 {
        // log(1 + e^x) without overflow.
        let cost = |x: f64| x.max(0.0) + (-x.abs()).exp().ln_1p();
        let mean = |scores: &[f64], sign: f64| {
            scores.iter().map(|score| cost(sign * score)).sum::<f64>() / scores.len() as f64
        };
        (mean(&self.genuine, -1.0) + mean(&self.impostor, 1.0)) / (2.0 * std::f64::consts::LN_2)
    }
}

/// The number of scores below a threshold.
fn below(sorted: &[f64], threshold: f64) -> usize {
    sorted.partition_point(|&score| score < threshold)
}

/// The rate at which the two rates along points of a trade-off are equal.
pub(super) fn equal_error_rate(det: &[DetPoint]) -> f64 {
    // The last point has an FMR of 0 unless scores are infinite.
    let after = det.iter().position(|point| point.fnmr >= point.fmr).unwrap_or(det.len() - 1);
    let high = det[after];
    let Some(low) = after.checked_sub(1).map(|before| det[before]) else { return high.fmr };
    // FMR − FNMR falls from low to high, through 0.
    let (start, end) = (low.fmr - low.fnmr, high.fmr - high.fnmr);
    let t = if start > end { (start / (start - end)).clamp(0.0, 1.0) } else { 1.0 };
    low.fmr + t * (high.fmr - low.fmr)
}

/// The first point with an FMR of at most `fmr_max`, or the last one.
pub(super) fn at_fmr(det: &[DetPoint], fmr_max: f64) -> DetPoint {
    let last = det[det.len() - 1];
    det.iter().copied().find(|point| point.fmr <= fmr_max).unwrap_or(last)
}

/// The first point of each of many equal steps along a curve, by the sum of both rates' logarithms.
pub(super) fn thinned(det: &[DetPoint], points_max: usize) -> Vec<DetPoint> {
    if det.len() <= points_max {
        return det.to_vec();
    }
    // The curve is monotone, so this grows along it; rates that are 0 count as a millionth.
    let place = |point: &DetPoint| point.fnmr.max(1e-6).ln() - point.fmr.max(1e-6).ln();
    let (first, last) = (place(&det[0]), place(&det[det.len() - 1]));
    let step = ((last - first) / (points_max.max(3) - 2) as f64).max(f64::MIN_POSITIVE);
    let mut kept: Vec<DetPoint> = vec![];
    let mut next = first;
    for point in det {
        if place(point) >= next {
            kept.push(*point);
            next = place(point) + step;
        }
    }
    kept.extend(det.last().filter(|last| kept.last() != Some(last)).copied());
    kept
}
