//! Largest rectangles of any direction: closed forms, laws, other solvers as judges, and mutations of the certificate.

use super::common::{Ring, comb, star_shaped, tour};
use super::rings::{rows, square};
use crate::test_length::long_or;
use taut_certify::{
    CheckError, InscribedOrientedRectangle, OrientedRectangleVerdict, Solution, Stop,
};
use taut_inscribe::{
    Error, OrientedRectangleOptions, RectangleOptions, inscribed_oriented_rectangle,
    inscribed_rectangle,
};
use taut_points::Points;

fn solve(rings: &[Ring], epsilon: f64) -> Result<Solution<InscribedOrientedRectangle>, Error> {
    let options = OrientedRectangleOptions { epsilon, ..Default::default() };
    inscribed_oriented_rectangle(&Points::new(&rows(rings), 3).unwrap(), &options)
}

fn check(
    found: &Solution<InscribedOrientedRectangle>,
    rings: &[Ring],
) -> Result<OrientedRectangleVerdict, CheckError> {
    found.check(&Points::new(&rows(rings), 3).unwrap())
}

fn proved(rings: &[Ring], epsilon: f64) -> Solution<InscribedOrientedRectangle> {
    let found = solve(rings, epsilon).unwrap();
    let verdict = check(&found, rings);
    let verdict = verdict.unwrap_or_else(|error| panic!("{error}: {:?}, {rings:?}", found.answer));
    assert_eq!(found.trace.stop, Stop::Converged, "{rings:?}: {verdict:?}");
    assert!(verdict.gap <= epsilon * (1.0 + 1e-8), "{verdict:?}");
    found
}

/// A ring turned by an angle about the origin.
fn turned(ring: &[[f64; 2]], angle: f64) -> Ring {
    let (sine, cosine) = angle.sin_cos();
    ring.iter().map(|[x, y]| [cosine * x - sine * y, sine * x + cosine * y]).collect()
}

/// A regular polygon with corners on the unit circle.
fn regular(corners: u32) -> Ring {
    let angle = |i: u32| std::f64::consts::TAU * (f64::from(i) + 0.3) / f64::from(corners);
    (0..corners).map(|i| [angle(i).cos(), angle(i).sin()]).collect()
}

fn assert_area(rings: &[Ring], epsilon: f64, expected: f64) {
    let area = proved(rings, epsilon).answer.area;
    // Answers are shrunk by some roundings of the terms of tests, for which 1e-11 is ample.
    let is_near = area <= expected * (1.0 + 1e-11) && area * (1.0 + 1.1 * epsilon) >= expected;
    assert!(is_near, "{area} instead of {expected}: {rings:?}");
}

