//! The distance transform against brute force, and the largest circle of a polygon against the distance transform.

use proptest::prelude::*;
use taut_recognize::hand::circle::inscribed_circle;
use taut_recognize::hand::distance::{Border, distance_transform};
use taut_recognize::hand::mask::Mask;
use taut_recognize::hand::outline::{follow_cracks, twice_signed_area};

/// The next number of a linear congruential generator, its high bits.
fn next(state: &mut u64) -> u64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    *state >> 33
}

/// Returns the squared distance to the nearest pixel outside, by trying all.
fn brute_force(mask: &Mask, x: i64, y: i64, border: Border) -> Option<u64> {
    let (width, height) = (mask.width() as i64, mask.height() as i64);
    let mut best: Option<u64> = None;
    for v in -1..=height {
        for u in -1..=width {
            let is_beyond = u < 0 || v < 0 || u == width || v == height;
            if is_beyond && border == Border::Ignored || mask.contains(u, v) {
                continue;
            }
            let square = ((u - x).pow(2) + (v - y).pow(2)) as u64;
            best = Some(best.map_or(square, |other| other.min(square)));
        }
    }
    best
}

/// Makes a random set of pixels; its density is random too, so that full and empty ones are among them.
fn random_mask(state: &mut u64, side_max: u64) -> Mask {
    let (width, height) = (1 + next(state) % side_max, 1 + next(state) % side_max);
    let density = next(state) % 1025;
    let bits: Vec<bool> = (0..width * height).map(|_| next(state) % 1024 < density).collect();
    Mask::from_fn(width as usize, height as usize, |x, y| bits[y * width as usize + x])
}

#[test]
fn distances_are_exact_on_ten_thousand_images() {
    let mut state = 1;
    let mut without = 0;
    for image in 0..10_000 {
        let mask = random_mask(&mut state, 12);
        let border = if image % 2 == 0 { Border::Outside } else { Border::Ignored };
        let found = distance_transform(&mask, border);
        for y in 0..mask.height() {
            for x in 0..mask.width() {
                let wanted = brute_force(&mask, x as i64, y as i64, border);
                assert_eq!(found.squared(x, y), wanted, "image {image}, pixel {x} {y}");
                without += usize::from(wanted.is_none());
            }
        }
        assert_eq!(found.squared(mask.width(), 0), None);
    }
    assert!(without > 100, "{without} pixels of images without a pixel outside");
}

#[test]
fn distances_of_long_images_are_exact() {
    // One pixel outside, at one end: squares beyond 32 bits.
    let length = 70_000;
    for is_wide in [true, false] {
        let (width, height) = if is_wide { (length, 1) } else { (1, length) };
        let mask = Mask::from_fn(width, height, |x, y| x + y > 0);
        let found = distance_transform(&mask, Border::Ignored);
        let far = (length - 1) as u64;
        assert_eq!(found.deepest(), Some(([width - 1, height - 1], far * far)));
    }
}

#[test]
fn an_empty_image_has_no_distances() {
    let mask = Mask::new(0, 0);
    assert_eq!(distance_transform(&mask, Border::Outside).deepest(), None);
    assert_eq!(distance_transform(&mask, Border::Outside).squared(0, 0), None);
}

#[test]
fn a_disc_may_not_leave_the_image() {
    let mask = Mask::from_fn(9, 5, |_, _| true);
    assert_eq!(distance_transform(&mask, Border::Outside).deepest(), Some(([2, 2], 9)));
    assert_eq!(distance_transform(&mask, Border::Ignored).deepest(), None);
}

