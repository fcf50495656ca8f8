//! Tight shapes around, through and inside point sets, with proof: every tool in one crate.
//!
//! | you want | call | promise | more |
//! |---|---|---|---|
//! | the smallest ball around points, balls or ellipsoids | [`ball()`] | R ≤ (1 + ε)·R*, proved | [`enclose`] |
//! | k-center: minimize the largest distance to the nearest center, for points or balls | [`centers()`] | radius ≤ (1 + ε) times the least, proved; with outliers, weights, or among the points | [`enclose`] |
//! | centers for every k at once, of any number of points | [`farthest_first()`] | at most twice the least radius, for each k | [`enclose`] |
//! | k centers of a stream, or of points in many places | [`enclose::StreamingCenters`], [`enclose::CoreSetSummary`] | a factor of the least radius, both bounds told | [`enclose`] |
//! | a tree of balls | [`sphere_tree()`] | each the smallest around its points | [`enclose`] |
//! | nearest, within a radius, along a ray, farthest, pairs, diameter; of points or balls | [`enclose::SphereSearch`] | as by a search through all rows, ties to the lowest | [`enclose`] |
//! | the ellipsoid of least volume around points, balls or ellipsoids | [`ellipsoid()`] | log-volume ≤ least + ε, proved | [`enclose`] |
//! | one for each of many point sets | [`ellipsoids()`] | the same | [`enclose`] |
//! | the ellipsoid of largest volume in a polytope | [`inscribed_ellipsoid()`] | optimum ≤ log-volume + ε, proved | [`enclose`] |
//! | the largest circle in a polygon, with holes | [`inscribed_circle()`] | largest radius ≤ (1 + ε)·radius, proved | [`inscribe`] |
//! | the largest ellipse in a polygon, with holes | [`inscribe::inscribed_ellipse()`] | largest area ≤ (1 + ε)·area, proved | [`inscribe`] |
//! | the largest rectangle of any direction in a polygon | [`inscribe::inscribed_oriented_rectangle()`] | largest area ≤ (1 + ε)·area, proved | [`inscribe`] |
//! | the largest rectangle along the axes in a polygon | [`inscribe::inscribed_rectangle()`] | largest area ≤ (1 + ε)·area, proved | [`inscribe`] |
//! | a large convex polygon in a polygon, with holes | [`inscribe::inscribed_polygon()`] | inside, proved; largest area ≤ (1 + gap)·area, proved | [`inscribe`] |
//! | the largest triangle in a polygon, with holes | [`inscribe::inscribed_triangle()`] | largest area ≤ (1 + ε)·area, proved | [`inscribe`] |
//! | a ball of rows that lie in several places, such as partitions on a cluster | [`enclose::passes::Solver`] | the bytes of [`ball()`] | [`enclose::passes`] |
//! | the smallest ball in the feature space of a kernel, hard or soft | [`enclose::kernel_ball()`] | objective ≤ (1 + ε) times the least, proved | [`enclose`] |
//! | the bounding k-dop of points of space, such as those of a mesh | [`enclose::bounding_dop()`] | the smallest with its normals, proved | [`enclose`] |
//! | center and scatter of most points, and the outliers | [`robust_ellipsoid()`] | all but the choice of points proved; that choice a local optimum | [`enclose`] |
//! | convex bodies inside a triangle mesh | [`inscribe::inscribed_bodies()`] | each lies inside, proved; coverage estimated | [`inscribe`] |
//! | the Delaunay triangulation of points in the plane or in space | [`delaunay()`] | exact, a function of the point set alone, proved | [mod@delaunay] |
//! | the same, to walk around in; Voronoi cells, alpha complexes, nearest points | [`delaunay::Plane`], [`delaunay::Space`] | the same | [mod@delaunay] |
//! | contour lines and rasters of heights | [`delaunay::terrain`] | exact neighbors, the same bits in memory and by tiles | [mod@delaunay] |
//! | the triangulation of more points than memory holds | [`delaunay_to_folder()`] | the same simplices, as tiles in a folder, proved by [`certify::check_tiles`] | [`delaunay::outofcore`] |
//! | constrained edges | [`delaunay::Plane::constrained`] | exact, Delaunay as far as they let it be | [mod@delaunay] |
//! | rows in an order where neighbors are near each other | [`spatial_order()`] | a function of the point set alone, proved | [mod@delaunay] |
//! | files sorted or transposed that memory does not hold, samples, orders, nearest points | [mod@oblivious] | each with its own | [mod@oblivious], [`files`] |
//! | the curves that noisy points were sampled from | [`curve()`] | no crossings; each point within the band told or named as an outlier; whether sampling was dense enough | [mod@reconstruct] |
//! | the curves through points without noise, a short tour through points | [`curve()`] with a [`CurveMethod`] | what each is known for, a bound beside the tour | [mod@reconstruct] |
//! | the surface that points of space were sampled from | [`surface()`] | an oriented manifold of Delaunay triangles, or where it is none | [mod@reconstruct] |
//! | classes of points, learned from labeled ones, and error rates | [`recognize::classify::train`], [mod@recognize] | the same bits for any number of threads | [mod@recognize] |
//! | a second opinion on any answer | [`Solution::check`] | a proved bracket, or the first violation | [`certify`] |
//! | an answer of yesterday | [`AnySolution::from_json`] | the same bits | [`certify`] |
//! | points to try with | [`points::generate()`] | point i depends on the seed and i alone | [`points`] |
//!
//! Each function takes [`Points`] in memory or any other [`PointSource`], of any size where it does not say that points are
//! held in memory, and one struct of options: what the rows are, the method, the threads, and a [`Monitor`] that watches
//! the work and can stop it.
//!
//! ```
//! let points = taut::Points::new(&[0.0, 0.0, 2.0, 0.0, 1.0, 1.0], 2)?;   // n × d, row-major
//! let found = taut::ball(&points, &taut::BallOptions::default())?;
//! assert_eq!(found.answer.center, [1.0, 0.0]);
//! assert!(found.check(&points)?.gap <= 1e-9);                            // not the solver's word: a proof
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! An answer is data: it travels as JSON, and anyone with the points can verify it.
//!
//! ```
//! # let points = taut::Points::new(&[0.0, 0.0, 2.0, 0.0, 1.0, 1.0], 2)?;
//! let json = taut::ball(&points, &taut::BallOptions::default())?.to_json();
//! let received = taut::AnySolution::from_json(&json)?;
//! assert!(received.check(&points, &taut::Monitor::silent()).is_ok());
//!
//! let other = taut::Points::new(&[0.0, 0.0, 2.0, 0.0, 1.0, 9.0], 2)?;
//! let refused = received.check(&other, &taut::Monitor::silent()).unwrap_err();
//! assert!(refused.to_string().contains("the data changed"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Ellipsoids fit closer than balls, and points in a flat are no exception:
//!
//! ```
//! let points = taut::Points::new(&[0.0, 0.0, 4.0, 0.0, 4.0, 2.0, 0.0, 2.0, 1.0, 1.0], 2)?;
//! let found = taut::ellipsoid(&points, &taut::EllipsoidOptions::default())?;
//! assert!((found.answer.log_volume.exp() - 4.0 * std::f64::consts::PI).abs() < 1e-9);
//! assert!(found.answer.norm(&[1.0, 1.0]) < 1.0);                         // inside: |F(x − c)| is less than 1
//! assert!(found.check(&points)?.gap <= 1e-9);                            // in log-volume, so e^gap in volume
//!
//! let line = taut::Points::new(&[0.0, 0.0, 3.0, 4.0, 1.5, 2.0], 2)?;
//! let segment = taut::ellipsoid(&line, &taut::EllipsoidOptions::default())?.answer;
//! assert_eq!(segment.rank(), 1);                                         // its volume is a length
//! assert!((segment.log_volume.exp() - 5.0).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Few centers for many points, and the proof that no others do much better:
//!
//! ```
//! let towns = taut::Points::new(&[0.0, 0.0, 0.0, 2.0, 9.0, 0.0, 9.0, 1.0], 2)?;
//! let options = taut::CentersOptions { epsilon: 1e-6, ..Default::default() };
//! let found = taut::centers(&towns, 2, &options)?;
//! assert_eq!(found.answer.radius, 1.0);
//! assert!(found.check(&towns)?.gap <= 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Triangulations are answers like any other:
//!
//! ```
//! let points = taut::Points::new(&[0.0, 0.0, 4.0, 0.0, 4.0, 3.0, 0.0, 1.0], 2)?;
//! let found = taut::delaunay(&points, &taut::DelaunayOptions::default())?;
//! assert_eq!(found.answer.rows().count(), 2);                            // triangles, as rows of the input
//! assert_eq!(found.answer.hull.len() / 2, 4);
//! assert_eq!(found.check(&points)?.counts.sites, 4);                     // proved to be the one and only
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! More points than memory holds are triangulated to a folder of tiles, which is proved within a limit on memory, too:
//!
//! ```
//! # let folder = tempfile::tempdir()?;
//! # let folder = folder.path();
//! use taut::points::{Distribution, GeneratedSource, ScalarKind};
//!
//! let source = GeneratedSource::new(Distribution::Uniform, 10_000, 2, 7, ScalarKind::F64)?;
//! let options = taut::delaunay::FolderOptions { memory: 64 << 20, ..Default::default() };
//! let found = taut::delaunay_to_folder(&source, folder, &options)?;
//! let proved = taut::certify::check_tiles(folder, &source, &Default::default())?;
//! assert_eq!(proved.counts.simplices, found.totals.simplices);
//! assert_eq!(proved.fingerprint, found.totals.fingerprint);              // that of the triangulation in memory
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Curves through points come with what is known about them:
//!
//! ```
//! let on_a_circle: Vec<f64> = (0..40)
//!     .map(|i| std::f64::consts::TAU * f64::from(i) / 40.0)
//!     .flat_map(|t| [t.cos(), t.sin()])
//!     .collect();
//! let points = taut::Points::new(&on_a_circle, 2)?;
//! let options = taut::CurveOptions { method: taut::CurveMethod::HnnCrust, ..Default::default() };
//! let found = taut::curve(&points, &options)?;
//! assert!(found.answer.curves.len() == 1 && found.answer.curves[0].closed);
//! assert_eq!(found.answer.curves[0].vertices.len(), 40);
//! assert!(found.check(&points)?.is_simple);                              // no two edges meet, by exact signs
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Nothing but names lives here, and in [`files`] what joins two crates that do not know each other; each crate behind the
//! façade can be used on its own. Files are read and written by `taut-io`, pictures drawn by `taut-draw`, and the command `taut`
//! is the crate `taut-cli`.
//!
//! Four cargo features, all on by default, switch areas off: `reconstruct` (curves and surfaces), `recognize` (classifiers,
//! their evaluation, and hands), `photographs` (images of hands in JPEG and TIFF; those in PNG are always read) and `conic`
//! (inscribed ellipsoids and the methods of the thesis for balls, which need a conic solver). A fifth one, `store`, is off by
//! default: the encrypted store of people in [mod@recognize], for which SQLite is compiled.
//!
//! Not for: distances other than Euclidean, or weights other than those of centers.
#![forbid(unsafe_code)]