#[test]
fn closed_forms_are_found_in_any_direction() {
    for angle in [0.0, 0.3, 0.9, 2.2] {
        let turn = |ring: &[[f64; 2]]| turned(ring, angle);
        let rectangle = [[1.0, 1.0], [4.0, 1.0], [4.0, 2.5], [1.0, 2.5]];
        assert_area(&[turn(&rectangle)], 1e-6, 4.5);
        let l = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        assert_area(&[turn(&l)], 1e-6, 3.0);
        let frame = [turn(&square(0.0, 0.0, 4.0)), turn(&square(1.0, 1.0, 2.0))];
        assert_area(&frame, 1e-6, 4.0);
        let far = [turn(&square(0.0, 0.0, 1.0)), turn(&square(5.0, 0.0, 3.0))];
        assert_area(&far, 1e-6, 9.0);
        // Half of a right triangle, in a family from both legs, and the middle of a hexagon.
        assert_area(&[turn(&[[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])], 1e-3, 3.0);
        assert_area(&[turn(&regular(6))], 1e-4, 3f64.sqrt());
        assert_area(&[turn(&regular(8))], 1e-3, 2.0);
    }
    assert_area(&[comb(5, 1.5)], 1e-4, 9.0);
    // Any inscribed square of a circle has the area 2; one of the polygon is at least that of four of its corners.
    assert_area(&[regular(64)], 1e-2, 2.0);
}

#[test]
fn the_answer_of_a_needle_is_the_needle() {
    let needle = [[0.0, 0.0], [1.0, 0.0], [1.0, 1e-3], [0.0, 1e-3]];
    for &angle in long_or(&[0.0, 0.4, 1.2][..], &[0.4]) {
        let found = proved(&[turned(&needle, angle)], 1e-3);
        assert!((found.answer.area / 1e-3 - 1.0).abs() < 1e-8, "{found:?}");
        assert!((found.answer.ratio / 1e-3 - 1.0).abs() < 1e-8, "{found:?}");
    }
}

#[test]
fn images_have_the_image_of_the_answer() {
    let ring = tour(4, 14);
    let before = proved(std::slice::from_ref(&ring), 1e-3).answer.area;
    let near = |image: Ring, scale: f64| {
        let after = proved(&[image], 1e-3).answer.area / scale / scale;
        assert!((after / before - 1.0).abs() < 1.1e-3, "{after} and {before}: {scale}");
    };
    for angle in [0.2, 0.5, 1.0, 1.4, 2.9] {
        near(turned(&ring, angle), 1.0);
    }
    for scale in [1e-100, 0.3, 1e100, 1e150] {
        near(ring.iter().map(|p| p.map(|x| scale * x)).collect(), scale);
    }
    near(ring.iter().map(|p| [p[0] + 1e3, p[1] - 1e3]).collect(), 1.0);
    near(ring.iter().map(|p| [-p[0], p[1]]).collect(), 1.0);
    let start: Ring = ring[5..].iter().chain(&ring[..5]).copied().collect();
    near(start, 1.0);
    near(ring.iter().rev().copied().collect(), 1.0);
}

/// In frames turned by 24 angles no rectangle along the axes is above the proved bound, and at angle 0 none is larger by more than the
/// gap.
#[test]
fn no_rectangle_along_turned_axes_is_larger() {
    for seed in 0..8 {
        let size = 5 + (seed as usize) % 6;
        let ring = if seed % 2 == 0 { tour(seed, size) } else { star_shaped(seed, size) };
        let found = proved(std::slice::from_ref(&ring), 1e-2);
        let verdict = check(&found, std::slice::from_ref(&ring)).unwrap();
        let mut best = 0.0f64;
        for turn in 0..24 {
            let image = turned(&ring, f64::from(turn) * std::f64::consts::FRAC_PI_2 / 24.0);
            let options = RectangleOptions { epsilon: 0.05, max_cells: 2000, ..Default::default() };
            let source = Points::new(image.as_flattened(), 2).unwrap();
            let area = inscribed_rectangle(&source, &options).unwrap().answer.area;
            assert!(area <= verdict.upper * (1.0 + 1e-9), "{area} and {verdict:?}: {ring:?}");
            best = best.max(area);
        }
        assert!(best >= 0.7 * verdict.lower, "{best} and {verdict:?}: {ring:?}");
    }
}

#[test]
fn a_rectangle_in_a_bay_or_a_hole_is_not_inside() {
    // The hole is larger than any rectangle inside, and no edge enters it.
    let angle = 0.35;
    let rings = [turned(&square(0.0, 0.0, 4.0), angle), turned(&square(0.5, 0.5, 3.0), angle)];
    assert_area(&rings, 1e-4, 2.0);
    let u = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 3.0],
        [3.5, 3.0],
        [3.5, 0.5],
        [0.5, 0.5],
        [0.5, 3.0],
        [0.0, 3.0],
    ];
    assert_area(&[turned(&u, angle)], 1e-4, 2.0);
}

