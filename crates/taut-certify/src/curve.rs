//! Curves through points of the plane, and the certificate of what is known about them.

mod check;
mod doubt;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError};

pub use check::evidence::{CurveEvidence, curve_evidence};
pub use check::tour::{tour_bound, tour_length};
pub use doubt::CurveDoubt;
pub use violation::CurveViolation;

/// Curves through a point set of the plane: polylines that meet neither themselves nor one another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a curve: an object with curves and noise")]
pub struct Curve {
    /// The connected curves, each a polyline.
    pub curves: Vec<CurveComponent>,
    /// Half the width of the band around the curve that noise fills, as estimated; 0 where vertices are points of the input.
    pub noise: f64,
    /// The rows that no curve accounts for, ascending; in JSON also where there are none.
    #[serde(default)]
    pub outliers: Vec<u64>,
    /// On request, for each row its place on the curves; of outliers the place next to them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub places: Vec<Place>,
}

/// One connected curve.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "one curve: an object with vertices and closed")]
pub struct CurveComponent {
    /// The vertices in order.
    pub vertices: Vec<[f64; 2]>,
    /// True if an edge leads from the last vertex back to the first.
    pub closed: bool,
    /// Where vertices are points of the input, the row of each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rows: Vec<u64>,
}

/// Where on the curves a row lies: [curve, position] in JSON, the position k + t for the share t of the edge after vertex k.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Place(pub u32, pub f64);

/// The claims about a curve.
///
/// # What `certified` means
/// The rows that are not outliers sample the answer itself so densely, and lie so near to it, beside its own features, that a
/// closed smooth curve that they sample as well is homeomorphic to the answer and passes by them in the same order. The features are
/// measured by φ, at each vertex the radius of the smallest ball that touches the curve there and meets it elsewhere, on either
/// side, made 1-Lipschitz along the curve; it is at least the local feature size, the distance to the medial axis. Where vertices
/// are rows, larger balls than nine times the gaps beside the vertex are not looked for, and no ε below 1/16 is told. For vertices
/// that are rows this is the reasoning behind the theorem on NN-Crust (Dey and Kumar 1999): closed smooth curves with the same
/// sample, at ε ≤ 1/3 for each, have the same polygon. For noise there is no such theorem; the thresholds are
/// choices, tried on known curves.
///
/// It is evidence, not proof, for points cannot tell of what was not sampled. What deceives it: a curve with features smaller than the gaps
/// between its samples; a curve open by less than gaps vary, by less than about ln n + 8 of n gaps, or three times the usual one where
/// samples are evenly spaced; two strands nearer to each other than the noise is wide, with samples all over the room between, or so few
/// that chance could leave it as empty; a curve of samples as sparse as the outliers among which it lies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of a curve: an object with band, sampling_ratio, noise_ratio, certified and points_hash"
)]
pub struct CurveCertificate {
    /// No row but the outliers is farther than this from the curve; 0 where vertices are rows, as each row then is a vertex.
    pub band: f64,
    /// ε: over all gaps between places of rows that follow each other along a curve, the largest of half the gap over φ.
    /// [`f64::MAX`] where it is not known; the solver does not tell it of curves that are not certified. Where vertices are rows, 1/16 says that it may be less.
    pub sampling_ratio: f64,
    /// Over all rows but the outliers, the largest of the distance from the curve over φ next to it. [`f64::MAX`] where it is not known.
    pub noise_ratio: f64,
    /// True if the sampling is dense enough, beside the features of the curve itself, to call it homeomorphic to the one that was
    /// sampled.
    pub certified: bool,
    /// Of a tour, what proves how short it can be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tour: Option<TourBound>,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// The proof that no tour through the points is shorter than a bound.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the bound of a tour: an object with potentials and lower"
)]
pub struct TourBound {
    /// A number for each distinct point, in the order of the tour.
    pub potentials: Vec<f64>,
    /// The bound claimed: no tour is shorter. Accepted when at most 1e-9 of it above what the potentials prove, as sums in
    /// another order are; the gap of the verdict is that of the lesser.
    pub lower: f64,
}

/// The proved facts about a curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CurveVerdict {
    /// Rows there are.
    pub rows: u64,
    /// Rows that were left out as outliers: band and evidence say nothing about them.
    pub outliers: u64,
    /// The largest distance of a row that is no outlier from the curve, rounded up.
    pub band: f64,
    /// True if no two edges meet but neighbors at their vertex. Of tours alone it may be false; other answers are refused then.
    pub is_simple: bool,
    /// ε as the checker finds it; infinite where it is not known.
    pub sampling_ratio: f64,
    /// The noise ratio as the checker finds it; infinite where it is not known.
    pub noise_ratio: f64,
    /// True if the evidence for a homeomorphism was found, claimed or not.
    pub certified: bool,
    /// Where it was not, the first reason.
    pub doubt: Option<CurveDoubt>,
    /// Of a tour with a bound, length / lower bound − 1, rounded up.
    pub tour_gap: Option<f64>,
}

impl Answer for Curve {
    type Certificate = CurveCertificate;
    type Verdict = CurveVerdict;
    const KIND: &'static str = "curve";

    fn check(
        &self,
        certificate: &CurveCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<CurveVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
