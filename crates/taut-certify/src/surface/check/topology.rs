//! The topology of the triangles, from their rows alone.
//!
//! *Idea.* Sides of triangles sorted by their ends are edges. Triangles that share an edge are joined to components, corners that
//! share one at a vertex to fans, boundary edges that share a vertex to loops; joined with a turn, triangles tell whether a component
//! has two sides.
//! *Guarantee.* Every count is exact; O(n log n).
//! *Trap.* The formula for the genus holds for surfaces only: where a component is none, it is not evaluated.

use taut_points::OrderBy;

use super::super::{SurfaceComponent, SurfaceDoubt, SurfaceTopology, SurfaceViolation};
use super::buckets;
use super::sets::Sets;

/// A side of a triangle. Corner k of triangle t is number 3t + k.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// The lower row and the higher one.
    ends: [u32; 2],
    /// The corners at the two.
    corners: [u32; 2],
}

impl Side {
    fn triangle(&self) -> u32 {
        self.corners[0] / 3
    }

    /// Returns true if the triangle runs along it from the lower row to the higher one.
    fn rises(&self) -> bool {
        (self.corners[0] + 1) % 3 == self.corners[1] % 3
    }
}

/// The properties found.
pub(super) struct Shape {
    pub(super) topology: SurfaceTopology,
    /// For each triangle its component.
    pub(super) component: Vec<u32>,
    /// For each component whether each edge has an even number of triangles, so that there is an inside.
    pub(super) is_closed: Vec<bool>,
    /// The first edge of one triangle only.
    pub(super) bare: Option<[u32; 2]>,
    /// The first reason why this is no oriented manifold.
    pub(super) doubt: Option<SurfaceDoubt>,
}

impl Shape {
    pub(super) fn of(triangles: &[[u32; 3]], rows: usize) -> Self {
        let sides = sides(triangles, rows);
        let edges = || sides.chunk_by(|a, b| a.ends == b.ends);
        let count = triangles.len();
        let (mut together, mut turned) = (Sets::new(count), Sets::new(count));
        let mut fans = Sets::new(3 * count);
        let mut topology = SurfaceTopology::default();
        let (mut crowded, mut not_oriented, mut bare) = (None, None, None);
        let mut one_sided = vec![];
        for edge in edges() {
            topology.edges += 1;
            for pair in edge.windows(2) {
                together.join(pair[0].triangle(), pair[1].triangle(), false);
                (0..2).for_each(|k| _ = fans.join(pair[0].corners[k], pair[1].corners[k], false));
            }
            let ends = edge[0].ends;
            match edge {
                [_] => {
                    topology.boundary_edges += 1;
                    bare.get_or_insert(ends);
                }
                [one, other] => {
                    let (alike, triangles) = (one.rises() == other.rises(), [one, other]);
                    let triangles = triangles.map(Side::triangle);
                    if alike {
                        topology.inconsistent_edges += 1;
                        not_oriented.get_or_insert(SurfaceDoubt::NotOriented { triangles });
                    }
                    if !turned.join(triangles[0], triangles[1], alike) {
                        one_sided.push(triangles[0]);
                    }
                }
                more => {
                    topology.non_manifold_edges += 1;
                    let (edge, triangles) = (ends, more.len());
                    crowded.get_or_insert(SurfaceDoubt::NonManifoldEdge { edge, triangles });
                }
            }
        }
        let mut component = vec![0u32; count];
        for triangle in 0..count as u32 {
            let (first_triangle, _) = together.root(triangle);
            if first_triangle == triangle {
                component[triangle as usize] = topology.components.len() as u32;
                let new =
                    SurfaceComponent { first_triangle, orientable: true, ..Default::default() };
                topology.components.push(new);
            }
            // The least triangle of a set is its root, so it came first.
            let own = component[first_triangle as usize];
            component[triangle as usize] = own;
            topology.components[own as usize].triangles += 1;
        }
        let of = |triangle: u32| component[triangle as usize] as usize;
        let mut parts =
            vec![Part { is_manifold: true, is_closed: true }; topology.components.len()];
        one_sided.iter().for_each(|&t| topology.components[of(t)].orientable = false);
        for edge in edges() {
            let own = of(edge[0].triangle());
            topology.components[own].edges += 1;
            parts[own].is_closed &= edge.len().is_multiple_of(2);
            parts[own].is_manifold &= edge.len() <= 2;
        }
        let crowds = edges().filter(|edge| edge.len() > 2).flat_map(|edge| edge[0].ends).collect();
        let corners = Corners { triangles, rows, component: &component, fans: &mut fans };
        let pinched = corners.count(&mut topology, &mut parts, crowds);
        loops(
            edges().filter(|edge| edge.len() == 1).map(|edge| edge[0]),
            &component,
            &mut topology,
        );
        conclude(&mut topology, &parts, count);
        let one_sided = topology.components.iter().position(|one| !one.orientable);
        let one_sided = one_sided.map(|component| SurfaceDoubt::OneSided { component });
        let doubt = crowded.or(pinched).or(one_sided).or(not_oriented);
        let is_closed = parts.iter().map(|part| part.is_closed).collect();
        Shape { topology, component, is_closed, bare, doubt }
    }
}

