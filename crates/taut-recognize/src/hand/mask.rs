//! A set of pixels, one bit each: from an image by the threshold, and opened by words of 64 pixels.

use super::color::ThresholdTable;

/// A set of the pixels of an image, one bit for each, rows padded to whole words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    width: usize,
    height: usize,
    stride: usize,
    words: Vec<u64>,
}

/// The side of the tiles that are tested at once; it divides the 64 bits of a word.
const TILE: usize = 16;

/// Returns the least and the largest red, green and blue of a tile.
fn color_range(
    pixels: &[u8],
    width: usize,
    rows: std::ops::Range<usize>,
    left: usize,
) -> [[u8; 3]; 2] {
    // Sixteen pixels side by side, so that the loop is one over bytes.
    let (mut low, mut high) = ([u8::MAX; 3 * TILE], [0; 3 * TILE]);
    for y in rows {
        let row = &pixels[3 * (y * width + left)..][..3 * TILE];
        for ((low, high), &value) in low.iter_mut().zip(&mut high).zip(row) {
            (*low, *high) = ((*low).min(value), (*high).max(value));
        }
    }
    let fold = |values: &[u8; 3 * TILE], pick: fn(u8, u8) -> u8| {
        let mut found = [values[0], values[1], values[2]];
        for pixel in values.chunks_exact(3) {
            found = std::array::from_fn(|c| pick(found[c], pixel[c]));
        }
        found
    };
    [fold(&low, u8::min), fold(&high, u8::max)]
}

impl Mask {
    /// Makes an empty set of the pixels of an image.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        let stride = width.div_ceil(64);
        Self { width, height, stride, words: vec![0; stride * height] }
    }

    /// Makes the set of all pixels for which `is_inside(x, y)` holds.
    pub fn from_fn(width: usize, height: usize, is_inside: impl Fn(usize, usize) -> bool) -> Self {
        let mut mask = Self::new(width, height);
        for y in 0..height {
            for x in 0..width {
                mask.words[y * mask.stride + x / 64] |= u64::from(is_inside(x, y)) << (x % 64);
            }
        }
        mask
    }

    /// Makes the set of the pixels of an RGB image, 3 bytes each by rows, whose b* is above the threshold.
    ///
    /// A tile whose colors are in a box on one side of the threshold is decided at once.
    #[must_use]
    pub fn from_rgb(pixels: &[u8], width: usize, height: usize, table: &ThresholdTable) -> Self {
        let mut mask = Self::new(width, height);
        for top in (0..height).step_by(TILE) {
            let rows = top..(top + TILE).min(height);
            for left in (0..width).step_by(TILE) {
                let right = (left + TILE).min(width);
                let uniform = if right - left == TILE {
                    let [low, high] = color_range(pixels, width, rows.clone(), left);
                    table.is_box_above(low, high)
                } else {
                    None
                };
                if uniform == Some(false) {
                    continue;
                }
                for y in rows.clone() {
                    let bits = if uniform == Some(true) {
                        (1 << TILE) - 1
                    } else {
                        let block = &pixels[3 * (y * width + left)..3 * (y * width + right)];
                        let is_above = |rgb: &[u8]| table.is_above([rgb[0], rgb[1], rgb[2]]);
                        (0..)
                            .zip(block.chunks_exact(3))
                            .fold(0, |bits, (bit, rgb)| bits | u64::from(is_above(rgb)) << bit)
                    };
                    // A tile is within a word.
                    mask.words[y * mask.stride + left / 64] |= bits << (left % 64);
                }
            }
        }
        mask
    }

    /// Returns the number of columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Tests whether a pixel is in the set; pixels outside the image are not.
    #[inline]
    #[must_use]
    pub fn contains(&self, x: i64, y: i64) -> bool {
        if x < 0 || y < 0 || x >= self.width as i64 || y >= self.height as i64 {
            return false;
        }
        let (x, y) = (x as usize, y as usize);
        self.words[y * self.stride + x / 64] >> (x % 64) & 1 == 1
    }

    /// Returns the number of pixels in the set.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.words.iter().map(|word| u64::from(word.count_ones())).sum()
    }

    /// Returns the words of a row, 64 pixels each, the first pixel in the lowest bit.
    pub(super) fn row(&self, y: usize) -> &[u64] {
        &self.words[y * self.stride..(y + 1) * self.stride]
    }

    /// Adds the pixels from `start` to before `end` of a row.
    pub(super) fn fill(&mut self, y: usize, start: usize, end: usize) {
        let row = &mut self.words[y * self.stride..(y + 1) * self.stride];
        for (index, word) in row.iter_mut().enumerate().take(end.div_ceil(64)).skip(start / 64) {
            let low = start.saturating_sub(64 * index);
            let high = (end - 64 * index).min(64);
            let ones = if high - low == 64 { u64::MAX } else { (1 << (high - low)) - 1 };
            *word |= ones << low;
        }
    }

    /// Removes a pixel.
    pub(super) fn remove(&mut self, x: usize, y: usize) {
        self.words[y * self.stride + x / 64] &= !(1 << (x % 64));
    }

    /// Removes what no diamond of the given radius fits into: erosions by a cross, then as many dilations.
    /// Pixels beyond the border count as members of the set, so that a hand that is cut off still touches the border.
    #[must_use]
    pub fn opened(&self, radius: usize) -> Self {
        let mut mask = self.clone();
        let mut next = self.clone();
        for step in 0..2 * radius {
            mask.apply_cross(step < radius, &mut next);
            std::mem::swap(&mut mask, &mut next);
        }
        mask
    }

    /// Erodes or dilates by the cross of five pixels, into `out`.
    fn apply_cross(&self, is_erosion: bool, out: &mut Self) {
        // An erosion is the dilation of the complement; beyond the border is nothing to dilate from in both.
        let flip = if is_erosion { u64::MAX } else { 0 };
        let last = self.stride.saturating_sub(1);
        let tail = match self.width % 64 {
            0 => u64::MAX,
            rest => (1 << rest) - 1,
        };
        let valid = |index: usize| if index == last { tail } else { u64::MAX };
        for y in 0..self.height {
            let row = self.row(y);
            let above = (y > 0).then(|| self.row(y - 1));
            let below = (y + 1 < self.height).then(|| self.row(y + 1));
            for index in 0..self.stride {
                let word = |index: usize| (row[index] ^ flip) & valid(index);
                let own = word(index);
                let mut grown = own | own << 1 | own >> 1;
                if index > 0 {
                    grown |= word(index - 1) >> 63;
                }
                if index < last {
                    grown |= word(index + 1) << 63;
                }
                for other in [above, below].into_iter().flatten() {
                    grown |= (other[index] ^ flip) & valid(index);
                }
                out.words[y * self.stride + index] = (grown ^ flip) & valid(index);
            }
        }
    }
}
