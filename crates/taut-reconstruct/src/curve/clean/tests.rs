use taut_points::Points;
use taut_predicates::plane::in_diametral_circle;

use super::near::distance2;
use super::*;
use crate::{CurveOptions, curve};

const METHODS: [CurveMethod; 6] = [
    CurveMethod::Crust,
    CurveMethod::OneStepCrust,
    CurveMethod::NnCrust,
    CurveMethod::ConservativeCrust,
    CurveMethod::HnnCrust,
    CurveMethod::Corners,
];

/// Numbers in [0, 1) from a seed.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn found(points: &[[f64; 2]], method: CurveMethod, ends: Ends) -> taut_certify::Curve {
    let view = Points::new(points.as_flattened(), 2).expect("pairs");
    let options = CurveOptions { method, ends, ..Default::default() };
    curve(&view, &options).expect("finite points").answer
}

fn cloud(points: &[[f64; 2]]) -> Cloud {
    let view = Points::new(points.as_flattened(), 2).expect("pairs");
    Cloud::read(&view, &Monitor::silent()).expect("finite points")
}

/// Whether the answer is one closed curve through the points in their order.
fn is_ring(answer: &taut_certify::Curve, points: usize) -> bool {
    let [ring] = &answer.curves[..] else { return false };
    let step = |a: u64, b: u64| (b + points as u64 - a) % points as u64;
    let around = ring.rows.iter().zip(ring.rows.iter().cycle().skip(1));
    let steps: Vec<u64> = around.map(|(&a, &b)| step(a, b)).collect();
    let one_way =
        steps.iter().all(|&s| s == steps[0]) && (steps[0] == 1 || steps[0] == points as u64 - 1);
    ring.closed && ring.rows.len() == points && one_way
}

#[test]
fn few_points() {
    for method in METHODS {
        for ends in [Ends::Auto, Ends::Open] {
            let none = found(&[], method, ends);
            assert!(none.curves.is_empty() && none.outliers.is_empty());
            let one = found(&[[1.0, 2.0]; 3], method, ends);
            assert!(one.curves.is_empty(), "{method:?}");
            assert_eq!(one.outliers, [0, 1, 2]);
            let two = found(&[[0.0, 0.0], [3.0, 4.0], [0.0, -0.0]], method, ends);
            assert_eq!((two.curves.len(), two.outliers.len()), (1, 0), "{method:?}");
            assert!(!two.curves[0].closed && two.curves[0].rows == [0, 1], "{method:?}");
            let line = [[0.0, 0.0], [1.0, 2.0], [2.0, 4.0], [4.0, 8.0], [1.0, 2.0]];
            for used in 3..=5 {
                let answer = found(&line[..used], method, ends);
                let rows = [0, 1, 2, 3];
                assert_eq!(answer.curves[0].rows, rows[..used.min(4)], "{method:?} {used}");
                assert!(answer.outliers.is_empty());
            }
        }
    }
}

#[test]
fn extreme_coordinates_grids_and_circles() {
    let mut draw = Draw(5);
    let grid: Vec<[f64; 2]> = (0..64).map(|i| [f64::from(i % 8), f64::from(i / 8)]).collect();
    let round = |n: usize| -> Vec<[f64; 2]> {
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
        (0..n).map(|i| [angle(i).cos(), angle(i).sin()]).collect()
    };
    let random: Vec<[f64; 2]> = (0..300).map(|_| [draw.next(), draw.next()]).collect();
    for points in [grid, round(24), random] {
        for method in METHODS {
            let plain = found(&points, method, Ends::Auto);
            for exponent in [-1000, -990, 980, 1000] {
                let scaled: Vec<[f64; 2]> =
                    points.iter().map(|p| p.map(|x| x * 2f64.powi(exponent))).collect();
                let again = found(&scaled, method, Ends::Auto);
                let rows = |answer: &taut_certify::Curve| -> Vec<Vec<u64>> {
                    answer.curves.iter().map(|c| c.rows.clone()).collect()
                };
                assert_eq!(rows(&plain), rows(&again), "{method:?} {exponent}");
            }
        }
    }
    for n in [12, 40] {
        for method in METHODS {
            assert!(is_ring(&found(&round(n), method, Ends::Open), n), "{method:?} {n}");
        }
    }
    let wide = [[1e300, 1e-300], [-1e300, 1e300], [1e-300, 0.0], [2e-300, 1e-300], [0.0, 1.7e308]];
    for method in METHODS {
        found(&wide, method, Ends::Auto);
    }
}

