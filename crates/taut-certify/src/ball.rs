//! The minimum enclosing ball of points, of balls or of ellipsoids, and its certificate.

pub(crate) mod check;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError, Items, Verdict};

/// A ball in ℝᵈ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a ball: an object with center and radius")]
pub struct Ball {
    /// The d coordinates of the center.
    pub center: Vec<f64>,
    /// The vector to add to `center`, coordinate by coordinate, for the exact center; empty means nothing.
    ///
    /// Given when the points lie so far from the origin that rounding the center to one `f64` would cost more than
    /// 1e-15 of the radius. It is what that rounding leaves over: adding it to `center` in `f64` changes nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub center_tail: Vec<f64>,
    /// The radius.
    pub radius: f64,
}

/// Convex multipliers λ over few items: the proof that no much smaller ball exists.
///
/// For points, c = Σ λᵢpᵢ and r² = Σ λᵢ|pᵢ − c|² ≤ R*², for any λ ≥ 0 with Σ λᵢ = 1. For balls with radii rᵢ and
/// r̄ = Σ λᵢrᵢ, c = Σ λᵢcᵢ and r = r̄ + √(Σ λᵢ(|cᵢ − c|² − (rᵢ − r̄)²)) ≤ R*. For ellipsoids the pᵢ are points of theirs,
/// known by their `directions`.
///
/// With u = 2⁻⁵³, the checker grants |Σ λᵢ − 1| ≤ 2(k + 2)u for k multipliers, and takes λᵢ/Σ λᵢ in their place. The
/// center of the ball is Σ λᵢpᵢ/Σ λᵢ, each coordinate to 4u(|cⱼ| + R), with a tail to 4uR + 8u²|cⱼ|; of a ball around
/// ellipsoids this is not asked, as their points are rounded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of a ball: an object with items, support and multipliers"
)]
pub struct BallCertificate {
    /// Points, balls or ellipsoids.
    pub items: Items,
    /// Row numbers of the items with λᵢ > 0, from 0, ascending. Ellipsoids may occur several times in a row, as they can
    /// touch at several points.
    pub support: Vec<u64>,
    /// λᵢ, in the order of `support`.
    pub multipliers: Vec<f64>,
    /// For ellipsoids, in the order of `support`: d numbers a that say at which point the ellipsoid touches.
    ///
    /// It is the point that lies farthest in the direction a, p = m + Sa/√(aᵀSa), or m where Sa = 0: so it belongs to the
    /// ellipsoid whatever a is. What stands for S where rounding has made it indefinite, is said at
    /// [`EllipsoidCertificate::directions`](crate::EllipsoidCertificate::directions). Empty for points and balls.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub directions: Vec<Vec<f64>>,
    /// The gap claimed: radius ≤ (1 + gap)·r. Accepted when the gap found is at most gap·(1 + 1e-9) + 4e-16.
    pub gap: f64,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

impl Answer for Ball {
    type Certificate = BallCertificate;
    type Verdict = Verdict;
    const KIND: &'static str = "ball";

    fn check(
        &self,
        certificate: &BallCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Verdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
