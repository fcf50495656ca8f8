//! Questions to a triangulation, against brute force.

use std::collections::BTreeSet;

use taut_delaunay::{DelaunayOptions, Location, Plane, Segment, Space};
use taut_points::Points;

fn numbers(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    (0..count)
        .map(|_| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        })
        .collect()
}

/// By three threads, so that there are slots without a simplex.
fn by_threads() -> DelaunayOptions<'static> {
    DelaunayOptions { threads: Some(3), sites_per_thread: Some(1), ..DelaunayOptions::default() }
}

fn plane(values: &[f64]) -> Plane {
    let points = Points::new(values, 2).expect("whole rows");
    Plane::build(&points, &by_threads()).expect("finite")
}

fn space(values: &[f64]) -> Space {
    let points = Points::new(values, 3).expect("whole rows");
    Space::build(&points, &by_threads()).expect("finite")
}

fn square_distance<const D: usize>(p: [f64; D], q: [f64; D]) -> f64 {
    (0..D).map(|i| (p[i] - q[i]).powi(2)).sum()
}

#[test]
fn the_nearest_site_is_the_nearest() {
    let lines: Vec<f64> = (0..60).flat_map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect();
    for values in [numbers(800, 3), lines, vec![1.0, 1.0]] {
        let plane = plane(&values);
        let locator = plane.locator();
        for q in numbers(400, 9).chunks(2).map(|q| [q[0] * 3.0 - 1.0, q[1] * 3.0 - 1.0]) {
            let found = locator.nearest(q).expect("there are sites");
            let least = (0..plane.site_count() as u32)
                .map(|s| square_distance(plane.site(s), q))
                .fold(f64::INFINITY, f64::min);
            assert_eq!(square_distance(plane.site(found), q), least);
        }
    }
    assert_eq!(plane(&[]).locator().nearest([0.0, 0.0]), None);
    assert_eq!(plane(&[0.0, 0.0]).locator().nearest([f64::NAN, 0.0]), None);
}

#[test]
fn a_point_is_located_in_a_triangle_that_holds_it() {
    let plane = plane(&numbers(1000, 5));
    let locator = plane.locator();
    let left = |a: [f64; 2], b: [f64; 2], q: [f64; 2]| {
        (b[0] - a[0]) * (q[1] - a[1]) - (b[1] - a[1]) * (q[0] - a[0])
    };
    for q in numbers(1000, 6).chunks(2).map(|q| [q[0] * 1.2 - 0.1, q[1] * 1.2 - 0.1]) {
        let beyond = plane.hull().any(|[a, b]| left(plane.site(a), plane.site(b), q) < 0.0);
        match locator.locate(q) {
            Location::Inside(t) => {
                assert!(!beyond);
                let [a, b, c] = plane.vertices(t).map(|v| plane.site(v));
                assert!(left(a, b, q) >= 0.0 && left(b, c, q) >= 0.0 && left(c, a, q) >= 0.0);
            }
            Location::Outside(ghost) => {
                assert!(beyond && plane.ghosts().any(|t| t == ghost));
            }
            other => panic!("{q:?} is neither a site nor is the set flat: {other:?}"),
        }
    }
    for s in 0..plane.site_count() as u32 {
        assert_eq!(locator.locate(plane.site(s)), Location::Site(s));
    }
    assert_eq!(self::plane(&[0.0, 0.0, 1.0, 1.0]).locator().locate([0.5, 0.0]), Location::Nowhere);
}

/// The natural neighbors of a point are its neighbors once it is a site: in space, and on grids, where a point may lie
/// on edges, on circles, outside, and on the lines of the hull.
#[test]
fn natural_neighbors_are_those_after_insertion() {
    let values = numbers(900, 17);
    let before = space(&values);
    let locator = before.locator();
    for q in numbers(60, 18).chunks(3).map(|q| [q[0] * 1.4 - 0.2, q[1], q[2]]) {
        let mut with_q = values.clone();
        with_q.extend(q);
        let after = space(&with_q);
        let new = after.sites_of_rows()[300];
        let expected: BTreeSet<u32> =
            after.locator().adjacent(new).into_iter().map(|s| after.row(s)).collect();
        let found: BTreeSet<u32> =
            locator.natural_neighbors(q).into_iter().map(|s| before.row(s)).collect();
        assert_eq!(found, expected);
    }
    let grid: Vec<f64> = (0..64).flat_map(|i| [f64::from(i % 8), f64::from(i / 8)]).collect();
    let before = plane(&grid);
    let locator = before.locator();
    for q in (0..24 * 24).map(|i| [f64::from(i % 24) / 2.0 - 2.0, f64::from(i / 24) / 2.0 - 2.0]) {
        let mut with_q = grid.clone();
        with_q.extend(q);
        let after = plane(&with_q);
        if !after.duplicates().is_empty() {
            continue;
        }
        let new = after.sites_of_rows()[64];
        let expected: BTreeSet<u32> =
            after.locator().adjacent(new).into_iter().map(|s| after.row(s)).collect();
        let found: BTreeSet<u32> =
            locator.natural_neighbors(q).into_iter().map(|s| before.row(s)).collect();
        assert_eq!(found, expected, "{q:?}");
    }
}

