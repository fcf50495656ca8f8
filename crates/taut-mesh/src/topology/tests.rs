//! Surfaces known by heart, defects of every kind, and definitions taken word for word.

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;

use super::*;
use crate::shapes::*;

fn of(shape: &Shape) -> Topology {
    topology(&shape.view())
}

/// Vertices, edges, triangles, components, loops and genus.
type Summary = (usize, usize, usize, usize, usize, Option<u64>);

fn summary(found: &Topology) -> Summary {
    let parts = (found.components.len(), found.boundary_loops.len());
    (found.vertices, found.edges, found.triangles, parts.0, parts.1, found.genus)
}

#[test]
fn closed_surfaces_have_their_genus() {
    for (shape, expected) in [
        (tetrahedron(), (4, 6, 4, 1, 0, Some(0))),
        (cube(), (8, 18, 12, 1, 0, Some(0))),
        (torus(7, 5), (35, 105, 70, 1, 0, Some(1))),
        (sphere(3), (258, 768, 512, 1, 0, Some(0))),
        (
            torus(3, 3).and(&sphere(1)).and(&torus(4, 3)),
            (9 + 18 + 12, 27 + 48 + 36, 74, 3, 0, Some(2)),
        ),
    ] {
        let found = of(&shape);
        assert_eq!(summary(&found), expected);
        assert!(found.is_manifold() && found.is_closed() && found.is_oriented());
        assert!(
            found.components.iter().all(|p| p.manifold && p.closed && p.orientable && p.oriented)
        );
        assert_eq!((found.unreferenced_vertices, found.duplicate_triangles), (0, 0));
    }
    let parts = of(&torus(3, 3).and(&sphere(1))).components;
    assert_eq!((parts[0].genus, parts[1].genus), (Some(1), Some(0)));
    assert_eq!((parts[0].first_triangle, parts[1].first_triangle), (0, 18));
    assert_eq!((parts[0].euler_characteristic, parts[1].euler_characteristic), (0, 2));
}

/// Two triangles glued with both back to back are the smallest sphere.
#[test]
fn a_triangle_given_twice_is_counted() {
    let pillow = Shape::new(&[[0.0; 3]; 3], &[[0, 1, 2], [1, 0, 2]]);
    let found = of(&pillow);
    assert_eq!(summary(&found), (3, 3, 2, 1, 0, Some(0)));
    assert_eq!((found.duplicate_triangles, found.inconsistent_edges), (1, 0));
    let same = of(&Shape::new(&[[0.0; 3]; 3], &[[0, 1, 2], [1, 2, 0]]));
    assert_eq!((same.duplicate_triangles, same.inconsistent_edges), (1, 3));
    let thrice = of(&Shape::new(&[[0.0; 3]; 3], &[[0, 1, 2], [1, 0, 2], [2, 1, 0]]));
    assert_eq!((thrice.duplicate_triangles, thrice.non_manifold_edges), (2, 3));
}

#[test]
fn one_sided_surfaces_are_told() {
    let band = of(&moebius(9, 2));
    assert_eq!(summary(&band), (27, 63, 36, 1, 1, None));
    assert!(band.is_manifold() && !band.is_closed() && !band.is_oriented());
    assert_eq!(band.inconsistent_edges, 2);
    let part = band.components[0];
    assert!(part.manifold && !part.orientable && !part.oriented && !part.closed);
    assert_eq!((part.genus, part.euler_characteristic, part.boundary_loops), (Some(1), 0, 1));
    assert_eq!((band.boundary_loops[0].edges, band.boundary_loops[0].simple), (18, true));

    let bottle = of(&klein(8, 5));
    assert_eq!(summary(&bottle), (40, 120, 80, 1, 0, None));
    assert!(bottle.is_manifold() && bottle.is_closed() && !bottle.components[0].orientable);
    assert_eq!(bottle.components[0].genus, Some(2));
}

#[test]
fn triangles_turned_over_are_told_from_one_sided_surfaces() {
    let mut shape = torus(6, 5);
    shape.triangles[7].swap(0, 1);
    let found = of(&shape);
    assert_eq!((found.inconsistent_edges, found.genus), (3, Some(1)));
    assert!(found.components[0].orientable && !found.components[0].oriented);
}

