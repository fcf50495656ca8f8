//! A grid of square cells over segments: what is near a point, and what may meet what.
//!
//! *Idea.* Cells about as large as segments are long, but no more than four for each segment; a segment is listed in the cells of
//! each row between the two where it enters and leaves the row, so that a long one costs its length and not its square.
//! *Guarantee.* [`Grid::nearest`] is exact up to rounding: rings of cells are opened until the next is farther than the best.
//! *Trap.* A point far outside the box would open empty rings first: rings begin at the cell of the box next to it.

pub(crate) type Segment = ([f64; 2], [f64; 2]);

/// Segments in the cells they run through.
pub(crate) struct Grid<'a> {
    segments: &'a [Segment],
    low: [f64; 2],
    cell: f64,
    size: [usize; 2],
    starts: Vec<u32>,
    listed: Vec<u32>,
}

/// The nearest place on a set of segments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearest {
    pub(crate) distance: f64,
    pub(crate) segment: u32,
    /// Share of the segment before it.
    pub(crate) share: f64,
}

/// The place of a segment next to p: distance and share.
fn place(p: [f64; 2], (a, b): Segment) -> (f64, f64) {
    let (e, d) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = e[0] * e[0] + e[1] * e[1];
    let share =
        if square > 0.0 { ((d[0] * e[0] + d[1] * e[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    ((d[0] - share * e[0]).hypot(d[1] - share * e[1]), share)
}

impl<'a> Grid<'a> {
    /// Lists all segments; `None` when there are none.
    pub(crate) fn new(segments: &'a [Segment]) -> Option<Self> {
        let (mut low, mut high) = (segments.first()?.0, segments.first()?.0);
        let mut length = 0.0;
        for &(a, b) in segments {
            for k in 0..2 {
                low[k] = low[k].min(a[k]).min(b[k]);
                high[k] = high[k].max(a[k]).max(b[k]);
            }
            length += (b[0] - a[0]).abs() + (b[1] - a[1]).abs();
        }
        let (width, height, n) = (high[0] - low[0], high[1] - low[1], segments.len() as f64);
        // Four cells for each segment at the most, also where the box is thin.
        let cell = (length / n)
            .max((width * height / (4.0 * n)).sqrt())
            .max(width.max(height) / (4.0 * n));
        let cell = if cell > 0.0 && cell.is_finite() { cell } else { 1.0 };
        let cells = |extent: f64| ((extent / cell) as usize + 1).min(1 << 31);
        let size = [cells(width), cells(height)];
        let mut grid = Self {
            segments,
            low,
            cell,
            size,
            starts: vec![0; size[0] * size[1] + 1],
            listed: Vec::new(),
        };
        let mut starts = std::mem::take(&mut grid.starts);
        for &segment in segments {
            grid.cells(segment, |cell| starts[cell + 1] += 1);
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut listed = vec![0; starts[starts.len() - 1] as usize];
        let mut next = starts.clone();
        for (number, &segment) in segments.iter().enumerate() {
            grid.cells(segment, |cell| {
                listed[next[cell] as usize] = number as u32;
                next[cell] += 1;
            });
        }
        (grid.starts, grid.listed) = (starts, listed);
        Some(grid)
    }

    /// Column or row of a coordinate, within the grid.
    fn index(&self, axis: usize, value: f64) -> usize {
        (((value - self.low[axis]) / self.cell) as usize).min(self.size[axis] - 1)
    }

    /// Calls for each cell that a segment may run through.
    fn cells(&self, (a, b): Segment, mut call: impl FnMut(usize)) {
        let (a, b) = if a[1] <= b[1] { (a, b) } else { (b, a) };
        let (first, last) = (self.index(1, a[1]), self.index(1, b[1]));
        let slope = (b[0] - a[0]) / (b[1] - a[1]);
        for row in first..=last {
            let (mut from, mut to) = (a[0], b[0]);
            if first < last {
                // A little more than the row, for rounding.
                let bottom = self.low[1] + (row as f64 - 1e-6) * self.cell;
                let x = |y: f64| a[0] + slope * (y - a[1]);
                if row > first {
                    from = x(bottom);
                }
                if row < last {
                    to = x(bottom + (1.0 + 2e-6) * self.cell);
                }
            }
            let slack = 1e-6 * self.cell;
            let columns = self.index(0, from.min(to) - slack)..=self.index(0, from.max(to) + slack);
            for column in columns {
                call(row * self.size[0] + column);
            }
        }
    }

    fn listed(&self, column: usize, row: usize) -> &[u32] {
        let cell = row * self.size[0] + column;
        &self.listed[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// All lists of segments that share a cell.
    pub(crate) fn lists(&self) -> impl Iterator<Item = &[u32]> {
        self.starts.windows(2).map(|pair| &self.listed[pair[0] as usize..pair[1] as usize])
    }

    /// The place on the segments next to p.
    pub(crate) fn nearest(&self, p: [f64; 2]) -> Nearest {
        let mut best = Nearest { distance: f64::INFINITY, segment: 0, share: 0.0 };
        let middle = [self.index(0, p[0]), self.index(1, p[1])];
        let look = |column: usize, row: usize, best: &mut Nearest| {
            for &segment in self.listed(column, row) {
                let (distance, share) = place(p, self.segments[segment as usize]);
                if (distance, segment) < (best.distance, best.segment) {
                    *best = Nearest { distance, segment, share };
                }
            }
        };
        for ring in 0..=self.size[0].max(self.size[1]) {
            let [left, bottom] = middle.map(|v| v as isize - ring as isize);
            let [right, top] = middle.map(|v| (v + ring) as isize);
            // What the rings before hold lies within this far of p on every side that has cells left.
            if ring > 0 && self.beyond(p, [left, bottom], [right, top]) > best.distance {
                break;
            }
            let inside = |v: isize, axis: usize| (0..self.size[axis] as isize).contains(&v);
            for row in [bottom, top] {
                if inside(row, 1) && (ring > 0 || row == bottom) {
                    for column in left.max(0)..=right.min(self.size[0] as isize - 1) {
                        look(column as usize, row as usize, &mut best);
                    }
                    if ring == 0 {
                        break;
                    }
                }
            }
            for column in [left, right] {
                if ring > 0 && inside(column, 0) {
                    for row in (bottom + 1).max(0)..=(top - 1).min(self.size[1] as isize - 1) {
                        look(column as usize, row as usize, &mut best);
                    }
                }
            }
        }
        best
    }

    /// A distance from p that no cell of a ring and of those around it is within; infinite when the ring has left the grid.
    fn beyond(&self, p: [f64; 2], low: [isize; 2], high: [isize; 2]) -> f64 {
        let mut least = f64::INFINITY;
        for axis in 0..2 {
            // The sides of the ring towards its middle.
            let edge = |cell: isize| self.low[axis] + cell as f64 * self.cell;
            if low[axis] >= 0 {
                least = least.min((p[axis] - edge(low[axis] + 1)).max(0.0));
            }
            if high[axis] < self.size[axis] as isize {
                least = least.min((edge(high[axis]) - p[axis]).max(0.0));
            }
        }
        // Segments are listed with a slack for rounding, which counts against it here.
        least - 1e-5 * self.cell
    }
}
