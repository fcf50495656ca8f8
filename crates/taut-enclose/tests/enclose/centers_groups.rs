//! Centers of groups of rows: against all partitions, and the laws that they obey.

use std::collections::BTreeMap;

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use taut_certify::{Centers, Items, LowerBound, Placement, Solution, Stop};
use taut_enclose::{
    BallOptions, CentersMethod, CentersOptions, Error, StreamingOptions, ball, centers,
};
use taut_points::{Distribution, InputError, Points, generate};

use crate::common::least_of_partitions;

fn seeded(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(53), failure_persistence: None, ..Config::default() }
}

/// Rows of which the last column is the group.
#[derive(Clone, Debug)]
struct Groups {
    rows: Vec<Vec<f64>>,
}

impl Groups {
    fn columns(&self) -> usize {
        self.rows[0].len()
    }

    fn values(&self) -> Vec<f64> {
        self.rows.concat()
    }

    fn options(&self) -> CentersOptions<'static> {
        CentersOptions { epsilon: 1e-9, group: Some(self.columns() - 1), ..Default::default() }
    }

    /// The rows of each group, without its column.
    fn members(&self) -> Vec<Vec<&[f64]>> {
        let mut members: BTreeMap<u64, Vec<&[f64]>> = BTreeMap::new();
        for row in &self.rows {
            let (group, item) = row.split_last().unwrap();
            members.entry(group.to_bits()).or_default().push(item);
        }
        members.into_values().collect()
    }

    /// An answer that the checker accepts, to the gap that was asked for.
    fn found(&self, k: usize, options: &CentersOptions<'_>) -> Solution<Centers> {
        let values = self.values();
        let points = Points::new(&values, self.columns()).unwrap();
        let found = centers(&points, k, options).unwrap_or_else(|why| panic!("{why}: {self:?}"));
        let verdict = found
            .check(&points)
            .unwrap_or_else(|why| panic!("{why}\nk = {k}, {options:?}\n{self:?}\n{found:?}"));
        assert_eq!((verdict.lower, verdict.upper), (found.answer.lower_bound, found.answer.radius));
        found
    }

    fn radius(&self, k: usize, options: &CentersOptions<'_>) -> f64 {
        let found = self.found(k, options);
        let gap = found.certificate.gap;
        assert!(gap <= options.epsilon.max(2e-11), "gap {gap}, k = {k}\n{self:?}\n{found:?}");
        found.answer.radius
    }

    /// Changes the coordinates of each row.
    fn map(&self, change: impl Fn(&mut [f64])) -> Self {
        let mut changed = self.clone();
        for row in &mut changed.rows {
            let (_, item) = row.split_last_mut().unwrap();
            change(item);
        }
        changed
    }
}

/// The radius of the smallest ball of each set of groups, with its center anywhere: by another solver.
fn free_radii(groups: &Groups, items: Items) -> Vec<f64> {
    let members = groups.members();
    let chosen = |set: usize| (0..members.len()).filter(move |group| set >> group & 1 == 1);
    (0..1 << members.len())
        .map(|set| {
            let rows: Vec<f64> = chosen(set).flat_map(|group| members[group].concat()).collect();
            if rows.is_empty() {
                return 0.0;
            }
            let points = Points::new(&rows, groups.columns() - 1).unwrap();
            let options = BallOptions { epsilon: 1e-12, inputs: items, ..Default::default() };
            ball(&points, &options).unwrap().answer.radius
        })
        .collect()
}

/// The same with the center at a row of the input.
fn discrete_radii(groups: &Groups) -> Vec<f64> {
    let members = groups.members();
    let distance =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
    let reach = |group: usize, center: &[f64]| {
        members[group].iter().map(|row| distance(row, center)).fold(0.0, f64::max)
    };
    let places: Vec<&[f64]> = members.iter().flatten().copied().collect();
    (0..1usize << members.len())
        .map(|set| {
            let chosen = || (0..members.len()).filter(|group| set >> group & 1 == 1);
            let radius = |center: &&[f64]| chosen().map(|g| reach(g, center)).fold(0.0, f64::max);
            places.iter().map(radius).fold(f64::INFINITY, f64::min)
        })
        .collect()
}