#[test]
fn holes_are_loops_with_lengths() {
    let ring = of(&annulus(12));
    assert_eq!(summary(&ring), (24, 48, 24, 1, 2, Some(0)));
    let side = 2.0 * (std::f64::consts::TAU / 24.0).sin();
    for (own, radius) in ring.boundary_loops.iter().zip([1.0, 2.0]) {
        assert_eq!((own.edges, own.simple), (12, true));
        assert!((own.length - radius * 12.0 * side).abs() < 1e-13, "{own:?}");
    }
    assert_eq!(ring.boundary_loops[1].first_vertex, 1);
    let mut pierced = torus(9, 9);
    pierced.triangles.swap_remove(0);
    pierced.triangles.remove(80);
    let found = of(&pierced);
    assert_eq!((found.boundary_loops.len(), found.boundary_edges, found.genus), (2, 6, Some(1)));
    let mut half = sphere(3);
    half.triangles.retain(|t| t.iter().all(|&k| half.vertices[k as usize][2] >= 0.0));
    let found = of(&half);
    assert_eq!((found.components.len(), found.boundary_loops.len(), found.genus), (1, 1, Some(0)));
    assert_eq!(found.vertices + found.unreferenced_vertices, 258);
    assert!(found.unreferenced_vertices > 100);
}

#[test]
fn a_bow_tie_is_two_components_or_one_bad_vertex() {
    let tie = of(&Shape::new(&[[0.0; 3]; 5], &[[0, 1, 2], [0, 3, 4]]));
    assert_eq!(summary(&tie), (5, 6, 2, 2, 1, Some(0)));
    assert_eq!(
        (tie.non_manifold_vertices, tie.is_manifold(), tie.euler_characteristic),
        (1, false, 1)
    );
    assert!(!tie.boundary_loops[0].simple);
    assert!(tie.components.iter().all(|p| p.manifold && p.boundary_loops == 1));

    // A strip of the plane whose ends meet in one vertex: now the component is none on its own.
    let ring = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 5, 2], [4, 0, 5]];
    let found = of(&Shape::new(&[[0.0; 3]; 6], &ring));
    assert_eq!((found.components.len(), found.non_manifold_vertices), (1, 1));
    assert_eq!(
        (found.components[0].manifold, found.components[0].genus, found.genus),
        (false, None, None)
    );
}

#[test]
fn three_triangles_on_an_edge_are_no_surface() {
    let fins = of(&Shape::new(&[[0.0; 3]; 5], &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]));
    assert_eq!((fins.non_manifold_edges, fins.non_manifold_vertices), (1, 2));
    assert_eq!((fins.genus, fins.components[0].genus, fins.components.len()), (None, None, 1));
    assert!(fins.components[0].orientable && fins.is_oriented());
    // A wall within a box: closed, and no surface.
    let mut box_ = cube();
    box_.triangles.push([0, 1, 6]);
    box_.triangles.push([1, 7, 6]);
    let found = of(&box_);
    assert_eq!((found.is_closed(), found.boundary_edges), (true, 0));
    assert_eq!((found.non_manifold_edges, found.non_manifold_vertices), (4, 4));
}

#[test]
fn what_is_next_to_nothing_is_counted_too() {
    let nothing = of(&Shape::default());
    assert_eq!(
        (nothing.clone(), nothing.genus),
        (Topology { genus: Some(0), ..Topology::default() }, Some(0))
    );
    let points = of(&Shape::new(&[[0.0; 3]; 4], &[[0, 0, 1], [2, 2, 2]]));
    assert_eq!((points.degenerate_triangles, points.unreferenced_vertices), (2, 4));
    assert_eq!(summary(&points), (0, 0, 0, 0, 0, Some(0)));
    let one = of(&Shape::new(&[[0.0; 3]; 4], &[[0, 0, 1], [3, 1, 2]]));
    assert_eq!(summary(&one), (3, 3, 1, 1, 1, Some(0)));
    assert_eq!((one.boundary_loops[0].first_vertex, one.components[0].first_triangle), (1, 1));
}

#[test]
fn lengths_of_loops_may_be_of_any_size() {
    for scale in [1e-150, 1.0, 1e150] {
        let found = of(&square(4).scaled(scale));
        assert!((found.boundary_loops[0].length / scale - 4.0).abs() < 1e-14);
    }
}

/// The triangles on an edge, each with whether it runs from the lower vertex to the higher one.
type On = Vec<(usize, bool)>;

