//! From a method's outcome to an answer with a certificate.
//!
//! *Upper.* The points that may lie farthest outside are measured again with twice the digits, with F as it will be
//! returned: rounding the entries of F moves points by up to 2⁻⁵³ times the condition of the set, so F is scaled,
//! rounded and measured until every point is inside.
//! *Lower.* With u alone: ln κ_d + (d/2) ln d + ½ ln det Σ, for Σ the covariance of the support. In coordinates
//! y = F(x − c) it is nearly 1/d, so what is proved is not lost in logarithms of large numbers.
//! *Trap.* Of a thin shell more points are near the border than a pass lists. Then one more pass measures with twice
//! the digits whatever might be outside.

use taut_certify::{Ellipsoid, EllipsoidCertificate, Hull, Items, Solution, Stop, Trace};
use taut_kernels::Center;
use taut_kernels::compensated::Map;
use taut_kernels::triangle::leverages;
use taut_kernels::vector::dot;

use super::dense::{cholesky, divide_rows};
use super::outcome::{Candidate, Outcome, log_unit_ball};
use super::point_reader::PointReader;
use super::question::{Kind, Question};
use super::tilt::Tilt;
use super::{EllipsoidOptions, ROUNDING};
use crate::Error;
use crate::top::{Far, Top};

/// u of the rounding of `f64`.
const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;
/// The claimed gap may lack this of the proved one, for each dimension: the logarithms.
pub(super) const LOGARITHM_ROUNDING: f64 = 2e-15;
/// The part by which a checker may find a bound on errors larger than the solver does.
const ERROR_MARGIN: f64 = 1e-4;
/// At most this many scales are tried before a bound on the rounding of F takes the place of measuring.
const SCALES_MAX: u32 = 8;
/// At most this many points near the border are measured for each of them.
pub(super) const MEASURED_POINTS_MAX: usize = 1 << 14;

/// Turns an outcome for points that span the space into a solution.
pub(super) fn prove(
    reader: &mut PointReader<'_>,
    outcome: Outcome,
    options: &EllipsoidOptions<'_>,
) -> Result<Solution<Ellipsoid>, Error> {
    let dim = reader.dim();
    let best = &outcome.best;
    let map = Map { matrix: &best.matrix, center: &best.center, triangular: true };
    let settled = settle(reader, best, map, triangular_spread(&best.matrix, dim), None)?;
    let logs: f64 = (0..dim).map(|a| settled.factor[a * dim + a].ln()).sum();
    let log_volume = log_unit_ball(dim) - logs;
    let answer = answer(&settled.factor, best.center.clone(), log_volume, None)?;
    Ok(solution(reader, answer, outcome, settled.gap, options))
}

/// Puts together an answer from F, r × d.
pub(super) fn answer(
    factor: &[f64],
    center: Center,
    log_volume: f64,
    hull: Option<Hull>,
) -> Result<Ellipsoid, Error> {
    let dim = center.dim();
    let rows: Vec<Vec<f64>> = factor.chunks_exact(dim).map(<[f64]>::to_vec).collect();
    let mut matrix = vec![vec![0.0; dim]; dim];
    for a in 0..dim {
        for b in 0..=a {
            let entry: f64 = rows.iter().map(|row| row[a] * row[b]).sum();
            (matrix[a][b], matrix[b][a]) = (entry, entry);
        }
    }
    let finite = matrix.iter().flatten().chain(factor).all(|v| v.is_finite());
    // Where digits of the diagonal are lost, Q lets points of any size in. In a hull, other coordinates tell.
    let digits = |a: usize| matrix[a][a] >= f64::MIN_POSITIVE;
    let seen = match hull {
        Some(_) => rows.is_empty() || (0..dim).any(digits),
        None => (0..dim).all(digits),
    };
    if !finite || !seen || !log_volume.is_finite() {
        return Err(Error::Overflow);
    }
    Ok(Ellipsoid {
        center: center.high,
        center_tail: center.low,
        matrix,
        factor: rows,
        hull,
        log_volume,
    })
}

