//! Centers by trying all partitions, and certificates of every kind for them.

use taut_certify::{
    Centers, CentersCertificate, CentersVerdict, CheckError, Items, LowerBound, Placement,
    Solution, Trace, Violation,
};
use taut_points::{Monitor, Points, hash_points};

/// Items and what is asked of them.
#[derive(Clone, Debug)]
pub(crate) struct Task {
    pub(crate) values: Vec<f64>,
    pub(crate) columns: usize,
    pub(crate) items: Items,
    pub(crate) weights: bool,
    pub(crate) placement: Placement,
}

/// A best choice of centers.
#[derive(Clone, Debug)]
pub(crate) struct Best {
    pub(crate) radius: f64,
    /// Items by group, and those left out.
    pub(crate) groups: Vec<u32>,
    pub(crate) left_out: u32,
}

impl Task {
    pub(crate) fn points(values: &[f64], dim: usize) -> Self {
        let (items, placement) = (Items::Points, Placement::Free);
        Task { values: values.to_vec(), columns: dim, items, weights: false, placement }
    }

    pub(crate) fn len(&self) -> usize {
        self.values.len() / self.columns
    }

    pub(crate) fn dim(&self) -> usize {
        self.items.dim(self.columns) - usize::from(self.weights)
    }

    pub(crate) fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.columns..(i + 1) * self.columns]
    }

    /// Returns how far an item reaches from a center.
    pub(crate) fn reach(&self, i: usize, center: &[f64]) -> f64 {
        let (row, dim) = (self.row(i), self.dim());
        let squares: f64 = row[..dim].iter().zip(center).map(|(x, c)| (x - c).powi(2)).sum();
        match (self.items, self.weights) {
            (Items::Balls, _) => squares.sqrt() + row[dim],
            (_, true) => squares.sqrt() * row[dim],
            _ => squares.sqrt(),
        }
    }

    fn farthest(&self, group: u32, center: &[f64]) -> f64 {
        members(group).map(|i| self.reach(i, center)).fold(0.0, f64::max)
    }

    /// The best center of a group, and its radius.
    pub(crate) fn center(&self, group: u32) -> (Vec<f64>, f64) {
        let dim = self.dim();
        match self.placement {
            Placement::Rows => (0..self.len())
                .map(|row| self.row(row)[..dim].to_vec())
                .map(|center| (self.farthest(group, &center), center))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .map(|(radius, center)| (center, radius))
                .unwrap(),
            Placement::Free if self.items == Items::Points && !self.weights => {
                self.smallest_ball(group)
            }
            Placement::Free => self.by_halving(group),
        }
    }

    /// Of points: the least ball through few of them that holds all.
    fn smallest_ball(&self, group: u32) -> (Vec<f64>, f64) {
        let mut best: Option<(Vec<f64>, f64)> = None;
        let mut subset = group;
        while subset != 0 {
            if subset.count_ones() as usize <= self.dim() + 1 {
                let rows: Vec<&[f64]> = members(subset).map(|i| self.row(i)).collect();
                if let Some(lambda) = super::circumcenter(&rows) {
                    let coordinate =
                        |j: usize| rows.iter().zip(&lambda).map(|(row, l)| row[j] * l).sum();
                    let center: Vec<f64> = (0..self.dim()).map(coordinate).collect();
                    let radius = self.farthest(subset, &center);
                    let holds = self.farthest(group, &center) <= radius * (1.0 + 1e-10);
                    if holds && best.as_ref().is_none_or(|(_, least)| radius < *least) {
                        best = Some((center, radius));
                    }
                }
            }
            subset = (subset - 1) & group;
        }
        best.expect("some subset determines the ball")
    }

    /// Of anything on a line or in the plane: a convex function of the center, by thirds, to about 1e-9.
    fn by_halving(&self, group: u32) -> (Vec<f64>, f64) {
        let range = |j: usize| {
            let all = members(group).map(|i| self.row(i)[j]);
            (all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max))
        };
        let along = |y: Option<f64>| {
            least(range(0), &|x| {
                let center: Vec<f64> = std::iter::once(x).chain(y).collect();
                self.farthest(group, &center)
            })
        };
        match self.dim() {
            1 => {
                let (x, radius) = along(None);
                (vec![x], radius)
            }
            2 => {
                let (y, radius) = least(range(1), &|y| along(Some(y)).1);
                (vec![along(Some(y)).0, y], radius)
            }
            dim => panic!("no oracle in dimension {dim}"),
        }
    }

    /// The radius of each set of items.
    pub(crate) fn radii(&self) -> Vec<f64> {
        let radius = |group: u32| if group == 0 { 0.0 } else { self.center(group).1 };
        (0..1u32 << self.len()).map(radius).collect()
    }
}