#[test]
fn no_chain_meets_another_and_order_of_rows_and_threads_change_nothing() {
    let mut draw = Draw(11);
    for round in 0..20 {
        let whole = round % 2 == 0;
        let points: Vec<[f64; 2]> = (0..400)
            .map(|_| [draw.next(), draw.next()].map(|x| if whole { (30.0 * x).floor() } else { x }))
            .collect();
        let backwards: Vec<[f64; 2]> = points.iter().rev().copied().collect();
        for method in METHODS {
            let answer = found(&points, method, Ends::Auto);
            let edges: Vec<[[f64; 2]; 2]> = answer
                .curves
                .iter()
                .flat_map(|c| {
                    let next = c.vertices.iter().cycle().skip(1);
                    let count = c.vertices.len() - usize::from(!c.closed);
                    c.vertices.iter().zip(next).take(count).map(|(&a, &b)| [a, b])
                })
                .collect();
            assert!(answer.curves.iter().all(|c| c.vertices.len() > 1 + usize::from(c.closed)));
            for (i, &a) in edges.iter().enumerate() {
                for &b in &edges[..i] {
                    assert!(!touch(a, b), "{method:?}: {a:?} {b:?}");
                }
            }
            let vertices = |answer: &taut_certify::Curve| -> Vec<(bool, Vec<[f64; 2]>)> {
                answer.curves.iter().map(|c| (c.closed, c.vertices.clone())).collect()
            };
            assert_eq!(vertices(&answer), vertices(&found(&backwards, method, Ends::Auto)));
            let view = Points::new(points.as_flattened(), 2).expect("pairs");
            for threads in [1, 3] {
                let options = CurveOptions { method, threads: Some(threads), ..Default::default() };
                assert_eq!(curve(&view, &options).expect("finite").answer, answer);
            }
        }
    }
}

/// Whether segments have a point in common that is not an end of both, by orientations alone.
fn touch([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    use taut_predicates::plane::orient;
    let sign = |p, q, r| {
        i32::from(orient(p, q, r).is_positive()) - i32::from(orient(p, q, r).is_negative())
    };
    let within = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
        (0..2).all(|i| p[i].min(q[i]) <= r[i] && r[i] <= p[i].max(q[i])) && sign(p, q, r) == 0
    };
    let inside = |p, q, r: [f64; 2]| r != p && r != q && within(p, q, r);
    let proper = sign(a, b, c) * sign(a, b, d) < 0 && sign(c, d, a) * sign(c, d, b) < 0;
    proper || inside(a, b, c) || inside(a, b, d) || inside(c, d, a) || inside(c, d, b)
}

/// The first of the sites that are accepted, by distance and coordinates, by looking at all.
fn first(sites: &[[f64; 2]], p: u32, accept: impl Fn(u32) -> bool) -> Option<u32> {
    let at = |q: u32| sites[q as usize];
    let others = (0..sites.len() as u32).filter(|&q| q != p && accept(q));
    others.min_by(|&a, &b| {
        let [x, y] = [a, b].map(|q| distance2(at(p), at(q)));
        x.total_cmp(&y).then(at(a).partial_cmp(&at(b)).expect("numbers"))
    })
}

