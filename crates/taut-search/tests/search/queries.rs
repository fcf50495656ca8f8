//! Queries of points and balls against brute force, on sets that are random, clustered, tied, equal, collinear or single.

use std::cmp::Ordering;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use taut_certify::Items;
use taut_points::{Distribution, InputError, Points, generate};
use taut_search::{Error, Neighbor, QueryOptions, RowPair, SphereSearch, SphereSearchOptions};

const QUERY: QueryOptions<'static> =
    QueryOptions { threads: None, monitor: taut_points::Monitor::silent() };

fn points(values: &[f64], dim: usize) -> Points<'_, f64> {
    Points::new(values, dim).unwrap()
}

fn tree(values: &[f64], columns: usize, inputs: Items) -> SphereSearch {
    let options = SphereSearchOptions { inputs, ..Default::default() };
    SphereSearch::new(&points(values, columns), &options).unwrap()
}

/// Points, or balls with the radius last.
#[derive(Clone, Debug)]
struct Set {
    values: Vec<f64>,
    columns: usize,
    inputs: Items,
}

impl Set {
    fn points(values: Vec<f64>, dim: usize) -> Self {
        Set { values, columns: dim, inputs: Items::Points }
    }

    fn balls(values: Vec<f64>, dim: usize) -> Self {
        let mut set = Set { values, columns: dim + 1, inputs: Items::Balls };
        set.values.chunks_exact_mut(dim + 1).for_each(|ball| ball[dim] = ball[dim].abs());
        set
    }

    fn dim(&self) -> usize {
        self.columns - usize::from(self.inputs == Items::Balls)
    }

    fn rows(&self) -> impl Iterator<Item = (&[f64], f64)> {
        let dim = self.dim();
        let radius = move |row: &[f64]| row.get(dim).copied().unwrap_or(0.0);
        self.values.chunks_exact(self.columns).map(move |row| (&row[..dim], radius(row)))
    }

    fn tree(&self) -> SphereSearch {
        tree(&self.values, self.columns, self.inputs)
    }

    /// What rows are ordered by: squares for points, as their roots can be equal where they are not; of balls distances with
    /// their radii.
    fn key(&self, square: f64, radius: f64) -> f64 {
        if self.inputs == Items::Points { square } else { square.sqrt() + radius }
    }

    /// All rows from the nearest to a place on, or from the farthest on.
    fn from(&self, place: &[f64], is_far: bool) -> Vec<Neighbor> {
        let sign = if is_far { -1.0 } else { 1.0 };
        let mut found: Vec<(f64, Neighbor)> = vec![];
        for (row, (center, radius)) in self.rows().enumerate() {
            let square = square(place, center);
            let key = sign * self.key(square, -sign * radius);
            let distance = square.sqrt() - sign * radius;
            found.push((key, Neighbor { row: row as u64, distance }));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.row.cmp(&b.1.row)));
        found.into_iter().map(|(_, found)| found).collect()
    }
}

fn by_distance_and_row(a: &Neighbor, b: &Neighbor) -> Ordering {
    a.distance.total_cmp(&b.distance).then(a.row.cmp(&b.row))
}

/// As it is calculated in the tree: the sum of squares, axis by axis.
fn square(p: &[f64], q: &[f64]) -> f64 {
    p.iter().zip(q).map(|(x, y)| (x - y) * (x - y)).fold(0.0, |sum, square| sum + square)
}

fn distance(p: &[f64], q: &[f64]) -> f64 {
    square(p, q).sqrt()
}

/// All pairs within a distance of each other, sorted.
fn pairs_within(first: &Set, second: Option<&Set>, most: f64) -> Vec<RowPair> {
    let mut pairs = vec![];
    for (i, (p, r)) in first.rows().enumerate() {
        for (j, (q, s)) in second.unwrap_or(first).rows().enumerate() {
            let distance = distance(p, q) - (r + s);
            if (second.is_some() || i < j) && distance <= most {
                pairs.push(RowPair { rows: [i as u64, j as u64], distance });
            }
        }
    }
    pairs
}

