//! A binary tree of boxes over edges in the order of the curve: neighbors along the curve are neighbors in the plane.

/// A leaf has at most this many edges.
const LEAF_SIZE: usize = 4;

/// An axis-parallel box: least and largest coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub(super) least: [f64; 2],
    pub(super) most: [f64; 2],
}

impl Area {
    const EMPTY: Area = Area { least: [f64::INFINITY; 2], most: [f64::NEG_INFINITY; 2] };

    pub(super) fn of(segment: &[[f64; 2]; 2]) -> Self {
        let [a, b] = *segment;
        Area { least: [a[0].min(b[0]), a[1].min(b[1])], most: [a[0].max(b[0]), a[1].max(b[1])] }
    }

    fn joined(&self, other: &Area) -> Self {
        Area {
            least: [0, 1].map(|k| self.least[k].min(other.least[k])),
            most: [0, 1].map(|k| self.most[k].max(other.most[k])),
        }
    }

    pub(super) fn meets(&self, other: &Area) -> bool {
        (0..2).all(|k| self.least[k] <= other.most[k] && other.least[k] <= self.most[k])
    }

    /// The squared distance of a point; infinite for an empty box.
    #[inline(always)]
    pub(super) fn distance_squared(&self, p: [f64; 2]) -> f64 {
        let along = |k: usize| (self.least[k] - p[k]).max(p[k] - self.most[k]).max(0.0);
        let (x, y) = (along(0), along(1));
        x * x + y * y
    }
}

/// Node 1 is the root, the children of node i are 2i and 2i + 1.
pub(super) struct Tree {
    areas: Vec<Area>,
    leaves: usize,
    edges: usize,
}

impl Tree {
    pub(super) fn of(segments: impl ExactSizeIterator<Item = [[f64; 2]; 2]>) -> Self {
        let edges = segments.len();
        let leaves = edges.div_ceil(LEAF_SIZE).next_power_of_two();
        let mut areas = vec![Area::EMPTY; 2 * leaves];
        for (edge, segment) in segments.enumerate() {
            let area = &mut areas[leaves + edge / LEAF_SIZE];
            *area = area.joined(&Area::of(&segment));
        }
        for node in (1..leaves).rev() {
            areas[node] = areas[2 * node].joined(&areas[2 * node + 1]);
        }
        Tree { areas, leaves, edges }
    }

    /// Calls `look` for edges in leaves whose least value, as `least` tells it of a box and the first and last edge in it, is below
    /// `best`, the lesser child first; `look` lowers `best`.
    pub(super) fn least(
        &self,
        best: &mut f64,
        least: impl Fn(&Area, [usize; 2]) -> f64,
        mut look: impl FnMut(usize, &mut f64),
    ) {
        if self.edges == 0 {
            return;
        }
        let mut open = [(0usize, 0.0f64); 64];
        let mut count = 1;
        let value = |node: usize| {
            let size = LEAF_SIZE * (self.leaves >> node.ilog2());
            let first = (node - (1 << node.ilog2())) * size;
            match first < self.edges {
                true => least(&self.areas[node], [first, (first + size).min(self.edges) - 1]),
                false => f64::INFINITY,
            }
        };
        open[0] = (1, value(1));
        while count > 0 {
            count -= 1;
            let (node, bound) = open[count];
            if bound >= *best {
                continue;
            }
            if node >= self.leaves {
                let first = (node - self.leaves) * LEAF_SIZE;
                (first..(first + LEAF_SIZE).min(self.edges)).for_each(|edge| look(edge, best));
                continue;
            }
            let [one, other] = [2 * node, 2 * node + 1].map(|child| (child, value(child)));
            let (near, far) = if other.1 < one.1 { (other, one) } else { (one, other) };
            open[count] = far;
            open[count + 1] = near;
            count += 2;
        }
    }

    /// Calls `look` for pairs of edges, the first before the second, whose leaves have boxes that meet, until it says so.
    pub(super) fn pairs<E>(
        &self,
        mut look: impl FnMut(usize, usize) -> Result<bool, E>,
    ) -> Result<(), E> {
        let mut open = vec![(1, 1)];
        while let Some((a, b)) = open.pop() {
            if self.edges == 0 || !self.areas[a].meets(&self.areas[b]) {
                continue;
            }
            if a < self.leaves {
                match a == b {
                    true => {
                        open.extend([(2 * a, 2 * a), (2 * a, 2 * a + 1), (2 * a + 1, 2 * a + 1)])
                    }
                    // Both are of one level.
                    false => {
                        let children = [2 * a, 2 * a + 1].into_iter();
                        open.extend(children.flat_map(|a| [(a, 2 * b), (a, 2 * b + 1)]));
                    }
                }
                continue;
            }
            let of = |node: usize| {
                let first = (node - self.leaves) * LEAF_SIZE;
                first..(first + LEAF_SIZE).min(self.edges)
            };
            for one in of(a) {
                for other in of(b).filter(|&other| other > one) {
                    if look(one, other)? {
                        return Ok(());
                    }
                }
            }
        }
        Ok(())
    }
}