/// All pairs of sites: an edge is in the complex if its smallest circle is empty and small enough, or its triangle is.
#[test]
fn alpha_complexes_are_those_of_the_definition() {
    let plane = plane(&numbers(160, 31));
    let sites: Vec<[f64; 2]> = (0..plane.site_count() as u32).map(|s| plane.site(s)).collect();
    for alpha in [0.0, 0.02, 0.05, 0.08, 0.12, 0.3, 1e9] {
        let complex = plane.alpha_complex(alpha);
        let kept: BTreeSet<u32> = complex.simplices.iter().copied().collect();
        assert!(plane.simplices().all(|t| kept.contains(&t) == (plane.circumradius(t) <= alpha)));
        let mut covered = BTreeSet::new();
        let mut once: BTreeSet<[u32; 2]> = BTreeSet::new();
        for &t in &complex.simplices {
            let [a, b, c] = plane.vertices(t);
            for [u, v] in [[a, b], [b, c], [c, a]] {
                covered.insert([u.min(v), u.max(v)]);
                if !once.remove(&[v, u]) {
                    once.insert([u, v]);
                }
            }
        }
        assert_eq!(
            complex.boundary.iter().copied().collect::<BTreeSet<_>>(),
            once,
            "triangles to the left"
        );
        let mut lone = BTreeSet::new();
        for u in 0..sites.len() {
            for v in u + 1..sites.len() {
                let (p, q) = (sites[u], sites[v]);
                let inside = |r: [f64; 2]| {
                    (p[0] - r[0]) * (q[0] - r[0]) + (p[1] - r[1]) * (q[1] - r[1]) < 0.0
                };
                let small = 0.25 * square_distance(p, q) <= alpha * alpha;
                if small && !sites.iter().any(|&r| inside(r)) {
                    lone.insert([u as u32, v as u32]);
                }
            }
        }
        let lone: BTreeSet<_> = lone.difference(&covered).copied().collect();
        let singular: BTreeSet<_> =
            complex.singular.iter().map(|&[u, v]| [u.min(v), u.max(v)]).collect();
        assert_eq!(singular, lone, "alpha {alpha}");
    }
}

/// All triples of sites in space.
#[test]
fn lone_triangles_in_space_are_those_of_the_definition() {
    let space = space(&numbers(120, 77));
    let sites: Vec<[f64; 3]> = (0..space.site_count() as u32).map(|s| space.site(s)).collect();
    let sub = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let mut met = 0;
    for alpha in [0.1, 0.2, 0.25, 0.3, 0.4] {
        let complex = space.alpha_complex(alpha);
        let mut covered = BTreeSet::new();
        for &t in &complex.simplices {
            let mut v = space.vertices(t);
            v.sort_unstable();
            covered.extend((0..4).map(|i| {
                let rest: Vec<u32> = (0..4).filter(|&k| k != i).map(|k| v[k]).collect();
                [rest[0], rest[1], rest[2]]
            }));
        }
        let mut lone = BTreeSet::new();
        for a in 0..sites.len() {
            for b in a + 1..sites.len() {
                for c in b + 1..sites.len() {
                    // The center of the circle is a + s(b − a) + t(c − a).
                    let (u, v) = (sub(sites[b], sites[a]), sub(sites[c], sites[a]));
                    let (uu, vv, uv) = (dot(u, u), dot(v, v), dot(u, v));
                    let det = 2.0 * (uu * vv - uv * uv);
                    let (s, t) = (vv * (uu - uv) / det, uu * (vv - uv) / det);
                    let center = [0, 1, 2].map(|k| sites[a][k] + s * u[k] + t * v[k]);
                    let r2 = square_distance(center, sites[a]);
                    let empty = (0..sites.len())
                        .filter(|i| ![a, b, c].contains(i))
                        .all(|i| square_distance(center, sites[i]) >= r2);
                    if empty && r2 <= alpha * alpha {
                        lone.insert([a as u32, b as u32, c as u32]);
                    }
                }
            }
        }
        let lone: BTreeSet<_> = lone.difference(&covered).copied().collect();
        let sorted = |mut f: [u32; 3]| {
            f.sort_unstable();
            f
        };
        let singular: BTreeSet<_> = complex.singular.iter().copied().map(sorted).collect();
        assert_eq!(singular, lone, "alpha {alpha}");
        met += lone.len();
    }
    assert!(met > 20, "{met}");
}

