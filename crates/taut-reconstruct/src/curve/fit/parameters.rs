//! The tuned constants of the fit, in one place.
//!
//! Each names its unit and its source. *Formula* or *paper*: it follows from a derivation. *Measured*: trials that the comment or the head of
//! the file that uses it describes. *Chosen*: the curves found in the tests of this crate and in `bench curve` are right with it, and how
//! much it could change is not known.

use std::f64::consts::FRAC_PI_6;

// Everywhere.

/// Cosine of the largest angle between a tangent and the way to a neighbor, or another tangent: 60°. Chosen.
pub(super) const ALONG_COS_MIN: f64 = 0.5;

// Points and their noise.

/// Largest distance of a point from a curve before the kind of noise is known, and where noise has no edge. Unit: standard deviations of the
/// noise. Chosen.
pub(super) const POINT_DEVIATIONS_MAX: f64 = 5.0;
/// Largest distance of a point from a curve where noise has an edge. Unit: the distance of that edge from the curve. Chosen.
pub(super) const EDGE_DEVIATIONS_MAX: f64 = 1.5;
/// Half-width of the band of noise without an edge. Unit: standard deviations. Formula: it holds 99.7 % of normal noise.
pub(super) const BAND_DEVIATIONS: f64 = 3.0;
/// Least distance from a curve, over the spacing along it, from which on points are not its vertices. No unit. Chosen.
pub(super) const NOISE_RATIO_MIN: f64 = 0.1;
/// Noise has an edge where nine tenths of it lie within this many medians. Formula: 1.8 of uniform noise, 2.44 of normal and 2.33 of
/// triangular noise.
pub(super) const EDGE_MEDIANS_MAX: f64 = 2.13;
/// Fewest points that tell the kind of noise. Chosen.
pub(super) const KIND_POINTS_MIN: usize = 100;
/// Noise counts up to this distance, and background from there to twice as far. Unit: standard deviations. Formula: 99.7 % of normal noise.
pub(super) const NOISE_DEVIATIONS_MAX: f64 = 3.0;

// Whether what is left of points is noise.

/// Points along the curve whose offsets are compared with each other. Chosen.
pub(super) const RUN_POINTS: usize = 24;
/// Least median of the mean squares of successive differences of offsets, over twice their variance, of many runs. No unit. Measured: 0.4
/// to 0.82 of rugged borders, 0.93 and more of noise where points are many.
pub(super) const NOISE_NEUMANN_MIN: f64 = 0.94;
/// By how much that is less for one run; for n runs by a √n-th of it. No unit. Formula: twice the standard error of the median, 0.25/√n, but
/// for a tenth.
pub(super) const NOISE_NEUMANN_SPREAD: f64 = 0.45;
/// From this share of mutual half neighbors on, points can be read as vertices too, and noise has to pass four more bounds. No unit. Measured:
/// 0.88 and more of rugged borders; of noise 0.66 to 0.9 where it is half a spacing wide or more, up to 1 where it is less.
pub(super) const MUTUAL_SHARE_MIN: f64 = 0.885;
/// The bound of [`NOISE_NEUMANN_MIN`] there. Measured: 40 of 44 maps that were taken for noise fail one of the four, and 2 of 572 noisy scenes.
pub(super) const MUTUAL_NEUMANN_MIN: f64 = 0.96;
/// The spread of [`NOISE_NEUMANN_SPREAD`] there. Formula: the standard error of the median.
pub(super) const MUTUAL_NEUMANN_SPREAD: f64 = 0.25;
/// Least share of the points that are in whole runs along the curves. No unit. Measured: 0.7 and more of noise, 0.2 to 0.6 of borders in many
/// pieces.
pub(super) const MUTUAL_RUNS_SHARE_MIN: f64 = 0.6;
/// Most mutual half neighbors of noise that is next to nothing beside the spacing. No unit. Measured, as the loss.
pub(super) const MUTUAL_SHARE_MAX: f64 = 1.1;
/// How much smaller that share is where the standard deviation of the noise is a spacing. No unit. Measured: noise of 0.5 spacings leaves at
/// most 0.98, of 0.7 at most 0.91, of one at most 0.87.
pub(super) const MUTUAL_SHARE_LOSS: f64 = 0.2;
/// Largest share of outliers of points that lie around curves. No unit. Chosen: a tenth more than the outliers that fits are tried with.
pub(super) const OUTLIER_SHARE_MAX: f64 = 0.3;

