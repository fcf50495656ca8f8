//! Robust ellipsoids: what most of the points say of center and scatter, whatever the others say.

mod check;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash, choice};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError, Ellipsoid, EllipsoidCertificate, EllipsoidVerdict, Hull};

/// The criterion of a robust estimate of center and scatter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RobustMethod {
    /// Minimum covariance determinant: the h points whose covariance has the least determinant, then reweighted.
    #[default]
    Mcd,
    /// Minimum volume ellipsoid: the h points that fit the smallest ellipsoid, then reweighted.
    Mve,
    /// The smallest ellipsoid around h points, as it stands.
    Trim,
}

choice! { "method", RobustMethod {
    Mcd = "mcd", "the points whose covariance has the least determinant";
    Mve = "mve", "the points that fit the smallest ellipsoid";
    Trim = "trim", "the same, and its ellipsoid as it stands";
}}

/// The part of normal points from whose covariance that of all is concluded, where outliers were weighed out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RobustScale {
    /// The share of the points that is left; by `mcd` with a factor for small samples. So does R's robustbase.
    #[default]
    Share,
    /// The level, whatever share is left. So does scikit-learn.
    Level,
}

choice! { "scale", RobustScale {
    Share = "share", "by the share of the points that is left";
    Level = "level", "by the level alone";
}}

impl RobustScale {
    /// Returns true for the default, which certificates do not name.
    fn is_share(&self) -> bool {
        *self == RobustScale::Share
    }
}

/// Center and scatter of most of the points, the ellipsoid they mean, and the points that lie outside it.
///
/// By `mcd` and `mve` the ellipsoid is the tolerance ellipsoid (x − c)ᵀS⁻¹(x − c) ≤ χ²: of normal points it holds the
/// part that was asked for. By `trim` it is the smallest ellipsoid around the points that were kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a robust ellipsoid: an object with center, matrix, factor, log_volume, scatter, log_det and outliers"
)]
pub struct RobustEllipsoid {
    /// The d coordinates of the center c.
    pub center: Vec<f64>,
    /// The vector to add to `center` for the exact center, as in [`Ellipsoid::center_tail`]. By `mcd` and `mve` it is empty
    /// unless the points are so far from the origin that rounding the center to `f64` would move it by a visible part of
    /// their spread.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub center_tail: Vec<f64>,
    /// Q, d rows of d numbers: (x − c)ᵀQ(x − c) ≤ 1 is the ellipsoid.
    pub matrix: Vec<Vec<f64>>,
    /// F, r rows of d numbers, Q = FᵀF: a point is inside if and only if |F(x − c)| ≤ 1, where x − c is formed first.
    pub factor: Vec<Vec<f64>>,
    /// The affine subspace in which most points lie exactly; absent when there is none. All points off it are outliers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hull: Option<Hull>,
    /// The natural logarithm of the volume of the ellipsoid, of dimension r; 0 for a single point.
    pub log_volume: f64,
    /// S, the scatter, d rows of d numbers: for normal points an estimate of their covariance. Its rank is r.
    pub scatter: Vec<Vec<f64>>,
    /// ln det S, of dimension r: where a hull is given, the determinant is that of S within it. 0 for r = 0.
    pub log_det: f64,
    /// Rows outside the ellipsoid or off the hull, ascending: the outliers.
    #[serde(alias = "flagged")]
    pub outliers: Vec<u64>,
}

impl RobustEllipsoid {
    /// The ellipsoid alone.
    pub fn ellipsoid(&self) -> Ellipsoid {
        Ellipsoid {
            center: self.center.clone(),
            center_tail: self.center_tail.clone(),
            matrix: self.matrix.clone(),
            factor: self.factor.clone(),
            hull: self.hull.clone(),
            log_volume: self.log_volume,
        }
    }
}

