//! The answers of taut, the certificate of each, and checkers that share no code with the solvers.
//!
//! | answer | certificate | what the checker proves from the input alone |
//! |---|---|---|
//! | [`Ball`] | [`BallCertificate`] | every point is inside; no smaller ball than r/(1 + gap) holds them all |
//! | [`KernelBall`] | [`KernelBallCertificate`] | every point is inside, or the soft objective; no ball of the feature space has an objective below 1/(1 + gap) of it |
//! | [`Ellipsoid`] | [`EllipsoidCertificate`] | every point is inside; no ellipsoid of a log-volume less by more than the gap holds them all |
//! | [`RobustEllipsoid`] | [`RobustCertificate`] | center, scatter, factors and flags are those of the points kept; by `mcd`, no C-step leads on from them; by `mve` and `trim`, no much smaller ellipsoid holds them |
//! | [`InscribedEllipsoid`] | [`InscribedCertificate`] | it lies in every half-space; no ellipsoid in the polytope has a log-volume larger by more than the gap |
//! | [`InscribedCircle`] | [`CircleCertificate`] | its center is inside and no edge enters it; no circle in the polygon has a radius above (1 + gap)·r |
//! | [`InscribedEllipse`] | [`EllipseCertificate`] | its center is inside and no edge enters it; no ellipse in the polygon has an area above (1 + gap) times its own |
//! | [`InscribedOrientedRectangle`] | [`OrientedRectangleCertificate`] | it is inside; no rectangle of any direction in the polygon has an area above (1 + gap) times its own |
//! | [`InscribedRectangle`] | [`RectangleCertificate`] | it is inside; no rectangle along the axes in the polygon has an area above (1 + gap) times its own |
//! | [`ConvexPolygon`] | [`ConvexCertificate`] | it is convex and inside; no convex set in the polygon has an area above (1 + gap) times its own |
//! | [`InscribedTriangle`] | [`TriangleCertificate`] | it lies in the polygon; no triangle in the polygon has an area above (1 + gap) times its own |
//! | [`Centers`] | [`CentersCertificate`] | every item that counts is within the radius of a center; no k equal balls much smaller hold the core-set |
//! | [`InscribedBodies`] | [`BodiesCertificate`] | each body lies inside the mesh, by whole numbers alone; its volume; nothing about larger bodies |
//! | [`BoundingDop`] | [`DopCertificate`] | every point is inside; each facet touches one; its vertices and its volume |
//! | [`Curve`] | [`CurveCertificate`] | it meets neither itself nor others; every point but the outliers is within the band; whether sampling was dense enough |
//! | [`Surface`] | [`SurfaceCertificate`] | which rows it uses and why not the others; its topology; it meets itself nowhere; each triangle has an empty ball; it faces outwards |
//! | [`Order`] | [`OrderCertificate`] | each row once; it is *the* order of the points along its curve |
//! | [`Triangulation`] | [`TriangulationCertificate`] | the simplices are *the* Delaunay triangulation of the points |
//!
//! Answers that are files, judged from their bytes:
//!
//! | answer | certificate | what the checker proves |
//! |---|---|---|
//! | [`SortedFile`] | [`SortCertificate`] | its records are in order, and by a hash those of the input |
//! | [`TransposedFile`] | [`TransposeCertificate`] | each element is where the transpose has it; by a hash if the input is gone |
//! | [`DrawnSample`] | [`SampleCertificate`] | its numbers are those of the seed: different, in order, in range |
//!
//! A folder of tiles, as out-of-core triangulations are written, is judged with its points by [`check_tiles`]: the simplices of all
//! tiles together are *the* Delaunay triangulation of the points, for more of either than memory holds.
//!
//! A [`Solution`] is an answer, its certificate and a trace of counters. [`Solution::check`] reads the points again
//! and returns a [`Verdict`], or the first [`Violation`] it meets.
//!
//! ```
//! use taut_certify::{Ball, BallCertificate, Items, Solution, Trace};
//! use taut_points::{Monitor, Points, hash_points};
//!
//! let points = Points::new(&[0.0, 0.0, 2.0, 0.0, 1.0, 1.0], 2)?;
//! let by_hand = Solution {
//!     answer: Ball { center: vec![1.0, 0.0], center_tail: vec![], radius: 1.0 },
//!     certificate: BallCertificate {
//!         items: Items::Points,
//!         support: vec![0, 1],
//!         multipliers: vec![0.5, 0.5],
//!         directions: vec![],
//!         gap: 0.0,
//!         points_hash: hash_points(&points, &Monitor::silent())?,
//!     },
//!     trace: Trace::default(),
//! };
//! assert_eq!(by_hand.check(&points)?.gap, 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Not for: finding answers. No solver is imported here, and no solver's arithmetic is called.
#![forbid(unsafe_code)]