fn is_near(found: f64, wanted: f64) -> bool {
    (found - wanted).abs() <= 3e-9 * wanted.abs()
}

/// Up to so many groups of one to four rows with small integers for ties, or reals, in one to three dimensions.
fn few_groups(most: usize, extra: bool) -> impl Strategy<Value = Groups> {
    (1usize..=3, 1..=most, any::<bool>(), 0.0f64..6.0).prop_flat_map(
        move |(dim, count, is_grid, spread)| {
            let columns = dim + usize::from(extra);
            let number = move || match is_grid {
                true => (-3i32..4).prop_map(f64::from).boxed(),
                false => (-1.0f64..1.0).boxed(),
            };
            let row = prop::collection::vec(number(), columns);
            let group =
                (prop::collection::vec(number(), columns), prop::collection::vec(row, 1..=4));
            prop::collection::vec(group, count).prop_map(move |groups| {
                let mut rows = vec![];
                for (number, (place, members)) in groups.into_iter().enumerate() {
                    for member in members {
                        let mut row: Vec<f64> = member
                            .iter()
                            .zip(&place)
                            .map(|(x, m)| x + (spread * m).round())
                            .collect();
                        if extra {
                            row[dim] = row[dim].abs() + 0.25;
                        }
                        // Groups are told apart by their numbers alone, whatever these are.
                        row.push(2.5 - number as f64);
                        rows.push(row);
                    }
                }
                // Rows of a group need not stand together.
                let step = 7;
                let count = rows.len();
                let order = (0..step).flat_map(|first| (first..count).step_by(step));
                Groups { rows: order.map(|at| rows[at].clone()).collect() }
            })
        },
    )
}