/// Radii and places are right where squares leave the range of `f64`.
#[test]
fn extreme_scales_are_no_different() {
    let values = numbers(200, 91);
    let plain = plane(&values);
    let expected = plain.alpha_complex(0.1);
    for scale in [1e-150, 1e150, 1e-300, 1e300] {
        let scaled: Vec<f64> = values.iter().map(|x| x * scale).collect();
        let plane = plane(&scaled);
        let complex = plane.alpha_complex(0.1 * scale);
        assert_eq!(complex.simplices.len(), expected.simplices.len(), "{scale}");
        assert_eq!(complex.singular.len(), expected.singular.len(), "{scale}");
        let locator = plane.locator();
        assert_eq!(
            locator.nearest([0.0, 0.0]).map(|s| plane.row(s)),
            plain.locator().nearest([0.0, 0.0]).map(|s| plain.row(s))
        );
        // Far outside in any scale.
        assert!(matches!(locator.locate([1.5e308, 1e10]), Location::Outside(_)), "{scale}");
        assert!(locator.nearest([1.5e308, 1e10]).is_some());
        assert_eq!(locator.locate([f64::NAN, 0.0]), Location::Nowhere);
    }
}

#[test]
fn a_large_alpha_in_space_leaves_the_hull() {
    let space = space(&numbers(600, 41));
    let all = space.alpha_complex(1e12);
    assert_eq!(all.simplices.len(), space.simplices().count());
    let turned = |mut f: [u32; 3]| {
        let first = (0..3).min_by_key(|&i| f[i]).expect("three");
        f.rotate_left(first);
        f
    };
    let hull: BTreeSet<_> = space.hull().map(turned).collect();
    assert_eq!(all.boundary.into_iter().map(turned).collect::<BTreeSet<_>>(), hull);
    assert!(all.singular.is_empty());
    // A closed surface: each edge once either way.
    let some = space.alpha_complex(0.15);
    assert!(!some.simplices.is_empty() && some.simplices.len() < all.simplices.len());
    let mut edges = std::collections::BTreeMap::new();
    for [a, b, c] in some.boundary {
        for (u, v) in [(a, b), (b, c), (c, a)] {
            *edges.entry((u.min(v), u.max(v))).or_insert(0) += if u < v { 1 } else { -1 };
        }
    }
    assert!(edges.values().all(|&sum| sum == 0));
}

/// A square with a square hole, by threads and on one thread alike.
#[test]
fn constraints_hold_however_the_triangulation_was_built() {
    let mut values = numbers(800, 53);
    values.extend([0.2, 0.2, 0.8, 0.2, 0.8, 0.8, 0.2, 0.8, 0.4, 0.4, 0.6, 0.4, 0.6, 0.6, 0.4, 0.6]);
    let points = Points::new(&values, 2).expect("whole rows");
    let mut areas = Vec::new();
    for options in [DelaunayOptions::default(), by_threads()] {
        let plane = Plane::build(&points, &options).expect("finite");
        let site = plane.sites_of_rows();
        let rings = [[400, 401, 402, 403], [404, 405, 406, 407]];
        let sides = rings.iter().flat_map(|ring| (0..4).map(|i| [ring[i], ring[(i + 1) % 4]]));
        let segments: Vec<Segment> =
            sides.map(|[a, b]| Segment { from: site[a], to: site[b], ring: true }).collect();
        let constrained = plane.constrained(&segments).expect("nothing crosses");
        let inside = (0u32..)
            .zip(constrained.triangles())
            .filter(|&(t, s)| !s.is_ghost() && constrained.is_inside(t));
        let doubled = inside.map(|(_, s)| {
            let [a, b, c] = s.vertices.map(|v| plane.site(v));
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        });
        areas.push(0.5 * doubled.sum::<f64>());
    }
    assert!(areas.iter().all(|area| (area - (0.36 - 0.04)).abs() < 1e-12), "{areas:?}");
}
