//! The hull of tetrahedra: one convex surface, winding once around the points.
//!
//! *Proof.* Let the triangles with a tetrahedron on one side only satisfy:
//! 1. across each edge of each of them there is just one other, which runs along it the other way, and all hang together;
//! 2. no dent at any edge: the triangle beyond it does not rise above the plane, and unfolds where it lies in it;
//! 3. each vertex of the first tetrahedron, and the lexicographically smallest site v, is on no outer side of any of them;
//! 4. no other vertex has the place of v; v is a vertex of the surface, the triangles around it form one cycle, and the
//!    directions from v to the next vertices of this cycle have one local minimum.
//!
//! By 3 the centroid o of the first tetrahedron is strictly inside every triangle, so seen from o every triangle shows
//! its inner side; by 1 the view from o is a covering of the sphere of directions, unbranched but at vertices. How many
//! sheets has it? Follow the ray from o through v. A triangle met before v would have v on its outer side, against 3; a
//! triangle that contains v but does not end there, or that is met beyond v, would contain a convex combination of sites
//! that is not larger than v, against the choice of v. So all sheets over this direction meet in the place of v, hence, by
//! 4, in the one vertex v, and their number is how often the cycle around v winds. By 2 the cycle, cut by a plane beside v, is a polygon that only turns left, so it
//! winds once for each local minimum: once. So the surface is seen once in every direction, and without dents it bounds
//! a convex body.
//!
//! *Trap.* That no two vertices have one place follows from the tiling, which is what is to be proved here. Two rows of
//! the same point can carry a sheet each, and each winds once around its own vertex.
//! *Trap.* Euler's formula cannot take the place of 4. Five tetrahedra around one edge, each reaching 144° around it, wind
//! twice and close up: each is positive, facets pair up, there is no dent, and V − E + F = 2.
//! *Reference.* Mehlhorn, Näher, Seel, Seidel, Schilz, Schirra, Uhrig, Comput. Geom. 12, 1999, which counts by a ray that
//! has to avoid all edges.

use std::cmp::Ordering;

use super::super::{MeshViolation, NO_NEIGHBOR};
use super::facets::Facets;
use super::geometry::{Plane, Tetrahedra};
use super::input::turn;
use super::pairing;
use super::signs::Signs;
use super::sites::Sites;

/// A closed surface of triangles, counter-clockwise from outside.
struct Surface<'a> {
    sites: &'a Sites<'a, 3>,
    signs: &'a Signs,
    triangles: Vec<[u32; 3]>,
    neighbors: Vec<[u32; 3]>,
    /// The corners of each triangle: rows are in no order that memory likes.
    corners: Vec<[[f64; 3]; 3]>,
}

/// Checks the surface of the open facets, and that `listed` has just these, if it is given.
pub(super) fn check(
    sites: &Sites<'_, 3>,
    signs: &Signs,
    tetrahedra: &[[u32; 4]],
    open: &[(u32, u8)],
    listed: Option<&[u32]>,
) -> Result<(), MeshViolation> {
    let facet = |&(t, i): &(u32, u8)| tetrahedra[t as usize].facet(usize::from(i));
    if let Some(listed) = listed {
        is_listed(open, &facet, listed, sites.rows())?;
    }
    let triangles: Vec<[u32; 3]> = open.iter().map(facet).collect();
    let broken = |row: u32| MeshViolation::HullOpen { dimension: 3, row };
    let neighbors = pairing::pair(&triangles, sites.rows()).map_err(|violation| {
        let at = match violation {
            MeshViolation::Shared { simplex, .. } => triangles[simplex][0],
            _ => 0,
        };
        broken(at)
    })?;
    let corners = triangles.iter().map(|triangle| sites.gather(triangle)).collect();
    let surface = Surface { sites, signs, triangles, neighbors, corners };
    surface.is_closed()?;
    surface.is_connected()?;
    surface.has_no_dent()?;
    let smallest = sites.smallest();
    if let Some(twin) = sites.twin_of(smallest) {
        return Err(MeshViolation::HullWinding { row: twin });
    }
    let [a, b, c, d] = tetrahedra[0];
    surface.is_beneath(&[a, b, c, d, smallest])?;
    surface.winds_once(smallest)
}