proptest! {
    #![proptest_config(seeded(60))]

    #[test]
    fn free_centers_are_those_of_the_best_partition(groups in few_groups(9, false)) {
        let one = free_radii(&groups, Items::Points);
        let count = groups.members().len();
        for k in 1..=3 {
            for z in 0..=2.min(count - 1) {
                let options = CentersOptions { outliers: z as u64, assignment: true, ..groups.options() };
                let (found, wanted) = (groups.radius(k, &options), least_of_partitions(&one, k, z));
                prop_assert!(is_near(found, wanted), "{found} {wanted}, k = {k}, z = {z}");
            }
        }
    }

    #[test]
    fn centers_at_rows_are_those_of_the_best_partition(groups in few_groups(7, false)) {
        let one = discrete_radii(&groups);
        let count = groups.members().len();
        for k in 1..=3 {
            for z in 0..=1.min(count - 1) {
                let options = CentersOptions {
                    outliers: z as u64, assignment: true, placement: Placement::Rows, ..groups.options()
                };
                let (found, wanted) = (groups.radius(k, &options), least_of_partitions(&one, k, z));
                prop_assert!(is_near(found, wanted), "{found} {wanted}, k = {k}, z = {z}");
            }
        }
    }

    #[test]
    fn groups_of_balls_are_held_whole(groups in few_groups(6, true)) {
        let one = free_radii(&groups, Items::Balls);
        for k in 1..=3 {
            let options = CentersOptions { inputs: Items::Balls, assignment: true, ..groups.options() };
            let (found, wanted) = (groups.radius(k, &options), least_of_partitions(&one, k, 0));
            prop_assert!(is_near(found, wanted), "{found} {wanted}, k = {k}");
        }
    }

    /// Weights have no other judge here than the checker, at both placements and with a group left out.
    #[test]
    fn groups_of_weighted_points_are_confirmed(groups in few_groups(6, true), k in 1usize..4) {
        for placement in [Placement::Free, Placement::Rows] {
            for outliers in 0..=1.min(groups.members().len() as u64 - 1) {
                let options = CentersOptions {
                    weights: true, placement, outliers, assignment: true, ..groups.options()
                };
                groups.radius(k, &options);
            }
        }
    }

    /// Rows of one each are points, to the last bit, and so are groups that no two rows share; but where points of the plane are left
    /// out, proofs of points ask what the balls avoid.
    #[test]
    fn groups_of_one_row_are_points(groups in few_groups(9, false), k in 1usize..5, z in 0u64..3) {
        let mut single = groups.clone();
        single.rows.iter_mut().enumerate().for_each(|(at, row)| *row.last_mut().unwrap() = at as f64);
        let items: Vec<f64> = single.rows.iter().flat_map(|row| &row[..row.len() - 1]).copied().collect();
        let points = Points::new(&items, groups.columns() - 1).unwrap();
        for placement in [Placement::Free, Placement::Rows] {
            let outliers = z.min(single.rows.len() as u64 - 1);
            let options = CentersOptions { placement, outliers, assignment: true, ..single.options() };
            let found = single.found(k, &options);
            let wanted = centers(&points, k, &CentersOptions { group: None, ..options }).unwrap();
            if outliers > 0 && points.dim() == 2 && placement == Placement::Free {
                let (found, wanted) = (found.answer.radius, wanted.answer.radius);
                prop_assert!(is_near(found, wanted), "{found} {wanted}");
                continue;
            }
            prop_assert_eq!(&found.answer, &wanted.answer);
            prop_assert_eq!(&found.certificate.core_set, &wanted.certificate.core_set);
            prop_assert_eq!(&found.certificate.proof, &wanted.certificate.proof);
            prop_assert_eq!(found.certificate.gap, wanted.certificate.gap);
        }
    }

    /// One group of all rows has the smallest ball, whatever k is.
    #[test]
    fn one_group_has_the_smallest_ball(groups in few_groups(9, false), k in 1usize..4) {
        let mut one = groups.clone();
        one.rows.iter_mut().for_each(|row| *row.last_mut().unwrap() = 1.0);
        let wanted = *free_radii(&one, Items::Points).last().unwrap();
        prop_assert!(is_near(one.radius(k, &one.options()), wanted));
    }

    /// Turned, scaled, permuted, with rows repeated inside their groups, with copies of groups.
    #[test]
    fn the_radius_is_that_of_the_shape(groups in few_groups(8, false), k in 1usize..4) {
        let wanted = groups.radius(k, &groups.options());
        let same = |other: &Groups, factor: f64, what: &str| {
            let found = other.radius(k, &other.options());
            assert!((found / factor - wanted).abs() <= 4e-9 * wanted.abs() + 1e-12, "{what}: {found} {wanted}");
        };
        let (sin, cos) = 0.7f64.sin_cos();
        same(&groups.map(|item| if let [x, y, ..] = item {
            (*x, *y) = (cos * *x - sin * *y, sin * *x + cos * *y);
        }), 1.0, "turned");
        same(&groups.map(|item| item.iter_mut().for_each(|x| *x *= 0.125)), 0.125, "scaled");
        let mut other = groups.clone();
        other.rows.reverse();
        same(&other, 1.0, "permuted");
        other.rows.extend(groups.rows.iter().step_by(2).cloned());
        same(&other, 1.0, "repeated");
        let copies: Vec<Vec<f64>> = groups.rows.iter().map(|row| {
            let mut copy = row.clone();
            *copy.last_mut().unwrap() += 100.0;
            copy
        }).collect();
        other.rows.extend(copies);
        same(&other, 1.0, "copied");
    }

    /// More centers and fewer rows in a group are never worse; the first centers of a traversal are at most twice as bad.
    #[test]
    fn the_radius_falls(groups in few_groups(9, false)) {
        let radius = |k| groups.radius(k, &groups.options());
        let radii: Vec<f64> = (1..5).map(radius).collect();
        prop_assert!(radii.windows(2).all(|pair| pair[1] <= pair[0] * (1.0 + 2e-9)), "{radii:?}");
        let mut fewer = groups.clone();
        fewer.rows.pop();
        if !fewer.rows.is_empty() {
            prop_assert!(fewer.radius(2, &fewer.options()) <= radii[1] * (1.0 + 2e-9) + 1e-12);
        }
        for placement in [Placement::Free, Placement::Rows] {
            let options = CentersOptions { placement, ..groups.options() };
            let least = groups.radius(2, &options);
            let traversal = CentersOptions { method: CentersMethod::FarthestFirst, ..options };
            let found = groups.found(2, &traversal).answer;
            prop_assert!(found.radius <= 2.0 * least * (1.0 + 1e-9));
            prop_assert!(found.lower_bound <= least);
        }
    }
}

