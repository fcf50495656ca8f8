//! A triangulation of space as the two sides of each of its facets.
//!
//! *Idea.* The facet opposite vertex i of cell c, seen from that cell, is the *side* `c << 2 | i`; its corners are listed so that
//! their normal points into c. So a side is an oriented triangle, its mirror is the same triangle turned over, and the room outside
//! the hull has cells like any other: the ghosts.
//! *Guarantee.* Cells are numbered as the triangulation was built, which depends on threads: nothing may be decided by these numbers.
//! Sites are numbered by the point set alone.
//! Coordinates are scaled by a power of two, so that their products neither overflow nor vanish; a set that spans too many exponents
//! for that is left as it is, and exact signs take longer.

use taut_delaunay::{GHOST, Space, decode};
use taut_points::{exponent_of, times_two_to};

use super::check_span;
use crate::Error;

/// A facet seen from one of its cells: `cell << 2 | place of the vertex opposite`.
pub(super) type Side = u32;

/// The corners of the facet opposite each vertex of a positive tetrahedron, their normal pointing in.
const INWARD: [[usize; 3]; 4] = [[3, 2, 1], [2, 3, 0], [3, 1, 0], [1, 2, 0]];

/// The cells of a triangulation that spans space, ghosts included, and its sites.
pub(super) struct Sides {
    vertices: Vec<[u32; 4]>,
    across: Vec<[Side; 4]>,
    /// Of each site, scaled.
    pub(super) points: Vec<[f64; 3]>,
    exponent: i32,
}

impl Sides {
    /// Those of a triangulation; `lengths` are to be scaled with it.
    pub(super) fn of(space: &Space, lengths: &[f64]) -> Result<Self, Error> {
        check_span(space)?;
        let slots = space.slots();
        let mut number = vec![0; slots.len()];
        let mut count = 0;
        for (slot, simplex) in slots.iter().enumerate() {
            number[slot] = count;
            count += u32::from(simplex.is_live());
        }
        let (mut vertices, mut across) = (Vec::new(), Vec::new());
        vertices.reserve_exact(count as usize);
        across.reserve_exact(count as usize);
        for simplex in slots.iter().filter(|simplex| simplex.is_live()) {
            vertices.push(simplex.vertices);
            across.push(simplex.neighbors.map(|code| {
                let (slot, place) = decode(code);
                number[slot as usize] << 2 | place as u32
            }));
        }
        let mut points: Vec<_> = (0..space.site_count() as u32).map(|s| space.site(s)).collect();
        let exponent = scale(&mut points, lengths);
        Ok(Self { vertices, across, points, exponent })
    }

    /// A length in the unit of the points.
    pub(super) fn scaled(&self, length: f64) -> f64 {
        times_two_to(length, -self.exponent)
    }

    /// A length in the unit of the input, not less than it was.
    pub(super) fn unscaled_up(&self, length: f64) -> f64 {
        let back = times_two_to(length, self.exponent);
        if self.scaled(back) < length { back.next_up() } else { back }
    }

    pub(super) fn cell_count(&self) -> usize {
        self.vertices.len()
    }

    /// The sites of a cell in positive order; one of a ghost's is [`GHOST`].
    pub(super) fn cell(&self, cell: u32) -> [u32; 4] {
        self.vertices[cell as usize]
    }

    pub(super) fn is_ghost(&self, cell: u32) -> bool {
        self.cell(cell).contains(&GHOST)
    }

    /// The points of a cell, which is no ghost.
    pub(super) fn corners(&self, cell: u32) -> [[f64; 3]; 4] {
        self.cell(cell).map(|site| self.points[site as usize])
    }

    /// The facet turned over.
    pub(super) fn mirror(&self, side: Side) -> Side {
        self.across[(side >> 2) as usize][(side & 3) as usize]
    }

    /// The vertex opposite, [`GHOST`] outside the hull.
    pub(super) fn apex(&self, side: Side) -> u32 {
        self.vertices[(side >> 2) as usize][(side & 3) as usize]
    }

    /// The corners, with a normal that points into the cell.
    pub(super) fn triangle(&self, side: Side) -> [u32; 3] {
        let vertices = self.cell(side >> 2);
        INWARD[(side & 3) as usize].map(|i| vertices[i])
    }