fn is_listed(
    open: &[(u32, u8)],
    facet: &impl Fn(&(u32, u8)) -> [u32; 3],
    listed: &[u32],
    rows: usize,
) -> Result<(), MeshViolation> {
    let found = open.iter().enumerate().map(|(place, open)| packed(facet(open), place)).collect();
    let listed = listed.as_chunks::<3>().0.iter().enumerate();
    let claimed = listed.map(|(position, &row)| packed(row, position)).collect();
    let mut found = sorted(found, rows).into_iter().peekable();
    let mut missing = None;
    for claim in sorted(claimed, rows) {
        while let Some(before) = found.next_if(|found| found >> 32 < claim >> 32) {
            missing.get_or_insert(before);
        }
        if found.next_if(|found| found >> 32 == claim >> 32).is_none() {
            return Err(MeshViolation::HullFacet { position: claim as u32 as usize });
        }
    }
    match missing.or(found.next()) {
        Some(missing) => {
            let (simplex, facet) = open[missing as u32 as usize];
            Err(MeshViolation::Open { simplex: simplex as usize, facet: usize::from(facet) })
        }
        None => Ok(()),
    }
}

/// A triangle, whichever vertex it begins with, and its place in a list, as one number that sorts fast.
fn packed(triangle: [u32; 3], place: usize) -> u128 {
    let [a, b, c] = turned(triangle).map(u128::from);
    a << 96 | b << 64 | c << 32 | place as u128
}

/// Sorted, by counting first vertices where there are many: few triangles have the same one. Vertices that are no rows
/// come last.
fn sorted(mut triangles: Vec<u128>, rows: usize) -> Vec<u128> {
    if triangles.len() < rows / 8 {
        triangles.sort_unstable();
        return triangles;
    }
    let first = |triangle: &u128| ((triangle >> 96) as usize).min(rows);
    let mut starts = vec![0usize; rows + 2];
    for triangle in &triangles {
        starts[first(triangle) + 1] += 1;
    }
    for vertex in 0..=rows {
        starts[vertex + 1] += starts[vertex];
    }
    let mut sorted = vec![0; triangles.len()];
    for triangle in triangles {
        let place = &mut starts[first(&triangle)];
        sorted[*place] = triangle;
        *place += 1;
    }
    sorted.chunk_by_mut(|a, b| first(a) == first(b)).for_each(<[u128]>::sort_unstable);
    sorted
}

/// The same cycle, from its smallest number on.
fn turned([a, b, c]: [u32; 3]) -> [u32; 3] {
    match () {
        () if a < b && a < c => [a, b, c],
        () if b < c => [b, c, a],
        () => [c, a, b],
    }
}