/// Compares all queries of a set with brute force.
fn agrees(set: &Set, places: &[f64]) {
    let (tree, dim) = (set.tree(), set.dim());
    let queries = points(places, dim);
    let nearest = tree.nearest(&queries, &QUERY).unwrap();
    let farthest = tree.farthest(&queries, 0.0, &QUERY).unwrap();
    let near_enough = tree.farthest(&queries, 0.25, &QUERY).unwrap();
    for (i, place) in queries.rows().enumerate() {
        let wanted = set.from(place, false);
        assert_eq!(nearest[i], wanted[0]);
        assert_eq!(tree.nearest_to(place), Some(wanted[0]));
        assert_eq!(farthest[i], set.from(place, true)[0]);
        assert!(near_enough[i].distance * 1.25 >= farthest[i].distance);
    }
    let wanted = |place: &[f64]| set.from(place, false);
    for k in [1, 2, 7, set.rows().count() + 1] {
        for (place, found) in queries.rows().zip(tree.nearest_k(&queries, k, &QUERY).unwrap()) {
            assert_eq!(found, wanted(place).into_iter().take(k).collect::<Vec<_>>());
        }
    }
    // A distance that some row has exactly: the border counts.
    let border = wanted(queries.row(0))[set.rows().count() / 2].distance;
    for radius in [border, border.next_down(), 0.0, -1.0, f64::INFINITY] {
        for (place, found) in queries.rows().zip(tree.within(&queries, radius, &QUERY).unwrap()) {
            let wanted = wanted(place).into_iter().take_while(|found| found.distance <= radius);
            assert_eq!(found, wanted.collect::<Vec<_>>(), "within {radius}");
        }
    }
}

/// Compares what is asked of sets alone with brute force.
fn agrees_on_pairs(set: &Set, other: &Set) {
    let (tree, second) = (set.tree(), other.tree());
    let all = pairs_within(set, None, f64::INFINITY);
    let border = all.get(all.len() / 3).map_or(0.0, |pair| pair.distance);
    for most in [border, border.next_down(), 0.0, f64::INFINITY] {
        assert_eq!(tree.pairs(most, &QUERY).unwrap(), pairs_within(set, None, most));
        let between = tree.pairs_with(&second, most, &QUERY).unwrap();
        assert_eq!(between, pairs_within(set, Some(other), most));
    }
    let rows: Vec<(&[f64], f64)> = set.rows().collect();
    let mut best = (f64::NEG_INFINITY, 0.0, [0; 2]);
    for (i, (p, r)) in rows.iter().enumerate() {
        for (j, (q, s)) in rows.iter().enumerate().skip(i) {
            let key = set.key(square(p, q), r + s);
            if key > best.0 {
                best = (key, distance(p, q) + (r + s), [i as u64, j as u64]);
            }
        }
    }
    let best = (best.1, best.2);
    let found = tree.diameter(0.0, &QUERY).unwrap();
    assert_eq!((found.distance, found.rows), best);
    assert_eq!(found.upper_bound, found.distance);
    let found = tree.diameter(0.1, &QUERY).unwrap();
    assert!(found.distance <= best.0 && best.0 <= found.upper_bound);
    assert!(found.upper_bound <= 1.1 * found.distance * (1.0 + 1e-15));
}

/// Numbers with ties, of one size, or of many sizes.
fn numbers(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<f64>> {
    prop_oneof![
        vec(-1.0..1.0f64, count.clone()),
        vec((-2..3i32).prop_map(f64::from), count.clone()),
        vec((-90..90i32, -3..4i32).prop_map(|(e, m)| f64::from(m) * 2f64.powi(e)), count),
    ]
}

proptest! {
    #![proptest_config(Config {
        cases: 60,
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..Config::default()
    })]

    #[test]
    fn points_as_by_brute_force(dim in 1usize..=10, values in numbers(12..600), places in numbers(10..60)) {
        let set = Set::points(values[..values.len() / dim * dim].to_vec(), dim);
        agrees(&set, &places[..places.len() / dim * dim]);
        let other = Set::points(places[..places.len() / dim * dim].to_vec(), dim);
        agrees_on_pairs(&set, &other);
    }

    #[test]
    fn balls_as_by_brute_force(dim in 1usize..=4, values in numbers(12..400), places in numbers(10..60)) {
        let set = Set::balls(values[..values.len() / (dim + 1) * (dim + 1)].to_vec(), dim);
        agrees(&set, &places[..places.len() / dim * dim]);
        let other = Set::points(places[..places.len() / dim * dim].to_vec(), dim);
        agrees_on_pairs(&set, &other);
        agrees_on_pairs(&other, &set);
    }

    /// Sums of integers are exact, so that hits can be told without rounding.
    #[test]
    fn rays_along_axes_meet_what_they_should(
        centers in vec((-9..10i32, -9..10i32, 0..4i32), 1..120),
        origin in (-12..13i32, -12..13i32),
        axis in 0usize..2,
        forward in any::<bool>(),
    ) {
        let values = centers.iter().flat_map(|&(x, y, r)| [x, y, r].map(f64::from)).collect();
        let set = Set::balls(values, 2);
        let step = if forward { 1.0 } else { -1.0 };
        let mut ray = [f64::from(origin.0), f64::from(origin.1), 0.0, 0.0];
        ray[2 + axis] = 3.0 * step;
        let entry = |(center, radius): (&[f64], f64)| {
            let along = (center[axis] - ray[axis]) * step;
            let away = center[1 - axis] - ray[1 - axis];
            let half = (radius * radius - away * away).sqrt();
            // NaN where the line misses.
            (along + half >= 0.0).then_some((along - half).max(0.0))
        };
        let hits = set.rows().map(entry).enumerate();
        let hits = hits.filter_map(|(row, hit)| Some(Neighbor { row: row as u64, distance: hit? }));
        let mut wanted: Vec<Neighbor> = hits.collect();
        wanted.sort_by(by_distance_and_row);
        let tree = set.tree();
        let found = tree.hits(&points(&ray, 4), 0.0, &QUERY).unwrap().remove(0);
        prop_assert_eq!(&found, &wanted);
        let first = tree.first_hits(&points(&ray, 4), 0.0, &QUERY).unwrap()[0];
        prop_assert_eq!(first, wanted.first().copied());
    }
}

