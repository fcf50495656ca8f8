//! Tight enclosing shapes of point sets, each with a certificate anyone can check.
//!
//! | you want | call | promise | cost, n points in ℝᵈ |
//! |---|---|---|---|
//! | smallest ball around points or balls | [`ball()`] | R ≤ (1 + ε)·R*, proved | few passes of O(nd) |
//! | smallest ball around ellipsoids | [`ball()`] with [`BallOptions::inputs`] | the same | O(nd³), then a dozen passes of O(nd²) |
//! | smallest ball in the feature space of a kernel, hard or soft | [`kernel_ball()`] | objective ≤ (1 + ε) times the least, proved | some ten passes of O(nd) where the kernel is wide |
//! | k smallest equal balls around points, balls or ellipsoids, with outliers, weights | [`centers()`] | radius ≤ (1 + ε) times the least, proved | exponential in k; about 0.1 s for k = 10 in the plane |
//! | ellipsoid of least volume around points | [`ellipsoid()`] | log-volume ≤ optimum + ε, proved | few passes of O(nd²) |
//! | ellipsoid of least volume around balls, ellipsoids | [`ellipsoid()`] with [`EllipsoidOptions::inputs`] | the same | a dozen passes of O(nd³) |
//! | one for each of many point sets | [`ellipsoids()`] | the same | that of the sets, shared by all threads |
//! | ellipsoid of largest volume in a polytope | `inscribed_ellipsoid` (feature `conic`) | optimum ≤ log-volume + ε, proved | some fifty steps of O(nd⁴ + d⁶) |
//! | center, scatter and outliers | [`robust_ellipsoid()`] | all proved but that no other points kept would do better | some ten to thirty passes of O(nd²) |
//! | bounding k-dop of points of space | [`bounding_dop()`] | the smallest with its normals, proved | one pass of O(kn) |
//! | 2-approximate centers for every k at once | [`farthest_first()`] | radius ≤ 2·lower bound for each k | O(nkd) at worst, a small part of it as a rule |
//! | k centers of a stream | [`StreamingCenters`], or [`centers()`] with [`CentersMethod::Stream`] | radius ≤ 2.96·lower bound, or another factor | O(mkd) for each point, m = 8 guesses; one pass, and one to measure |
//! | k centers of points in many places | [`CoreSetSummary`] | radius ≤ 4 times the optimum, less with larger summaries | one pass in each place, and one to measure |
//! | a ball of rows that lie in several places | [`passes::Solver`] | the bytes of the same function in memory | a round of messages for each pass |
//! | a tree of balls | [`sphere_tree()`] | each the smallest around its points | some thirty passes of O(nd) for each level |
//!
//! Each takes points in memory or any [`PointSource`](taut_points::PointSource), and one struct of options, where a
//! [`Monitor`](taut_points::Monitor) can watch the work and stop it.
//!
//! ```
//! let points = taut_points::Points::new(&[0.0, 0.0, 2.0, 0.0, 1.0, 1.0], 2)?;   // n × d, row-major
//! let found = taut_enclose::ball(&points, &Default::default())?;
//! assert_eq!(found.answer.radius, 1.0);
//! assert!(found.check(&points)?.gap <= 1e-9);                                    // a second opinion, not the solver's
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//! The feature `conic`, on by default, brings the conic solver that `inscribed_ellipsoid`, [`BallMethod::ThesisPure`] and
//! [`BallMethod::ThesisFast`] need.
//!
//! Not for: distances other than Euclidean.

mod ball;
mod centers;
mod cholesky;
mod dop;
mod ellipsoid;
mod error;
mod farthest_first;
mod frame;
#[cfg(feature = "conic")]
mod inscribed;
mod item_reader;
mod kernel_ball;
pub mod passes;
mod robust;
mod separated_set;
mod shapes;
mod sphere_tree;
mod streaming;
mod top;

pub use ball::{BallMethod, BallOptions, ball};
pub use centers::{CentersMethod, CentersOptions, centers};
pub use dop::{DopOptions, bounding_dop};
pub use ellipsoid::{EllipsoidMethod, EllipsoidOptions, ellipsoid, ellipsoids};
pub use error::Error;
pub use farthest_first::{FarthestFirst, FarthestFirstOptions, farthest_first};
#[cfg(feature = "conic")]
pub use inscribed::{InscribedOptions, inscribed_ellipsoid};
pub use kernel_ball::{KernelBallMethod, KernelBallOptions, kernel_ball};
pub use robust::{RobustInParts, RobustOptions, robust_ellipsoid};
pub use sphere_tree::{SphereNode, SphereTree, SphereTreeOptions, sphere_tree};
pub use streaming::{CoreSetSummary, StreamingCenters, StreamingOptions, StreamingReport};
