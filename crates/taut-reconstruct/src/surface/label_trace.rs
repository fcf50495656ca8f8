//! How the labels of cells come about, facet by facet, for those who want to watch.
//!
//! *Idea.* Borůvka's rounds in `tree` obey the facets of a maximum spanning tree. Facets of that tree in the order of their weight are
//! those that Kruskal's algorithm obeys one by one, which is easier to follow: each joins two parts of space, until one is left.
//! *Guarantee.* What is obeyed is what `tree` obeys; the ghosts, which are one, are one cell here.

use taut_points::{Monitor, OrderBy, PointSource};

use super::answer::Sites;
use super::cells::Cells;
use super::dual_edges::{CERTAIN_STEPS, DualEdges};
use super::labeled::surface_of_labels;
use super::parity::ParityUnionFind;
use super::tree::labels;
use super::{SurfaceMode, check_dim, read, triangulated};
use crate::Error;

/// How the default method comes to a closed surface: the facets in the order in which they are processed, and the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct LabelTrace {
    /// The distinct points.
    pub sites: Vec<[f64; 3]>,
    /// The number of cells. Cell 0 is the outside of the convex hull, the others are tetrahedra.
    pub cells: usize,
    /// The facets of all tetrahedra, those of the largest weight first.
    pub facets: Vec<LabelFacet>,
    /// The triangles of the surface after all repairs, each as three sites, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// A facet of the triangulation, and what it says about its two cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LabelFacet {
    /// Its corners, counter-clockwise as seen from the second cell.
    pub sites: [u32; 3],
    /// The cells on both sides of it.
    pub cells: [u32; 2],
    /// The evidence, from −1, the surface is between the cells, to 1, both are on one side of it. Its size is the weight.
    pub evidence: f64,
    /// True if it joins two parts of space that facets of larger weights have not joined.
    pub is_obeyed: bool,
}

/// The border between labels, when some of the facets have been processed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LabelBorder {
    /// Triangles between cells known to be outside and inside, as three sites each, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Triangles between opposite cells of parts of which it is not yet known which side is outside.
    pub undecided: Vec<[u32; 3]>,
    /// The number of parts of space whose labels do not depend on each other yet.
    pub parts: usize,
}

impl LabelTrace {
    /// Returns the border between labels after the first `processed` facets.
    pub fn border(&self, processed: usize) -> LabelBorder {
        let mut parity = ParityUnionFind::new(self.cells);
        let mut border = LabelBorder { parts: self.cells, ..LabelBorder::default() };
        for facet in self.facets.iter().take(processed).filter(|facet| facet.is_obeyed) {
            let [one, other] = facet.cells;
            border.parts -= usize::from(parity.join(one, other, facet.evidence < 0.0));
        }
        for facet in &self.facets {
            let [one, other] = facet.cells.map(|cell| parity.root(cell));
            // The outside has the lowest number, so it is the root of its part.
            let list = match (one ^ other, one >> 1) {
                (1, 0) => &mut border.triangles,
                (1, _) => &mut border.undecided,
                _ => continue,
            };
            // Opposite to the outside is inside.
            let [a, b, c] = facet.sites;
            list.push(if one & 1 == 1 { [a, b, c] } else { [a, c, b] });
        }
        border
    }
}

