//! The outline as the thesis traces it (7.4): boundary pixels, cleaned, and traversed from the right-most one.
//!
//! *Idea.* Boundary pixels have less than four neighbors in the hand. Dead ends and small cycles are removed until each
//! pixel has two neighbors; the traversal is counterclockwise as one sees the image.
//! *Gap.* The thesis does not name its masks. A pixel is removed here if it is simple: its boundary neighbors are
//! connected among themselves, so that removing it does not cut the boundary. That covers dead ends, corners of an L
//! and blocks of four pixels.
//! *Trap.* The curve passes through the centers of pixels of the hand, half a pixel inside of the cracks.

use super::mask::Mask;

/// The eight neighbors of a pixel, in the order of rotation.
const AROUND: [[i64; 2]; 8] =
    [[1, 0], [1, -1], [0, -1], [-1, -1], [-1, 0], [-1, 1], [0, 1], [1, 1]];

/// Returns the cleaned boundary of a set of pixels, counterclockwise on the screen from the right-most pixel, the upper
/// one of equals; `None` if the boundary is not one closed curve, as when a part is one pixel wide.
#[must_use]
pub fn thesis_boundary(mask: &Mask) -> Option<Vec<[i64; 2]>> {
    let (width, height) = (mask.width() as i64, mask.height() as i64);
    let is_boundary = |x: i64, y: i64| {
        mask.contains(x, y)
            && [[1, 0], [0, -1], [-1, 0], [0, 1]].iter().any(|[u, v]| !mask.contains(x + u, y + v))
    };
    let mut boundary =
        Mask::from_fn(width as usize, height as usize, |x, y| is_boundary(x as i64, y as i64));
    let mut waiting: Vec<[i64; 2]> = (0..height)
        .rev()
        .flat_map(|y| (0..width).rev().map(move |x| [x, y]))
        .filter(|&[x, y]| boundary.contains(x, y))
        .collect();
    let mut left = waiting.len();
    while let Some([x, y]) = waiting.pop() {
        if !boundary.contains(x, y) || !is_simple(&boundary, x, y) {
            continue;
        }
        boundary.remove(x as usize, y as usize);
        left -= 1;
        let neighbors = AROUND.map(|[u, v]| [x + u, y + v]);
        waiting.extend(neighbors.into_iter().filter(|&[x, y]| boundary.contains(x, y)));
    }
    traverse(&boundary, left)
}

/// Tests whether the boundary neighbors of a pixel are connected among themselves, or are none.
fn is_simple(boundary: &Mask, x: i64, y: i64) -> bool {
    let ring = AROUND.map(|[u, v]| boundary.contains(x + u, y + v));
    // Pieces of the ring, where an empty corner between two edge neighbors does not separate them.
    let mut joined = ring;
    for corner in [1, 3, 5, 7] {
        joined[corner] |= ring[corner - 1] && ring[(corner + 1) % 8];
    }
    let starts = (0..8).filter(|&k| joined[k] && !joined[(k + 7) % 8]).count();
    starts <= 1
}

/// Follows a closed curve of `count` pixels, each with two neighbors.
fn traverse(boundary: &Mask, count: usize) -> Option<Vec<[i64; 2]>> {
    const PIXELS_MIN: usize = 4;
    if count < PIXELS_MIN {
        return None;
    }
    let (width, height) = (boundary.width() as i64, boundary.height() as i64);
    let start = (0..width)
        .rev()
        .find_map(|x| (0..height).find(|&y| boundary.contains(x, y)).map(|y| [x, y]))?;
    let neighbors = |[x, y]: [i64; 2]| {
        let found: Vec<[i64; 2]> = AROUND
            .iter()
            .map(|[u, v]| [x + u, y + v])
            .filter(|&[x, y]| boundary.contains(x, y))
            .collect();
        <[[i64; 2]; 2]>::try_from(found).ok()
    };
    // At the right-most pixel the counterclockwise way is up, as far as it is not only to the left.
    let [a, b] = neighbors(start)?;
    let next = if (a[1], b[0]) < (b[1], a[0]) { a } else { b };
    let mut curve = vec![start, next];
    loop {
        let (before, at) = (curve[curve.len() - 2], curve[curve.len() - 1]);
        let [a, b] = neighbors(at)?;
        let next = if a == before { b } else { a };
        if next == start {
            return (curve.len() == count).then_some(curve);
        }
        if curve.len() >= count {
            return None;
        }
        curve.push(next);
    }
}