/// Of a component.
#[derive(Clone, Copy)]
struct Part {
    is_manifold: bool,
    is_closed: bool,
}

fn sides(triangles: &[[u32; 3]], rows: usize) -> Vec<Side> {
    let mut sides = Vec::with_capacity(3 * triangles.len());
    for (triangle, own) in (0u32..).zip(triangles) {
        for k in 0..3 {
            let next = (k + 1) % 3;
            let (from, to) =
                ((own[k], 3 * triangle + k as u32), (own[next], 3 * triangle + next as u32));
            let (low, high) = (from.min(to), from.max(to));
            sides.push(Side { ends: [low.0, high.0], corners: [low.1, high.1] });
        }
    }
    buckets::sorted(&sides, rows, |side| side.ends[0])
}

/// Corners by vertex and component: each pair of these is a vertex of the component, and should be one fan.
struct Corners<'a> {
    triangles: &'a [[u32; 3]],
    rows: usize,
    component: &'a [u32],
    fans: &'a mut Sets,
}

impl Corners<'_> {
    /// Counts vertices; the first one of more than one fan. Ends of non-manifold edges are given.
    fn count(
        self,
        topology: &mut SurfaceTopology,
        parts: &mut [Part],
        mut crowds: Vec<u32>,
    ) -> Option<SurfaceDoubt> {
        crowds.sort_unstable();
        let corner =
            |(number, &row): (u32, &u32)| (row, self.component[number as usize / 3], number);
        let flat = self.triangles.as_flattened();
        let corners: Vec<(u32, u32, u32)> = (0..).zip(flat).map(corner).collect();
        let corners = buckets::sorted(&corners, self.rows, |corner| corner.0);
        let mut pinched = None;
        for at_row in corners.chunk_by(|a, b| a.0 == b.0) {
            let (row, mut fans) = (at_row[0].0, 0);
            for at_place in at_row.chunk_by(|a, b| a.1 == b.1) {
                let is_first =
                    |&&(_, _, corner): &&(u32, u32, u32)| self.fans.root(corner).0 == corner;
                let own = at_place.iter().filter(is_first).count();
                let part = at_place[0].1 as usize;
                topology.components[part].vertices += 1;
                parts[part].is_manifold &= own == 1;
                fans += own;
            }
            topology.vertices += 1;
            if fans > 1 {
                pinched.get_or_insert(SurfaceDoubt::NonManifoldVertex { row, fans });
            }
            let is_bad = fans > 1 || crowds.binary_search(&row).is_ok();
            topology.non_manifold_vertices += u64::from(is_bad);
        }
        pinched
    }
}

