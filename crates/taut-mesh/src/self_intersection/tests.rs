//! Pairs of every kind, meshes that do not meet themselves, and soups judged by convex combinations.

use proptest::prelude::*;

use super::*;
use crate::shapes::*;

fn of(shape: &Shape) -> SelfIntersections {
    self_intersections(&shape.view())
}

/// A triangle by its corners on a grid.
type Grid = [[i64; 3]; 3];

/// Tests whether two triangles that name their vertices meet, whichever way round they are given.
fn pair(vertices: &[[i64; 3]], triangles: [[u32; 3]; 2]) -> bool {
    let vertices: Vec<[f64; 3]> = vertices.iter().map(|p| p.map(|x| x as f64)).collect();
    let turned =
        |[a, b, c]: [u32; 3]| [[a, b, c], [b, c, a], [c, a, b], [b, a, c], [a, c, b], [c, b, a]];
    let [one, other] = triangles;
    let mut found = Vec::new();
    for one in turned(one) {
        for other in turned(other) {
            for pair in [[one, other], [other, one]] {
                let met = of(&Shape::new(&vertices, &pair));
                assert_eq!(met.degenerate, 0);
                assert_eq!(met.triangles as u64, 2 * met.pairs);
                found.push(met.pairs == 1);
            }
        }
    }
    assert!(found.iter().all(|&met| met == found[0]), "{vertices:?} {triangles:?}");
    found[0]
}

#[test]
fn triangles_without_common_vertices() {
    let own = [[0, 0, 0], [6, 0, 0], [0, 6, 0]];
    let with = |other: Grid| pair(&[own, other].concat(), [[0, 1, 2], [3, 4, 5]]);
    // Through, beside, above, and through the plane only.
    assert!(with([[1, 1, -1], [1, 1, 1], [2, 2, 1]]));
    assert!(!with([[5, 5, -1], [5, 5, 1], [7, 7, 1]]));
    assert!(!with([[1, 1, 1], [1, 2, 1], [2, 2, 2]]));
    assert!(!with([[-1, -1, -1], [-1, -1, 1], [-5, 7, 1]]));
    // A corner in the face, on a side, on a corner; a side on a side, across a side.
    assert!(with([[1, 1, 0], [1, 1, 1], [2, 2, 1]]));
    assert!(with([[3, 3, 0], [9, 9, 1], [9, 8, 1]]));
    assert!(with([[6, 0, 0], [9, 9, 1], [9, 8, 1]]));
    assert!(with([[1, 0, 0], [2, 0, 0], [1, -1, 1]]));
    assert!(with([[3, -1, -1], [3, 1, 1], [9, -9, 0]]));
    assert!(!with([[7, 0, 0], [8, 0, 0], [7, -1, 1]]));
    // In the plane: inside, around, across, corner to side, apart though boxes meet.
    assert!(with([[1, 1, 0], [2, 1, 0], [1, 2, 0]]));
    assert!(with([[-9, -9, 0], [30, -9, 0], [-9, 30, 0]]));
    assert!(with([[1, 1, 0], [9, 1, 0], [9, 2, 0]]));
    assert!(with([[3, 3, 0], [9, 9, 0], [9, 8, 0]]));
    assert!(!with([[4, 4, 0], [9, 4, 0], [4, 9, 0]]));
    // Itself, on other vertices.
    assert!(with(own));
}

#[test]
fn triangles_with_a_common_vertex() {
    let own = [[0, 0, 0], [6, 0, 0], [0, 6, 0]];
    let with = |b: [i64; 3], c: [i64; 3]| {
        pair(&[own.as_slice(), &[b, c]].concat(), [[0, 1, 2], [0, 3, 4]])
    };
    // Beside each other, upright, in the plane.
    assert!(!with([-1, 0, 0], [0, -1, 0]));
    assert!(!with([1, 1, 1], [2, 1, 1]));
    assert!(!with([-1, -1, 1], [-1, -1, -1]));
    // Through the other, with its sides beyond it or short of it.
    assert!(with([1, 1, 1], [1, 1, -1]));
    assert!(with([9, 9, 1], [9, 9, -1]));
    // A side of one lies on the face, on a side, and shorter.
    assert!(with([1, 1, 0], [1, 1, 1]));
    assert!(with([9, 0, 0], [1, 1, 1]));
    assert!(with([3, 0, 0], [0, -9, 1]));
    // In the plane, across.
    assert!(with([1, 1, 0], [-9, 1, 0]));
    assert!(!with([0, -1, 0], [9, -1, 0]));
}

