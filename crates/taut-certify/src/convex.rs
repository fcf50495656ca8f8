//! A large convex polygon in a polygon, and its certificate.

mod check;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource};

use crate::{Answer, CheckError, EllipseCertificate, InscribedEllipse};

pub use violation::ConvexViolation;

/// A convex polygon in a polygon.
///
/// The rows of the source are the rings of the outer polygon, as for [`InscribedCircle`](crate::InscribedCircle).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a convex polygon: an object with vertices and area")]
pub struct ConvexPolygon {
    /// The corners, counterclockwise; no three of them are on a line.
    pub vertices: Vec<[f64; 2]>,
    /// The area, up to rounding.
    pub area: f64,
}

/// The proof that a convex polygon is inside, and that no other is much larger.
///
/// *Bound.* Every convex body of area A contains an ellipse of area at least π/(3√3)·A, so that the bound of ellipses times 3√3/π
/// is one of convex polygons; the area of the convex hull of all vertices is another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of a convex polygon: an object with inside, ellipse, ellipse_certificate and gap"
)]
pub struct ConvexCertificate {
    /// A point inside the convex polygon.
    pub inside: [f64; 2],
    /// An ellipse in the outer polygon.
    pub ellipse: InscribedEllipse,
    /// The proof that no ellipse is much larger; it has the hash of the rows.
    pub ellipse_certificate: EllipseCertificate,
    /// The gap claimed: largest area ≤ (1 + gap)·area. Accepted when the gap found is at most gap·(1 + 1e-9) + 4e-15.
    pub gap: f64,
}

/// What was proved of a convex polygon.
///
/// A point is inside when the edges wind around it an odd number of times (even-odd rule), as for a circle in a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ConvexVerdict {
    /// The area of the answer, rounded down: it is convex and inside, and no edge enters it.
    pub lower: f64,
    /// No convex set inside has an area above this.
    pub upper: f64,
    /// `upper / lower − 1`, rounded up.
    pub gap: f64,
}

impl Answer for ConvexPolygon {
    type Certificate = ConvexCertificate;
    type Verdict = ConvexVerdict;
    const KIND: &'static str = "convex-polygon";

    fn check(
        &self,
        certificate: &ConvexCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<ConvexVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
