//! The certificate of each body: weights of facets that separate triangles from it, in whole numbers.
//!
//! *Idea.* For a triangle with corners v and facets j the numbers a = uⱼ·v − hⱼ form a matrix with three rows. Weights λ ≥ 0 with
//! aλ ≥ 0 exist exactly if the triangle stays out of the interior. A solution needs one facet, or two, or three that give all
//! three rows the same value.
//! *Guarantee.* Floors and ceilings of coordinates differ by at most one unit from the rounded coordinates, so that Σ λⱼuⱼ·v differs
//! by at most Σ λⱼ|uⱼ|₁. Offsets that are smaller by |uⱼ|₁ have the same weights for the mesh as given.

use taut_certify::{BodyProof, ConvexBody};
use taut_points::{OrderBy, two_to};

use super::directions::{Directions, Offsets, gcd, opposite};
use super::grow::Dop;
use super::mesh::GridMesh;
use super::polytope::{self, Sides};
use super::tree::Tree;
use crate::Error;

/// Units by which all facets are moved inward until a proof is found, at most: rounding in the search is far below one.
const INWARD_UNITS_MAX: usize = 4;

/// Bits of a weight, at most: a certificate allows weights up to 2⁵⁷.
const WEIGHT_BITS: u32 = 57;

/// Bodies with their proofs.
#[derive(Default)]
pub(super) struct Proved {
    pub(super) bodies: Vec<ConvexBody>,
    pub(super) proofs: Vec<BodyProof>,
    pub(super) pairs: Vec<Vec<u64>>,
}

/// The error of a body around a given point that cannot be proved.
pub(super) fn unproved(at: usize) -> Error {
    Error::At {
        at,
        problem: "has no body around it that could be proved: there is too little room, or facets are too few",
    }
}

/// Proves bodies one by one and leaves out those without proof, which rounding may cause for bodies of a few units.
pub(super) fn prove(
    mesh: &GridMesh,
    tree: &Tree,
    dops: Vec<Dop>,
    disjoint: bool,
) -> Result<Proved, Error> {
    let directions = &tree.directions;
    let mut kept: Vec<Offsets> = vec![];
    let mut proved = Proved::default();
    for (at, dop) in dops.into_iter().enumerate() {
        let found = prove_dop(mesh, tree, &dop, if disjoint { &kept } else { &[] });
        match found {
            Some((h, body, proof)) => {
                kept.push(h);
                proved.bodies.push(body);
                proved.proofs.push(proof);
            }
            None if dop.kept.is_some() => return Err(unproved(at)),
            None => {}
        }
    }
    if disjoint {
        for (i, one) in kept.iter().enumerate() {
            let pairs = kept[i + 1..].iter().map(|other| separation(directions, one, other));
            proved.pairs.extend(pairs.flatten());
        }
    }
    Ok(proved)
}

/// Proves that one body is inside, and disjoint from others with the same directions.
pub(super) fn prove_dop(
    mesh: &GridMesh,
    tree: &Tree,
    dop: &Dop,
    others: &[Offsets],
) -> Option<(Offsets, ConvexBody, BodyProof)> {
    let directions = &tree.directions;
    let (mut h, combined) = separated(tree, dop)?;
    if !mesh.is_exact {
        for (j, u) in directions.normals.iter().enumerate() {
            h[j] -= u.iter().map(|n| n.abs() as i32).sum::<i32>();
        }
    }
    make_disjoint(directions, &mut h, others)?;
    let sides = Sides::of_dop(directions, &h);
    let inside = inner_point(mesh, tree, &sides, &Sides::of_dop(directions, &dop.h), dop.anchor)?;
    let unit = two_to(mesh.exponent);
    let body = ConvexBody {
        normals: directions.normals.clone(),
        offsets: h[..directions.len()].iter().map(|&h| h.into()).collect(),
        volume: polytope::volume(&sides, inside) * unit * unit * unit,
    };
    Some((h, body, BodyProof { inside: inside.map(i64::from), combined }))
}

