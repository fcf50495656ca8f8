//! Honest surfaces are true, doctored ones are not.

use taut::certify::Surface;
use taut::certify::{Apex, SurfaceMethod, SurfaceMode, SurfaceVerdict};
use taut::reconstruct::{Denoise, Positions, SurfaceMode as Mode};
use taut::{Points, Solution, SurfaceOptions, surface};

use super::super::Truth;
use super::super::numbers::numbers;
use super::{Point, SurfaceOracle};
use crate::test_length::long_or;

type Solved = (Solution<Surface>, SurfaceVerdict);

fn flat(points: impl IntoIterator<Item = Point>) -> Vec<f64> {
    points.into_iter().flatten().collect()
}

fn sphere(n: usize, radius: f64) -> impl Iterator<Item = Point> {
    (0..n).map(move |k| {
        let z = 1.0 - (2 * k + 1) as f64 / n as f64;
        let (r, t) = ((1.0 - z * z).sqrt(), 2.399_963_229_728_653 * k as f64);
        [r * t.cos(), r * t.sin(), z].map(|x| radius * x)
    })
}

/// Spheres, one in another, a torus, the shell of a grid, sheets, noise, copies, lines, planes and few points, at several
/// scales.
fn inputs() -> Vec<Vec<f64>> {
    let mut inputs = vec![vec![], vec![1.0; 9]];
    for n in [4, 6, 12, 30, 60] {
        inputs.push(flat(sphere(n, 1.0)));
    }
    inputs.push(flat(sphere(40, 3.0).chain(sphere(20, 0.5))));
    inputs.push(flat(sphere(30, 1.0).chain(sphere(6, 1.0))));
    inputs.push(flat(sphere(36, 1.0).chain([[0.0; 3], [9.0, 9.0, 9.0], [0.1, 0.2, 0.3]])));
    let torus = (0..12).flat_map(|i| {
        (0..5).map(move |j| {
            let [s, t] = [i as f64 / 12.0, j as f64 / 5.0].map(|x| std::f64::consts::TAU * x);
            let r = 3.0 + t.cos();
            [r * s.cos(), r * s.sin(), t.sin()]
        })
    });
    inputs.push(flat(torus));
    let whole =
        |n: i32| (0..n).flat_map(move |x| (0..n).flat_map(move |y| (0..n).map(move |z| [x, y, z])));
    let shell = whole(4).filter(|p| p.iter().any(|x| [0, 3].contains(x)));
    inputs.push(flat(shell.map(|p| p.map(f64::from))));
    inputs.push(flat(whole(3).map(|p| p.map(f64::from))));
    let sheet = |bend: f64| {
        (0..49).map(move |k| [(k % 7) as f64, (k / 7) as f64, bend * ((k % 7) as f64).sin()])
    };
    inputs.push(flat(sheet(0.3)));
    inputs.push(flat(sheet(0.0)));
    inputs.push(flat((0..9).map(|k| [f64::from(k), 2.0 * f64::from(k), 0.0])));
    let mut random = numbers(3);
    inputs.push(flat(sphere(60, 1.0).map(|p| p.map(|x| x * (0.95 + 0.1 * random())))));
    for seed in 0..4 {
        let mut random = numbers(seed);
        inputs.push((0..75).map(|_| random()).collect());
        inputs.push((0..75).map(|_| (random() * 3.0).floor()).collect());
    }
    inputs.push(flat(sphere(20, 1e-100).chain(sphere(20, 1e100))));
    inputs.push(flat(sphere(30, 1.0).chain([[1e20, 1e-20, 0.0]])));
    for scale in [1e-150, 1e150, 1e-300] {
        inputs.push(flat(sphere(24, scale)));
        inputs.push(flat(whole(2).map(|p| p.map(|x| f64::from(x) * scale))));
    }
    inputs
}

