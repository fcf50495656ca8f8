use super::*;

fn repaired(sites: &[[f64; 2]], edges: &[[u32; 2]], ends: Ends) -> (Vec<[u32; 2]>, Repairs) {
    repair(sites, edges.to_vec(), ends, &Monitor::silent()).expect("nobody cancels")
}

#[test]
fn chains_do_not_depend_on_the_order_of_edges() {
    let mut edges = vec![[5, 2], [2, 7], [7, 5], [0, 9], [9, 3], [1, 4]];
    let expected = [
        Chain { sites: vec![0, 9, 3], closed: false },
        Chain { sites: vec![1, 4], closed: false },
        Chain { sites: vec![2, 5, 7], closed: true },
    ];
    for _ in 0..edges.len() {
        assert_eq!(chains(10, &edges), expected);
        edges.rotate_left(1);
        let turned: Vec<[u32; 2]> = edges.iter().map(|&[a, b]| [b, a]).collect();
        assert_eq!(chains(10, &turned), expected);
    }
    assert_eq!(chains(3, &[]), []);
}

#[test]
fn a_branch_gives_way_to_the_straight_pair() {
    let sites = [[0.0, 0.0], [1.0, 0.0], [-1.0, 0.1], [0.0, 1.0]];
    let (edges, repairs) = repaired(&sites, &[[0, 3], [2, 0], [0, 1]], Ends::Open);
    assert_eq!(edges, [[0, 1], [0, 2]]);
    assert_eq!(repairs.cut, 1);
}

#[test]
fn of_edges_that_meet_the_longer_one_goes() {
    // Crossing, a foot on an edge, and two along one line.
    let sites = [[0.0, 0.0], [4.0, 0.0], [1.0, -1.0], [1.0, 1.0], [2.0, 0.0], [2.0, 3.0]];
    for other in [[2, 3], [4, 5], [0, 4]] {
        let (edges, repairs) = repaired(&sites, &[[0, 1], other], Ends::Open);
        assert_eq!((edges, repairs.crossed), (vec![other], 1), "{other:?}");
    }
    let (edges, repairs) = repaired(&sites, &[[0, 4], [4, 1], [4, 5]], Ends::Open);
    assert_eq!((edges.len(), repairs), (2, Repairs { cut: 1, ..Repairs::default() }));
}

#[test]
fn facing_ends_are_joined_across_a_moderate_gap_only() {
    let sites = [[0.0, 0.0], [1.0, 0.0], [4.0, 0.0], [5.0, 0.0], [10.0, 0.0], [11.0, 0.0]];
    let edges = [[0, 1], [2, 3], [4, 5]];
    let (joined, repairs) = repaired(&sites, &edges, Ends::Auto);
    assert_eq!((joined, repairs.joined), (vec![[0, 1], [1, 2], [2, 3], [4, 5]], 1));
    assert_eq!(repaired(&sites, &edges, Ends::Open).0, edges);
}

#[test]
fn no_gap_is_joined_across_an_edge() {
    let sites = [[0.0, 0.0], [1.0, 0.0], [3.0, 0.0], [4.0, 0.0], [2.0, -5.0], [2.0, 5.0]];
    let edges = [[0, 1], [2, 3], [4, 5]];
    assert_eq!(repaired(&sites, &edges, Ends::Auto).0, edges);
}