#[test]
fn clusters_grids_lines_and_copies() {
    let clusters: Vec<f64> =
        generate(Distribution::Clusters { count: 5, spread: 0.05 }, 3000, 3, 4).unwrap();
    let places: Vec<f64> = generate(Distribution::Normal, 30, 3, 5).unwrap();
    agrees(&Set::points(clusters.clone(), 3), &places);
    agrees_on_pairs(&Set::points(clusters[..900].to_vec(), 3), &Set::points(places.clone(), 3));
    let grid: Vec<f64> =
        (0..1000).flat_map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from)).collect();
    let between = [4.5, 4.5, 4.5, 0.0, 0.0, 0.0, 4.0, 4.5, 30.0];
    agrees(&Set::points(grid.clone(), 3), &between);
    agrees_on_pairs(&Set::points(grid, 3), &Set::points(between.to_vec(), 3));
    let line: Vec<f64> = (0..500).flat_map(|i| [0.5, f64::from(i / 7), 0.5]).collect();
    agrees(&Set::points(line.clone(), 3), &[0.5, 3.0, 0.5, 0.5, 3.5, 0.5, 7.0, 3.5, 0.5]);
    agrees_on_pairs(&Set::points(line, 3), &Set::points(places, 3));
    for n in [1, 2, 15, 16, 17, 129] {
        let copies = Set::points([1.0, 2.0].repeat(n), 2);
        agrees(&copies, &[1.0, 2.0, 0.0, 0.0]);
        agrees_on_pairs(&copies, &copies);
    }
}

/// Of many copies the lowest row is found without a look at all of them, and so is their diameter.
/// Rows are divided along the first 256 axes alone.
#[test]
fn many_axes_of_which_the_last_is_the_widest() {
    for dim in [255, 256, 257, 300] {
        let mut values: Vec<f64> = generate(Distribution::Uniform, 220, dim, 3).unwrap();
        for (row, values) in values.chunks_exact_mut(dim).enumerate() {
            values[dim - 1] *= 1000.0;
            if row % 3 == 0 {
                values[..dim - 1].fill(0.5);
            }
        }
        let places: Vec<f64> = values[..20 * dim].iter().map(|x| x + 0.25).collect();
        agrees(&Set::points(values, dim), &places);
    }
}

/// Squares need an exponent of their own there, and the radii of balls come off their roots.
#[test]
fn pairs_of_balls_of_all_sizes() {
    let mut values: Vec<f64> = generate(Distribution::Uniform, 300, 4, 4).unwrap();
    for (row, ball) in values.chunks_exact_mut(4).enumerate() {
        let size = [1.0, 1e-130, 1e151, 1e-120][row % 4];
        ball.iter_mut().for_each(|x| *x *= size);
        ball[3] *= 0.3;
    }
    let set = Set::balls(values, 3);
    agrees_on_pairs(&set, &Set::points(vec![0.0, 0.1, 0.2, 1e151, 0.0, 0.0], 3));
}

