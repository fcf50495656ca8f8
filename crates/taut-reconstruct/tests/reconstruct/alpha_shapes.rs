//! Alpha shapes and filtered hulls against fractions: every facet of small sets, asked by all points.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::AddAssign;

use num_traits::ToPrimitive;
use samples::rational::{Fraction, Pencil, Vector, fraction, vector};
use samples::{Point, Random, soup, sphere};
use taut_delaunay::{Complex, DelaunayOptions, Space};
use taut_points::{InputError, Points};
use taut_reconstruct::Error;
use taut_reconstruct::alpha::{
    AlphaFilter, AlphaShape, Emptiness, FacetClass, alpha_shape, filtered_hull, optimal_alpha,
};

use crate::samples;
use crate::test_length::long_or;

fn space(points: &[Point]) -> Space {
    let points = Points::new(points.as_flattened(), 3).expect("whole rows");
    Space::build(&points, &DelaunayOptions::default()).expect("finite points")
}

fn sites(space: &Space) -> Vec<Point> {
    (0..space.site_count() as u32).map(|site| space.site(site)).collect()
}

/// Small sets that span space: general ones, and such of a grid with all its ties.
fn small_sets(count: u64) -> impl Iterator<Item = (bool, Space, Vec<Vector>)> {
    (0..count).filter_map(|number| {
        let mut random = Random(number);
        let (n, grid) = (5 + number as usize % 5, number % 3 == 0);
        let points: Vec<Point> = soup(n, number)
            .into_iter()
            .map(|p| if grid { p.map(|x| (3.0 * x).floor()) } else { p })
            .collect();
        // Few bits make the fractions fast; every seventh set has all.
        let short = |x: f64| if number % 7 == 0 { x } else { (x * 4096.0).round() / 4096.0 };
        let scale = [1.0, 2f64.powi(-30), 2f64.powi(60)][(random.unit() * 3.0) as usize];
        let points: Vec<Point> = points.into_iter().map(|p| p.map(|x| short(x) * scale)).collect();
        let space = space(&points);
        let exact = sites(&space).into_iter().map(vector).collect();
        let spans = matches!(space.complex(), Complex::Full);
        spans.then_some((grid, space, exact))
    })
}

/// All finite facets of a triangulation as sorted sites.
fn facets(space: &Space) -> BTreeSet<[u32; 3]> {
    let of = |t: u32| {
        let [a, b, c, d] = space.vertices(t);
        [[b, c, d], [a, c, d], [a, b, d], [a, b, c]].map(sorted)
    };
    space.simplices().flat_map(of).collect()
}

fn sorted(mut facet: [u32; 3]) -> [u32; 3] {
    facet.sort_unstable();
    facet
}

/// The class of a Delaunay facet at α by definition.
fn class(pencil: &Pencil, alpha: f64) -> FacetClass {
    let alpha2 = (alpha < f64::INFINITY).then(|| fraction(alpha) * fraction(alpha));
    let small = |square: &Fraction| alpha2.as_ref().is_none_or(|most| square <= most);
    let cells = pencil.cells();
    match cells.iter().filter(|cell| cell.as_ref().is_some_and(&small)).count() {
        2 => FacetClass::Interior,
        1 => FacetClass::Regular,
        _ if pencil.is_gabriel() && small(&pencil.square) => FacetClass::Singular,
        _ => FacetClass::Exterior,
    }
}

