use super::*;
use proptest::prelude::*;

/// One link after the other.
fn plain(next: &[u32]) -> Lists {
    let mut led_to = vec![false; next.len()];
    next.iter().filter(|&&to| to != NO_NODE).for_each(|&to| led_to[to as usize] = true);
    let mut seen = vec![false; next.len()];
    let mut lists: Vec<(Vec<u32>, bool)> = Vec::new();
    for closed in [false, true] {
        for head in 0..next.len() {
            if seen[head] || (!closed && led_to[head]) {
                continue;
            }
            let (mut nodes, mut at) = (Vec::new(), head as u32);
            while at != NO_NODE && !seen[at as usize] {
                seen[at as usize] = true;
                nodes.push(at);
                at = next[at as usize];
            }
            lists.push((nodes, closed));
        }
    }
    lists.sort();
    let mut answer = Lists::default();
    for (nodes, closed) in lists {
        answer.starts.push(answer.order.len());
        answer.closed.push(closed);
        answer.order.extend(nodes);
    }
    answer.starts.push(next.len());
    answer
}

/// Links along a random permutation that is cut, or closed, every so often.
fn links(n: usize, mean: u64, closed_of_four: u64, seed: u64) -> Vec<u32> {
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        state >> 33
    };
    let mut nodes: Vec<u32> = (0..n as u32).collect();
    for i in (1..n).rev() {
        nodes.swap(i, (random() % (i as u64 + 1)) as usize);
    }
    let mut next = vec![NO_NODE; n];
    let mut first = 0;
    for i in 0..n {
        let ends = i + 1 == n || random() % mean == 0;
        next[nodes[i] as usize] = if !ends {
            nodes[i + 1]
        } else if random() % 4 < closed_of_four {
            nodes[first]
        } else {
            NO_NODE
        };
        first = if ends { i + 1 } else { first };
    }
    next
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 2 } else { 60 }))]
    #[test]
    fn equals_one_link_after_the_other(
        n in 0usize..9000, mean in 1u64..9000, closed in 0u64..5, seed: u64,
    ) {
        let next = links(if cfg!(miri) { n % 100 } else { n }, mean, closed, seed);
        let lists = list_order(&next).unwrap();
        prop_assert!(lists == plain(&next));
        let ranks = lists.ranks();
        for (rank, &node) in lists.order.iter().enumerate() {
            prop_assert_eq!(ranks[node as usize] as usize, rank);
        }
    }
}

#[test]
fn small_ones() {
    assert_eq!(list_order(&[]).unwrap(), Lists { starts: vec![0], ..Lists::default() });
    assert_eq!(list_order(&[0]).unwrap().closed, [true]);
    assert_eq!(list_order(&[NO_NODE]).unwrap().closed, [false]);
}

#[test]
fn links_that_meet_or_lead_nowhere_are_refused() {
    for next in [&[1, NO_NODE, 1][..], &[5, NO_NODE], &[0, 0]] {
        assert!(matches!(list_order(next), Err(Error::Option { .. })), "{next:?}");
    }
}

#[test]
#[cfg_attr(miri, ignore = "large")]
fn long_lists_of_many_cuts() {
    for (mean, closed) in [(u64::MAX, 0), (u64::MAX, 4), (50_000, 2)] {
        let next = links(200_000, mean, closed, 9);
        assert!(list_order(&next).unwrap() == plain(&next));
    }
}
