//! The smallest ellipsoid around the rows kept: the estimate of MVE and trimming, and its proof.
//!
//! *Problem.* Of n points find the h that fit into the smallest ellipsoid.
//! *Idea.* The C-steps of the MCD, with the exact smallest ellipsoid in place of mean and covariance: of the rows, the h
//! nearest in the metric of the ellipsoid around the last h.
//! *Guarantee.* At least h rows have |F(x − c)| ≤ 1, so the h nearest lie in an ellipsoid of the same shape that is no
//! larger, and the smallest around them is smaller still: volumes fall until the rows stay. A local optimum; what is
//! proved is that no smaller ellipsoid holds the rows kept, and that all others lie outside.
//! *Trap.* Rows on the border, or within rounding of it, may be kept or not. In the end all of them are kept.
//! *Reference.* C-steps after Rousseeuw, Van Driessen, Technometrics 41, 1999; the estimator is that of Rousseeuw, 1985.

use taut_certify::{Enclosure, Solution};
use taut_kernels::vector::dot;
use taut_points::Points;

use super::estimate::Estimate;
use super::flat::{Flat, Part};
use crate::ellipsoid::point_reader::PointReader;
use crate::{EllipsoidOptions, Error, ellipsoid};

/// Rows that reach no farther out than this are kept.
const KEPT_REACH_MAX: f64 = 1.0 + 1e-9;

/// An ellipsoid around rows, and what its metric says of all rows of the space it is in.
pub(super) struct EnclosingMetric {
    pub(super) enclosure: Enclosure,
    /// Rows enclosed, ascending.
    pub(super) kept: Vec<u64>,
    /// The subspace of the ellipsoid, unless it is the whole space, with the rows on it.
    pub(super) part: Option<Part>,
    /// F as a metric, in coordinates of the subspace.
    pub(super) metric: Estimate,
}

fn around(
    data: &PointReader<'_>,
    ids: &[u64],
    epsilon: f64,
) -> Result<Solution<taut_certify::Ellipsoid>, Error> {
    let rows = data.rows(ids)?;
    let points = Points::new(&rows, data.dim()).expect("rows of the dimension");
    ellipsoid(&points, &EllipsoidOptions { epsilon, ..Default::default() })
}

/// The metric of the smallest ellipsoid around the rows kept, or the subspace they lie in.
pub(super) fn estimate(
    data: &PointReader<'_>,
    kept: &[bool],
    epsilon: f64,
) -> Result<Result<Estimate, Flat>, Error> {
    let ids: Vec<u64> = (0..).zip(kept).filter(|(_, kept)| **kept).map(|(id, _)| id).collect();
    let answer = around(data, &ids, epsilon)?.answer;
    Ok(match answer.hull {
        Some(hull) => Err(Flat::of_hull(answer.center, &hull)),
        None => {
            let (center, tail) = (answer.center, answer.center_tail);
            Ok(Estimate { center, tail, matrix: answer.factor.concat() }.with_needed_tail())
        }
    })
}

/// The smallest ellipsoid around rows, and around all that it encloses besides.
pub(super) fn enclose(
    data: &mut PointReader<'_>,
    mut kept: Vec<u64>,
    epsilon: f64,
) -> Result<EnclosingMetric, Error> {
    let dim = data.dim();
    loop {
        let found = around(data, &kept, epsilon)?;
        let answer = &found.answer;
        let flat = answer.hull.as_ref().map(|hull| Flat::of_hull(answer.center.clone(), hull));
        let inside = data.visit(|first, rows| {
            let is_inside = |row: &[f64]| {
                answer.norm(row) <= KEPT_REACH_MAX
                    && flat.as_ref().is_none_or(|flat| flat.project(row).1 <= flat.distance)
            };
            let rows = (first..).zip(rows.chunks_exact(dim));
            rows.filter(|(_, row)| is_inside(row)).map(|(id, _)| id).collect::<Vec<u64>>()
        })?;
        let mut all: Vec<u64> = inside.concat();
        all.extend(&kept);
        all.sort_unstable();
        all.dedup();
        if all.len() > kept.len() {
            kept = all;
            continue;
        }
        let (center, tail, part) = match flat {
            None => (answer.center.clone(), answer.center_tail.clone(), None),
            Some(flat) => {
                let center = vec![0.0; flat.rank()];
                let (ids, values) = flat.rows_on(data)?;
                (center, vec![], Some(Part { flat, ids, values }))
            }
        };
        let matrix = match &answer.hull {
            None => answer.factor.concat(),
            // F = AB with A lower triangular.
            Some(hull) => (answer.factor.iter().enumerate())
                .flat_map(|(a, row)| {
                    hull.basis
                        .iter()
                        .enumerate()
                        .map(move |(b, direction)| if b <= a { dot(row, direction) } else { 0.0 })
                })
                .collect(),
        };
        let mut left_out = vec![];
        let mut rest = kept.iter().peekable();
        left_out.extend((0..data.len()).filter(|id| rest.next_if_eq(&id).is_none()));
        let mut certificate = found.certificate;
        certificate.support.iter_mut().for_each(|id| *id = kept[*id as usize]);
        certificate.left_out = left_out;
        certificate.points_hash = data.hash();
        let enclosure = Enclosure { ellipsoid: found.answer, certificate };
        let metric = Estimate { center, tail, matrix };
        let metric = if metric.dim() > 0 { metric.with_needed_tail() } else { metric };
        return Ok(EnclosingMetric { enclosure, kept, part, metric });
    }
}
