//! The least of a convex function on a segment.

use super::vectors::{minus, plus};

/// Steps of the search: each leaves two thirds, and 2⁻³⁵ of the segment is left.
const THIRDING_STEPS: usize = 60;

/// Returns the least of a convex function on the segment between two points, and where it is: by thirds, of which one is left out
/// at a time.
pub(super) fn least(
    [from, to]: [[f64; 3]; 2],
    of_point: impl Fn([f64; 3]) -> f64,
) -> (f64, [f64; 3]) {
    let along = minus(to, from);
    let at = |share: f64| plus(from, share, along);
    let (mut low, mut high) = (0.0, 1.0);
    if along != [0.0; 3] {
        for _ in 0..THIRDING_STEPS {
            let third = (high - low) / 3.0;
            if of_point(at(low + third)) <= of_point(at(high - third)) {
                high -= third;
            } else {
                low += third;
            }
        }
    }
    // The ends themselves come exactly.
    let middle = at(f64::midpoint(low, high));
    let mut best = (of_point(middle), middle);
    for end in [from, to] {
        let value = of_point(end);
        if value <= best.0 {
            best = (value, end);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::super::vectors::dot;
    use super::*;

    #[test]
    fn the_least_is_inside_or_at_an_end() {
        let square = |center: [f64; 3]| {
            move |p: [f64; 3]| {
                let off = minus(p, center);
                dot(off, off)
            }
        };
        let ends = [[1.0, 0.0, 2.0], [9.0, 0.0, 2.0]];
        let (value, place) = least(ends, square([4.0, 3.0, 2.0]));
        assert!((value - 9.0).abs() < 1e-9 && (place[0] - 4.0).abs() < 1e-6, "{value} {place:?}");
        assert_eq!(least(ends, square([-1.0, 0.0, 2.0])), (4.0, ends[0]));
        assert_eq!(least(ends, square([12.0, 0.0, 2.0])), (9.0, ends[1]));
        assert_eq!(least([ends[0]; 2], square([1.0, 0.0, 0.0])), (4.0, ends[0]));
        // Flat at its least.
        let (value, _) = least(ends, |p| (3.0 - p[0]).max(p[0] - 5.0).max(0.0));
        assert_eq!(value, 0.0);
    }
}
