//! Evenly spaced samples of the rings of a polygon, with outward normals.

use crate::levels::is_left;
use crate::polygon::Segment;

/// A point of a ring.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) at: [f64; 2],
    /// A unit vector, out of the polygon, perpendicular to the chord between the samples before and after; 0 where that has no length.
    pub(super) normal: [f64; 2],
}

/// The samples of all rings, and the largest length of a ring between two of them.
pub(super) fn samples(edges: &[Segment], count: usize) -> (Vec<Sample>, f64) {
    let length = |[a, b]: &Segment| (b[0] - a[0]).hypot(b[1] - a[1]);
    let total: f64 = edges.iter().map(length).sum();
    let (mut found, mut spacing) = (vec![], 0.0f64);
    // A ring ends at its first vertex, which no other ring has.
    for ring in edges.chunk_by(|one, next| one[1] == next[0]) {
        let own: f64 = ring.iter().map(length).sum();
        let parts = ((count as f64 * own / total).round() as usize).max(3);
        let step = own / parts as f64;
        spacing = spacing.max(step);
        let (mut points, mut passed) = (vec![], 0.0);
        for edge in ring {
            let (along, [a, b]) = (length(edge), *edge);
            // Vertices that are one in these units have no way between them.
            while along > 0.0
                && points.len() < parts
                && points.len() as f64 * step <= passed + along
            {
                let share = ((points.len() as f64 * step - passed) / along).clamp(0.0, 1.0);
                points.push([0, 1].map(|k| a[k] + share * (b[k] - a[k])));
            }
            passed += along;
        }
        let outward = if has_inside_at_left(ring, edges) { 1.0 } else { -1.0 };
        for (i, &at) in points.iter().enumerate() {
            let before = points[if i == 0 { points.len() - 1 } else { i - 1 }];
            let after = points[if i + 1 == points.len() { 0 } else { i + 1 }];
            let chord = [after[0] - before[0], after[1] - before[1]];
            let size = chord[0].hypot(chord[1]);
            let normal =
                [chord[1], -chord[0]].map(|x| if size > 0.0 { outward * x / size } else { 0.0 });
            found.push(Sample { at, normal });
        }
    }
    (found, spacing)
}

/// Whether the inside of the polygon is at the left of the edges of a ring.
fn has_inside_at_left(ring: &[Segment], edges: &[Segment]) -> bool {
    let first = ring[0][0];
    let turn = |[a, b]: &Segment| {
        (a[0] - first[0]) * (b[1] - first[1]) - (a[1] - first[1]) * (b[0] - first[0])
    };
    let is_counterclockwise = ring.iter().map(turn).sum::<f64>() > 0.0;
    // The rings around this one: the crossings of a line to its first vertex, less those with its own edges.
    let crossed = |list: &[Segment]| list.iter().filter(|&&edge| is_left(edge, first)).count();
    let is_in_others = (crossed(edges) - crossed(ring)) % 2 == 1;
    is_counterclockwise != is_in_others
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Loops;

    #[test]
    fn samples_are_evenly_spaced_and_normals_point_out() {
        let square = |low: f64, high: f64| [[low, low], [high, low], [high, high], [low, high]];
        for is_turned in [false, true] {
            let (mut outer, mut hole) = (square(0.0, 4.0), square(1.0, 3.0));
            if is_turned {
                outer.reverse();
                hole.reverse();
            }
            let mut loops = Loops::default();
            loops.push(&outer);
            loops.push(&hole);
            let (found, spacing) = samples(&loops.segments, 24);
            assert_eq!((found.len(), spacing), (24, 1.0));
            for Sample { at, normal } in &found {
                // From the middle of the ring between both squares, away from it.
                let away = |k: usize| (at[k] - 2.0).abs();
                let side = usize::from(away(1) > away(0));
                let is_corner = away(0) == away(1);
                let is_outer = away(side) == 2.0;
                let outward = (at[side] - 2.0).signum() * if is_outer { 1.0 } else { -1.0 };
                assert!(is_corner || normal[side] == outward, "{at:?}: {normal:?}");
            }
        }
    }
}
