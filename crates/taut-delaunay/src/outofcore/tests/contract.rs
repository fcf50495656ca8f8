//! The functions for drivers refuse what does not fit together.

use taut_points::Monitor;

use super::super::front::FrozenFacet;
use super::super::{
    CellBox, FINE_LEVELS, Front, Magnitudes, NodeJob, NodePoints, Router, Tree, Whole, finish,
    summarize,
};
use super::sets;
use crate::Error;

/// The fronts of two leaves, and what their parent must know.
fn two_leaves() -> (Whole<2>, [Front<2>; 2]) {
    let points = sets::uniform::<2>(2000, 23);
    let router = Router::new(points.clone(), 1 + FINE_LEVELS);
    let mut cells = vec![CellBox::EMPTY; router.cells()];
    let mut magnitudes = Magnitudes::EMPTY;
    let mut leaves = [NodePoints::default(), NodePoints::default()];
    for (row, &p) in (0u64..).zip(&points) {
        cells[router.cell(p)].add(p);
        p.iter().for_each(|&x| magnitudes.add(x));
        leaves[router.cell(p) >> FINE_LEVELS].push(p, row);
    }
    let whole = Whole::new(&Tree::new(&cells), magnitudes, true);
    let fronts = [(1, 0), (2, 1)].map(|(node, leaf): (u32, usize)| {
        let job = NodeJob { node, row_bytes: 8, output: "memory" };
        let points = leaves[leaf].clone();
        summarize(&whole, job, points, &mut Vec::new(), &Monitor::silent()).unwrap().1
    });
    (whole, fronts)
}

fn finished(whole: &Whole<2>, front: Front<2>) -> Result<u64, Error> {
    let job = NodeJob { node: 0, row_bytes: 8, output: "memory" };
    finish(whole, job, front, &mut Vec::new(), &Monitor::silent()).map(|counts| counts.simplices)
}

#[test]
fn fronts_that_were_changed_do_not_fit() {
    let (whole, [left, right]) = two_leaves();
    let mut both = left;
    both.append(right);
    assert!(both.len() < 400 && finished(&whole, both.clone()).unwrap() > 100);
    let last = both.facets.len() - 1;
    let refused = |change: &dyn Fn(&mut Front<2>)| {
        let mut front = both.clone();
        change(&mut front);
        matches!(finished(&whole, front), Err(Error::DamagedFront { .. }))
    };
    // Without one of its facets a border is open: the flood comes behind it.
    for removed in [0, last / 2, last] {
        assert!(refused(&|front| {
            front.facets.remove(removed);
        }));
    }
    assert!(refused(&|front| front.facets[last].vertices.swap(0, 1)));
    assert!(refused(&|front| {
        let facet = FrozenFacet { vertices: [0, front.rows.len() as u32 - 1], ..front.facets[0] };
        front.facets.push(facet);
    }));
    assert!(refused(&|front| front.coordinates[0] = front.coordinates[1]));
}

#[test]
fn a_task_that_runs_twice_gives_the_same_bytes() {
    let (_, once) = two_leaves();
    let (_, twice) = two_leaves();
    assert_eq!(once.map(|front| front.to_bytes()), twice.map(|front| front.to_bytes()));
}

#[test]
fn points_that_are_not_finite_are_refused() {
    let (whole, _) = two_leaves();
    let mut points = NodePoints::default();
    points.push([0.0, f64::INFINITY], 7);
    let job = NodeJob { node: 1, row_bytes: 8, output: "memory" };
    let refused = summarize(&whole, job, points, &mut Vec::new(), &Monitor::silent());
    assert!(refused.unwrap_err().to_string().contains("coordinate 1 of point 7"));
}