pub mod enclose;
mod error;
pub mod files;

pub use error::Error;

pub use taut_certify as certify;
pub use taut_delaunay as delaunay;
pub use taut_inscribe as inscribe;
pub use taut_oblivious as oblivious;
pub use taut_points as points;
#[cfg(feature = "recognize")]
pub use taut_recognize as recognize;
#[cfg(feature = "reconstruct")]
pub use taut_reconstruct as reconstruct;

pub use taut_certify::{AnySolution, Items, RobustMethod, Solution};
pub use taut_delaunay::{
    DelaunayOptions, OrderOptions, delaunay, delaunay_to_folder, spatial_order,
};
pub use taut_enclose::{
    BallMethod, BallOptions, CentersMethod, CentersOptions, EllipsoidMethod, EllipsoidOptions,
    FarthestFirstOptions, RobustOptions, SphereTreeOptions, ball, centers, ellipsoid, ellipsoids,
    farthest_first, robust_ellipsoid, sphere_tree,
};
#[cfg(feature = "conic")]
pub use taut_enclose::{InscribedOptions, inscribed_ellipsoid};
pub use taut_inscribe::{CircleOptions, inscribed_circle};
pub use taut_points::{Monitor, PointSource, Points};
#[cfg(feature = "reconstruct")]
pub use taut_reconstruct::{
    CurveMethod, CurveOptions, SurfaceMethod, SurfaceOptions, curve, surface,
};
