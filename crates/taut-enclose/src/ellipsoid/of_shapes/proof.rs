//! From multipliers to an answer with a certificate.

use taut_certify::{Ellipsoid, EllipsoidCertificate, Solution, Stop, Trace};
use taut_kernels::vector::dot;
use taut_points::OrderBy;
use taut_points::parallel::ParallelSlice;

use super::base::Base;
use super::rounds::Best;
use crate::Error;
use crate::ellipsoid::outcome::log_unit_ball;
use crate::ellipsoid::proof::{LOGARITHM_ROUNDING, answer, lower_gap};
use crate::ellipsoid::tilt::Tilt;
use crate::ellipsoid::{EllipsoidOptions, ROUNDING};
use crate::shapes::Shapes;
use crate::shapes::eigen::eigen;
use crate::shapes::frame::Map;
use crate::shapes::reach::farthest;

/// Items that reach this near the border, relatively, are measured again with twice the digits.
const BORDER_TOLERANCE: f64 = 1e-8;
/// So many items are all measured, as rounding may move a thin one far from where a pass found it.
const MEASURED_ALL: usize = 256;
/// At most this many scales are tried.
const SCALES_MAX: usize = 12;

impl Base {
    /// From multipliers to an answer: containment is measured with F as it will be returned.
    pub(super) fn prove(
        &self,
        shapes: &Shapes,
        best: Best,
        mut trace: Trace,
        options: &EllipsoidOptions<'_>,
    ) -> Result<Solution<Ellipsoid>, Error> {
        let rank = self.rank;
        let center = self.back(&best.center);
        let border = best.largest * (1.0 - BORDER_TOLERANCE);
        let all = shapes.len() <= MEASURED_ALL;
        let near: Vec<usize> =
            (0..shapes.len()).filter(|&i| all || best.squares[i] >= border).collect();
        let hull = self.hull(shapes, &center);
        let mut scale = 1.0 / best.largest.sqrt();
        let mut factor = self.factor(&best.matrix, scale);
        let map = Map { matrix: &factor, center: &center };
        let tilt = Tilt::new(&factor, hull.as_ref());
        let off_hull = near.iter().map(|&i| tilt_error(&tilt, map, shapes, i)).fold(0.0, f64::max);
        // The error of a reach found from exact coordinates: eigenvalues, roots and sums.
        let rounding = 16.0 * (rank + 4) as f64 * f64::EPSILON + off_hull;
        scale /= 1.0 + rounding;
        let mut excess = 0.0;
        for attempt in 0..SCALES_MAX {
            factor = self.factor(&best.matrix, scale);
            let map = Map { matrix: &factor, center: &center };
            let squares: Vec<f64> = near
                .par_iter()
                .with_min_len(16)
                .map(|&i| square(&map.shape_of(shapes, i), &map.center_of(shapes, i)))
                .collect();
            let largest = squares.into_iter().fold(0.0, f64::max);
            excess = (largest.sqrt() - 1.0 + rounding).max(0.0);
            if excess == 0.0 {
                break;
            }
            // Rounding the new F can push items out again by the same amount, so each attempt shrinks twice as much.
            let pushed = if attempt == 0 { rounding } else { excess.max(rounding) };
            scale /= (1.0 + f64::from(2u32 << attempt) * pushed) * largest.sqrt();
        }
        let dim = shapes.dim();
        let map = Map { matrix: &factor, center: &center };
        let mut support: Vec<(usize, Vec<f64>, f64)> = best
            .support
            .into_iter()
            .map(|(support_point, u)| {
                (support_point.item, self.direction(&support_point.direction), u)
            })
            .collect();
        support.order_by_key(|entry| entry.0);
        let images: Vec<f64> =
            support.iter().flat_map(|(i, a, _)| map.touching(shapes, *i, a)).collect();
        let multipliers: Vec<f64> = support.iter().map(|entry| entry.2).collect();
        let tilt = Tilt::new(&factor, hull.as_ref());
        let errors: Vec<f64> = support
            .iter()
            .map(|(i, a, _)| map.touching_error(shapes, *i, a) + tilt_error(&tilt, map, shapes, *i))
            .collect();
        let lower = lower_gap(&images, &multipliers, rank, &errors);
        let gap = (lower + rank as f64 * (excess + LOGARITHM_ROUNDING)).min(f64::MAX);
        let log_volume = match self.directions {
            None => log_unit_ball(rank) - (0..rank).map(|a| factor[a * dim + a].ln()).sum::<f64>(),
            Some(_) => {
                let diagonal = |m: &[f64]| (0..rank).map(|a| m[a * rank + a].ln()).sum::<f64>();
                let logs = diagonal(&best.matrix) + diagonal(&self.lower);
                log_unit_ball(rank) - logs - rank as f64 * scale.ln()
            }
        };
        let exactly = 4.0 * ROUNDING * rank as f64;
        let wanted = if options.epsilon > 0.0 { options.epsilon } else { exactly };
        if trace.stop == Stop::Converged && gap > wanted {
            trace.stop = Stop::Rounding;
        }
        let certificate = EllipsoidCertificate {
            items: shapes.items(),
            support: support.iter().map(|entry| entry.0 as u64).collect(),
            multipliers,
            directions: support.into_iter().map(|entry| entry.1).collect(),
            left_out: vec![],
            gap,
            points_hash: shapes.hash(),
        };
        Ok(Solution { answer: answer(&factor, center, log_volume, hull)?, certificate, trace })
    }
}

/// What images of the points of an item may be off by, as it lies off the hull and F leans out of it.
fn tilt_error(tilt: &Tilt, map: Map<'_>, shapes: &Shapes, i: usize) -> f64 {
    let center = &map.center.high;
    let offset = shapes.center(i).iter().zip(center).map(|(m, c)| (m - c).abs()).sum();
    tilt.error(offset, (0..center.len()).map(|j| shapes.width(i, j)).sum())
}

/// The largest |y|² of an ellipsoid given by its matrix and center.
fn square(shape: &[f64], center: &[f64]) -> f64 {
    let rank = center.len();
    let (lambda, vectors) = eigen(&mut shape.to_vec(), rank);
    let h: Vec<f64> = vectors.chunks_exact(rank.max(1)).map(|v| dot(v, center)).collect();
    farthest(&lambda, &h).square
}
