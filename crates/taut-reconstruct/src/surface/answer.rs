//! The surface in terms of the rows of the input, with its certificate.

use std::collections::BTreeMap;

use taut_certify::{
    Solution, Stop, Surface, SurfaceCertificate, SurfaceComponent, SurfaceMethod,
    SurfaceMode as Promise, SurfaceTopology, TopologyDoubt, Trace, Unused,
};
use taut_delaunay::Space;
use taut_mesh::{Topology, TriangleMesh, self_intersections, topology};
use taut_points::{InputError, PointsHash};

use super::cells::Cells;
use super::changes::Changes;
use super::circles;
use super::doubts::Doubts;
use super::facing;
use super::outward;
use super::scaled::Scale;
use super::spheres::Point;
use super::witness::{located, witnesses};
use crate::Error;

/// The facets that a method found, in terms of sites.
#[derive(Clone, Debug, Default)]
pub(super) struct Facets {
    /// Delaunay facets, counter-clockwise from outside.
    pub(super) triangles: Vec<[u32; 3]>,
    /// For each of them a cell that has it and its place there, if that is known.
    pub(super) facets: Option<Vec<u32>>,
    /// True if closed parts face outwards, or inwards if they are inside others, by construction. Else they are turned.
    pub(super) is_outward: bool,
    /// Where that is known, for sites that no triangle has whether they are inside.
    pub(super) inside: Vec<bool>,
    /// What speaks against the topology.
    pub(super) doubts: Doubts,
    /// Events worth counting.
    pub(super) counters: BTreeMap<String, u64>,
}

/// The distinct points, and the rows that they are.
pub(super) struct Sites {
    /// Scaled.
    pub(super) points: Vec<Point>,
    /// As they are, if scaling loses digits of coordinates that are very small beside the largest.
    exact: Option<Vec<Point>>,
    /// The first row of each.
    rows: Vec<u32>,
    /// Each other row with the first that it equals.
    duplicates: Vec<[u32; 2]>,
}

impl Sites {
    /// Those of a triangulation of some rows, all of them if none are named.
    pub(super) fn of(space: &Space, rows: Option<&[u32]>) -> Self {
        let row = |of_space: u32| rows.map_or(of_space, |rows| rows[of_space as usize]);
        let sites = 0..space.site_count() as u32;
        let given = || sites.clone().map(|site| space.site(site));
        let mut points: Vec<Point> = given().collect();
        let scale = Scale::of(&points);
        points.iter_mut().for_each(|point| *point = scale.apply(*point));
        let mut scaled_back = points.iter().map(|&point| scale.inverse().apply(point));
        let exact =
            (!given().all(|given| scaled_back.next() == Some(given))).then(|| given().collect());
        let copies = space.duplicates().iter();
        Self {
            points,
            exact,
            rows: sites.map(|site| row(space.row(site))).collect(),
            duplicates: copies.map(|&[copy, first]| [row(copy), row(first)]).collect(),
        }
    }

    /// In the coordinates in which exact signs are true.
    pub(super) fn exact(&self) -> &[Point] {
        self.exact.as_ref().unwrap_or(&self.points)
    }

    pub(super) fn row(&self, site: u32) -> u32 {
        self.rows[site as usize]
    }
}