#[test]
fn triangles_with_a_common_edge() {
    let own = [[0, 0, 0], [6, 0, 0], [1, 6, 2]];
    let with = |c: [i64; 3]| pair(&[own.as_slice(), &[c]].concat(), [[0, 1, 2], [1, 0, 3]]);
    assert!(!with([3, -3, -1]) && !with([3, 3, 9]) && !with([3, 0, 1]) && !with([9, -6, -2]));
    assert!(with([3, 3, 1]) && with([9, 9, 3]) && with(own[2]));
    assert!(pair(&own, [[0, 1, 2], [2, 1, 0]]));
}

#[test]
fn surfaces_meet_themselves_or_not() {
    for shape in
        [tetrahedron(), cube(), torus(9, 8), sphere(4), moebius(30, 3), square(9), annulus(9)]
    {
        assert_eq!(of(&shape), SelfIntersections::default());
        assert!(of(&shape).is_embedded());
    }
    // A cube in a cube does not meet it, nor one beside it; one that touches it at a corner does.
    let small = cube().scaled(0.25);
    assert_eq!(of(&cube().and(&small.clone().moved([0.5; 3]))).pairs, 0);
    assert_eq!(of(&cube().and(&small.clone().moved([-0.5, 0.0, 0.0]))).pairs, 0);
    let corner = of(&cube().and(&small.moved([1.0; 3])));
    // All triangles at one of the two corners meet all at the other.
    assert_eq!((corner.pairs, corner.triangles), ((at(7) * at(0)) as u64, at(7) + at(0)));
    // What runs through itself and what is given twice.
    assert!(of(&klein(20, 12)).pairs > 0);
    let twice = of(&Shape {
        triangles: [tetrahedron().triangles, tetrahedron().triangles].concat(),
        ..tetrahedron()
    });
    assert_eq!((twice.pairs, twice.triangles, twice.first), (4, 8, Some([0, 4])));
    let beside = of(&tetrahedron().and(&tetrahedron()));
    assert_eq!((beside.pairs, beside.triangles), (16, 8));
}

/// Triangles of the cube at a corner.
fn at(corner: u32) -> usize {
    cube().triangles.iter().filter(|t| t.contains(&corner)).count()
}

#[test]
fn triangles_without_area_are_counted_and_left_out() {
    let vertices = [[0.0; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0], [0.1, 0.1, 0.2], [0.5, 0.0, 0.0]];
    let found = of(&Shape::new(&vertices, &[[0, 1, 2], [3, 3, 4], [4, 4, 4], [0, 3, 4]]));
    assert_eq!(found, SelfIntersections { degenerate: 3, ..SelfIntersections::default() });
    assert!(!found.is_embedded());
    // 0.1 + 0.2 is not 0.3: this one has an area, if a small one.
    let thin = Shape::new(&[[0.1, 0.2, 0.0], [0.3, 0.3, 0.0], [0.1 + 0.2, 0.3, 0.0]], &[[0, 1, 2]]);
    assert_eq!(of(&thin).degenerate, 0);
    assert_eq!(of(&Shape::default()), SelfIntersections::default());
}

#[test]
fn the_answer_does_not_depend_on_threads() {
    let mut shape = klein(60, 24);
    shape = shape.and(&sphere(4).scaled(2.0)).shuffled(5);
    let pool = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads");
    let one = pool(1).install(|| of(&shape));
    assert!(one.pairs > 100);
    for threads in [2, 8] {
        assert_eq!(pool(threads).install(|| of(&shape)), one);
    }
}

