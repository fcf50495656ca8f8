//! k equal balls around all items, and the certificate that no k much smaller ones would do.

pub(crate) mod check;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError, Items};

pub use violation::CentersViolation;

/// Where centers may be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Placement {
    /// Anywhere in the space.
    #[default]
    Free,
    /// At points of the input only.
    Rows,
}

/// k centers, from one of which each item is at most `radius` away.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "centers: an object with centers, radius and lower_bound")]
pub struct Centers {
    /// At most k centers of d coordinates each. Fewer than k where fewer are as good.
    pub centers: Vec<Vec<f64>>,
    /// For centers among the points, the row of each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rows: Vec<u64>,
    /// The largest distance of an item to the center next to it, as evaluated in `f64` or a little more: |p − c|, |m − c| + r for a ball,
    /// w·|p − c| for a point of weight w, and the largest of these for a group of rows; of an ellipsoid, how far its farthest point is.
    pub radius: f64,
    /// No k centers have a smaller radius.
    pub lower_bound: f64,
    /// The rows that are left out, ascending; they count for nothing. A group is left out with all its rows.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outliers: Vec<u64>,
    /// On request, for each row the number of the center next to it, the first of several; also for rows that are left out.
    ///
    /// The checker asks that no other center is nearer by more than what a sum in `f64` may be off by: which of centers that
    /// are equally near but for rounding is the first, depends on the order of the sum. All rows of a group have the center from which
    /// the group reaches least far. For ellipsoids 1e-9 of how far they reach is granted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assignment: Vec<u32>,
}

/// The way in which the lower bound is to be confirmed: that no k balls of a radius less than it hold all of a core-set except z of
/// its items.
///
/// Rows of one group are to be in one ball. Those of them that are in the core-set stand for the group: a ball that does not
/// hold these does not hold it. An ellipsoid is the group of its points, of which the core-set has some.
///
/// A ball of a radius less than ρ holds items just when its center is less than ρᵢ from each of them, with ρᵢ = ρ for points,
/// ρ − r for balls and ρ/w for points of weight w. That no such ball holds some items is shown by λ ≥ 0 with
/// Σλᵢ = 1 and p̄ = Σλᵢpᵢ, when Σλᵢ(|pᵢ − p̄|² − ρᵢ²) ≥ 0; the checker finds λ itself, and refutes with a bound on all that it
/// rounds, some 1e-14·d/8 of ρ: claim the radius at which all cases are refuted, less 1e-12 of it. For centers among the
/// rows, and for two items apart, it decides exactly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "by", try_from = "LowerBoundFields")]
pub enum LowerBound {
    /// No two items of the core-set fit in one ball, and there are more than k and the outliers together. O(|X|²d). With groups, no
    /// two groups do, and there are so many groups.
    #[serde(rename = "apart")]
    Separated,
    /// By the branches of a search, in the order in which they were taken (preorder), over at most 16384 items. For
    /// free centers the checker compares all pairs of items first. It replays the branches in time linear in their number.
    Branches {
        /// At each node that is not refuted at once, which item of the core-set is given to the balls in turn: to each that has
        /// items already, in the order in which they got their first, then to the next empty one, if there is one, and
        /// then to the outliers, if there may be more. A child is refuted at once when no ball of a radius less than
        /// the bound holds the items of the one that got the item. Where an item above it is of the same group, it is given
        /// to the ball of that item alone; where that is among the outliers, so is this one, and it has no node.
        items: Vec<u32>,
    },
    /// Branches as in [`Self::Branches`], of points in the plane with free centers and without groups, some of whose nodes are refuted
    /// by the items left out above them.
    ///
    /// Balls that hold all but z items may all have one radius, as near to the bound as wanted, and an item is among the outliers only
    /// where none of them holds it. So a node is refuted, too, when each ball of this radius that holds the items of some cluster holds an
    /// item that is among the outliers there. The checker grants 1e-6 in the angles by which it finds such balls.
    Avoiding {
        /// As in [`Self::Branches`].
        items: Vec<u32>,
        /// The nodes that are refuted in this way, in preorder: none of them has a branch.
        held_out: Vec<HeldOut>,
    },
    /// By nogoods over at most 2048 items: points in the plane with free centers, without groups and outliers.
    ///
    /// A nogood is a set of items that no e balls of a radius less than the bound hold. Each is shown by those before it, and the last one
    /// is a set that no k balls hold. The checker grants 1e-7 in the angles by which it finds balls. It takes time linear in the
    /// number of nogoods, and for each as much as the square of its items near the one that is branched on.
    ///
    /// *Source.* Recording of nogoods as in constraint satisfaction: Dechter, Artificial Intelligence 41, 1990.
    Nogoods {
        /// At most 2³⁰ / |X| of them.
        nogoods: Vec<Nogood>,
    },
}

