//! The truth about Delaunay triangulations, by gift wrapping with whole numbers of any size.
//!
//! *Idea.* The triangulation is a function of the point set, so it is computed once and compared with each claim. The
//! first simplex at site 0 is found by trial; every other lies beyond a facet of one that is known.
//! *Ties.* Site p has the height |p|² + ε(p), where ε(p) is infinitely larger for the lexicographically larger of two
//! sites. The in-sphere determinant is linear in the heights, so the first coefficient that is not 0 decides, in the
//! order 1, ε(largest), ε(second), …

mod build;
mod hash;
#[cfg(test)]
mod tests;

use std::collections::HashMap;

use taut::Solution;
use taut::certify::Triangulation;
use taut::certify::{NO_NEIGHBOR, TriangulationCounts, TriangulationVerdict};
use taut::points::{Monitor, Points, PointsHash, hash_points};

use self::build::Delaunay;
use super::Truth;

/// All that is true of the triangulation of one point set.
pub(crate) struct TriangulationOracle {
    columns: usize,
    points_hash: PointsHash,
    built: Delaunay,
    counts: TriangulationCounts,
    fingerprint: u128,
}

impl TriangulationOracle {
    /// Computes the triangulation of finite points in the plane or in space.
    pub(crate) fn new(values: &[f64], columns: usize) -> Self {
        let points = Points::new(values, columns).expect("rows of equal length");
        let points_hash = hash_points(&points, &Monitor::silent()).expect("points in memory");
        let built = Delaunay::of(values, columns);
        let counts = TriangulationCounts {
            sites: built.sites as u64,
            simplices: built.simplices.len() as u64,
            hull: built.hull.len() as u64,
        };
        let fingerprint = hash::of_simplices(values, columns, &built.simplices);
        TriangulationOracle { columns, points_hash, built, counts, fingerprint }
    }

    /// Tests whether every claim of an accepted answer and of its verdict is true.
    pub(crate) fn judge(
        &self,
        solution: &Solution<Triangulation>,
        verdict: &TriangulationVerdict,
    ) -> Truth {
        match self.first_lie(solution, verdict) {
            None => Truth::True,
            Some(lie) => Truth::False(lie),
        }
    }

    fn first_lie(
        &self,
        solution: &Solution<Triangulation>,
        verdict: &TriangulationVerdict,
    ) -> Option<String> {
        let (answer, certificate) = (&solution.answer, &solution.certificate);
        let is = |what: &str, claim: &dyn std::fmt::Debug, truth: &dyn std::fmt::Debug| {
            Some(format!("{what}: {claim:?} is claimed, {truth:?} is true"))
        };
        if usize::from(answer.dimension) != self.columns {
            return is("dimension", &answer.dimension, &self.columns);
        }
        if answer.hull_dimension != self.built.dimension {
            return is("hull dimension", &answer.hull_dimension, &self.built.dimension);
        }
        if certificate.points_hash != self.points_hash {
            return Some("the hash is that of other points".into());
        }
        if answer.duplicates != self.built.duplicates {
            return is("duplicates", &answer.duplicates, &self.built.duplicates);
        }
        for (what, claim) in [("certificate", certificate.counts), ("verdict", verdict.counts)] {
            if claim != self.counts {
                return is(&format!("counts of the {what}"), &claim, &self.counts);
            }
        }
        for (what, claim) in
            [("certificate", certificate.fingerprint), ("verdict", verdict.fingerprint)]
        {
            if claim.0 != self.fingerprint {
                return is(&format!("fingerprint of the {what}"), &claim.0, &self.fingerprint);
            }
        }
        if verdict.ties != self.built.ties {
            return is("ties", &verdict.ties, &self.built.ties);
        }
        // How many signs a filter leaves open is a matter of the filter: of facets, ties among them, and orientations.
        let signs = self.built.inner_facets + self.counts.simplices;
        if !(self.built.ties..=signs).contains(&verdict.refined) {
            return is("refined", &verdict.refined, &(self.built.ties, signs));
        }
        self.lists(answer).or_else(|| self.neighbors(answer, &certificate.neighbors))
    }

    /// Returns what is wrong with the simplices or the hull.
    fn lists(&self, answer: &Triangulation) -> Option<String> {
        let width = self.built.dimension.map_or(0, usize::from);
        for (what, list, width, truth) in [
            ("simplices", &answer.simplices, width + 1, &self.built.simplices),
            ("hull", &answer.hull, width, &self.built.hull),
        ] {
            if width == 0 || list.len() != truth.len() * width {
                match list.len() == truth.len() * width {
                    true => continue,
                    false => return Some(format!("{what}: {} ids", list.len())),
                }
            }
            let rows = list.chunks(width);
            let is_same = match self.built.dimension {
                // The chain and its ends have an order.
                Some(..=1) | None => rows.zip(truth).all(|(row, truth)| row == truth),
                Some(_) => {
                    let mut rows: Vec<Vec<u32>> = rows.map(canonical).collect();
                    rows.sort_unstable();
                    rows == *truth
                }
            };
            if !is_same {
                return Some(format!("{what}: another list than the true one"));
            }
        }
        None
    }

    /// Returns what is wrong with the neighbors of simplices that are the true ones.
    fn neighbors(&self, answer: &Triangulation, claimed: &[u32]) -> Option<String> {
        if claimed.is_empty() {
            return None;
        }
        if claimed.len() != answer.simplices.len() {
            return Some("neighbors: one for each vertex of each simplex is wanted".into());
        }
        let width = answer.vertices_per_simplex().max(1);
        let facet = |simplex: &[u32], opposite: usize| {
            let mut facet = simplex.to_vec();
            facet.remove(opposite);
            facet.sort_unstable();
            facet
        };
        let mut at: HashMap<Vec<u32>, Vec<u32>> = HashMap::new();
        for (number, simplex) in (0..).zip(answer.simplices.chunks(width)) {
            for opposite in 0..width {
                at.entry(facet(simplex, opposite)).or_default().push(number);
            }
        }
        for (number, simplex) in answer.simplices.chunks(width).enumerate() {
            for opposite in 0..width {
                let around = &at[&facet(simplex, opposite)];
                let other = around.iter().find(|&&other| other as usize != number);
                let truth = other.copied().unwrap_or(NO_NEIGHBOR);
                if claimed[number * width + opposite] != truth {
                    return Some(format!("neighbor {opposite} of simplex {number} is {truth}"));
                }
            }
        }
        None
    }
}

/// A row with its ids ascending, except that the last two are exchanged if the row is an odd permutation of that.
fn canonical(row: &[u32]) -> Vec<u32> {
    let mut sorted = row.to_vec();
    let mut is_odd = false;
    for end in (1..sorted.len()).rev() {
        for k in 0..end {
            if sorted[k] > sorted[k + 1] {
                sorted.swap(k, k + 1);
                is_odd = !is_odd;
            }
        }
    }
    if let (true, [.., a, b]) = (is_odd, &mut sorted[..]) {
        std::mem::swap(a, b);
    }
    sorted
}