/// Tests whether the origin is a convex combination of these points: of one, two, three or four of them, by Carathéodory.
fn around_origin(points: &[[i64; 3]]) -> bool {
    let dot = |a: [i64; 3], b: [i64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: [i64; 3], b: [i64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let det = |a, b, c| dot(a, cross(b, c));
    let n = points.len();
    for i in 0..n {
        let a = points[i];
        if a == [0; 3] {
            return true;
        }
        for j in 0..i {
            let b = points[j];
            if cross(a, b) == [0; 3] && dot(a, b) < 0 {
                return true;
            }
            for k in 0..j {
                let c = points[k];
                let parts = [cross(a, b), cross(b, c), cross(c, a)];
                let normal = [0, 1, 2].map(|x| parts[0][x] + parts[1][x] + parts[2][x]);
                if det(a, b, c) == 0
                    && normal != [0; 3]
                    && parts.iter().all(|&p| dot(p, normal) >= 0)
                {
                    return true;
                }
                for &d in &points[..k] {
                    // The four weights, each up to the sum, which is the volume.
                    let weights = [det(b, c, d), -det(a, c, d), det(a, b, d), -det(a, b, c)];
                    let volume: i64 = weights.iter().sum();
                    if volume != 0 && weights.iter().all(|&w| w * volume.signum() >= 0) {
                        return true;
                    }
                }
            }
        }
    }
    false
}

/// Tests whether two triangles with area share more than their common vertices, by the existence of a combination.
fn plain(vertices: &[[i64; 3]], one: [u32; 3], other: [u32; 3]) -> bool {
    let at = |k: &u32| vertices[*k as usize];
    let from = |a: [i64; 3], b: [i64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let common: Vec<[i64; 3]> = one.iter().filter(|k| other.contains(k)).map(at).collect();
    let a: Vec<[i64; 3]> = one.iter().filter(|k| !other.contains(k)).map(at).collect();
    let b: Vec<[i64; 3]> = other.iter().filter(|k| !one.contains(k)).map(at).collect();
    match common[..] {
        // Some point of A less some point of B is nothing.
        [] => {
            let all: Vec<_> = a.iter().flat_map(|&p| b.iter().map(move |&q| from(p, q))).collect();
            around_origin(&all)
        }
        // A direction into A is one into B: u·a₁ + v·a₂ = w·b₁ + z·b₂ with nothing negative, and not all nothing.
        [p] => around_origin(&[from(a[0], p), from(a[1], p), from(p, b[0]), from(p, b[1])]),
        // From the middle of the edge: u·a + t·(q − p) = w·b with u, w > 0 and any t.
        [p, q] => {
            let (a, b) = (from(a[0], p), from(p, b[0]));
            around_origin(&[a, b, from(q, p)]) || around_origin(&[a, b, from(p, q)])
        }
        _ => true,
    }
}

fn has_area(vertices: &[[i64; 3]], [a, b, c]: [u32; 3]) -> bool {
    let [a, b, c] = [a, b, c].map(|k| vertices[k as usize]);
    let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
    (0..3).any(|k| u[k] * v[(k + 1) % 3] != u[(k + 1) % 3] * v[k])
}

/// All pairs that meet, and the triangles without area.
fn all_pairs(vertices: &[[i64; 3]], triangles: &[[u32; 3]]) -> SelfIntersections {
    let mut found = SelfIntersections::default();
    let mut met = vec![false; triangles.len()];
    for i in 0..triangles.len() {
        found.degenerate += usize::from(!has_area(vertices, triangles[i]));
        for j in i + 1..triangles.len() {
            let (one, other) = (triangles[i], triangles[j]);
            if has_area(vertices, one) && has_area(vertices, other) && plain(vertices, one, other) {
                found.pairs += 1;
                found.first = found.first.or(Some([i as u32, j as u32]));
                (met[i], met[j]) = (true, true);
            }
        }
    }
    found.triangles = met.iter().filter(|&&met| met).count();
    found
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// A small grid brings common planes, lines and points, copies of vertices and of triangles; then the grid is sheared, moved
    /// and scaled by powers of two, all without rounding.
    #[test]
    fn pairs_are_those_of_convex_combinations(
        vertices in prop::collection::vec([0i64..4, 0i64..4, 0i64..3], 9),
        triangles in prop::collection::vec([0u32..9, 0u32..9, 0u32..9], 0..14),
        wide in 1i64..3,
        power in prop::sample::select(vec![-500, -40, 0, 30, 500]),
        seed in 0u64..1000,
    ) {
        let vertices: Vec<[i64; 3]> = vertices.iter().map(|&[x, y, z]| [wide * x, y, z]).collect();
        let expected = all_pairs(&vertices, &triangles);
        let mut shape = Shape::new(&[], &triangles);
        shape.vertices = vertices.iter().map(|p| p.map(|x| x as f64)).collect();
        prop_assert_eq!(of(&shape), expected);

        let factor = 2f64.powi(power);
        let mut sheared = shape.clone();
        sheared.map(|[x, y, z]| [x + 3.0 * y + 1e6, y - 5.0 * z, z - 70.0 + 2.0 * x].map(|v| factor * v));
        prop_assert_eq!(of(&sheared), expected);

        let shuffled = of(&sheared.shuffled(seed));
        let numbers = |f: SelfIntersections| (f.pairs, f.triangles, f.degenerate);
        prop_assert_eq!(numbers(shuffled), numbers(expected));
    }
}
