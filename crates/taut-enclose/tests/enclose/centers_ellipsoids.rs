//! Centers of ellipsoids: against all partitions, against the ball of ellipsoids and against balls, and the laws that they obey.

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use taut_certify::{Centers, Items, Placement, Solution, Stop};
use taut_enclose::{
    BallOptions, CentersMethod, CentersOptions, Error, StreamingOptions, ball, centers,
};
use taut_points::{InputError, Points};

use crate::common::least_of_partitions;

fn seeded(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(59), failure_persistence: None, ..Config::default() }
}

/// Rows of a center and the lower triangle of a shape matrix.
#[derive(Clone, Debug)]
struct Ellipsoids {
    dim: usize,
    rows: Vec<Vec<f64>>,
}

fn options(epsilon: f64) -> CentersOptions<'static> {
    CentersOptions { epsilon, inputs: Items::Ellipsoids, ..Default::default() }
}

impl Ellipsoids {
    fn columns(&self) -> usize {
        self.dim * (self.dim + 3) / 2
    }

    /// An answer that the checker accepts.
    fn found(&self, k: usize, options: &CentersOptions<'_>) -> Solution<Centers> {
        let values = self.rows.concat();
        let points = Points::new(&values, self.columns()).unwrap();
        let found = centers(&points, k, options).unwrap_or_else(|why| panic!("{why}: {self:?}"));
        let verdict = found
            .check(&points)
            .unwrap_or_else(|why| panic!("{why}\nk = {k}, {options:?}\n{self:?}\n{found:?}"));
        assert_eq!((verdict.lower, verdict.upper), (found.answer.lower_bound, found.answer.radius));
        found
    }

    /// The radius, where the gap is what was asked for.
    fn radius(&self, k: usize, options: &CentersOptions<'_>) -> f64 {
        self.radius_to(options.epsilon.max(2e-11), k, options)
    }

    /// The same where rounding may leave a gap of so much.
    fn radius_to(&self, gap_max: f64, k: usize, options: &CentersOptions<'_>) -> f64 {
        let found = self.found(k, options);
        let gap = found.certificate.gap;
        assert!(gap <= gap_max, "gap {gap}, k = {k}\n{self:?}\n{found:?}");
        let is_reached = gap <= options.epsilon.max(2e-11);
        assert!((found.trace.stop == Stop::Converged) == is_reached, "{found:?}");
        found.answer.radius
    }

    /// The radius of the smallest ball of some of them.
    fn ball(&self, which: impl Iterator<Item = usize>) -> f64 {
        let rows: Vec<f64> = which.flat_map(|i| self.rows[i].clone()).collect();
        if rows.is_empty() {
            return 0.0;
        }
        let options = BallOptions { epsilon: 0.0, inputs: Items::Ellipsoids, ..Default::default() };
        ball(&Points::new(&rows, self.columns()).unwrap(), &options).unwrap().answer.radius
    }

    /// The same for each set of them.
    fn balls(&self) -> Vec<f64> {
        let n = self.rows.len();
        (0..1usize << n).map(|set| self.ball((0..n).filter(|i| set >> i & 1 == 1))).collect()
    }

    /// Places times a factor, then moved along each axis.
    fn moved(&self, factor: f64, shift: f64) -> Self {
        let mut moved = self.clone();
        for row in &mut moved.rows {
            for (column, value) in row.iter_mut().enumerate() {
                *value = match column < self.dim {
                    true => *value * factor + shift,
                    false => *value * factor * factor,
                };
            }
        }
        moved
    }

    /// Turned in the plane of the first two axes.
    fn turned(&self, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        let rotate = |v: &mut [f64], x: usize, y: usize| {
            (v[x], v[y]) = (cos * v[x] - sin * v[y], sin * v[x] + cos * v[y]);
        };
        let d = self.dim;
        let mut turned = self.clone();
        for row in &mut turned.rows {
            rotate(row, 0, 1);
            let mut full = vec![0.0; d * d];
            for j in 0..d {
                for k in 0..d {
                    full[j * d + k] = row[d + j.max(k) * (j.max(k) + 1) / 2 + j.min(k)];
                }
            }
            (0..d).for_each(|j| rotate(&mut full, j, d + j));
            (0..d).for_each(|j| rotate(&mut full, j * d, j * d + 1));
            // Of a flat ellipsoid that comes to lie almost along an axis, rounding leaves less than nothing across.
            let across = 5e-16 * (full[0] + full[d + 1]);
            for at in [0, d + 1] {
                full[at] += across;
            }
            for j in 0..d {
                for k in 0..=j {
                    row[d + j * (j + 1) / 2 + k] = full[j * d + k];
                }
            }
        }
        turned
    }
}

