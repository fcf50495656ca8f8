//! The nearest box (thesis, 7.5).
//!
//! *Idea.* A class is the box of its training points. The distance of a point from it is the largest over the coordinates, each divided
//! by the largest range that any class has there.
//! *Trap.* A point may be inside several boxes, at distance 0 from each: there the distance from the center of the box decides.

use serde::{Deserialize, Serialize};

use super::data::Rows;
use super::{Classifier, Score};

/// The least range that divides a coordinate, as a part of its range over all classes: a class of one point has range 0.
const RANGE_MIN: f64 = 1e-9;

/// Boxes of the classes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Boxes {
    /// Class after class.
    low: Vec<f64>,
    high: Vec<f64>,
    /// One over the range of each coordinate.
    weight: Vec<f64>,
}

impl Boxes {
    /// Learns the boxes from `rows`, and how much each coordinate counts from `background`.
    pub(super) fn learn(background: &Rows, rows: &Rows) -> Self {
        Boxes { weight: Boxes::of(background).weight, ..Boxes::of(rows) }
    }

    fn of(rows: &Rows) -> Self {
        let (dim, classes) = (rows.dim, rows.classes);
        let mut low = vec![f64::INFINITY; classes * dim];
        let mut high = vec![f64::NEG_INFINITY; classes * dim];
        for (row, class) in rows.iter() {
            for (j, &x) in row.iter().enumerate() {
                let at = class * dim + j;
                low[at] = low[at].min(x);
                high[at] = high[at].max(x);
            }
        }
        let weight = (0..dim)
            .map(|j| {
                let of_class = |class: usize| (low[class * dim + j], high[class * dim + j]);
                let all = (0..classes)
                    .map(of_class)
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |all, one| {
                        (all.0.min(one.0), all.1.max(one.1))
                    });
                let range =
                    (0..classes).map(of_class).map(|(low, high)| high - low).fold(0.0, f64::max);
                let range = range.max(RANGE_MIN * (all.1 - all.0));
                // A coordinate without any range counts as it is.
                if range > 0.0 { (1.0 / range).min(f64::MAX) } else { 1.0 }
            })
            .collect();
        Boxes { low, high, weight }
    }

    pub(super) fn is_sound(&self, dim: usize, classes: usize) -> bool {
        self.weight.len() == dim
            && self.low.len() == dim * classes
            && self.high.len() == dim * classes
    }
}

impl Classifier for Boxes {
    fn dim(&self) -> usize {
        self.weight.len()
    }

    fn classes(&self) -> usize {
        self.low.len() / self.dim()
    }

    fn scores(&self, x: &[f64], out: &mut [Score]) {
        let dim = self.dim();
        let boxes = self.low.chunks_exact(dim).zip(self.high.chunks_exact(dim));
        for ((low, high), out) in boxes.zip(out) {
            let (mut outside, mut from_center) = (0f64, 0f64);
            for j in 0..dim {
                let beyond = (low[j] - x[j]).max(x[j] - high[j]).max(0.0);
                outside = outside.max(beyond * self.weight[j]);
                let offset = (x[j] - (low[j] + high[j]) / 2.0).abs();
                from_center = from_center.max(offset * self.weight[j]);
            }
            *out = Score { value: -outside, tie: -from_center };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_the_thesis() {
        let values = vec![0.0, 0.0, 2.0, 1.0, 10.0, 0.0, 11.0, 4.0];
        let boxes = Boxes::of(&Rows { values, dim: 2, labels: vec![0, 0, 1, 1], classes: 2 });
        let mut out = [Score::default(); 2];
        // The largest ranges are 2 and 4.
        boxes.scores(&[3.0, 3.0], &mut out);
        assert_eq!(out.map(|score| score.value), [-0.5, -3.5]);
        boxes.scores(&[1.0, 0.5], &mut out);
        assert_eq!((out[0].value, out[0].tie), (0.0, 0.0));
    }

    #[test]
    fn the_nearer_center_decides_inside_two_boxes() {
        let values = vec![0.0, 10.0, 4.0, 20.0];
        let boxes = Boxes::of(&Rows { values, dim: 1, labels: vec![0, 0, 1, 1], classes: 2 });
        assert_eq!(boxes.best(&[7.0]).0, 0);
        assert_eq!(boxes.best(&[9.0]).0, 1);
        let alone = Rows { values: vec![1.0, 2.0], dim: 1, labels: vec![0, 1], classes: 2 };
        assert_eq!(Boxes::of(&alone).best(&[1.9]).0, 1);
    }
}
