//! Options out of all bounds are refused before any work, by every function that takes them.

use std::fmt::Display;

use taut::delaunay::Plane;
use taut::{
    BallOptions, CentersOptions, CurveOptions, DelaunayOptions, EllipsoidOptions,
    FarthestFirstOptions, Points, RobustOptions, SphereTreeOptions, SurfaceOptions,
};

/// Returns the error of a function that refuses an option.
fn refused<T, E: Display>(done: Result<T, E>) -> String {
    match done {
        Ok(_) => panic!("not refused"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_thousand_million_threads_are_refused_in_the_same_words_everywhere() {
    let plane = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.5];
    let space = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    let plane = Points::new(&plane, 2).unwrap();
    let space = Points::new(&space, 3).unwrap();
    for many in [1_000_000_000, 1025, 0] {
        let threads = Some(many);
        let said = format!("option `threads` is {many}: expected 1 to 1024");
        let ball = BallOptions { threads, ..Default::default() };
        assert_eq!(refused(taut::ball(&plane, &ball)), said);
        let ellipsoid = EllipsoidOptions { threads, ..Default::default() };
        assert_eq!(refused(taut::ellipsoid(&plane, &ellipsoid)), said);
        assert_eq!(refused(taut::ellipsoids(&[plane], &ellipsoid)), said);
        let robust = RobustOptions { threads, ..Default::default() };
        assert_eq!(refused(taut::robust_ellipsoid(&plane, &robust)), said);
        let centers = CentersOptions { threads, ..Default::default() };
        assert_eq!(refused(taut::centers(&plane, 2, &centers)), said);
        let farthest = FarthestFirstOptions { threads, ..Default::default() };
        assert_eq!(refused(taut::farthest_first(&plane, 2, &farthest)), said);
        let tree = SphereTreeOptions { threads, ..Default::default() };
        assert_eq!(refused(taut::sphere_tree(&plane, &tree)), said);
        let delaunay = DelaunayOptions { threads, ..Default::default() };
        assert_eq!(refused(Plane::build(&plane, &delaunay)), said);
        let curve = CurveOptions { threads, ..Default::default() };
        assert_eq!(refused(taut::curve(&plane, &curve)), said);
        let surface = SurfaceOptions { threads, ..Default::default() };
        assert_eq!(refused(taut::surface(&space, &surface)), said);
    }
}

#[test]
fn an_option_is_shown_in_its_shortest_form() {
    let points = Points::new(&[0.0, 0.0, 1.0, 0.0], 2).unwrap();
    let options = BallOptions { epsilon: 1e308, ..Default::default() };
    let said = refused(taut::ball(&points, &options));
    assert_eq!(said, "option `epsilon` is 1e308: expected a number in [0, 1)");
}
