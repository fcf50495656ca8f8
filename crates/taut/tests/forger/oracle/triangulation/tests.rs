//! Honest triangulations are true, doctored ones are not.

use taut::certify::Triangulation;
use taut::certify::{Fingerprint, NO_NEIGHBOR, TriangulationVerdict};
use taut::{DelaunayOptions, Points, Solution, delaunay};

use super::super::Truth;
use super::super::numbers::numbers;
use super::TriangulationOracle;

/// Point sets in the plane and in space: in general position, on grids, circles, lines and planes, with copies, at the ends
/// of the range, and hardly any.
fn inputs() -> Vec<(usize, Vec<f64>)> {
    let mut inputs = vec![];
    for columns in [2, 3] {
        for n in 0..7 {
            let mut random = numbers(n as u64);
            inputs.push((columns, (0..n * columns).map(|_| random()).collect()));
        }
        for seed in 0..6 {
            let mut random = numbers(100 + seed);
            let n = if columns == 2 { 40 } else { 24 };
            inputs.push((columns, (0..n * columns).map(|_| random() - 0.5).collect()));
            // Small whole numbers: ties, copies and flat parts.
            let side = 2.0 + seed as f64;
            let grid = |_| (random() * side).floor();
            inputs.push((columns, (0..n * columns).map(grid).collect()));
        }
        for scale in [1e-150, 1e150, 5e-324, 1e300] {
            let mut random = numbers(7);
            let whole = |_| (random() * 4.0).floor() * scale;
            inputs.push((columns, (0..14 * columns).map(whole).collect()));
        }
        let line = |k: usize| (0..columns).map(move |c| (k * k % 17 * (c + 1)) as f64);
        inputs.push((columns, (0..12).flat_map(line).collect()));
        inputs.push((columns, vec![3.0; 5 * columns]));
    }
    let circle = [(5, 0), (4, 3), (3, 4), (0, 5), (-3, 4), (-4, 3), (-5, 0), (-4, -3), (0, -5)];
    inputs.push((2, circle.iter().flat_map(|&(x, y)| [f64::from(x), f64::from(y)]).collect()));
    inputs.push((2, vec![0.0, 1.0, -0.0, 1.0, 1.0, -0.0, 2.0, 2.0, 0.0, 1.0]));
    // A far point among near ones, and coordinates of all sizes.
    for far in [1e6, 1e16, 1e300] {
        let near = circle.iter().flat_map(|&(x, y)| [f64::from(x) / 3.0, f64::from(y)]);
        inputs.push((2, near.chain([far, far / 3.0]).collect()));
    }
    for columns in [2, 3] {
        let mut random = numbers(11);
        let sized = |_| random() * 10f64.powf((random() * 40.0 - 20.0).floor());
        inputs.push((columns, (0..12 * columns).map(sized).collect()));
    }
    // The sphere of radius 3, the planes x + y = z and x = 1 with grids, and the unit cube twice.
    let sphere = |_: usize| {
        let whole = -3i32..=3;
        let all = whole.clone().flat_map(move |x| whole.clone().map(move |y| (x, y)));
        all.flat_map(|(x, y)| (-3..=3).map(move |z| [x, y, z]))
            .filter(|[x, y, z]| x * x + y * y + z * z == 9)
            .flat_map(|p| p.map(f64::from))
            .collect::<Vec<f64>>()
    };
    inputs.push((3, sphere(0)));
    for plane in 0..4 {
        let mut random = numbers(plane);
        let point = |_| {
            let [a, b] = [(random() * 4.0).floor(), (random() * 4.0).floor()];
            match plane {
                0 => [a, b, a + b],
                1 => [1.0, a, b],
                2 => [a, -2.0, b],
                _ => [a, a, b],
            }
        };
        inputs.push((3, (0..16).flat_map(point).collect()));
    }
    inputs
}

fn solved(columns: usize, values: &[f64]) -> (Solution<Triangulation>, TriangulationVerdict) {
    let points = Points::new(values, columns).expect("rows");
    let found = delaunay(&points, &DelaunayOptions::default()).expect("solved");
    let verdict = found.check(&points).expect("accepted");
    (found, verdict)
}

#[test]
fn honest_triangulations_are_true() {
    for (columns, values) in inputs() {
        let (mut found, verdict) = solved(columns, &values);
        let oracle = TriangulationOracle::new(&values, columns);
        assert_eq!(oracle.judge(&found, &verdict), Truth::True, "{columns} {values:?}");
        found.certificate.neighbors.clear();
        assert_eq!(oracle.judge(&found, &verdict), Truth::True, "{columns} {values:?}");
    }
}