impl Surface<'_> {
    fn broken(&self, row: u32) -> MeshViolation {
        MeshViolation::HullOpen { dimension: 3, row }
    }

    fn is_closed(&self) -> Result<(), MeshViolation> {
        for (triangle, neighbors) in self.triangles.iter().zip(&self.neighbors) {
            if let Some(edge) = neighbors.iter().position(|&n| n == NO_NEIGHBOR) {
                return Err(self.broken(triangle.facet(edge)[0]));
            }
        }
        Ok(())
    }

    fn is_connected(&self) -> Result<(), MeshViolation> {
        let mut reached = vec![false; self.triangles.len()];
        let mut stack: Vec<u32> = (0..self.triangles.len() as u32).take(1).collect();
        while let Some(triangle) = stack.pop() {
            if !std::mem::replace(&mut reached[triangle as usize], true) {
                stack.extend(self.neighbors[triangle as usize]);
            }
        }
        match reached.iter().position(|&reached| !reached) {
            Some(apart) => Err(self.broken(self.triangles[apart][0])),
            None => Ok(()),
        }
    }

    fn has_no_dent(&self) -> Result<(), MeshViolation> {
        // Which of two triangles has the smaller number nobody can foretell, so no branch depends on it: each edge is
        // listed once, as 4·triangle + edge.
        let mut edges = vec![0u64; self.triangles.len() * 3 / 2 + 1];
        let mut count = 0;
        for (number, neighbors) in self.neighbors.iter().enumerate() {
            for (edge, &neighbor) in neighbors.iter().enumerate() {
                edges[count] = (4 * number + edge) as u64;
                count += usize::from(neighbor as usize > number);
            }
        }
        for edge in &edges[..count] {
            let (number, edge) = ((edge / 4) as usize, (edge % 4) as usize);
            let neighbor = self.neighbors[number][edge] as usize;
            let [a, b] = self.triangles[number].facet(edge);
            let beyond = &self.triangles[neighbor];
            let is_far = |place: usize| usize::from((beyond[place] != a) & (beyond[place] != b));
            let place = is_far(1) + 2 * is_far(2);
            let (corners, d) = (&self.corners[number], &self.corners[neighbor][place]);
            if !self.is_surely_beneath(&Plane::of(corners), d) && self.is_dent(corners, edge, d) {
                return Err(MeshViolation::HullDent { ridge: vec![a, b], row: beyond[place] });
            }
        }
        Ok(())
    }

    /// None of these sites is on the outer side of a triangle.
    fn is_beneath(&self, of: &[u32]) -> Result<(), MeshViolation> {
        let of: Vec<(u32, [f64; 3])> = of.iter().map(|&v| (v, self.sites.point(v))).collect();
        for (triangle, corners) in self.triangles.iter().zip(&self.corners) {
            let plane = Plane::of(corners);
            for &(site, point) in &of {
                if self.is_surely_beneath(&plane, &point) || triangle.contains(&site) {
                    continue;
                }
                let [a, b, c] = *corners;
                if self.signs.orientation::<Tetrahedra, 3, 4>(&[a, b, c, point]).is_gt() {
                    return Err(MeshViolation::HullWinding { row: site });
                }
            }
        }
        Ok(())
    }

    /// Plain arithmetic settles nearly all.
    #[inline(always)]
    fn is_surely_beneath(&self, plane: &Plane, point: &[f64; 3]) -> bool {
        self.signs.is_filtered && plane.is_beneath(point)
    }

    /// Whether d, beyond the edge opposite corner `edge`, rises above the triangle or is folded onto it.
    fn is_dent(&self, corners: &[[f64; 3]; 3], edge: usize, d: &[f64; 3]) -> bool {
        let [a, b, c] = [1, 2, 0].map(|k| corners[(edge + k) % 3]);
        match self.signs.orientation::<Tetrahedra, 3, 4>(&[a, b, c, *d]) {
            Ordering::Greater => true,
            Ordering::Equal => !self.unfolds(&[a, b, c, *d]),
            Ordering::Less => false,
        }
    }

    /// Whether c and d, in one plane with the edge ab, lie on either side of it.
    fn unfolds(&self, [a, b, c, d]: &[[f64; 3]; 4]) -> bool {
        // One projection in which abc is not flat shows the plane as it is.
        [[0, 1], [0, 2], [1, 2]].into_iter().any(|axes| {
            let beside = turn(self.signs, a, b, c, axes);
            beside.is_ne() && turn(self.signs, b, a, d, axes) == beside
        })
    }

    fn winds_once(&self, v: u32) -> Result<(), MeshViolation> {
        let around = self.triangles.iter().filter(|triangle| triangle.contains(&v)).count();
        let Some(start) = self.triangles.iter().position(|triangle| triangle.contains(&v)) else {
            return Err(MeshViolation::HullWinding { row: v });
        };
        let mut cycle = Vec::with_capacity(around);
        let mut triangle = start;
        loop {
            let place = self.triangles[triangle].iter().position(|&site| site == v).unwrap_or(0);
            // The triangle is v, x, y; the next one shares the edge from y to v, which is opposite x.
            let x = self.triangles[triangle][(place + 1) % 3];
            cycle.push(self.sites.point(x));
            triangle = self.neighbors[triangle][(place + 1) % 3] as usize;
            if triangle == start || cycle.len() == around {
                break;
            }
        }
        let apex = &self.sites.point(v);
        let is_smaller = |a: &[f64; 3], b: &[f64; 3]| {
            // By y/x, then z/x, of the directions from v, where x is not 0 but leans infinitesimally towards y, and
            // infinitely less towards z: positive for all of them, as v is the smallest.
            let turns = [[0, 1], [2, 1], [0, 2]].map(|axes| turn(self.signs, apex, a, b, axes));
            turns.into_iter().find(|turn| turn.is_ne()) == Some(Ordering::Greater)
        };
        let count = cycle.len();
        let minima = (0..count)
            .filter(|&i| {
                let (before, at, after) =
                    (&cycle[(i + count - 1) % count], &cycle[i], &cycle[(i + 1) % count]);
                is_smaller(at, before) && is_smaller(at, after)
            })
            .count();
        if triangle == start && count == around && minima == 1 {
            return Ok(());
        }
        Err(MeshViolation::HullWinding { row: v })
    }
}

#[cfg(test)]
mod tests {
    use taut_points::{Monitor, Points, Scratch};

    use super::super::input::Input;
    use super::super::sites::Recent;
    use super::*;