/// Moves a body inward until each triangle is separated from it; `None` where this fails.
pub(super) fn separated(tree: &Tree, dop: &Dop) -> Option<(Offsets, Vec<Vec<u64>>)> {
    let directions = &tree.directions;
    let mut h = dop.h;
    for _ in 0..=INWARD_UNITS_MAX {
        let mut combined: Vec<Vec<u64>> = vec![];
        let is_separated = tree.near(&h, |t| {
            let weights = weights(directions, &h, &tree.corners[t]);
            let entry = weights.map(|weights| {
                let row = u64::from(tree.rows[t]);
                let terms = weights.into_iter().flat_map(|(j, weight)| [j as u64, weight as u64]);
                std::iter::once(row).chain(terms).collect()
            });
            combined.extend(entry.clone());
            entry.is_some()
        });
        if is_separated {
            combined.order();
            return Some((h, combined));
        }
        h[..directions.len()].iter_mut().for_each(|h| *h -= 1);
    }
    None
}

/// Facets with positive weights that separate a triangle from a body, if there are such.
pub(super) fn weights(
    directions: &Directions,
    h: &Offsets,
    corners: &[[i32; 3]; 3],
) -> Option<Vec<(usize, i64)>> {
    let row = |j: usize| corners.map(|v| directions.along(j, v) - i64::from(h[j]));
    // A facet above which no corner lies adds nothing.
    let columns: Vec<(usize, [i64; 3])> = (0..directions.len())
        .map(|j| (j, row(j)))
        .filter(|(_, a)| a.iter().any(|&a| a > 0) || a.iter().all(|&a| a >= 0))
        .collect();
    if let Some((j, _)) = columns.iter().find(|(_, a)| a.iter().all(|&a| a >= 0)) {
        return Some(vec![(*j, 1)]);
    }
    for (at, (i, a)) in columns.iter().enumerate() {
        for (j, b) in &columns[at + 1..] {
            if let Some([one, two]) = of_two(*a, *b) {
                return Some(reduced(vec![(*i, one), (*j, two)]));
            }
        }
    }
    for (at, (i, a)) in columns.iter().enumerate() {
        for (next, (j, b)) in columns.iter().enumerate().skip(at + 1) {
            for (k, c) in &columns[next + 1..] {
                if let Some([one, two, three]) = of_three(*a, *b, *c) {
                    let terms = [(*i, one), (*j, two), (*k, three)];
                    return Some(reduced(terms.into_iter().filter(|t| t.1 > 0).collect()));
                }
            }
        }
    }
    None
}

/// Positive weights of two columns whose sum is nowhere negative.
fn of_two(a: [i64; 3], b: [i64; 3]) -> Option<[i64; 2]> {
    // The ratio of the second weight to the first is at least `low` and at most `high`, as fractions with positive divisors.
    let (mut low, mut high) = ((0, 1), None);
    let is_less = |p: (i64, i64), q: (i64, i64)| {
        i128::from(p.0) * i128::from(q.1) < i128::from(q.0) * i128::from(p.1)
    };
    for (a, b) in a.into_iter().zip(b) {
        match b.signum() {
            0 if a < 0 => return None,
            1 if is_less(low, (-a, b)) => low = (-a, b),
            -1 if high.is_none_or(|high| is_less((a, -b), high)) => high = Some((a, -b)),
            _ => {}
        }
    }
    let is_empty = high.is_some_and(|high| is_less(high, low));
    (!is_empty && low.0 > 0).then_some([low.1, low.0])
}