fn is_near(found: f64, wanted: f64, part: f64) -> bool {
    (found - wanted).abs() <= part * wanted.abs()
}

/// Up to so many ellipsoids of a rank from 0 to d, in one to three dimensions.
fn few_ellipsoids(
    dims: std::ops::RangeInclusive<usize>,
    most: usize,
) -> impl Strategy<Value = Ellipsoids> {
    (dims, 1..=most, any::<bool>(), 0.2f64..4.0).prop_flat_map(
        move |(dim, count, is_grid, spread)| {
            let number = move || match is_grid {
                true => (-3i32..4).prop_map(f64::from).boxed(),
                false => (-1.0f64..1.0).boxed(),
            };
            let axis = prop::collection::vec(number(), dim);
            let one = (prop::collection::vec(number(), dim), prop::collection::vec(axis, 0..=dim));
            prop::collection::vec(one, count).prop_map(move |all| {
                let row = |(place, axes): (Vec<f64>, Vec<Vec<f64>>)| {
                    let mut row: Vec<f64> = place.iter().map(|x| x * spread).collect();
                    for j in 0..dim {
                        for k in 0..=j {
                            row.push(axes.iter().map(|axis| axis[j] * axis[k]).sum());
                        }
                    }
                    row
                };
                Ellipsoids { dim, rows: all.into_iter().map(row).collect() }
            })
        },
    )
}

proptest! {
    #![proptest_config(seeded(60))]

    #[test]
    fn centers_are_those_of_the_best_partition(given in few_ellipsoids(1..=3, 7)) {
        let one = given.balls();
        for k in 1..=3 {
            for z in 0..=2.min(given.rows.len() - 1) {
                let options =
                    CentersOptions { outliers: z as u64, assignment: true, ..options(1e-9) };
                let (found, wanted) = (given.radius(k, &options), least_of_partitions(&one, k, z));
                prop_assert!(is_near(found, wanted, 3e-9), "{found} {wanted}, k = {k}, z = {z}");
            }
        }
    }

    #[test]
    fn one_center_is_that_of_the_ball(given in few_ellipsoids(1..=5, 30)) {
        let (found, wanted) = (given.radius_to(1e-9, 1, &options(0.0)), given.ball(0..given.rows.len()));
        prop_assert!(is_near(found, wanted, 2e-9), "{found} {wanted}");
    }

    #[test]
    fn balls_as_ellipsoids_are_balls(
        rows in prop::collection::vec((prop::collection::vec(-3.0f64..3.0, 3), 0.0f64..1.0), 1..25),
        dim in 1usize..=3, k in 1usize..=4,
    ) {
        let row = |(place, radius): &(Vec<f64>, f64)| {
            let mut row = place[..dim].to_vec();
            for j in 0..dim {
                row.extend((0..=j).map(|k| if j == k { radius * radius } else { 0.0 }));
            }
            row
        };
        let given = Ellipsoids { dim, rows: rows.iter().map(row).collect() };
        let found = given.found(k, &options(0.0));
        let balls: Vec<f64> = rows
            .iter()
            .flat_map(|(place, radius)| [&place[..dim], &[*radius]].concat())
            .collect();
        let exact = CentersOptions { epsilon: 0.0, inputs: Items::Balls, ..Default::default() };
        let wanted = centers(&Points::new(&balls, dim + 1).unwrap(), k, &exact).unwrap();
        let (found, wanted) = (found.answer, wanted.answer);
        prop_assert!(is_near(found.radius, wanted.radius, 1e-9));
        prop_assert!(is_near(found.lower_bound, wanted.lower_bound, 1e-9));
    }

    #[test]
    fn order_place_size_and_direction_do_not_matter(
        given in few_ellipsoids(2..=3, 14), k in 1usize..=4, angle in 0.0f64..7.0,
    ) {
        // Where points of ellipsoids nearly coincide, a search refutes by fits what a proof cannot, and the gap is larger than asked for. A
        // flat ellipsoid that is turned, or scaled by what is no power of two, has a little width or lacks it: the root of what was rounded.
        let left = 2e-8;
        let radius = given.radius_to(left, k, &options(1e-9));
        let mut other = given.clone();
        other.rows.reverse();
        let again = other.radius_to(left, k, &options(1e-9));
        prop_assert!(is_near(again, radius, 2.0 * left), "reversed: {again} {radius}");
        other.rows.extend(given.rows.clone());
        let again = other.radius_to(left, k, &options(1e-9));
        prop_assert!(is_near(again, radius, 2.0 * left), "doubled: {again} {radius}");
        let again = given.turned(angle).radius_to(left, k, &options(1e-9));
        prop_assert!((again - radius).abs() <= 2.0 * left * radius + 3e-7, "turned: {again} {radius}");
        for exponent in [-140, -60, 40, 140] {
            let factor = 10f64.powi(exponent);
            let again = given.moved(factor, 0.0).radius_to(left, k, &options(1e-9));
            prop_assert!(is_near(again, radius * factor, 2.0 * left), "1e{exponent}: {again} {radius}");
        }
        let again = given.moved(1.0, 1e6).radius(k, &options(1e-6));
        prop_assert!((again - radius).abs() <= 2e-6 * radius + 1e-8, "far: {again} {radius}");
    }
}

