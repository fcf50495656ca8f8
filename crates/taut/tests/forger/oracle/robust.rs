//! Decides whether what is said of a robust ellipsoid is true.
//!
//! *Claims.* As many points are kept as is said, and the objective is theirs. No C-step leads on: in the metric of the points
//! kept none of them is farther than a point left out, and by `mve` and `trim` the ellipsoid around them is the smallest and
//! has fewer than h points strictly inside. Center, scatter, log-determinant and log-volume are those of the points not
//! weighed out; points are weighed out beyond the quantile, and outliers are outside the ellipsoid.
//! *Truth.* Moments and distances are found in 256 bits from the lists of the certificate. They are compared in the frame of
//! the answer, y = F(x − c), with the slack that the verdict states, and that with its definition.
//! *The smallest.* A verdict calls an ellipsoid around the points kept a local optimum, so its volume may exceed the least by
//! no more than [`VOLUME_GAP_MAX`], whatever gap is stated for it.

mod factors;
mod moments;
mod passes;
#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use taut::certify::{
    Ellipsoid, EllipsoidVerdict, RobustCertificate, RobustEllipsoid, RobustVerdict,
};
use taut::{Items, RobustMethod, Solution};

use self::moments::Moments;
use self::passes::{distances, flags, rows, slack};
use super::Truth;
use super::body::Body;
use super::claims::Claims;
use super::ellipsoid::{EllipsoidOracle, U, center, log_volume, log_volume_tolerance};
use super::flat;
use super::interval::Interval;
use super::linear::{Matrix, Vector, congruent, exact_rows};

/// By how much the log-volume of an ellipsoid around the points kept may exceed the least one: with a wider gap nothing tells
/// that no C-step leads on.
const VOLUME_GAP_MAX: f64 = 0.011;
/// Rows nearer than this to the border of the ellipsoid around the points kept may be on it.
const ON_BORDER: f64 = 1e-6;
/// The checker's least slack.
const SLACK_MIN: f64 = 1e-9;

/// The truth about robust ellipsoids of one input.
pub(crate) struct RobustOracle {
    dim: usize,
    points: Option<Vec<Body>>,
    /// The oracles of the points kept, by the rows left out.
    enclosures: Mutex<HashMap<Vec<u64>, Arc<EllipsoidOracle>>>,
}

impl RobustOracle {
    pub(crate) fn new(values: &[f64], columns: usize) -> Self {
        let rows = values.chunks_exact(columns.max(1));
        let points = rows.map(|row| Body::of(Items::Points, columns, row)).collect();
        RobustOracle { dim: columns, points, enclosures: Mutex::new(HashMap::new()) }
    }

    pub(crate) fn judge(
        &self,
        solution: &Solution<RobustEllipsoid>,
        verdict: &RobustVerdict,
    ) -> Truth {
        let mut claims = Claims::default();
        let (answer, certificate) = (&solution.answer, &solution.certificate);
        let Some(points) = &self.points else {
            return Truth::Undecided("a coordinate is not finite".into());
        };
        if let Err(why) = self.counts(answer, certificate, verdict, points.len()) {
            return Truth::False(why);
        }
        if self.claims(&mut claims, answer, certificate, verdict, points).is_none() {
            claims.holds(Some(false), || "a number is not finite, or a matrix singular".into());
        }
        claims.truth()
    }

    /// Lists, lengths and counts.
    fn counts(
        &self,
        answer: &RobustEllipsoid,
        certificate: &RobustCertificate,
        verdict: &RobustVerdict,
        n: usize,
    ) -> Result<(), String> {
        let is_list = |rows: &[u64]| {
            rows.windows(2).all(|pair| pair[0] < pair[1]) && rows.iter().all(|&row| row < n as u64)
        };
        let lists = [&answer.outliers, &certificate.left_out, &certificate.weighed_out];
        let ensure = |holds: bool, what: &str| if holds { Ok(()) } else { Err(what.to_owned()) };
        ensure(lists.iter().all(|rows| is_list(rows)), "a list of rows is not ascending")?;
        let kept = (n - certificate.left_out.len()) as u64;
        let is_mcd = certificate.method == RobustMethod::Mcd;
        let is_trim = certificate.method == RobustMethod::Trim;
        ensure(verdict.kept == kept && verdict.wanted == certificate.kept, "the counts differ")?;
        let wanted = verdict.wanted;
        ensure(if is_mcd { kept == wanted } else { kept >= wanted }, "too few rows are kept")?;
        let least = if is_trim { 1 } else { (n + self.dim).div_ceil(2).min(n) as u64 };
        ensure(wanted >= least, "fewer rows are kept than a robust fit needs")?;
        ensure(!is_trim || answer.outliers == certificate.left_out, "other rows are outliers")?;
        let rank = verdict.rank;
        let is_shaped = answer.center.len() == self.dim
            && answer.factor.len() == rank
            && answer.hull.is_some() == (rank < self.dim)
            && answer.hull.as_ref().is_none_or(|hull| hull.basis.len() == rank)
            && answer.scatter.len() == self.dim;
        ensure(is_shaped, "the lengths of lists disagree")?;
        let reweighted = certificate.unweighted.is_none() && rank > 0;
        ensure(verdict.reweighted == reweighted, "it is not as said whether points are weighed")?;
        ensure(verdict.enclosure.is_some() == certificate.enclosure.is_some(), "no enclosure")?;
        ensure(is_mcd == certificate.enclosure.is_none(), "the enclosure is that of no method")
    }

