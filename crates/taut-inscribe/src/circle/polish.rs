//! The center that is equally far from two or three edges, by Newton's method.

use super::distance::Edges;

/// Newton steps: convergence is quadratic, and edges may change from their inside to an end on the way.
const STEPS_MAX: usize = 16;

/// Returns a point near `start` that is equally far from the edges given, two or three; in scaled coordinates.
///
/// With two edges there is a curve of such points; each step is the shortest that leads to it.
pub(super) fn equidistant(edges: &Edges<'_>, touched: &[u32], start: [f64; 2]) -> Option<[f64; 2]> {
    let mut q = start;
    for _ in 0..STEPS_MAX {
        let mut from = [([0.0; 2], 0.0); 3];
        for (slot, &edge) in from.iter_mut().zip(touched) {
            *slot = edges.feature(q, edge);
        }
        let [(n, d), others @ ..] = from;
        let row =
            |(other, distance): ([f64; 2], f64)| ([other[0] - n[0], other[1] - n[1]], d - distance);
        let (u, s) = row(others[0]);
        let step = match touched.len() {
            2 => {
                let square = u[0] * u[0] + u[1] * u[1];
                [u[0] * s / square, u[1] * s / square]
            }
            3 => {
                let (v, t) = row(others[1]);
                let determinant = u[0] * v[1] - u[1] * v[0];
                [(s * v[1] - t * u[1]) / determinant, (t * u[0] - s * v[0]) / determinant]
            }
            _ => return None,
        };
        let next = [q[0] + step[0], q[1] + step[1]];
        if !next.iter().all(|x| x.is_finite()) {
            return None;
        }
        if next == q {
            break;
        }
        q = next;
    }
    Some(q)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Loops;
    use crate::runs::Runs;

    #[test]
    fn the_center_of_an_incircle_is_found() {
        let loops = Loops::of_ring(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.75]]);
        let runs = Runs::of(&loops.segments);
        let edges = Edges::of(&loops.segments, &runs);
        let q = equidistant(&edges, &[0, 1, 2], [0.6, 0.3]).unwrap();
        assert!((q[0] - 0.75).abs() < 1e-15 && (q[1] - 0.25).abs() < 1e-15, "{q:?}");
        let q = equidistant(&edges, &[0, 1], [0.6, 0.3]).unwrap();
        assert!((q[1] - (1.0 - q[0])).abs() < 1e-15, "{q:?}");
        assert_eq!(equidistant(&edges, &[0], [0.6, 0.3]), None);
    }
}
