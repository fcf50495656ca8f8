//! Claims about each row: where it is, whether it is an outlier, and how far it is in the metric of the rows kept.

use taut::RobustMethod;
use taut::certify::{Ellipsoid, RobustCertificate, RobustEllipsoid, RobustVerdict};

use super::super::body::Body;
use super::super::claims::Claims;
use super::super::ellipsoid::U;
use super::super::flat;
use super::super::interval::Interval;
use super::super::linear::{Matrix, Vector, difference, exact, image, squared_length};
use super::super::mvee::larger;
use super::SLACK_MIN;

/// Differences in |F(x − c)| below this are not told apart.
const DIFFERENCE_MIN: f64 = 1e-25;

/// Where a row is.
pub(super) struct Row {
    /// |F(x − c)|² of the answer.
    pub(super) square: Interval,
    /// States whether it is on the hull; `None` where rounding may decide.
    pub(super) on_hull: Option<bool>,
    pub(super) y: Vector,
}

/// Where all rows are.
pub(super) fn rows(
    ellipsoid: &Ellipsoid,
    at: &[Interval],
    factor: &Matrix,
    points: &[Body],
) -> Option<Vec<Row>> {
    points
        .iter()
        .map(|point| {
            let offset = difference(&point.center, at);
            let y = image(factor, &offset);
            let on_hull = match &ellipsoid.hull {
                None => Some(true),
                Some(hull) => flat::is_near(hull, &offset)?,
            };
            Some(Row { square: squared_length(&y), on_hull, y })
        })
        .collect()
}

/// Outliers are the rows outside, up to the excess stated, and those off the hull.
pub(super) fn flags(
    claims: &mut Claims,
    answer: &RobustEllipsoid,
    verdict: &RobustVerdict,
    rows: &[Row],
) -> Option<()> {
    let excess = Interval::exact(verdict.flag_excess * (1.0 + 1e-9) + DIFFERENCE_MIN)?;
    let (most, least) = (Interval::integer(1).plus(&excess), Interval::integer(1).minus(&excess));
    let (most, least) =
        (most.square(), if least.is_positive() { least.square() } else { Interval::zero() });
    for (number, row) in rows.iter().enumerate() {
        let is_outlier = answer.outliers.binary_search(&(number as u64)).is_ok();
        match (is_outlier, row.on_hull) {
            (false, Some(false)) => {
                claims
                    .holds(Some(false), || format!("row {number} is off the hull and no outlier"));
            }
            (true, Some(true)) => {
                claims.at_most(&format!("the border, for outlier {number}"), &least, &row.square);
            }
            (false, _) => {
                claims.at_most(&format!("row {number}, no outlier"), &row.square, &most);
            }
            (true, _) => {}
        }
    }
    Some(())
}

/// The slack is 1e-9, and 16(d + 4)u of what |F| makes of the extents of the points kept, and 8u of what it makes of the center.
pub(super) fn slack(
    claims: &mut Claims,
    answer: &RobustEllipsoid,
    verdict: &RobustVerdict,
    points: &[Body],
    kept: &[usize],
) -> Option<()> {
    let at = exact(&answer.center)?;
    let mut extents = vec![Interval::zero(); at.len()];
    for &row in kept {
        for (most, x) in extents.iter_mut().zip(difference(&points[row].center, &at)) {
            *most = larger(most.clone(), x.absolute());
        }
    }
    let seen = |sizes: &[Interval]| -> Option<f64> {
        let along = |row: &Vec<f64>| -> Option<f64> {
            let terms = exact(row)?
                .iter()
                .zip(sizes)
                .map(|(f, x)| f.times(x).absolute())
                .collect::<Vec<_>>();
            Some(terms.iter().fold(Interval::zero(), |sum, t| sum.plus(t)).rounded())
        };
        answer.factor.iter().map(along).try_fold(0.0f64, |most, v| Some(most.max(v?)))
    };
    let thin = 16.0 * (at.len() + 4) as f64 * U * seen(&extents)?;
    let far = 8.0 * U * seen(&at)?;
    let wanted = (SLACK_MIN + thin + far).min(0.1);
    claims.holds(Some(verdict.slack <= 1.001 * wanted), || {
        format!("the slack is {:e} in place of {wanted:e}", verdict.slack)
    });
    Some(())
}

/// No row kept is farther than one left out, and rows are weighed out beyond the quantile.
pub(super) fn distances(
    claims: &mut Claims,
    certificate: &RobustCertificate,
    verdict: &RobustVerdict,
    rows: &[Row],
    squares: &[Interval],
) -> Option<()> {
    let slack = Interval::exact(1.01 * verdict.slack)?;
    let one = Interval::integer(1);
    let border =
        Interval::exact(certificate.cutoff)?.times(&Interval::exact(certificate.raw_scale)?);
    let named = |list: &[u64], row: usize| list.binary_search(&(row as u64)).is_ok();
    let on_hull = || (0..squares.len()).filter(|&row| rows[row].on_hull == Some(true));
    let kept = on_hull().filter(|&row| !named(&certificate.left_out, row));
    let far = kept.fold(Interval::zero(), |far, row| larger(far, squares[row].clone()));
    for row in on_hull() {
        if named(&certificate.left_out, row) {
            let limit = squares[row].times(&one.plus(&slack)).plus(&slack);
            let what =
                format!("squared distance of the farthest row kept, and of row {row} left out");
            claims.at_most(&what, &far, &limit);
        }
        if !verdict.reweighted || certificate.method == RobustMethod::Trim {
            continue;
        }
        let what = format!("row {row} and the quantile");
        match named(&certificate.weighed_out, row) {
            true => {
                let inner = one.minus(&slack).square().times(&border);
                claims.at_most(&what, &inner, &squares[row]);
            }
            false => {
                let outer = one.plus(&slack).square().times(&border);
                claims.at_most(&what, &squares[row], &outer);
            }
        }
    }
    Some(())
}