#[test]
fn copies_are_no_trap() {
    let copies = tree(&[3.0; 200_000], 2, Items::Points);
    let places = [3.0; 2000];
    let found = copies.nearest(&points(&places, 2), &QUERY).unwrap();
    assert!(found.iter().all(|found| *found == Neighbor { row: 0, distance: 0.0 }));
    let found = copies.nearest_k(&points(&places, 2), 3, &QUERY).unwrap();
    assert!(found.iter().all(|found| found.iter().map(|f| f.row).eq(0..3)));
    assert_eq!(copies.diameter(0.0, &QUERY).unwrap().rows, [0, 0]);
    let far = copies.farthest(&points(&places, 2), 0.0, &QUERY).unwrap();
    assert!(far.iter().all(|found| found.row == 0));
}

/// In directions that are no axes: against the same formula over all rows, at distances that rounding does not blur.
#[test]
fn rays_in_space() {
    let centers: Vec<f64> = generate(Distribution::Uniform, 4000, 3, 8).unwrap();
    let rays: Vec<f64> = generate(Distribution::Normal, 300, 6, 9).unwrap();
    let set = Set::points(centers, 3);
    let (tree, queries, radius) = (set.tree(), points(&rays, 6), 0.02);
    let all = tree.hits(&queries, radius, &QUERY).unwrap();
    let first = tree.first_hits(&queries, radius, &QUERY).unwrap();
    let mut hits = 0;
    for (i, ray) in queries.rows().enumerate() {
        let norm = distance(&ray[3..], &[0.0; 3]);
        let wanted = set.rows().enumerate().filter(|(_, (center, _))| {
            let along: f64 = (0..3).map(|j| (center[j] - ray[j]) * ray[3 + j] / norm).sum();
            let nearest: Vec<f64> =
                (0..3).map(|j| ray[j] + along.max(0.0) * ray[3 + j] / norm).collect();
            distance(&nearest, center) <= radius
        });
        let mut rows: Vec<u64> = all[i].iter().map(|hit| hit.row).collect();
        rows.sort_unstable();
        assert!(rows.iter().copied().eq(wanted.map(|(row, _)| row as u64)), "ray {i}");
        assert!(all[i].is_sorted_by(|a, b| by_distance_and_row(a, b).is_lt()));
        assert_eq!(first[i], all[i].first().copied());
        hits += rows.len();
    }
    assert!(hits > 100, "{hits}");
}

/// Shifted by a power of two, scaled by one, and with rows in another order, a set has the same neighbors.
#[test]
fn moved_scaled_and_permuted() {
    let values: Vec<f64> = generate(Distribution::Uniform, 2000, 3, 1).unwrap();
    let places: Vec<f64> = generate(Distribution::Uniform, 200, 3, 2).unwrap();
    let own = tree(&values, 3, Items::Points).nearest(&points(&places, 3), &QUERY).unwrap();
    for scale in [2f64.powi(-30), 2f64.powi(-600), 2f64.powi(900)] {
        let scaled = |values: &[f64]| values.iter().map(|x| x * scale).collect::<Vec<_>>();
        let found = tree(&scaled(&values), 3, Items::Points)
            .nearest(&points(&scaled(&places), 3), &QUERY)
            .unwrap();
        for (own, found) in own.iter().zip(&found) {
            assert_eq!((own.row, own.distance * scale), (found.row, found.distance));
        }
    }
    let backwards: Vec<f64> = values.chunks_exact(3).rev().flatten().copied().collect();
    let found = tree(&backwards, 3, Items::Points).nearest(&points(&places, 3), &QUERY).unwrap();
    assert!(own.iter().zip(&found).all(|(a, b)| a.row == 1999 - b.row && a.distance == b.distance));
}

#[test]
fn threads_change_nothing() {
    let values: Vec<f32> = generate(Distribution::Uniform, 30_000, 3, 9).unwrap();
    let rows = Points::new(&values, 3).unwrap();
    let with = |threads| {
        let threads = Some(threads);
        let tree = SphereSearch::new(&rows, &SphereSearchOptions { threads, ..Default::default() });
        let (tree, options) = (tree.unwrap(), QueryOptions { threads, ..QUERY });
        let near = tree.nearest_k(&rows, 3, &options).unwrap();
        let pairs = tree.pairs(0.01, &options).unwrap();
        let far = tree.farthest(&rows.slice(0..500), 0.1, &options).unwrap();
        let diameter = tree.diameter(0.01, &options).unwrap();
        (tree, near, pairs, far, diameter)
    };
    let wanted = with(1);
    assert!(wanted.2.len() > 100);
    assert!(wanted == with(2) && wanted == with(8));
}

