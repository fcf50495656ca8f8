//! The mesh is a function of the set of sites: brute force over insertion orders of the most degenerate sets.

use super::*;
use crate::test_length::long_or;

/// Each order of the points, on each path of the signs in turn, as integers and not, must give `expected`.
fn all_orders(points: &[[f64; 3]], expected: &[[u32; 4]], levels: &[Level]) {
    let n = points.len();
    let mut order: Vec<u32> = (0..n as u32).collect();
    // Heap's algorithm (Comput. J. 6(3), 1963).
    let (mut count, mut i, mut run) = (vec![0; n], 0, 0);
    loop {
        let settings = Settings { integral: run % 2 == 0, ..PLAIN };
        let mesh = built(points, settings, Some(levels[run / 2 % levels.len()]), &order);
        assert_eq!(quadruples(&mesh), expected, "{points:?} in the order {order:?}");
        run += 1;
        while i < n && count[i] >= i {
            count[i] = 0;
            i += 1;
        }
        if i == n {
            return;
        }
        order.swap(i, if i % 2 == 0 { 0 } else { count[i] });
        count[i] += 1;
        i = 0;
    }
}

/// Brute force, and the ghosts on the facets that only one simplex has.
fn expected(points: &[[f64; 3]]) -> Vec<[u32; 4]> {
    let mut all = brute_force(points);
    let facets: Vec<[u32; 4]> = all
        .iter()
        .flat_map(|&[a, b, c, d]| {
            [[b, c, d, GHOST], [a, c, d, GHOST], [a, b, d, GHOST], [a, b, c, GHOST]]
        })
        .collect();
    all.extend(
        facets.iter().filter(|facet| facets.iter().filter(|other| other == facet).count() == 1),
    );
    all.sort_unstable();
    all
}

#[test]
fn every_order_of_the_cube_and_of_subsets_of_grids() {
    let levels = Level::filtered();
    let cube = grid(2);
    let answer = expected(&cube);
    assert_eq!(answer.len(), 6 + 12);
    all_orders(&cube, &answer, &levels);
    let mut numbers = Numbers(7);
    let mut sets: Vec<Vec<[f64; 3]>> = (0..8)
        .step_by(long_or(1, 3))
        .map(|out| [&cube[..out], &cube[out + 1..]].concat())
        .collect();
    while sets.len() < long_or(59, 5) {
        let all = grid(3);
        let set: Vec<[f64; 3]> =
            numbers.shuffled(27)[..7].iter().map(|&i| all[i as usize]).collect();
        if independent(&set, &[0, 1, 2, 3, 4, 5, 6]).is_some() {
            sets.push(set);
        }
    }
    for set in sets {
        all_orders(&set, &expected(&set), &levels);
    }
}

#[test]
fn grids_in_random_orders() {
    let mut numbers = Numbers(11);
    let levels = Level::filtered();
    for k in [3, 4] {
        let points = grid(k);
        let mut answer = None;
        for run in 0..400 {
            let order = numbers.shuffled(points.len());
            let settings = Settings { integral: run % 2 == 0, ..PLAIN };
            let mut mesh = built(&points, settings, Some(levels[run / 2 % levels.len()]), &order);
            assert_eq!(finite(&mesh), 6 * (k as usize - 1).pow(3));
            if run == 0 {
                check(&mut mesh);
            }
            let found = quadruples(&mesh);
            assert_eq!(answer.get_or_insert_with(|| found.clone()), &found, "order {order:?}");
        }
    }
}

#[test]
fn brute_force_gives_the_same_simplices() {
    let mut numbers = Numbers(13);
    for run in 0..300 {
        let n = 4 + numbers.below(9);
        let points: Vec<[f64; 3]> = match run % 3 {
            0 => numbers.points(n),
            // Small integers, by their thirds (which are not exact) or as they are.
            kind => {
                let all = grid(4);
                let scale = if kind == 1 { 1.0 } else { 1.0 / 3.0 };
                numbers.shuffled(64)[..n]
                    .iter()
                    .map(|&i| all[i as usize].map(|x| x * scale))
                    .collect()
            }
        };
        let order = numbers.shuffled(n);
        if independent(&points, &order).is_none() {
            continue;
        }
        for settings in
            [PLAIN, Settings { vectors: false, ..PLAIN }, Settings { filtered: false, ..PLAIN }]
        {
            let mut mesh = built(&points, settings, None, &order);
            check(&mut mesh);
            assert_eq!(quadruples(&mesh), expected(&points));
        }
    }
}

/// A small set with many ties: of a grid, of a slanted one, mostly in a plane, mostly on a line, or near a sphere.
fn hard_set(numbers: &mut Numbers) -> Vec<[f64; 3]> {
    let (n, k, kind) = (5 + numbers.below(60), 2 + numbers.below(6), numbers.below(5));
    let scale = [1.0, 1.0 / 3.0, 1000.0, 0.1, 1e-30][numbers.below(5)];
    let slant = [0; 9].map(|_: u8| numbers.below(7) as f64 - 3.0);
    let mut points = Vec::new();
    for _ in 0..n {
        let [x, y, z] = [0; 3].map(|_: u8| numbers.below(k) as f64);
        let off = numbers.below(8) == 0;
        let p = match kind {
            1 => [0, 3, 6].map(|i| slant[i] * x + slant[i + 1] * y + slant[i + 2] * z),
            2 if !off => [x, y, x + y],
            3 if !off => [x, 2.0 * x, 3.0 * x],
            4 => [x, y, z].map(|w| w / (x * x + y * y + z * z).sqrt().max(1.0)),
            _ => [x, y, z],
        };
        // 0 is added, as there is no −0 in a mesh.
        let p = p.map(|w| w * scale + 0.0);
        if !points.contains(&p) {
            points.push(p);
        }
    }
    points
}

#[test]
fn hard_sets_have_one_mesh_on_every_path_and_in_every_order() {
    let mut numbers = Numbers(17);
    let levels = [Level::filtered(), vec![Level::Unfiltered]].concat();
    for _ in 0..400 {
        let points = hard_set(&mut numbers);
        let order = numbers.shuffled(points.len());
        if points.len() < 5 || independent(&points, &order).is_none() {
            continue;
        }
        let integral = points.iter().flatten().all(|x| x.fract() == 0.0);
        let mut answer = None;
        for &level in &levels {
            let order = numbers.shuffled(points.len());
            let mut mesh = built(&points, Settings { integral, ..PLAIN }, Some(level), &order);
            check(&mut mesh);
            let found = quadruples(&mesh);
            assert_eq!(answer.get_or_insert_with(|| found.clone()), &found, "{points:?}");
        }
    }
}