/// Radii where something changes, rounded, and their neighbors.
fn radii(pencils: &[Pencil]) -> Vec<f64> {
    let mut all = vec![0.0, f64::INFINITY];
    for square in pencils.iter().flat_map(|p| [Some(p.square.clone())].into_iter().chain(p.cells()))
    {
        // In two steps, as the square may be beyond all numbers.
        let root = square.and_then(|square| square.to_f64()).map_or(1.0, f64::sqrt);
        all.extend([root.next_down(), root, root.next_up()]);
    }
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

#[test]
fn every_facet_is_in_the_class_of_its_definition() {
    let mut met = BTreeMap::new();
    for (grid, space, points) in small_sets(long_or(40, 12)) {
        let facets: Vec<[u32; 3]> = facets(&space).into_iter().collect();
        let pencil = |facet: &[u32; 3]| {
            Pencil::of(facet.map(|site| site as usize), &points).expect("no facet is flat")
        };
        let pencils: Vec<Pencil> = facets.iter().map(pencil).collect();
        assert!(pencils.iter().all(|pencil| pencil.is_delaunay));
        if !grid {
            let n = points.len();
            let triples =
                (0..n).flat_map(|i| (0..i).flat_map(move |j| (0..j).map(move |k| [k, j, i])));
            let all = triples.filter_map(|t| Pencil::of(t, &points)).filter(|p| p.is_delaunay);
            assert_eq!(all.count(), facets.len(), "no facet is missing");
        }
        let all = radii(&pencils);
        let step = (all.len() / 25).max(1);
        for &alpha in all.iter().step_by(step) {
            let shape = alpha_shape(&space, alpha).expect("points that span space");
            let regular: BTreeSet<[u32; 3]> = shape.regular.iter().copied().map(sorted).collect();
            let singular: BTreeSet<[u32; 3]> = shape.singular.iter().copied().collect();
            let mut times = BTreeMap::new();
            for (facet, pencil) in facets.iter().zip(&pencils) {
                let truth = class(pencil, alpha);
                *times.entry(truth).or_insert(0) += 1;
                *met.entry(truth).or_insert(0) += 1;
                assert_eq!(
                    regular.contains(facet),
                    truth == FacetClass::Regular,
                    "{facet:?} {alpha}"
                );
                assert_eq!(
                    singular.contains(facet),
                    truth == FacetClass::Singular,
                    "{facet:?} {alpha}"
                );
            }
            let of = |class| times.get(&class).copied().unwrap_or(0);
            assert_eq!(shape.interior, of(FacetClass::Interior));
            assert_eq!(shape.exterior, of(FacetClass::Exterior));
            is_the_boundary(&shape, &sites(&space));
        }
    }
    let least = long_or(200, 60);
    assert!(met.len() == 4 && met.values().all(|&times| times > least), "{met:?}");
}

/// Regular facets face outward: away from their witness; and they close up.
fn is_the_boundary(shape: &AlphaShape, points: &[Point]) {
    let mut balance: BTreeMap<[u32; 2], i32> = BTreeMap::new();
    for (&[a, b, c], &apex) in shape.regular.iter().zip(&shape.apexes) {
        let [p, q, r, s] = [a, b, c, apex].map(|site| points[site as usize]);
        assert!(taut_predicates::space::orient(p, q, r, s).is_negative());
        for [u, v] in [[a, b], [b, c], [c, a]] {
            *balance.entry([u.min(v), u.max(v)]).or_default() += if u < v { 1 } else { -1 };
        }
    }
    assert!(balance.values().all(|&sum| sum == 0));
}

#[test]
fn the_optimal_radius_is_the_least_that_serves() {
    let mut seen = BTreeSet::new();
    for (_, space, points) in small_sets(24) {
        let pencils: Vec<Pencil> = facets(&space)
            .into_iter()
            .filter_map(|f| Pencil::of(f.map(|site| site as usize), &points))
            .collect();
        let changes = radii(&pencils);
        let cells: Vec<([u32; 4], Fraction)> = space
            .simplices()
            .map(|t| (space.vertices(t), square_of(space.vertices(t), &points)))
            .collect();
        for solids in 1..4 {
            let found = optimal_alpha(&space, solids).expect("points that span space");
            seen.insert(found.to_bits());
            // The shape is as wanted there, and at no radius where it changes before.
            let serves = |alpha: f64| {
                let shape = alpha_shape(&space, alpha).expect("points that span space");
                let mut on = vec![false; points.len()];
                for (cell, square) in &cells {
                    if alpha == f64::INFINITY || *square <= fraction(alpha) * fraction(alpha) {
                        cell.iter().for_each(|&v| on[v as usize] = true);
                    }
                }
                shape.solids <= solids && on.into_iter().all(|on| on)
            };
            assert!(serves(found), "{found}");
            let before = changes.iter().copied().chain([found.next_down()]);
            for alpha in before.filter(|&alpha| alpha < found) {
                assert!(!serves(alpha), "{alpha} before {found}");
            }
        }
    }
    assert!(seen.len() > 10);
}

/// The square of the circumradius of a cell, by one of its facets.
fn square_of(cell: [u32; 4], points: &[Vector]) -> Fraction {
    let own: Vec<Vector> = cell.iter().map(|&i| points[i as usize].clone()).collect();
    let [below, above] = Pencil::of([0, 1, 2], &own).expect("no facet is flat").cells();
    below.or(above).expect("the fourth corner is off the plane")
}

#[test]
fn the_filtered_hull_is_that_of_its_definition() {
    let (mut passed, mut failed, mut differ) = (0, 0, 0);
    for (_, space, points) in small_sets(40) {
        let pencils: BTreeMap<[u32; 3], Pencil> = facets(&space)
            .into_iter()
            .map(|f| (f, Pencil::of(f.map(|site| site as usize), &points).expect("not flat")))
            .collect();
        for epsilon in [0.0, 2e-5, 0.1, 0.4] {
            let hull = |emptiness| {
                let none = AlphaFilter::None;
                let hull = filtered_hull(&space, epsilon, emptiness, none).expect("spans space");
                hull.triangles.into_iter().collect::<BTreeSet<_>>()
            };
            let (two, all) = (hull(Emptiness::Apexes), hull(Emptiness::Sites));
            assert!(all.is_subset(&two));
            differ += two.len() - all.len();
            for (facet, pencil) in &pencils {
                let held = points.iter().any(|p| pencil.shrunk_holds(p, epsilon));
                assert_eq!(all.contains(facet), !held, "{facet:?} {epsilon}");
                (if held { &mut failed } else { &mut passed }).add_assign(1);
            }
            if epsilon == 0.0 {
                assert_eq!(two, all, "two vertices tell whether a facet is Gabriel");
            }
        }
    }
    assert!(passed > 300 && failed > 300 && differ > 5, "{passed} {failed} {differ}");
}

#[test]
fn the_two_filters_by_size_are_those_of_their_definition() {
    for (_, space, points) in small_sets(12) {
        let facets = facets(&space);
        let pencils: BTreeMap<[u32; 3], Pencil> = facets
            .iter()
            .map(|&f| (f, Pencil::of(f.map(|site| site as usize), &points).expect("not flat")))
            .collect();
        let all: Vec<Pencil> = facets
            .iter()
            .filter_map(|f| Pencil::of(f.map(|site| site as usize), &points))
            .collect();
        for alpha in radii(&all).into_iter().step_by(7) {
            let hull = |filter| {
                let found = filtered_hull(&space, 0.9, Emptiness::Apexes, filter);
                found.expect("spans space").triangles.into_iter().collect::<BTreeSet<_>>()
            };
            let plain = hull(AlphaFilter::None);
            let (by_circle, by_ball) =
                (hull(AlphaFilter::Circumradius(alpha)), hull(AlphaFilter::EmptyBall(alpha)));
            for facet in plain {
                let pencil = &pencils[&facet];
                let small =
                    alpha == f64::INFINITY || pencil.square <= fraction(alpha) * fraction(alpha);
                assert_eq!(by_circle.contains(&facet), small);
                assert_eq!(by_ball.contains(&facet), class(pencil, alpha) != FacetClass::Exterior);
            }
        }
    }
}

#[test]
fn smooth_samples_have_the_right_solid() {
    let ball = space(&sphere(2000));
    // All spheres of cells are that of the ball itself, up to rounding.
    let shape = alpha_shape(&ball, 1.0 + 1e-6).expect("spans space");
    assert_eq!((shape.solids, shape.regular.len(), shape.singular.len()), (1, 3996, 0));
    let alpha = optimal_alpha(&ball, 1).expect("spans space");
    assert!((alpha - 1.0).abs() < 1e-6, "{alpha}");

    // Two balls three radii apart: no sphere that touches both is that small.
    let mut points = sphere(400);
    points.extend(sphere(500).into_iter().map(|[x, y, z]| [x + 5.0, y, z]));
    let balls = space(&points);
    let shape = alpha_shape(&balls, 1.0 + 1e-6).expect("spans space");
    assert_eq!((shape.solids, shape.regular.len()), (2, 2 * 400 - 4 + 2 * 500 - 4));
    is_the_boundary(&shape, &sites(&balls));
    assert!((optimal_alpha(&balls, 2).expect("spans space") - 1.0).abs() < 1e-6);
    assert!(optimal_alpha(&balls, 1).expect("spans space") > 1.5);
}

#[test]
fn bad_input_is_named() {
    let cube = space(&soup(20, 1));
    for alpha in [-1.0, f64::NAN] {
        let refused = alpha_shape(&cube, alpha);
        assert!(matches!(refused, Err(Error::Input(InputError::Option { name: "alpha", .. }))));
        let filter = AlphaFilter::Circumradius(alpha);
        let refused = filtered_hull(&cube, 0.0, Emptiness::Apexes, filter);
        assert!(matches!(refused, Err(Error::Input(InputError::Option { name: "alpha", .. }))));
    }
    for epsilon in [-1e-9, 1.0, f64::NAN] {
        let refused = filtered_hull(&cube, epsilon, Emptiness::Apexes, AlphaFilter::None);
        assert!(matches!(refused, Err(Error::Input(InputError::Option { name: "epsilon", .. }))));
    }
    assert!(matches!(
        optimal_alpha(&cube, 0),
        Err(Error::Input(InputError::Option { name: "solids", .. }))
    ));
    let flat: Vec<Point> = soup(20, 1).into_iter().map(|[x, y, _]| [x, y, 1.0]).collect();
    for points in [vec![], vec![[1.0; 3]], vec![[1.0; 3], [2.0; 3], [3.0; 3]], flat] {
        let space = space(&points);
        assert!(matches!(alpha_shape(&space, 1.0), Err(Error::Flat { .. })));
        assert!(matches!(optimal_alpha(&space, 1), Err(Error::Flat { .. })));
    }
}

#[test]
fn scale_and_order_of_points_change_nothing() {
    let points = soup(400, 3);
    let alpha = 0.09;
    let plain = alpha_shape(&space(&points), alpha).expect("spans space");
    assert!(plain.regular.len() > 100 && plain.singular.len() > 10);
    for exponent in [-900, -3, 1, 40, 900] {
        let by = 2f64.powi(exponent);
        let scaled: Vec<Point> = points.iter().map(|p| p.map(|x| x * by)).collect();
        let scaled = alpha_shape(&space(&scaled), alpha * by).expect("spans space");
        assert_eq!(AlphaShape { alpha, ..scaled }, plain);
    }
    let optimal = optimal_alpha(&space(&points), 1).expect("spans space");
    let scaled: Vec<Point> = points.iter().map(|p| p.map(|x| 4.0 * x)).collect();
    assert_eq!(optimal_alpha(&space(&scaled), 1).expect("spans space"), 4.0 * optimal);
    let mut shuffled = points.clone();
    Random(9).shuffle(&mut shuffled);
    assert_eq!(alpha_shape(&space(&shuffled), alpha).expect("spans space"), plain);
}