/// Where a convex function is least, and how small.
fn least((mut low, mut high): (f64, f64), f: &dyn Fn(f64) -> f64) -> (f64, f64) {
    for _ in 0..60 {
        let (a, b) = (low + (high - low) * 0.38, low + (high - low) * 0.62);
        if f(a) <= f(b) { high = b } else { low = a }
    }
    let middle = (low + high) / 2.0;
    (middle, f(middle))
}

pub(crate) fn members(group: u32) -> impl Iterator<Item = usize> + Clone {
    (0..32).filter(move |i| group >> i & 1 == 1)
}

/// The best of all partitions of `all` into k groups, with z items left out.
pub(crate) fn best(radii: &[f64], all: u32, k: usize, z: usize) -> Best {
    let mut best = Best { radius: f64::INFINITY, groups: vec![], left_out: 0 };
    let mut left_out = all;
    loop {
        if left_out.count_ones() as usize <= z {
            let (radius, groups) = partition(radii, all & !left_out, k);
            if radius < best.radius {
                best = Best { radius, groups, left_out };
            }
        }
        if left_out == 0 {
            return best;
        }
        left_out = (left_out - 1) & all;
    }
}

fn partition(radii: &[f64], items: u32, k: usize) -> (f64, Vec<u32>) {
    if items == 0 {
        return (0.0, vec![]);
    }
    if k == 1 {
        return (radii[items as usize], vec![items]);
    }
    // The group of the first item, and the best of the rest.
    let first = items & items.wrapping_neg();
    let rest = items & !first;
    let mut best = (f64::INFINITY, vec![]);
    let mut others = rest;
    loop {
        let own = radii[(first | others) as usize];
        if own < best.0 {
            let (radius, mut groups) = partition(radii, rest & !others, k - 1);
            if radius.max(own) < best.0 {
                groups.push(first | others);
                best = (radius.max(own), groups);
            }
        }
        if others == 0 {
            return best;
        }
        others = (others - 1) & rest;
    }
}

/// The log of a plain search over the items of `core`; `None` where groups of less than `bound` hold them.
pub(crate) fn log(radii: &[f64], core: &[u64], k: usize, z: usize, bound: f64) -> Option<Vec<u32>> {
    let mut log = vec![];
    branch(radii, core, k, z, bound, &mut vec![], 0, &mut log).then_some(log)
}

#[allow(clippy::too_many_arguments, reason = "the state of a search")]
fn branch(
    radii: &[f64],
    core: &[u64],
    k: usize,
    z: usize,
    bound: f64,
    groups: &mut Vec<u32>,
    given: u32,
    log: &mut Vec<u32>,
) -> bool {
    let fits = |group: u32, item: usize| radii[(group | 1 << core[item]) as usize] < bound;
    let open = (0..core.len()).filter(|item| given >> item & 1 == 0);
    let choices = |&item: &usize| groups.iter().filter(|&&group| fits(group, item)).count();
    let Some(item) = open.min_by_key(choices) else { return false };
    log.push(item as u32);
    let given = given | 1 << item;
    for group in 0..groups.len() {
        if fits(groups[group], item) {
            groups[group] |= 1 << core[item];
            let refuted = branch(radii, core, k, z, bound, groups, given, log);
            groups[group] &= !(1 << core[item]);
            if !refuted {
                return false;
            }
        }
    }
    if groups.len() < k && fits(0, item) {
        groups.push(1 << core[item]);
        let refuted = branch(radii, core, k, z, bound, groups, given, log);
        groups.pop();
        if !refuted {
            return false;
        }
    }
    z == 0 || branch(radii, core, k, z - 1, bound, groups, given, log)
}

