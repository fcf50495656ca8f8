//! Bodies with k fixed directions, after those with fewer.
//!
//! *Guarantee.* More directions never cover fewer of the points, and one body never has less volume: the bodies of a smaller set of
//! directions are improved in the larger set, and the better result counts. Merging gives up what was allowed to be lost.

use std::sync::Arc;

use super::BodyShape;
use super::directions::{self, DIRECTIONS_MAX, Directions, Offsets};
use super::grow::{Dop, Space};
use super::merge;
use super::pack::{Input, Packing};
use super::tree::Tree;
use crate::Error;
use crate::random::Random;

/// A search with the directions of the axes stops after this part of the events: its bodies have few facets, and are a start at best.
const EVENTS_PART_OF_6: u64 = 8;

/// The part of the events that improves the bodies of a smaller set of directions.
const EVENTS_PART_OF_WARM_START: u64 = 8;

/// What a search found.
pub(super) struct Packed<B> {
    pub(super) bodies: Vec<B>,
    /// Events of this search and of those in smaller sets of directions.
    pub(super) events: u64,
    /// Points that at least one body covers.
    pub(super) covered: u64,
    /// Lines that at least one body hides.
    pub(super) hidden: u64,
    /// The points covered, or the lines hidden, as the objective has it; for one body its volume.
    value: u64,
}

/// Finds bodies with the directions of a tree, which are one of [`directions::KINDS`] or were given.
pub(super) fn pack(input: &Input<'_>, tree: &Arc<Tree>) -> Result<Packed<Dop>, Error> {
    let k = tree.directions.len();
    let mut found: Vec<(usize, Packed<Dop>)> = vec![];
    if let BodyShape::Directions(_) = input.options.shape {
        return merged(input, tree, search(input, tree, &found)?);
    }
    for kind in directions::KINDS.into_iter().filter(|&kind| kind < k && is_part(kind, k)) {
        let smaller = Arc::new(tree.turned(&Arc::new(Directions::of(kind))));
        match search(input, &smaller, &found) {
            Ok(packed) => found.push((kind, packed)),
            // More directions may have a body around a segment where fewer have none.
            Err(Error::At { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    merged(input, tree, search(input, tree, &found)?)
}

/// Merges bodies, if this is asked for.
fn merged(input: &Input<'_>, tree: &Arc<Tree>, found: Packed<Dop>) -> Result<Packed<Dop>, Error> {
    let options = input.options;
    let Some(loss) = options.merge_within else { return Ok(found) };
    let random = Random::new(options.seed ^ tree.directions.len() as u64);
    let mut packing = Packing::new(input, Space::new(tree, random, options.monitor));
    for dop in found.bodies {
        packing.push(dop);
    }
    packing.merge(loss, options.events / merge::EVENTS_PART)?;
    Ok(Packed {
        covered: packing.covered(),
        hidden: packing.hidden(),
        value: packing.value(),
        events: found.events + packing.family.events,
        bodies: packing.bodies,
    })
}

/// Whether one set of directions is part of another.
fn is_part(kind: usize, of: usize) -> bool {
    kind == of || kind == 6 || of == 26
}

/// Searches with one set of directions, after the sets that are part of it.
fn search(
    input: &Input<'_>,
    tree: &Arc<Tree>,
    smaller: &[(usize, Packed<Dop>)],
) -> Result<Packed<Dop>, Error> {
    let (k, options) = (tree.directions.len(), input.options);
    let is_of_axes = k == 6 && matches!(options.shape, BodyShape::Dop(_));
    let budget =
        if is_of_axes { options.events.div_ceil(EVENTS_PART_OF_6) } else { options.events };
    let random = Random::new(options.seed ^ k as u64);
    let mut packing = Packing::new(input, Space::new(tree, random, options.monitor));
    packing.fill(budget)?;
    let before = smaller.last().map_or(0, |(_, packed)| packed.events);
    let mut best = Packed {
        covered: packing.covered(),
        hidden: packing.hidden(),
        value: packing.value(),
        events: before + packing.family.events,
        bodies: packing.bodies,
    };
    let parts = smaller.iter().filter(|(kind, _)| is_part(*kind, k));
    if let Some((kind, packed)) = parts.max_by_key(|(_, packed)| packed.value) {
        let cold = packing.family.events;
        let mut warm = Packing::new(input, packing.family);
        for dop in &packed.bodies {
            warm.push(taken(tree, *kind, dop));
        }
        warm.improve(cold + budget / EVENTS_PART_OF_WARM_START)?;
        best.events = before + warm.family.events;
        if warm.value() > best.value {
            let (covered, hidden, value) = (warm.covered(), warm.hidden(), warm.value());
            best = Packed { covered, hidden, value, bodies: warm.bodies, ..best };
        }
    }
    Ok(best)
}

/// Takes over a body of a smaller set of directions; its new facets are redundant.
fn taken(tree: &Tree, kind: usize, dop: &Dop) -> Dop {
    let smaller = Directions::of(kind);
    let mut h: Offsets = [0; DIRECTIONS_MAX];
    for (j, u) in tree.directions.normals.iter().enumerate() {
        let old = smaller.normals.iter().position(|v| v == u);
        h[j] = old.map_or_else(|| tree.extent(j), |old| dop.h[old]);
    }
    tree.directions.tighten(&mut h);
    Dop { h, ..dop.clone() }
}
