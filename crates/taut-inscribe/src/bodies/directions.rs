//! The directions of facets, and where facets become redundant.

use std::collections::BTreeSet;

use taut_points::InputError;

/// Numbers of directions there are.
pub(super) const KINDS: [usize; 4] = [6, 14, 18, 26];

/// Directions of a body, at most.
pub(super) const DIRECTIONS_MAX: usize = 26;

/// The sum |u₀| + |u₁| + |u₂| of a direction, at most: heights of points of the grid are below 2³⁰ then.
const DIRECTION_SUM_MAX: i64 = 63;

/// One number for each direction; those beyond the number of directions are 0.
pub(super) type Offsets = [i32; DIRECTIONS_MAX];

/// uᵢ·`divisor` = Σ weight·uⱼ over the terms (j, weight), all above 0.
pub(super) struct Combination {
    pub(super) divisor: i64,
    pub(super) terms: Vec<(usize, i64)>,
}

/// The directions u₀, u₁, …, of which u₁ = −u₀, u₃ = −u₂ and so on.
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
        Self::with_opposites(AXES.iter().chain(edges).chain(corners).copied())
    }

    /// Directions that were given, each without common divisor, and their opposites.
    ///
    /// # Errors
    /// [`InputError::Option`] for fewer than 3 directions or more than 13, for one that is 0, parallel to another or beyond
    /// [`DIRECTION_SUM_MAX`], and for directions in one plane.
    pub(super) fn given(directions: &[[i64; 3]]) -> Result<Self, InputError> {
        let wrong = |value: String, expected| {
            Err(InputError::Option { name: "direction", value, expected })
        };
        let count = directions.len();
        if !(3..=DIRECTIONS_MAX / 2).contains(&count) {
            return wrong(
                count.to_string(),
                "from 3 to 13 directions, whose opposites come by themselves",
            );
        }
        let mut reduced: Vec<[i64; 3]> = vec![];
        for &direction in directions {
            let shown = || format!("{direction:?}");
            let sum = direction.iter().fold(0i64, |sum, n| sum.saturating_add(n.saturating_abs()));
            if !(1..=DIRECTION_SUM_MAX).contains(&sum) {
                return wrong(
                    shown(),
                    "whole numbers, not all 0, whose absolute values add up to at most 63",
                );
            }
            let divisor = direction.iter().fold(0, |divisor, &n| gcd(divisor, n.abs()));
            let direction = direction.map(|n| n / divisor);
            if reduced.contains(&direction) || reduced.contains(&direction.map(|n| -n)) {
                return wrong(shown(), "directions of which no two are parallel");
            }
            reduced.push(direction);
        }
        let directions = Self::with_opposites(reduced.into_iter());
        match directions.span_space() {
            true => Ok(directions),
            false => {
                wrong(format!("{count} directions"), "directions that are not all in one plane")
            }
        }
    }

    fn with_opposites(directions: impl Iterator<Item = [i64; 3]>) -> Self {
        let normals: Vec<_> = directions.flat_map(|u| [u, u.map(|n| -n)]).collect();
        let combinations = (0..normals.len()).map(|i| combinations(&normals, i)).collect();
        let floats = normals.iter().map(|u| u.map(|n| n as f64)).collect();
        Directions { normals, floats, combinations }
    }

    pub(super) fn len(&self) -> usize {
        self.normals.len()
    }

    /// Whether the axes are among the directions.
    pub(super) fn hold_axes(&self) -> bool {
        AXES.iter().all(|axis| self.normals.contains(axis))
    }

    /// Whether the directions are not all in one plane.
    fn span_space(&self) -> bool {
        let all = &self.normals;
        all.iter().any(|&u| all.iter().any(|&v| all.iter().any(|&w| determinant(u, v, w) != 0)))
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