    /// Tetrahedra over the axis from (0, 0, −9) to (0, 0, 9), one for each of these edges around it.
    fn around_an_axis(ring: &[[f64; 2]], edges: &[[u32; 2]]) -> Result<(), MeshViolation> {
        let mut values = vec![0.0, 0.0, -9.0, 0.0, 0.0, 9.0];
        values.extend(ring.iter().flat_map(|&[x, y]| [x, y, 0.0]));
        let points = Points::new(&values, 3).unwrap();
        let mut scratch = Scratch::new();
        let input = Input::<3>::read(&points, &mut scratch, &Monitor::silent()).unwrap();
        let simplices: Vec<u32> = edges.iter().flat_map(|&[a, b]| [a + 2, b + 2, 0, 1]).collect();
        let sites = Sites::of(&input, &simplices, 4).unwrap();
        let mut recent = Recent::new(simplices.len());
        simplices.iter().for_each(|&id| recent.want(id));
        recent.bring(&sites);
        let tetrahedra: &[[u32; 4]] = simplices.as_chunks().0;
        for tetrahedron in tetrahedra {
            let points = sites.gather(tetrahedron);
            assert!(input.signs().orientation::<Tetrahedra, 3, 4>(&points).is_gt());
        }
        let neighbors = pairing::pair(tetrahedra, sites.rows()).unwrap();
        let open: Vec<(u32, u8)> = (0..tetrahedra.len() as u32)
            .flat_map(|t| (0..4u8).map(move |i| (t, i)))
            .filter(|&(t, i)| neighbors[t as usize][usize::from(i)] == NO_NEIGHBOR)
            .collect();
        assert_eq!(open.len(), 2 * edges.len());
        check(&sites, &input.signs(), tetrahedra, &open, None)
    }

    const PENTAGON: [[f64; 2]; 5] = [[9., 0.], [3., 8.], [-7., 5.], [-7., -5.], [3., -8.]];

    #[test]
    fn a_bipyramid_is_convex() {
        let edges = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 0]];
        assert_eq!(around_an_axis(&PENTAGON, &edges), Ok(()));
    }

    /// All is as it should be around each facet and each edge, V − E + F = 2, and yet space is covered twice.
    #[test]
    fn a_surface_that_winds_twice_is_seen() {
        let star = [[0, 2], [2, 4], [4, 1], [1, 3], [3, 0]];
        let found = around_an_axis(&PENTAGON, &star);
        assert!(matches!(found, Err(MeshViolation::HullWinding { .. })), "{found:?}");
    }

    /// From a smallest site that is a tip of the surface, the cycle around it is seen to wind twice.
    #[test]
    fn the_cycle_around_the_smallest_site_is_counted() {
        let star = [[0, 2], [2, 4], [4, 1], [1, 3], [3, 0]];
        // The axis leans, so that its lower end has the smallest x.
        let leaning: Vec<[f64; 3]> = [[0.0, 0.0, -90.0], [0.0, 0.0, 90.0]]
            .into_iter()
            .chain(PENTAGON.map(|[x, y]| [x, y, 0.0]))
            .map(|[x, y, z]| [x + z, y, z])
            .collect();
        let values = leaning.as_flattened();
        let points = Points::new(values, 3).unwrap();
        let mut scratch = Scratch::new();
        let input = Input::<3>::read(&points, &mut scratch, &Monitor::silent()).unwrap();
        let simplices: Vec<u32> = star.iter().flat_map(|&[a, b]| [a + 2, b + 2, 0, 1]).collect();
        let sites = Sites::of(&input, &simplices, 4).unwrap();
        let mut recent = Recent::new(simplices.len());
        simplices.iter().for_each(|&id| recent.want(id));
        recent.bring(&sites);
        let tetrahedra: &[[u32; 4]] = simplices.as_chunks().0;
        let triangles: Vec<[u32; 3]> =
            tetrahedra.iter().flat_map(|t| [t.facet(2), t.facet(3)]).collect();
        let neighbors = pairing::pair(&triangles, sites.rows()).unwrap();
        let corners = triangles.iter().map(|triangle| sites.gather(triangle)).collect();
        let signs = &input.signs();
        let surface = Surface { sites: &sites, signs, triangles, neighbors, corners };
        assert_eq!(surface.is_closed(), Ok(()));
        assert_eq!(surface.is_connected(), Ok(()));
        assert_eq!(surface.has_no_dent(), Ok(()));
        assert_eq!(sites.smallest(), 0);
        assert!(surface.winds_once(sites.smallest()).is_err());
    }
}
