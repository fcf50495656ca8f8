//! Center and scatter of most of the points, whatever the others are: MCD, MVE, trimming.
//!
//! [`search`] finds the rows to keep; [`fit`] goes down to a subspace where many rows lie in one, and weighs outliers
//! out; what it ends in becomes an answer here.

mod border;
mod chi_square;
mod concentrate;
mod eigen;
mod enclosing;
mod estimate;
mod fit;
mod flat;
mod in_parts;
mod options;
mod scale;
mod search;
mod starts;

use std::collections::BTreeMap;

use taut_certify::{
    Ellipsoid, Enclosure, Hull, RobustCertificate, RobustEllipsoid, RobustMethod, RobustScale,
    Solution, Stop, Trace, Unweighted,
};
use taut_points::{Monitor, PointSource, on_threads};

use self::fit::{Fit, Placed};
use crate::Error;
use crate::ellipsoid::dense::divide_rows;
use crate::ellipsoid::outcome::log_unit_ball;
use crate::ellipsoid::point_reader::PointReader;
pub(crate) use estimate::{Estimate, Moments};
pub use in_parts::RobustInParts;
pub(crate) use in_parts::in_parts;
pub use options::RobustOptions;

/// Center and scatter of most of n points of dimension d, the tolerance ellipsoid, and the points outside of it.
///
/// By default the h = ⌊(n + d + 1)/2⌋ points are sought whose covariance has the least determinant (MCD): wherever
/// nearly half of the points are, the answer stays bounded, though a denser cluster may win. Points far out in the
/// metric of the h are then weighed out, and center and scatter taken of the rest.
///
/// *What is proved.* The certificate names the h points; the checker takes their mean and covariance again, all factors,
/// weights and flags, and that no C-step leads on from them. That no other h points have a lower determinant is *not*
/// proved: the problem is NP-hard, and like all programs for it this one ends in a local optimum, the best of those
/// that six rankings and, up to d = 20, 500 simplices lead to. By `mcd`, exchanges of a point kept for one left out,
/// and small perturbations, lead lower still; no C-step and no such exchange of points near the border is left. For `mve` and
/// `trim` it is proved besides that no smaller ellipsoid holds the points kept.
///
/// *Equivariance.* What is minimized is affine equivariant, and so is the answer wherever the starts lead to the same
/// optimum, as they do on all but small or shapeless sets. The starts themselves are not: rankings look at coordinates
/// one by one, which only bears shifts and scales, and simplices are drawn by the bits of the points, so that their
/// order does not matter.
///
/// *Exact fit.* When h points lie in a hyperplane, or a smaller subspace, that is reported, not refused: the answer has
/// a [`hull`](RobustEllipsoid::hull), center and scatter are those of the points on it, and all others are outliers.
///
/// *Cost.* By `mcd`, for up to 4000 points: rankings of O(nd² log n), a thousand C-steps on up to 600 points, and some
/// hundred C-steps of O(nd²) on all. Beyond, starts see a sample of 2000, and all points are read some hundred to two
/// hundred times: normal points, 9000 × 2 87 to 190 times, 9000 × 10 114 to 127 times, 10⁵ × 10 144 to 155 times. By
/// `mve` and `trim`, a C-step solves a smallest ellipsoid of the points kept; 9000 × 10 are read some 40 times. In memory are one
/// block for each thread and some 30 bytes a point; by `mve` and `trim`, and where many points lie in a subspace, the
/// points kept as well.
///
/// ```
/// use taut_enclose::{RobustOptions, robust_ellipsoid};
///
/// // A grid of 5 × 5, and six points where somebody's hand slipped.
/// let mut values: Vec<f64> = (0..25).flat_map(|i| [f64::from(i % 5), f64::from(i / 5)]).collect();
/// (0..6).for_each(|i| values.extend([1000.0, f64::from(i)]));
/// let points = taut_points::Points::new(&values, 2)?;
/// let found = robust_ellipsoid(&points, &RobustOptions::default())?;
/// assert_eq!(found.answer.outliers, [25, 26, 27, 28, 29, 30]);
/// assert!((found.answer.center[0] - 2.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Empty`], [`Error::Overflow`]; [`Error::Input`], also when the source fails or the monitor stops the work.
pub fn robust_ellipsoid(
    source: &dyn PointSource,
    options: &RobustOptions<'_>,
) -> Result<Solution<RobustEllipsoid>, Error> {
    options.check()?;
    on_threads(options.threads, || solve(source, options, &options.monitor))
}

