//! Clips a square by half-planes, one after the other (Sutherland and Hodgman, Communications of the
//! ACM 17(1), 1974).

/// nᵀy ≤ h.
pub(super) type HalfPlane = ([f64; 2], f64);

/// A convex polygon, and whether it ends by itself.
pub(super) struct Polygon {
    pub(super) corners: Vec<[f64; 2]>,
    /// True if the half-planes bound it, and not the square that was begun with.
    pub(super) is_whole: bool,
}

/// At most this many squares are tried.
const SQUARES_MAX: i32 = 6;
/// Each square is this much larger than the one before.
const SQUARE_GROWTH: f64 = 32.0;

/// The polygon of some half-planes about the origin. One that does not end is cut off somewhere.
pub(super) fn polygon(half_planes: &[HalfPlane], reach: f64) -> Polygon {
    let mut size = reach;
    for _ in 0..SQUARES_MAX {
        let corners = within(half_planes, size);
        let is_whole = corners.iter().flatten().all(|v| v.abs() < size * (1.0 - 1e-9));
        if is_whole {
            return Polygon { corners, is_whole };
        }
        size *= SQUARE_GROWTH;
    }
    Polygon { corners: within(half_planes, 2.0 * reach), is_whole: false }
}

/// The same within a square of this half side.
fn within(half_planes: &[HalfPlane], size: f64) -> Vec<[f64; 2]> {
    let mut corners = vec![[-size, -size], [size, -size], [size, size], [-size, size]];
    for &(normal, offset) in half_planes {
        corners = cut(&corners, normal, offset);
    }
    corners
}

/// Returns what a half-plane leaves of a convex polygon.
fn cut(corners: &[[f64; 2]], [a, b]: [f64; 2], offset: f64) -> Vec<[f64; 2]> {
    let above: Vec<f64> = corners.iter().map(|[x, y]| a * x + b * y - offset).collect();
    if above.iter().all(|&v| v <= 0.0) {
        return corners.to_vec();
    }
    let mut left = Vec::with_capacity(corners.len() + 1);
    for (i, &here) in corners.iter().enumerate() {
        let next = (i + 1) % corners.len();
        if above[i] <= 0.0 {
            left.push(here);
        }
        if (above[i] <= 0.0) != (above[next] <= 0.0) {
            let part = above[i] / (above[i] - above[next]);
            let there = corners[next];
            left.push([0, 1].map(|k| here[k] + part * (there[k] - here[k])));
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_planes_leave_a_polygon_or_one_without_an_end() {
        let triangle = [([-1.0, 0.0], 1.0), ([0.0, -1.0], 1.0), ([1.0, 1.0], 1000.0)];
        let found = polygon(&triangle, 4.0);
        assert!(found.is_whole);
        let mut corners = found.corners;
        corners.iter_mut().flatten().for_each(|v| *v = v.round());
        corners.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        assert_eq!(corners, [[-1.0, -1.0], [-1.0, 1001.0], [1001.0, -1.0]]);

        let strip = polygon(&[([1.0, 0.0], 1.0), ([-1.0, 0.0], 1.0)], 4.0);
        assert!(!strip.is_whole && strip.corners.len() == 4);
        assert!(polygon(&[([1.0, 0.0], -5.0), ([-1.0, 0.0], 1.0)], 4.0).corners.is_empty());
    }
}
