//! The evidence for a homeomorphism, figure by figure.

use std::collections::HashSet;

use taut::Solution;
use taut::certify::Curve;
use taut::certify::{CurveDoubt, CurveVerdict};

use super::doubts::{Gaps, Scene};
use super::lists::{apart, is_exact, key, projection};
use super::planar::Point;
use super::{Edge, Judged, Stop, ensure};

/// Fewest rows of a curve of which evidence is told, where vertices are rows and else.
const ROWS_MIN: [usize; 2] = [24, 128];

/// Relative error of a distance here.
const ROUNDING: f64 = 1e-12;

pub(super) fn judge(
    solution: &Solution<Curve>,
    verdict: &CurveVerdict,
    edges: &[Edge],
    rows: &[Point],
) -> Judged {
    let curve = &solution.answer;
    let unknown = |is_told: bool, why: &str| {
        let is_unknown =
            verdict.sampling_ratio == f64::INFINITY && verdict.noise_ratio == f64::INFINITY;
        ensure(is_told && is_unknown, || format!("{why}, but told is {verdict:?}"))
    };
    let doubt = verdict.doubt;
    if curve.curves.is_empty() {
        return unknown(doubt == Some(CurveDoubt::Empty), "there are no curves");
    }
    if !verdict.is_simple {
        return unknown(matches!(doubt, Some(CurveDoubt::Crossing { .. })), "edges meet");
    }
    if solution.certificate.tour.is_some() {
        return unknown(doubt == Some(CurveDoubt::Tour), "it is a tour");
    }
    if let Some(curve) = curve.curves.iter().position(|one| !one.closed) {
        return unknown(doubt == Some(CurveDoubt::Open { curve }), "a curve is open");
    }
    let counts = counts(curve, edges, rows);
    let least = ROWS_MIN[usize::from(!is_exact(curve))];
    // Rows in the middle between two curves count for either.
    if let Some(first) = counts.iter().position(|&[_, most]| most < least) {
        let is_told = match doubt {
            Some(CurveDoubt::Few { curve, rows, least: told }) => {
                let [from, to] = counts.get(curve).copied().unwrap_or([1, 0]);
                told == least && (from..=to).contains(&rows) && rows < least && curve <= first
            }
            _ => false,
        };
        return unknown(is_told, "a curve has few rows");
    }
    if !is_exact(curve) {
        return Err(Stop::Unknown("evidence for noisy samples".into()));
    }
    ensure(verdict.noise_ratio == 0.0, || "the noise of vertices that are rows".into())?;
    let scene = Scene::of(curve, edges, rows).map_err(Stop::Unknown)?;
    let gaps = scene.gaps();
    ratios(verdict, &gaps)?;
    scene.judge(verdict.doubt, &gaps)
}

/// The largest ratio is the one told.
fn ratios(verdict: &CurveVerdict, gaps: &Gaps) -> Judged {
    let all = || gaps.ratios.iter().flatten();
    let [low, high] = [0, 1].map(|k| all().map(|ratio| ratio[k]).fold(0.0, f64::max));
    let told = verdict.sampling_ratio;
    ensure(told >= low && told <= high, || {
        format!("the sampling ratio is told to be {told}, and is from {low} to {high}")
    })
}

/// For each curve the least and the most distinct rows that are nearest to it and no outliers.
fn counts(curve: &Curve, edges: &[Edge], rows: &[Point]) -> Vec<[usize; 2]> {
    let mut counts = vec![[0; 2]; curve.curves.len()];
    let mut seen = HashSet::new();
    for (row, &p) in (0u64..).zip(rows) {
        if curve.outliers.binary_search(&row).is_ok() || !seen.insert(key(p)) {
            continue;
        }
        let mut nearest = vec![f64::INFINITY; counts.len()];
        for edge in edges {
            let distance = apart(p, edge.ends, projection(p, edge.ends));
            nearest[edge.curve] = nearest[edge.curve].min(distance);
        }
        let least = nearest.iter().fold(f64::INFINITY, |least, &x| least.min(x));
        let size = p.iter().chain(edges.iter().flat_map(|edge| edge.ends.as_flattened()));
        let size = size.fold(0.0f64, |most, x| most.max(x.abs()));
        let is_near = |distance: f64| distance <= least + ROUNDING * (least + size);
        let near: Vec<usize> = (0..counts.len()).filter(|&k| is_near(nearest[k])).collect();
        near.iter().for_each(|&k| counts[k][1] += 1);
        if let [only] = near[..] {
            counts[only][0] += 1;
        }
    }
    counts
}