fn solve(
    source: &dyn PointSource,
    options: &RobustOptions<'_>,
    monitor: &Monitor<'_>,
) -> Result<Solution<RobustEllipsoid>, Error> {
    let mut data = PointReader::new(source, monitor)?;
    // Names what is not finite before anything is calculated from it.
    data.visit(|_, _| ())?;
    let h = options.kept(data.len() as usize, data.dim());
    let mut steps = 0;
    let placed = fit::place(&mut data, h, options, &mut steps)?;
    let answer = answer(&mut data, &placed, options.method)?;
    let reweighted = placed.fit.unweighted.is_none() && !placed.fit.estimate.center.is_empty();
    let certificate = certificate(&data, placed, h, options);
    // The search ends where it ends; only the ellipsoid around the points kept can miss the gap that was wanted.
    let misses = |enclosure: &Enclosure| {
        options.epsilon > 0.0 && enclosure.certificate.gap > options.epsilon
    };
    let is_missed = certificate.enclosure.as_ref().is_some_and(misses);
    let trace = Trace {
        method: options.method.name().to_owned(),
        stop: if is_missed { Stop::Rounding } else { Stop::Converged },
        passes: data.passes(),
        iterations: steps,
        core_set: h as u64,
        history: vec![],
        counters: BTreeMap::from([("reweighted".to_owned(), u64::from(reweighted))]),
    };
    Ok(Solution { answer, certificate, trace })
}

/// The answer in the space of the points.
fn answer(
    data: &mut PointReader<'_>,
    placed: &Placed,
    method: RobustMethod,
) -> Result<RobustEllipsoid, Error> {
    let mut answer = shape(data.dim(), placed, method)?;
    // Those of trimming are the points left out, and named with the shape.
    let is_trimmed = method == RobustMethod::Trim && placed.fit.enclosure.is_some();
    if !is_trimmed {
        answer.outliers = outliers(data, placed, &answer)?;
    }
    Ok(answer)
}

/// The answer without its outliers, unless they are those of trimming.
fn shape(dim: usize, placed: &Placed, method: RobustMethod) -> Result<RobustEllipsoid, Error> {
    let Fit { estimate, scale, cutoff, .. } = &placed.fit;
    // The border of a trimmed set is the ellipsoid itself.
    let cutoff = if method == RobustMethod::Trim { 1.0 / scale } else { *cutoff };
    let rank = estimate.dim();
    // S = LL′ with L = √scale·M⁻¹, F = M/√(scale·cutoff).
    let mut inverse = vec![0.0; rank * rank];
    (0..rank).for_each(|a| inverse[a * rank + a] = scale.sqrt());
    divide_rows(&estimate.matrix, rank, &mut inverse);
    let border = (scale * cutoff).sqrt();
    let factor: Vec<f64> = estimate.matrix.iter().map(|m| m / border).collect();
    let (center, center_tail, factor, lower) = match &placed.flat {
        None => (estimate.center.clone(), estimate.tail.clone(), factor, inverse),
        Some(flat) => {
            let transposed = flat.rotated_columns(&inverse);
            (flat.lifted(&estimate.center), vec![], flat.rotated_rows(&factor), transposed)
        }
    };
    // `lower` is d × r: S = lower·lower′.
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let width = rank.max(1);
    let table = |entry: &dyn Fn(usize, usize) -> f64| {
        let mut rows = vec![vec![0.0; dim]; dim];
        for a in 0..dim {
            for b in 0..=a {
                let value = entry(a, b);
                (rows[a][b], rows[b][a]) = (value, value);
            }
        }
        rows
    };
    let row = |a: usize| if rank == 0 { &[][..] } else { &lower[a * width..(a + 1) * width] };
    let scatter = table(&|a, b| product(row(a), row(b)));
    let factor: Vec<Vec<f64>> = factor.chunks_exact(dim).map(<[f64]>::to_vec).collect();
    let matrix = table(&|a, b| factor.iter().map(|row| row[a] * row[b]).sum());
    let log_det = estimate.log_det() + rank as f64 * scale.ln();
    let log_volume = match rank {
        0 => 0.0,
        _ => log_unit_ball(rank) + 0.5 * (rank as f64 * cutoff.ln() + log_det),
    };
    let log_det = if rank == 0 { 0.0 } else { log_det };
    let mut numbers = scatter.iter().chain(&matrix).chain(&factor).flatten();
    let visible = placed.flat.is_some()
        || (0..dim).all(|a| scatter[a][a].is_normal() && matrix[a][a].is_normal());
    if !visible || !numbers.all(|v| v.is_finite()) || !log_volume.is_finite() {
        return Err(Error::Overflow);
    }
    if let (RobustMethod::Trim, Some(Enclosure { ellipsoid, certificate })) =
        (method, &placed.fit.enclosure)
    {
        let Ellipsoid { center, center_tail, matrix, factor, hull, log_volume } = ellipsoid.clone();
        let outliers = certificate.left_out.clone();
        return Ok(RobustEllipsoid {
            center,
            center_tail,
            matrix,
            factor,
            hull,
            log_volume,
            scatter,
            log_det,
            outliers,
        });
    }
    let hull = placed.flat.as_ref().map(|flat| Hull {
        basis: flat.basis.chunks_exact(dim).map(<[f64]>::to_vec).collect(),
        distance: flat.distance,
    });
    Ok(RobustEllipsoid {
        center,
        center_tail,
        matrix,
        factor,
        hull,
        log_volume,
        scatter,
        log_det,
        outliers: vec![],
    })
}

