//! No triangle meets the interior of a body.

use super::grid::{Boxes, COORDINATE_MAX};
use super::{BodiesViolation, ConvexBody, WEIGHT_MAX};
use crate::BodyProof;

/// Most facets of an entry: four constraints of space always do.
const COMBINED_FACETS_MAX: usize = 4;

/// The entries of a proof that are not used yet.
type Entries<'a> = std::iter::Peekable<std::iter::Enumerate<std::slice::Iter<'a, Vec<u64>>>>;

/// Facets that are tried on a group of blocks: more would take longer than they spare where the group is not far from the body.
const GROUP_FACETS: usize = 8;

/// Checks that each triangle is separated from a body, by one facet or by the entry of the proof; by one facet a group or a block of
/// them at once.
pub(super) fn is_empty(
    body: usize,
    found: &ConvexBody,
    proof: &BodyProof,
    boxes: &Boxes,
) -> Result<(), BodiesViolation> {
    let mut entries: Entries<'_> = proof.combined.iter().enumerate().peekable();
    // Neighbors in the list are mostly neighbors in space: the facets that separated last are tried first.
    let mut order: Vec<usize> = (0..found.normals.len()).collect();
    let has_entry = |entries: &mut Entries<'_>, end: usize| {
        // An entry without a number is refused where the next one is due.
        let row = entries.peek().map(|(_, entry)| entry.first().copied().unwrap_or(0));
        row.is_some_and(|row| row < end as u64)
    };
    for (of_group, low, high) in boxes.groups() {
        let tried = GROUP_FACETS.min(order.len());
        if !has_entry(&mut entries, of_group.end)
            && is_beyond(found, &mut order[..tried], low, high)
        {
            continue;
        }
        for (rows, low, high) in boxes.blocks(of_group) {
            if !has_entry(&mut entries, rows.end) && is_beyond(found, &mut order, low, high) {
                continue;
            }
            for row in rows {
                let [low, high] = [&boxes.floors[row], &boxes.ceilings[row]];
                let separates = |&facet: &usize| {
                    let (normal, offset) = (found.normals[facet], found.offsets[facet]);
                    (0..3).all(|corner| least(normal, low[corner], high[corner]) >= offset)
                };
                match entries.next_if(|(_, entry)| entry.first() == Some(&(row as u64))) {
                    Some((position, entry)) => combined(body, position, found, entry, low, high)?,
                    None => {
                        let Some(place) = order.iter().position(separates) else {
                            return Err(match row.checked_sub(boxes.rows) {
                                None => BodiesViolation::Reaches { row: row as u64, body },
                                Some(cap) => BodiesViolation::CapReaches { cap: cap as u64, body },
                            });
                        };
                        order[..=place].rotate_right(1);
                    }
                }
            }
        }
    }
    match entries.next() {
        None => Ok(()),
        Some((entry, _)) => {
            let problem = "names no triangle, or one that does not follow the triangle before";
            Err(BodiesViolation::Combined { body, entry, problem })
        }
    }
}

/// Whether a box is beyond one of some facets, which then comes first.
fn is_beyond(found: &ConvexBody, order: &mut [usize], low: &[i32; 3], high: &[i32; 3]) -> bool {
    let separates =
        |&facet: &usize| least(found.normals[facet], *low, *high) >= found.offsets[facet];
    let place = order.iter().position(separates);
    place.inspect(|&place| order[..=place].rotate_right(1)).is_some()
}

/// The least value of a linear function with small coefficients on a box. At most 3·2⁴⁶.
fn least(normal: [i64; 3], low: [i32; 3], high: [i32; 3]) -> i64 {
    debug_assert!(low.iter().chain(&high).all(|&c| i64::from(c).abs() <= COORDINATE_MAX));
    (0..3).map(|c| normal[c] * i64::from(if normal[c] > 0 { low[c] } else { high[c] })).sum()
}

/// Checks the weights of one entry: Σ λⱼ(uⱼ·y − hⱼ) ≥ 0 for the corners of the triangle, wherever they are in their boxes.
fn combined(
    body: usize,
    entry: usize,
    found: &ConvexBody,
    list: &[u64],
    low: &[[i32; 3]; 3],
    high: &[[i32; 3]; 3],
) -> Result<(), BodiesViolation> {
    let wrong = |problem| Err(BodiesViolation::Combined { body, entry, problem });
    let (pairs, rest) = list[1..].as_chunks::<2>();
    if pairs.is_empty() || pairs.len() > COMBINED_FACETS_MAX || !rest.is_empty() {
        return wrong("has not from 1 to 4 facets, each with a weight");
    }
    let (mut normal, mut offset) = ([0i128; 3], 0i128);
    for &[facet, weight] in pairs {
        let facet = usize::try_from(facet).unwrap_or(usize::MAX);
        let (Some(u), Some(&h)) = (found.normals.get(facet), found.offsets.get(facet)) else {
            return wrong("names a facet that does not exist");
        };
        if !(1..=WEIGHT_MAX).contains(&weight) {
            return wrong("has a weight that is not from 1 to 2^57");
        }
        let weight = i128::from(weight);
        for c in 0..3 {
            normal[c] += weight * i128::from(u[c]);
        }
        offset += weight * i128::from(h);
    }
    let is_separated = (0..3).all(|corner| {
        let least: i128 = (0..3)
            .map(|c| {
                let end = if normal[c] > 0 { low[corner][c] } else { high[corner][c] };
                normal[c] * i128::from(end)
            })
            .sum();
        least >= offset
    });
    match is_separated {
        true => Ok(()),
        false => wrong("does not separate the triangle from the body"),
    }
}
