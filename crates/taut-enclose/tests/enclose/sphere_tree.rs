//! The tree of balls: every point in every ball on its way, and nothing lost.

use covering::distance;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use taut_certify::Ball;
use taut_enclose::{BallOptions, Error, SphereTree, SphereTreeOptions, ball, sphere_tree};
use taut_points::{Distribution, InputError, Points, generate};

use crate::covering;

fn tree(values: &[f64], dim: usize, leaf_size: usize) -> SphereTree {
    let points = Points::new(values, dim).unwrap();
    let tree = sphere_tree(&points, &SphereTreeOptions { leaf_size, ..Default::default() });
    tree.unwrap()
}

/// The distance of a point to the center of a ball, which may be a sum of two numbers.
fn reach(point: &[f64], ball: &Ball) -> f64 {
    let tail = |j: usize| ball.center_tail.get(j).copied().unwrap_or(0.0);
    let less: Vec<f64> = (0..point.len()).map(|j| point[j] - ball.center[j] - tail(j)).collect();
    distance(&less, &vec![0.0; point.len()])
}

/// All that has to hold of a tree.
fn judge(tree: &SphereTree, values: &[f64], dim: usize, leaf_size: usize) {
    let points = Points::new(values, dim).unwrap();
    let mut rows = tree.order.clone();
    rows.sort_unstable();
    assert!(rows.iter().copied().eq(0..points.len() as u64), "every row is there once");
    assert_eq!(tree.nodes[0].range, 0..points.len());
    let mut parents = vec![0; tree.nodes.len()];
    for (i, node) in tree.nodes.iter().enumerate() {
        for &row in tree.rows(i) {
            let reach = reach(points.row(row as usize), &node.ball);
            assert!(reach <= node.ball.radius * (1.0 + 1e-15), "row {row} in node {i}");
        }
        match node.children {
            None => {
                let first = points.row(tree.rows(i)[0] as usize);
                let all_equal = || tree.rows(i).iter().all(|&r| points.row(r as usize) == first);
                assert!(node.range.len() <= leaf_size || all_equal());
            }
            Some([a, b]) => {
                assert!(node.range.len() > leaf_size && a > i && b > a);
                let (left, right) = (&tree.nodes[a], &tree.nodes[b]);
                assert!(!left.range.is_empty() && !right.range.is_empty());
                assert_eq!((left.range.start, right.range.end), (node.range.start, node.range.end));
                assert_eq!(left.range.end, right.range.start);
                for child in [left, right] {
                    assert!(child.ball.radius <= node.ball.radius * (1.0 + 1e-9));
                }
                parents[a] += 1;
                parents[b] += 1;
            }
        }
    }
    assert!(parents[1..].iter().all(|&count| count == 1) && parents[0] == 0);
}

proptest! {
    #![proptest_config(Config {
        cases: 150,
        rng_seed: RngSeed::Fixed(3),
        failure_persistence: None,
        ..Config::default()
    })]

    #[test]
    fn every_point_is_in_every_ball_on_its_way(
        dim in 1usize..=4,
        values in prop_oneof![
            vec(-1.0..1.0f64, 4..200),
            vec((-2..3i32).prop_map(f64::from), 4..200),
            vec((-300..300i32).prop_map(|e| 2f64.powi(e)), 4..80),
        ],
        leaf_size in 1usize..6,
    ) {
        let values = &values[..values.len() / dim * dim];
        judge(&tree(values, dim, leaf_size), values, dim, leaf_size);
    }
}

/// The ball of each node is the smallest of its points, and two clusters come apart at the root.
#[test]
fn balls_are_the_smallest_and_clusters_come_apart() {
    let mut values: Vec<f64> = generate(Distribution::Normal, 300, 3, 1).unwrap();
    values[450..].iter_mut().for_each(|v| *v += 100.0);
    let tree = tree(&values, 3, 4);
    judge(&tree, &values, 3, 4);
    let [a, b] = tree.nodes[0].children.unwrap();
    let (mut left, mut right) = (tree.rows(a).to_vec(), tree.rows(b).to_vec());
    left.sort_unstable();
    right.sort_unstable();
    if left[0] != 0 {
        std::mem::swap(&mut left, &mut right);
    }
    assert!(left.into_iter().eq(0..150) && right.into_iter().eq(150..300));
    for (i, node) in tree.nodes.iter().enumerate() {
        let subset: Vec<f64> =
            tree.rows(i).iter().flat_map(|&r| values[r as usize * 3..][..3].to_vec()).collect();
        let options = BallOptions { epsilon: 0.0, ..BallOptions::default() };
        let best = ball(&Points::new(&subset, 3).unwrap(), &options).unwrap().answer.radius;
        assert!(node.ball.radius <= best * (1.0 + 2e-9), "{} above {best}", node.ball.radius);
    }
    assert!(tree.depth() < 20, "{}", tree.depth());
}

