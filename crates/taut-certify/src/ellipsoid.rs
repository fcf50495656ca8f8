//! The minimum volume enclosing ellipsoid of points, of balls or of ellipsoids, and its certificate.

pub(crate) mod check;
mod plane;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

pub use self::plane::{EllipseSupport, ellipse_support};
use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError, Items, Violation};

/// An ellipsoid {x : |F(x − c)| ≤ 1} in ℝᵈ, or in an affine subspace of dimension r < d.
///
/// ```
/// use taut_certify::{Ellipsoid, EllipsoidCertificate, Items, Solution, Trace};
/// use taut_points::{Monitor, Points, hash_points};
///
/// // The corners of a rectangle, of sides 4 and 2; each has its part in the proof.
/// let points = Points::new(&[-2.0, -1.0, 2.0, -1.0, -2.0, 1.0, 2.0, 1.0], 2)?;
/// let (long, short) = (8f64.sqrt(), 2f64.sqrt());
/// let by_hand = Solution {
///     answer: Ellipsoid {
///         center: vec![0.0, 0.0],
///         center_tail: vec![],
///         matrix: vec![vec![0.125, 0.0], vec![0.0, 0.5]],
///         factor: vec![vec![1.0 / long, 0.0], vec![0.0, 1.0 / short]],
///         hull: None,
///         log_volume: (4.0 * std::f64::consts::PI).ln(),
///     },
///     certificate: EllipsoidCertificate {
///         items: Items::Points,
///         support: vec![0, 1, 2, 3],
///         multipliers: vec![0.25; 4],
///         directions: vec![],
///         left_out: vec![],
///         gap: 1e-12,
///         points_hash: hash_points(&points, &Monitor::silent())?,
///     },
///     trace: Trace::default(),
/// };
/// assert!(by_hand.check(&points)?.gap < 1e-14);
/// assert_eq!(by_hand.answer.norm(&[0.0, 0.5 * short]), 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an ellipsoid: an object with center, matrix, factor and log_volume"
)]
pub struct Ellipsoid {
    /// The d coordinates of the center c.
    pub center: Vec<f64>,
    /// The vector to add to `center`, coordinate by coordinate, for the exact center; empty means nothing.
    ///
    /// Given when the points lie so far from the origin that rounding the center to one `f64` would cost more than
    /// rounding the rest. It is what that rounding leaves over: adding it to `center` in `f64` changes nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub center_tail: Vec<f64>,
    /// Q = FᵀF, d rows of d numbers, symmetric to the bit: (x − c)ᵀQ(x − c) ≤ 1. Its rank is r.
    ///
    /// It is `factor` multiplied out and rounded: where the axes differ by many orders of magnitude, `factor` tells
    /// inside from outside more sharply. A point on the border may evaluate to more than 1 with Q, by up to
    /// [`EllipsoidVerdict::matrix_excess`]: rounding entries that differ by the square of the ratio of the axes costs
    /// about that square times 2⁻⁵³ at worst, more than a gap of 1e-12 leaves room to scale away from a ratio of 100 on.
    /// Who tests points with Q allows for it; who needs all of them inside takes F.
    pub matrix: Vec<Vec<f64>>,
    /// F, r rows of d numbers: x is inside if and only if |F(x − c)| ≤ 1, where x − c is formed first.
    ///
    /// Any factor will do. One whose zeros make it triangular is checked in half the time.
    pub factor: Vec<Vec<f64>>,
    /// The affine subspace in which a rank-deficient set lies; absent when r = d.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hull: Option<Hull>,
    /// The natural logarithm of the volume, of dimension r; 0 for a single point.
    pub log_volume: f64,
}

/// The affine subspace {c + Bᵀz : z ∈ ℝʳ} in which a rank-deficient set lies, but for rounding.
///
/// The claim of the answer is then about the projections of the points to it: no ellipsoid of dimension r that encloses
/// them has less volume. The checker takes a set for flat when `distance` is at most 1e-10 of its extent (1e-6 for
/// ellipsoids, whose shape matrices know half as many digits of a short axis, 1e-3·√d in single precision), or what rounding the coordinates explains:
/// 128√d·2⁻⁵³ times the root of the sum of the squares of maxᵢ |xᵢⱼ|·|(I − BᵀB)eⱼ| over the coordinates j.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a hull: an object with basis and distance")]
pub struct Hull {
    /// B, r orthonormal rows of d numbers that span the rows of `factor`; none when all points are one.
    pub basis: Vec<Vec<f64>>,
    /// No point lies farther than this from the subspace, |(I − BᵀB)(x − c)| ≤ distance, but for rounding: how far they are
    /// with that is [`EllipsoidVerdict::off_hull`].
    pub distance: f64,
}

impl Ellipsoid {
    /// d, the dimension of the space.
    pub fn dim(&self) -> usize {
        self.center.len()
    }