/// Counts loops: of the whole over its vertices, of each component over its own.
fn loops(bare: impl Iterator<Item = Side>, component: &[u32], topology: &mut SurfaceTopology) {
    let mut ends: Vec<(u32, u32, u32)> = vec![];
    for (number, side) in (0u32..).zip(bare) {
        let own = component[side.triangle() as usize];
        ends.extend(side.ends.map(|row| (row, own, number)));
    }
    ends.order();
    let (mut whole, mut own) = (Sets::new(ends.len() / 2), Sets::new(ends.len() / 2));
    for pair in ends.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        whole.join(pair[0].2, pair[1].2, false);
        if pair[0].1 == pair[1].1 {
            own.join(pair[0].2, pair[1].2, false);
        }
    }
    // The root of a set is one of its edges, which is met at both of its ends.
    let mut twice = 0u64;
    let mut twice_own = vec![0u64; topology.components.len()];
    for &(_, part, number) in &ends {
        twice += u64::from(whole.root(number).0 == number);
        twice_own[part as usize] += u64::from(own.root(number).0 == number);
    }
    topology.boundary_loops = twice / 2;
    for (one, twice) in topology.components.iter_mut().zip(twice_own) {
        one.boundary_loops = twice / 2;
    }
}

/// Draws the conclusions from the counts.
fn conclude(topology: &mut SurfaceTopology, parts: &[Part], triangles: usize) {
    let euler = |vertices: u64, edges: u64, triangles: u64| {
        vertices as i64 - edges as i64 + triangles as i64
    };
    for (one, part) in topology.components.iter_mut().zip(parts) {
        // On a surface this is a whole number from 0 on, and even if there are two sides.
        let lacking = 2 - one.boundary_loops as i64 - euler(one.vertices, one.edges, one.triangles);
        let caps = if one.orientable { lacking / 2 } else { lacking };
        one.genus = part.is_manifold.then_some(caps.unsigned_abs());
    }
    topology.euler_characteristic = euler(topology.vertices, topology.edges, triangles as u64);
    let handles = topology.components.iter().map(|one| one.genus.filter(|_| one.orientable));
    topology.genus = handles.sum();
}

/// Tests whether a topology is the one found.
pub(super) fn compare(
    claimed: &SurfaceTopology,
    found: &SurfaceTopology,
) -> Result<(), SurfaceViolation> {
    let same = |what: String, claimed: String, found: String| match claimed == found {
        true => Ok(()),
        false => Err(SurfaceViolation::Topology { what, claimed, found }),
    };
    for (what, claimed, found) in [
        ("the number of vertices", claimed.vertices, found.vertices),
        ("the number of edges", claimed.edges, found.edges),
        ("the number of boundary edges", claimed.boundary_edges, found.boundary_edges),
        ("the number of boundary loops", claimed.boundary_loops, found.boundary_loops),
        ("the number of non-manifold edges", claimed.non_manifold_edges, found.non_manifold_edges),
        (
            "the number of non-manifold vertices",
            claimed.non_manifold_vertices,
            found.non_manifold_vertices,
        ),
        ("the number of inconsistent edges", claimed.inconsistent_edges, found.inconsistent_edges),
        (
            "the number of components",
            claimed.components.len() as u64,
            found.components.len() as u64,
        ),
    ] {
        same(what.into(), claimed.to_string(), found.to_string())?;
    }
    let (one, other) = (claimed.euler_characteristic, found.euler_characteristic);
    same("the Euler characteristic".into(), one.to_string(), other.to_string())?;
    same("the genus".into(), genus(claimed.genus), genus(found.genus))?;
    let pairs = claimed.components.iter().zip(&found.components).enumerate();
    for (number, (claimed, found)) in pairs.filter(|(_, (claimed, found))| claimed != found) {
        for (what, claimed, found) in [
            ("first triangle", u64::from(claimed.first_triangle), u64::from(found.first_triangle)),
            ("number of vertices", claimed.vertices, found.vertices),
            ("number of edges", claimed.edges, found.edges),
            ("number of triangles", claimed.triangles, found.triangles),
            ("number of boundary loops", claimed.boundary_loops, found.boundary_loops),
        ] {
            let what = format!("the {what} of component {number}");
            same(what, claimed.to_string(), found.to_string())?;
        }
        let what = format!("whether component {number} is orientable");
        same(what, claimed.orientable.to_string(), found.orientable.to_string())?;
        let what = format!("the genus of component {number}");
        same(what, genus(claimed.genus), genus(found.genus))?;
    }
    Ok(())
}

fn genus(genus: Option<u64>) -> String {
    genus.map_or("none".into(), |genus| genus.to_string())
}