#[test]
fn what_is_no_input_is_named() {
    let values = [0.0, 1.0, 2.0, f64::INFINITY];
    let new = |values: &[f64], columns: usize, inputs: Items| {
        let options = SphereSearchOptions { inputs, ..Default::default() };
        SphereSearch::new(&points(values, columns), &options).unwrap_err()
    };
    let wrong = new(&values, 2, Items::Points);
    assert!(matches!(wrong, Error::Input(InputError::NonFinite { row: 1, column: 1, .. })));
    assert!(matches!(new(&values[..0], 1, Items::Points), Error::Empty));
    assert!(matches!(new(&values[..3], 1, Items::Balls), Error::NoRadius { columns: 1 }));
    let wrong = new(&[0.0, 1.0, 0.0, -1.0], 2, Items::Balls);
    assert!(matches!(wrong, Error::NegativeRadius { row: 1, .. }));
    let wrong = new(&values[..2], 2, Items::Ellipsoids);
    assert!(matches!(wrong, Error::Input(InputError::Option { name: "inputs", .. })));

    let tree = tree(&[0.0, 1.0, 2.0, 3.0], 2, Items::Points);
    let nan = [0.0, 0.0, f64::NAN, 0.0];
    let refused = tree.nearest(&points(&nan, 2), &QUERY).unwrap_err();
    assert!(matches!(refused, Error::Input(InputError::NonFinite { row: 1, column: 0, .. })));
    assert_eq!(tree.nearest_to(&[0.0, f64::NAN]), None);
    assert_eq!(tree.nearest_to(&[0.0]), None);
    let refused = tree.farthest(&points(&[0.0; 3], 3), 0.0, &QUERY).unwrap_err();
    assert!(matches!(refused, Error::Input(InputError::Dimension { dim: 3, .. })));
    let refused = tree.hits(&points(&[0.0, 0.0, 0.0, 0.0], 4), 0.0, &QUERY).unwrap_err();
    assert!(matches!(refused, Error::NoDirection { row: 0 }));
    let option = |error: Error| match error {
        Error::Input(InputError::Option { name, .. }) => name,
        other => panic!("{other}"),
    };
    let place = points(&[0.0; 2], 2);
    assert_eq!(option(tree.nearest_k(&place, 0, &QUERY).unwrap_err()), "k");
    assert_eq!(option(tree.within(&place, f64::NAN, &QUERY).unwrap_err()), "radius");
    assert_eq!(option(tree.farthest(&place, -0.1, &QUERY).unwrap_err()), "epsilon");
    assert_eq!(option(tree.diameter(f64::INFINITY, &QUERY).unwrap_err()), "epsilon");
    assert_eq!(option(tree.pairs(f64::NAN, &QUERY).unwrap_err()), "distance");
    let ray = points(&[0.0, 0.0, 1.0, 0.0], 4);
    assert_eq!(option(tree.hits(&ray, -1.0, &QUERY).unwrap_err()), "hit_radius");
    let threads = QueryOptions { threads: Some(0), ..QUERY };
    assert_eq!(option(tree.nearest(&place, &threads).unwrap_err()), "threads");
    assert!(tree.nearest(&points(&[], 2), &QUERY).unwrap().is_empty());
}

#[test]
fn balls_that_touch_as_calculated_are_pairs_whatever_the_order_of_roundings() {
    let lots = generate::<f64>(Distribution::Uniform, 2000, 2, 11).unwrap();
    for radii in lots.as_chunks::<2>().0 {
        let [first, second] = *radii;
        let distance = first + second;
        let alone = |x: f64, radius: f64| tree(&[x, 0.0, radius], 3, Items::Balls);
        let wanted = [RowPair { rows: [0, 0], distance: 0.0 }];
        let (a, b) = (alone(0.0, first), alone(distance, second));
        assert_eq!(a.pairs_with(&b, 0.0, &QUERY).unwrap(), wanted, "{radii:?}");
        assert_eq!(b.pairs_with(&a, 0.0, &QUERY).unwrap(), wanted, "{radii:?}");
        let both = tree(&[0.0, 0.0, first, distance, 0.0, second], 3, Items::Balls);
        assert_eq!(both.pairs(0.0, &QUERY).unwrap()[0].rows, [0, 1], "{radii:?}");
    }
}
