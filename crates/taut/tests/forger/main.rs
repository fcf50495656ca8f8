//! Forged answers against the checkers, and exact oracles that judge what the checkers let pass.
//!
//! `cargo test -p taut --test forger -- --nocapture` makes 400 forgeries of each kind of answer, 1000 where the tests are long, and prints
//! what came of them; `TAUT_LONG_TESTS=1 TAUT_FORGERIES=100000` makes so many of each kind, of all inputs, and `TAUT_FORGER_REASONS=1` lists
//! why they were refused.
#![allow(unreachable_pub)] // modules of one test binary

mod attack;
mod attack_files;
mod cases;
mod forge;
mod oracle;
mod random;
mod test_length;

use attack::{Attack, attack};
use random::Random;

#[test]
fn no_false_ball_is_accepted() {
    attack("ball", &cases::ball::all()).report("ball");
}

#[test]
fn no_false_centers_are_accepted() {
    attack("centers", &cases::centers::all()).report("centers");
}

#[test]
fn no_false_ball_of_a_kernel_is_accepted() {
    attack("kernel-ball", &cases::kernel_ball::all()).report("kernel-ball");
}

#[test]
fn no_false_bodies_are_accepted() {
    attack("bodies", &cases::bodies::all()).report("bodies");
}

#[test]
fn no_false_circle_is_accepted() {
    attack("circle", &cases::circle::all()).report("circle");
}

#[test]
fn no_false_dop_is_accepted() {
    attack("dop", &cases::dop::all()).report("dop");
}

#[test]
fn no_false_ellipse_in_a_polygon_is_accepted() {
    attack("ellipse-in-polygon", &cases::ellipse::all()).report("ellipse-in-polygon");
}

#[test]
fn no_false_convex_polygon_is_accepted() {
    attack("convex-polygon", &cases::convex::all()).report("convex-polygon");
}

#[test]
fn no_false_oriented_rectangle_is_accepted() {
    attack("oriented-rectangle", &cases::oriented::all()).report("oriented-rectangle");
}

#[test]
fn no_false_rectangle_is_accepted() {
    attack("rectangle", &cases::rectangle::all()).report("rectangle");
}

#[test]
fn no_false_triangle_in_a_polygon_is_accepted() {
    attack("triangle-in-polygon", &cases::triangle::all()).report("triangle-in-polygon");
}

#[test]
fn no_false_order_is_accepted() {
    attack("order", &cases::order::all()).report("order");
}

#[test]
fn no_false_triangulation_is_accepted() {
    attack("triangulation", &cases::triangulation::all()).report("triangulation");
}

#[test]
fn no_false_curve_is_accepted() {
    attack("curve", &cases::curve::all()).report("curve");
}

#[test]
fn no_false_surface_is_accepted() {
    attack("surface", &cases::surface::all()).report("surface");
}

#[test]
fn no_false_ellipsoid_is_accepted() {
    attack("ellipsoid", &cases::ellipsoid::all()).report("ellipsoid");
}

#[test]
fn no_false_inscribed_ellipsoid_is_accepted() {
    attack("inscribed", &cases::inscribed::all()).report("inscribed");
}

#[test]
fn no_false_robust_ellipsoid_is_accepted() {
    attack("robust", &cases::robust::all()).report("robust");
}

#[test]
fn no_false_sort_is_accepted() {
    attack_files::attack("sort", &cases::files::sorts()).report("sort");
}

#[test]
fn no_false_transpose_is_accepted() {
    attack_files::attack("transpose", &cases::files::transposes()).report("transpose");
}

#[test]
fn no_false_sample_is_accepted() {
    attack_files::attack("sample", &cases::files::samples()).report("sample");
}

/// As fuzzers ask for them: the bytes alone say which forgery is made.
#[test]
fn forgeries_that_bytes_choose_are_judged_too() {
    let cases = cases::order::all();
    let mut attack = Attack::new("order", &cases);
    for number in 0..500u64 {
        let mut random = Random::new("bytes", number);
        let bytes: Vec<u8> = (0..random.below(40)).map(|_| random.next() as u8).collect();
        attack.forge_any(&mut Random::from_bytes(&bytes));
    }
    assert_eq!(Random::from_bytes(&[1, 2, 3]).next(), Random::from_bytes(&[1, 2, 9]).next());
    assert_ne!(Random::from_bytes(&[1, 2]).next(), Random::from_bytes(&[1, 3]).next());
}
