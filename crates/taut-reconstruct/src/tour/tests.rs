//! Tours beside the best of all, and laws.

use taut_points::{InputError, Monitor};

use super::*;

fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn find(sites: &[[f64; 2]], open: bool) -> Tour {
    let found = tour(sites, open, &Monitor::silent()).expect("not stopped");
    let mut order = found.order.clone();
    order.sort_unstable();
    assert_eq!(order, (0..sites.len() as u32).collect::<Vec<_>>());
    let by_order: f64 = {
        let steps = found.order.windows(2).map(|w| [w[0], w[1]]);
        let back = found.order.last().zip(found.order.first()).filter(|_| found.closed);
        let all = steps.chain(back.map(|(&a, &b)| [a, b]));
        all.map(|e| e.map(|v| sites[v as usize]))
            .map(|[p, q]| (p[0] - q[0]).hypot(p[1] - q[1]))
            .sum()
    };
    assert!((found.length - by_order).abs() <= 1e-12 * by_order, "{} {by_order}", found.length);
    assert!(found.lower <= found.length, "{} {}", found.lower, found.length);
    found
}

/// The shortest, by Held and Karp's dynamic program.
fn shortest(sites: &[[f64; 2]], open: bool) -> f64 {
    let n = sites.len();
    let d = |i: usize, j: usize| (sites[i][0] - sites[j][0]).hypot(sites[i][1] - sites[j][1]);
    let mut best = vec![vec![f64::INFINITY; n]; 1 << n];
    for v in 0..n {
        if open || v == 0 {
            best[1 << v][v] = 0.0;
        }
    }
    for set in 1..1usize << n {
        for v in 0..n {
            for u in (0..n).filter(|&u| set & (1 << u) == 0) {
                let through = best[set][v] + d(v, u);
                let of = &mut best[set | 1 << u][u];
                *of = of.min(through);
            }
        }
    }
    let last = &best[(1 << n) - 1];
    (0..n).map(|v| last[v] + if open { 0.0 } else { d(v, 0) }).fold(f64::INFINITY, f64::min)
}

#[test]
fn few_sites_have_tours_close_to_the_shortest_and_bounds_below() {
    let (mut exact, mut runs) = (0, 0);
    for n in 3..12 {
        for seed in 0..12 {
            let mut random = numbers(seed * 100 + n);
            let coarse = seed % 3 == 0;
            let mut sites: Vec<[f64; 2]> = (0..n)
                .map(|_| [random(), random()].map(|x| if coarse { (x * 4.0).floor() } else { x }))
                .collect();
            sites.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
            sites.dedup();
            for open in [false, true] {
                let found = find(&sites, open);
                let best = shortest(&sites, !found.closed);
                assert!(found.lower <= best * (1.0 + 1e-12), "{sites:?}");
                assert!(found.length <= best * 1.1 + 1e-12, "{} {best} {sites:?}", found.length);
                runs += 1;
                exact += u32::from(found.length <= best * (1.0 + 1e-9));
            }
        }
    }
    assert!(exact * 50 >= runs * 49, "{exact} of {runs}");
}

#[test]
fn nothing_is_too_few_and_a_line_is_a_path() {
    assert_eq!(find(&[], false), Tour::default());
    let one = find(&[[1.0, 2.0]], true);
    assert_eq!((one.closed, one.length, one.lower), (false, 0.0, 0.0));
    for scale in [1.0, 1e-300, 5e-324, 1e300, 1.7e308] {
        let sites = [[0.0, 0.0], [0.5, 0.25], [1.0, 0.5], [-1.0, -0.5]];
        let sites = sites.map(|p: [f64; 2]| p.map(|x| x * scale));
        let mut sites = sites.to_vec();
        sites.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
        sites.dedup();
        let found = find_any(&sites);
        assert!(!found.closed);
        assert!(found.order.iter().copied().eq(0..sites.len() as u32), "{:?}", found.order);
    }
}

/// In units of the extent the first coordinates are infinite.
#[test]
fn a_short_line_far_from_the_origin_is_a_path() {
    let sites = [0.0, 1e-300, 3e-300].map(|y| [1e300, y]);
    let found = find_any(&sites);
    assert_eq!((found.closed, &found.order[..]), (false, &[0, 1, 2][..]));
    assert!((found.length - 3e-300).abs() <= 1e-312, "{}", found.length);
    assert!((found.lower - 3e-300).abs() <= 1e-312, "{}", found.lower);
}

/// Without the comparison of lengths, which may be beyond the largest number.
fn find_any(sites: &[[f64; 2]]) -> Tour {
    tour(sites, false, &Monitor::silent()).expect("not stopped")
}

#[test]
fn scales_by_powers_of_two_change_nothing() {
    let mut random = numbers(7);
    let sites: Vec<[f64; 2]> = (0..60).map(|_| [random(), random()]).collect();
    let plain = find(&sites, false);
    for exponent in [-900, -30, 30, 900] {
        let scale = 2f64.powi(exponent);
        let scaled: Vec<[f64; 2]> = sites.iter().map(|p| p.map(|x| x * scale)).collect();
        let found = find_any(&scaled);
        assert_eq!(found.order, plain.order, "{exponent}");
        assert_eq!(found.lower, plain.lower * scale, "{exponent}");
    }
}

