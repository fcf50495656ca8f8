//! What can be wrong with a curve.

/// Why a curve or its certificate is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveViolation {
    /// The points are not of the plane.
    #[error("the points have {dim} coordinates: curves are of the plane, which has 2")]
    Plane {
        /// Coordinates of a point.
        dim: usize,
    },
    /// A curve has too few vertices.
    #[error("curve {curve} has {found} vertices, expected at least {least}")]
    Vertices {
        /// Curve, from 0.
        curve: usize,
        /// Vertices it has.
        found: usize,
        /// Fewest it could have.
        least: usize,
    },
    /// Of some curves the vertices are rows, of others not.
    #[error("vertices of curve {curve} are rows, or those of another are: expected all or none")]
    Mixed {
        /// The first curve unlike curve 0.
        curve: usize,
    },
    /// A vertex is not the row it is said to be.
    #[error("vertex {vertex} of curve {curve} is said to be point {row}, {problem}")]
    Row {
        /// Curve, from 0.
        curve: usize,
        /// Vertex, from 0.
        vertex: usize,
        /// The row it is said to be.
        row: u64,
        /// What is wrong with that.
        problem: &'static str,
    },
    /// A vertex occurs twice.
    #[error("vertex {vertex} of curve {curve} is where vertex {other_vertex} of curve {other} is")]
    Repeated {
        /// Curve, from 0.
        curve: usize,
        /// Vertex, from 0.
        vertex: usize,
        /// The other curve, or the same.
        other: usize,
        /// The other vertex.
        other_vertex: usize,
    },
    /// Two edges meet that are no neighbors, or neighbors elsewhere than at their vertex.
    #[error("edge {edge} of curve {curve} meets edge {other_edge} of curve {other}")]
    Crossing {
        /// Curve, from 0.
        curve: usize,
        /// The edge after this vertex, from 0.
        edge: usize,
        /// The other curve, or the same.
        other: usize,
        /// The edge after this vertex.
        other_edge: usize,
    },
    /// A row is said to be an outlier, but cannot be.
    #[error("entry {position} of the list of outliers names point {row}, {problem}")]
    Outlier {
        /// Position in the list, from 0.
        position: usize,
        /// The row.
        row: u64,
        /// What is wrong with that.
        problem: &'static str,
    },
    /// Vertices are rows, but a row is neither a vertex nor an outlier.
    #[error("point {row} is neither a vertex nor an outlier")]
    NoVertex {
        /// The first such row, from 0.
        row: u64,
    },
    /// A row lies outside the band.
    #[error("point {row} lies {distance:?} off the curve, outside the band of {band:?}")]
    OutsideBand {
        /// The first such row, from 0.
        row: u64,
        /// Its distance, rounded up.
        distance: f64,
        /// The band claimed.
        band: f64,
    },
    /// The place of a row is not on the curves.
    #[error(
        "point {row} is said to have its place at {position:?} on curve {curve}, where there is none"
    )]
    NoPlace {
        /// The first such row, from 0.
        row: u64,
        /// The curve named.
        curve: u32,
        /// The position named.
        position: f64,
    },
    /// The place of a row is not the next one.
    #[error(
        "the place of point {row} is {distance:?} away, but the curve is as near as {nearest:?}"
    )]
    FarPlace {
        /// The first such row, from 0.
        row: u64,
        /// Distance of the place named.
        distance: f64,
        /// Distance of the curve.
        nearest: f64,
    },
    /// A figure is claimed to be less than it is.
    #[error("the {figure} is {found:e}, the certificate claims {claimed:e}")]
    Figure {
        /// Which.
        figure: &'static str,
        /// What the certificate says.
        claimed: f64,
        /// What the checker finds.
        found: f64,
    },
    /// The curve is claimed to be certified, but is not.
    #[error("the curve is claimed to be certified, but it is not: {doubt}")]
    NotCertified {
        /// The first reason.
        doubt: super::CurveDoubt,
    },
    /// A bound of a tour is not of a tour.
    #[error("a tour is one curve through all points without outliers, {problem}")]
    NoTour {
        /// What is wrong with that.
        problem: &'static str,
    },
    /// The length of a tour cannot be bounded by the potentials as claimed.
    #[error(
        "the potentials prove that no tour is shorter than {proved:?}, the certificate claims {claimed:?}"
    )]
    TourBound {
        /// What the certificate says.
        claimed: f64,
        /// What the potentials prove.
        proved: f64,
    },
}