/// Returns how the method [`Tree`](super::SurfaceMethod::Tree) comes to the closed surface through points.
///
/// ```
/// use taut_points::{Monitor, Points};
/// use taut_reconstruct::label_trace;
///
/// let octahedron = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
/// let flat: Vec<f64> = octahedron.as_flattened().iter().map(|&x| f64::from(x)).collect();
/// let trace = label_trace(&Points::new(&flat, 3)?, &Monitor::silent())?;
/// assert_eq!(trace.border(0).parts, trace.cells);
/// let border = trace.border(trace.facets.len());
/// assert_eq!((border.parts, border.triangles.len(), trace.triangles.len()), (1, 8, 8));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// It takes several times the memory of the surface itself, as it keeps all facets.
///
/// # Errors
/// As [`surface()`](super::surface()).
pub fn label_trace(source: &dyn PointSource, monitor: &Monitor<'_>) -> Result<LabelTrace, Error> {
    check_dim(source)?;
    let space = triangulated(&read(source)?, monitor)?;
    let sites: Vec<[f64; 3]> =
        (0..space.site_count() as u32).map(|site| space.site(site)).collect();
    let points = Sites::of(&space, None).points;
    let cells = Cells::of(space.into_slots(), points.len());
    monitor.check()?;
    let dual_edges = DualEdges::of(&cells, &points, true);
    let tree = labels(&dual_edges, &cells, cells.first_ghost().unwrap_or(0)).tree;
    monitor.check()?;
    // By cell, its number here.
    let mut numbers = vec![0u32; cells.len()];
    cells.finite().zip(1..).for_each(|(cell, number)| numbers[cell as usize] = number);
    let mut facets: Vec<u32> = cells
        .finite()
        .flat_map(|cell| (0..4).map(move |i| cell << 2 | i))
        .filter(|&facet| {
            let back = cells.mirror(facet);
            facet < back || cells.is_ghost(back >> 2)
        })
        .collect();
    let first = |facet: u32| facet.min(cells.mirror(facet));
    facets.order_by_key(|&facet| (!dual_edges.at(facet).key, first(facet)));
    let facet = |&facet: &u32| {
        let (cell, i) = ((facet >> 2) as usize, facet & 3);
        let beyond = (cells.mirror(facet) >> 2) as usize;
        LabelFacet {
            sites: cells.facet(facet >> 2, i as usize),
            cells: [numbers[cell], numbers[beyond]],
            evidence: dual_edges.at(facet).signed() as f64 / CERTAIN_STEPS as f64,
            is_obeyed: tree[cell] >> i & 1 == 1,
        }
    };
    let facets = facets.iter().map(facet).collect();
    let found = surface_of_labels(&cells, &points, SurfaceMode::Closed, monitor)?;
    let count = cells.finite().count() + 1;
    Ok(LabelTrace { sites, cells: count, facets, triangles: found.triangles })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use taut_points::{Distribution, GeneratedSource, Points, ScalarKind};

    use super::*;
    use crate::{SurfaceOptions, surface};

    fn trace_of(name: &str, n: u64) -> (GeneratedSource, LabelTrace) {
        let distribution = Distribution::named(name, n, 3, &Default::default()).unwrap();
        let source = GeneratedSource::new(distribution, n, 3, 1, ScalarKind::F64).unwrap();
        let trace = label_trace(&source, &Monitor::silent()).unwrap();
        (source, trace)
    }

    /// A triangle that begins with its lowest site.
    fn turned([a, b, c]: [u32; 3]) -> [u32; 3] {
        match a.min(b).min(c) {
            low if low == a => [a, b, c],
            low if low == b => [b, c, a],
            _ => [c, a, b],
        }
    }

    fn set(triangles: &[[u32; 3]]) -> BTreeSet<[u32; 3]> {
        triangles.iter().map(|&triangle| turned(triangle)).collect()
    }

    #[test]
    fn facets_are_obeyed_as_kruskals_algorithm_obeys_them() {
        for name in ["uniform", "torus"] {
            let (_, trace) = trace_of(name, 300);
            assert!(trace.facets.is_sorted_by(|a, b| a.evidence.abs() >= b.evidence.abs()));
            let mut part: Vec<u32> = (0..trace.cells as u32).collect();
            for facet in &trace.facets {
                let [one, other] = facet.cells.map(|cell| part[cell as usize]);
                assert_eq!(facet.is_obeyed, one != other, "{name}: {facet:?}");
                part.iter_mut().filter(|part| **part == other).for_each(|part| *part = one);
            }
            assert!(part.iter().all(|&one| one == part[0]), "{name}");
        }
    }

    #[test]
    fn borders_grow_to_the_surface() {
        let (source, trace) = trace_of("torus", 2000);
        let first = trace.border(0);
        assert_eq!(
            (first.parts, first.triangles.len(), first.undecided.len()),
            (trace.cells, 0, 0)
        );
        let last = trace.border(trace.facets.len());
        assert_eq!((last.parts, last.undecided.len()), (1, 0));
        // What is repaired is little.
        let (labeled, repaired) = (set(&last.triangles), set(&trace.triangles));
        let alike = labeled.intersection(&repaired).count();
        assert!(10 * alike >= 9 * repaired.len(), "{alike} of {}", repaired.len());
        // Sites are numbered apart from rows, so triangles are compared by their corners.
        let found = surface(&source, &SurfaceOptions::default()).unwrap();
        assert_eq!(found.answer.triangles.len(), trace.triangles.len());
        let volume = |triangles: &[[u32; 3]]| -> f64 {
            let of = |triangle: &[u32; 3]| {
                let [a, b, c] = triangle.map(|site| trace.sites[site as usize]);
                a[0] * (b[1] * c[2] - b[2] * c[1])
                    + a[1] * (b[2] * c[0] - b[0] * c[2])
                    + a[2] * (b[0] * c[1] - b[1] * c[0])
            };
            triangles.iter().map(of).sum::<f64>() / 6.0
        };
        assert!(volume(&last.triangles) > 0.0);
        assert!((volume(&last.triangles) / volume(&trace.triangles) - 1.0).abs() < 0.1);
    }

    #[test]
    fn points_that_span_no_space_are_refused() {
        let flat = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0];
        let points = Points::new(&flat, 3).unwrap();
        assert!(matches!(label_trace(&points, &Monitor::silent()), Err(Error::Flat { .. })));
        let points = Points::new(&flat, 2).unwrap();
        assert!(matches!(label_trace(&points, &Monitor::silent()), Err(Error::Input(_))));
    }
}
