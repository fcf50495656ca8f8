//! From cells to one mesh: each hands over the simplices whose smallest site it owns, and facets between cells are
//! joined.
//!
//! Idea: a cell numbers what it hands over and writes it where it belongs, neighbours of its own resolved on the spot.
//! For a facet whose two sides are not both its own, the cell that owns the facet's smallest site notes both sides by
//! their vertices; a table of the simplices along the borders turns the notes into numbers.
//! Guarantee: every facet is joined exactly once.

use std::collections::HashMap;
use std::ops::Range;

use rayon::prelude::*;

use super::cell::Cell;
use crate::Error;
use crate::simplex::{GHOST, Simplex, code, decode};

/// No number yet.
const NONE: u32 = u32::MAX;

/// One side of a facet: the vertices of its simplex in ascending order, and the vertex opposite.
#[derive(Clone, Copy)]
struct Side<const V: usize> {
    key: [u32; V],
    opposite: u32,
}

/// What a cell leaves for others while it hands over its simplices.
struct Border<const V: usize> {
    /// Facets to join.
    joints: Vec<[Side<V>; 2]>,
    /// Simplices that other cells may name, by their vertices in ascending order.
    names: HashMap<[u32; V], u32>,
}

fn sorted<const V: usize>(mut vertices: [u32; V]) -> [u32; V] {
    vertices.sort_unstable();
    vertices
}

/// The smallest vertex but the one at `except`.
fn smallest_without<const V: usize>(vertices: [u32; V], except: usize) -> u32 {
    (0..V).filter(|&i| i != except).map(|i| vertices[i]).min().unwrap_or(GHOST)
}

impl<const V: usize> Cell<V> {
    /// The sites of a simplex.
    fn global(&self, simplex: &Simplex<V>) -> [u32; V] {
        simplex.vertices.map(|v| if v == GHOST { GHOST } else { self.sites[v as usize] })
    }

    /// Whether this cell hands the simplex over.
    fn owns(&self, simplex: &Simplex<V>) -> bool {
        // Sites are numbered alike here and in the whole, but for those that came later.
        let own = |v: &u32| self.own_local.contains(v);
        let before = |v: &u32| *v != GHOST && self.sites[*v as usize] < self.own.start;
        simplex.is_live()
            && simplex.vertices.iter().any(own)
            && !simplex.vertices.iter().any(before)
    }

    /// A number for each slot that is handed over, and how many there are.
    fn numbers(&self) -> (Vec<u32>, u32) {
        let mut next = 0;
        let numbers = self.simplices.iter().map(|simplex| {
            if self.owns(simplex) {
                next += 1;
                next - 1
            } else {
                NONE
            }
        });
        (numbers.collect(), next)
    }

    /// Writes what this cell hands over to `out`, whose first simplex has number `offset` in the whole. `owner` tells
    /// which cell a site is of.
    fn hand_over(
        &self,
        numbers: &[u32],
        offset: u32,
        out: &mut [Simplex<V>],
        owner: impl Fn(u32) -> usize,
    ) -> Border<V> {
        let mut border = Border { joints: Vec::new(), names: HashMap::new() };
        for (t, simplex) in self.simplices.iter().enumerate() {
            let number = numbers[t];
            if number == NONE
                && !(simplex.is_live()
                    && simplex.vertices.iter().any(|v| self.own_local.contains(v)))
            {
                continue;
            }
            let vertices = self.global(simplex);
            let mut neighbors = [NONE; V];
            let mut inside = true;
            for i in 0..V {
                let (other, facet) = decode(simplex.neighbors[i]);
                let other_number = numbers[other as usize];
                if number != NONE && other_number != NONE {
                    neighbors[i] = code(other_number + offset, facet as u32);
                    continue;
                }
                inside = false;
                // Both sides of a facet at an own site are known here; note it from the side that comes first.
                let first = number != NONE || (other_number == NONE && (t as u32) < other);
                if first && self.own.contains(&smallest_without(vertices, i)) {
                    let there = self.global(&self.simplices[other as usize]);
                    let sides = [
                        Side { key: sorted(vertices), opposite: vertices[i] },
                        Side { key: sorted(there), opposite: there[facet] },
                    ];
                    // A cell that owns both sides has joined them itself.
                    if owner(sides[0].key[0]) != owner(sides[1].key[0]) {
                        border.joints.push(sides);
                    }
                }
            }
            if number != NONE {
                out[number as usize] = Simplex { vertices, neighbors };
                if !inside {
                    border.names.insert(sorted(vertices), number + offset);
                }
            }
        }
        border
    }
}

/// One mesh from all cells, in the order of the cells.
pub(super) fn join<const V: usize>(cells: Vec<Cell<V>>) -> Result<Vec<Simplex<V>>, Error> {
    let numbers: Vec<(Vec<u32>, u32)> =
        cells.par_iter().with_max_len(1).map(Cell::numbers).collect();
    let total: usize = numbers.iter().map(|(_, count)| *count as usize).sum();
    if total >= 1 << 30 {
        return Err(Error::TooManySimplices);
    }
    let mut mesh = vec![Simplex { vertices: [0; V], neighbors: [0; V] }; total];
    let mut rest = mesh.as_mut_slice();
    let mut offset = 0;
    let mut tasks = Vec::with_capacity(cells.len());
    for (cell, (numbers, count)) in cells.iter().zip(&numbers) {
        let (out, after) = rest.split_at_mut(*count as usize);
        tasks.push((cell, numbers, offset, out));
        (rest, offset) = (after, offset + count);
    }
    let owned: Vec<Range<u32>> = cells.iter().map(|cell| cell.own.clone()).collect();
    let owner = |site: u32| owned.partition_point(|own| own.end <= site);
    let borders: Vec<Border<V>> = tasks
        .into_par_iter()
        .with_max_len(1)
        .map(|(cell, numbers, offset, out)| cell.hand_over(numbers, offset, out, owner))
        .collect();
    drop(cells);
    let number = |side: &Side<V>| {
        *borders[owner(side.key[0])]
            .names
            .get(&side.key)
            .expect("the owner of the smallest site hands over the simplex")
    };
    let joints: Vec<[(u32, u32); 2]> = borders
        .par_iter()
        .flat_map_iter(|border| &border.joints)
        .map(|sides| [0, 1].map(|k| (number(&sides[k]), sides[k].opposite)))
        .collect();
    for [(a, opposite_a), (b, opposite_b)] in joints {
        let place = |t: u32, opposite: u32| {
            let vertices = mesh[t as usize].vertices;
            vertices.iter().position(|&v| v == opposite).expect("the vertex opposite the facet")
                as u32
        };
        let (i, j) = (place(a, opposite_a), place(b, opposite_b));
        mesh[a as usize].neighbors[i as usize] = code(b, j);
        mesh[b as usize].neighbors[j as usize] = code(a, i);
    }
    debug_assert!(mesh.iter().all(|s| !s.neighbors.contains(&NONE)));
    Ok(mesh)
}