/// The answers of all methods that find one.
fn solved(values: &[f64]) -> Vec<Solved> {
    let points = Points::new(values, 3).expect("rows");
    let mut found = vec![];
    let of = |positions| Some(Denoise { neighbors: Some(8), iterations: 1, positions });
    for method in SurfaceMethod::ALL {
        for mode in [Mode::Closed, Mode::Open] {
            for denoise in [None, of(Positions::Projected), of(Positions::Original)] {
                if mode == Mode::Open && method != SurfaceMethod::Tree {
                    continue;
                }
                let solver = match method {
                    SurfaceMethod::Tree => taut::SurfaceMethod::Tree(mode),
                    other => other.into(),
                };
                let options = SurfaceOptions { method: solver, denoise, ..Default::default() };
                if let Ok(solution) = surface(&points, &options) {
                    // At the places given, what was found of moved points need not hold.
                    let may_fail = options.denoise == of(Positions::Original);
                    match solution.check(&points) {
                        Ok(verdict) => found.push((solution, verdict)),
                        Err(refused) => assert!(may_fail, "{method:?}: {refused} {values:?}"),
                    }
                }
            }
        }
    }
    found
}

#[test]
fn honest_surfaces_are_true() {
    let [mut all, mut sound, mut moved, mut closed, mut bad] = [0; 5];
    for values in inputs().into_iter().skip(long_or(0, 1)).step_by(long_or(1, 2)) {
        let oracle = SurfaceOracle::new(&values, 3);
        for (solution, verdict) in solved(&values) {
            let truth = oracle.judge(&solution, &verdict);
            let method = solution.certificate.method;
            assert_eq!(truth, Truth::True, "{method:?}: {verdict:?} {values:?}");
            all += 1;
            sound += usize::from(verdict.is_sound);
            moved += usize::from(verdict.displacement > 0.0);
            closed += usize::from(verdict.is_closed);
            bad += usize::from(!verdict.is_manifold);
        }
    }
    eprintln!("{all} surfaces: {sound} sound, {closed} closed, {moved} moved, {bad} bad");
    let least = long_or([30, 20, 40, 20], [15, 10, 20, 10]);
    assert!([sound, moved, closed, bad].iter().zip(&least).all(|(count, least)| count >= least));
}