#[test]
fn neighbors_are_those_of_brute_force() {
    let mut draw = Draw(3);
    for round in 0..12 {
        let points: Vec<[f64; 2]> = (0..30 * round)
            .map(|_| {
                let [x, y] = [draw.next(), draw.next()];
                // Uniform, whole numbers with ties, or two far clusters.
                match round % 3 {
                    0 => [x, y],
                    1 => [(12.0 * x).floor(), (12.0 * y).floor()],
                    _ => [x * 1e-3 + if y > 0.5 { 1.0 } else { 0.0 }, y * 1e-3],
                }
            })
            .collect();
        let cloud = cloud(&points);
        let sites = &cloud.sites;
        let at = |q: u32| sites[q as usize];
        let all = 0..sites.len() as u32;
        let sorted = |mut edges: Vec<[u32; 2]>| {
            edges.iter_mut().for_each(|edge| edge.sort_unstable());
            edges.sort_unstable();
            edges.dedup();
            edges
        };
        let nearest: Vec<Option<u32>> = all.clone().map(|p| first(sites, p, |_| true)).collect();
        let mut edges: Vec<[u32; 2]> =
            all.clone().filter_map(|p| Some([p, nearest[p as usize]?])).collect();
        edges = sorted(edges);
        let lonely: Vec<u32> = all
            .clone()
            .filter(|p| edges.iter().filter(|edge| edge.contains(p)).count() == 1)
            .collect();
        for p in lonely {
            let q = nearest[p as usize].expect("it has an edge");
            let behind = |r: u32| in_diametral_circle(at(q), at(r), at(p)).is_positive();
            edges.extend(first(sites, p, behind).map(|r| [p, r]));
        }
        let near = Near::new(sites);
        let silent = Monitor::silent();
        let found = nn_crust::edges(&near, &silent).expect("nobody cancels");
        assert_eq!(sorted(found.clone()), sorted(edges));
        assert_eq!(sorted(found.clone()).len(), found.len(), "each edge once");

        let named: Vec<Vec<u32>> = all
            .clone()
            .map(|p| {
                let Some(n) = nearest[p as usize] else { return vec![] };
                let second = first(sites, p, |s| {
                    let across = distance2(at(n), at(s));
                    across > distance2(at(p), at(n)) && across > distance2(at(p), at(s))
                });
                std::iter::once(n).chain(second).collect()
            })
            .collect();
        let mutual = all.clone().flat_map(|p| {
            let named = &named;
            named[p as usize]
                .iter()
                .filter(move |&&q| named[q as usize].contains(&p))
                .map(move |&q| [p, q])
        });
        let found = hnn_crust::edges(&near, &silent).expect("nobody cancels");
        assert_eq!(sorted(found), sorted(mutual.collect()));
    }
}

/// The crust by its definition: edges between sites in the triangulation of sites and Voronoi vertices.
fn crust_by_triangulation(sites: &[[f64; 2]]) -> Vec<[u32; 2]> {
    let silent = Monitor::silent();
    let plane = graph::triangulate(sites, &silent).expect("nobody cancels");
    let mut both = sites.to_vec();
    both.extend(graph::voronoi_vertices(&plane, sites, 1e6));
    let refined = graph::triangulate(&both, &silent).expect("nobody cancels");
    let ends = graph::edges(&refined).into_iter().map(|edge| edge.ends);
    sorted(ends.filter(|ends| ends.iter().all(|&v| (v as usize) < sites.len())).collect())
}

/// Each edge from its smaller end, by ends.
fn sorted(mut edges: Vec<[u32; 2]>) -> Vec<[u32; 2]> {
    edges.iter_mut().for_each(|ends| ends.sort_unstable());
    edges.sort_unstable();
    edges
}

#[test]
fn the_crust_is_that_of_its_definition() {
    let mut draw = Draw(23);
    let mut fewer = 0;
    for round in 0..120 {
        let n = 3 + (round * 7) % 300;
        let points: Vec<[f64; 2]> = match round % 3 {
            0 => (0..n).map(|_| [draw.next(), draw.next()]).collect(),
            // A curve with bends, sampled now well and now badly.
            1 => (0..n)
                .map(|_| {
                    let angle = std::f64::consts::TAU * draw.next();
                    let radius = 1.0 + 0.4 * (5.0 * angle).cos();
                    [radius * angle.cos(), radius * angle.sin()]
                })
                .collect(),
            // Flat, so that circles are wide.
            _ => (0..n).map(|_| [draw.next(), 1e-4 * draw.next()]).collect(),
        };
        let sites = cloud(&points).sites;
        let silent = Monitor::silent();
        let found = sorted(crust::edges(&sites, &silent).expect("nobody cancels"));
        assert_eq!(found, crust_by_triangulation(&sites), "{round}: {n} points");
        let plane = graph::triangulate(&sites, &silent).expect("nobody cancels");
        fewer += one_step_crust::edges(&sites, &plane).len() - found.len();
    }
    assert!(fewer > 30, "the search rules out {fewer} edges of the one-step crust in all");
}