#[test]
fn the_cracks_enclose_the_area_of_the_set() {
    for radius in [1.0, 3.5, 20.2] {
        let is_inside = |x: usize, y: usize| {
            (x as f64 - 25.0).powi(2) + (y as f64 - 25.0).powi(2) <= radius * radius
        };
        let mask = Mask::from_fn(51, 51, is_inside);
        let cracks = follow_cracks(&mask);
        let corners: Vec<[f64; 2]> =
            cracks.iter().map(|crack| crack.corner.map(|c| c as f64)).collect();
        assert_eq!(twice_signed_area(&corners), 2.0 * mask.count() as f64);
    }
    assert!(follow_cracks(&Mask::new(3, 3)).is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 40, ..ProptestConfig::default() })]

    /// The largest circle of a star-shaped polygon against the distance transform of its pixels at a large scale. Some pixel's
    /// center is within √½ of that of the circle, so the transform finds a radius less by √½ at most. It measures to a center
    /// outside, which is not far from the nearest point of the boundary: there is one within √½ of the center of each disc of that radius,
    /// and at a reflex corner a disc outside fits between the edges. Their angle is least for 24 corners, one at 20 between two at 70: its
    /// half has a sine of 0.3556, the disc's center is √½/0.3556 from the corner, and the radius found is more by 2.7 at most.
    #[test]
    fn circles_agree_with_the_distance_transform(radii in prop::collection::vec(20f64..70.0, 3..25)) {
        let corners: Vec<[f64; 2]> = radii.iter().enumerate().map(|(k, radius)| {
            let angle = std::f64::consts::TAU * k as f64 / radii.len() as f64;
            [75.0 + radius * angle.cos(), 75.0 + radius * angle.sin()]
        }).collect();
        let is_inside = |p: [f64; 2]| {
            let mut inside = false;
            for k in 0..corners.len() {
                let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
                if (a[1] > p[1]) != (b[1] > p[1])
                    && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
                {
                    inside = !inside;
                }
            }
            inside
        };
        let mask = Mask::from_fn(150, 150, |x, y| is_inside([x as f64 + 0.5, y as f64 + 0.5]));
        let (_, square) = distance_transform(&mask, Border::Outside).deepest().expect("pixels outside");
        let circle = inscribed_circle(&corners, 1e-3).expect("a polygon with an inside");
        prop_assert!(is_inside(circle.center));
        let difference = circle.radius - (square as f64).sqrt();
        let sqrt_half = std::f64::consts::FRAC_1_SQRT_2;
        let most = sqrt_half + sqrt_half / 0.3556;
        prop_assert!(difference <= sqrt_half + 1e-9 && difference >= -most - 1e-3, "{difference}");
        // The circle is in the polygon, and no sample of a grid has a larger one.
        let to_boundary = |p: [f64; 2]| {
            (0..corners.len()).map(|k| {
                let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
                let (d, e) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
                let share = ((d[0] * e[0] + d[1] * e[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
                (e[0] - share * d[0]).hypot(e[1] - share * d[1])
            }).fold(f64::INFINITY, f64::min)
        };
        prop_assert!((to_boundary(circle.center) - circle.radius).abs() < 1e-9);
        for k in 0..2500 {
            let p = [f64::from(k % 50) * 3.0, f64::from(k / 50) * 3.0];
            prop_assert!(!is_inside(p) || to_boundary(p) <= circle.radius + 1e-3);
        }
    }
}

#[test]
fn circles_of_known_polygons() {
    let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    let circle = inscribed_circle(&square, 1e-6).expect("a square has an inside");
    assert!((circle.radius - 2.0).abs() <= 1e-6);
    // Within 1e-6 of the radius means within as much of the center, as the sides are flat.
    assert!((circle.center[0] - 2.0).abs() <= 1e-5 && (circle.center[1] - 2.0).abs() <= 1e-5);
    // The inradius of the triangle of sides 3, 4, 5 is 1.
    let triangle = [[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]];
    let circle = inscribed_circle(&triangle, 1e-9).expect("a triangle has an inside");
    assert!((circle.radius - 1.0).abs() <= 1e-9);
    assert_eq!(inscribed_circle(&square[..2], 1e-6), None);
    assert_eq!(inscribed_circle(&[[1.0, 1.0]; 5], 1e-6), None);
    assert_eq!(inscribed_circle(&[[0.0, 0.0], [f64::NAN, 1.0], [1.0, 0.0]], 1e-6), None);
}