// Seeds.

/// Least length of a window, from its center to its end. Unit: standard deviations of its residuals. Chosen: a blob inside the band has 2.
pub(super) const FLATNESS_MIN: f64 = 8.0;
/// Bounds the best of all windows below where none reaches [`FLATNESS_MIN`]. Same unit. Chosen.
pub(super) const BEST_FLATNESS_MIN: f64 = 5.0;
/// Where no window was flat, no other is tried within this part of the largest. No unit. Chosen.
pub(super) const BARREN_RATIO: f64 = 0.2;
/// Most points that windows without a seed may hold, over all points there are. No unit. Chosen; it bounds the work.
pub(super) const VAIN_POINTS_RATIO_MAX: usize = 8;
/// Least deviation of a coarse window, over the median of those within it. No unit. Chosen.
pub(super) const COARSE_RATIO_MIN: f64 = 3.0;
/// Windows end when they are this many times as long as the flattest. No unit. Chosen.
pub(super) const WINDOW_RATIO_MAX: f64 = 4.0;
/// Fewest points of a window that is not confirmed by a longer one: of all that are tried, some of fewer are flat by chance. Chosen.
pub(super) const SURE_POINTS_MIN: usize = 60;
/// Length of the window that confirms one, over its length. No unit. Chosen.
pub(super) const CONFIRMING_RATIO: f64 = 1.4;
/// Least flatness of the window that confirms one, over its flatness. No unit. Chosen.
pub(super) const CONFIRMED_FLATNESS_RATIO: f64 = 0.75;
/// Least mean square of successive differences of residuals, over twice their variance. No unit. Paper: von Neumann 1941, 1 on average for
/// noise; the bound is chosen.
pub(super) const NEUMANN_RATIO_MIN: f64 = 0.5;
/// Factor by which windows of seeds grow. No unit. Chosen.
pub(super) const SEED_WINDOW_GROWTH: f64 = 1.2;
/// Lengths of a window that are tried around the curve. Chosen.
pub(super) const LENGTHS_TRIED: usize = 4;
/// Points of a window that tell whether it is worth a fit. Formula: they tell the width to 3 %, unless few of the window lie in a band.
pub(super) const SAMPLE_POINTS: usize = 512;
/// Least flatness that [`SAMPLE_POINTS`] must show, over [`FLATNESS_MIN`], for a window to be worth a fit. No unit. Chosen.
pub(super) const SAMPLE_FLATNESS_RATIO: f64 = 0.6;
/// Neighbors whose distance tells the density at a point. Chosen.
pub(super) const DENSITY_NEIGHBORS: usize = 8;
/// Half-length of the slab of a seed, over the length of its window. No unit. Chosen.
pub(super) const SLAB_LENGTH_RATIO: f64 = 0.45;
/// Largest residual of points of the slab. Unit: standard deviations, of which the edge of uniform noise has 1.73. Chosen.
pub(super) const SLAB_DEVIATIONS_MAX: f64 = 4.0;
/// The same where the window holds another strand. Measured: two strands of 500 points 4 half-widths apart need it.
pub(super) const SPLIT_SLAB_DEVIATIONS_MAX: f64 = 2.2;
/// Most times that another strand is left out of a window. Formula: two on either side would be four.
pub(super) const SPLITS_MAX: usize = 3;
/// Largest spacing of points of a curve, over that at nine tenths of it; beyond are outliers. No unit. Chosen.
pub(super) const SPACING_RATIO_MAX: f64 = 5.0;
/// At least one of this many points is on curves: fewer, such as a clump in one place, do not tell how dense those are. Chosen.
pub(super) const POINTS_PER_CURVE_POINT_MAX: usize = 8;
/// Largest ratio of the density along the curve to that of a seed: a seed beside the curve has few points. No unit. Chosen: with 8, seeds
/// among outliers stay.
pub(super) const DENSITY_RATIO_MAX: f64 = 4.0;
/// The same for that of all curves around, where a seed has others of its own curve: a curve may be sparser than one beside it. No unit. Chosen.
pub(super) const BESIDE_DENSITY_RATIO_MAX: f64 = 8.0;
/// Fewest seeds of one curve, the seed itself among them. Chosen.
pub(super) const ALIGNED_SEEDS_MIN: usize = 3;
/// Most tangents within this distance of a seed are along its own, else it runs across the band. Unit: windows. Chosen.
pub(super) const ALONG_WINDOWS: f64 = 1.5;
/// Least ratio of the length of a window to that of one within it that is flat by chance. In length alone they differ where points are sparse,
/// or where outliers hid the band. No unit. Chosen.
pub(super) const LENGTH_RATIO_MIN: f64 = 2.5;
/// Least ratio of the deviations of the same two windows. No unit. Chosen.
pub(super) const WIDTH_RATIO_MIN: f64 = 1.5;