pub(super) fn finish(
    method: SurfaceMethod,
    mode: Promise,
    mut facets: Facets,
    (cells, sites): (&Cells, &Sites),
    changes: Changes,
    points_hash: PointsHash,
) -> Result<Solution<Surface>, Error> {
    // Coordinates are finite and sites exist; only the number of triangles can be refused.
    let refused = |_| {
        Error::Input(InputError::TooManyPoints {
            points: sites.points.len() as u64,
            most: u64::from(u32::MAX / 6),
        })
    };
    let mesh = TriangleMesh::new(&sites.points, &facets.triangles).map_err(refused)?;
    let known = facets.facets.take();
    let known = known.unwrap_or_else(|| located(cells, &facets.triangles, sites.points.len()));
    let apexes = || match &changes.elsewhere {
        None => witnesses(cells, sites.exact(), &known, |site| sites.row(site)),
        Some(_) => Vec::new(),
    };
    let (found, apexes) = taut_points::parallel::join(|| topology(&mesh), apexes);
    let is_surface = found.is_manifold() && found.is_oriented();
    if is_surface && !facets.is_outward {
        outward::turn(cells, &mut facets.triangles, &found);
    }
    // What labels say of points holds where these are when they are labeled.
    let mut unused = unused(&facets, sites, is_surface && changes.elsewhere.is_none());
    if let Some(copies) = changes.copies {
        // Points that met when they were moved are no copies where they were given.
        let is_copy = |row: u32| copies.binary_search_by_key(&row, |pair| pair[0]).is_ok();
        let others = unused.duplicates.iter().map(|pair| pair[0]).filter(|&row| !is_copy(row));
        unused.unreferenced.extend(others);
        unused.unreferenced.sort_unstable();
        unused.duplicates = copies;
    }
    unused.outliers = changes.outliers;
    let triangles = facets.triangles.iter().map(|triangle| triangle.map(|site| sites.row(site)));
    let mut triangles: Vec<[u32; 3]> = triangles.collect();
    // Facets of one triangulation share their common edges and vertices and nothing else. In other places than those where they were
    // found they can meet, face the other way and have other circles.
    let (mut mode, mut embedded) = (mode, true);
    if let Some(places) = &changes.elsewhere {
        let mesh = TriangleMesh::new(places, &triangles).map_err(refused)?;
        embedded = self_intersections(&mesh).is_embedded();
        if is_surface && embedded {
            facing::turn(places, &mut triangles, &found);
        }
        if let Promise::Alpha { radius } = mode {
            mode = circles::promise(places, &triangles, radius);
        }
    }
    let answer = Surface { vertices: changes.moved, triangles, topology: numbers(&found), unused };
    let doubts = facets.doubts.into_iter().map(|(reason, at)| {
        let mut rows: Vec<u32> = at.into_iter().map(|site| sites.row(site)).collect();
        rows.sort_unstable();
        TopologyDoubt { reason, rows }
    });
    let certificate = SurfaceCertificate {
        method,
        mode,
        apexes,
        embedded,
        // Of what is no surface nothing is claimed.
        outward: is_surface && embedded,
        displacement: changes.displacement,
        doubts: doubts.chain(changes.doubts).collect(),
        points_hash,
    };
    let trace = Trace {
        method: method.name().into(),
        stop: Stop::Converged,
        passes: 1,
        counters: facets.counters,
        ..Trace::default()
    };
    Ok(Solution { answer, certificate, trace })
}

/// The rows that no triangle has. Where parts touch, or have a boundary, being inside is not a matter of closed parts.
pub(super) fn unused(facets: &Facets, sites: &Sites, is_surface: bool) -> Unused {
    let mut is_used = vec![false; sites.points.len()];
    let used = facets.triangles.as_flattened();
    used.iter().for_each(|&site| is_used[site as usize] = true);
    let mut rows = Unused { duplicates: sites.duplicates.clone(), ..Unused::default() };
    for site in (0..is_used.len()).filter(|&site| !is_used[site]) {
        let is_inside = is_surface && facets.inside.get(site) == Some(&true);
        let list = if is_inside { &mut rows.interior } else { &mut rows.unreferenced };
        list.push(sites.rows[site]);
    }
    rows.duplicates.sort_unstable();
    rows.interior.sort_unstable();
    rows.unreferenced.sort_unstable();
    rows
}

pub(super) fn numbers(found: &Topology) -> SurfaceTopology {
    let components = found.components.iter().map(|one| SurfaceComponent {
        first_triangle: one.first_triangle,
        vertices: one.vertices as u64,
        edges: one.edges as u64,
        triangles: one.triangles as u64,
        boundary_loops: one.boundary_loops as u64,
        orientable: one.orientable,
        genus: one.genus,
    });
    SurfaceTopology {
        vertices: found.vertices as u64,
        edges: found.edges as u64,
        boundary_edges: found.boundary_edges as u64,
        boundary_loops: found.boundary_loops.len() as u64,
        non_manifold_edges: found.non_manifold_edges as u64,
        non_manifold_vertices: found.non_manifold_vertices as u64,
        inconsistent_edges: found.inconsistent_edges as u64,
        euler_characteristic: found.euler_characteristic,
        genus: found.genus,
        components: components.collect(),
    }
}