    fn claims(
        &self,
        claims: &mut Claims,
        answer: &RobustEllipsoid,
        certificate: &RobustCertificate,
        verdict: &RobustVerdict,
        points: &[Body],
    ) -> Option<()> {
        let ellipsoid = answer.ellipsoid();
        let (at, factor) = (center(&ellipsoid)?, exact_rows(&answer.factor)?);
        let rank = verdict.rank;
        let is_out = |list: &[u64], row: usize| list.binary_search(&(row as u64)).is_ok();
        let kept: Vec<usize> =
            (0..points.len()).filter(|&row| !is_out(&certificate.left_out, row)).collect();
        if answer.hull.is_some() {
            let near: Vec<Body> = kept.iter().map(|&row| points[row].clone()).collect();
            flat::judge(claims, &ellipsoid, &at, &near, flat::OF_POINTS, 4.0, None)?;
        }
        let rows = rows(&ellipsoid, &at, &factor, points)?;
        let sure = rows.iter().filter(|row| row.on_hull == Some(true)).count() as u64;
        let open = rows.iter().filter(|row| row.on_hull.is_none()).count() as u64;
        let least = sure.max(verdict.kept);
        claims.holds(Some((least..=sure + open).contains(&verdict.on_hull)), || {
            format!("{} rows on the hull in place of {sure}", verdict.on_hull)
        });
        flags(claims, answer, verdict, &rows)?;
        slack(claims, answer, verdict, points, &kept)?;
        factors::claims(claims, certificate, verdict, points.len());
        let slack = verdict.slack;
        if rank > 0 {
            let volume = log_volume(&ellipsoid, &factor)?;
            let of_basis = 16.0 * (rank * (self.dim + 4)) as f64 * U;
            let granted = log_volume_tolerance(&answer.factor, volume.rounded()) + of_basis;
            claims.near("log-volume", &Interval::exact(answer.log_volume)?, &volume, granted);
            self.shape(claims, answer, certificate, &volume, &factor, slack)?;
        }
        let off_hull = |claims: &mut Claims, list: &[u64], what: &str| {
            for (row, found) in rows.iter().enumerate() {
                let holds = is_out(list, row) || found.on_hull != Some(false);
                claims.holds(Some(holds), || format!("row {row} is off the hull and not {what}"));
            }
        };
        off_hull(claims, &certificate.left_out, "left out");
        let images =
            |rows_of: &[usize]| -> Matrix { rows_of.iter().map(|&r| rows[r].y.clone()).collect() };
        let around = Moments::of(&images(&kept), rank)?;
        if certificate.method != RobustMethod::Trim {
            off_hull(claims, &certificate.weighed_out, "weighed out");
            let weighed: Vec<usize> =
                (0..points.len()).filter(|&r| !is_out(&certificate.weighed_out, r)).collect();
            let factor = Interval::exact(certificate.scale * certificate.cutoff)?;
            // By `mve` without weights the ellipsoid around the points kept gives center and scatter.
            let is_enclosure = certificate.enclosure.is_some() && !verdict.reweighted;
            if rank > 0 && !is_enclosure {
                Moments::of(&images(&weighed), rank)?.is_standard(claims, &factor, slack)?;
            }
        }
        let objective = Interval::exact(verdict.objective)?;
        let squares: Vector = match (&certificate.enclosure, &verdict.enclosure) {
            (Some(enclosure), Some(proved)) => {
                let (answer, kept) = (&enclosure.ellipsoid, &kept);
                self.enclosure(claims, certificate, answer, proved, &objective, points, kept)?
            }
            _ if rank == 0 => vec![],
            _ => {
                let ln_det =
                    around.log_determinant()?.minus(&self.log_det_factor(&ellipsoid, &factor)?);
                let granted = SLACK_MIN * (1.0 + ln_det.rounded().abs()) + rank as f64 * slack;
                claims.near("objective", &objective, &ln_det, granted);
                rows.iter().map(|row| around.square(&row.y)).collect::<Option<_>>()?
            }
        };
        if rank > 0 {
            distances(claims, certificate, verdict, &rows, &squares)?;
        }
        Some(())
    }

    /// 2·ln |det F|, or that within the hull: what ln det of a covariance in the frame exceeds that of the points by.
    fn log_det_factor(&self, ellipsoid: &Ellipsoid, factor: &Matrix) -> Option<Interval> {
        let of_ball = super::interval::log_unit_ball(factor.len());
        Some(of_ball.minus(&log_volume(ellipsoid, factor)?).scaled(1))
    }

