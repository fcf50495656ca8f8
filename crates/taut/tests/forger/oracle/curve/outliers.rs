//! Decides whether outliers of curves whose vertices are rows could be the samples of a curve that was missed.

use std::collections::HashSet;
use std::f64::consts::PI;

use taut::certify::Curve;

use super::lists::key;
use super::planar::Point;
use super::{Edge, Judged, ensure};

/// At most this part of the rows may be outliers.
const OUTLIER_RATIO_MAX: f64 = 0.2;

/// Outliers that may be linked, and how near two that are linked lie, over the gap that 95 of 100 samples have at most.
const CLUSTER_MOST: usize = 9;
const LINK_RATIO: f64 = 1.5;

/// Fewest outliers of which it is asked whether they lie nearer to each other than chance would put them, and how near.
const OUTLIERS_MIN: usize = 8;
const NEAR_LEAST: f64 = 0.75;

/// Circles in which chance puts so many, and ln of how seldom it may fill one of them so.
const EXPECTED: [f64; 7] = [0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
const FILL_RARITY: f64 = 6.5;

/// Parts of the outliers that chance puts nearest to their next, and the evidence that more are as near.
const NEXT_SHARES: [f64; 3] = [0.1, 0.2, 0.4];
const NEXT_RARITY: f64 = 10.0;

/// Outliers that may be alone far off: farther from the box of the curves than that is long, and than any other.
const LONE_MOST: usize = 3;

/// Chance links outliers where each has more than so many others within reach on average.
const CHANCE_NEIGHBORS_MAX: f64 = 0.15;

/// Relative error of a distance or a threshold.
const ROUNDING: f64 = 1e-9;

/// Distinct outliers with their first rows, and what is known of them.
pub(super) struct Outliers {
    all: Vec<(u64, Point)>,
    /// Distinct rows, outliers among them.
    rows: u64,
    link: f64,
    /// Their mean distance from the next, over what chance makes it.
    near: f64,
    /// Those of which that is said.
    within: usize,
    /// By how much the fullest circle is fuller, or more are near their next, than chance makes it, over the most that is granted.
    fullest: f64,
}

impl Outliers {
    /// `lengths` are those of the edges, ascending.
    pub(super) fn of(
        curve: &Curve,
        rows: &[Point],
        scaled: impl Fn(Point) -> Point,
        edges: &[Edge],
        lengths: &[f64],
    ) -> Result<Self, String> {
        let (mut seen, mut all, mut others) = (HashSet::new(), vec![], HashSet::new());
        for (row, &p) in (0u64..).zip(rows) {
            if curve.outliers.binary_search(&row).is_err() {
                others.insert(key(p));
            } else if seen.insert(key(p)) {
                all.push((row, scaled(p)));
            }
        }
        let usual = lengths.get(lengths.len() * 19 / 20).copied().unwrap_or(0.0);
        let mut outliers = Outliers {
            rows: (all.len() + others.len()) as u64,
            all,
            link: LINK_RATIO * usual,
            near: f64::INFINITY,
            within: 0,
            fullest: 0.0,
        };
        let range = |places: &[Point], k: usize| {
            let of = || places.iter().map(|p| p[k]);
            [of().fold(f64::MAX, f64::min), of().fold(f64::MIN, f64::max)]
        };
        let ends: Vec<Point> = edges.iter().flat_map(|edge| edge.ends).collect();
        let curves = [0, 1].map(|k| range(&ends, k));
        let size = curves.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
        let beyond = |p: Point| {
            let off = |k: usize| (curves[k][0] - p[k]).max(p[k] - curves[k][1]).max(0.0);
            off(0).max(off(1))
        };
        let mut far: Vec<f64> = outliers.all.iter().map(|&(_, p)| beyond(p)).collect();
        far.sort_by(|a, b| b.total_cmp(a));
        let reach = far.get(LONE_MOST).map_or(size, |next| next.max(size));
        let some: Vec<Point> =
            outliers.all.iter().map(|&(_, p)| p).filter(|&p| beyond(p) <= reach).collect();
        let places: Vec<Point> = ends.iter().chain(&some).copied().collect();
        let span = |k: usize| range(&places, k)[1] - range(&places, k)[0];
        let area = span(0) * span(1);
        let many = some.len() as f64;
        outliers.within = some.len();
        let by_chance = (CHANCE_NEIGHBORS_MAX * area / (PI * many.max(1.0))).sqrt();
        outliers.link = outliers.link.min(by_chance);
        if some.len() >= OUTLIERS_MIN {
            if !area.is_normal() {
                return Err("the box around curves and outliers has no area in doubles".into());
            }
            let usual = 0.5 * (area / many).sqrt();
            let most = many.ln() + FILL_RARITY;
            let (mut nearest, mut fullest) = (vec![], 0.0f64);
            for &p in &some {
                let apart = || {
                    let all = some.iter().map(|q| (p[0] - q[0]).hypot(p[1] - q[1]));
                    all.filter(|&apart| apart > 0.0)
                };
                nearest.push(apart().fold(4.0 * usual, f64::min));
                for expected in EXPECTED {
                    let reach = (expected * area / (PI * many)).sqrt();
                    let count = apart().filter(|&apart| apart <= reach).count() as f64;
                    if count > expected {
                        let evidence = count * (count / expected).ln() - (count - expected);
                        fullest = fullest.max(evidence / most);
                    }
                }
            }
            for share in NEXT_SHARES {
                // Of points at random this share has its next within that distance.
                let distance = (-f64::ln(1.0 - share) * area / (PI * many)).sqrt();
                let found = nearest.iter().filter(|&&next| next < distance).count() as f64 / many;
                let part = |found: f64, share: f64| {
                    if found > 0.0 { found * (found / share).ln() } else { 0.0 }
                };
                if found > share {
                    let evidence = many * (part(found, share) + part(1.0 - found, 1.0 - share));
                    fullest = fullest.max(evidence / NEXT_RARITY);
                }
            }
            (outliers.near, outliers.fullest) =
                (nearest.iter().sum::<f64>() / many / usual, fullest);
        }
        Ok(outliers)
    }

    pub(super) fn are_many(&self, outliers: u64, rows: u64) -> bool {
        let is_so = outliers == self.all.len() as u64 && rows == self.rows;
        is_so && outliers as f64 > OUTLIER_RATIO_MAX * rows as f64
    }

    /// Outliers linked with a given one, itself among them.
    fn linked(&self, start: usize, link: f64) -> usize {
        let mut found = vec![start];
        let mut at = 0;
        while at < found.len() {
            let p = self.all[found[at]].1;
            for (k, (_, q)) in self.all.iter().enumerate() {
                if !found.contains(&k) && (p[0] - q[0]).hypot(p[1] - q[1]) <= link {
                    found.push(k);
                }
            }
            at += 1;
        }
        found.len()
    }

    pub(super) fn are_cluster(&self, row: u64, rows: usize) -> bool {
        let start = self.all.iter().position(|one| one.0 == row);
        let most = start.map_or(0, |start| self.linked(start, self.link * (1.0 + ROUNDING)));
        rows > CLUSTER_MOST && rows <= most
    }

    /// Returns how near they may be on average.
    fn near_least(&self) -> f64 {
        NEAR_LEAST.min(1.0 - 4.0 * 0.52 / (self.within as f64).sqrt())
    }

    pub(super) fn are_gathered(&self, row: u64, rows: usize, near: f64) -> bool {
        let is_gathered = self.near < self.near_least() * (1.0 + ROUNDING);
        let is_told = (near - self.near).abs() <= ROUNDING * self.near;
        let is_there = rows == self.within && self.all.iter().any(|one| one.0 == row);
        is_told && is_there && (is_gathered || self.fullest > 1.0 - ROUNDING)
    }

    /// None of the reasons holds.
    pub(super) fn are_few(&self) -> Judged {
        let count = self.all.len();
        ensure(count as f64 <= OUTLIER_RATIO_MAX * self.rows as f64, || {
            format!("{count} outliers")
        })?;
        let is_cluster = |k: usize| self.linked(k, self.link * (1.0 - ROUNDING)) > CLUSTER_MOST;
        ensure(!(0..count).any(is_cluster), || "a cluster of outliers".into())?;
        let is_gathered =
            self.within >= OUTLIERS_MIN && self.near < self.near_least() * (1.0 - ROUNDING);
        let is_full = self.fullest > 1.0 + ROUNDING;
        ensure(!is_gathered && !is_full, || "outliers nearer to each other than by chance".into())
    }
}
