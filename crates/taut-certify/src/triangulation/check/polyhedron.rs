//! The hull of tetrahedra: one convex surface, winding once around the points.
//!
//! *Proof.* Let the triangles with a tetrahedron on one side only satisfy:
//! 1. across each edge of each of them there is just one other, which runs along it the other way;
//! 2. no dent at any edge: the triangle beyond it does not rise above the plane, and unfolds where it lies in it;
//! 3. each vertex of the first tetrahedron, and the lexicographically smallest site v, is on no outer side of any of them;
//! 4. no other vertex has the place of v; v is a vertex of the surface, the triangles around it form one cycle, and the
//!    directions from v to the next vertices of this cycle have one local minimum.
//!
//! By 3 the centroid o of the first tetrahedron is strictly inside every triangle, so seen from o every triangle shows
//! its inner side; by 1 the view from o is a covering of the sphere of directions, unbranched but at vertices, by each
//! of the parts that hang together. How many sheets are there? Follow the ray from o through v. A triangle met before v
//! would have v on its outer side, against 3; a triangle that contains v but does not end there, or that is met beyond
//! v, would contain a convex combination of sites that is not larger than v, against the choice of v. So all sheets
//! over this direction meet in the place of v, hence, by 4, in the one vertex v, and their number is how often the
//! cycle around v winds. By 2 the cycle, cut by a plane beside v, is a polygon that only turns left, so it winds once
//! for each local minimum: once. So the surface is one part, seen once in every direction, and without dents it bounds
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

/// Triangles that are looked at together.
const BATCH: usize = 1 << 9;

/// A closed surface of triangles, counter-clockwise from outside.
struct Surface<'a> {
    sites: &'a Sites<'a, 3>,
    signs: &'a Signs,
    triangles: Vec<[u32; 3]>,
    neighbors: Vec<[u32; 3]>,
}

/// Checks the surface of these triangles, around `first`.
pub(super) fn check(
    sites: &Sites<'_, 3>,
    signs: &Signs,
    first: &[u32; 4],
    triangles: Vec<[u32; 3]>,
) -> Result<(), MeshViolation> {
    let broken = |row: u32| MeshViolation::HullOpen { dimension: 3, row };
    let neighbors = pairing::pair(&triangles, sites.rows()).map_err(|violation| {
        let at = match violation {
            MeshViolation::Shared { simplex, .. } => triangles[simplex][0],
            _ => 0,
        };
        broken(at)
    })?;
    if let Some(open) = neighbors.as_flattened().iter().position(|&n| n == NO_NEIGHBOR) {
        return Err(broken(triangles[open / 3].facet(open % 3)[0]));
    }
    let surface = Surface { sites, signs, triangles, neighbors };
    let smallest = sites.smallest();
    let [a, b, c, d] = *first;
    surface.is_convex_around(&[a, b, c, d, smallest])?;
    if let Some(twin) = sites.twin_of(smallest) {
        return Err(MeshViolation::HullWinding { row: twin });
    }
    surface.winds_once(smallest)
}