/// The solution of an outcome whose answer is settled.
pub(super) fn solution(
    reader: &PointReader<'_>,
    answer: Ellipsoid,
    outcome: Outcome,
    gap: f64,
    options: &EllipsoidOptions<'_>,
) -> Solution<Ellipsoid> {
    let wanted =
        if options.epsilon > 0.0 { options.epsilon } else { 4.0 * ROUNDING * answer.rank() as f64 };
    let mut stop = outcome.stop;
    if stop == Stop::Converged && gap > wanted {
        stop = Stop::Rounding;
    }
    let trace = Trace {
        method: options.method.name().to_owned(),
        stop,
        passes: reader.passes(),
        iterations: outcome.iterations,
        core_set: outcome.core_set,
        history: outcome.history,
        counters: outcome.counters,
    };
    let certificate = EllipsoidCertificate {
        items: Items::Points,
        support: outcome.best.support,
        multipliers: outcome.best.multipliers,
        directions: vec![],
        left_out: vec![],
        gap,
        points_hash: reader.hash(),
    };
    Solution { answer, certificate, trace }
}

/// Bounds | |M||x − c| | where |M(x − c)| ≤ 1: how much larger than its result the terms of a product are.
///
/// |x_b − c_b| is at most the norm of row b of M⁻¹.
pub(super) fn triangular_spread(matrix: &[f64], dim: usize) -> f64 {
    let mut inverse = vec![0.0; dim * dim];
    (0..dim).for_each(|a| inverse[a * dim + a] = 1.0);
    divide_rows(matrix, dim, &mut inverse);
    let extents: Vec<f64> = inverse.chunks_exact(dim).map(|row| dot(row, row).sqrt()).collect();
    spread(matrix, &extents)
}

/// | |M|·extents |.
pub(super) fn spread(matrix: &[f64], extents: &[f64]) -> f64 {
    let terms = |row: &[f64]| row.iter().zip(extents).map(|(m, e)| (m * e).abs()).sum::<f64>();
    matrix.chunks_exact(extents.len()).map(|row| terms(row).powi(2)).sum::<f64>().sqrt()
}

/// Bound on the relative error of |M(x − c)|² as a pass finds it, for the points that lie farthest out: differences,
/// products and sums of each coordinate.
pub(super) fn pass_error(dim: usize, spread: f64) -> f64 {
    2.0 * (dim as f64 + 5.0) * UNIT_ROUNDOFF * spread
}

/// F, r × d, such that every point has |F(x − c)| ≤ 1.
pub(super) struct Settled {
    pub(super) factor: Vec<f64>,
    /// F is s times the matrix given, but for rounding.
    pub(super) scale: f64,
    /// Its log-volume less a lower bound on that of any enclosing ellipsoid.
    pub(super) gap: f64,
}

/// The hull of a flat set, and the sum over the coordinates of how far points are from the center.
pub(super) struct Flat<'a> {
    pub(super) hull: &'a Hull,
    pub(super) reach: f64,
}

/// Scales M so that every point is inside; `spread` bounds | |M||x − c| | where |M(x − c)| ≤ 1.
pub(super) fn settle(
    reader: &mut PointReader<'_>,
    best: &Candidate,
    map: Map<'_>,
    spread: f64,
    flat: Option<Flat<'_>>,
) -> Result<Settled, Error> {
    let found = &best.found;
    let near = found.largest * (1.0 - 2.0 * pass_error(map.dim(), spread));
    let in_support = |id: &u64| best.support.binary_search(id).is_ok();
    let (others, all) = if map.triangular && found.listed_above < near {
        let far = found.far.iter().take_while(|far| far.reach2 >= near);
        (far.map(|far| far.id).filter(|id| !in_support(id)).collect(), found.largest)
    } else {
        let (far, largest) = measure(reader, map, near, spread)?;
        let others: Vec<u64> = far.iter().map(|far| far.id).filter(|id| !in_support(id)).collect();
        (if far.len() < MEASURED_POINTS_MAX { others } else { vec![] }, largest)
    };
    let all_measured = map.triangular && found.listed_above < near || !others.is_empty();
    let support = reader.rows(&best.support)?;
    let others = reader.rows(&others)?;
    let mut scale = 1.0 / all.sqrt();
    for attempt in 0.. {
        if attempt == SCALES_MAX || !all_measured {
            // Rounding the entries of sM moves an image by at most UNIT_ROUNDOFF·spread of it.
            scale = (1.0 - UNIT_ROUNDOFF * (spread + 3.0)) / all.sqrt();
        }
        let factor: Vec<f64> = map.matrix.iter().map(|m| m * scale).collect();
        let scaled = map.with(&factor);
        let (images, squares) = scaled.images(&support);
        let (_, other_squares) = scaled.images(&others);
        let largest = squares.iter().chain(&other_squares).fold(0.0f64, |m, &v| m.max(v));
        if largest <= 1.0 || attempt == SCALES_MAX || !all_measured {
            let tilt =
                flat.map_or(0.0, |flat| Tilt::new(&factor, Some(flat.hull)).error(flat.reach, 0.0));
            let errors = vec![tilt; best.support.len()];
            let gap = lower_gap(&images, &best.multipliers, map.rank(), &errors);
            // So far points may be outside, too.
            let gap = (gap + (LOGARITHM_ROUNDING + tilt) * map.rank() as f64).min(f64::MAX);
            return Ok(Settled { factor, scale, gap });
        }
        scale *= (1.0 - f64::from(1u32 << attempt) * UNIT_ROUNDOFF) / largest.sqrt();
    }
    unreachable!("the loop ends with the last attempt")
}

