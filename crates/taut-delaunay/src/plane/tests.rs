//! The kernel of the plane against the definition: whatever the order, the mesh is the one perturbed Delaunay
//! triangulation.

use std::collections::BTreeSet;

use taut_predicates::plane::{conflict, lexicographic, orient};

use super::*;
use crate::simplex::decode;
use crate::test_length::long_or;

type Point = [f64; 2];

const FILTERED_VECTORS: Settings = Settings { integral: false, filtered: true, vectors: true };

/// Random numbers with an address: the n-th of a seed.
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(super) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(super) fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, (self.next() % (i as u64 + 1)) as usize);
        }
    }
}

/// Inserts the sites in this order, but for the first three, which have to be a triangle.
pub(super) fn mesh(points: &[Point], order: &[u32], settings: Settings) -> Mesh {
    let mut order = order.to_vec();
    let point = |i: u32| points[i as usize];
    let third = (2..order.len())
        .find(|&k| !orient(point(order[0]), point(order[1]), point(order[k])).is_zero())
        .expect("points that are not all on a line");
    order[2..=third].rotate_right(1);
    let mut mesh = Mesh::new(points.to_vec(), settings);
    mesh.start([order[0], order[1], order[2]]);
    mesh.insert(&order[3..]).unwrap();
    mesh
}

/// A mesh in an order that keeps neighbors close, checked.
fn checked(mut points: Vec<Point>, settings: Settings) -> Mesh {
    points.sort_by(|&a, &b| lexicographic(a, b));
    points.dedup();
    let rounds =
        |k: u32| (0..points.len() as u32).filter(move |i| i.trailing_zeros().min(9) / 3 == k);
    let order: Vec<u32> = (0..4).rev().flat_map(rounds).collect();
    let mesh = mesh(&points, &order, settings);
    check(&mesh);
    mesh
}

/// Every facet has two sides, every triangle turns left, every edge is locally Delaunay, and Euler agrees.
fn check(mesh: &Mesh) {
    for (i, t) in mesh.simplices().iter().enumerate() {
        assert!(t.is_live());
        for place in 0..3 {
            let (other, facet) = decode(t.neighbors[place]);
            let u = &mesh.simplices()[other as usize];
            assert_eq!(decode(u.neighbors[facet]), (i as u32, place));
            assert_eq!(t.vertices[(place + 1) % 3], u.vertices[(facet + 2) % 3]);
            assert_eq!(t.vertices[(place + 2) % 3], u.vertices[(facet + 1) % 3]);
            let apex = u.vertices[facet];
            if !t.is_ghost() {
                let [a, b, c] = t.vertices.map(|v| mesh.sites[v as usize]);
                assert!(orient(a, b, c).is_positive());
                assert!(apex == GHOST || !conflict(a, b, c, mesh.sites[apex as usize]));
            } else if t.vertices[place] != GHOST {
                // Two edges of the hull in a row: no turn to the outside.
                let hull = |s: &Simplex<3>| {
                    let g = s.vertices.iter().position(|&v| v == GHOST).unwrap();
                    [s.vertices[(g + 1) % 3], s.vertices[(g + 2) % 3]]
                        .map(|v| mesh.sites[v as usize])
                };
                let [from, to] = hull(t);
                assert!(!orient(from, to, mesh.sites[apex as usize]).is_positive());
            }
        }
    }
    let n = mesh.simplices().iter().flat_map(|t| t.vertices).collect::<BTreeSet<_>>().len() - 1;
    let ghosts = mesh.simplices().iter().filter(|t| t.is_ghost()).count();
    assert_eq!(mesh.simplices().len() - ghosts, 2 * n - 2 - ghosts, "T = 2n − 2 − h");
}

fn triangles(mesh: &Mesh) -> BTreeSet<[u32; 3]> {
    let sorted = |t: &Simplex<3>| {
        let mut v = t.vertices;
        v.sort_unstable();
        v
    };
    mesh.simplices().iter().filter(|t| !t.is_ghost()).map(sorted).collect()
}

/// All triangles in conflict with no other point: the definition.
fn brute(points: &[Point]) -> BTreeSet<[u32; 3]> {
    let mut found = BTreeSet::new();
    for i in 0..points.len() {
        for j in 0..i {
            for k in 0..j {
                let (mut a, b, mut c) = (points[i], points[j], points[k]);
                match orient(a, b, c) {
                    taut_predicates::Sign::Zero => continue,
                    taut_predicates::Sign::Negative => std::mem::swap(&mut a, &mut c),
                    taut_predicates::Sign::Positive => {}
                }
                if (0..points.len())
                    .all(|q| [i, j, k].contains(&q) || !conflict(a, b, c, points[q]))
                {
                    found.insert([k as u32, j as u32, i as u32]);
                }
            }
        }
    }
    found
}

