//! The directions that triangles face at their corners, for shading.
//!
//! *Idea.* Flat, a corner has the direction of its triangle. Smooth, it has the mean of those triangles around the vertex that face
//! nearly the same way, by area: shades flow over gentle edges and break at sharp ones, and where triangles are turned over.
//! *Trap.* Triangles at one vertex are compared in pairs. A vertex with very many of them, the tip of a fan, keeps flat corners.

use crate::Shading;
use crate::svg::{V3, add, cross, dot};

/// Cosine of the angle between two triangles from which on the edge between them counts as sharp: 40 degrees.
const SHARP_COS_MAX: f64 = 0.766;

/// A vertex with smooth corners has at most this many triangles: a pair of them costs as much as a sample.
const FAN_TRIANGLES_MAX: usize = 64;

/// The unit normals at the three corners of each triangle, 0 where it has no area.
pub(crate) fn normals(places: &[V3], triangles: &[[u32; 3]], shading: Shading) -> Vec<[V3; 3]> {
    let areas: Vec<V3> = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|i| places[i as usize]);
            cross(add(b, a, -1.0), add(c, a, -1.0))
        })
        .collect();
    let flat: Vec<V3> = areas.iter().map(|&area| unit(area)).collect();
    let mut corners: Vec<[V3; 3]> = flat.iter().map(|&normal| [normal; 3]).collect();
    if shading == Shading::Flat {
        return corners;
    }
    // Corners by vertex: those of v are around[first[v]..first[v + 1]], each 3·triangle + place in it.
    let mut first = vec![0_usize; places.len() + 1];
    for &vertex in triangles.as_flattened() {
        first[vertex as usize + 1] += 1;
    }
    for v in 0..places.len() {
        first[v + 1] += first[v];
    }
    let mut next = first.clone();
    let mut around = vec![0_usize; 3 * triangles.len()];
    for (corner, &vertex) in triangles.as_flattened().iter().enumerate() {
        around[next[vertex as usize]] = corner;
        next[vertex as usize] += 1;
    }
    for ends in first.windows(2) {
        let here = &around[ends[0]..ends[1]];
        if here.len() > FAN_TRIANGLES_MAX {
            continue;
        }
        for &corner in here {
            let own = flat[corner / 3];
            let gentle = here.iter().filter(|&&other| dot(own, flat[other / 3]) >= SHARP_COS_MAX);
            let sum = gentle.fold([0.0; 3], |sum, &other| add(sum, areas[other / 3], 1.0));
            corners[corner / 3][corner % 3] = unit(sum);
        }
    }
    corners
}

/// The vector at length 1; 0 where it is too short to have a direction.
fn unit(v: V3) -> V3 {
    let length = dot(v, v).sqrt();
    if length > 0.0 { v.map(|x| x / length) } else { [0.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A roof over the x axis, its sides as steep as told.
    fn roof(height: f64) -> (Vec<V3>, Vec<[u32; 3]>) {
        let places =
            vec![[0.0, 0.0, height], [1.0, 0.0, height], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]];
        (places, vec![[0, 1, 2], [1, 0, 3]])
    }

    #[test]
    fn gentle_edges_are_smooth_and_sharp_ones_are_not() {
        let (places, triangles) = roof(0.1);
        let smooth = normals(&places, &triangles, Shading::Smooth);
        assert!((smooth[0][0][2] - 1.0).abs() < 1e-12 && smooth[0][0] == smooth[1][1]);
        assert!(smooth[0][2][1] > 0.09);
        let (places, triangles) = roof(1.0);
        let sharp = normals(&places, &triangles, Shading::Smooth);
        assert_eq!(sharp, normals(&places, &triangles, Shading::Flat));
    }

    #[test]
    fn no_area_is_no_direction() {
        let places = vec![[1.0; 3], [1.0; 3], [2.0; 3]];
        for shading in [Shading::Flat, Shading::Smooth] {
            assert_eq!(normals(&places, &[[0, 1, 2]], shading), [[[0.0; 3]; 3]]);
        }
        assert!(normals(&[], &[], Shading::Smooth).is_empty());
    }
}