/// Weights of three columns, none negative, whose sum is the same in each row, and not negative; of large numbers nearly the same.
fn of_three(a: [i64; 3], b: [i64; 3], c: [i64; 3]) -> Option<[i64; 3]> {
    let row = |k: usize| [a[k], b[k], c[k]].map(i128::from);
    let minus = |p: [i128; 3], q: [i128; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let (u, v) = (minus(row(0), row(1)), minus(row(0), row(2)));
    let weights = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let sign = weights.iter().sum::<i128>().signum();
    if sign == 0 || weights.iter().any(|weight| weight * sign < 0) {
        return None;
    }
    let most = weights.iter().fold(0, |most: i128, weight| most.max(weight.abs()));
    let bits = i128::BITS - most.leading_zeros();
    let weights = weights.map(|weight| (weight * sign) >> bits.saturating_sub(WEIGHT_BITS));
    let sum = |k: usize| -> i128 { weights.iter().zip(row(k)).map(|(weight, a)| weight * a).sum() };
    (0..3).all(|k| sum(k) >= 0).then_some(weights.map(|weight| weight as i64))
}

/// The weights without common divisor.
fn reduced(terms: Vec<(usize, i64)>) -> Vec<(usize, i64)> {
    let divisor = terms.iter().fold(0, |divisor, term| gcd(divisor, term.1)).max(1);
    terms.into_iter().map(|(j, weight)| (j, weight / divisor)).collect()
}

/// Moves a body inward until it is separated from all others; `None` where this fails.
fn make_disjoint(directions: &Directions, h: &mut Offsets, others: &[Offsets]) -> Option<()> {
    for _ in 0..=INWARD_UNITS_MAX {
        if others.iter().all(|other| separation(directions, other, h).is_some()) {
            return Some(());
        }
        h[..directions.len()].iter_mut().for_each(|h| *h -= 1);
    }
    None
}

/// Facets of two bodies with weights such that their normals add up to 0 and their offsets to at most 0.
fn separation(directions: &Directions, one: &Offsets, other: &Offsets) -> Option<Vec<u64>> {
    let least = |j: usize| i64::from(one[j].min(other[j]));
    let numbered = |j: usize| if one[j] <= other[j] { j } else { directions.len() + j } as u64;
    for i in 0..directions.len() {
        if least(i) + least(opposite(i)) <= 0 {
            return Some(vec![numbered(i), 1, numbered(opposite(i)), 1]);
        }
    }
    for i in 0..directions.len() {
        for combination in &directions.combinations[opposite(i)] {
            let terms = combination.terms.iter();
            let sum: i64 = terms.map(|&(j, weight)| weight * least(j)).sum();
            if sum + combination.divisor * least(i) <= 0 {
                let terms = combination.terms.iter();
                let terms = terms.flat_map(|&(j, weight)| [numbered(j), weight as u64]);
                return Some(terms.chain([numbered(i), combination.divisor as u64]).collect());
            }
        }
    }
    None
}

/// Returns a point of the grid in the interior of a body after its facets moved inward, from which the mesh is seen, and not its
/// caps alone; `None` for a body without such a point, or outside. The center of the corners before is tried first, then the
/// anchor, which is in the interior before, then the middles between center and corners.
pub(super) fn inner_point(
    mesh: &GridMesh,
    tree: &Tree,
    after: &Sides,
    before: &Sides,
    anchor: [i32; 3],
) -> Option<[i32; 3]> {
    let corners: Vec<[f64; 3]> = polytope::facets(before, anchor).concat();
    let mean = |c: usize| corners.iter().map(|p| p[c]).sum::<f64>() / corners.len() as f64;
    let center = [0, 1, 2].map(mean);
    let rounded = |p: [f64; 3]| p.map(|x| x.round() as i32);
    let middle = |p: &[f64; 3]| rounded([0, 1, 2].map(|c| f64::midpoint(p[c], center[c])));
    let found = [rounded(center), anchor]
        .into_iter()
        .chain(corners.iter().map(middle))
        .find(|&p| after.contains(p.map(f64::from)) && mesh.sees_mesh(p))?;
    (tree.is_inside(found) == Some(true)).then_some(found)
}