// Links between seeds.

/// Largest distance of the next seed. Unit: windows. Chosen.
pub(super) const SEED_DISTANCE_MAX: f64 = 2.5;
/// How often the way across a tangent counts beside that along it: the next seed lies on the same strand. No unit. Measured: 3 for strands
/// 4 half-widths apart.
pub(super) const ACROSS_FACTOR: f64 = 3.0;
/// How often the distance of strands counts beside the way along them, over the length of windows in deviations of the noise: half, so that
/// two deviations count as the length of a window. No unit. Chosen.
pub(super) const APART_FACTOR: f64 = 0.5;
/// Most times that it counts. No unit. Chosen.
pub(super) const APART_FACTOR_MAX: f64 = 12.0;
/// Largest distance of ends that face each other. Unit: windows. Chosen.
pub(super) const END_DISTANCE_MAX: f64 = 4.0;
/// Fewest seeds of a chain. Chosen.
pub(super) const CHAIN_SEEDS_MIN: usize = 3;

// Loose ends.

/// Length of a step from a loose end on. Unit: standard deviations of the noise. Chosen.
pub(super) const STEP_DEVIATIONS: f64 = 1.5;
/// Length of the windows there, from their centers to their ends. Same unit. Chosen: half of what seeds need.
pub(super) const TRACK_WINDOW_DEVIATIONS: f64 = 4.0;
/// Fewest points of such a window. Chosen: two more than a parabola takes.
pub(super) const TRACK_POINTS_MIN: usize = 5;
/// Fewest of them ahead of its center: where there are none, the curve ends. Chosen.
pub(super) const TRACK_POINTS_AHEAD_MIN: usize = 2;
/// Cosine of the largest angle between a window and what was predicted: 45°. Chosen.
pub(super) const STEP_TURN_COS_MIN: f64 = 0.7;
/// Most steps from one end to another. Chosen; it bounds the work.
pub(super) const STEPS_MAX: usize = 64;
/// Most seeds of an end that are left out: at a bend the last ones are askew. Chosen.
pub(super) const TRACK_SEEDS_DROPPED: usize = 3;

// Layers.

/// Most searches, each among the points that the curves before have left. Chosen; it bounds the work.
pub(super) const LAYERS_MAX: usize = 3;
/// Fewest points that are searched again. Chosen: a loop of fewer is not told from outliers.
pub(super) const LAYER_POINTS_MIN: usize = 24;
/// Largest share of the nodes of a curve found so that are within the bands of those before. No unit. Measured: without it one in ten
/// circles among outliers gets a second curve along its own edge.
pub(super) const BESIDE_SHARE_MAX: f64 = 0.1;

// Splines and their nodes.

/// Nodes of each seed. Chosen.
pub(super) const NODES_PER_SEED: usize = 3;
/// Seeds on either side of one that tell the noise there. Chosen.
pub(super) const NOISE_SEEDS: usize = 2;
/// Least deviation at a node. Unit: windows. Formula: a window is at least eight deviations long and holds at least five points; of points without
/// noise the deviation would be that of rounding, and most would be farther off, as polylines are from parabolas.
pub(super) const DEVIATION_MIN: f64 = 0.002;
/// Pieces of the polyline between two nodes. Chosen.
pub(super) const PIECES_PER_NODE: usize = 4;
/// Points whose nearest places are sought together. Chosen for speed; it changes no result.
pub(super) const POINTS_PER_RUN: usize = 16;

// Regression along a spline.

