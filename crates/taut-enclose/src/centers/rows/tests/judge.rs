//! A judge of its own: measures the answer, and follows the proof item by item with plain arithmetic.

use taut_certify::{Centers, Items, LowerBound, Placement, Solution};

/// What is asked.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a> {
    pub(super) values: &'a [f64],
    pub(super) columns: usize,
    pub(super) items: Items,
    pub(super) weights: bool,
    pub(super) k: usize,
    pub(super) outliers: usize,
}

impl Problem<'_> {
    pub(super) fn len(&self) -> usize {
        self.values.len() / self.columns
    }

    pub(super) fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.columns..(i + 1) * self.columns]
    }

    fn dim(&self) -> usize {
        self.columns - usize::from(self.weights || self.items == Items::Balls)
    }

    /// The reach of an item from a center.
    pub(super) fn reach(&self, item: usize, center: &[f64]) -> f64 {
        let row = self.row(item);
        // By the largest difference, as hypot does, so that no square overflows.
        let differences = || row[..self.dim()].iter().zip(center).map(|(a, b)| (a - b).abs());
        let largest = differences().fold(0.0, f64::max);
        let distance = match largest {
            0.0 => 0.0,
            _ if (1e-100..1e100).contains(&largest) => {
                differences().map(|d| d * d).sum::<f64>().sqrt()
            }
            _ => differences().map(|d| (d / largest).powi(2)).sum::<f64>().sqrt() * largest,
        };
        match (self.weights, self.items) {
            (true, _) => row[self.dim()] * distance,
            (_, Items::Balls) => distance + row[self.dim()],
            _ => distance,
        }
    }

    /// The radius that the rows with these numbers have as centers.
    fn radius(&self, centers: &[usize]) -> f64 {
        let nearest = |item| {
            let reaches = centers.iter().map(|&c| self.reach(item, self.row(c)));
            reaches.fold(f64::INFINITY, f64::min)
        };
        let mut reaches: Vec<f64> = (0..self.len()).map(nearest).collect();
        reaches.sort_unstable_by(|a, b| b.total_cmp(a));
        reaches.get(self.outliers).copied().unwrap_or(0.0)
    }

    /// The least radius of all choices of k rows.
    pub(super) fn brute_force(&self) -> f64 {
        let k = self.k.min(self.len());
        let choices = (1u32..1 << self.len()).filter(|choice| choice.count_ones() as usize == k);
        let centers =
            |choice: u32| (0..self.len()).filter(|i| choice >> i & 1 == 1).collect::<Vec<_>>();
        choices.map(|choice| self.radius(&centers(choice))).fold(f64::INFINITY, f64::min)
    }
}

/// Judges all of it.
#[track_caller]
pub(super) fn judge(problem: &Problem<'_>, found: &Solution<Centers>, epsilon: f64) {
    let Solution { answer, certificate, .. } = found;
    assert_eq!(certificate.placement, Placement::Rows);
    assert_eq!((certificate.k, certificate.outliers), (problem.k as u64, problem.outliers as u64));
    assert_eq!((certificate.items, certificate.weights), (problem.items, problem.weights));
    assert_eq!(answer.rows.len(), answer.centers.len());
    assert!(!answer.rows.is_empty() && answer.rows.len() <= problem.k);
    assert!(answer.rows.is_sorted_by(|a, b| a < b), "rows ascend, each once");
    for (&row, center) in answer.rows.iter().zip(&answer.centers) {
        assert_eq!(center, &problem.row(row as usize)[..problem.dim()]);
    }
    assert!(answer.outliers.len() <= problem.outliers && answer.outliers.is_sorted());
    for item in (0..problem.len()).filter(|&item| !answer.outliers.contains(&(item as u64))) {
        let reaches = answer.centers.iter().map(|center| problem.reach(item, center));
        let nearest = reaches.fold(f64::INFINITY, f64::min);
        assert!(nearest <= answer.radius, "row {item}: {nearest} beyond {}", answer.radius);
    }
    let lower = answer.lower_bound;
    assert!(0.0 <= lower && lower <= answer.radius);
    let gap = if answer.radius == lower { 0.0 } else { answer.radius / lower - 1.0 };
    assert!(gap <= certificate.gap * (1.0 + 1e-9) + 4e-16, "{gap} {}", certificate.gap);
    // 1e-12 for rounding, and as much again to spare.
    assert!(gap <= epsilon + 2e-12 + answer.radius.recip() * 1e-300, "{gap} beyond {epsilon}");
    if lower > 0.0 {
        Replay::new(problem, found).follow();
    }
}

/// A depth-first replay of the proof.
struct Replay<'a> {
    /// For each item of the core-set, whether each row has it within less than the bound.
    near: Vec<Vec<bool>>,
    k: usize,
    outliers: usize,
    proof: &'a LowerBound,
    read: usize,
}

impl<'a> Replay<'a> {
    fn new(problem: &Problem<'_>, found: &'a Solution<Centers>) -> Self {
        let bound = found.answer.lower_bound;
        let near = |&item: &u64| {
            let reach = |row| problem.reach(item as usize, problem.row(row));
            (0..problem.len()).map(|row| reach(row) < bound).collect()
        };
        Replay {
            near: found.certificate.core_set.iter().map(near).collect(),
            k: problem.k,
            outliers: problem.outliers,
            proof: &found.certificate.proof,
            read: 0,
        }
    }

    #[track_caller]
    fn follow(&mut self) {
        match self.proof {
            LowerBound::Separated => {
                assert!(self.near.len() > self.k + self.outliers);
                for a in 0..self.near.len() {
                    assert!((0..a).all(|b| !self.is_feasible(&[a, b])));
                }
            }
            LowerBound::Avoiding { .. } => panic!("centers at rows are not asked to avoid"),
            LowerBound::Nogoods { .. } => panic!("nogoods are recorded of free centers alone"),
            LowerBound::Branches { items } => {
                self.node(items, &mut vec![], &mut vec![]);
                assert_eq!(self.read, items.len(), "branches left over");
            }
        }
    }

    fn is_feasible(&self, items: &[usize]) -> bool {
        (0..self.near[0].len()).any(|row| items.iter().all(|&item| self.near[item][row]))
    }

    fn node(&mut self, log: &[u32], clusters: &mut Vec<Vec<usize>>, left_out: &mut Vec<usize>) {
        let item = *log.get(self.read).expect("the log ends too soon") as usize;
        self.read += 1;
        let mut given = clusters.iter().flatten().chain(&*left_out);
        assert!(given.all(|&i| i != item), "item {item} is given twice");
        for j in 0..clusters.len() {
            clusters[j].push(item);
            if self.is_feasible(&clusters[j]) {
                self.node(log, clusters, left_out);
            }
            clusters[j].pop();
        }
        if clusters.len() < self.k && self.is_feasible(&[item]) {
            clusters.push(vec![item]);
            self.node(log, clusters, left_out);
            clusters.pop();
        }
        if left_out.len() < self.outliers {
            left_out.push(item);
            self.node(log, clusters, left_out);
            left_out.pop();
        }
    }
}
