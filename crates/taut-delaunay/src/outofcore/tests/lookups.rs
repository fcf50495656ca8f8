//! What an earlier run has stored is looked up on all threads.

use std::sync::{Condvar, Mutex};
use std::time::Duration;

use taut_points::Monitor;

use super::super::driver::{Course, NodeRecord, Storage, Walk, WriteNode, run};
use super::super::{
    CellBox, FINE_LEVELS, Front, Magnitudes, NodePoints, Router, TileCounts, Tree, Whole,
};
use crate::Error;

/// Threads that ask for a node: how many do, and how many did at the same time.
#[derive(Default)]
struct Asking {
    now: usize,
    most: usize,
    /// No second thread came: nobody waits for one any more.
    is_alone: bool,
}

/// Has all nodes, and tells so once two threads have asked at the same time.
#[derive(Default)]
struct Stored {
    asking: Mutex<Asking>,
    changed: Condvar,
}

impl Storage<2> for Stored {
    fn points(&self, leaf: u32) -> Result<NodePoints<2>, Error> {
        panic!("leaf {leaf} is stored")
    }

    fn front(&self, node: u32) -> Result<Front<2>, Error> {
        panic!("the front of {node} is of no use")
    }

    fn store(&self, node: u32, _: &mut WriteNode<'_, 2>) -> Result<NodeRecord, Error> {
        panic!("node {node} is stored")
    }

    fn stored(&self, _: u32) -> Result<Option<NodeRecord>, Error> {
        let mut asking = self.asking.lock().unwrap();
        asking.now += 1;
        asking.most = asking.most.max(asking.now);
        self.changed.notify_all();
        let limit = Duration::from_secs(20);
        let is_waiting = |asking: &mut Asking| asking.most < 2 && !asking.is_alone;
        let (mut asking, waited) =
            self.changed.wait_timeout_while(asking, limit, is_waiting).unwrap();
        asking.is_alone |= waited.timed_out();
        asking.now -= 1;
        let counts = TileCounts { sites: 3, simplices: 1, ..TileCounts::default() };
        Ok(Some(NodeRecord { counts, front_sites: 3, front_facets: 0 }))
    }

    fn release(&self, _: u32) {}
}

#[test]
fn stored_nodes_are_looked_up_on_several_threads() {
    let router = Router::<2>::new(vec![], 3 + FINE_LEVELS);
    let tree = Tree::new(&vec![CellBox::EMPTY; router.cells()]);
    let whole = Whole::new(&tree, Magnitudes::EMPTY, true);
    let walk = Walk::new(|node| tree.children(node), |node| node >= 7);
    let course =
        Course { merge_above: 4, row_bytes: 4, threads: 2, budget: u64::MAX, site_bytes: 100 };
    let storage = Stored::default();
    let totals = run(&whole, &walk, &course, &|_| 5, &storage, &Monitor::silent()).unwrap();
    assert_eq!(storage.asking.into_inner().unwrap().most, 2);
    // Eight leaves with a front of three sites each, and seven nodes above.
    assert_eq!((totals.tiles, totals.simplices, totals.front_sites), (15, 15, 24));
    assert_eq!((totals.merged_sites, totals.root_sites), (42, 6));
}
