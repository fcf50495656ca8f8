//! The centers, halved again and again along their widest axis, so that few are asked for each row.
//!
//! *Cost.* O(dk log k) to build. In few dimensions a row asks O(log k) of k centers that lie evenly; in many, all.

/// Up to this many centers are asked one by one.
const LEAF_SIZE: usize = 8;

/// Centers that lie on two sides of a gap along an axis, or few of them.
struct Node {
    /// Which of the centers, in their order here.
    first: usize,
    end: usize,
    /// Where they are parted; `None` for few.
    parting: Option<Split>,
}

struct Split {
    axis: usize,
    /// The largest coordinate of the one side, and the smallest of the other.
    low: f64,
    high: f64,
    /// Number of the node of the other side; that of the one side follows its parent.
    other: usize,
}

pub(super) struct CenterTree {
    order: Vec<usize>,
    nodes: Vec<Node>,
}

impl CenterTree {
    pub(super) fn of(centers: &[Vec<f64>]) -> Self {
        let mut center_tree = CenterTree { order: (0..centers.len()).collect(), nodes: vec![] };
        center_tree.part(centers, 0, centers.len());
        center_tree
    }

    /// Parts a range of the order; its depth is the logarithm of its length.
    fn part(&mut self, centers: &[Vec<f64>], first: usize, end: usize) {
        let node = self.nodes.len();
        self.nodes.push(Node { first, end, parting: None });
        if end - first <= LEAF_SIZE {
            return;
        }
        let range = |axis: usize, order: &[usize]| {
            let all = order.iter().map(|&center| centers[center][axis]);
            all.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
        };
        let order = &mut self.order[first..end];
        let width = |axis: usize, order: &[usize]| {
            let (least, most) = range(axis, order);
            most - least
        };
        let widest = (0..centers[0].len())
            .map(|axis| (axis, width(axis, order)))
            .reduce(|a, b| if b.1 > a.1 { b } else { a });
        let Some((axis, _)) = widest.filter(|&(_, width)| width > 0.0) else { return };
        let half = order.len() / 2;
        order.select_nth_unstable_by(half, |&a, &b| {
            centers[a][axis].total_cmp(&centers[b][axis]).then(a.cmp(&b))
        });
        let (low, high) = (range(axis, &order[..half]).1, range(axis, &order[half..]).0);
        self.part(centers, first, first + half);
        let other = self.nodes.len();
        self.part(centers, first + half, end);
        self.nodes[node].parting = Some(Split { axis, low, high, other });
    }

    /// The first center that passes a test, of all that are at most so far from a place, and perhaps of others; those on
    /// the side of the place come first.
    #[inline(always)]
    pub(super) fn find<T: Copy + Into<f64>>(
        &self,
        place: &[T],
        reach: f64,
        mut test: impl FnMut(usize) -> bool,
    ) -> Option<usize> {
        // Each level leaves one node behind, and there are fewer than 64.
        let (mut open, mut count) = ([0; 65], 1);
        while count > 0 {
            count -= 1;
            let number = open[count];
            let node = &self.nodes[number];
            let Some(Split { axis, low, high, other }) = node.parting else {
                let few = &self.order[node.first..node.end];
                match few.iter().copied().find(|&center| test(center)) {
                    Some(center) => return Some(center),
                    None => continue,
                }
            };
            let x: f64 = place[axis].into();
            let sides = [(number + 1, x - low), (other, high - x)];
            let nearer = usize::from(sides[1].1 < sides[0].1);
            for (node, distance) in [sides[1 - nearer], sides[nearer]] {
                if distance <= reach {
                    open[count] = node;
                    count += 1;
                }
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_are_near_are_asked() {
        let coordinate = |i: usize| ((i * i * 37 + i * 11) % 101) as f64;
        let centers: Vec<Vec<f64>> =
            (0..300).map(|i| vec![coordinate(i), coordinate(i + 7), coordinate(3 * i)]).collect();
        let center_tree = CenterTree::of(&centers);
        let distance = |a: &[f64], b: &[f64]| {
            a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
        };
        let mut total = 0;
        for place in &centers {
            let mut asked = vec![];
            center_tree.find(place, 12.0, |center| {
                asked.push(center);
                false
            });
            total += asked.len();
            asked.sort_unstable();
            assert!(asked.windows(2).all(|pair| pair[0] < pair[1]));
            let is_near = |center: &usize| distance(&centers[*center], place) <= 12.0;
            assert!((0..300).filter(is_near).all(|center| asked.binary_search(&center).is_ok()));
        }
        assert!(total < 300 * 100, "{total}");
    }
}