impl Surface<'_> {
    /// There is no dent, and none of these sites is on the outer side of a triangle.
    fn is_convex_around(&self, of: &[u32]) -> Result<(), MeshViolation> {
        let of: Vec<(u32, [f64; 3])> = of.iter().map(|&v| (v, self.sites.point(v))).collect();
        let mut planes = Vec::with_capacity(BATCH);
        let mut edges = vec![(0, 0); 3 * BATCH + 1];
        for first in (0..self.triangles.len()).step_by(BATCH) {
            let batch = first..self.triangles.len().min(first + BATCH);
            planes.clear();
            // Which of two triangles has the smaller number nobody can foretell, so no branch depends on it: each edge
            // is listed once.
            let mut count = 0;
            for number in batch {
                planes.push(Plane::of(&self.sites.gather(&self.triangles[number])));
                for (edge, &neighbor) in self.neighbors[number].iter().enumerate() {
                    edges[count] = (number, edge);
                    count += usize::from(neighbor as usize > number);
                }
            }
            for (number, plane) in (first..).zip(&planes) {
                self.is_beneath(number, plane, &of)?;
            }
            for &(number, edge) in &edges[..count] {
                self.is_no_dent(number, edge, &planes[number - first])?;
            }
        }
        Ok(())
    }

    /// None of these sites is on the outer side of a triangle.
    #[inline(always)]
    fn is_beneath(
        &self,
        number: usize,
        plane: &Plane,
        of: &[(u32, [f64; 3])],
    ) -> Result<(), MeshViolation> {
        for &(site, point) in of {
            let triangle = &self.triangles[number];
            if self.is_surely_beneath(plane, &point) || triangle.contains(&site) {
                continue;
            }
            let [a, b, c] = self.sites.gather(triangle);
            if self.signs.orientation::<Tetrahedra, 3, 4>(&[a, b, c, point]).is_gt() {
                return Err(MeshViolation::HullWinding { row: site });
            }
        }
        Ok(())
    }

    /// The triangle beyond an edge neither rises above the plane nor is folded onto the triangle.
    #[inline(always)]
    fn is_no_dent(&self, number: usize, edge: usize, plane: &Plane) -> Result<(), MeshViolation> {
        let triangle = &self.triangles[number];
        let [a, b] = triangle.facet(edge);
        let beyond = &self.triangles[self.neighbors[number][edge] as usize];
        let is_far = |place: usize| usize::from((beyond[place] != a) & (beyond[place] != b));
        let row = beyond[is_far(1) + 2 * is_far(2)];
        let d = self.sites.point(row);
        let corners = || {
            let corners = self.sites.gather(triangle);
            let [a, b, c] = [1, 2, 0].map(|k| corners[(edge + k) % 3]);
            [a, b, c, d]
        };
        if !self.is_surely_beneath(plane, &d) && is_dent(self.signs, &corners()) {
            return Err(MeshViolation::HullDent { ridge: vec![a, b], row });
        }
        Ok(())
    }

    /// Plain arithmetic settles nearly all.
    #[inline(always)]
    fn is_surely_beneath(&self, plane: &Plane, point: &[f64; 3]) -> bool {
        self.signs.is_filtered && plane.is_beneath(point)
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
        let is_smaller = |a: &[f64; 3], b: &[f64; 3]| is_before(self.signs, apex, a, b);
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

/// Tests whether d, beyond the edge ab of the triangle abc, rises above the triangle or is folded onto it.
pub(super) fn is_dent(signs: &Signs, corners: &[[f64; 3]; 4]) -> bool {
    match signs.orientation::<Tetrahedra, 3, 4>(corners) {
        Ordering::Greater => true,
        Ordering::Equal => !unfolds(signs, corners),
        Ordering::Less => false,
    }
}

/// Tests whether c and d, in one plane with the edge ab, lie on either side of it.
fn unfolds(signs: &Signs, [a, b, c, d]: &[[f64; 3]; 4]) -> bool {
    // One projection in which abc is not flat shows the plane as it is.
    [[0, 1], [0, 2], [1, 2]].into_iter().any(|axes| {
        let beside = turn(signs, a, b, c, axes);
        beside.is_ne() && turn(signs, b, a, d, axes) == beside
    })
}

/// Tests whether the direction from the lexicographically smallest point to a comes before the one to b: a total order.
pub(super) fn is_before(signs: &Signs, smallest: &[f64; 3], a: &[f64; 3], b: &[f64; 3]) -> bool {
    // By y/x, then z/x, of the directions, where x is not 0 but leans infinitesimally towards y, and infinitely less
    // towards z: positive for all of them, as the point is the smallest.
    let turns = [[0, 1], [2, 1], [0, 2]].map(|axes| turn(signs, smallest, a, b, axes));
    turns.into_iter().find(|turn| turn.is_ne()) == Some(Ordering::Greater)
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
        let sites = Sites::of(&input);
        let mut recent = Recent::new(simplices.len());
        recent.want(simplices.iter().copied());
        recent.bring(&sites);
        let tetrahedra: &[[u32; 4]] = simplices.as_chunks().0;
        for tetrahedron in tetrahedra {
            let points = sites.gather(tetrahedron);
            assert!(input.signs().orientation::<Tetrahedra, 3, 4>(&points).is_gt());
        }
        let neighbors = pairing::pair(tetrahedra, sites.rows()).unwrap();
        let facets = (0..tetrahedra.len()).flat_map(|t| (0..4).map(move |i| (t, i)));
        let open: Vec<[u32; 3]> = facets
            .filter(|&(t, i)| neighbors[t][i] == NO_NEIGHBOR)
            .map(|(t, i)| tetrahedra[t].facet(i))
            .collect();
        assert_eq!(open.len(), 2 * edges.len());
        check(&sites, &input.signs(), &tetrahedra[0], open)
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
        let sites = Sites::of(&input);
        let mut recent = Recent::new(simplices.len());
        recent.want(simplices.iter().copied());
        recent.bring(&sites);
        let tetrahedra: &[[u32; 4]] = simplices.as_chunks().0;
        let triangles: Vec<[u32; 3]> =
            tetrahedra.iter().flat_map(|t| [t.facet(2), t.facet(3)]).collect();
        let neighbors = pairing::pair(&triangles, sites.rows()).unwrap();
        assert!(!neighbors.as_flattened().contains(&NO_NEIGHBOR));
        let surface = Surface { sites: &sites, signs: &input.signs(), triangles, neighbors };
        assert_eq!(surface.is_convex_around(&[]), Ok(()));
        assert_eq!(sites.smallest(), 0);
        assert!(surface.winds_once(sites.smallest()).is_err());
    }
}