/// Polygons around places of a grid, more than one block of rows has.
fn polygons(count: usize, corners: usize) -> Groups {
    let rows = (0..count * corners).map(|at| {
        let (group, corner) = (at % count, at / count);
        let (angle, size) = (corner as f64 * 2.4, 0.2 + (group * 7 % 11) as f64 * 0.03);
        let place = [(group * 37 % 101) as f64 * 0.2, (group * 53 % 89) as f64 * 0.2];
        vec![place[0] + size * angle.cos(), place[1] + size * angle.sin(), group as f64]
    });
    Groups { rows: rows.collect() }
}

#[test]
fn threads_and_the_place_of_the_column_decide_nothing() {
    let groups = polygons(300, 5);
    let values = groups.values();
    let points = Points::new(&values, 3).unwrap();
    let first: Vec<f64> = groups.rows.iter().flat_map(|row| [row[2], row[0], row[1]]).collect();
    for placement in [Placement::Free, Placement::Rows] {
        for outliers in [0, 2] {
            let options = CentersOptions {
                epsilon: 0.02,
                placement,
                outliers,
                assignment: true,
                ..groups.options()
            };
            let wanted = groups.found(4, &options);
            assert_eq!(wanted.trace.stop, Stop::Converged);
            for threads in [1, 2, 8] {
                let options = CentersOptions { threads: Some(threads), ..options };
                assert_eq!(centers(&points, 4, &options).unwrap(), wanted, "{threads} threads");
            }
            let other = Points::new(&first, 3).unwrap();
            let found = centers(&other, 4, &CentersOptions { group: Some(0), ..options }).unwrap();
            assert_eq!(found.answer, wanted.answer);
            found.check(&other).unwrap();
            for row in 0..300 {
                let of_group = (0..5).map(|corner| wanted.answer.assignment[row + 300 * corner]);
                assert_eq!(of_group.collect::<std::collections::BTreeSet<u32>>().len(), 1);
            }
        }
    }
}

#[test]
fn a_group_counts_with_all_its_rows_and_is_left_out_whole() {
    // Two short segments, and a long one that no ball of their size holds.
    let rows = [[0.0, 0.0, 7.0], [0.0, 2.0, 7.0], [9.0, 0.0, 8.0], [9.0, 2.0, 8.0]];
    let long = [[0.0, 1.0, 9.0], [9.0, 1.0, 9.0]];
    let groups = Groups { rows: rows.iter().chain(&long).map(|row| row.to_vec()).collect() };
    assert!(is_near(groups.radius(2, &groups.options()), 41.0 / 9.0));
    assert!(is_near(groups.radius(3, &groups.options()), 4.5));
    let found = groups.found(2, &CentersOptions { outliers: 1, ..groups.options() });
    assert_eq!(found.answer.radius, 1.0);
    assert_eq!(found.answer.outliers, [4, 5]);
}

#[test]
fn the_ends_of_the_range_are_solved() {
    let shape = polygons(8, 3);
    let wanted = shape.radius(2, &shape.options());
    for exponent in [-1000, -990, 900, 1000] {
        let factor = 2f64.powi(exponent);
        let scaled = shape.map(|item| item.iter_mut().for_each(|x| *x *= factor));
        let found = scaled.radius(2, &scaled.options());
        assert!((found / factor - wanted).abs() <= 4e-9 * wanted, "2^{exponent}");
    }
    for factor in [1e300, 1e-300] {
        let scaled = shape.map(|item| item.iter_mut().for_each(|x| *x *= factor));
        for placement in [Placement::Free, Placement::Rows] {
            scaled.found(2, &CentersOptions { placement, ..scaled.options() });
        }
    }
    // All of one place, in groups of two; more centers than groups; ±0 are one group.
    let copies = Groups { rows: (0..6).map(|at| vec![3.0, 4.0, f64::from(at / 2)]).collect() };
    assert_eq!(copies.radius(2, &copies.options()), 0.0);
    assert_eq!(shape.found(20, &shape.options()).answer.centers.len(), 8);
    let zeros = Groups { rows: vec![vec![0.0, 0.0], vec![6.0, -0.0]] };
    assert_eq!(zeros.radius(2, &zeros.options()), 3.0);
}