#[test]
fn coarse_answers_are_within_what_was_asked_for() {
    let mut state = 5u64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
        (state >> 33) as f64 / 2f64.powi(31)
    };
    for (n, k, epsilon) in [(60, 4, 0.01), (200, 6, 0.05), (2000, 3, 0.01), (300, 2, 1e-6)] {
        let row = |_| {
            let (x, y, a, b, c) = (draw(), draw(), 0.2 * draw(), 0.2 * draw(), 0.02 * draw());
            vec![10.0 * x, 10.0 * y, a * a + c, a * b, b * b + c]
        };
        let given = Ellipsoids { dim: 2, rows: (0..n).map(row).collect() };
        let asked = CentersOptions { assignment: true, ..options(epsilon) };
        let found = given.found(k, &asked);
        assert!(found.certificate.gap <= epsilon, "{n}: {found:?}");
        for threads in [1, 3] {
            let again = given.found(k, &CentersOptions { threads: Some(threads), ..asked });
            assert_eq!(again, found, "{threads} threads");
        }
    }
}

#[test]
fn odd_sets_have_their_answers() {
    let disc = |x: f64, y: f64, r: f64| vec![x, y, r * r, 0.0, r * r];
    let needle = |x: f64, y: f64, u: f64, v: f64| vec![x, y, u * u, u * v, v * v];
    let of = |rows: Vec<Vec<f64>>| Ellipsoids { dim: 2, rows };
    let radius = |rows: Vec<Vec<f64>>, k: usize| of(rows).radius(k, &options(1e-9));
    // One, and equal ones.
    assert!(is_near(radius(vec![disc(3.0, 4.0, 2.0)], 1), 2.0, 1e-9));
    assert!(is_near(radius(vec![disc(3.0, 4.0, 2.0); 5], 3), 2.0, 1e-9));
    // As many centers as ellipsoids, and more.
    let three =
        || vec![disc(0.0, 0.0, 1.0), needle(9.0, 0.0, 3.0, 4.0), needle(50.0, 9.0, 1.0, 0.0)];
    for k in [3, 4, 100] {
        assert!(is_near(radius(three(), k), 5.0, 1e-9));
    }
    // Points alone, with as many places as centers and with more.
    let points = || vec![disc(0.0, 0.0, 0.0), disc(6.0, 8.0, 0.0), disc(6.0, 8.0, 0.0)];
    assert_eq!(radius(points(), 2), 0.0);
    assert!(is_near(radius(points(), 1), 5.0, 1e-9));
    // Segments end to end, of which two fit in one ball.
    let chain = |n: i32| (0..n).map(|i| needle(2.0 * f64::from(i), 1.0, 1.0, 0.0)).collect();
    assert!(is_near(radius(chain(8), 4), 2.0, 1e-9));
    // Thick and thin, far apart in size.
    let mixed =
        vec![needle(0.0, 0.0, 1e-9, 0.0), needle(1.0, 0.0, 0.0, 1e-6), disc(0.5, 0.0, 1e-3)];
    assert!(is_near(radius(mixed, 1), 0.5, 1e-8));
    // All but what is left out are points.
    let left_out = CentersOptions { outliers: 1, assignment: true, ..options(1e-9) };
    let mut with_disc = points();
    with_disc.insert(0, disc(1.0, 1.0, 3.0));
    let found = of(with_disc).found(2, &left_out);
    assert_eq!((found.answer.radius, &found.answer.outliers[..]), (0.0, &[0][..]));
    // Two pairs so far apart that rounding is in the way of a small gap.
    for far in [1e6, 1e10, 1e14, 1e40] {
        let pairs = [
            disc(0.0, 0.0, 1.0),
            needle(0.0, 1.0, 2.0, 0.5),
            disc(far, 0.0, 1.0),
            needle(far, 1.0, 0.5, 2.0),
        ];
        let asked = CentersOptions { assignment: true, ..options(1e-12) };
        let found = of(pairs.to_vec()).found(2, &asked);
        assert_eq!(found.trace.stop, Stop::Rounding, "{far:e}");
        let wanted = [0, 2].map(|i| of(pairs[i..i + 2].to_vec()).ball(0..2));
        let wanted = wanted[0].max(wanted[1]);
        assert!((found.answer.radius - wanted).abs() <= 4e-16 * far + 1e-9, "{found:?}");
    }
    // In one dimension an ellipsoid is an interval.
    let intervals = [[0.0, 1.0], [3.0, 4.0], [10.0, 0.0]];
    let intervals = Ellipsoids { dim: 1, rows: intervals.iter().map(|row| row.to_vec()).collect() };
    assert!(is_near(intervals.radius(2, &options(1e-9)), 3.0, 1e-9));
}

