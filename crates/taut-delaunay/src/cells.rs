//! Cells: the unit of work that threads share.
//!
//! Idea: a cell is a run of sites along the Hilbert curve. It triangulates them with enough of their surroundings that
//! the stars of its own sites are those of the whole (`cell`), and hands over the simplices whose smallest site it
//! owns; each simplex of the whole has exactly one smallest site, so each is handed over exactly once. Facets between
//! simplices of two cells are joined by the cell that owns the smallest site of the facet, which knows both sides.
//! Guarantee: exactly the triangulation of all sites, for any cut into cells; no locks, no floating decision.
//! Three functions, so that the same work can be done elsewhere: build the [`Index`](index::Index), assign sites to
//! cells, triangulate a cell.

mod cell;
mod clean;
mod emit;
mod geometry;
mod index;
mod reach;

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use taut_points::Monitor;

pub(crate) use cell::star_of;
pub(crate) use geometry::{ConflictZone, Geometry, InPlane, InSpace, conflicts};
pub(crate) use index::{Bounds, Index};

use crate::kernel::{Counters, Settings};
use crate::simplex::Slots;
use crate::{Error, InsertionOrder};
use cell::{Cell, SharedData};
use index::LEAF_SIZE;

/// A cell has at least this many sites of its own, unless more cells are asked for: below, halos outweigh it.
pub(crate) const fn cell_at_least(d: usize) -> usize {
    if d == 2 { 1 << 14 } else { 1 << 16 }
}

/// The triangulation of all sites by `cells` cells, on the current rayon pool. `None` if cells are of no use, as the
/// sphere of almost every simplex touches most sites.
pub(crate) fn triangulate<const D: usize, const V: usize, G: Geometry<D, V>>(
    sites: &[[f64; D]],
    cells: usize,
    start: [u32; V],
    settings: Settings,
    order: (InsertionOrder, u64),
    monitor: &Monitor<'_>,
) -> Result<Option<(Slots<V>, Counters)>, Error> {
    let index = Index::build(sites);
    let hopeless = AtomicBool::new(false);
    let whole = SharedData { sites, index: &index, start, settings, order, hopeless: &hopeless };
    let leaves = sites.len().div_ceil(LEAF_SIZE);
    let cells = cells.clamp(1, leaves);
    let cut = |k: usize| (leaves * k / cells * LEAF_SIZE).min(sites.len()) as u32;
    let done: Result<Vec<Option<Cell<V>>>, Error> = (0..cells)
        .into_par_iter()
        .with_max_len(1)
        .map(|k| whole.triangulate::<G>(cut(k)..cut(k + 1), monitor))
        .collect();
    let Some(done) = done?.into_iter().collect::<Option<Vec<Cell<V>>>>() else { return Ok(None) };
    let mut counters = Counters::default();
    done.iter().for_each(|cell| counters += cell.counters);
    Ok(Some((emit::join(done)?, counters)))
}
