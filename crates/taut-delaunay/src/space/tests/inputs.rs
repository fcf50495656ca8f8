//! Inputs that have broken other kernels, and what can be said of their meshes.

use super::*;

/// Builds on every path and in several orders, checks each, and returns one.
fn checked(points: &[[f64; 3]], settings: Settings) -> Mesh {
    let mut numbers = Numbers(points.len() as u64);
    let n = points.len();
    let mut mesh = built(points, settings, None, &numbers.shuffled(n));
    check(&mut mesh);
    let answer = quadruples(&mesh);
    let levels = if settings.filtered { Level::filtered() } else { vec![Level::Unfiltered; 3] };
    for level in levels {
        for order in [numbers.shuffled(n), (0..n as u32).collect(), (0..n as u32).rev().collect()] {
            assert_eq!(
                quadruples(&built(points, settings, Some(level), &order)),
                answer,
                "{level:?}"
            );
        }
    }
    mesh
}

#[test]
fn uniform_points_in_hilbert_order() {
    let points = hilbert(Numbers(1).points(3000));
    let (first, order) = rounds(&points);
    let mut counters = Vec::new();
    for level in Level::filtered() {
        let mut mesh = Mesh::new(points.clone(), PLAIN);
        mesh.level = level;
        mesh.start(first);
        mesh.insert(&order).unwrap();
        let (simplices, _, counted) = mesh.finish();
        assert_eq!(counted.insertions, 3000);
        assert_eq!(counted.stages.calls(), counted.orientations + counted.conflict_tests);
        assert!(
            counted.stages.calls() - counted.stages.filter <= counted.stages.calls() / 10_000,
            "{level:?} {counted:?}"
        );
        counters.push((simplices, counted));
    }
    // The scalar path without fused multiplication may leave other signs open.
    counters.dedup_by_key(|(simplices, _)| simplices.clone());
    assert_eq!(counters.len(), 1, "even the slots are the same on every path");
    checked(&points, PLAIN);
}

#[test]
fn cospherical_integers() {
    // x² + y² + z² = 9² has 102 solutions, so does no simplex' sphere hold any point: all ties.
    let axis = || (-9..=9).map(f64::from);
    let points: Vec<[f64; 3]> = axis()
        .flat_map(|x| axis().flat_map(move |y| axis().map(move |z| [x, y, z])))
        .filter(|[x, y, z]| x * x + y * y + z * z == 81.0)
        .collect();
    assert_eq!(points.len(), 102);
    let mesh = checked(&points, Settings { integral: true, ..PLAIN });
    assert_eq!(quadruples(&mesh), quadruples(&checked(&points, PLAIN)));
}

#[test]
fn octahedron_with_its_center_and_two_more() {
    let mut points = vec![[0.0; 3], [0.0, 0.0, 0.5], [0.5, 0.0, 0.0]];
    for i in 0..3 {
        for sign in [1.0, -1.0] {
            let mut p = [0.0; 3];
            p[i] = sign;
            points.push(p);
        }
    }
    let mut mesh = checked(&points, PLAIN);
    check(&mut mesh);
    let finite: Vec<_> = quadruples(&mesh).into_iter().filter(|s| s[3] != GHOST).collect();
    assert_eq!(finite, brute_force(&points));
}

#[test]
fn two_skew_lines_make_a_quadratic_mesh_and_too_many_is_an_error() {
    let k = 40;
    let at = |i: usize| i as f64 / 8.0 - 2.0;
    let points: Vec<[f64; 3]> =
        (0..k).map(|i| [at(i), 0.0, -1.0]).chain((0..k).map(|i| [0.0, at(i), 1.0])).collect();
    let mesh = checked(&points, PLAIN);
    assert_eq!(finite(&mesh), (k - 1) * (k - 1));
    let order: Vec<u32> = Numbers(3).shuffled(2 * k);
    let first = independent(&points, &order).unwrap();
    let mut mesh = Mesh::new(points.clone(), PLAIN);
    mesh.limit = 1000;
    mesh.start(first);
    let rest: Vec<u32> = order.into_iter().filter(|i| !first.contains(i)).collect();
    assert_eq!(mesh.insert(&rest), Err(TooMany));
    assert!(mesh.simplices().len() <= 1000);
}

