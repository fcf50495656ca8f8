//! Reasons not to certify closed curves whose vertices are rows: what each says must be so, and none may be left unsaid.

use std::f64::consts::FRAC_PI_3;

use taut::certify::Curve;
use taut::certify::CurveDoubt;

use super::features::Course;
use super::outliers::Outliers;
use super::planar::Point;
use super::{Edge, Judged, Stop, ensure};

/// The most that half a gap may be of φ.
const SAMPLING_MOST: f64 = 0.25;

/// φ is told up to this much of it.
const RADIUS_TOLERANCE: f64 = 1.0 / 64.0;

/// Relative error of a figure here or there beside that: R of a circle through a point at distance |w| is off by
/// u·R/|w| of itself, and [`Scene::of`] gives up where an edge is shorter than 10⁻⁹ of the extent.
const ROUNDING: f64 = 1e-6;
const EDGE_RATIO_MIN: f64 = 1e-9;

/// A gap is compared with this many gaps on either side of it.
const NEIGHBOR_GAPS: usize = 32;
/// They are supposed to have at least this coefficient of variation.
const VARIATION_MIN: f64 = 0.1;
/// A gap this much longer than their mean can be too long,
const GAP_TIMES_MIN: f64 = 2.0;
/// if −ln of the probability that chance leaves any as long is above this.
const GAP_RARITY: f64 = 6.0;

/// The curves and outliers, scaled so that the curves have coordinates of about 1.
pub(super) struct Scene {
    courses: Vec<Course>,
    edges: Vec<Edge>,
    outliers: Outliers,
}

/// The known facts about the gaps of each curve.
pub(super) struct Gaps {
    /// Half of each over φ: the least and the most that may be told.
    pub(super) ratios: Vec<Vec<[f64; 2]>>,
    /// Of each, its length over the mean of those beside it, and −ln of the probability that chance leaves any as long.
    gap_sizes: Vec<Vec<[f64; 2]>>,
}

impl Scene {
    pub(super) fn of(curve: &Curve, edges: &[Edge], rows: &[Point]) -> Result<Self, String> {
        let all = curve.curves.iter().flat_map(|one| one.vertices.as_flattened());
        let largest = all.fold(0.0f64, |most, x| most.max(x.abs()));
        // Two factors, each of which is a double.
        let exponent = -(largest.log2() as i32);
        let factors = [exponent / 2, exponent - exponent / 2].map(|e| 2f64.powi(e));
        let scaled = |p: Point| p.map(|x| x * factors[0] * factors[1]);
        let edges: Vec<Edge> =
            edges.iter().map(|edge| Edge { ends: edge.ends.map(scaled), ..*edge }).collect();
        let courses: Vec<Course> = curve
            .curves
            .iter()
            .enumerate()
            .map(|(k, one)| Course::of(k, one.vertices.iter().map(|&p| scaled(p)).collect()))
            .collect();
        let is_long =
            |course: &Course| (0..course.points.len()).all(|k| course.gap(k) > EDGE_RATIO_MIN);
        if !courses.iter().all(is_long) {
            return Err("edges are so short beside the extent that figures are all rounding".into());
        }
        let mut lengths: Vec<f64> =
            courses.iter().flat_map(|c| (0..c.points.len()).map(|k| c.gap(k))).collect();
        lengths.sort_by(f64::total_cmp);
        let outliers = Outliers::of(curve, rows, scaled, &edges, &lengths)?;
        Ok(Scene { courses, edges, outliers })
    }