#[test]
fn wrong_input_is_named() {
    let option = |values: &[f64], columns: usize, options: CentersOptions<'_>| match centers(
        &Points::new(values, columns).unwrap(),
        1,
        &options,
    ) {
        Err(Error::Input(InputError::Option { name, .. })) => name,
        other => panic!("{other:?}"),
    };
    let rows = [0.0, 1.0, 2.0, 3.0, 4.0, 2.0];
    let grouped = CentersOptions { group: Some(2), ..Default::default() };
    assert_eq!(option(&rows, 3, CentersOptions { group: Some(3), ..grouped }), "group");
    assert_eq!(option(&rows, 1, CentersOptions { group: Some(0), ..grouped }), "group");
    // One group is all there is.
    assert_eq!(option(&rows, 3, CentersOptions { outliers: 1, ..grouped }), "outliers");
    let stream = CentersMethod::Stream(StreamingOptions::DEFAULT);
    for method in [CentersMethod::Thesis, stream] {
        assert_eq!(option(&rows, 3, CentersOptions { method, ..grouped }), "group");
    }
    let points = [0.0, 1.0, 2.0, 3.0, 4.0, f64::NAN];
    assert!(matches!(
        centers(&Points::new(&points, 3).unwrap(), 1, &grouped),
        Err(Error::Input(InputError::NonFinite { row: 1, column: 2, .. }))
    ));
    let balls = CentersOptions { inputs: Items::Balls, ..grouped };
    assert!(matches!(
        centers(&Points::new(&rows, 2).unwrap(), 1, &CentersOptions { group: Some(1), ..balls }),
        Err(Error::NoRadius { columns: 1 })
    ));
}

/// With every row its own group, proofs are of groups all the same: no ball need avoid what is left out, and no nogoods are taken.
#[test]
fn proofs_of_single_rows_are_those_of_groups() {
    let places = [
        [0, 0],
        [-1, 3],
        [0, 0],
        [0, -2],
        [2, -1],
        [3, 0],
        [-2, 2],
        [-2, -2],
        [0, 0],
        [-2, 0],
        [1, 2],
    ];
    let many: Vec<f64> = generate(Distribution::Uniform, 1000, 2, 6).unwrap();
    for (places, k, outliers, epsilon) in [
        (&places.map(|place| place.map(f64::from))[..], 1, 2, 1e-9),
        (many.as_chunks::<2>().0, 13, 0, 0.01),
    ] {
        let row = |(at, [x, y]): (u32, &[f64; 2])| vec![*x, *y, f64::from(at)];
        let single = Groups { rows: (0..).zip(places).map(row).collect() };
        let options = CentersOptions { outliers, epsilon, ..single.options() };
        let found = single.found(k, &options);
        assert!(found.certificate.gap <= epsilon, "{}", found.certificate.gap);
        assert!(matches!(found.certificate.proof, LowerBound::Branches { .. }));
        // Of points alone these are others.
        let points = Points::new(places.as_flattened(), 2).unwrap();
        let plain = centers(&points, k, &CentersOptions { group: None, ..options }).unwrap();
        assert!(!matches!(plain.certificate.proof, LowerBound::Branches { .. }));
        let (found, plain) = (found.answer.radius, plain.answer.radius);
        assert!((found - plain).abs() <= epsilon * plain, "{found} {plain}");
    }
}

/// Found by other seeds than those of the properties.
#[test]
fn a_few_groups_on_a_line_are_proved() {
    let rows = [
        [7.0, 2.5],
        [0.0, -0.5],
        [-9.0, -2.5],
        [7.0, 2.5],
        [1.0, -0.5],
        [7.0, 2.5],
        [-3.0, -0.5],
        [-13.0, 1.5],
        [0.0, -1.5],
        [0.0, 0.5],
        [0.0, -1.5],
        [-2.0, 0.5],
        [0.0, -1.5],
        [3.0, 0.5],
        [0.0, -1.5],
    ];
    let groups = Groups { rows: rows.map(Vec::from).to_vec() };
    let options = CentersOptions { outliers: 1, assignment: true, ..groups.options() };
    assert!(is_near(groups.radius(2, &options), 3.0));
}