/// Each change alone is a lie, on every input on which it is a change.
#[test]
fn doctored_triangulations_are_false() {
    type Change = fn(&mut Solution<Triangulation>, &mut TriangulationVerdict);
    let changes: [(&str, Change); 17] = [
        ("two ids exchanged", |found, _| {
            if found.answer.simplices.len() > 1 {
                found.answer.simplices.swap(0, 1);
            }
        }),
        ("another id", |found, _| {
            let Some(&last) = found.answer.simplices.last() else { return };
            if let Some(id) = found.answer.simplices.iter_mut().find(|id| **id != last) {
                *id = last;
            }
        }),
        ("a simplex twice", |found, _| {
            let row = found.answer.rows().next().map(<[u32]>::to_vec);
            found.answer.simplices.extend(row.into_iter().flatten());
        }),
        ("a simplex less", |found, _| {
            let width = found.answer.vertices_per_simplex();
            let rest = found.answer.simplices.len().saturating_sub(width);
            found.answer.simplices.truncate(rest);
        }),
        ("a diagonal flipped", flip),
        ("a hull facet less", |found, _| {
            let width = found.answer.hull_dimension.map_or(1, usize::from);
            let rest = found.answer.hull.len().saturating_sub(width);
            found.answer.hull.truncate(rest);
        }),
        ("a hull facet turned", |found, _| {
            if found.answer.hull.len() > 1 {
                found.answer.hull.swap(0, 1);
            }
        }),
        ("a duplicate less", |found, _| {
            found.answer.duplicates.pop();
        }),
        ("a duplicate of another", |found, _| {
            if let Some(pair) = found.answer.duplicates.last_mut() {
                pair[1] = pair[0];
            }
        }),
        ("another dimension", |found, _| found.answer.dimension ^= 1),
        ("another hull dimension", |found, _| {
            found.answer.hull_dimension = found.answer.hull_dimension.map_or(Some(0), |_| None);
        }),
        ("one site more", |found, verdict| {
            found.certificate.counts.sites += 1;
            verdict.counts.sites += 1;
        }),
        ("another fingerprint", |found, verdict| {
            found.certificate.fingerprint = Fingerprint(found.certificate.fingerprint.0 ^ 1);
            verdict.fingerprint = found.certificate.fingerprint;
        }),
        ("a tie more", |_, verdict| {
            verdict.ties += 1;
            verdict.refined += 1;
        }),
        ("more refined than there are", |_, verdict| verdict.refined += 1 << 31),
        ("a neighbor changed", |found, _| {
            if let Some(neighbor) = found.certificate.neighbors.first_mut() {
                *neighbor = if *neighbor == NO_NEIGHBOR { 0 } else { NO_NEIGHBOR };
            }
        }),
        ("another hash", |found, _| {
            let other = Points::new(&[1.5], 1).expect("one row");
            let hash = taut::points::hash_points(&other, &taut::Monitor::silent());
            found.certificate.points_hash = hash.expect("in memory");
        }),
    ];
    let mut judged = [0; 17];
    for (columns, values) in inputs() {
        let honest = solved(columns, &values);
        let oracle = TriangulationOracle::new(&values, columns);
        for (count, (name, change)) in judged.iter_mut().zip(&changes) {
            let (mut found, mut verdict) = honest.clone();
            change(&mut found, &mut verdict);
            if (&found, verdict) != (&honest.0, honest.1) {
                let truth = oracle.judge(&found, &verdict);
                assert!(matches!(truth, Truth::False(_)), "{name}: {truth:?} {columns} {values:?}");
                *count += 1;
            }
        }
    }
    assert!(judged.iter().all(|&count| count >= 5), "{judged:?}");
}

/// Exchanges the diagonal of the first two triangles that share an edge.
fn flip(found: &mut Solution<Triangulation>, _: &mut TriangulationVerdict) {
    if found.answer.hull_dimension != Some(2) {
        return;
    }
    let (rows, neighbors) = (&mut found.answer.simplices, &found.certificate.neighbors);
    let Some(place) = neighbors.iter().position(|&neighbor| neighbor != NO_NEIGHBOR) else {
        return;
    };
    let (one, other) = (place / 3, neighbors[place] as usize);
    let triangle = |at: usize| [rows[3 * at], rows[3 * at + 1], rows[3 * at + 2]];
    let (t, u) = (triangle(one), triangle(other));
    let [apex, a, b] = [t[place % 3], t[(place + 1) % 3], t[(place + 2) % 3]];
    let beyond = u.into_iter().find(|v| *v != a && *v != b).expect("a third vertex");
    rows[3 * one..3 * one + 3].copy_from_slice(&[apex, a, beyond]);
    rows[3 * other..3 * other + 3].copy_from_slice(&[apex, beyond, b]);
    found.certificate.neighbors.clear();
}
