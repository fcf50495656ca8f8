//! The ellipsoid of largest volume inside a polytope, and its certificate.

mod check;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError};

/// An ellipsoid {c + Gz : |z| ≤ 1} inside a polytope.
///
/// The polytope is {x : aᵢᵀx ≤ bᵢ}, one half-space in each row of the source: the d coordinates of a, then b.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an inscribed ellipsoid: an object with center, axes and log_volume"
)]
pub struct InscribedEllipsoid {
    /// The d coordinates of the center c.
    pub center: Vec<f64>,
    /// G, d rows of d numbers.
    pub axes: Vec<Vec<f64>>,
    /// The natural logarithm of the volume: log |det G| and that of the unit ball.
    pub log_volume: f64,
}

/// Multipliers λ ≥ 0 over few half-spaces: the proof that no ellipsoid of much larger volume fits.
///
/// With ãᵢ = Gᵀaᵢ and sᵢ = bᵢ − aᵢᵀc: where Σ λᵢãᵢ = 0 and W = Σ λᵢãᵢãᵢᵀ/|ãᵢ|, every ellipsoid in the polytope has at most
/// the volume of the answer times (Σ λᵢsᵢ/d)ᵈ/det W. Any λ will do; good ones make it nearly 1.
///
/// A half-space is the same whatever its row is multiplied by. So that neither rows nor multipliers over- or underflow, λᵢ
/// is meant for row i divided by the power of two that brings the largest entry of aᵢ to [1, 2).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of an inscribed ellipsoid: an object with support, multipliers, gap and points_hash"
)]
pub struct InscribedCertificate {
    /// Row numbers of the half-spaces with λᵢ > 0, from 0, ascending.
    pub support: Vec<u64>,
    /// λᵢ, in the order of `support`.
    pub multipliers: Vec<f64>,
    /// The gap claimed: optimum ≤ `log_volume` + gap. Accepted when the gap found is at most gap·(1 + 1e-9) + 2e-15·d.
    pub gap: f64,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// The proved facts about an inscribed ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct InscribedVerdict {
    /// The log-volume of the answer, rounded down as found here: it lies in every half-space, so the optimum is no less.
    pub lower: f64,
    /// No ellipsoid in the polytope has a log-volume above this: that of the answer as found here, rounded up, and the gap.
    pub upper: f64,
    /// By how much the log-volume of an ellipsoid in the polytope can exceed that of the answer.
    pub gap: f64,
}

impl Answer for InscribedEllipsoid {
    type Certificate = InscribedCertificate;
    type Verdict = InscribedVerdict;
    const KIND: &'static str = "inscribed-ellipsoid";

    fn check(
        &self,
        certificate: &InscribedCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<InscribedVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
