//! The directions of facets, and where facets become redundant.

use std::collections::BTreeSet;

/// Numbers of directions there are.
pub(super) const KINDS: [usize; 4] = [6, 14, 18, 26];

/// Directions of a body, at most.
pub(super) const DIRECTIONS_MAX: usize = 26;

/// One number for each direction; those beyond the number of directions are 0.
pub(super) type Offsets = [i32; DIRECTIONS_MAX];

/// uᵢ·`divisor` = Σ weight·uⱼ over the terms (j, weight), all above 0.
pub(super) struct Combination {
    pub(super) divisor: i64,
    pub(super) terms: Vec<(usize, i64)>,
}

/// The directions u₀, u₁, …, of which u₁ = −u₀, u₃ = −u₂ and so on. The first six are those of the axes.
pub(super) struct Directions {
    pub(super) normals: Vec<[i64; 3]>,
    /// The same in floating point.
    pub(super) floats: Vec<[f64; 3]>,
    /// For each direction all ways to combine it from up to three others.
    pub(super) combinations: Vec<Vec<Combination>>,
}

/// The direction against direction i.
pub(super) fn opposite(i: usize) -> usize {
    i ^ 1
}

const AXES: [[i64; 3]; 3] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const EDGES: [[i64; 3]; 6] = [[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]];
const CORNERS: [[i64; 3]; 4] = [[1, 1, 1], [1, 1, -1], [1, -1, 1], [1, -1, -1]];

impl Directions {
    /// One of [`KINDS`]: the axes, with 14 and 26 the diagonals of a cube, with 18 and 26 those of its faces.
    pub(super) fn of(kind: usize) -> Self {
        let edges: &[[i64; 3]] = if kind >= 18 { &EDGES } else { &[] };
        let corners: &[[i64; 3]] = if kind == 14 || kind == 26 { &CORNERS } else { &[] };
        let pairs = AXES.iter().chain(edges).chain(corners);
        let normals: Vec<_> = pairs.flat_map(|u| [*u, u.map(|n| -n)]).collect();
        let combinations = (0..normals.len()).map(|i| combinations(&normals, i)).collect();
        let floats = normals.iter().map(|u| u.map(|n| n as f64)).collect();
        Directions { normals, floats, combinations }
    }

    pub(super) fn len(&self) -> usize {
        self.normals.len()
    }

    /// uᵢ·p.
    pub(super) fn along(&self, i: usize, p: [i32; 3]) -> i64 {
        let u = self.normals[i];
        (0..3).map(|c| u[c] * i64::from(p[c])).sum()
    }

    /// The largest uᵢ·x of the body that the other facets bound, rounded up; `bound` where they do not bound it.
    pub(super) fn redundant_at(&self, i: usize, h: &Offsets, bound: i32) -> i32 {
        let of_one = |combination: &Combination| {
            let terms = combination.terms.iter();
            let sum: i64 = terms.map(|&(j, weight)| weight * i64::from(h[j])).sum();
            -(-sum).div_euclid(combination.divisor)
        };
        let least = self.combinations[i].iter().map(of_one).min();
        least.map_or(bound, |least| least.min(i64::from(bound)) as i32)
    }

    /// Moves redundant facets inward until they touch the body.
    pub(super) fn tighten(&self, h: &mut Offsets) {
        for i in 0..self.len() {
            h[i] = self.redundant_at(i, h, h[i]).min(h[i]);
        }
    }

    /// Whether a point of the grid is in the interior of a body.
    pub(super) fn contains(&self, h: &Offsets, p: [i32; 3]) -> bool {
        (0..self.len()).all(|j| self.along(j, p) < i64::from(h[j]))
    }
}

/// All ways to combine direction i from up to three directions other than itself and its opposite.
fn combinations(normals: &[[i64; 3]], i: usize) -> Vec<Combination> {
    let others: Vec<usize> = (0..normals.len()).filter(|&j| j != i && j != opposite(i)).collect();
    let mut found: BTreeSet<(i64, Vec<(usize, i64)>)> = BTreeSet::new();
    for (a, &j) in others.iter().enumerate() {
        for (b, &k) in others.iter().enumerate().skip(a + 1) {
            for &l in &others[b + 1..] {
                let [u, v, w] = [normals[j], normals[k], normals[l]];
                let divisor = determinant(u, v, w);
                let target = normals[i];
                let weights = [
                    determinant(target, v, w),
                    determinant(u, target, w),
                    determinant(u, v, target),
                ];
                let weights = weights.map(|weight| weight * divisor.signum());
                if divisor == 0 || weights.iter().any(|&weight| weight < 0) {
                    continue;
                }
                let all = weights.iter().fold(divisor.abs(), |all, &weight| gcd(all, weight));
                let terms = [j, k, l].into_iter().zip(weights).filter(|term| term.1 > 0);
                let terms = terms.map(|(j, weight)| (j, weight / all)).collect();
                found.insert((divisor.abs() / all, terms));
            }
        }
    }
    found.into_iter().map(|(divisor, terms)| Combination { divisor, terms }).collect()
}

fn determinant(u: [i64; 3], v: [i64; 3], w: [i64; 3]) -> i64 {
    u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
}

pub(super) fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
