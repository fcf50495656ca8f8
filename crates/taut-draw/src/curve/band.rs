//! The borders of a band around a polyline.

/// Corners are cut off where their tip is this many times farther than the band is wide.
const TIP_RATIO_MAX: f64 = 2.0;

/// The polyline shifted to its left and to its right by `width`.
pub(super) fn borders(vertices: &[[f64; 2]], closed: bool, width: f64) -> Vec<Vec<[f64; 2]>> {
    let mut vertices = vertices.to_vec();
    vertices.dedup();
    if closed && vertices.first() == vertices.last() {
        vertices.pop();
    }
    let n = vertices.len();
    if n < 2 {
        return Vec::new();
    }
    // The unit normal of the edge after each vertex, to its left.
    let normals: Vec<[f64; 2]> = (0..n)
        .map(|i| {
            let (a, b) = (vertices[i], vertices[(i + 1) % n]);
            let [x, y] = [b[0] - a[0], b[1] - a[1]];
            let length = x.hypot(y);
            [-y / length, x / length]
        })
        .collect();
    let shift = |i: usize| -> [f64; 2] {
        let before = if i > 0 { i - 1 } else { n - 1 };
        let (u, v) = match closed {
            true => (normals[before], normals[i]),
            false if i == 0 => (normals[0], normals[0]),
            false if i == n - 1 => (normals[n - 2], normals[n - 2]),
            false => (normals[before], normals[i]),
        };
        // The tip of the mitre between both edges, cut off where it is far.
        let sum = [u[0] + v[0], u[1] + v[1]];
        let square = sum[0] * sum[0] + sum[1] * sum[1];
        let least = 4.0 / (TIP_RATIO_MAX * TIP_RATIO_MAX);
        let factor = 2.0 / square.max(least);
        [factor * sum[0], factor * sum[1]]
    };
    let side = |sign: f64| -> Vec<[f64; 2]> {
        (0..n)
            .map(|i| {
                let [x, y] = shift(i);
                [vertices[i][0] + sign * width * x, vertices[i][1] + sign * width * y]
            })
            .collect()
    };
    vec![side(1.0), side(-1.0)]
}

#[cfg(test)]
mod tests {
    use super::borders;

    #[test]
    fn a_square_has_a_square_on_either_side() {
        let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        let [left, right] = &borders(&square, true, 1.0)[..] else { panic!("two borders") };
        let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-12;
        assert!(near(left[0], [1.0, 1.0]) && near(left[2], [3.0, 3.0]), "{left:?}");
        assert!(near(right[0], [-1.0, -1.0]) && near(right[2], [5.0, 5.0]), "{right:?}");
    }

    #[test]
    fn what_has_no_edge_has_no_band() {
        assert!(borders(&[[1.0, 1.0], [1.0, 1.0]], true, 1.0).is_empty());
        let hairpin = borders(&[[0.0, 0.0], [9.0, 0.0], [0.0, 1e-9]], false, 1.0);
        assert!(hairpin.iter().flatten().flatten().all(|x| x.abs() < 20.0), "{hairpin:?}");
    }
}