/// A task and a solution for it.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) task: Task,
    pub(crate) solution: Solution<Centers>,
}

impl Case {
    /// Centers of these groups, at the radius that they need times `slack`, and this proof of this bound.
    pub(crate) fn of(
        name: &str,
        task: &Task,
        found: &Best,
        (k, z): (usize, usize),
        (slack, lower_bound): (f64, f64),
        (core_set, proof): (Vec<u64>, LowerBound),
    ) -> Self {
        let groups: Vec<u32> = found.groups.iter().copied().filter(|&g| g != 0).collect();
        let mut centers: Vec<Vec<f64>> = groups.iter().map(|&group| task.center(group).0).collect();
        if centers.is_empty() {
            centers.push(task.row(0)[..task.dim()].to_vec());
        }
        let is_row = |center: &Vec<f64>| {
            (0..task.len()).find(|&i| task.row(i)[..task.dim()] == center[..]).map(|i| i as u64)
        };
        let rows = match task.placement {
            Placement::Free => vec![],
            Placement::Rows => centers.iter().map(|center| is_row(center).unwrap()).collect(),
        };
        let nearest = |i: usize| {
            let all = centers.iter().map(|center| task.reach(i, center)).enumerate();
            all.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
        };
        let outliers: Vec<u64> = members(found.left_out).map(|i| i as u64).collect();
        let counts = |i: &usize| found.left_out >> i & 1 == 0;
        let needed = (0..task.len()).filter(counts).map(|i| nearest(i).1).fold(0.0, f64::max);
        let radius = needed * slack * (1.0 + 1e-15);
        let assignment = (0..task.len()).map(|i| nearest(i).0 as u32).collect();
        let gap = if radius == lower_bound { 0.0 } else { (radius - lower_bound) / lower_bound };
        let points = Points::new(&task.values, task.columns).unwrap();
        let solution = Solution {
            answer: Centers { centers, rows, radius, lower_bound, outliers, assignment },
            certificate: CentersCertificate {
                items: task.items,
                weights: task.weights,
                group: None,
                placement: task.placement,
                k: k as u64,
                outliers: z as u64,
                gap: gap.min(f64::MAX),
                core_set,
                directions: vec![],
                proof,
                points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
            },
            trace: Trace::default(),
        };
        Case { name: name.into(), task: task.clone(), solution }
    }

    pub(crate) fn check(&self) -> Result<CentersVerdict, CheckError> {
        self.solution.check(&Points::new(&self.task.values, self.task.columns).unwrap())
    }

    /// The violation found; panics when the case is accepted.
    pub(crate) fn violation(&self) -> Violation {
        match self.check() {
            Err(CheckError::Rejected(violation)) => violation,
            other => panic!("{}: {other:?}\n{self:?}", self.name),
        }
    }
}

/// All rows.
pub(crate) fn everything(task: &Task) -> Vec<u64> {
    (0..task.len() as u64).collect()
}

/// k centers at these places, of this radius.
pub(crate) fn by_hand(
    points: &Points<'_, f64>,
    centers: &[&[f64]],
    (radius, lower_bound): (f64, f64),
    core_set: &[u64],
    proof: LowerBound,
) -> Solution<Centers> {
    let gap = if lower_bound > 0.0 { (radius - lower_bound) / lower_bound } else { f64::MAX };
    Solution {
        answer: Centers {
            centers: centers.iter().map(|center| center.to_vec()).collect(),
            rows: vec![],
            radius,
            lower_bound,
            outliers: vec![],
            assignment: vec![],
        },
        certificate: CentersCertificate {
            items: Items::Points,
            weights: false,
            group: None,
            placement: Placement::Free,
            k: centers.len() as u64,
            outliers: 0,
            gap: gap.min(f64::MAX),
            core_set: core_set.to_vec(),
            directions: vec![],
            proof,
            points_hash: hash_points(points, &Monitor::silent()).unwrap(),
        },
        trace: Trace::default(),
    }
}
