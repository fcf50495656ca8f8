//! Which loops lie within which.
//!
//! *Problem.* Loops that do not meet bound areas with holes; a hole belongs to the smallest loop around it.
//! *Idea.* A loop lies within another if one of its vertices does, and that is so if a ray from it crosses the other an odd number of
//! times. All rays are level, so one sweep upwards holds the edges that any of them can cross. A first sweep counts the loops
//! around each; in a second one the parent is the one among them that has one fewer around itself.
//! *Guarantee.* Signs are exact, so for loops that do not meet so is the answer. O(n log n), and for each loop the edges on its level.
//! *Trap.* A ray through a vertex crosses two edges or none: an edge holds its lower end and not its upper one.

use taut_points::OrderBy;
use taut_predicates::Sign;
use taut_predicates::plane::orient;

use crate::Polyline;

/// An edge that is not level: its lower and its upper end, and the loop it is of.
struct Edge {
    low: [f64; 2],
    high: [f64; 2],
    of: u32,
}

/// For each curve the smallest loop around it, if there is one. What is open or has fewer than three vertices is within loops, but
/// nothing is within it; of curves that meet the answer is one of several.
///
/// ```
/// use taut_mesh::{Polyline, parents};
/// let square = |r: f64| [[-r, -r], [r, -r], [r, r], [-r, r]];
/// let (large, small) = (square(2.0), square(1.0));
/// let curves = [&small, &large].map(|vertices| Polyline { vertices, closed: true });
/// assert_eq!(parents(&curves), [Some(1), None]);
/// ```
pub fn parents(curves: &[Polyline<'_>]) -> Vec<Option<u32>> {
    let mut edges = Vec::new();
    for (of, curve) in (0u32..).zip(curves) {
        if !curve.closed || curve.vertices.len() < 3 {
            continue;
        }
        for (a, b) in curve.edges() {
            if a[1] != b[1] {
                let (low, high) = if a[1] < b[1] { (a, b) } else { (b, a) };
                edges.push(Edge { low, high, of });
            }
        }
    }
    edges.order_by(&|a, b| a.low[1].total_cmp(&b.low[1]));
    let mut asked: Vec<(u32, [f64; 2])> = (0u32..)
        .zip(curves)
        .filter_map(|(number, curve)| Some((number, *curve.vertices.first()?)))
        .collect();
    asked.order_by(&|a, b| a.1[1].total_cmp(&b.1[1]).then(a.0.cmp(&b.0)));
    let mut depth = vec![0u32; curves.len()];
    around(&edges, &asked, |inner, loops| depth[inner as usize] = loops.len() as u32);
    let mut parents = vec![None; curves.len()];
    around(&edges, &asked, |inner, loops| {
        let wanted = depth[inner as usize].checked_sub(1);
        parents[inner as usize] =
            loops.iter().copied().find(|&outer| Some(depth[outer as usize]) == wanted);
    });
    parents
}

/// Returns true if a loop runs counter-clockwise, by the exact sign of the turn at its leftmost vertex, of several the lowest. Of one that meets
/// itself this is all that is said.
///
/// ```
/// use taut_mesh::{Polyline, is_counter_clockwise};
/// let vertices = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
/// assert!(is_counter_clockwise(&Polyline { vertices: &vertices, closed: true }));
/// ```
pub fn is_counter_clockwise(curve: &Polyline<'_>) -> bool {
    let vertices = curve.vertices;
    let n = vertices.len();
    let by_place = |&i: &usize, &j: &usize| {
        let (a, b) = (vertices[i], vertices[j]);
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    };
    let Some(first) = (0..n).min_by(by_place) else { return true };
    let at = vertices[first];
    let other = |steps: &mut dyn Iterator<Item = usize>| {
        steps.map(|step| vertices[(first + step) % n]).find(|&vertex| vertex != at)
    };
    match (other(&mut (1..n).rev()), other(&mut (1..n))) {
        (Some(before), Some(after)) => orient(before, at, after) != Sign::Negative,
        _ => true,
    }
}

/// For each vertex that is asked about, by height, the loops around it but its own.
fn around(edges: &[Edge], asked: &[(u32, [f64; 2])], mut tell: impl FnMut(u32, &[u32])) {
    let (mut active, mut next): (Vec<&Edge>, usize) = (Vec::new(), 0);
    let mut crossed: Vec<u32> = Vec::new();
    let mut loops: Vec<u32> = Vec::new();
    for &(inner, at) in asked {
        while next < edges.len() && edges[next].low[1] <= at[1] {
            active.push(&edges[next]);
            next += 1;
        }
        active.retain(|edge| edge.high[1] > at[1]);
        crossed.clear();
        // The ray goes to the right: it crosses what passes on that side.
        let passes =
            |edge: &&&Edge| edge.of != inner && orient(edge.low, edge.high, at) == Sign::Positive;
        crossed.extend(active.iter().filter(passes).map(|edge| edge.of));
        crossed.sort_unstable();
        loops.clear();
        for same in crossed.chunk_by(|a, b| a == b) {
            if same.len() % 2 == 1 {
                loops.push(same[0]);
            }
        }
        tell(inner, &loops);
    }
}

#[cfg(test)]
mod tests {
    use super::{is_counter_clockwise, parents};
    use crate::Polyline;

    fn square([x, y]: [f64; 2], r: f64) -> Vec<[f64; 2]> {
        vec![[x - r, y - r], [x + r, y - r], [x + r, y + r], [x - r, y + r]]
    }

    fn of(loops: &[Vec<[f64; 2]>]) -> Vec<Option<u32>> {
        let curves: Vec<_> =
            loops.iter().map(|vertices| Polyline { vertices, closed: true }).collect();
        parents(&curves)
    }

    /// Two islands, one with a lake and an islet in it; vertices on one level throughout.
    #[test]
    fn holes_belong_to_the_smallest_loop_around_them() {
        let loops = [
            square([0.0, 0.0], 1.0),
            square([0.0, 0.0], 8.0),
            square([0.0, 0.0], 4.0),
            square([6.0, 0.0], 1.0),
            square([20.0, 0.0], 8.0),
            square([20.0, 0.0], 4.0),
        ];
        assert_eq!(of(&loops), [Some(2), None, Some(1), Some(1), None, Some(4)]);
        let turned: Vec<Vec<_>> =
            loops.iter().map(|l| l.iter().rev().map(|&[x, y]| [y, -x]).collect()).collect();
        assert_eq!(of(&turned), [Some(2), None, Some(1), Some(1), None, Some(4)]);
    }

    /// Diamonds have their vertices on the level of the centers of all others.
    #[test]
    fn rays_through_vertices_count_once() {
        let diamond = |x: f64, r: f64| vec![[x, 0.0], [x + r, r], [x + 2.0 * r, 0.0], [x + r, -r]];
        let loops = [diamond(0.0, 1.0), diamond(-1.0, 3.0), diamond(-7.0, 1.0), diamond(6.0, 1.0)];
        assert_eq!(of(&loops), [Some(1), None, None, None]);
    }

    /// A sliver whose area by sums would be lost to rounding, with its first vertex given twice.
    #[test]
    fn the_way_round_is_exact() {
        let far = 1e15;
        let mut sliver =
            vec![[far, far], [far, far], [far + 2.0, far + 2.0], [far + 1.0, far + 1.125]];
        for _ in 0..4 {
            sliver.rotate_left(1);
            assert!(is_counter_clockwise(&Polyline { vertices: &sliver, closed: true }));
            let back: Vec<_> = sliver.iter().rev().copied().collect();
            assert!(!is_counter_clockwise(&Polyline { vertices: &back, closed: true }));
        }
    }

    #[test]
    fn what_bounds_nothing_holds_nothing() {
        let open = square([0.0, 0.0], 5.0);
        let (inner, point) = (square([0.0, 0.0], 1.0), vec![[0.5, 0.5]]);
        let line = |vertices| Polyline { vertices, closed: false };
        let curves = [line(&open[..]), Polyline { vertices: &inner, closed: true }, line(&point)];
        assert_eq!(parents(&curves), [None, None, Some(1)]);
        assert!(parents(&[]).is_empty());
    }
}
