//! Nodes that lie off the way from those before to those after them, moved onto it.
//!
//! *Problem.* Where outliers lie near the band a window may follow them, and the curve goes aside and back, or turns around for a stretch.
//! *Idea.* Along a curve the way from one node to the next is along the tangents of both. Of two nodes between which it is not, the
//! one that is askew to more of its surroundings is taken out, until all is in order; then those taken out are put in again, on
//! the cubic between the nodes beside them.
//! *Guarantee.* Of the nodes that stay where they were, no two follow each other by a way that is more than 60° off a tangent, but in
//! stretches of more than [`KINK_NODES_MAX`] nodes, which are left alone. A spline that is not in order after [`ROUNDS_MAX`] rounds, or of which
//! fewer than [`ORDERED_NODES_MIN`] nodes are, is left as it was. A function of the nodes that turns and scales with them; O(n) for each round, of
//! which there are as many as kinks are long.

use std::cmp::Ordering;

use super::parameters::{ALONG_COS_MIN, KINK_NODES_MAX, ORDERED_NODES_MIN, ROUNDS_MAX};
use super::spline::{Node, hermite};

/// Puts nodes off the way onto it, and says how many there were.
pub(super) fn straighten(nodes: &mut Vec<Node>, closed: bool) -> usize {
    let mut kept: Vec<usize> = (0..nodes.len()).collect();
    for _ in 0..ROUNDS_MAX {
        let askew = askew(nodes, &kept, closed);
        if !askew.contains(&true) {
            restore(&mut kept, nodes.len(), closed);
            let moved = nodes.len() - kept.len();
            if moved > 0 {
                put_between(nodes, &kept, closed);
            }
            return moved;
        }
        let mut askew = askew.into_iter();
        kept.retain(|_| askew.next() == Some(false));
        if kept.len() < ORDERED_NODES_MIN {
            break;
        }
    }
    0
}

/// Puts the numbers back that are missing in runs longer than [`KINK_NODES_MAX`].
fn restore(kept: &mut Vec<usize>, count: usize, closed: bool) {
    let mut whole = Vec::with_capacity(count);
    if let (false, [first, .., last]) = (closed, &kept[..]) {
        whole.extend(0..if *first > KINK_NODES_MAX { *first } else { 0 });
        whole.extend(if count - 1 - last > KINK_NODES_MAX { last + 1 } else { count }..count);
    }
    for (k, &first) in kept.iter().enumerate() {
        whole.push(first);
        let next = match kept.get(k + 1) {
            Some(&next) => next,
            None if closed => kept[0] + count,
            None => break,
        };
        if next - first - 1 > KINK_NODES_MAX {
            whole.extend((first + 1..next).map(|i| i % count));
        }
    }
    whole.sort_unstable();
    *kept = whole;
}

/// Which of the nodes kept are at an end of a way that is off its tangents, and no less askew than the other end.
fn askew(nodes: &[Node], kept: &[usize], closed: bool) -> Vec<bool> {
    let count = kept.len();
    let ways = count - usize::from(!closed);
    // Cosines at the beginning and the end of each way.
    let cosines: Vec<[f64; 2]> = (0..ways)
        .map(|k| {
            let (a, b) = (&nodes[kept[k]], &nodes[kept[(k + 1) % count]]);
            let (dx, dy) = (b.at[0] - a.at[0], b.at[1] - a.at[1]);
            [a.leaving, b.tangent].map(|t| (dx * t[0] + dy * t[1]) / dx.hypot(dy))
        })
        .collect();
    // The mean of those at each node, of one at the ends of an open spline.
    let along: Vec<f64> = (0..count)
        .map(|k| {
            let before =
                if k > 0 || closed { Some(cosines[(k + ways - 1) % ways][1]) } else { None };
            match (before, cosines.get(k)) {
                (Some(before), Some(after)) => 0.5 * (before + after[0]),
                (Some(one), None) => one,
                (None, after) => after.map_or(1.0, |after| after[0]),
            }
        })
        .collect();
    let mut askew = vec![false; count];
    for (k, cosines) in cosines.iter().enumerate() {
        // Nodes in one place make no way: their cosines are not numbers.
        if !(cosines[0] >= ALONG_COS_MIN && cosines[1] >= ALONG_COS_MIN) {
            let (a, b) = (k, (k + 1) % count);
            let order = along[a].partial_cmp(&along[b]);
            askew[a] |= order != Some(Ordering::Greater);
            askew[b] |= order != Some(Ordering::Less);
        }
    }
    askew
}