    /// r, the dimension of the ellipsoid itself.
    pub fn rank(&self) -> usize {
        self.factor.len()
    }

    /// |F(x − c)| in plain `f64`: at most 1 inside, but for rounding. The distance from the hull is not looked at.
    ///
    /// Costs O(rd). Numbers of `point` beyond d are not looked at.
    pub fn norm(&self, point: &[f64]) -> f64 {
        let tails = self.center_tail.iter().copied().chain(std::iter::repeat(0.0));
        let offsets: Vec<f64> = point
            .iter()
            .zip(&self.center)
            .zip(tails)
            .map(|((x, c), tail)| (x - c) - tail)
            .collect();
        let images =
            self.factor.iter().map(|row| row.iter().zip(&offsets).map(|(f, x)| f * x).sum::<f64>());
        images.map(|y| y * y).sum::<f64>().sqrt()
    }
}

/// Convex multipliers u over few items: the proof that no ellipsoid of much smaller volume exists.
///
/// With p̄ = Σ uᵢpᵢ and Σ = Σ uᵢ(pᵢ − p̄)(pᵢ − p̄)ᵀ, every ellipsoid of ℝʳ that encloses the points pᵢ has at least the
/// volume of the trial ellipsoid {x : (x − p̄)ᵀΣ⁻¹(x − p̄) ≤ r}, whose logarithm is log κᵣ + (r/2) log r + ½ log det Σ
/// with κᵣ the volume of the unit ball. Any u ≥ 0 with Σ uᵢ = 1 will do; good ones make the bound tight.
///
/// The checker grants |Σ uᵢ − 1| ≤ 2(k + 2)·2⁻⁵³ for k multipliers, and takes uᵢ/Σ uᵢ in their place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of an ellipsoid: an object with items, support, multipliers, gap and points_hash"
)]
pub struct EllipsoidCertificate {
    /// Points, balls or ellipsoids.
    pub items: Items,
    /// Row numbers of the items with uᵢ > 0, from 0, ascending. Balls and ellipsoids may occur several times in a row,
    /// as they can touch at several points.
    pub support: Vec<u64>,
    /// uᵢ, in the order of `support`.
    pub multipliers: Vec<f64>,
    /// For balls and ellipsoids, in the order of `support`: d numbers a that say at which point the item touches.
    ///
    /// It is the point of the item that lies farthest in the direction a, p = m + Sa/√(aᵀSa), or m where Sa = 0. So it
    /// belongs to the item whatever a is, and a bound for these points is a bound for the items. The length of a does
    /// not matter. Where an item touches the answer at p, a = Q(p − c) is its direction. Empty for points. For the S of a
    /// row that rounding has made indefinite see [`Items::Ellipsoids`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub directions: Vec<Vec<f64>>,
    /// Row numbers of the items that the ellipsoid leaves out, ascending: the rest is claimed to be enclosed tightly.
    /// Each of them reaches outside. Empty but within robust fits: an ellipsoid by itself that leaves rows out is refused.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<u64>,
    /// The gap claimed: `log_volume` ≤ optimum + gap, the optimum being that of the items not left out. Accepted when
    /// the gap found is at most gap·(1 + 1e-9) + 2e-15·r.
    pub gap: f64,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// The proved facts about an ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EllipsoidVerdict {
    /// No enclosing ellipsoid has a log-volume below this.
    pub lower: f64,
    /// Log-volume of the answer, enlarged about its center by 1 + `excess` so that it encloses every item.
    pub upper: f64,
    /// `upper` − `lower`, rounded up, as it was before what rounding the log-volume itself costs was added to both.
    pub gap: f64,
    /// By how much |F(x − c)| exceeds 1 at worst, rounded up; 0 when every item is inside without any tolerance.
    pub excess: f64,
    /// By how much (x − c)ᵀQ(x − c) can exceed 1 at worst, Q being `matrix` as it stands.
    pub matrix_excess: f64,
    /// No item is farther than this from the hull, rounded up: [`Hull::distance`] and what rounding adds to it; 0 where there
    /// is no hull.
    pub off_hull: f64,
    /// r, the dimension of the ellipsoid.
    pub rank: usize,
}

impl Answer for Ellipsoid {
    type Certificate = EllipsoidCertificate;
    type Verdict = EllipsoidVerdict;
    const KIND: &'static str = "ellipsoid";

    fn check(
        &self,
        certificate: &EllipsoidCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<EllipsoidVerdict, CheckError> {
        if let Some(&row) = certificate.left_out.first() {
            let problem = "but only the ellipsoid of a robust fit may leave points out";
            return Err(Violation::LeftOut { position: 0, row, problem }.into());
        }
        check::check(self, certificate, source, monitor, 1)
    }
}