    pub(super) fn gaps(&self) -> Gaps {
        let ratios = |course: &Course| {
            // What is forgiven is 16 roundings; none and twice as many bound what rounding makes of it.
            let [low, high] = [0.0, 16.0].map(|forgiven| course.features(&self.edges, forgiven));
            let count = course.points.len();
            let ratio = |k: usize| {
                let half = course.gap(k) / 2.0;
                let [next, after] = [k + 1, k + 2].map(|k| k % count);
                let most = high[k].min(high[next]) * (1.0 + RADIUS_TOLERANCE);
                // The checker looks at one more vertex, which makes the figure no smaller.
                let least = low[k].min(low[next]).min(low[after]);
                [half / most * (1.0 - ROUNDING), half / least * (1.0 + ROUNDING)]
            };
            (0..count).map(ratio).collect()
        };
        let gap_sizes = |course: &Course| {
            let count = course.points.len();
            let beside = NEIGHBOR_GAPS.min((count - 1) / 2);
            let gap_size = |k: usize| {
                let near: Vec<f64> = (1..=beside)
                    .flat_map(|step| [course.gap(k + step), course.gap(k + count - step)])
                    .collect();
                let many = near.len() as f64;
                let mean = near.iter().sum::<f64>() / many;
                let variance = near.iter().map(|gap| (gap - mean).powi(2)).sum::<f64>() / many;
                let varied = (variance.sqrt() / mean).clamp(VARIATION_MIN, 1.0);
                let size = course.gap(k) / mean;
                let times = 1.0 + (size - 1.0) / varied;
                [size, many * (1.0 + times / many).ln() - (count as f64).ln()]
            };
            (0..count).map(gap_size).collect()
        };
        Gaps {
            ratios: self.courses.iter().map(ratios).collect(),
            gap_sizes: self.courses.iter().map(gap_sizes).collect(),
        }
    }

    /// Tests whether a doubt told is so; or, without one, whether none is so.
    pub(super) fn judge(&self, doubt: Option<CurveDoubt>, gaps: &Gaps) -> Judged {
        let is_near = |told: f64, found: f64| (told - found).abs() <= ROUNDING * found.abs();
        let Some(doubt) = doubt else { return self.has_none(gaps) };
        let is_so = match doubt {
            CurveDoubt::Corner { curve, vertex, degrees } => {
                let course = self.courses.get(curve).filter(|one| vertex < one.points.len());
                let turn = course.map_or(0.0, |one| one.turn(vertex));
                is_near(degrees, turn.to_degrees()) && turn > FRAC_PI_3 * (1.0 - ROUNDING)
            }
            CurveDoubt::Sparse { curve, vertex, ratio, most } => {
                let at = gaps.ratios.get(curve).and_then(|of| of.get(vertex));
                let is_it = at.is_some_and(|&[low, high]| (low..=high).contains(&ratio));
                is_it && most == SAMPLING_MOST && ratio > most
            }
            CurveDoubt::Lacuna { curve, vertex, times } => {
                let at = gaps.gap_sizes.get(curve).and_then(|of| of.get(vertex));
                at.is_some_and(|&[found, rarity]| {
                    let is_long = found > GAP_TIMES_MIN * (1.0 - ROUNDING);
                    is_near(times, found) && is_long && rarity > GAP_RARITY - ROUNDING
                })
            }
            CurveDoubt::Outliers { outliers, rows } => self.outliers.are_many(outliers, rows),
            CurveDoubt::Cluster { row, rows } => self.outliers.are_cluster(row, rows),
            CurveDoubt::Gathered { row, rows, near } => self.outliers.are_gathered(row, rows, near),
            _ => return Err(Stop::Lie(format!("no such doubt of such curves: {doubt:?}"))),
        };
        ensure(is_so, || format!("this is not so: {doubt:?}"))
    }

    fn has_none(&self, gaps: &Gaps) -> Judged {
        for course in &self.courses {
            let turns = (0..course.points.len()).map(|v| course.turn(v));
            let turn = turns.fold(0.0, f64::max);
            ensure(turn <= FRAC_PI_3 * (1.0 + ROUNDING), || format!("a corner of {turn} radians"))?;
        }
        let sparse = gaps.ratios.iter().flatten().find(|ratio| ratio[0] > SAMPLING_MOST);
        ensure(sparse.is_none(), || format!("sparse samples: {sparse:?}"))?;
        let is_long = |&&[times, rarity]: &&[f64; 2]| {
            times > GAP_TIMES_MIN * (1.0 + ROUNDING) && rarity > GAP_RARITY + ROUNDING
        };
        let long = gaps.gap_sizes.iter().flatten().find(is_long);
        ensure(long.is_none(), || format!("a long gap: {long:?}"))?;
        self.outliers.are_few()
    }
}