/// Calls `visit` with every order of 0..n, by Heap's algorithm.
fn permutations(n: usize, mut visit: impl FnMut(&[u32])) {
    let mut order: Vec<u32> = (0..n as u32).collect();
    let mut counts = vec![0; n];
    visit(&order);
    let mut i = 1;
    while i < n {
        if counts[i] < i {
            order.swap(if i % 2 == 0 { 0 } else { counts[i] }, i);
            visit(&order);
            counts[i] += 1;
            i = 1;
        } else {
            counts[i] = 0;
            i += 1;
        }
    }
}

#[test]
fn every_order_of_small_subsets_of_grids_gives_the_one_triangulation() {
    let mut random = Random(1);
    let mut runs = 0i64;
    for case in 0..long_or(100, 30) {
        let side = 3 + case % 3;
        let size = if case % 4 == 0 { 7 } else { 6 };
        let mut grid: Vec<Point> =
            (0..side * side).map(|i| [(i % side) as f64, (i / side) as f64]).collect();
        random.shuffle(&mut grid);
        let points = &grid[..size];
        if points.iter().all(|&p| orient(points[0], points[1], p).is_zero()) {
            continue;
        }
        let expected = brute(points);
        permutations(size, |order| {
            runs += 1;
            let settings = Settings {
                integral: runs % 2 == 0,
                filtered: runs % 3 != 0,
                vectors: runs % 5 < 3,
            };
            assert_eq!(triangles(&mesh(points, order, settings)), expected, "{points:?} {order:?}");
        });
    }
    assert!(runs > long_or(150_000, 45_000));
}

#[test]
fn points_on_circles_of_a_lattice() {
    // x² + y² = 5²·13²·17²: 108 points on one circle, with its center and some of its chords.
    let r2 = (5i64 * 13 * 17).pow(2);
    let mut points: Vec<Point> = vec![[0.0, 0.0], [1.0, 2.0]];
    for x in -1105i64..=1105 {
        let y = ((r2 - x * x) as f64).sqrt().round() as i64;
        if x * x + y * y == r2 {
            points.extend([[x as f64, y as f64], [x as f64, -y as f64]]);
        }
    }
    points.sort_by(|&a, &b| lexicographic(a, b));
    points.dedup();
    assert_eq!(points.len(), 110);
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let expected = brute(&points);
    let mut random = Random(7);
    for run in 0..30 {
        random.shuffle(&mut order);
        let settings =
            Settings { integral: run % 2 == 0, filtered: run % 3 != 0, vectors: run % 2 == 0 };
        let mesh = mesh(&points, &order, settings);
        check(&mesh);
        assert_eq!(triangles(&mesh), expected);
    }
    // The circle alone.
    let circle: Vec<Point> = points.into_iter().filter(|p| p[0].hypot(p[1]) > 10.0).collect();
    let alone = triangles(&checked(circle.clone(), FILTERED_VECTORS));
    assert_eq!(alone.len(), circle.len() - 2);
    assert_eq!(alone, brute(&circle));
}

#[test]
fn sets_of_many_kinds_are_locally_delaunay() {
    let mut random = Random(3);
    let tau = std::f64::consts::TAU;
    let n = 3000;
    let mut sets: Vec<Vec<Point>> = vec![
        (0..n).map(|_| [random.unit(), random.unit()]).collect(),
        (0..n).map(|_| [random.unit() - 0.5, random.unit() * 1e-9]).collect(),
        (0..n).map(|i| [f64::from(i % 50), f64::from(i / 50)]).collect(),
        (0..n).map(|i| (tau * f64::from(i) / f64::from(n)).sin_cos().into()).collect(),
        // Collinear and one more; two lines; a line of equal slope that rounding bends.
        (0..n).map(|i| if i == 0 { [0.5, 1.0] } else { [f64::from(i), 0.0] }).collect(),
        (0..n).map(|i| [random.unit(), f64::from(i % 2)]).collect(),
        (0..n).map(|i| [0.1 * f64::from(i), 0.3 * f64::from(i)]).collect(),
        // Millimeters of a wall, on both sides of zero.
        (0..n)
            .map(|_| [random.unit() * 2e4 - 1e4, (random.unit() * 6.0 - 3.0).round() * 1e3])
            .collect(),
        // Pairs an ulp apart.
        (0..n).map(|i| [f64::from(i / 2), 1.0 + f64::from(i % 2) * f64::EPSILON]).collect(),
    ];
    // A grid turned by 302.328°.
    let (sin, cos) = 302.328f64.to_radians().sin_cos();
    sets.push(
        (0..n)
            .map(|i| [f64::from(i % 50), f64::from(i / 50)])
            .map(|[x, y]| [x * cos - y * sin, x * sin + y * cos])
            .collect(),
    );
    for (number, set) in sets.into_iter().enumerate() {
        let unfiltered = Settings { integral: false, filtered: false, vectors: false };
        let separate = Settings { vectors: false, ..FILTERED_VECTORS };
        let fast = triangles(&checked(set.clone(), FILTERED_VECTORS));
        assert_eq!(fast, triangles(&checked(set.clone(), separate)), "set {number}");
        assert_eq!(fast, triangles(&checked(set, unfiltered)), "set {number}");
    }
}