/// One pass in which all points that may lie farthest out are measured with twice the digits: the largest
/// |M(x − c)|², and who comes so near that rounding of F could put it first.
fn measure(
    reader: &mut PointReader<'_>,
    map: Map<'_>,
    near: f64,
    spread: f64,
) -> Result<(Vec<Far>, f64), Error> {
    let question = || Question {
        matrix: map.matrix.to_vec(),
        center: map.center.clone(),
        kind: Kind::Border { near },
    };
    let mut far = match reader.ask(question)? {
        Some(answer) => answer.border()?,
        None => {
            let lists = reader.visit(|first, rows| border_of_block(map, near, first, rows))?;
            let mut all = Top::new(MEASURED_POINTS_MAX);
            lists.into_iter().for_each(|list| all.merge(list));
            all.into_sorted()
        }
    };
    let largest = far.first().map_or(0.0, |far| far.reach2);
    far.retain(|far| far.reach2 >= largest * (1.0 - 4.0 * UNIT_ROUNDOFF * (spread + 3.0)));
    Ok((far, largest))
}

/// The points of a block that may lie farthest out, measured with twice the digits.
pub(super) fn border_of_block(map: Map<'_>, near: f64, first: u64, rows: &[f64]) -> Top {
    let dim = map.dim();
    let mut top = Top::new(MEASURED_POINTS_MAX);
    let mut scratch = vec![];
    let mut values = [0.0; 64];
    for (part, rows) in rows.chunks(64 * dim).enumerate() {
        let count = rows.len() / dim;
        let values = &mut values[..count];
        if map.triangular {
            leverages(rows, map.matrix, map.center, &mut scratch, values);
            if values.iter().all(|&v| v < near) {
                continue;
            }
        }
        let (_, squares) = map.images(rows);
        for (i, reach2) in squares.into_iter().enumerate() {
            top.offer(Far { id: first + (part * 64 + i) as u64, reach2 });
        }
    }
    top
}

/// −½ ln det(r·Σ − sI) for the covariance Σ of weighted images, n × r, and what r·Σ is off by at most, s.
///
/// Images that are off by eᵢ move Σuᵢyᵢyᵢ′/Σu by no more than Σuᵢeᵢ(2|yᵢ| + eᵢ)/Σu in norm, and the square of the mean by no
/// more again. No errors stand for none.
pub(super) fn lower_gap(images: &[f64], weights: &[f64], rank: usize, errors: &[f64]) -> f64 {
    let total: f64 = weights.iter().sum();
    let mut mean = vec![0.0; rank];
    for (y, u) in images.chunks_exact(rank).zip(weights) {
        mean.iter_mut().zip(y).for_each(|(s, y)| *s += u / total * y);
    }
    let mut covariance = vec![0.0; rank * rank];
    let mut z = vec![0.0; rank];
    for (y, u) in images.chunks_exact(rank).zip(weights) {
        z.iter_mut().zip(y).zip(&mean).for_each(|((z, y), m)| *z = y - m);
        for a in 0..rank {
            let row = &mut covariance[a * rank..a * rank + a + 1];
            let factor = u / total * rank as f64 * z[a];
            row.iter_mut().zip(&z).for_each(|(s, z)| *s += factor * z);
        }
    }
    let each = images.chunks_exact(rank.max(1)).zip(weights).zip(errors);
    let off: f64 = each.map(|((y, u), e)| u / total * e * (2.0 * dot(y, y).sqrt() + e)).sum();
    let shift = 2.0 * rank as f64 * off * (1.0 + ERROR_MARGIN);
    (0..rank).for_each(|a| covariance[a * rank + a] -= shift);
    if !cholesky(&mut covariance, rank) {
        return f64::INFINITY;
    }
    -(0..rank).map(|a| covariance[a * rank + a].ln()).sum::<f64>().min(0.0)
}