    /// F S Fᵀ = I/border, and ln det S.
    fn shape(
        &self,
        claims: &mut Claims,
        answer: &RobustEllipsoid,
        certificate: &RobustCertificate,
        volume: &Interval,
        factor: &Matrix,
        slack: f64,
    ) -> Option<()> {
        let scatter = exact_rows(&answer.scatter)?;
        let is_trim = certificate.method == RobustMethod::Trim;
        let border = match is_trim {
            true => Interval::integer(1).over(&Interval::exact(certificate.raw_scale)?)?,
            false => Interval::exact(certificate.cutoff)?,
        };
        let deviations: Vec<f64> =
            (0..self.dim).map(|j| answer.scatter[j][j].max(0.0).sqrt()).collect();
        let size =
            |row: &[f64]| -> f64 { row.iter().zip(&deviations).map(|(f, s)| f.abs() * s).sum() };
        for (a, row) in congruent(factor, &scatter).iter().enumerate() {
            for (b, entry) in row.iter().enumerate() {
                let sizes = size(&answer.factor[a]) * size(&answer.factor[b]) * border.rounded();
                let granted = 1.01 * slack + 16.0 * (self.dim + 4) as f64 * U * sizes;
                let wanted = Interval::integer(i64::from(a == b));
                let what = format!("entry ({a}, {b}) of FSFᵀ over the border");
                claims.near(&what, &entry.times(&border), &wanted, granted);
            }
        }
        for j in 0..self.dim {
            let is_symmetric = (0..j).all(|k| answer.scatter[j][k] == answer.scatter[k][j]);
            claims.holds(Some(is_symmetric), || "the scatter is not symmetric".into());
        }
        let rank = factor.len();
        let of_ball = super::interval::log_unit_ball(rank);
        let rank_times = Interval::integer(rank as i64).times(&border.ln()?);
        let log_det = volume.minus(&of_ball).scaled(1).minus(&rank_times);
        let granted = SLACK_MIN * (1.0 + log_det.rounded().abs()) + rank as f64 * slack;
        claims.near("log-determinant", &Interval::exact(answer.log_det)?, &log_det, granted);
        Some(())
    }

    /// Claims about the ellipsoid around the points kept; returns |F(x − c)|² of it for all rows.
    fn enclosure(
        &self,
        claims: &mut Claims,
        certificate: &RobustCertificate,
        answer: &Ellipsoid,
        proved: &EllipsoidVerdict,
        objective: &Interval,
        points: &[Body],
        kept: &[usize],
    ) -> Option<Vector> {
        let oracle = self.around(certificate, points, kept)?;
        let theirs = &certificate.enclosure.as_ref()?.certificate;
        claims.holds(Some(theirs.left_out == certificate.left_out), || {
            "the ellipsoid around the points kept leaves out others".into()
        });
        oracle.claims(claims, answer, theirs, proved);
        let (at, factor) = (center(answer)?, exact_rows(&answer.factor)?);
        let rows = rows(answer, &at, &factor, points)?;
        let outside = Interval::exact(1.0 - 2e-12)?.square();
        for &row in &certificate.left_out {
            let row = rows.get(row as usize)?;
            if row.on_hull == Some(true) {
                claims.at_most("the border, for a row left out", &outside, &row.square);
            }
        }
        if !factor.is_empty() {
            let volume = log_volume(answer, &factor)?;
            let granted = SLACK_MIN * (1.0 + volume.rounded().abs());
            claims.near("objective", objective, &volume, granted);
            if claims.is_settled_false() {
                return Some(vec![]);
            }
            let least = objective.minus(&Interval::exact(VOLUME_GAP_MAX)?);
            match oracle.optimum_for(answer.hull.as_ref(), &least) {
                Some(optimum) => {
                    claims.below(
                        "objective of a local optimum, less what is loose",
                        &least,
                        &optimum,
                    );
                }
                None => claims.undecided("the least volume around the points kept is not known"),
            }
            let inside =
                Interval::exact(1.0 - ON_BORDER - VOLUME_GAP_MAX.min(proved.gap))?.square();
            let strictly = rows.iter().filter(|row| row.on_hull == Some(true));
            let count = strictly.filter(|row| row.square.at_most(&inside) == Some(true)).count();
            claims.holds(Some((count as u64) < certificate.kept), || {
                format!("{count} rows lie strictly inside: a C-step leads on")
            });
        }
        Some(rows.into_iter().map(|row| row.square).collect())
    }

    /// The oracle of the points kept.
    fn around(
        &self,
        certificate: &RobustCertificate,
        points: &[Body],
        kept: &[usize],
    ) -> Option<Arc<EllipsoidOracle>> {
        let mut known = self.enclosures.lock().ok()?;
        let make = || {
            let bodies = kept.iter().map(|&row| points[row].clone()).collect();
            let rows = kept.iter().map(|&row| row as u64).collect();
            Arc::new(EllipsoidOracle::of_bodies(Some(bodies), rows, self.dim, Items::Points))
        };
        Some(known.entry(certificate.left_out.clone()).or_insert_with(make).clone())
    }
}