/// The rows outside the ellipsoid as it is returned, or off the hull.
fn outliers(
    data: &mut PointReader<'_>,
    placed: &Placed,
    RobustEllipsoid { center, center_tail: tail, factor, .. }: &RobustEllipsoid,
) -> Result<Vec<u64>, Error> {
    let dim = data.dim();
    let blocks = data.visit(|first, rows| {
        let mut outside = vec![];
        let mut offset = vec![0.0; dim];
        for (id, row) in (first..).zip(rows.chunks_exact(dim)) {
            offset.iter_mut().zip(row).zip(center).for_each(|((o, x), c)| *o = x - c);
            offset.iter_mut().zip(tail).for_each(|(o, tail)| *o -= tail);
            let image =
                factor.iter().map(|f| f.iter().zip(&offset).map(|(f, o)| f * o).sum::<f64>());
            let square: f64 = image.map(|y| y * y).sum();
            let is_off =
                placed.flat.as_ref().is_some_and(|flat| flat.project(row).1 > flat.distance);
            let is_inside = square <= 1.0 && !is_off;
            if !is_inside {
                outside.push(id);
            }
        }
        outside
    })?;
    Ok(blocks.concat())
}

fn certificate(
    data: &PointReader<'_>,
    placed: Placed,
    h: usize,
    options: &RobustOptions<'_>,
) -> RobustCertificate {
    let is_trimmed = options.method == RobustMethod::Trim;
    let weighed_out =
        if is_trimmed { vec![] } else { placed.others(&placed.fit.weighed, data.len()) };
    let left_out = placed.others(&placed.fit.kept, data.len());
    let fit = placed.fit;
    let is_weighed = fit.unweighted.is_none() && !is_trimmed && !fit.estimate.center.is_empty();
    RobustCertificate {
        method: options.method,
        kept: h as u64,
        left_out,
        objective: fit.objective,
        level: if is_trimmed { 1.0 } else { options.level },
        cutoff: if is_trimmed { 0.0 } else { fit.cutoff },
        raw_scale: fit.raw_scale,
        scale: if is_trimmed { 0.0 } else { fit.scale },
        scaled_by: if is_weighed { options.scale } else { RobustScale::default() },
        weighed_out,
        unweighted: if is_trimmed { Some(Unweighted::Trimmed) } else { fit.unweighted },
        enclosure: fit.enclosure,
        points_hash: data.hash(),
    }
}
