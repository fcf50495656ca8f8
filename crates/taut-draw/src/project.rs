//! Two directions that show most of a weighted set of vectors.
//!
//! *Idea.* The two leading eigenvectors of Σ wᵢ vᵢvᵢᵀ by subspace iteration, with the vectors kept as rows, so that no
//! d × d matrix is made. For the support of a ball with its multipliers as weights the trace of that matrix is r², so
//! an eigenvalue says which part of the squared radius lies along its direction.
//! *Trap.* Fewer than two independent vectors: the missing direction is the coordinate axis that is least used.

/// Iterations; the picture is a true projection however far they converged.
const ITERATIONS: usize = 200;

/// Two orthonormal directions in ℝᵈ for `vectors` (rows of length `dim`) and their weights, the stronger first.
pub(crate) fn plane(vectors: &[f64], weights: &[f64], dim: usize) -> [Vec<f64>; 2] {
    let heaviest = vectors
        .chunks_exact(dim)
        .zip(weights)
        .map(|(v, w)| (w * dot(v, v), v))
        .fold((0.0, None), |best, (size, v)| if size > best.0 { (size, Some(v)) } else { best });
    let mut u = heaviest.1.map_or_else(|| axis(dim, 0), <[f64]>::to_vec);
    let mut v =
        (0..dim).map(|j| ((j + 1) as f64 * 0.754_877_666).fract() - 0.5).collect::<Vec<_>>();
    frame(&mut u, &mut v);
    for _ in 0..ITERATIONS {
        let (mut next_u, mut next_v) = (vec![0.0; dim], vec![0.0; dim]);
        for (row, w) in vectors.chunks_exact(dim).zip(weights) {
            let (a, b) = (w * dot(row, &u), w * dot(row, &v));
            for j in 0..dim {
                next_u[j] += a * row[j];
                next_v[j] += b * row[j];
            }
        }
        frame(&mut next_u, &mut next_v);
        let change = (1.0 - dot(&u, &next_u).abs()).max(1.0 - dot(&v, &next_v).abs());
        (u, v) = (next_u, next_v);
        if change < 1e-12 {
            break;
        }
    }
    for direction in [&mut u, &mut v] {
        // A direction and its opposite are as good: the largest coordinate is made positive.
        let largest = direction.iter().fold(0.0_f64, |a, &x| if x.abs() > a.abs() { x } else { a });
        if largest < 0.0 {
            direction.iter_mut().for_each(|x| *x = -*x);
        }
    }
    [u, v]
}

/// Scales vectors together so that their largest entry is 1, whatever their unit was.
pub(crate) fn to_unit_reach(vectors: &mut [f64]) {
    let reach = vectors.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
    if reach > 0.0 {
        vectors.iter_mut().for_each(|v| *v /= reach);
    }
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn axis(dim: usize, k: usize) -> Vec<f64> {
    let mut axis = vec![0.0; dim];
    axis[k] = 1.0;
    axis
}

/// Makes two vectors orthonormal; a vector that vanishes becomes the coordinate axis least used by the other.
fn frame(u: &mut Vec<f64>, v: &mut Vec<f64>) {
    if !normalize(u) {
        *u = axis(u.len(), 0);
    }
    // Twice, since the first subtraction leaves rounding along u where v was almost parallel.
    let before = dot(v, v).sqrt();
    for _ in 0..2 {
        let along = dot(u, v);
        v.iter_mut().zip(u.iter()).for_each(|(x, y)| *x -= along * y);
    }
    if dot(v, v).sqrt() <= 1e-9 * before || !normalize(v) {
        let least = (0..u.len()).min_by(|&a, &b| u[a].abs().total_cmp(&u[b].abs())).unwrap_or(0);
        *v = axis(u.len(), least);
        let along = dot(u, v);
        v.iter_mut().zip(u.iter()).for_each(|(x, y)| *x -= along * y);
        normalize(v);
    }
}

fn normalize(v: &mut [f64]) -> bool {
    let norm = dot(v, v).sqrt();
    let usable = norm > 0.0 && norm.is_finite();
    if usable {
        v.iter_mut().for_each(|x| *x /= norm);
    }
    usable
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_two_strongest_axes() {
        let rows = [0.0, 3.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0];
        let [u, v] = plane(&rows, &[0.5, 0.5], 5);
        assert!((u[1] - 1.0).abs() < 1e-2 && (v[3] - 1.0).abs() < 1e-2, "{u:?} {v:?}");
    }

    #[test]
    fn missing_directions_are_replaced() {
        for rows in [vec![0.0; 8], vec![1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0]] {
            let [u, v] = plane(&rows, &[0.5, 0.5], 4);
            assert!((dot(&u, &u) - 1.0).abs() < 1e-12 && (dot(&v, &v) - 1.0).abs() < 1e-12);
            assert!(dot(&u, &v).abs() < 1e-12);
        }
    }
}
