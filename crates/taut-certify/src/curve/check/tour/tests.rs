//! The bound beside least 1-trees of all edges and shortest tours.

use super::*;

fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn apart(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

fn bound(points: &[[f64; 2]], potentials: &[f64], open: bool) -> f64 {
    tour_bound(points, potentials, open, &Monitor::silent()).expect("not stopped")
}

/// Prim's tree of all edges.
fn naive_tree(points: &[[f64; 2]], pi: &[f64]) -> f64 {
    let n = points.len();
    let weight = |i: usize, j: usize| apart(points[i], points[j]) + pi[i] + pi[j];
    let mut near: Vec<f64> = (0..n).map(|j| weight(0, j)).collect();
    let mut inside = vec![false; n];
    inside[0] = true;
    let mut total = 0.0;
    for _ in 1..n {
        let next = (0..n)
            .filter(|&j| !inside[j])
            .min_by(|&a, &b| near[a].total_cmp(&near[b]))
            .expect("one is left");
        inside[next] = true;
        total += near[next];
        for j in 0..n {
            near[j] = near[j].min(weight(next, j));
        }
    }
    total
}

fn naive_bound(points: &[[f64; 2]], pi: &[f64], open: bool) -> f64 {
    let mut least: Vec<f64> = if open {
        pi.to_vec()
    } else {
        (1..points.len()).map(|i| apart(points[0], points[i]) + pi[0] + pi[i]).collect()
    };
    least.sort_by(f64::total_cmp);
    let from = usize::from(!open);
    naive_tree(&points[from..], &pi[from..]) + least[0] + least[1] - 2.0 * pi.iter().sum::<f64>()
}

#[test]
fn the_bound_is_that_of_the_least_one_tree_of_all_edges() {
    for (n, seed) in [3, 4, 9, 40, 300].into_iter().flat_map(|n| (0..8).map(move |s| (n, s))) {
        let mut random = numbers(seed * 1000 + n as u64);
        // Curves, grids with ties, and potentials from none to larger than any distance.
        let points: Vec<[f64; 2]> = (0..n)
            .map(|_| match seed % 3 {
                0 => [random(), random()],
                1 => [random(), random()].map(|x| (x * 8.0).floor()),
                _ => [(6.0 * random()).cos(), random() * 1e-3],
            })
            .collect();
        for size in [0.0, 0.05, 1.0, 3.0] {
            // Up to what the checker takes: larger potentials are cut, and the bound is another one.
            let extent = points.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
            let size = size * extent;
            let pi: Vec<f64> = (0..n).map(|_| (random() - 0.5) * size).collect();
            for open in [false, true] {
                let (found, naive) = (bound(&points, &pi, open), naive_bound(&points, &pi, open));
                let naive = naive.max(0.0);
                let slack = 1e-11 * (n as f64) * (8.0 + size);
                assert!((found - naive).abs() <= slack, "{n} {seed} {size}: {found} {naive}");
            }
        }
    }
}

/// By Held and Karp's dynamic program.
fn shortest(points: &[[f64; 2]], open: bool) -> f64 {
    let n = points.len();
    let mut best = vec![vec![f64::INFINITY; n]; 1 << n];
    for v in 0..n {
        if open || v == 0 {
            best[1 << v][v] = 0.0;
        }
    }
    for set in 1..1usize << n {
        for v in 0..n {
            for u in (0..n).filter(|&u| set & (1 << u) == 0) {
                let through = best[set][v] + apart(points[v], points[u]);
                let of = &mut best[set | 1 << u][u];
                *of = of.min(through);
            }
        }
    }
    let last = &best[(1 << n) - 1];
    let back = |v: usize| if open { 0.0 } else { apart(points[v], points[0]) };
    (0..n).map(|v| last[v] + back(v)).fold(f64::INFINITY, f64::min)
}

/// Whatever the potentials, doctored ones too, and with equal points: no bound is above the shortest tour.
#[test]
fn no_potentials_prove_more_than_the_shortest_tour() {
    for (n, seed) in (2..9).flat_map(|n| (0..6).map(move |seed| (n, seed))) {
        let mut random = numbers(seed * 77 + n as u64);
        let mut points: Vec<[f64; 2]> = (0..n).map(|_| [random(), random()]).collect();
        if seed == 0 {
            points[n - 1] = points[0];
        }
        for open in [false, true] {
            let best = shortest(&points, open);
            for trial in 0..40 {
                let size = [0.0, 0.3, 3.0, 1e9, 1e300][trial % 5];
                let mut pi: Vec<f64> = (0..n).map(|_| (random() - 0.5) * size).collect();
                match trial % 7 {
                    1 => pi[n / 2] = f64::NAN,
                    2 => pi[0] = f64::INFINITY,
                    3 => pi.truncate(n / 2),
                    4 => pi[0] = f64::MAX,
                    _ => {}
                }
                let found = bound(&points, &pi, open);
                assert!((0.0..=best * (1.0 + 1e-12)).contains(&found), "{found} {best} {pi:?}");
            }
        }
    }
}

#[test]
fn bounds_that_are_lengths_are_rounded_down_and_lengths_up() {
    assert_eq!(bound(&[], &[], false), 0.0);
    assert_eq!(bound(&[[3.0, 4.0]], &[1.0], true), 0.0);
    assert_eq!((tour_length(&[], true), tour_length(&[[3.0, 4.0]], false)), (0.0, 0.0));
    for scale in [1.0, 1e-300, 1e-310, 1e300] {
        let pair = [[0.0, 0.0], [3.0 * scale, 4.0 * scale]];
        for (open, length) in [(true, 5.0 * scale), (false, 10.0 * scale)] {
            let below = bound(&pair, &[0.5 * scale, -0.25 * scale], open);
            assert!(below <= length && below >= length * (1.0 - 1e-9), "{below} {length}");
            let above = tour_length(&pair, open);
            assert!(above >= length && above <= length * (1.0 + 1e-9), "{above} {length}");
        }
    }
    // A triangle is its own 1-tree.
    let triangle = [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]];
    let below = bound(&triangle, &[0.1, 5.0, -7.0], false);
    assert!(below <= 12.0 && below > 12.0 - 1e-9, "{below}");
    let above = tour_length(&triangle, false);
    assert!((12.0..12.0 + 1e-9).contains(&above), "{above}");
    assert!(bound(&[[-1.7e308; 2], [1.7e308; 2]], &[0.0; 2], false).is_finite());
}

#[test]
fn threads_change_nothing_and_a_stop_is_heard() {
    let mut random = numbers(11);
    let points: Vec<[f64; 2]> = (0..3000).map(|_| [random(), random()]).collect();
    let pi: Vec<f64> = (0..3000).map(|_| random() * 0.01).collect();
    let plain = bound(&points, &pi, false);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        assert_eq!(pool.install(|| bound(&points, &pi, false)), plain);
    }
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let monitor = Monitor { cancel: Some(&cancel), ..Monitor::silent() };
    assert_eq!(tour_bound(&points, &pi, true, &monitor), Err(Cancelled));
}
