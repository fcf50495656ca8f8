//! How far around a vertex φ is sought: several times the gaps near it.
//!
//! What ε is asked for needs no more, and circles that have a thousand vertices on their border would take as long for each vertex.

use super::features::around;

/// The sight over a gap beside it. One vertex past a gap counts for it, so that no ε below 1/16 is told.
const SIGHT_RATIO: f64 = 9.0;

/// For vertices at `way` along a closed curve, with the way around as the last entry: the largest, over all gaps, of so many times the
/// gap less the way there, and no more than the radius of a circle as long as the curve.
pub(super) fn sight(way: &[f64]) -> Vec<f64> {
    let n = way.len() - 1;
    let (gap, most) = (|k: usize| way[k + 1] - way[k], way[n] / std::f64::consts::TAU);
    let of = |k: usize| (SIGHT_RATIO * gap(k).max(gap((k + n - 1) % n))).min(most);
    let mut sight: Vec<f64> = (0..n).map(of).collect();
    around(way, |from, to, gap| {
        let is_more = sight[from] - gap > sight[to];
        if is_more {
            sight[to] = sight[from] - gap;
        }
        is_more
    });
    sight
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_long_gap_is_seen_from_around() {
        // 100 gaps of 1, one of 7.
        let mut way: Vec<f64> = (0..=100).map(f64::from).collect();
        way.push(107.0);
        let found = sight(&way);
        let most = 107.0 / std::f64::consts::TAU;
        for (k, &sight) in found.iter().enumerate() {
            let away = (100 - k).min(k) as f64;
            assert_eq!(sight, (most - away).max(SIGHT_RATIO), "{k}");
        }
    }
}