/// The larger ball of the two sets in which a point and the one farthest from it part the points, the least and the largest
/// for the points on the smallest ball: any of these may be the first.
fn larger_of_the_farthest_pair(values: &[f64], dim: usize) -> [f64; 2] {
    let ball_of = |values: &[f64]| {
        let options = BallOptions { epsilon: 0.0, ..BallOptions::default() };
        ball(&Points::new(values, dim).unwrap(), &options).unwrap().answer
    };
    let (points, all) = (Points::new(values, dim).unwrap(), ball_of(values));
    let parted_from = |first: &[f64]| {
        let far = |a: &&[f64], b: &&[f64]| distance(a, first).total_cmp(&distance(b, first));
        let second = points.rows().max_by(far).unwrap();
        let (left, right): (Vec<&[f64]>, Vec<&[f64]>) =
            points.rows().partition(|row| distance(row, first) <= distance(row, second));
        ball_of(&left.concat()).radius.max(ball_of(&right.concat()).radius)
    };
    let firsts = points.rows().filter(|row| reach(row, &all) >= all.radius * (1.0 - 1e-6));
    firsts.map(parted_from).fold([f64::INFINITY, 0.0], |[a, b], r| [a.min(r), b.max(r)])
}

fn larger_child(tree: &SphereTree) -> f64 {
    let children = tree.nodes[0].children.unwrap();
    children.map(|child| tree.nodes[child].ball.radius).into_iter().fold(0.0, f64::max)
}

/// Whatever point comes first, centers that are moved make the larger ball of some sets smaller, and of none larger.
#[test]
fn the_split_is_improved_by_moving_the_centers() {
    let mut better = 0;
    for seed in 0..40 {
        let dim = 2 + seed as usize % 3;
        let values: Vec<f64> = generate(Distribution::Normal, 60, dim, seed).unwrap();
        let [least, largest] = larger_of_the_farthest_pair(&values, dim);
        let moved = larger_child(&tree(&values, dim, 4));
        // Centers are moved for balls that are within 1e-4 of the smallest.
        assert!(moved <= largest * (1.0 + 2e-4), "seed {seed}: {moved} against {largest}");
        better += usize::from(moved < 0.99 * least);
    }
    assert!(better >= 5, "{better} of 40");
}

#[test]
fn copies_are_one_leaf() {
    for n in [1, 2, 1000] {
        let tree = tree(&vec![1.5; 2 * n], 2, 1);
        assert_eq!((tree.nodes.len(), tree.depth()), (1, 1));
        assert_eq!((tree.nodes[0].ball.radius, tree.order.len()), (0.0, n));
    }
    let two = tree(&[0.0, 1.0, 0.0, 1.0, 0.0], 1, 1);
    assert_eq!(two.nodes.len(), 3);
    assert_eq!((two.rows(1), two.rows(2)), (&[0, 2, 4][..], &[1, 3][..]));
}

/// Sizes from one end of the numbers to the other in one tree, one level for each.
#[test]
fn points_that_pile_up() {
    let values: Vec<f64> = (-500..500).map(|e| 2f64.powi(e)).collect();
    let tree = tree(&values, 1, 1);
    judge(&tree, &values, 1, 1);
    assert!(tree.depth() > 100);
}

#[test]
fn sizes_of_all_kinds() {
    for size in [1e-300, 1e300] {
        let values: Vec<f64> = (0..200).map(|i| size * f64::from(i * i % 71) / 71.0).collect();
        let scaled = tree(&values, 2, 3);
        let back: Vec<f64> = values.iter().map(|v| v / size).collect();
        let points = Points::new(&back, 2).unwrap();
        for (i, node) in scaled.nodes.iter().enumerate() {
            let center: Vec<f64> = node.ball.center.iter().map(|c| c / size).collect();
            for &row in scaled.rows(i) {
                let reach = distance(points.row(row as usize), &center);
                assert!(reach <= node.ball.radius / size * (1.0 + 1e-14));
            }
        }
        assert!(scaled.nodes.len() > 30);
    }
}

#[test]
fn threads_change_nothing() {
    let values: Vec<f32> = generate(Distribution::Uniform, 3000, 3, 9).unwrap();
    let points = Points::new(&values, 3).unwrap();
    let with = |threads| {
        let options = SphereTreeOptions { threads: Some(threads), ..Default::default() };
        sphere_tree(&points, &options).unwrap()
    };
    let wanted = with(1);
    assert_eq!(wanted, with(2));
    assert_eq!(wanted, with(3));
}

#[test]
fn what_is_no_input_is_named() {
    let values = [0.0, 1.0, 2.0, f64::INFINITY];
    let points = Points::new(&values, 1).unwrap();
    let options = SphereTreeOptions::default();
    let wrong = sphere_tree(&points, &options);
    assert!(matches!(wrong, Err(Error::Input(InputError::NonFinite { row: 3, column: 0, .. }))));
    let points = Points::new(&values[..0], 1).unwrap();
    assert!(matches!(sphere_tree(&points, &options), Err(Error::Empty)));
    let points = Points::new(&values[..3], 1).unwrap();
    let wrong = |options| sphere_tree(&points, &options).unwrap_err();
    let leaf = SphereTreeOptions { leaf_size: 0, ..options };
    assert!(matches!(wrong(leaf), Error::Input(InputError::Option { name: "leaf_size", .. })));
    let epsilon = SphereTreeOptions { epsilon: 1.0, ..options };
    assert!(matches!(wrong(epsilon), Error::Input(InputError::Option { name: "epsilon", .. })));
    let threads = SphereTreeOptions { threads: Some(0), ..options };
    assert!(matches!(wrong(threads), Error::Input(InputError::Option { name: "threads", .. })));
}
