//! Where a mesh meets itself.
//!
//! *Problem.* Triangles of a surface in space may share their common vertices and edges, and nothing else. Count the pairs
//! that share more.
//! *Idea.* A tree of boxes lists the pairs that can meet; exact signs decide ([`pair`]).
//! *Guarantee.* No pair is missed or counted twice, rounding plays no part, and the answer is the same for any number of threads.
//! O(n log n) and O(log n) for each pair of boxes that meet.
//! *Trap.* Vertices are common by number, not by place. Two sheets that touch at a point do meet, and so do the triangles of a
//! soup that was never merged.

use std::sync::atomic::{AtomicBool, Ordering};

use taut_points::parallel::IntoParallel;

use crate::TriangleMesh;
use crate::bvh::Bvh;
use crate::mesh::repeats;

mod pair;

use pair::Face;

/// Triangles that a thread takes at a time.
const BLOCK: usize = 512;

/// The result of [`self_intersections`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SelfIntersections {
    /// Pairs of triangles with a point in common that is on no common vertex or edge.
    pub pairs: u64,
    /// Triangles of such pairs.
    pub triangles: usize,
    /// The first of such pairs by the lower number, then by the higher one.
    pub first: Option<[u32; 2]>,
    /// Triangles without area, exactly: their corners lie on one line. They were left out.
    pub degenerate: usize,
}

impl SelfIntersections {
    /// Returns true if the mesh lies in space as it is connected: different points of it in different places. Then no two triangles
    /// meet that should not, and all have an area.
    pub fn is_embedded(&self) -> bool {
        self.pairs == 0 && self.degenerate == 0
    }
}

/// The pairs of triangles that share more than their common vertices and edges.
///
/// Vertices are common if they have the same number. A triangle given twice meets itself. Triangles without area are counted,
/// and otherwise left out. Exact for all coordinates; O(n log n) and O(log n) for each pair whose boxes meet, on all threads
/// of the current pool.
///
/// ```
/// use taut_mesh::{TriangleMesh, self_intersections};
/// let vertices = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 1.0, 0.0]];
/// let pierced = TriangleMesh::new(&vertices, &[[0, 1, 2], [3, 4, 5]])?;
/// let found = self_intersections(&pierced);
/// assert_eq!((found.pairs, found.triangles, found.first), (1, 2, Some([0, 1])));
/// let beside = TriangleMesh::new(&vertices, &[[0, 1, 2], [1, 2, 4]])?;
/// assert!(self_intersections(&beside).is_embedded());
/// # Ok::<(), taut_mesh::Error>(())
/// ```
pub fn self_intersections(mesh: &TriangleMesh<'_>) -> SelfIntersections {
    let all = mesh.triangles();
    let with_area = |&(number, corners): &(u32, [[f64; 3]; 3])| {
        !repeats(all[number as usize]) && pair::has_area(&corners)
    };
    let faces: Vec<(u32, [[f64; 3]; 3])> = (0..all.len() as u32)
        .into_par_iter()
        .map(|number| (number, mesh.corners(number)))
        .filter(with_area)
        .collect();
    let tree = Bvh::new(&faces);
    let face = |place: usize| {
        let (number, &corners) = tree.at(place);
        (number, Face { names: all[number as usize], corners })
    };
    let met: Vec<AtomicBool> = all.iter().map(|_| AtomicBool::new(false)).collect();
    let block = |block: usize| {
        let (mut pairs, mut first) = (0u64, None);
        for place in block * BLOCK..tree.len().min((block + 1) * BLOCK) {
            let (i, one) = face(place);
            tree.meeting_after(place, |other| {
                let (j, other) = face(other);
                if pair::meet(one, other) {
                    pairs += 1;
                    first = earlier(first, Some([i.min(j), i.max(j)]));
                    met[i as usize].store(true, Ordering::Relaxed);
                    met[j as usize].store(true, Ordering::Relaxed);
                }
            });
        }
        (pairs, first)
    };
    let (pairs, first) = (0..tree.len().div_ceil(BLOCK))
        .into_par_iter()
        .map(block)
        .reduce(|| (0, None), |a, b| (a.0 + b.0, earlier(a.1, b.1)));
    SelfIntersections {
        pairs,
        triangles: met.into_iter().filter(|met| met.load(Ordering::Relaxed)).count(),
        first,
        degenerate: all.len() - faces.len(),
    }
}

/// The lower of two pairs, where there are any.
fn earlier(a: Option<[u32; 2]>, b: Option<[u32; 2]>) -> Option<[u32; 2]> {
    a.into_iter().chain(b).min()
}

#[cfg(test)]
mod tests;