/// Everything by the words of the definitions, in quadratic time.
fn plain(shape: &Shape) -> Topology {
    let kept: Vec<(usize, [u32; 3])> = shape
        .triangles
        .iter()
        .copied()
        .enumerate()
        .filter(|(_, t)| BTreeSet::from(*t).len() == 3)
        .collect();
    let directed = |t: [u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let mut edges: BTreeMap<[u32; 2], On> = BTreeMap::new();
    for (slot, &(_, t)) in kept.iter().enumerate() {
        for [a, b] in directed(t) {
            edges.entry([a.min(b), a.max(b)]).or_default().push((slot, a < b));
        }
    }
    /// Sizes do not matter: the parts of a graph.
    fn parts<T: Ord + Copy>(
        nodes: &BTreeSet<T>,
        joined: impl Fn(T, T) -> bool,
    ) -> Vec<BTreeSet<T>> {
        let (mut left, mut parts) = (nodes.clone(), Vec::new());
        while let Some(first) = left.pop_first() {
            let (mut part, mut open) = (BTreeSet::from([first]), vec![first]);
            while let Some(at) = open.pop() {
                let next: Vec<T> =
                    left.iter().copied().filter(|&other| joined(at, other)).collect();
                for other in next {
                    left.remove(&other);
                    part.insert(other);
                    open.push(other);
                }
            }
            parts.push(part);
        }
        parts
    }
    let link_is_good = |v: u32, among: &BTreeSet<usize>| {
        let star: Vec<Vec<u32>> = among
            .iter()
            .map(|&slot| kept[slot].1)
            .filter(|t| t.contains(&v))
            .map(|t| t.into_iter().filter(|&w| w != v).collect())
            .collect();
        let nodes: BTreeSet<u32> = star.iter().flatten().copied().collect();
        let degree = |w: u32| star.iter().filter(|side| side.contains(&w)).count();
        let joined =
            |a: u32, b: u32| star.iter().any(|side| side.contains(&a) && side.contains(&b));
        parts(&nodes, joined).len() == 1 && nodes.iter().all(|&w| degree(w) <= 2)
    };
    let loops_of = |among: &BTreeSet<usize>| {
        let bare: Vec<[u32; 2]> = edges
            .iter()
            .filter(|(_, on)| on.len() == 1 && among.contains(&on[0].0))
            .map(|(&ends, _)| ends)
            .collect();
        let nodes: BTreeSet<u32> = bare.iter().flatten().copied().collect();
        let sets = parts(&nodes, |a, b| bare.contains(&[a.min(b), a.max(b)]));
        let own = |set: &BTreeSet<u32>| {
            let ends: Vec<u32> =
                bare.iter().filter(|e| set.contains(&e[0])).flatten().copied().collect();
            let degree = |v: u32| ends.iter().filter(|&&w| w == v).count();
            BoundaryLoop {
                first_vertex: set.first().copied().unwrap_or_default(),
                edges: ends.len() / 2,
                length: ends.len() as f64 / 2.0,
                simple: set.iter().all(|&v| degree(v) == 2),
            }
        };
        sets.iter().map(own).collect::<Vec<_>>()
    };
    let slots: BTreeSet<usize> = (0..kept.len()).collect();
    let neighbors = |a: usize, b: usize| {
        edges.values().any(|on| on.iter().any(|x| x.0 == a) && on.iter().any(|x| x.0 == b))
    };
    let component = |part: &BTreeSet<usize>| {
        let own: Vec<&On> = edges.values().filter(|on| part.contains(&on[0].0)).collect();
        let vertices: BTreeSet<u32> = part.iter().flat_map(|&slot| kept[slot].1).collect();
        let pairs: Vec<_> =
            own.iter().filter(|on| on.len() == 2).map(|on| (on[0], on[1])).collect();
        // Turned or not, for each triangle: all ways are tried.
        let list: Vec<usize> = part.iter().copied().collect();
        let turned =
            |way: u32, slot: usize| way >> list.iter().position(|&s| s == slot).unwrap() & 1 == 1;
        let right = |way: u32| {
            pairs.iter().all(|&(a, b)| (a.1 ^ turned(way, a.0)) != (b.1 ^ turned(way, b.0)))
        };
        let (v, e, f) = (vertices.len() as i64, own.len() as i64, part.len() as i64);
        let manifold =
            own.iter().all(|on| on.len() <= 2) && vertices.iter().all(|&v| link_is_good(v, part));
        let orientable = (0..1u32 << list.len()).any(right);
        let lacking = 2 - loops_of(part).len() as i64 - (v - e + f);
        if manifold {
            assert!(lacking >= 0 && (!orientable || lacking % 2 == 0), "a surface has a genus");
        }
        Component {
            first_triangle: kept[list[0]].0 as u32,
            vertices: v as usize,
            edges: e as usize,
            triangles: f as usize,
            boundary_edges: own.iter().filter(|on| on.len() == 1).count(),
            boundary_loops: loops_of(part).len(),
            euler_characteristic: v - e + f,
            manifold,
            closed: own.iter().all(|on| on.len() > 1),
            orientable,
            oriented: right(0),
            genus: manifold.then_some((if orientable { lacking / 2 } else { lacking }) as u64),
        }
    };
    let components: Vec<Component> = parts(&slots, neighbors).iter().map(component).collect();
    let vertices: BTreeSet<u32> = kept.iter().flat_map(|k| k.1).collect();
    let count = |wanted: &dyn Fn(&On) -> bool| edges.values().filter(|on| wanted(on)).count();
    let good = components.iter().all(|p| p.manifold && p.orientable);
    Topology {
        vertices: vertices.len(),
        unreferenced_vertices: shape.vertices.len() - vertices.len(),
        edges: edges.len(),
        triangles: kept.len(),
        degenerate_triangles: shape.triangles.len() - kept.len(),
        duplicate_triangles: kept.len()
            - kept.iter().map(|k| BTreeSet::from(k.1)).collect::<BTreeSet<_>>().len(),
        boundary_edges: count(&|on| on.len() == 1),
        non_manifold_edges: count(&|on| on.len() > 2),
        inconsistent_edges: count(&|on| on.len() == 2 && on[0].1 == on[1].1),
        non_manifold_vertices: vertices.iter().filter(|&&v| !link_is_good(v, &slots)).count(),
        boundary_loops: loops_of(&slots),
        euler_characteristic: vertices.len() as i64 - edges.len() as i64 + kept.len() as i64,
        genus: good.then(|| components.iter().filter_map(|p| p.genus).sum()),
        components,
    }
}

/// Vertices such that any two are at distance 1 is asking too much: lengths are set to the number of edges.
fn without_lengths(mut found: Topology) -> Topology {
    found.boundary_loops.iter_mut().for_each(|own| own.length = own.edges as f64);
    found
}

proptest! {
    /// Few vertices, so that edges are crowded, triangles repeat and loops touch.
    #[test]
    fn the_report_is_what_the_definitions_say(
        triangles in prop::collection::vec([0u32..7, 0u32..7, 0u32..7], 0..11),
    ) {
        let shape = Shape::new(&[[0.0; 3]; 7], &triangles);
        prop_assert_eq!(without_lengths(of(&shape)), plain(&shape));
    }

    /// Surfaces with some triangles taken out and some turned: the names of vertices and the order of triangles do not count,
    /// nor does where the mesh lies.
    #[test]
    fn names_and_places_do_not_count(
        which in 0usize..5,
        out in prop::collection::vec(0usize..1000, 0..30),
        over in prop::collection::vec(0usize..1000, 0..3),
        seed in 0u64..1000,
    ) {
        let mut shape = match which {
            0 => torus(6, 7),
            1 => moebius(9, 3),
            2 => klein(6, 6).and(&tetrahedron()),
            3 => annulus(20).and(&sphere(1)),
            _ => square(6),
        };
        for k in out {
            shape.triangles.swap_remove(k % shape.triangles.len());
        }
        for k in over {
            let k = k % shape.triangles.len();
            shape.triangles[k].swap(1, 2);
        }
        let canonical = |found: Topology| {
            let mut found = without_lengths(found);
            found.boundary_loops.iter_mut().for_each(|own| own.first_vertex = 0);
            found.components.iter_mut().for_each(|own| own.first_triangle = 0);
            found.boundary_loops.sort_by_key(|own| (own.edges, own.simple));
            found.components.sort_by_key(|p| (p.triangles, p.vertices, p.edges, p.boundary_loops, p.oriented, p.orientable));
            found
        };
        let first = of(&shape);
        let again = of(&shape.shuffled(seed));
        let total = |found: &Topology| found.boundary_loops.iter().map(|own| own.length).sum::<f64>();
        // A sum of fewer than 2000 lengths below 10 in another order.
        prop_assert!((total(&first) - total(&again)).abs() < 1e-9);
        prop_assert_eq!(canonical(first.clone()), canonical(again));
        let mut turned = shape.clone();
        turned.map(|[x, y, z]| [8.0 * y, -8.0 * x, 8.0 * z]);
        for (own, other) in first.boundary_loops.iter().zip(of(&turned).boundary_loops) {
            prop_assert!((8.0 * own.length - other.length).abs() < 1e-9);
        }
    }
}