#[test]
fn a_budget_is_kept_and_bad_input_is_refused() {
    let rings = [tour(9, 30)];
    let values = rows(&rings);
    let source = Points::new(&values, 3).unwrap();
    for max_cells in [1, 2, 3, 100] {
        let options = OrientedRectangleOptions { max_cells, epsilon: 1e-9, ..Default::default() };
        let found = inscribed_oriented_rectangle(&source, &options).unwrap();
        assert!(found.certificate.tree.len() as u64 <= max_cells);
        assert_eq!(found.trace.stop, Stop::NodeBudget);
        found.check(&source).unwrap();
    }
    let options = OrientedRectangleOptions { max_cells: 0, ..Default::default() };
    assert!(matches!(inscribed_oriented_rectangle(&source, &options), Err(Error::Input(_))));
    assert!(matches!(solve(&rings, 1.0), Err(Error::Input(_))));
    let crossed = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    assert!(matches!(solve(&[crossed], 1e-3), Err(Error::NotSimple { .. })));
    for scale in [1e200, 1e-200] {
        let image: Ring = square(0.0, 0.0, 1.0).iter().map(|p| p.map(|x| x * scale)).collect();
        assert!(matches!(solve(&[image], 1e-3), Err(Error::Area)));
    }
}

#[test]
fn repeated_rows_change_nothing() {
    let ring = tour(3, 12);
    let mut doubled: Ring = ring.iter().flat_map(|&p| [p, p]).collect();
    doubled.push(ring[0]);
    let [one, other] = [ring, doubled].map(|ring| proved(&[ring], 1e-2));
    assert_eq!(one.answer, other.answer);
}

#[test]
fn every_change_of_answer_or_proof_is_refused() {
    let rings = [tour(6, 12)];
    let found = proved(&rings, 1e-2);
    let is_refused = |change: &dyn Fn(&mut Solution<InscribedOrientedRectangle>)| {
        let mut changed = found.clone();
        change(&mut changed);
        matches!(check(&changed, &rings), Err(CheckError::Rejected(_)))
    };
    for k in 0..2 {
        for by in [-0.01, 0.01] {
            assert!(is_refused(&|f| f.answer.center[k] += by));
        }
        assert!(is_refused(&|f| f.answer.axis[k] = f64::NAN));
        assert!(is_refused(&|f| f.certificate.pivot[k] = -1.0));
    }
    assert!(is_refused(&|f| f.answer.axis = f.answer.axis.map(|x| 1.001 * x)));
    assert!(is_refused(&|f| f.answer.axis = [0.0; 2]));
    assert!(is_refused(&|f| f.answer.ratio = 1.5));
    assert!(is_refused(&|f| f.answer.area *= 1.0 + 1e-12));
    assert!(is_refused(&|f| f.certificate.gap *= 0.9));
    assert!(is_refused(&|f| f.certificate.gap = f64::INFINITY));
    assert!(is_refused(&|f| _ = f.certificate.leaves.pop()));
    assert!(is_refused(&|f| f.certificate.leaves.push(vec![0, 0])));
    assert!(is_refused(&|f| f.certificate.leaves[0][0] = 1 << 40));
    assert!(is_refused(&|f| f.certificate.tree.push('s')));
    assert!(is_refused(&|f| _ = f.certificate.tree.pop()));
    // A reason put in the place of another one holds by chance at most.
    let (mut refused, mut tried) = (0, 0);
    for position in (0..found.certificate.tree.len()).step_by(long_or(7, 21)) {
        for letter in "0123msbewxyzc".chars() {
            let of = position..position + 1;
            if found.certificate.tree[of.clone()] == letter.to_string() {
                continue;
            }
            tried += 1;
            refused += usize::from(is_refused(&|f| {
                f.certificate.tree.replace_range(of.clone(), &letter.to_string());
            }));
        }
    }
    // Of empty cells each reason holds, and of small cells that are outside more than one.
    assert!(refused * 100 >= tried * 85, "{refused} of {tried}");
    // So does a leaf with another number, of which the weights alone may be what they like.
    let (mut refused, mut tried) = (0, 0);
    for leaf in (0..found.certificate.leaves.len()).step_by(3) {
        for place in 0..found.certificate.leaves[leaf].len() {
            tried += 1;
            refused += usize::from(is_refused(&|f| f.certificate.leaves[leaf][place] += 3));
        }
    }
    assert!(refused * 3 >= tried, "{refused} of {tried}");
}

