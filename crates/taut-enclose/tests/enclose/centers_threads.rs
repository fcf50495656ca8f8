//! The same bytes on one and three threads, and on two and eight in the long tests, for inputs of several blocks and searches of many nodes.

use taut_certify::{Items, LowerBound, Placement};
use taut_enclose::{
    CentersMethod, CentersOptions, FarthestFirstOptions, SphereTreeOptions, StreamingOptions,
    centers, farthest_first, sphere_tree,
};
use taut_points::{Blocks, Distribution, Points, generate};

use crate::test_length::long_or;

/// Numbers of threads to compare one thread with.
fn others() -> &'static [usize] {
    long_or(&[2, 3, 8], &[3])
}

/// `work` must return the same on any number of threads.
fn same<R: PartialEq>(name: &str, work: impl Fn(usize) -> R) {
    let wanted = work(1);
    for &threads in others() {
        assert!(work(threads) == wanted, "{name} on {threads} threads");
    }
}

/// The answer as it is written, which holds every bit of it.
fn same_centers(
    name: &str,
    values: &[f64],
    columns: usize,
    items: Items,
    k: usize,
    options: CentersOptions<'static>,
) -> taut_certify::Solution<taut_certify::Centers> {
    let points = Points::new(values, columns).unwrap();
    let solve = |threads| {
        let options = CentersOptions { threads: Some(threads), ..options };
        centers(&points, k, &CentersOptions { inputs: items, ..options }).unwrap()
    };
    let found = solve(1);
    let wanted = found.to_json();
    for &threads in others() {
        assert!(solve(threads).to_json() == wanted, "{name} on {threads} threads");
    }
    found
}

fn many(n: usize, columns: usize) -> Vec<f64> {
    let values: Vec<f64> = generate(Distribution::Normal, n, columns, 7).unwrap();
    let points = Points::new(&values, columns).unwrap();
    assert!(Blocks::of(&points).count() >= 4, "{n} rows of {columns} are too few blocks");
    values
}

#[test]
fn free_centers() {
    let plain = CentersOptions { assignment: true, ..Default::default() };
    let plane = many(150_000, 2);
    let found = same_centers("tree", &plane, 2, Items::Points, 6, plain);
    assert!(found.trace.iterations > 100, "{}", found.trace.iterations);
    let options = CentersOptions { outliers: 3, ..plain };
    same_centers("outliers", &plane, 2, Items::Points, 2, options);
    let thesis = CentersOptions { method: CentersMethod::Thesis, epsilon: 0.1, ..plain };
    same_centers("thesis", &plane, 2, Items::Points, 3, thesis);
    let mut space = many(100_000, 4);
    space.iter_mut().skip(3).step_by(4).for_each(|v| *v = 0.1 + v.abs());
    same_centers("balls", &space, 4, Items::Balls, 3, plain);
    let weights = CentersOptions { weights: true, epsilon: 0.05, ..plain };
    same_centers("weights", &space, 4, Items::Points, 2, weights);
}

/// Thousands of nodes, a log of branches, and a search that the budget stops.
#[test]
fn long_searches() {
    let values: Vec<f64> = generate(Distribution::Uniform, 3000, 2, 3).unwrap();
    let plain = CentersOptions::default();
    let found = same_centers("long", &values, 2, Items::Points, 11, plain);
    assert!(found.trace.iterations >= 5000, "{}", found.trace.iterations);
    assert!(matches!(found.certificate.proof, LowerBound::Branches { .. }));
    let stopped = CentersOptions { max_nodes: 5000, epsilon: 1e-6, ..plain };
    same_centers("stopped", &values, 2, Items::Points, 14, stopped);
}

#[test]
fn centers_among_the_rows() {
    let rows =
        CentersOptions { placement: Placement::Rows, assignment: true, ..Default::default() };
    let values: Vec<f64> = generate(Distribution::Uniform, 3000, 2, 3).unwrap();
    same_centers("rows", &values, 2, Items::Points, 8, rows);
    let options = CentersOptions { outliers: 2, epsilon: 0.05, ..rows };
    same_centers("rows, outliers", &values, 2, Items::Points, 3, options);
    let method = CentersMethod::FarthestFirst;
    let traversal = CentersOptions { method, assignment: false, ..rows };
    same_centers("traversal", &many(150_000, 2), 2, Items::Points, 50, traversal);
}

#[test]
fn traversals_streams_and_trees() {
    let values = many(150_000, 3);
    let points = Points::new(&values, 3).unwrap();
    same("farthest first", |threads| {
        let options = FarthestFirstOptions { threads: Some(threads), ..Default::default() };
        let found = farthest_first(&points, 300, &options).unwrap();
        (found.order, found.radii.into_iter().map(f64::to_bits).collect::<Vec<_>>())
    });
    same("stream", |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let method = CentersMethod::Stream(StreamingOptions::default());
        let cover =
            || centers(&points, 20, &CentersOptions { method, ..Default::default() }).unwrap();
        pool.install(cover).to_json()
    });
    let few = Points::new(&values[..60_000], 3).unwrap();
    same("tree of balls", |threads| {
        let options = SphereTreeOptions { threads: Some(threads), ..Default::default() };
        let tree = sphere_tree(&few, &options).unwrap();
        format!("{tree:?}")
    });
}
