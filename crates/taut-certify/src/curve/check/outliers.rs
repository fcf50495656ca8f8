//! Whether outliers could be the samples of a curve that was missed.

use std::collections::BTreeMap;

use super::super::CurveDoubt;
use super::band::{Placed, nearest};
use super::edges::Edges;

/// The most of the rows that may be outliers.
const MOST: f64 = 0.2;

/// Outliers that may lie as near to each other as samples do.
const CLUSTER_MOST: usize = 9;

/// How near outliers must be to each other to be linked, over the gap that 95 of 100 samples have at most to the next.
const LINK: f64 = 1.5;

/// Outliers nearer to the curve than this times the band are its own: noise has tails.
const OWN: f64 = 2.0;

/// The first reason to think that outliers are more than that, `gaps` being those between samples and `band` that of the noise.
pub(super) fn doubt(
    edges: &Edges,
    placed: &Placed,
    mut gaps: Vec<f64>,
    band: f64,
) -> Option<CurveDoubt> {
    let outliers = placed.outliers.len();
    let rows = outliers + placed.inliers.len();
    if outliers as f64 > MOST * rows as f64 {
        return Some(CurveDoubt::Outliers { outliers: outliers as u64, rows: rows as u64 });
    }
    gaps.sort_by(f64::total_cmp);
    let usual = gaps.get(gaps.len() * 19 / 20).copied().unwrap_or(0.0);
    let link = band.max(LINK * usual);
    let far: Vec<(usize, [f64; 2])> = placed
        .outliers
        .iter()
        .filter(|(_, place)| nearest(edges, *place, OWN * band).is_none())
        .copied()
        .collect();
    cluster(&far, link)
}

/// The first cluster of too many points that are linked one by one.
fn cluster(points: &[(usize, [f64; 2])], link: f64) -> Option<CurveDoubt> {
    // Two points of a cell are linked, so a cell of many is a cluster; else there are few pairs to look at.
    let side = link / 2f64.sqrt();
    let mut cells: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
    for (at, (row, place)) in points.iter().enumerate() {
        let cell = cells.entry(place.map(|x| (x / side).floor() as i64)).or_default();
        cell.push(at);
        if cell.len() > CLUSTER_MOST {
            let row = points[cell[0]].0.min(*row) as u64;
            return Some(CurveDoubt::Cluster { row, rows: cell.len() });
        }
    }
    let (mut parent, mut size): (Vec<usize>, Vec<usize>) =
        ((0..points.len()).collect(), vec![1; points.len()]);
    for (&[x, y], cell) in &cells {
        for &one in cell {
            for (i, j) in (-2..=2).flat_map(|i| (-2..=2).map(move |j| (i, j))) {
                let near = cells.get(&[x.saturating_add(i), y.saturating_add(j)]);
                for &other in near.into_iter().flatten().filter(|&&other| other < one) {
                    let [p, q] = [points[one].1, points[other].1];
                    if (p[0] - q[0]).hypot(p[1] - q[1]) > link {
                        continue;
                    }
                    let (a, b) = (root(&mut parent, one), root(&mut parent, other));
                    let (first, second) = (a.min(b), a.max(b));
                    if first == second {
                        continue;
                    }
                    parent[second] = first;
                    size[first] += size[second];
                    if size[first] > CLUSTER_MOST {
                        let (row, rows) = (points[first].0 as u64, size[first]);
                        return Some(CurveDoubt::Cluster { row, rows });
                    }
                }
            }
        }
    }
    None
}

fn root(parent: &mut [usize], mut at: usize) -> usize {
    while parent[at] != at {
        parent[at] = parent[parent[at]];
        at = parent[at];
    }
    at
}
