//! Algorithm 3 of the thesis: at most 2d points whose ellipsoid is not much smaller than that of all.
//!
//! *Idea.* d times: a direction orthogonal to what is spanned so far, the two points that are extreme in it, and their
//! difference joins the span.
//! *Guarantee.* The log-volume of the ellipsoid of the points found is at most 2d·ln d below that of all; d passes of
//! O(nd).
//! *Departure.* The direction is arbitrary in the paper: here it is a normal vector of the seed, less its part in the
//! span, in coordinates of extent 1. "2d points" are at most 2d: a point may be extreme twice.
//! *Reference.* The thesis, 3.3; Kumar and Yıldırım, J. Optim. Theory Appl. 126(1), 2005.

use taut_kernels::vector::{add_scaled, dot};
use taut_points::{Distribution, generate};

use super::point_reader::PointReader;
use super::sample::Sample;
use super::working_set::WorkingSet;
use crate::Error;

/// X₀ with equal weights.
pub(super) fn points(
    reader: &mut PointReader<'_>,
    sample: &Sample,
    seed: u64,
) -> Result<WorkingSet, Error> {
    let dim = reader.dim();
    let mut set = WorkingSet::new(dim);
    if reader.len() <= 2 * dim as u64 {
        let ids: Vec<u64> = (0..reader.len()).collect();
        take(&mut set, reader, &sample.origin, &ids)?;
        return Ok(set);
    }
    let extents = sample.extents();
    let directions: Vec<f64> =
        generate(Distribution::Normal, dim, dim, seed).map_err(|_| Error::Overflow)?;
    let mut span: Vec<Vec<f64>> = vec![];
    for direction in directions.chunks_exact(dim) {
        let mut b = direction.to_vec();
        orthogonalize(&mut b, &span);
        let scaled: Vec<f64> = b.iter().zip(&extents).map(|(b, e)| b / e).collect();
        let (most, least) = extremes(reader, &scaled, &sample.origin)?;
        take(&mut set, reader, &sample.origin, &[most, least])?;
        let rows = reader.rows_from(&sample.origin, &[most, least])?;
        let (p, q) = rows.split_at(dim);
        let mut difference: Vec<f64> =
            p.iter().zip(q).zip(&extents).map(|((p, q), e)| (q - p) / e).collect();
        orthogonalize(&mut difference, &span);
        let norm = dot(&difference, &difference).sqrt();
        if norm > 0.0 {
            difference.iter_mut().for_each(|v| *v /= norm);
            span.push(difference);
        }
    }
    Ok(set)
}

/// Adds points, and makes all weights equal.
fn take(
    set: &mut WorkingSet,
    reader: &PointReader<'_>,
    origin: &[f64],
    ids: &[u64],
) -> Result<(), Error> {
    let rows = reader.rows_from(origin, ids)?;
    for (&id, row) in ids.iter().zip(rows.chunks_exact(origin.len())) {
        set.push(id, row, 1.0);
    }
    set.weights_mut().fill(1.0);
    set.normalize();
    Ok(())
}

/// Takes from v its part in the span; twice, as once leaves what rounding makes of it.
fn orthogonalize(v: &mut [f64], span: &[Vec<f64>]) {
    for other in span.iter().chain(span) {
        let product = dot(v, other);
        add_scaled(v, -product, other);
    }
}

/// One pass for the rows with the largest and least b′(x − o), the first of equals.
fn extremes(reader: &mut PointReader<'_>, b: &[f64], origin: &[f64]) -> Result<(u64, u64), Error> {
    let shift: Vec<f64> = origin.to_vec();
    let each = reader.visit(|first, rows| {
        let mut row = vec![0.0; b.len()];
        let (mut most, mut least) = ((f64::NEG_INFINITY, first), (f64::INFINITY, first));
        for (id, x) in (first..).zip(rows.chunks_exact(b.len())) {
            row.iter_mut().zip(x).zip(&shift).for_each(|((r, x), o)| *r = x - o);
            let value = dot(b, &row);
            if value > most.0 {
                most = (value, id);
            }
            if value < least.0 {
                least = (value, id);
            }
        }
        (most, least)
    })?;
    let start = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
    let (most, least) = each.into_iter().fold(start, |(most, least), (m, l)| {
        (if m.0 > most.0 { m } else { most }, if l.0 < least.0 { l } else { least })
    });
    Ok((most.1, least.1))
}