/// Items that are not held by so many balls, as [`LowerBound::Nogoods`] lists them.
///
/// Without `misses`: the items are apart two by two, so e balls do not hold e + 1 of them. One item alone is not held by no ball.
/// With `misses` there is one item: whatever the ball that holds it, it holds nothing of at least one of these nogoods, so that one would have to be
/// held by the other balls. With e balls, none of these is held by e − 1. The nogood is the item with all that are in these.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Nogood {
    /// Places in the core-set.
    pub items: Vec<u32>,
    /// The numbers of nogoods before this one, from 0; at most 63.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub misses: Vec<u32>,
}

/// A node of [`LowerBound::Avoiding`] in which each ball that holds a cluster holds an item that is among the outliers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeldOut {
    /// The number of branches before the node in preorder.
    pub at: u64,
    /// The cluster, by the order in which they got their first item, from 0.
    pub cluster: u32,
}

/// A [`LowerBound`] as it is read: of a variant without braces, serde would not refuse unknown fields. Files of earlier
/// versions may also say `search`.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case", tag = "by", deny_unknown_fields)]
enum LowerBoundFields {
    #[serde(rename = "apart")]
    Separated {},
    Search {},
    Branches {
        items: Vec<u32>,
    },
    Avoiding {
        items: Vec<u32>,
        held_out: Vec<HeldOut>,
    },
    Nogoods {
        nogoods: Vec<Nogood>,
    },
}

impl TryFrom<LowerBoundFields> for LowerBound {
    type Error = &'static str;

    fn try_from(written: LowerBoundFields) -> Result<Self, Self::Error> {
        match written {
            LowerBoundFields::Separated {} => Ok(LowerBound::Separated),
            LowerBoundFields::Branches { items } => Ok(LowerBound::Branches { items }),
            LowerBoundFields::Avoiding { items, held_out } => {
                Ok(LowerBound::Avoiding { items, held_out })
            }
            LowerBoundFields::Nogoods { nogoods } => Ok(LowerBound::Nogoods { nogoods }),
            LowerBoundFields::Search {} => Err(
                "the proof of these centers is \"search\", which an earlier version of taut wrote and \
                 which is no longer verified: solve again to get a proof that lists its branches",
            ),
        }
    }
}

/// The question, and a few items that prove the lower bound.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of centers: an object with items, k, core_set and proof"
)]
pub struct CentersCertificate {
    /// Points, balls or ellipsoids.
    pub items: Items,
    /// True if the last column holds the weights w > 0 of points.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub weights: bool,
    /// The column, from 0, whose value says to which group a row belongs: rows of the same value are to lie in one ball. It is
    /// none of the columns that say where a row lies. None where each row stands for itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<u64>,
    /// Where centers may be.
    pub placement: Placement,
    /// Most centers.
    pub k: u64,
    /// Most rows that may be left out; most groups, where rows are in groups.
    #[serde(default)]
    pub outliers: u64,
    /// The gap claimed: radius ≤ (1 + gap)·lower_bound. Accepted when the gap found is at most gap·(1 + 1e-9) + 4e-16; where
    /// the lower bound is 0 and the radius is not, only [`f64::MAX`] is.
    pub gap: f64,
    /// Row numbers, none twice, in the order that `proof` speaks of. Of an ellipsoid there may be several points.
    pub core_set: Vec<u64>,
    /// For ellipsoids, in the order of `core_set`: d numbers a that say which point of the ellipsoid is meant.
    ///
    /// It is the point that lies farthest in the direction a, as at [`BallCertificate::directions`](crate::BallCertificate::directions):
    /// so it belongs to the ellipsoid whatever a is. Empty for points and balls.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub directions: Vec<Vec<f64>>,
    /// The way in which these rows prove the lower bound. Where that is 0 nothing has to be proved.
    pub proof: LowerBound,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// The proved facts about centers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CentersVerdict {
    /// No k centers have a smaller radius.
    pub lower: f64,
    /// The radius of the answer, within which every item that counts was found.
    pub upper: f64,
    /// `upper / lower − 1`, rounded up; 0 where both are equal, infinite where `lower` alone is 0.
    pub gap: f64,
    /// Branches that were replayed to prove the lower bound; 0 where it needs none.
    #[serde(rename = "nodes")]
    pub branches: u64,
}

impl Answer for Centers {
    type Certificate = CentersCertificate;
    type Verdict = CentersVerdict;
    const KIND: &'static str = "centers";

    fn check(
        &self,
        certificate: &CentersCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<CentersVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
