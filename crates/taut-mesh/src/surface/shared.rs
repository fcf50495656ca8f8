//! Edges and triangles that two meshes have in common.
//!
//! *Problem.* Count the edges, and the triangles, of either mesh and of both, as sets of points in space.
//! *Idea.* The vertices of both are sorted, and equal ones get one number; then sorted lists are merged.
//! *Guarantee.* Exact: coordinates are compared, not measured; 0 and −0 are one number. O(n log n).
//! *Trap.* Where the reference is a grid of squares, either diagonal is as good as the other: a perfect surface can miss half of
//! the triangles and a fifth of the edges.

use crate::TriangleMesh;
use crate::mesh::repeats;

/// The overlap of two sets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shared {
    /// Size of the set of the reference, each thing counted once.
    pub reference: usize,
    /// Size of the set of the result.
    pub result: usize,
    /// The number of elements in both.
    pub both: usize,
}

impl Shared {
    /// The share of the reference that the result has; 1 if the reference has nothing.
    pub fn of_reference(&self) -> f64 {
        share(self.both, self.reference)
    }

    /// The share of the result that the reference has; 1 if the result has nothing.
    pub fn of_result(&self) -> f64 {
        share(self.both, self.result)
    }
}

fn share(part: usize, whole: usize) -> f64 {
    if whole == 0 { 1.0 } else { part as f64 / whole as f64 }
}

/// The edges and the triangles of two meshes; triangles with two corners in one place are left out.
pub(super) fn shared(reference: &TriangleMesh<'_>, result: &TriangleMesh<'_>) -> (Shared, Shared) {
    let (ours, theirs) = names(reference.vertices(), result.vertices());
    let (ours, theirs) = (triangles(reference, &ours), triangles(result, &theirs));
    (common(&edges(&ours), &edges(&theirs)), common(&ours, &theirs))
}

/// A number for each vertex of two lists: the same one for the same coordinates.
fn names(one: &[[f64; 3]], other: &[[f64; 3]]) -> (Vec<u64>, Vec<u64>) {
    // Adding 0 makes 0 of −0.
    let mut all: Vec<([f64; 3], usize)> =
        one.iter().chain(other).map(|p| p.map(|x| x + 0.0)).zip(0..).collect();
    let order = |p: &[f64; 3], q: &[f64; 3]| {
        (0..3)
            .map(|k| p[k].total_cmp(&q[k]))
            .find(|o| o.is_ne())
            .unwrap_or(std::cmp::Ordering::Equal)
    };
    all.sort_unstable_by(|(p, i), (q, j)| order(p, q).then(i.cmp(j)));
    let mut names = vec![0; all.len()];
    for (name, equal) in (0..).zip(all.chunk_by(|(p, _), (q, _)| p == q)) {
        equal.iter().for_each(|&(_, place)| names[place] = name);
    }
    let others = names.split_off(one.len());
    (names, others)
}

/// The distinct triangles, in order.
fn triangles(mesh: &TriangleMesh<'_>, names: &[u64]) -> Vec<[u64; 3]> {
    let mut found: Vec<[u64; 3]> = mesh
        .triangles()
        .iter()
        .filter(|&&triangle| !repeats(triangle))
        .map(|triangle| {
            let mut triangle = triangle.map(|index| names[index as usize]);
            triangle.sort_unstable();
            triangle
        })
        .filter(|[a, b, c]| a < b && b < c)
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Their distinct edges, in order.
fn edges(triangles: &[[u64; 3]]) -> Vec<[u64; 2]> {
    let mut found: Vec<[u64; 2]> =
        triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [a, c]]).collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Counts what is in two lists, each in order and without copies.
fn common<T: Ord>(reference: &[T], result: &[T]) -> Shared {
    let mut rest = result.iter().peekable();
    let both = reference.iter().filter(|&thing| {
        while rest.next_if(|&other| other < thing).is_some() {}
        rest.peek() == Some(&thing)
    });
    Shared { both: both.count(), reference: reference.len(), result: result.len() }
}
