//! The normal of a triangle, for formats that have one.

/// The unit normal of a triangle whose corners go around it counter-clockwise; none where it has no area.
///
/// Edges are halved and then scaled, so that nothing overflows and small triangles far from the origin have one too.
pub(super) fn unit_normal([a, b, c]: [[f64; 3]; 3]) -> Option<[f64; 3]> {
    let edge = |to: [f64; 3]| scaled([0, 1, 2].map(|k| to[k] / 2.0 - a[k] / 2.0));
    let (u, v) = (edge(b)?, edge(c)?);
    unit([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])
}

/// The unit vector in this direction; none of 0.
pub(super) fn unit(vector: [f64; 3]) -> Option<[f64; 3]> {
    let [x, y, z] = scaled(vector)?;
    let length = (x * x + y * y + z * z).sqrt();
    Some([x / length, y / length, z / length])
}

/// The vector, so that its largest coordinate is 1 or −1; none of 0.
fn scaled(vector: [f64; 3]) -> Option<[f64; 3]> {
    let largest = vector.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    (largest > 0.0).then(|| vector.map(|x| x / largest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_of_any_size_have_a_normal() {
        for size in [5e-324, 1e-200, 1.0, 1e200, f64::MAX] {
            let found = unit_normal([[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0]]);
            let halved_away = size == 5e-324;
            assert_eq!(found, (!halved_away).then_some([0.0, 0.0, 1.0]), "{size}");
        }
        let far = unit_normal([[-f64::MAX, 0.0, 0.0], [f64::MAX, 0.0, 0.0], [0.0, 0.0, f64::MAX]]);
        assert_eq!(far, Some([0.0, -1.0, 0.0]));
    }

    #[test]
    fn what_has_no_area_has_none() {
        assert_eq!(unit_normal([[1.0; 3], [1.0; 3], [2.0; 3]]), None);
        assert_eq!(unit_normal([[0.0; 3], [1.0, 2.0, 3.0], [2.0, 4.0, 6.0]]), None);
        assert_eq!(unit([0.0, -0.0, 0.0]), None);
        assert_eq!(unit([0.0, 0.0, -3.0]), Some([0.0, 0.0, -1.0]));
    }
}
