//! Which simplices of a cell need not be asked whether a site that was left out conflicts with them.
//!
//! Idea: sites are in Hilbert order, so a group of consecutive own sites fills a box. Call the group *clean* if no site
//! that was left out lies in its box. A simplex with all its vertices in one clean group needs no question, if all
//! other simplices at own sites are asked.
//! Proof: let a site p that was left out conflict with such a simplex σ. The simplices that p conflicts with are
//! connected through facets and include one, τ, that p lies in (or a ghost that sees it). τ is not in a clean group, as
//! it would lie in the group's box, and p with it. So on the way from τ to σ some simplex that is not in a clean group
//! shares a facet with one that is. That facet has own sites, so the former is at an own site, was asked, and no site
//! that was left out conflicts with it: a contradiction.
//! Worth: nine of ten simplices in the plane, two of three in space, each at the price of a comparison.

use std::ops::Range;

use super::index::{Bounds, Index, LEAF_SIZE, Node};

/// Groups have 2ˢ sites for these s: the large ones take most simplices, the small ones those near the border.
const SIZES: [u32; 3] = [15, 12, 9];

/// For each size which groups of own sites are clean.
pub(super) struct Clean {
    groups: [Vec<bool>; SIZES.len()],
}

impl Clean {
    /// Looks at all groups of `own`, which begins with a leaf. `missing` lists the sites of a leaf that were left out.
    pub(super) fn of<const D: usize, S: Iterator<Item = u32>>(
        index: &Index<D>,
        sites: &[[f64; D]],
        own: &Range<u32>,
        missing: impl Fn(Node) -> S,
    ) -> Self {
        let mut open = Vec::new();
        let groups = SIZES.map(|shift| {
            let leaves_each = (1 << shift) / LEAF_SIZE;
            let leaves: Vec<usize> =
                (own.start as usize / LEAF_SIZE..(own.end as usize).div_ceil(LEAF_SIZE)).collect();
            let group = |leaves: &[usize]| {
                let bounds = leaves.iter().map(|&place| *index.bounds(Node { level: 0, place }));
                let bounds = bounds.fold(Bounds::EMPTY, |all, leaf| all.union(&leaf));
                let mut clean = true;
                let meets = |index: &Index<D>, node| {
                    let run = index.run(node);
                    let own = own.start <= run.start && run.end <= own.end;
                    !own && index.bounds(node).distance_squared(&bounds) == 0.0
                };
                index.visit(&mut open, meets, |leaf| {
                    clean = missing(leaf).all(|site| !bounds.holds(sites[site as usize]));
                    !clean
                });
                clean
            };
            leaves.chunks(leaves_each).map(group).collect()
        });
        Self { groups }
    }

    /// Tests whether vertices at these places among the own sites are all in one clean group.
    #[inline(always)]
    pub(super) fn holds<const V: usize>(&self, places: [u32; V]) -> bool {
        SIZES.iter().zip(&self.groups).any(|(&shift, clean)| {
            let group = places[0] >> shift;
            places.iter().all(|&place| place >> shift == group) && clean[group as usize]
        })
    }
}
