//! Curves through noisy points: connectivity first, regression along the ordered curve after it.
//!
//! *Problem.* Points lie around unknown curves, off them by noise of unknown width; some may be outliers.
//! *Idea.* [`seeds`] finds at which scale the points look like a band, and puts places on its middle line; [`link`] joins them to
//! chains; [`spline`] gives each point its place along a chain, so that every neighborhood is a range of a sorted list; [`regress`]
//! fits the curve in windows as long as it lets them be, first by least squares, then, as [`noise`] has shown of which kind the
//! noise is, by the least largest residual where it has an edge. Where windows followed outliers, [`kinks`] puts the curve straight.
//! *Guarantee.* The answer turns, scales and shifts with the points, to rounding. O(n log n) for windows of bounded overlap. Error
//! O(n^(−4/5)) for noise with an edge and O(n^(−4/9)) for other noise, of smooth curves.
//! *Trap.* Tours and crusts of noisy points run zigzag through the band: order is known only after the noise is gone.
//! *Reference.* Cheng, Funke, Golin, Kumar, Poon and Ramos 2005, for seeds; Genovese, Perone-Pacifico, Verdinelli and Wasserman 2012,
//! for what error can be reached.

mod corners;
mod ends;
mod kinks;
mod layers;
mod link;
mod local;
mod minimax;
mod noise;
mod output;
mod parameters;
mod regress;
mod residuals;
mod seeds;
mod spline;
mod split;

use taut_points::{Monitor, OrderBy, exponent_of, two_to};

use super::Ends;
use super::answer::Outcome;
use super::cloud::Cloud;
use super::index::Index;
use crate::Error;
use layers::Layer;
use parameters::{BAND_DEVIATIONS, NOISE_RATIO_MIN, OUTLIER_SHARE_MAX};
use spline::Spline;

type Point = [f64; 2];

/// The curves of points, noisy or not.
pub(super) fn fit(cloud: &Cloud, ends: Ends, monitor: &Monitor<'_>) -> Result<Outcome, Error> {
    let frame = Frame::of(&cloud.sites);
    let points = frame.all_inward(&cloud.sites);
    Ok(fit_within(&frame, &points, &Index::new(&points), ends, 0.0, monitor)?.outcome)
}

/// The curves of points, and whether they are to be preferred to those through vertices; the share of mutual half neighbors tells how well
/// points can be read as vertices ([`Judged`](super::kind::Judged)).
pub(super) fn judged(
    cloud: &Cloud,
    ends: Ends,
    mutual_share: f64,
    monitor: &Monitor<'_>,
) -> Result<Fitted, Error> {
    let frame = Frame::of(&cloud.sites);
    let points = frame.all_inward(&cloud.sites);
    fit_within(&frame, &points, &Index::new(&points), ends, mutual_share, monitor)
}

/// The curves, and whether they are a good answer.
pub(super) struct Fitted {
    /// The curves.
    pub(super) outcome: Outcome,
    /// Whether points lie around the curves as noise does: off them by a length that shows beside their spacing, each for itself, few of
    /// them far off.
    pub(super) is_noisy: bool,
}

/// The curves of points in a frame.
fn fit_within(
    frame: &Frame,
    points: &[Point],
    index: &Index<'_>,
    ends: Ends,
    mutual_share: f64,
    monitor: &Monitor<'_>,
) -> Result<Fitted, Error> {
    let Layer { splines, noise, outliers, seeds, straightened } =
        layers::layers(points, index, ends, monitor)?;
    let deviation = typical(&splines, |_| 1.0);
    let noisiness = noisiness(&splines);
    let is_noise = residuals::are_noise(&splines, points.len(), noisiness, mutual_share);
    let is_apart = noisiness > NOISE_RATIO_MIN;
    let (curves, crossed) = output::curves(&splines, frame, ends, monitor)?;
    let counters = [
        ("seeds", seeds),
        ("nodes", splines.iter().map(|s| s.nodes.len()).sum()),
        ("corners", splines.iter().map(Spline::corners).sum()),
        ("nodes_straightened", straightened),
        ("edged_noise", usize::from(noise.edge.is_some())),
        ("edges_crossed", crossed as usize),
    ];
    let shows_curves =
        outliers.len() as f64 <= OUTLIER_SHARE_MAX * points.len() as f64 && !curves.is_empty();
    let outcome = Outcome {
        method: "fit",
        curves,
        outliers,
        noise: frame.length(noise.edge.unwrap_or(BAND_DEVIATIONS) * deviation),
        counters: counters.into_iter().map(|(name, n)| (name.into(), n as u64)).collect(),
        ..Outcome::default()
    };
    Ok(Fitted { outcome, is_noisy: is_noise && is_apart && shows_curves })
}

/// How far most points are off, beside their spacing along their spline.
fn noisiness(splines: &[Spline]) -> f64 {
    typical(splines, |s| s.members.len() as f64 / s.length())
}

/// The median over all points of the standard deviation of the noise there, times a factor of their spline.
fn typical(splines: &[Spline], factor: impl Fn(&Spline) -> f64) -> f64 {
    let mut all: Vec<(f64, usize)> = Vec::new();
    for spline in splines {
        let factor = factor(spline);
        let mut left = &spline.members[..];
        for (edge, node) in spline.nodes.iter().enumerate() {
            // Beyond the last node of an open spline, all that are left.
            let end = spline.arc.get(edge + 1).copied().unwrap_or(f64::INFINITY);
            let (here, after) = left.split_at(left.partition_point(|m| m.arc < end));
            all.push((factor * node.deviation, here.len()));
            left = after;
        }
    }
    all.order_by(&|a, b| a.0.total_cmp(&b.0));
    let total: usize = all.iter().map(|&(_, points)| points).sum();
    let mut before = 0;
    let middle = all.iter().find(|&&(_, points)| {
        before += points;
        2 * before > total
    });
    middle.map_or(0.0, |&(deviation, _)| deviation)
}

/// Moves points to around the origin and to the size of 1, and back.
struct Frame {
    middle: Point,
    /// A power of two.
    scale: f64,
}

impl Frame {
    /// The median of each coordinate goes to the origin, half the longer side of the box to a length in (½, 1]. The middle of the box would
    /// lose all digits of a curve that has a single point very far away.
    fn of(points: &[Point]) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in points {
            for i in 0..2 {
                (low[i], high[i]) = (low[i].min(p[i]), high[i].max(p[i]));
            }
        }
        if points.is_empty() {
            return Self { middle: [0.0; 2], scale: 1.0 };
        }
        // Halves, so that nothing overflows.
        let extent = (0.5 * high[0] - 0.5 * low[0]).max(0.5 * high[1] - 0.5 * low[1]);
        // That of the power of two which is not less.
        let exponent = if extent > 0.0 { exponent_of(extent.next_down()) + 1 } else { 0 };
        let median = |i: usize| {
            let mut all: Vec<f64> = points.iter().map(|p| p[i]).collect();
            *all.select_nth_unstable_by(points.len() / 2, f64::total_cmp).1
        };
        Self { middle: [0, 1].map(median), scale: two_to(-exponent.clamp(-1020, 1020)) }
    }

    fn inward(&self, p: Point) -> Point {
        [0, 1].map(|i| p[i] * self.scale - self.middle[i] * self.scale)
    }

    fn all_inward(&self, points: &[Point]) -> Vec<Point> {
        points.iter().map(|&p| self.inward(p)).collect()
    }

    fn outward(&self, p: Point) -> Point {
        [0, 1].map(|i| p[i] / self.scale + self.middle[i])
    }

    fn length(&self, length: f64) -> f64 {
        length / self.scale
    }
}