    /// The corners in the order of their numbers.
    pub(super) fn sorted(&self, side: Side) -> [u32; 3] {
        let mut sites = self.triangle(side);
        sites.sort_unstable();
        sites
    }

    /// The finite ones of the vertices opposite on both sides: one or two.
    pub(super) fn apexes(&self, side: Side) -> impl Iterator<Item = u32> {
        [self.apex(side), self.apex(self.mirror(side))].into_iter().filter(|&site| site != GHOST)
    }

    /// The same facet from the first of its two sides, which has no meaning but that it is one.
    pub(super) fn either(&self, side: Side) -> Side {
        side.min(self.mirror(side))
    }

    /// One side of each finite facet of a cell that has the facet on its books: the one with the lower number of its two.
    pub(super) fn facets_of(&self, cell: u32) -> impl Iterator<Item = Side> {
        let of = (0..4).map(move |i| cell << 2 | i);
        of.filter(|&side| self.either(side) == side && !self.triangle(side).contains(&GHOST))
    }

    pub(super) fn facet_count(&self) -> usize {
        (0..self.cell_count() as u32).map(|cell| self.facets_of(cell).count()).sum()
    }

    /// Turns from a side about one of its edges, u and v being its first and last corner and w the third one: to the other facet of
    /// the cell that has the edge, seen from there.
    pub(super) fn turned(&self, side: Side, w: u32) -> Side {
        let cell = side >> 2;
        let place = self.cell(cell).iter().position(|&site| site == w).unwrap_or(0);
        cell << 2 | place as u32
    }
}

/// Divides all by the power of two next to the largest magnitude, if that loses nothing; the exponent, 0 if nothing was done.
fn scale(points: &mut [[f64; 3]], lengths: &[f64]) -> i32 {
    let all = points.as_flattened();
    let largest = all.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let exponent = exponent_of(largest);
    let survives = |&x: &f64| times_two_to(times_two_to(x, -exponent), exponent) == x;
    if exponent == 0 || !all.iter().chain(lengths).all(survives) {
        return 0;
    }
    points.as_flattened_mut().iter_mut().for_each(|x| *x = times_two_to(*x, -exponent));
    exponent
}

#[cfg(test)]
mod tests {
    use taut_delaunay::DelaunayOptions;
    use taut_points::Points;
    use taut_predicates::space::orient;

    use super::*;

    #[test]
    fn normals_point_into_cells() {
        let cube: Vec<f64> =
            (0..8).flat_map(|i| [i & 1, i >> 1 & 1, i >> 2]).map(|x| 1e-9 * f64::from(x)).collect();
        let points = Points::new(&cube, 3).expect("whole rows");
        let space = Space::build(&points, &DelaunayOptions::default());
        let sides = Sides::of(&space.expect("finite"), &[]).expect("a cube spans space");
        assert!(sides.exponent < -20);
        let mut facets = 0;
        for cell in 0..sides.cell_count() as u32 {
            facets += sides.facets_of(cell).count();
            for side in (0..4).map(|i| cell << 2 | i) {
                assert_eq!(sides.mirror(sides.mirror(side)), side);
                assert_eq!(sides.sorted(side), sides.sorted(sides.mirror(side)));
                if !sides.is_ghost(cell) {
                    let p = |site: u32| sides.points[site as usize];
                    let [a, b, c] = sides.triangle(side).map(p);
                    assert!(orient(a, b, c, p(sides.apex(side))).is_positive());
                }
            }
        }
        // Twelve triangles of the hull, and half of what else the cells have.
        let cells = (0..sides.cell_count() as u32).filter(|&c| !sides.is_ghost(c)).count();
        assert_eq!(facets, (4 * cells + 12) / 2);
    }

    #[test]
    fn scaling_loses_nothing() {
        let mut points = [[3e300, -1.0, 0.0]];
        assert_eq!(scale(&mut points, &[]), 998);
        assert_eq!(points[0][0].abs().log2().floor(), 0.0);
        let mut points = [[3e300, f64::from_bits(1), 0.0]];
        assert_eq!(scale(&mut points, &[]), 0);
    }
}