#[test]
fn magnitudes_at_both_ends_of_the_range() {
    let unfiltered = Settings { integral: false, filtered: false, vectors: true };
    let mut random = Random(5);
    let points: Vec<Point> = (0..200).map(|_| [random.unit() - 0.5, random.unit() - 0.5]).collect();
    let ordinary = triangles(&checked(points.clone(), FILTERED_VECTORS));
    // Powers of two, so that the points are the same up to scale.
    for scale in [2f64.powi(500), 2f64.powi(-500), 2f64.powi(960)] {
        let scaled = points.iter().map(|p| p.map(|x| x * scale)).collect();
        assert_eq!(triangles(&checked(scaled, unfiltered)), ordinary);
    }
    // Subnormal numbers: a grid of the least of them.
    let least = f64::from_bits(1);
    let grid = |unit: f64| {
        (0..64).map(|i| [f64::from(i % 8) * unit, f64::from(i / 8) * unit]).collect::<Vec<_>>()
    };
    assert_eq!(
        triangles(&checked(grid(least), unfiltered)),
        triangles(&checked(grid(1.0), FILTERED_VECTORS))
    );
    // Products of tiny differences underflow; the filters have to see that, beside ordinary points, too.
    for tiny in [1e-80, 3e-81, 1e-81, 1e-161] {
        let mut mixed: Vec<Point> = points.iter().map(|p| p.map(|x| x * tiny)).collect();
        mixed.extend([[1.0, 0.5], [-1.0, 3.0], [0.25, -2.0]]);
        assert_eq!(
            triangles(&checked(mixed.clone(), FILTERED_VECTORS)),
            triangles(&checked(mixed, unfiltered))
        );
    }
}

/// Four points for which the JTS and GEOS libraries gave a triangulation that is none (libgeos/geos#1286), and six of
/// which delaunator lost one (mapbox/delaunator#94).
#[test]
fn sets_that_others_failed_on() {
    let geos = vec![
        [-1.3890020986020145e-10, 4.860466764224401],
        [-1.3889120965221466e-10, -5.531838081766228],
        [-1.388852095135568e-10, -12.460041312426647],
        [0.9999999999166641, -3.799787274101123],
    ];
    let delaunator = vec![
        [0.0, 0.0],
        [0.05626429153399996, 0.0],
        [0.024093852080076722, 4.80267923973791e-18],
        [0.01379050745122589, 0.1463775332929564],
        [0.05177587092034522, 0.015468457826306506],
        [0.024093852080076705, -5.204170427930421e-18],
    ];
    for points in [geos, delaunator] {
        let expected = brute(&points);
        permutations(points.len(), |order| {
            let mesh = mesh(&points, order, FILTERED_VECTORS);
            check(&mesh);
            assert_eq!(triangles(&mesh), expected);
        });
    }
}

#[test]
fn a_mesh_has_two_triangles_a_site() {
    let mut random = Random(13);
    let points: Vec<Point> = (0..50).map(|_| [random.unit(), random.unit()]).collect();
    let order: Vec<u32> = (0..50).collect();
    let (slots, _, counters) = mesh(&points, &order, FILTERED_VECTORS).finish();
    assert_eq!(slots.len(), 2 * 50 - 2);
    assert_eq!(counters.insertions, 50);
}

#[test]
fn more_than_thirty_bits_of_triangles_are_refused() {
    let mut mesh = Mesh::new(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], FILTERED_VECTORS);
    mesh.start([0, 1, 2]);
    // Refused before anything is read, so these pages are never touched.
    assert_eq!(mesh.insert(&vec![0; TRIANGLES_MAX / 2]), Err(TooMany));
    assert_eq!(mesh.simplices().len(), 4);
}

#[test]
fn uniform_points_need_no_exact_arithmetic() {
    let mut random = Random(17);
    let points: Vec<Point> = (0..20_000).map(|_| [random.unit(), random.unit()]).collect();
    let mesh = checked(points, FILTERED_VECTORS);
    let (_, _, counters) = mesh.finish();
    let stages = counters.stages;
    assert!(stages.calls() - stages.filter <= 2, "{stages:?}");
}

/// A walk of one thread may end in a slot that another one takes back.
#[test]
fn no_walk_begins_in_a_slot_that_died() {
    let mut random = Random(8);
    let points: Vec<Point> = (0..400).map(|_| [random.unit(), random.unit()]).collect();
    let order: Vec<u32> = (0..200).collect();
    let mut mesh = mesh(&points, &order, FILTERED_VECTORS);
    let (view, _, workers) = mesh.share(2);
    for worker in workers {
        assert!(worker.slots.reserve(2, view.room, view.triangles));
        worker.last = worker.slots.pop();
        view.triangles[worker.last as usize].kill();
        worker.slots.push(worker.last);
    }
    mesh.end_sharing();
    let rest: Vec<u32> = (200..400).collect();
    mesh.insert(&rest).unwrap();
    let live = mesh.simplices().iter().filter(|t| t.is_live()).count();
    assert_eq!(live, 2 * points.len() - 2);
}
