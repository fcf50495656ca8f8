//! The exact Euclidean distance transform of a set of pixels, in integers.
//!
//! *Problem.* For each pixel, the squared distance of its center to the nearest pixel center outside the set.
//! *Idea.* Down each column the distance to the nearest pixel outside takes two scans. Along each row the squared
//! distance is then the lower envelope of the parabolas (x − i)² + g(i)², which one scan builds and another one reads.
//! *Guarantee.* Exact for every size: no floating-point number takes part. O(1) for each pixel.
//! *Trap.* A set without any pixel outside has no distances: they are `None`, unless the border counts as outside.
//! *Reference.* A. Meijster, J. Roerdink, W. Hesselink, A general algorithm for computing distance transforms in linear
//! time, 2000; T. Felzenszwalb, D. Huttenlocher, Distance transforms of sampled functions, Theory of Computing 8, 2012.

use super::mask::Mask;

/// What lies beyond the border of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Border {
    /// The pixels beyond the border are outside the set: a disc must stay within the image.
    Outside,
    /// Nothing: distances are to pixels of the image only, and a disc may leave it.
    Ignored,
}

/// The squared distances of all pixels of an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DistanceTransform {
    width: usize,
    squared: Vec<u64>,
}

/// The distance of a column that has no pixel outside: beyond the side of every image.
const NO_PIXEL: u64 = u64::MAX;

impl DistanceTransform {
    /// Returns the squared distance between the centers of a pixel and of the nearest one outside the set, 0 for a
    /// pixel outside; `None` if nothing is outside, or for a pixel beyond the image.
    #[must_use]
    pub fn squared(&self, x: usize, y: usize) -> Option<u64> {
        let index = (x < self.width).then(|| y.checked_mul(self.width)?.checked_add(x))??;
        self.squared.get(index).copied().filter(|&square| square != NO_PIXEL)
    }

    /// Returns the first pixel with the largest squared distance, by rows, and that distance; `None` if nothing is
    /// outside or the image is empty.
    #[must_use]
    pub fn deepest(&self) -> Option<([usize; 2], u64)> {
        let largest = *self.squared.iter().max()?;
        let index = self.squared.iter().position(|&square| square == largest)?;
        (largest != NO_PIXEL).then_some(([index % self.width, index / self.width], largest))
    }
}

/// Returns the exact squared Euclidean distances of the pixels of a set to the nearest pixel outside.
#[must_use]
pub fn distance_transform(mask: &Mask, border: Border) -> DistanceTransform {
    let (width, height) = (mask.width(), mask.height());
    let beyond = if border == Border::Outside { 0 } else { NO_PIXEL };
    let mut squared = vec![0; width * height];
    // Columns, row by row: the distance to the nearest pixel outside above, then below.
    let mut last = vec![beyond; width];
    for y in 0..height {
        let row = &mut squared[y * width..(y + 1) * width];
        for x in 0..width {
            last[x] = if mask.contains(x as i64, y as i64) { last[x].saturating_add(1) } else { 0 };
            row[x] = last[x];
        }
    }
    last.fill(beyond);
    for y in (0..height).rev() {
        let row = &mut squared[y * width..(y + 1) * width];
        for x in 0..width {
            last[x] = if row[x] == 0 { 0 } else { last[x].saturating_add(1) };
            row[x] = row[x].min(last[x]);
        }
    }
    let mut envelope = Envelope::default();
    for row in squared.chunks_exact_mut(width.max(1)) {
        envelope.transform(row, border);
    }
    DistanceTransform { width, squared }
}

/// The lower envelope of the parabolas of a row: their vertices, and from where on each is lowest.
#[derive(Default)]
struct Envelope {
    parabolas: Vec<Parabola>,
}

#[derive(Clone, Copy)]
struct Parabola {
    /// The column of its vertex; −1 and the width are the columns beyond the border.
    column: i64,
    /// The squared distance at its vertex.
    height: i64,
    /// The first column where it is lowest.
    start: i64,
}

impl Envelope {
    /// Replaces the distances along the columns by the squared Euclidean distances.
    fn transform(&mut self, row: &mut [u64], border: Border) {
        let width = row.len() as i64;
        self.parabolas.clear();
        if border == Border::Outside {
            self.add(-1, 0);
        }
        for (column, &distance) in (0..).zip(row.iter()) {
            // Distances are at most the height of an image in memory, so that their squares fit.
            if distance != NO_PIXEL {
                let distance = distance as i64;
                self.add(column, distance * distance);
            }
        }
        if border == Border::Outside {
            self.add(width, 0);
        }
        let Some(&first) = self.parabolas.first() else {
            row.fill(NO_PIXEL);
            return;
        };
        let (mut current, mut next) = (first, 1);
        for (column, square) in (0..).zip(row.iter_mut()) {
            while next < self.parabolas.len() && self.parabolas[next].start <= column {
                current = self.parabolas[next];
                next += 1;
            }
            *square = ((column - current.column).pow(2) + current.height) as u64;
        }
    }

    /// Adds the parabola of a column to the right of all others.
    fn add(&mut self, column: i64, height: i64) {
        let start = loop {
            let Some(last) = self.parabolas.last() else { break i64::MIN };
            // (x − c)² + h < (x − c')² + h' from here on, with c' < c: the least whole x beyond the crossing.
            let numerator = column * column + height - last.column * last.column - last.height;
            let start = numerator.div_euclid(2 * (column - last.column)) + 1;
            if start > last.start {
                break start;
            }
            self.parabolas.pop();
        };
        self.parabolas.push(Parabola { column, height, start });
    }
}