mod arithmetic;
mod ball;
mod bodies;
mod body_mesh;
mod centers;
mod circle;
mod convex;
mod curve;
mod dop;
mod ellipse;
mod ellipsoid;
mod files;
mod hashed_pass;
mod inscribed;
mod items;
mod json;
mod kernel_ball;
mod order;
mod oriented;
mod parts;
mod polygon;
mod reading;
mod rectangle;
mod registry;
mod robust;
mod solution;
mod surface;
#[cfg(test)]
mod test_length;
mod triangle;
mod triangulation;
mod unrolled;
mod verdict;

pub use ball::{Ball, BallCertificate};
pub use bodies::{
    BodiesCertificate, BodiesVerdict, BodiesViolation, BodyProof, ConvexBody, InscribedBodies,
};
pub use centers::{
    Centers, CentersCertificate, CentersVerdict, CentersViolation, HeldOut, LowerBound, Nogood,
    Placement,
};
pub use circle::{CircleCertificate, CircleVerdict, CircleViolation, InscribedCircle};
pub use convex::{ConvexCertificate, ConvexPolygon, ConvexVerdict, ConvexViolation};
pub use curve::{
    Curve, CurveCertificate, CurveComponent, CurveDoubt, CurveEvidence, CurveVerdict,
    CurveViolation, Place, TourBound, curve_evidence, tour_bound, tour_length,
};
pub use dop::{BoundingDop, DopCertificate, DopVerdict, DopViolation};
pub use ellipse::{EllipseCertificate, EllipseVerdict, EllipseViolation, InscribedEllipse};
pub use ellipsoid::{
    EllipseSupport, Ellipsoid, EllipsoidCertificate, EllipsoidVerdict, Hull, ellipse_support,
};
pub use files::{
    Data, DrawnSample, ElementOrder, FileAnswer, FileCheckError, FileSolution, FileVerdict,
    FileViolation, Files, Hash128, Hash128FormError, KeyKind, SampleCertificate, SortCertificate,
    SortedFile, TransposeCertificate, TransposedFile, WhichFile,
};
pub use inscribed::{InscribedCertificate, InscribedEllipsoid, InscribedVerdict};
pub use items::Items;
pub use json::{JsonError, SCHEMA};
pub use kernel_ball::{
    Kernel, KernelBall, KernelBallCertificate, KernelBallVerdict, KernelBallViolation, KernelCenter,
};
pub use order::{Order, OrderCertificate, OrderCurve, OrderVerdict, OrderViolation};
pub use oriented::{
    InscribedOrientedRectangle, OrientedRectangleCertificate, OrientedRectangleVerdict,
    OrientedRectangleViolation,
};
pub use parts::PartialVerdict;
pub use polygon::PolygonViolation;
pub use reading::{ReadingChoice, ScaleChoice};
pub use rectangle::{
    InscribedRectangle, RectangleCertificate, RectangleVerdict, RectangleViolation,
};
pub use registry::{AnyDocument, AnyFileSolution, AnySolution, AnyVerdict};
pub use robust::{
    Enclosure, RobustCertificate, RobustEllipsoid, RobustMethod, RobustScale, RobustVerdict,
    Unweighted,
};
pub use solution::{Answer, PassBounds, Solution, Stop, Trace};
pub use surface::{
    Apex, Surface, SurfaceCertificate, SurfaceComponent, SurfaceDoubt, SurfaceMethod, SurfaceMode,
    SurfaceTopology, SurfaceVerdict, SurfaceViolation, TopologyDoubt, TopologyReason, Unused,
};
pub use triangle::{InscribedTriangle, TriangleCertificate, TriangleVerdict, TriangleViolation};
pub use triangulation::{
    Fingerprint, FingerprintFormError, MeshViolation, NO_NEIGHBOR, SiteHash, TilesError,
    TilesOptions, TilesVerdict, TilesViolation, Triangulation, TriangulationCertificate,
    TriangulationCounts, TriangulationVerdict, check_simplices, check_tiles, check_tiles_disk,
    fingerprint,
};
pub use verdict::{CheckError, Fault, Verdict, Violation};