/// A dense sample of a closed curve: its shortest tour is the curve, and the bound says so.
#[test]
fn dense_samples_of_a_curve_give_the_curve_with_a_closed_bound() {
    for (open, share) in [(false, 1.0), (true, 0.8)] {
        let mut random = numbers(3);
        let n = 1500;
        let angle =
            |i: usize, u: f64| share * std::f64::consts::TAU * (i as f64 + 0.6 * u) / n as f64;
        let at = |t: f64| [(3.0 + (5.0 * t).cos()) * t.cos(), (3.0 + (5.0 * t).cos()) * t.sin()];
        let sites: Vec<[f64; 2]> = (0..n).map(|i| at(angle(i, random()))).collect();
        let found = find(&sites, open);
        let n = n as u32;
        let step = |w: &[u32]| (w[0] + 1) % n == w[1] || (w[1] + 1) % n == w[0];
        assert!(found.order.windows(2).all(step));
        assert!(found.length <= found.lower * (1.0 + 1e-6), "{} {}", found.length, found.lower);
    }
}

/// Random samples have gaps that the least tree leaves out; potentials read off the tour prove them at once.
#[test]
fn random_samples_of_a_curve_are_proved_in_a_few_steps() {
    for seed in 0..6 {
        let mut random = numbers(seed);
        let n = 3000u32;
        let mut angles: Vec<f64> = (0..n).map(|_| std::f64::consts::TAU * random()).collect();
        angles.sort_by(f64::total_cmp);
        let at = |&t: &f64| [(3.0 + (5.0 * t).cos()) * t.cos(), (3.0 + (5.0 * t).cos()) * t.sin()];
        let sites: Vec<[f64; 2]> = angles.iter().map(at).collect();
        let found = find(&sites, false);
        let step = |w: &[u32]| (w[0] + 1) % n == w[1] || (w[1] + 1) % n == w[0];
        assert!(found.order.windows(2).all(step), "{seed}");
        assert!(found.events.steps <= 12, "{seed}: {}", found.events.steps);
        assert!(found.length <= found.lower * (1.0 + 3e-7), "{} {}", found.length, found.lower);
    }
}

fn ring(n: usize, radius: f64, x: f64) -> impl Iterator<Item = [f64; 2]> {
    (0..n).map(move |i| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
        [x + radius * cos, radius * sin]
    })
}

/// Three rings apart: the tour has to leave and return, and the least trees do not see that at first.
#[test]
fn rings_apart_have_close_bounds() {
    let mut sites: Vec<[f64; 2]> =
        ring(90, 1.0, 0.0).chain(ring(60, 0.5, 0.0)).chain(ring(80, 1.0, 5.0)).collect();
    sites.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
    for open in [false, true] {
        let found = find(&sites, open);
        assert!(found.length <= 1.01 * found.lower, "{} {}", found.length, found.lower);
    }
}

/// Clusters of random points, whose tours and bounds take more than the usual steps and perturbations.
#[test]
fn clusters_have_close_bounds() {
    for clusters in [3, 6, 12] {
        let mut random = numbers(clusters);
        let mut sites = Vec::new();
        for _ in 0..clusters {
            let corner = [10.0 * random(), 10.0 * random()];
            sites.extend((0..240 / clusters).map(|_| corner.map(|x| x + random() + random())));
        }
        sites.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
        let found = find(&sites, false);
        assert!(found.length <= 1.04 * found.lower, "{clusters}: {} {}", found.length, found.lower);
    }
}

#[test]
fn uniform_points_are_within_five_percent_of_their_bound_and_threads_change_nothing() {
    let mut random = numbers(5);
    let sites: Vec<[f64; 2]> = (0..1200).map(|_| [random(), random()]).collect();
    for open in [false, true] {
        let found = find(&sites, open);
        assert!(found.length <= 1.05 * found.lower, "{} {}", found.length, found.lower);
        for threads in [1, 3] {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            assert_eq!(pool.install(|| find(&sites, open)), found);
        }
    }
}

#[test]
fn grids_have_tours_that_do_not_meet_themselves() {
    for side in [2, 3, 5, 12] {
        let sites: Vec<[f64; 2]> =
            (0..side * side).map(|i| [f64::from(i % side), f64::from(i / side)]).collect();
        for open in [false, true] {
            let found = find(&sites, open);
            let mut order = found.order.clone();
            if open {
                order.push(sites.len() as u32);
            }
            let changed = untangle(&sites, &mut Cycle::new(order), &Monitor::silent());
            assert_eq!(changed.expect("not stopped"), 0);
        }
    }
}

#[test]
fn a_stop_is_heard() {
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let monitor = Monitor { cancel: Some(&cancel), ..Monitor::silent() };
    let mut random = numbers(1);
    let sites: Vec<[f64; 2]> = (0..500).map(|_| [random(), random()]).collect();
    assert!(matches!(
        tour(&sites, false, &monitor),
        Err(Error::Input(InputError::Cancelled(_)) | Error::Triangulation(_))
    ));
}
