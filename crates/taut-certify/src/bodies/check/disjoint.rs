//! No two bodies have an interior point in common.

use super::{BodiesViolation, ConvexBody, WEIGHT_MAX};

/// Checks the weights of each pair: Σ λ·normal = 0 and Σ λ·offset ≤ 0 over facets of both.
///
/// In the interior of both bodies Σ λ·(normal·y) < Σ λ·offset would hold, that is 0 < 0.
pub(super) fn are_disjoint(
    bodies: &[ConvexBody],
    pairs: &[Vec<u64>],
) -> Result<(), BodiesViolation> {
    let of_bodies = (0..bodies.len()).flat_map(|i| (i + 1..bodies.len()).map(move |j| [i, j]));
    for ([first, second], list) in of_bodies.zip(pairs) {
        let both = [&bodies[first], &bodies[second]];
        is_separated(both, list).map_err(|problem| BodiesViolation::Pair {
            first,
            second,
            problem,
        })?;
    }
    Ok(())
}

fn is_separated([first, second]: [&ConvexBody; 2], list: &[u64]) -> Result<(), &'static str> {
    let (pairs, rest) = list.as_chunks::<2>();
    if pairs.is_empty() || pairs.len() > 4 || !rest.is_empty() {
        return Err("expected from 1 to 4 facets, each with a weight");
    }
    let (mut normal, mut offset) = ([0i128; 3], 0i128);
    for &[facet, weight] in pairs {
        let facet = usize::try_from(facet).unwrap_or(usize::MAX);
        let (body, facet) = match facet.checked_sub(first.normals.len()) {
            None => (first, facet),
            Some(facet) => (second, facet),
        };
        let (Some(u), Some(&h)) = (body.normals.get(facet), body.offsets.get(facet)) else {
            return Err("a facet does not exist");
        };
        if !(1..=WEIGHT_MAX).contains(&weight) {
            return Err("a weight is not from 1 to 2^57");
        }
        for c in 0..3 {
            normal[c] += i128::from(weight) * i128::from(u[c]);
        }
        offset += i128::from(weight) * i128::from(h);
    }
    match normal == [0; 3] && offset <= 0 {
        true => Ok(()),
        false => Err("the facets do not separate them"),
    }
}