#[test]
fn what_ellipsoids_cannot_have_is_refused_by_name() {
    let rows = [0.0, 0.0, 1.0, 0.0, 1.0, 5.0, 0.0, 1.0, 0.0, 1.0];
    let points = Points::new(&rows, 5).unwrap();
    let refused = |options: CentersOptions<'_>, wanted: &str| match centers(&points, 1, &options) {
        Err(Error::Input(InputError::Option { name, .. })) => assert_eq!(name, wanted),
        other => panic!("{other:?}"),
    };
    let base = options(0.01);
    for method in [
        CentersMethod::Thesis,
        CentersMethod::FarthestFirst,
        CentersMethod::Stream(StreamingOptions::default()),
    ] {
        refused(CentersOptions { method, ..base }, "method");
    }
    refused(CentersOptions { placement: Placement::Rows, ..base }, "placement");
    refused(CentersOptions { weights: true, ..base }, "weights");
    refused(CentersOptions { group: Some(0), ..base }, "group");
    refused(CentersOptions { outliers: 2, ..base }, "outliers");
    let solve = |rows: &[f64], columns: usize| {
        centers(&Points::new(rows, columns).unwrap(), 1, &base).map(|_| ())
    };
    assert!(matches!(solve(&rows[..4], 4), Err(Error::NoShape { columns: 4 })));
    let negative = [0.0, 0.0, 1.0, 0.0, 1.0, 5.0, 0.0, 1.0, 2.0, 1.0];
    assert!(matches!(solve(&negative, 5), Err(Error::NegativeShape { row: 1 })));
    assert!(matches!(
        solve(&[0.0, f64::NAN, 1.0, 0.0, 1.0], 5),
        Err(Error::Input(InputError::NonFinite { row: 0, column: 1, .. }))
    ));
    assert!(matches!(solve(&[], 5), Err(Error::Empty)));
    assert!(matches!(solve(&[-1e308, 1.0, 1e308, 1.0], 2), Err(Error::Overflow)));
}

#[test]
fn nodes_that_run_out_leave_what_is_proved() {
    let row = |i: usize| {
        let (x, y) = ((i * 37 % 101) as f64, (i * 61 % 97) as f64);
        vec![x, y, 1.0 + (i % 7) as f64, 0.5, 1.0 + (i % 5) as f64]
    };
    let given = Ellipsoids { dim: 2, rows: (0..120).map(row).collect() };
    for max_nodes in [0, 1, 100] {
        let found = given.found(8, &CentersOptions { max_nodes, ..options(1e-6) });
        assert_eq!(found.trace.stop, Stop::NodeBudget, "{max_nodes}");
        assert!(found.answer.lower_bound > 0.0 && found.certificate.gap < 1.5, "{max_nodes}");
    }
}

/// Points of the ellipsoids come so near to one another that fits of points to balls are off by their centers; a proof went on with one
/// point until its nodes were spent.
#[test]
fn a_point_in_a_ball_is_not_asked_for_again() {
    let given = Ellipsoids {
        dim: 3,
        rows: vec![
            vec![0.0; 9],
            vec![
                0.16139334421502352,
                -0.21448828487086966,
                0.17505090417489222,
                1.4868492567532212,
                -0.9720023295442703,
                0.8549993255682322,
                0.22209482029006156,
                -0.09797532661367576,
                0.38170375334438345,
            ],
            vec![
                -0.1228319485714959,
                0.0,
                0.12042750484634264,
                0.07626044025104065,
                0.13239597315926832,
                1.8793315266608395,
                0.3275819057221361,
                -0.14950732261956,
                1.7198822835863716,
            ],
            vec![
                -0.05791883318863558,
                -0.05284145041143137,
                0.1554151499898314,
                1.376379297792508,
                0.8005714245361142,
                0.7032016772522484,
                0.525461283887925,
                0.24579330146047446,
                0.21568047647580993,
            ],
        ],
    };
    let found = given.found(1, &options(0.0));
    assert!(found.certificate.gap <= 1e-10 && found.trace.stop != Stop::ProofBudget, "{found:?}");
}