/// Each change alone is a lie wherever it is a change.
#[test]
fn doctored_surfaces_are_false() {
    type Change = fn(&mut Solution<Surface>, &mut SurfaceVerdict);
    let changes: [(&str, Change); 21] = [
        ("a triangle less", |found, _| {
            found.answer.triangles.pop();
            if !found.certificate.apexes.is_empty() {
                found.certificate.apexes.pop();
            }
        }),
        ("a triangle turned", |found, verdict| {
            if found.answer.topology.edges > found.answer.topology.boundary_edges
                && verdict.is_manifold
                && found.answer.triangles.len() > 1
                && let Some(triangle) = found.answer.triangles.last_mut()
            {
                triangle.swap(0, 1);
                // A component of one triangle is as good either way.
                let last = found.answer.topology.components.last();
                if last.is_some_and(|one| one.triangles == 1) {
                    triangle.swap(0, 1);
                }
            }
        }),
        ("all triangles turned", |found, verdict| {
            if verdict.is_outward && verdict.is_closed {
                found.answer.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
            }
        }),
        ("another corner", |found, _| {
            let topology = &found.answer.topology;
            if topology.vertices > 4
                && topology.boundary_edges == 0
                && let [first, .., last] = &mut found.answer.triangles[..]
                && let Some(row) = first.iter().find(|row| !last.contains(row))
            {
                last[0] = *row;
            }
        }),
        ("a triangle twice", |found, _| {
            let first = found.answer.triangles.first().copied();
            found.answer.triangles.extend(first);
        }),
        ("a handle more", |found, verdict| {
            if let Some(genus) = found.answer.topology.genus.as_mut() {
                *genus += 1;
                verdict.genus = Some(*genus);
            }
        }),
        ("another Euler characteristic", |found, _| {
            found.answer.topology.euler_characteristic -= 2;
        }),
        ("a component turned one-sided", |found, _| {
            if let Some(one) = found.answer.topology.components.first_mut() {
                one.orientable ^= true;
            }
        }),
        ("a boundary loop more", |found, verdict| {
            found.answer.topology.boundary_loops += 1;
            verdict.boundary_loops += 1;
        }),
        ("embedded or not", |found, verdict| {
            found.certificate.embedded ^= true;
            verdict.is_embedded ^= true;
        }),
        ("outward or not", |found, verdict| {
            found.certificate.outward ^= true;
            verdict.is_outward ^= true;
        }),
        ("certified or not", |_, verdict| {
            verdict.certified ^= true;
            if verdict.certified {
                verdict.doubt = None;
            }
        }),
        ("a promise to be closed", |found, _| {
            if found.answer.topology.boundary_edges > 0 {
                found.certificate.mode = SurfaceMode::Closed;
            }
        }),
        ("a smaller radius", |found, _| {
            if !found.answer.triangles.is_empty() {
                found.certificate.mode = SurfaceMode::Alpha { radius: 0.0 };
            }
        }),
        ("a row unused for no reason", |found, _| {
            let row = found.answer.triangles.first().map(|triangle| triangle[0]);
            found.answer.unused.unreferenced.extend(row);
        }),
        ("a duplicate less", |found, _| {
            found.answer.unused.duplicates.pop();
        }),
        ("a duplicate of another row", |found, _| {
            if let Some(pair) = found.answer.unused.duplicates.first_mut() {
                pair[1] = pair[0];
            }
        }),
        ("an unused row inside", |found, verdict| {
            // Of a surface with a boundary nothing is inside.
            if verdict.boundary_loops as usize >= found.answer.topology.components.len() {
                let unused = &mut found.answer.unused;
                unused.interior = std::mem::take(&mut unused.unreferenced);
            }
        }),
        ("moved less", |found, verdict| {
            verdict.displacement *= 1.0 - 1e-6;
            found.certificate.displacement = verdict.displacement;
        }),
        ("an outlier less told", |_, verdict| {
            verdict.outliers = verdict.outliers.saturating_sub(1);
        }),
        ("another hash", |found, _| {
            let other = Points::new(&[1.5], 1).expect("one row");
            let hash = taut::points::hash_points(&other, &taut::Monitor::silent());
            found.certificate.points_hash = hash.expect("in memory");
        }),
    ];
    let mut judged = [0; 21];
    for values in inputs().into_iter().step_by(long_or(1, 2)) {
        let oracle = SurfaceOracle::new(&values, 3);
        for honest in solved(&values) {
            for (count, (name, change)) in judged.iter_mut().zip(&changes) {
                let (mut found, mut verdict) = honest.clone();
                change(&mut found, &mut verdict);
                if (&found, verdict) == (&honest.0, honest.1) {
                    continue;
                }
                let truth = oracle.judge(&found, &verdict);
                let method = found.certificate.method;
                assert!(
                    matches!(truth, Truth::False(_)),
                    "{name}, {method:?}: {verdict:?} {values:?} {:?}",
                    found.answer.triangles
                );
                *count += 1;
            }
        }
    }
    eprintln!("{judged:?}");
    assert!(judged.iter().all(|&count| count >= long_or(3, 1)), "{judged:?}");
}

