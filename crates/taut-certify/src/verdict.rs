//! The verdicts and violations of checkers.

use serde::Serialize;
use taut_points::{PartsError, ReadError};

use crate::{
    BodiesViolation, CentersViolation, CircleViolation, ConvexViolation, CurveViolation,
    DopViolation, EllipseViolation, KernelBallViolation, MeshViolation, OrderViolation,
    OrientedRectangleViolation, PolygonViolation, RectangleViolation, SurfaceViolation,
    TriangleViolation,
};

/// The proved facts about an enclosing shape.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// No enclosing shape is smaller than this.
    pub lower: f64,
    /// The size of the answer, which was found to enclose every point.
    pub upper: f64,
    /// `upper / lower − 1`, rounded up, for the lower bound as it was before it was rounded down to one `f64`; 0 where
    /// both are 0.
    pub gap: f64,
}

/// Why an answer or its certificate is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Violation {
    /// The points are not those the certificate was made for.
    #[error("the points have hash {found}, the certificate speaks of {claimed}: the data changed")]
    Hash {
        /// Hash the certificate names.
        claimed: String,
        /// Hash of the points given.
        found: String,
    },
    /// The answer has another dimension than the points.
    #[error("the center has {}, but the points have dimension {expected}", Counted(*found, "number"))]
    Dimension {
        /// Coordinates of the center.
        found: usize,
        /// Dimension of the points.
        expected: usize,
    },
    /// A list of the answer or certificate has another length than it must.
    #[error("{what} has {}, expected {expected}", Counted(*found, "number"))]
    Length {
        /// The list in question.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A number of the answer or certificate is NaN, infinite or out of its range.
    #[error("{what} is {value:?}: expected {expected}")]
    Number {
        /// The number in question.
        what: String,
        /// Its value.
        value: f64,
        /// The values that would have been accepted.
        expected: &'static str,
    },
    /// A coordinate of the input is NaN or infinite.
    #[error("coordinate {column} of point {row} is {value:?}: all coordinates must be finite")]
    NonFinite {
        /// Point, from 0.
        row: u64,
        /// Coordinate, from 0.
        column: usize,
        /// Its value.
        value: f64,
    },
    /// A ball of the input has a negative radius.
    #[error("ball {row} has radius {value:?}: radii are the last column and must be at least 0")]
    NegativeRadius {
        /// Ball, from 0.
        row: u64,
        /// Its radius.
        value: f64,
    },
    /// The certificate speaks of balls, but the rows have no room for a center and a radius.
    #[error("a ball needs a center and a radius, but rows have {}", Counted(*columns, "column"))]
    NoRadius {
        /// Columns there are.
        columns: usize,
    },
    /// The certificate speaks of ellipsoids, but no dimension has rows of that many numbers.
    #[error(
        "ellipsoids in dimension d have rows of d(d + 3)/2 numbers, 2, 5, 9, 14, …, but rows have {columns}"
    )]
    NoShape {
        /// Columns there are.
        columns: usize,
    },
    /// An ellipsoid of the input has a shape matrix with a negative eigenvalue.
    #[error("the shape matrix of ellipsoid {row} is not positive semidefinite")]
    NegativeShape {
        /// Ellipsoid, from 0.
        row: u64,
    },
    /// The certificate names no point at all.
    #[error("the support is empty: a bound needs at least one point")]
    EmptySupport,
    /// The support names a point that does not exist, or one twice.
    #[error("support entry {position} names point {point}, {problem}")]
    Support {
        /// Position in the list, from 0.
        position: usize,
        /// The point it names.
        point: u64,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// A support was to be proved exactly, which is done in the plane alone.
    #[error("the support is proved exactly in the plane, but the points have dimension {dim}")]
    NoPlane {
        /// Dimension of the points.
        dim: usize,
    },
    /// No three to five of the support rows are the border of the smallest ellipse of all of them.
    #[error(
        "of the {rows} rows of the support no three to five determine an ellipse around all of them"
    )]
    NoBasis {
        /// Rows of the support.
        rows: usize,
    },
    /// A point lies outside the smallest ellipse of the support, by exact arithmetic.
    #[error("point {row} lies outside the smallest ellipse of the support")]
    OutsideSupport {
        /// Point, from 0.
        row: u64,
    },
    /// The list of rows left out names a row that does not exist, or one that it must not name.
    #[error("entry {position} of the list of points left out names point {row}, {problem}")]
    LeftOut {
        /// Position in the list, from 0.
        position: usize,
        /// The row it names.
        row: u64,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// A hull is given where the ellipsoid has the dimension of the space.
    #[error("a hull is given, but the factor has {rank} rows in dimension {dim}: nothing is flat")]
    NeedlessHull {
        /// Rows of the factor.
        rank: usize,
        /// Dimension of the space.
        dim: usize,
    },
    /// The multipliers are not convex.
    #[error("the multipliers sum to {sum:?}: expected 1")]
    MultiplierSum {
        /// Their sum.
        sum: f64,
    },
    /// The center is not the combination of the support that the multipliers say.
    #[error(
        "coordinate {column} of the center is {claimed:?}, but the multipliers give {found:?}, {difference:e} beside it"
    )]
    Center {
        /// Coordinate, from 0.
        column: usize,
        /// The value that the answer claims.
        claimed: f64,
        /// The value that the certificate gives.
        found: f64,
        /// found − claimed, with the tail of the center and before both were rounded to one `f64`.
        difference: f64,
    },
    /// A point lies outside the answer.
    #[error(
        "point {row} lies {distance:?} from the center, outside the radius {radius:?}, by {excess:e}"
    )]
    Outside {
        /// The first such point, from 0.
        row: u64,
        /// The distance that it reaches from the center.
        distance: f64,
        /// The claimed radius.
        radius: f64,
        /// distance − radius.
        excess: f64,
    },
    /// The gap proved is larger than the gap claimed.
    #[error("the multipliers prove a gap of {proved:e}, the certificate claims {claimed:e}")]
    Gap {
        /// The value that the certificate claims.
        claimed: f64,
        /// The result of the checker.
        proved: f64,
    },
    /// An item reaches outside the ellipsoid.
    #[error("point {row} reaches to |F(x − c)| = {norm:?}, outside the ellipsoid by {excess:e}")]
    OutsideEllipsoid {
        /// The first such row, from 0.
        row: u64,
        /// The distance that it reaches: 1 is the border.
        norm: f64,
        /// norm − 1.
        excess: f64,
    },
    /// An inscribed ellipsoid reaches out of a half-space.
    #[error("the ellipsoid reaches beyond half-space {row}, by {excess:e} in units of its normal")]
    OutsideHalfSpace {
        /// The first such row, from 0.
        row: u64,
        /// max aᵀx − b over the ellipsoid; at 0 and a little below, rounding leaves it open.
        excess: f64,
    },
    /// A row that is said to be left out lies inside.
    #[error("point {row} is said to be left out, but reaches only to |F(x − c)| = {norm:?}")]
    NotOutside {
        /// The first such row, from 0.
        row: u64,
        /// The distance that it reaches: 1 is the border.
        norm: f64,
    },
    /// The matrix of an ellipsoid is not its factor multiplied out, or not symmetric.
    #[error("entry ({row}, {column}) of the matrix is {claimed:?}, but the factor gives {found:?}")]
    Matrix {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// The value that the answer claims.
        claimed: f64,
        /// The value that the factor gives.
        found: f64,
    },
    /// The log-volume is not that of the factor.
    #[error("the log-volume is {claimed:?}, but the factor gives {found:?}")]
    LogVolume {
        /// The value that the answer claims.
        claimed: f64,
        /// The value that the factor gives, infinite when it is singular.
        found: f64,
    },
    /// The basis of the hull is not orthonormal.
    #[error("rows {first} and {second} of the basis of the hull are off orthonormal by {off:e}")]
    Basis {
        /// One row, from 0.
        first: usize,
        /// The other, or the same.
        second: usize,
        /// Their product, less 1 when they are the same.
        off: f64,
    },
    /// A row of the factor does not lie in the hull.
    #[error("row {row} of the factor lies off the hull by {off:e} of its length")]
    Span {
        /// Row, from 0.
        row: usize,
        /// The relative deviation.
        off: f64,
    },
    /// An item lies farther from the hull than stated.
    #[error("point {row} lies {distance:e} off the hull, but the distance stated is {claimed:e}")]
    OffHull {
        /// The first such row, from 0.
        row: u64,
        /// The deviation.
        distance: f64,
        /// The distance stated.
        claimed: f64,
    },
    /// The set is not as flat as a hull says.
    #[error("points {distance:e} off a hull are not flat: rounding explains {allowed:e}")]
    NotFlat {
        /// The distance stated.
        distance: f64,
        /// The values that would have been accepted.
        allowed: f64,
    },
    /// The gap proved for a log-volume is larger than the gap claimed.
    #[error(
        "the multipliers prove a gap of {proved:e} in log-volume, the certificate claims {claimed:e}"
    )]
    LogGap {
        /// The value that the certificate claims.
        claimed: f64,
        /// The result of the checker.
        proved: f64,
    },
    /// The ellipsoid around the points that a robust fit keeps is said to be around something else.
    #[error(
        "the ellipsoid around the points kept is said to enclose balls or ellipsoids: expected points"
    )]
    NoPoints,
    /// More points than were asked for lie strictly inside the ellipsoid around the points kept: a C-step leads on.
    #[error(
        "{inside} points lie strictly inside the ellipsoid around the points kept, but it is to be the smallest around {kept}"
    )]
    Spare {
        /// Points that lie strictly inside.
        inside: u64,
        /// h, how many points were asked for.
        kept: u64,
    },
    /// The ellipsoid around the points kept is proved minimal only within so wide a gap that a C-step may lead on.
    #[error(
        "the ellipsoid around the points kept is proved the smallest only within a gap of {gap:e}, too loose to tell that no \
         C-step leads on: expected at most {most}"
    )]
    LooseEnclosure {
        /// The gap proved.
        gap: f64,
        /// The largest gap from which the points inside can be counted.
        most: f64,
    },
    /// A robust estimate says that nothing was weighed out for a reason that does not hold.
    #[error("points are said not to be weighed again because {reason}, which is not so")]
    Reweighting {
        /// The reason given.
        reason: &'static str,
    },
    /// The multipliers ask for more than the answer has, though it encloses all items as their rows stand.
    #[error(
        "the multipliers prove a gap of {gap:e}, and none can be negative: some shape matrix is too far from positive semidefinite for this answer"
    )]
    NegativeGap {
        /// The result of the checker.
        gap: f64,
    },
    /// A number of a robust estimate is not what the points give.
    #[error("{what} is {claimed:?}, but the points give {found:?}")]
    Estimate {
        /// The number in question.
        what: String,
        /// The value that the answer or certificate claims.
        claimed: f64,
        /// The value found.
        found: f64,
    },
    /// A list of rows of a robust estimate names a row that does not belong there, or lacks one that does.
    #[error("the list of points {list} {problem} point {row}, at {distance:?} times its border")]
    Listed {
        /// The list.
        list: &'static str,
        /// "names" or "lacks".
        problem: &'static str,
        /// The first such row, from 0.
        row: u64,
        /// Its distance in units of the border that the list is about, infinite for a point off the hull.
        distance: f64,
    },
    /// The points kept are not the nearest in their own metric: a C-step leads on from them.
    #[error(
        "point {kept} is kept at a squared distance of {distance:?}, but point {other} is left out at {nearer:?}"
    )]
    NotNearest {
        /// The farthest row kept, from 0.
        kept: u64,
        /// Its squared distance in the metric of the rows kept.
        distance: f64,
        /// The nearest row left out.
        other: u64,
        /// Its squared distance.
        nearer: f64,
    },
    /// Something is wrong with inscribed bodies.
    #[error(transparent)]
    Bodies(#[from] BodiesViolation),
    /// Something is wrong with centers.
    #[error(transparent)]
    Centers(#[from] CentersViolation),
    /// Something is wrong with an inscribed circle.
    #[error(transparent)]
    Circle(#[from] CircleViolation),
    /// Something is wrong with a convex polygon.
    #[error(transparent)]
    Convex(#[from] ConvexViolation),
    /// Something is wrong with a bounding dop.
    #[error(transparent)]
    Dop(#[from] DopViolation),
    /// Something is wrong with an inscribed ellipse.
    #[error(transparent)]
    Ellipse(#[from] EllipseViolation),
    /// Something is wrong with a ball of a kernel.
    #[error(transparent)]
    KernelBall(#[from] KernelBallViolation),
    /// Something is wrong with an inscribed oriented rectangle.
    #[error(transparent)]
    OrientedRectangle(#[from] OrientedRectangleViolation),
    /// Something is wrong with an inscribed rectangle.
    #[error(transparent)]
    Rectangle(#[from] RectangleViolation),
    /// Something is wrong with an inscribed triangle.
    #[error(transparent)]
    Triangle(#[from] TriangleViolation),
    /// The points are no polygon.
    #[error(transparent)]
    Polygon(#[from] PolygonViolation),
    /// Something is wrong with a curve.
    #[error(transparent)]
    Curve(#[from] CurveViolation),
    /// Something is wrong with a surface.
    #[error(transparent)]
    Surface(#[from] SurfaceViolation),
    /// An order is wrong.
    #[error(transparent)]
    Order(#[from] OrderViolation),
    /// Something is wrong with a triangulation.
    #[error(transparent)]
    Mesh(#[from] MeshViolation),
}

/// The object at fault in a violation: the answer, one point, or the point set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The answer or its certificate.
    Answer,
    /// A point contradicts the answer: its row, from 0.
    Row(u64),
    /// The points are not those that the answer was found for.
    Points,
}

impl Violation {
    /// Returns what this violation blames, given that there are `rows` points.
    pub fn fault(&self, rows: u64) -> Fault {
        let of_list = |row: u64| if row < rows { Fault::Answer } else { Fault::Points };
        match *self {
            Violation::Outside { row, .. }
            | Violation::OutsideEllipsoid { row, .. }
            | Violation::OutsideHalfSpace { row, .. }
            | Violation::NotOutside { row, .. }
            | Violation::Listed { row, .. }
            | Violation::OffHull { row, .. } => Fault::Row(row),
            Violation::Hash { .. }
            | Violation::Dimension { .. }
            | Violation::NoRadius { .. }
            | Violation::NoShape { .. }
            | Violation::Order(OrderViolation::Dimension { .. })
            | Violation::Mesh(MeshViolation::Dimension { .. } | MeshViolation::Id { .. }) => {
                Fault::Points
            }
            Violation::Support { point: row, .. } | Violation::LeftOut { row, .. } => of_list(row),
            Violation::Centers(ref violation) => match *violation {
                CentersViolation::Outside { row, .. }
                | CentersViolation::NoSuchCenter { row, .. }
                | CentersViolation::GroupOutside { row, .. }
                | CentersViolation::GroupSplit { row, .. }
                | CentersViolation::Assignment { row, .. } => Fault::Row(row),
                CentersViolation::Dimension { .. }
                | CentersViolation::NoWeight { .. }
                | CentersViolation::GroupColumn { .. } => Fault::Points,
                CentersViolation::CoreSet { row, .. } | CentersViolation::Row { row, .. } => {
                    of_list(row)
                }
                _ => Fault::Answer,
            },
            Violation::Bodies(ref violation) => violation.fault(),
            Violation::Circle(ref violation) => violation.fault(),
            Violation::Convex(ref violation) => violation.fault(),
            Violation::KernelBall(ref violation) => violation.fault(),
            Violation::OrientedRectangle(ref violation) => violation.fault(),
            Violation::Rectangle(ref violation) => violation.fault(),
            Violation::Dop(ref violation) => violation.fault(rows),
            Violation::Ellipse(ref violation) => violation.fault(),
            Violation::Triangle(ref violation) => violation.fault(),
            Violation::Polygon(ref violation) => violation.fault(),
            Violation::Curve(ref violation) => match *violation {
                CurveViolation::OutsideBand { row, .. }
                | CurveViolation::NoVertex { row }
                | CurveViolation::NoPlace { row, .. }
                | CurveViolation::FarPlace { row, .. } => Fault::Row(row),
                CurveViolation::Plane { .. } => Fault::Points,
                _ => Fault::Answer,
            },
            Violation::Surface(ref violation) => match *violation {
                SurfaceViolation::Missing { row }
                | SurfaceViolation::MissingDuplicate { row, .. }
                | SurfaceViolation::Interior { row, .. }
                | SurfaceViolation::Ball { row, .. } => Fault::Row(row.into()),
                SurfaceViolation::Space { .. } => Fault::Points,
                _ => Fault::Answer,
            },
            _ => Fault::Answer,
        }
    }
}

/// A count with its noun.
struct Counted(usize, &'static str);

impl std::fmt::Display for Counted {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Counted(count, noun) = self;
        write!(f, "{count} {noun}{}", if *count == 1 { "" } else { "s" })
    }
}

/// Why a check did not end in a [`Verdict`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckError {
    /// The answer or its certificate is wrong.
    #[error(transparent)]
    Rejected(#[from] Violation),
    /// The points could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Parts of the points do not belong together, or what was found in them.
    #[error(transparent)]
    Parts(#[from] PartsError),
    /// Answers of this kind are judged over all points at once.
    #[error("answers of the kind {kind} are not verified in parts: verify them over all points")]
    NoParts {
        /// The word for the kind in JSON.
        kind: &'static str,
    },
}

impl From<BodiesViolation> for CheckError {
    fn from(violation: BodiesViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<CentersViolation> for CheckError {
    fn from(violation: CentersViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<CircleViolation> for CheckError {
    fn from(violation: CircleViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<ConvexViolation> for CheckError {
    fn from(violation: ConvexViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<KernelBallViolation> for CheckError {
    fn from(violation: KernelBallViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<OrientedRectangleViolation> for CheckError {
    fn from(violation: OrientedRectangleViolation) -> Self {
        Violation::from(violation).into()
    }
}

impl From<RectangleViolation> for CheckError {
    fn from(violation: RectangleViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<DopViolation> for CheckError {
    fn from(violation: DopViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<EllipseViolation> for CheckError {
    fn from(violation: EllipseViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<TriangleViolation> for CheckError {
    fn from(violation: TriangleViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<PolygonViolation> for CheckError {
    fn from(violation: PolygonViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<CurveViolation> for CheckError {
    fn from(violation: CurveViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<SurfaceViolation> for CheckError {
    fn from(violation: SurfaceViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<MeshViolation> for CheckError {
    fn from(violation: MeshViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}

impl From<OrderViolation> for CheckError {
    fn from(violation: OrderViolation) -> Self {
        CheckError::Rejected(violation.into())
    }
}
