//! Whether a point of the grid is inside a closed mesh with corners on the grid, and in none of the solids in it.
//!
//! *Idea.* The triangles of each surface that a ray in the direction of x crosses are counted. The ray starts at (x, y + ε, z + ε²) for an
//! infinitely small ε, so that it meets no edge; the signs are those of whole numbers.

use super::grid::Boxes;
use super::{MESH, WALL};

/// Whether the ray crosses an odd number of triangles of the mesh, and an even number of each solid. False for a point on a triangle.
pub(super) fn is_inside(point: [i64; 3], boxes: &Boxes, surfaces: &[i32]) -> bool {
    // The surfaces of which an odd number of triangles are crossed.
    let mut odd: Vec<i32> = vec![];
    for (rows, low, high) in boxes.blocks(0..boxes.floors.len()) {
        // Blocks beside the moved ray, or behind its start, have no triangle that it crosses.
        let [low, high] = [low, high].map(|corner| corner.map(i64::from));
        let is_beside = |c: usize| low[c] > point[c] || high[c] <= point[c];
        if is_beside(1) || is_beside(2) || high[0] < point[0] {
            continue;
        }
        for row in rows {
            let triangle = &boxes.floors[row];
            // Most triangles are all above or all below the ray.
            let sides = triangle.map(|corner| i64::from(corner[1]) > point[1]);
            if sides == [true; 3] || sides == [false; 3] {
                continue;
            }
            match crosses(point, &triangle.map(|corner| corner.map(i64::from))) {
                Some(true) if surfaces[row] != WALL => toggle(&mut odd, surfaces[row]),
                Some(_) => {}
                None => return false,
            }
        }
    }
    odd == [MESH]
}

/// Takes a number away that is there, and adds one that is not.
fn toggle(numbers: &mut Vec<i32>, number: i32) {
    match numbers.iter().position(|&other| other == number) {
        Some(at) => {
            numbers.swap_remove(at);
        }
        None => numbers.push(number),
    }
}

/// Whether the ray crosses a triangle; `None` if it starts on it.
fn crosses(point: [i64; 3], triangle: &[[i64; 3]; 3]) -> Option<bool> {
    let [a, b, c] = triangle;
    let is_odd = passes(point, a, b) ^ passes(point, b, c) ^ passes(point, c, a);
    if !is_odd {
        return Some(false);
    }
    // The line meets the plane of the triangle in one point; x tells on which side of the start.
    let minus = |p: &[i64; 3]| [0, 1, 2].map(|k| i128::from(p[k] - point[k]));
    let [a, b, c] = [minus(a), minus(b), minus(c)];
    let normal = |one: usize, other: usize| {
        let minus = |p: [i128; 3], q: [i128; 3], k: usize| p[k] - q[k];
        minus(b, a, one) * minus(c, a, other) - minus(b, a, other) * minus(c, a, one)
    };
    // The normal times (q − a) is 0 for the point q of the plane; for q = start + (t, 0, 0) this is normal·a = t·normal_x.
    let normal = [normal(1, 2), normal(2, 0), normal(0, 1)];
    let along: i128 = (0..3).map(|k| normal[k] * a[k]).sum();
    match along.signum() * normal[0].signum() {
        0 => None,
        sign => Some(sign > 0),
    }
}

/// Whether the edge between two corners, seen in the direction of x, passes above the start: at its y, at a larger z.
fn passes(point: [i64; 3], a: &[i64; 3], b: &[i64; 3]) -> bool {
    if (a[1] > point[1]) == (b[1] > point[1]) {
        return false;
    }
    // From the lower end to the upper one, so that both triangles at an edge decide alike.
    let [a, b] = if a[1] < b[1] { [a, b] } else { [b, a] };
    let minus = |p: i64, q: i64| i128::from(p - q);
    let side =
        minus(b[1], a[1]) * minus(point[2], a[2]) - minus(b[2], a[2]) * minus(point[1], a[1]);
    // On the edge the start is moved by ε in y, which moves it to the side of −(b − a)_z, and then by ε² in z.
    match side.signum() {
        0 if b[2] != a[2] => b[2] > a[2],
        0 => false,
        sign => sign < 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inside(point: [i64; 3], floors: &[[[i32; 3]; 3]]) -> bool {
        let rows = floors.len();
        is_inside(point, &Boxes::around(rows, floors.to_vec(), floors.to_vec()), &vec![MESH; rows])
    }

    #[test]
    fn points_of_a_tetrahedron_and_on_its_border() {
        let corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]];
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let mesh = faces.map(|face: [usize; 3]| face.map(|k| corners[k]));
        let mut found = 0;
        for x in -2..=5 {
            for y in -2..=5 {
                for z in -2..=5 {
                    let is_open = x > 0 && y > 0 && z > 0 && x + y + z < 4;
                    let is_on = x >= 0 && y >= 0 && z >= 0 && x + y + z <= 4 && !is_open;
                    let is_found = inside([x, y, z], &mesh);
                    assert!(is_found == is_open || is_on, "{x} {y} {z}");
                    found += u32::from(is_found && is_open);
                }
            }
        }
        assert_eq!(found, 1);
        // The plane of the large face is met exactly.
        assert!(!inside([1, 1, 2], &mesh));
    }

    #[test]
    fn rays_through_edges_and_corners_count_once() {
        // An octahedron around the origin: the ray from it leaves through a corner.
        let x = [[4, 0, 0], [-4, 0, 0]];
        let y = [[0, 4, 0], [0, -4, 0]];
        let z = [[0, 0, 4], [0, 0, -4]];
        let mut mesh = vec![];
        for a in x {
            for b in y {
                for c in z {
                    mesh.push([a, b, c]);
                }
            }
        }
        for p in [[0, 0, 0], [-1, 0, 0], [-3, 0, 0], [0, 1, 0], [1, 0, 1], [-1, 1, 1]] {
            assert!(inside(p, &mesh), "{p:?}");
        }
        for p in [[-5, 0, 0], [5, 0, 0], [-9, 4, 0], [-9, 1, 0], [-9, 0, -4], [-3, 1, 1]] {
            assert!(!inside(p, &mesh), "{p:?}");
        }
    }

    #[test]
    fn blocks_change_nothing() {
        // Random closed meshes: the boundary triangles of random tetrahedra, whose insides are combined by parity.
        let mut state = 5u64;
        let mut below = |bound: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((state >> 33) % bound) as i32
        };
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let mut mesh = vec![];
        for _ in 0..60 {
            let at = [0; 3].map(|_| below(24));
            let corners = [0; 4].map(|_| at.map(|x| x + below(9)));
            mesh.extend(faces.map(|face: [usize; 3]| face.map(|k| corners[k])));
        }
        let parity = |point: [i64; 3]| {
            let mut is_odd = false;
            for triangle in &mesh {
                match crosses(point, &triangle.map(|corner| corner.map(i64::from))) {
                    Some(crosses) => is_odd ^= crosses,
                    None => return false,
                }
            }
            is_odd
        };
        let mut found = 0;
        for _ in 0..4000 {
            let point = [0; 3].map(|_| i64::from(below(36)) - 2);
            assert_eq!(inside(point, &mesh), parity(point), "{point:?}");
            found += u32::from(parity(point));
        }
        assert!(found > 20, "{found}");
    }
}