#[test]
fn holes_of_tiny_or_no_extent_are_not_overlooked() {
    let outer = vec![
        [-0.49, -0.49],
        [0.49, -0.49],
        [0.49, -0.01],
        [1.0, 0.0],
        [0.49, 0.01],
        [0.49, 0.49],
        [-0.49, 0.49],
    ];
    let free = proved(std::slice::from_ref(&outer), 1e-2);
    let tiny = 5e-324;
    for hole in [
        vec![[0.0, 0.0], [tiny, 0.0], [0.0, tiny]],
        vec![[0.0, 0.0], [1e-200, 0.0], [0.0, 1e-200]],
        vec![[0.1, 0.1], [0.1 + 1e-15, 0.1], [0.1, 0.1 + 1e-15]],
    ] {
        let rings = [outer.clone(), hole];
        let honest = solve(&rings, 0.5).unwrap();
        // The rectangle of the polygon without the hole, said to be one of this polygon.
        let mut forged = free.clone();
        forged.certificate.points_hash = honest.certificate.points_hash;
        for shift in [0.0, 1e-16, -1e-16, 1e-9] {
            forged.answer.center[1] = free.answer.center[1] + shift;
            assert!(check(&forged, &rings).is_err(), "{rings:?}");
        }
    }
}

/// In a thin polygon the gap is large, but the rectangle is the largest one known.
#[test]
fn thin_polygons_have_rectangles_as_long_as_they_are() {
    for width in [1e-3, 1e-5] {
        // Of the trapezoid with the height w between (0.1, 0.8 w) and (0.7, w), the best rectangle has the area 0.528 w.
        let trapezoid = [[0.0, 0.0], [1.0, 0.0], [0.7, width], [0.1, 0.8 * width]];
        let rectangle = [[0.0, 0.0], [1.0, 0.0], [1.0, width], [0.0, width]];
        for (ring, area) in [(trapezoid, 0.528 * width), (rectangle, width)] {
            for angle in [0.0, 0.6, 2.5] {
                let ring = turned(&ring, angle);
                let options = OrientedRectangleOptions { max_cells: 100, ..Default::default() };
                let points = rows(&[ring]);
                let points = Points::new(&points, 3).unwrap();
                let found = inscribed_oriented_rectangle(&points, &options).unwrap();
                assert!(found.answer.area >= 0.99 * area, "{width}, {angle}: {found:?}");
                found.check(&points).unwrap();
            }
        }
    }
}

#[test]
fn repeated_rows_leave_the_answer_as_it_is() {
    let rings: [[&[[f64; 2]]; 2]; 3] = [
        [&[[0.0, 0.0], [1.0, 0.0], [3.0, 2.0]], &[[7.0, 6.0], [7.0, 6.0], [4.0, 5.0], [1.0, 6.0]]],
        [
            &[[3.0, 6.0], [5.0, 4.0], [4.0, 7.0]],
            &[[7.0, 3.0], [7.0, 3.0], [7.0, 3.0], [3.0, 3.0], [1.0, 2.0]],
        ],
        [
            &[[3.0, 7.0], [5.0, 7.0], [5.0, 4.0], [3.0, 7.0], [3.0, 7.0]],
            &[[6.0, 1.0], [1.0, 1.0], [0.0, 2.0], [6.0, 1.0]],
        ],
    ];
    for given in rings {
        let given = given.map(<[_]>::to_vec);
        let without = given.clone().map(|mut ring| {
            ring.dedup();
            if ring.first() == ring.last() {
                ring.pop();
            }
            ring
        });
        let options = OrientedRectangleOptions { max_cells: 300, ..Default::default() };
        let answer = |rings: &[Ring]| {
            let found =
                inscribed_oriented_rectangle(&Points::new(&rows(rings), 3).unwrap(), &options);
            let found = found.map_err(|error| error.to_string())?;
            check(&found, rings).unwrap_or_else(|error| panic!("{error}: {rings:?}"));
            Ok::<_, String>(found.answer)
        };
        let (found, expected) = (answer(&given), answer(&without));
        assert!(expected.is_ok() && found == expected, "{found:?} instead of {expected:?}");
    }
}