/// Puts the nodes that are not kept onto the cubics between those that are, evenly; those beyond the last ones of an open spline go.
fn put_between(nodes: &mut Vec<Node>, kept: &[usize], closed: bool) {
    let count = nodes.len();
    for (k, &first) in kept.iter().enumerate() {
        let next = match kept.get(k + 1) {
            Some(&next) => next,
            None if closed => kept[0] + count,
            None => break,
        };
        let (a, b) = (nodes[first], nodes[next % count]);
        for between in first + 1..next {
            let t = (between - first) as f64 / (next - first) as f64;
            let (at, slope) = hermite(&a, &b, t);
            let norm = slope[0].hypot(slope[1]);
            let mix = |a: f64, b: f64| (1.0 - t) * a + t * b;
            let tangent = slope.map(|x| x / norm);
            nodes[between % count] = Node {
                at,
                tangent,
                leaving: tangent,
                reach: mix(a.reach, b.reach),
                deviation: mix(a.deviation, b.deviation),
                error: a.error.max(b.error),
            };
        }
    }
    if let (false, [first, .., last]) = (closed, kept) {
        nodes.truncate(last + 1);
        nodes.drain(..first);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes on the unit circle, at so many degrees.
    fn at(degrees: f64) -> Node {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let (at, tangent) = ([cos, sin], [-sin, cos]);
        Node { at, tangent, leaving: tangent, reach: 0.1, deviation: 0.01, error: 0.01 }
    }

    fn circle(count: usize) -> Vec<Node> {
        (0..count).map(|k| at(360.0 * k as f64 / count as f64)).collect()
    }

    fn farthest_from_circle(nodes: &[Node]) -> f64 {
        nodes.iter().map(|n| (n.at[0].hypot(n.at[1]) - 1.0).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_curve_in_order_stays_as_it_is() {
        for (count, closed) in [(5, true), (72, true), (72, false), (4, false)] {
            let mut nodes = circle(count);
            assert_eq!(straighten(&mut nodes, closed), 0);
            assert_eq!(nodes.len(), count);
            assert_eq!(farthest_from_circle(&nodes), farthest_from_circle(&circle(count)));
        }
    }

    #[test]
    fn a_spike_goes_wherever_the_list_begins() {
        for place in 0..72 {
            let mut nodes = circle(72);
            nodes[place].at = nodes[place].at.map(|x| 0.8 * x);
            assert_eq!(straighten(&mut nodes, true), 1, "{place}");
            assert!(farthest_from_circle(&nodes) < 1e-4, "{place}");
        }
    }

    #[test]
    fn a_stretch_that_goes_back_is_put_in_order() {
        let mut nodes = circle(72);
        for (place, back) in [(20, 24.0), (21, 23.0), (22, 22.0), (23, 21.0)] {
            nodes[place] = at(5.0 * back);
            nodes[place].at = nodes[place].at.map(|x| 1.01 * x);
        }
        assert!(straighten(&mut nodes, true) > 0);
        assert_eq!(nodes.len(), 72);
        let angles = nodes.iter().map(|n| n.at[1].atan2(n.at[0]).rem_euclid(std::f64::consts::TAU));
        assert!(angles.clone().skip(1).zip(angles).all(|(next, one)| next > one));
        let unit = |n: &Node| (n.tangent[0].hypot(n.tangent[1]) - 1.0).abs() < 1e-12;
        assert!(nodes.iter().all(unit));
    }

    #[test]
    fn ends_askew_are_cut_off() {
        let mut nodes: Vec<Node> = circle(72)[..40].to_vec();
        nodes[0].leaving = [1.0, 0.0];
        nodes[39].at = [0.0, 0.0];
        assert_eq!(straighten(&mut nodes, false), 2);
        assert_eq!(nodes.len(), 38);
        assert_eq!(nodes[0].at, at(5.0).at);
    }

    #[test]
    fn nodes_without_any_order_stay() {
        let mut nodes: Vec<Node> = (0..40).map(|k| at(f64::from(k * k * 77 % 360))).collect();
        let before: Vec<[f64; 2]> = nodes.iter().map(|n| n.at).collect();
        assert_eq!(straighten(&mut nodes, true), 0);
        assert!(nodes.iter().map(|n| n.at).eq(before));
        let mut same = vec![at(0.0); 10];
        assert_eq!(straighten(&mut same, true), 0);
    }
}