/// The parts of a robust estimate, so that all of it can be calculated again from the points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of a robust ellipsoid: an object with method, kept, left_out, objective and others"
)]
pub struct RobustCertificate {
    /// The objective that was minimized.
    pub method: RobustMethod,
    /// h, how many points were asked for.
    pub kept: u64,
    /// Rows not among them, ascending. By `mcd` there are n − h; by `mve` and `trim` perhaps fewer, as an ellipsoid may
    /// hold more points than it was asked to.
    pub left_out: Vec<u64>,
    /// The value of the objective: by `mcd` ln det of the covariance (divisor h − 1) of the points kept, by `mve` and
    /// `trim` the log-volume of the ellipsoid around them. Of dimension r where a hull is given.
    pub objective: f64,
    /// The part of normal points that the tolerance ellipsoid holds. By `trim`, 1.
    pub level: f64,
    /// The quantile of χ² with r degrees of freedom at `level`; 0 by `trim` and for r = 0.
    pub cutoff: f64,
    /// By what the scatter of the points kept is multiplied before outliers are weighed out.
    pub raw_scale: f64,
    /// By what the covariance of the points not weighed out is multiplied; 0 by `trim`, where nothing is weighed.
    pub scale: f64,
    /// The part that `scale` is of; by `trim`, and where no points are weighed again, the default.
    #[serde(default, skip_serializing_if = "RobustScale::is_share")]
    pub scaled_by: RobustScale,
    /// Rows weighed out, ascending: those beyond `cutoff` in the metric of the points kept.
    pub weighed_out: Vec<u64>,
    /// Why center and scatter are those of the points kept, if they are: then no others are weighed, and `weighed_out`
    /// repeats `left_out`. Absent where points are weighed again.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unweighted: Option<Unweighted>,
    /// By `mve` and `trim`, the ellipsoid around the points kept, and the proof that it is the smallest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub enclosure: Option<Enclosure>,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// Why points are not weighed again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Unweighted {
    /// By `trim`, the ellipsoid around the points kept is the answer.
    Trimmed,
    /// Every point is kept, or every one on the hull.
    AllKept,
    /// The points within the quantile are too few for a scatter, or lie in a flat of lower dimension.
    Flat,
}

impl Unweighted {
    /// The reason, in words that follow "because".
    pub const fn reason(self) -> &'static str {
        match self {
            Unweighted::Trimmed => "points are trimmed",
            Unweighted::AllKept => "all points are kept",
            Unweighted::Flat => "the points within the quantile have no scatter",
        }
    }
}

/// The smallest ellipsoid around the points kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an enclosure: an object with ellipsoid and certificate")]
pub struct Enclosure {
    /// It holds every row but those left out.
    pub ellipsoid: Ellipsoid,
    /// Why no smaller one does.
    pub certificate: EllipsoidCertificate,
}

/// The proved facts about a robust ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RobustVerdict {
    /// The objective of the method, of the points kept, as found here. By `mcd` no C-step lowers it; that no other points
    /// have less is not proved.
    pub objective: f64,
    /// By `mve` and `trim`, what was proved of the ellipsoid around the points kept.
    pub enclosure: Option<EllipsoidVerdict>,
    /// h, how many points were asked for. By `mcd` and `mve` at least ⌊(n + d + 1)/2⌋, or n.
    pub wanted: u64,
    /// The number of points that are kept: h, and by `mve` and `trim` those that lie on the border besides.
    pub kept: u64,
    /// Points on the hull; all of them where there is none.
    pub on_hull: u64,
    /// By how much a point that is no outlier lies beyond the border, or an outlier within, in units of the
    /// border: what evaluating |F(x − c)| in `f64` may be off by. 0 where the flags are exactly the points outside.
    pub flag_excess: f64,
    /// The tolerance of center, scatter, and the border of the points weighed out, in units of the border: 1e-9, more
    /// where rounding the coordinates leaves the points few digits.
    pub slack: f64,
    /// True if center and scatter are those of the points not weighed out, rather than of the points kept.
    pub reweighted: bool,
    /// r, the dimension of the ellipsoid.
    pub rank: usize,
}

impl Answer for RobustEllipsoid {
    type Certificate = RobustCertificate;
    type Verdict = RobustVerdict;
    const KIND: &'static str = "robust-ellipsoid";

    fn check(
        &self,
        certificate: &RobustCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<RobustVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