#[test]
fn the_star_of_an_apex_is_the_triangulation_of_the_plane() {
    // A slanted plane, so that no coordinate is zero; (x, y) ↦ (x, y, 2x + 3y) keeps the order of the perturbation.
    let flat: Vec<[f64; 2]> = (0..16).map(|i| [f64::from(i % 4), f64::from(i / 4)]).collect();
    for lift in [[0.0, 0.0], [2.0, 3.0]] {
        let mut points: Vec<[f64; 3]> =
            flat.iter().map(|&[x, y]| [x, y, lift[0] * x + lift[1] * y]).collect();
        let apex = points.len() as u32;
        points.push([1.3, 1.7, 50.0]);
        let mesh = checked(&points, PLAIN);
        // A slanted plane has circles of its own; only the level one has those of (x, y).
        let bases: Vec<[u32; 4]> = quadruples(&mesh).into_iter().filter(|s| s[3] == apex).collect();
        assert_eq!(bases.len(), 18);
        if lift == [0.0, 0.0] {
            for &[a, b, c, _] in &bases {
                let [mut pa, pb, mut pc] = [a, b, c].map(|v| flat[v as usize]);
                if taut_predicates::plane::orient(pa, pb, pc).is_negative() {
                    std::mem::swap(&mut pa, &mut pc);
                }
                for q in (0..16).filter(|q| ![a, b, c].contains(q)) {
                    assert!(!taut_predicates::plane::conflict(pa, pb, pc, flat[q as usize]));
                }
            }
        }
    }
}

#[test]
fn a_line_and_two_points() {
    let mut points: Vec<[f64; 3]> = (0..50).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    points.extend([[20.5, 7.0, 0.0], [3.25, 0.0, 5.0]]);
    assert_eq!(finite(&checked(&points, PLAIN)), 49);
}

#[test]
fn a_boundary_too_large_for_the_table_is_paired_by_hash() {
    // A plane full of sites under an apex; then a second apex, whose cavity is bounded by all of them.
    let mut points: Vec<[f64; 3]> =
        (0..900).map(|i| [f64::from(i % 30), f64::from(i / 30), 0.0]).collect();
    points.push([14.5, 14.5, -100.0]);
    points.push([14.5, 14.5, 100.0]);
    let order: Vec<u32> = [900].into_iter().chain(0..900).chain([901]).collect();
    let settings = Settings { integral: false, ..PLAIN };
    let mut mesh = built(&points, settings, None, &order);
    check(&mut mesh);
    assert_eq!(finite(&mesh), 2 * 2 * 29 * 29);
    let reversed: Vec<u32> = order.into_iter().rev().collect();
    assert_eq!(quadruples(&mesh), quadruples(&built(&points, settings, None, &reversed)));
}

#[test]
fn near_duplicates() {
    let mut points = Vec::new();
    for p in Numbers(5).points(12) {
        points.push(p);
        for i in 0..3 {
            let mut q = p;
            q[i] = q[i].next_up();
            points.push(q);
        }
    }
    checked(&points, PLAIN);
}

#[test]
fn magnitudes_beyond_the_filters() {
    let settings = Settings { filtered: false, ..PLAIN };
    let unit = Numbers(17).points(24);
    let answer = quadruples(&checked(&unit, PLAIN));
    for exponent in [-1000, -500, 500] {
        let scaled: Vec<[f64; 3]> =
            unit.iter().map(|p| p.map(|x| x * 2.0f64.powi(exponent))).collect();
        assert_eq!(quadruples(&checked(&scaled, settings)), answer, "2^{exponent}");
    }
    let tiny = f64::from_bits(1);
    let subnormal: Vec<[f64; 3]> = grid(3).iter().map(|p| p.map(|x| x * tiny)).collect();
    assert_eq!(quadruples(&checked(&subnormal, settings)), quadruples(&checked(&grid(3), PLAIN)));
    // Large and small side by side.
    let mixed: Vec<[f64; 3]> =
        unit.iter().enumerate().map(|(i, p)| p.map(|x| x * [1e150, 1e-150][i % 2])).collect();
    checked(&mixed, settings);
    // Differences whose products underflow, in the range of the filters.
    let close: Vec<[f64; 3]> = unit.iter().map(|p| p.map(|x| x * 1e-120)).collect();
    checked(&close, PLAIN);
}