/// A ball through a row is empty or not as every other row says: of all apexes of a triangle of a sphere with its center,
/// those that hold the center are lies.
#[test]
fn balls_that_hold_a_row_are_lies() {
    let values = flat(sphere(12, 1.0).chain([[0.0, 0.0, 0.5]]));
    let points = Points::new(&values, 3).expect("rows");
    let found = surface(&points, &SurfaceOptions::default()).expect("solved");
    let verdict = found.check(&points).expect("accepted");
    let oracle = SurfaceOracle::new(&values, 3);
    let [mut kept, mut refused] = [0, 0];
    for triangle in 0..found.answer.triangles.len() {
        let rows = (0..13).map(Apex::Row).chain([Apex::Hull, Apex::Gabriel]);
        for apex in rows {
            let mut other = found.clone();
            other.certificate.apexes[triangle] = apex;
            let is_true = oracle.judge(&other, &verdict) == Truth::True;
            assert_eq!(is_true, other.check(&points).is_ok(), "{triangle} {apex:?}");
            *(if is_true { &mut kept } else { &mut refused }) += 1;
        }
    }
    assert!(kept > 20 && refused > 100, "{kept} {refused}");
}

/// What is kept of the places of one answer changes nothing of what is said about the next.
#[test]
fn answers_in_turn_are_judged_as_each_alone() {
    let values = flat(sphere(30, 1.0));
    let denoise =
        Some(Denoise { neighbors: Some(8), iterations: 1, positions: Positions::Projected });
    let points = Points::new(&values, 3).expect("rows");
    let options = SurfaceOptions { denoise, ..Default::default() };
    let found = surface(&points, &options).expect("solved");
    let honest = found.check(&points).expect("accepted");
    let in_turn = SurfaceOracle::new(&values, 3);
    let [mut kept, mut refused] = [0, 0];
    for row in (0..30).step_by(long_or(1, 3)) {
        for factor in [0.0, 0.5, 0.99, 1.0, 1.01, 1.5, 4.0] {
            let mut moved = found.clone();
            moved.answer.vertices[row] = moved.answer.vertices[row].map(|x| x * factor);
            // So far that no displacement is a lie.
            let verdict = SurfaceVerdict { displacement: 9.0, ..honest };
            moved.certificate.displacement = 9.0;
            let alone = SurfaceOracle::new(&values, 3).judge(&moved, &verdict);
            assert_eq!(in_turn.judge(&moved, &verdict) == Truth::True, alone == Truth::True);
            *(if alone == Truth::True { &mut kept } else { &mut refused }) += 1;
        }
    }
    let least = long_or(60, 20);
    assert!(kept > least && refused > least, "{kept} {refused}");
}

/// The band of Möbius, a pinched pair of pyramids, an edge of three triangles and a bottle of Klein, by their topology.
#[test]
fn shapes_of_one_side_and_no_surfaces_are_counted() {
    use super::shape::Shape;
    let band: Vec<[u32; 3]> = (0..5).map(|k| [k, (k + 1) % 5, (k + 2) % 5]).collect();
    let of = Shape::of(&band).topology;
    let one = of.components[0];
    let counted = (of.boundary_loops, of.euler_characteristic, one.orientable, one.genus);
    assert_eq!(counted, (1, 0, false, Some(1)));
    let pinched =
        [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2], [0, 4, 5], [0, 5, 6], [0, 6, 4], [4, 6, 5]];
    let of = Shape::of(&pinched).topology;
    assert_eq!((of.components.len(), of.non_manifold_vertices, of.genus), (2, 1, Some(0)));
    let crowded = [[0, 1, 2], [1, 0, 3], [0, 1, 4]];
    let of = Shape::of(&crowded).topology;
    let counted = (of.non_manifold_edges, of.non_manifold_vertices, of.genus, of.components.len());
    assert_eq!(counted, (1, 2, None, 1));
    // A grid of 4 × 4 squares, joined straight in one direction and turned over in the other.
    let at = |i: u32, j: u32| match i {
        4 => (4 - j % 4) % 4,
        i => 4 * i + j % 4,
    };
    let square = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let squares = (0..4).flat_map(|i| (0..4).map(move |j| (i, j)));
    let bottle: Vec<[u32; 3]> = squares.flat_map(square).collect();
    let of = Shape::of(&bottle).topology;
    let one = of.components[0];
    let counted = (of.boundary_edges, of.euler_characteristic, one.orientable, one.genus, of.genus);
    assert_eq!(counted, (0, 0, false, Some(2), None));
}