/// Windows are grown at one place in this many: their length changes slowly along the curve. Chosen.
pub(super) const PLACES_PER_WINDOW: usize = 3;
/// Factor by which windows of the regression grow. No unit. Chosen.
pub(super) const REGRESSION_WINDOW_GROWTH: f64 = 1.25;
/// Fewest points of a window. Chosen.
pub(super) const WINDOW_POINTS_MIN: usize = 6;
/// Largest difference of two windows. Unit: standard errors. Paper: the factor of Lepski 1991; its value is chosen.
pub(super) const STANDARD_ERRORS_MAX: f64 = 1.0;
/// Half-length of a window in the frame of its middle, over that along the curve. No unit. Formula: 1/√(1 + s²) for slopes s up to
/// [`SLOPE_MAX`] is at least 0.78, about this.
pub(super) const HALF_LENGTH_RATIO: f64 = 0.8;
/// Error of the middle of the least largest residual δ of m points, over δ/m. No unit. Measured: trials with uniform noise.
pub(super) const MINIMAX_ERROR: f64 = 5.5;
/// Least standard error from which on a window has its points on one side, or next to none. Unit: deviations of the noise. Chosen.
pub(super) const ONE_SIDED_ERROR_MIN: f64 = 0.75;
/// Most outliers that a window leaves out one by one. Chosen; it bounds the work.
pub(super) const PEELED_OUTLIERS_MAX: usize = 8;
/// Largest slope against the frame within a window. No unit. Chosen.
pub(super) const SLOPE_MAX: f64 = 0.8;
/// Largest deviation of the residuals of a window. Unit: deviations of the noise. Chosen.
pub(super) const WINDOW_DEVIATION_RATIO_MAX: f64 = 1.5;
/// Most exchanges of a minimax fit; the gap reached by then will do. Chosen; it bounds the work.
pub(super) const EXCHANGES_MAX: usize = 40;
/// Relative gap at which exchanges end. No unit. Chosen.
pub(super) const GAP_MIN: f64 = 1e-10;

// Kinks.

/// Most rounds after which a spline that is not in order is left as it was. Measured: kinks around outliers take two to five.
pub(super) const ROUNDS_MAX: usize = 50;
/// Most nodes of a kink, three windows: where more are out of order, it is the order that is wrong. Chosen.
pub(super) const KINK_NODES_MAX: usize = 9;
/// Fewest nodes that must be in order. Formula: three are a closed curve whatever their tangents.
pub(super) const ORDERED_NODES_MIN: usize = 4;

// Corners. Measured on the outlines of polygons of 3 to 12 corners, and on 200 smooth curves, none of which has any.

/// Length of what a corner spoils on either side. Unit: deviations of the noise.
pub(super) const HALF_SPAN_RATIO: f64 = 6.0;
/// Least angle of a corner. Unit: radians.
pub(super) const CORNER_ANGLE_MIN: f64 = FRAC_PI_6;
/// Least turn of the spline, over the angle of the corner: windows round corners off. No unit.
pub(super) const TURN_RATIO_MIN: f64 = 0.6;
/// Shortest and longest side. Unit: deviations of the noise.
pub(super) const SIDE_DEVIATIONS: [f64; 2] = [12.0, 60.0];
/// Most nodes that are looked at beside a corner. Formula: they are at least two deviations apart, so about ten lie within the shortest side and
/// what the corner spoils.
pub(super) const NODES_MAX: usize = 50;
/// Factor by which sides grow. No unit.
pub(super) const SIDE_GROWTH: f64 = 1.3;
/// Largest deviation of a side from its parabola. Unit: deviations of the noise.
pub(super) const SIDE_DEVIATION_RATIO_MAX: f64 = 1.3;
/// Fewest points of a side, and of what is between.
pub(super) const SIDE_POINTS_MIN: u32 = 8;
/// Largest mean square distance of the points between from the corner. Unit: that of the noise.
pub(super) const CORNER_FIT_MAX: f64 = 1.4;
/// Largest relative excess of that over the one from the curve that goes around, times the root of the number of points. No unit. Some of
/// 200 smooth curves with bends of two to ten widths of the band passed for corners with twice this; at the corners of polygons it is 0.5
/// to 0.9 of that from the curve, where points are many.
pub(super) const CHANCE_EXCESS_MAX: f64 = 1.5;

// Output.

/// Most edges between two nodes. Chosen.
pub(super) const EDGES_PER_NODE_MAX: f64 = 16.0;
/// Fewest vertices of a piece that is left where edges crossed. Chosen.
pub(super) const PIECE_VERTICES_MIN: usize = 8;
