//! Connected components of a set of pixels, by runs: the hand, what else is on the glass, and the holes of the hand.
//!
//! *Idea.* A row is a few runs of pixels. Runs that touch in neighboring rows are united by union–find; everything
//! that follows works on runs.
//! *Trap.* The set is 4-connected, so that its outline is a simple polygon, and its complement is 8-connected.

use taut_points::OrderBy;

use super::mask::Mask;

/// A run of pixels of one row: columns from `start` to before `end`.
#[derive(Clone, Copy, Debug)]
struct Run {
    y: usize,
    start: usize,
    end: usize,
}

/// One connected component of a set of pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Component {
    /// The number of its pixels.
    pub area: u64,
    /// The mean of its pixels' centers, in pixels from the image's top left corner.
    pub center: [f64; 2],
}

/// The largest component of a set, without holes, and what was left out or filled.
#[derive(Clone, Debug)]
pub struct LargestComponent {
    /// The component, its holes filled.
    pub mask: Mask,
    /// The number of its pixels, with those of the holes.
    pub area: u64,
    /// The other components, largest first.
    pub others: Vec<Component>,
    /// The holes that were filled, largest first.
    pub holes: Vec<Component>,
}

/// Returns the largest 4-connected component with its holes filled; `None` for an empty set.
#[must_use]
pub fn largest_component(mask: &Mask) -> Option<LargestComponent> {
    let runs = find_runs(mask, false);
    let labels = label(&runs, 0);
    let sums = sum_up(&runs, &labels);
    // The first of equals: the one that is higher in the image.
    let (largest, _) = sums
        .iter()
        .enumerate()
        .filter(|(_, sum)| sum.area > 0)
        .max_by_key(|(index, sum)| (sum.area, std::cmp::Reverse(*index)))?;
    let mut others: Vec<_> = sums
        .iter()
        .enumerate()
        .filter(|&(index, sum)| index != largest && sum.area > 0)
        .map(|(_, sum)| sum.component())
        .collect();
    others.order_by_key(|other| std::cmp::Reverse(other.area));
    let mut only = Mask::new(mask.width(), mask.height());
    for (run, _) in runs.iter().zip(&labels).filter(|&(_, &label)| label == largest) {
        only.fill(run.y, run.start, run.end);
    }
    let mut area = sums[largest].area;
    let mut holes = vec![];
    let gaps = find_runs(&only, true);
    let labels = label(&gaps, 1);
    let sums = sum_up(&gaps, &labels);
    let is_hole: Vec<bool> =
        sums.iter().map(|sum| sum.area > 0 && !sum.is_at_border(&only)).collect();
    for (sum, _) in sums.iter().zip(&is_hole).filter(|(_, is_hole)| **is_hole) {
        area += sum.area;
        holes.push(sum.component());
    }
    for (run, _) in gaps.iter().zip(&labels).filter(|&(_, &label)| is_hole[label]) {
        only.fill(run.y, run.start, run.end);
    }
    holes.order_by_key(|hole| std::cmp::Reverse(hole.area));
    Some(LargestComponent { mask: only, area, others, holes })
}

/// Returns the runs of a set or of its complement, by rows.
fn find_runs(mask: &Mask, is_complement: bool) -> Vec<Run> {
    let flip = if is_complement { u64::MAX } else { 0 };
    let mut runs = vec![];
    for y in 0..mask.height() {
        let row = mask.row(y);
        let (mut x, mut open) = (0, None);
        while x < mask.width() {
            // The distance to the next change within the word.
            let word = (row[x / 64] ^ flip) >> (x % 64);
            let left = 64 - x % 64;
            let is_inside = open.is_some();
            let step = if is_inside { word.trailing_ones() } else { word.trailing_zeros() };
            let step = (step as usize).min(left);
            x += step;
            if step < left && x < mask.width() {
                open = match open {
                    None => Some(x),
                    Some(start) => {
                        runs.push(Run { y, start, end: x });
                        None
                    }
                };
            }
        }
        if let Some(start) = open {
            runs.push(Run { y, start, end: mask.width() });
        }
    }
    runs
}

/// Returns the label of each run: the first run of its component. `diagonal` is 1 if corners connect and 0 if not.
fn label(runs: &[Run], diagonal: usize) -> Vec<usize> {
    let mut parents: Vec<usize> = (0..runs.len()).collect();
    let mut above = 0;
    for index in 0..runs.len() {
        let run = runs[index];
        // Runs are in order: those of the row above that end before this one begins end before all later ones do.
        while above < index
            && (runs[above].y + 1 < run.y
                || runs[above].y + 1 == run.y && runs[above].end + diagonal <= run.start)
        {
            above += 1;
        }
        let mut other = above;
        while other < index && runs[other].y + 1 == run.y && runs[other].start < run.end + diagonal
        {
            unite(&mut parents, other, index);
            other += 1;
        }
    }
    (0..runs.len()).map(|index| find(&mut parents, index)).collect()
}

fn find(parents: &mut [usize], mut index: usize) -> usize {
    while parents[index] != index {
        parents[index] = parents[parents[index]];
        index = parents[index];
    }
    index
}

fn unite(parents: &mut [usize], a: usize, b: usize) {
    let (a, b) = (find(parents, a), find(parents, b));
    parents[a.max(b)] = a.min(b);
}

/// What is known of the component of a label.
#[derive(Clone, Copy, Default)]
struct Sum {
    area: u64,
    twice_x: u128,
    twice_y: u128,
    start: usize,
    end: usize,
    first_row: usize,
    last_row: usize,
}

impl Sum {
    fn component(&self) -> Component {
        let mean = |twice: u128| twice as f64 / (2.0 * self.area as f64);
        Component { area: self.area, center: [mean(self.twice_x), mean(self.twice_y)] }
    }

    fn is_at_border(&self, mask: &Mask) -> bool {
        self.start == 0
            || self.first_row == 0
            || self.end == mask.width()
            || self.last_row + 1 == mask.height()
    }
}

/// Returns the sums of each label, at the label's index; other places are empty.
fn sum_up(runs: &[Run], labels: &[usize]) -> Vec<Sum> {
    let mut sums = vec![Sum::default(); runs.len()];
    for (run, &label) in runs.iter().zip(labels) {
        let length = (run.end - run.start) as u64;
        let sum = &mut sums[label];
        if sum.area == 0 {
            (sum.start, sum.end, sum.first_row) = (run.start, run.end, run.y);
        }
        sum.area += length;
        sum.twice_x += u128::from(length) * (run.start + run.end) as u128;
        sum.twice_y += u128::from(length) * (2 * run.y + 1) as u128;
        (sum.start, sum.end) = (sum.start.min(run.start), sum.end.max(run.end));
        sum.last_row = run.y;
    }
    sums
}
