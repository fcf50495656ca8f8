//! The b* channel of CIELAB, the threshold that separates skin from a scanner's lid, and how to choose it.
//!
//! *Problem.* The edge of a hand is faint, so that intensity does not separate it from noise; color does (thesis, 7.4).
//! Skin is yellowish, b* > 0; the lid of a scanner is bluish, b* ≤ 0.
//! *Idea.* b* decreases when blue grows and red and green stay. So one table holds, for each red and green, the largest
//! blue of a hand, and the classification of a pixel is one comparison.
//! *Guarantee.* The table classifies each of the 2²⁴ colors exactly as the formula does; a test compares them.
//! *Trap.* An image without a hand has an Otsu threshold too: [`adaptive_threshold`] also measures the separation.
//! *Reference.* N. Otsu, A threshold selection method from gray-level histograms, IEEE Trans. SMC 9(1), 1979.

use std::sync::OnceLock;

/// The white point D65 of sRGB: X and Z; Y is 1.
pub(super) const WHITE_XZ: [f64; 2] = [0.95047, 1.08883];

/// The weights of linear red, green and blue in X, Y and Z (IEC 61966-2-1).
pub(super) const XYZ_OF_RGB: [[f64; 3]; 3] = [
    [0.412_456_4, 0.357_576_1, 0.180_437_5],
    [0.212_672_9, 0.715_152_2, 0.072_175],
    [0.019_333_9, 0.119_192, 0.950_304_1],
];

/// The cube of 6/29, where the linear part of CIELAB's function f ends.
const LINEAR_PART_MAX: f64 = 216.0 / 24389.0;

/// The b* of the thesis' fixed threshold. The thesis does not print its value; skin has 8 to 25 and a lid at most 0.
pub const FIXED_THRESHOLD: f64 = 4.0;

/// The adaptive threshold is a multiple of this in b*, so that its tables are few and kept.
const THRESHOLD_QUANTUM: f64 = 0.5;

/// The range of the adaptive threshold in b*: below it the noise of a lid is a hand, above it a faint edge is lid.
const THRESHOLD_RANGE: [f64; 2] = [0.5, 9.0];

/// Returns the intensity in [0, 1] of each level of sRGB.
pub(super) fn linear_levels() -> &'static [f64; 256] {
    static LEVELS: OnceLock<[f64; 256]> = OnceLock::new();
    LEVELS.get_or_init(|| {
        std::array::from_fn(|level| {
            let value = level as f64 / 255.0;
            if value <= 0.04045 { value / 12.92 } else { power_2_4((value + 0.055) / 1.055) }
        })
    })
}

/// Returns x^2.4 for x in (0, 1] from additions, multiplications and divisions only, so that every machine agrees.
fn power_2_4(x: f64) -> f64 {
    // Newton's iteration for y⁵ = x² from above; it converges quadratically after some 10 linear steps.
    let square = x * x;
    let mut root = 1.0;
    for _ in 0..60 {
        let fourth = root * root * root * root;
        root -= (root * fourth - square) / (5.0 * fourth);
    }
    square * root
}

/// Returns CIELAB's f(u): the cube root, and a line near 0.
fn lab_function(u: f64) -> f64 {
    if u > LINEAR_PART_MAX { u.cbrt() } else { u * (841.0 / 108.0) + 4.0 / 29.0 }
}

/// Returns the b* of an 8-bit sRGB color.
#[must_use]
pub fn lab_b(rgb: [u8; 3]) -> f64 {
    let levels = linear_levels();
    let linear = rgb.map(|level| levels[usize::from(level)]);
    let weighted = |row: &[f64; 3]| row[0] * linear[0] + row[1] * linear[1] + row[2] * linear[2];
    let (y, z) = (weighted(&XYZ_OF_RGB[1]), weighted(&XYZ_OF_RGB[2]));
    200.0 * (lab_function(y) - lab_function(z / WHITE_XZ[1]))
}

/// Cells of the table of [`approximate_lab_b`] from 0 to 1.
const CELLS: usize = 4096;

/// What [`approximate_lab_b`] may differ from [`lab_b`]: in a cell at the end of the linear part, f bends by 587 × h²/8
/// with h = 1/4096, which are 0.0009 in b*, for each of its two values.
pub const APPROXIMATION_MAX: f64 = 0.002;

/// Returns the b* of an 8-bit sRGB color, within [`APPROXIMATION_MAX`], from a table of CIELAB's f.
#[must_use]
pub fn approximate_lab_b(rgb: [u8; 3]) -> f64 {
    static TABLE: OnceLock<Vec<f64>> = OnceLock::new();
    let table = TABLE
        .get_or_init(|| (0..CELLS + 2).map(|k| lab_function(k as f64 / CELLS as f64)).collect());
    let levels = linear_levels();
    let linear = rgb.map(|level| levels[usize::from(level)]);
    let weighted = |row: &[f64; 3]| row[0] * linear[0] + row[1] * linear[1] + row[2] * linear[2];
    let function = |u: f64| {
        let place = u * CELLS as f64;
        let cell = (place as usize).min(CELLS);
        table[cell] + (place - cell as f64) * (table[cell + 1] - table[cell])
    };
    let (y, z) = (weighted(&XYZ_OF_RGB[1]), weighted(&XYZ_OF_RGB[2]));
    200.0 * (function(y) - function(z * (1.0 / WHITE_XZ[1])))
}

/// For each red and green, how many of the levels of blue, from 0 on, have a b* above a threshold.
pub struct ThresholdTable {
    threshold: f64,
    blues: Vec<u16>,
    /// Whether no count is less than one of less red or less green.
    is_monotone: bool,
}

impl ThresholdTable {
    /// Makes the table of a threshold.
    #[must_use]
    pub fn new(threshold: f64) -> Self {
        let mut blues = vec![0u16; 1 << 16];
        for red in 0..=255u8 {
            // The count of the green before is near: the search moves from there, by one or two levels.
            let mut count = 0u16;
            for green in 0..=255u8 {
                let is_hand = |blue: u16| lab_b([red, green, blue as u8]) > threshold;
                while count < 256 && is_hand(count) {
                    count += 1;
                }
                while count > 0 && !is_hand(count - 1) {
                    count -= 1;
                }
                blues[usize::from(red) << 8 | usize::from(green)] = count;
            }
        }
        let is_monotone = (0..1 << 16).all(|index| {
            (index < 256 || blues[index - 256] <= blues[index])
                && (index % 256 == 0 || blues[index - 1] <= blues[index])
        });
        Self { threshold, blues, is_monotone }
    }

    /// Returns the threshold in b*.
    #[must_use]
    pub fn threshold(&self) -> f64 {
        self.threshold
    }

    /// Tests whether the b* of a color is above the threshold.
    #[inline]
    #[must_use]
    pub fn is_above(&self, rgb: [u8; 3]) -> bool {
        u16::from(rgb[2]) < self.blues[usize::from(rgb[0]) << 8 | usize::from(rgb[1])]
    }

    /// Tests whether all colors of a box in RGB are above the threshold, or none; `None` if that takes a look at each.
    #[must_use]
    pub fn is_box_above(&self, low: [u8; 3], high: [u8; 3]) -> Option<bool> {
        // Counts grow with red and green, so that those at two corners of the box bound all others.
        let count = |rgb: [u8; 3]| self.blues[usize::from(rgb[0]) << 8 | usize::from(rgb[1])];
        if !self.is_monotone {
            None
        } else if u16::from(high[2]) < count(low) {
            Some(true)
        } else if u16::from(low[2]) >= count(high) {
            Some(false)
        } else {
            None
        }
    }

    /// Returns the shared table of a multiple of the quantum within the range, and of the fixed threshold.
    pub(super) fn shared(threshold: f64) -> &'static Self {
        const COUNT: usize =
            ((THRESHOLD_RANGE[1] - THRESHOLD_RANGE[0]) / THRESHOLD_QUANTUM) as usize + 1;
        static TABLES: [OnceLock<ThresholdTable>; COUNT] = [const { OnceLock::new() }; COUNT];
        let index = ((threshold - THRESHOLD_RANGE[0]) / THRESHOLD_QUANTUM).round();
        let index = index.clamp(0.0, (COUNT - 1) as f64);
        TABLES[index as usize]
            .get_or_init(|| Self::new(THRESHOLD_RANGE[0] + index * THRESHOLD_QUANTUM))
    }
}

/// An Otsu threshold of b*, and how well it separates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveThreshold {
    /// The threshold in b*, a multiple of one half.
    pub threshold: f64,
    /// The difference of the two classes' medians in b*, divided by the sum of their median absolute deviations.
    pub separation: f64,
    /// The difference of the two classes' medians in b*.
    pub contrast: f64,
    /// The share of the pixels above the threshold.
    pub share: f64,
}

/// Classes of the histogram of b*, from −50 on, each a quarter wide.
const BINS: usize = 400;
const BIN_WIDTH: f64 = 0.25;
const BIN_START: f64 = -50.0;

/// Returns the place of a value of b* in the histogram, in bins.
fn place(b: f64) -> f64 {
    ((b - BIN_START) / BIN_WIDTH).clamp(0.0, (BINS - 1) as f64)
}

/// A histogram of values of b*.
pub(super) struct Histogram([u64; BINS]);

impl Default for Histogram {
    fn default() -> Self {
        Self([0; BINS])
    }
}

impl Histogram {
    /// Adds a value.
    pub(super) fn add(&mut self, b: f64) {
        self.0[place(b) as usize] += 1;
    }

    /// Adds a color: the table decides its class, and the formula where the table is too near the limit of a class.
    fn add_color(&mut self, rgb: [u8; 3]) {
        let quick = place(approximate_lab_b(rgb));
        let bin = quick as usize;
        let share = quick - bin as f64;
        let is_clear = share.min(1.0 - share) * BIN_WIDTH > APPROXIMATION_MAX;
        self.0[if is_clear { bin } else { place(lab_b(rgb)) as usize }] += 1;
    }

    /// Returns the middle of the class of the median; `None` without values.
    pub(super) fn median(&self) -> Option<f64> {
        let (bin, _) = median_and_deviation(&self.0, 0);
        let is_empty = self.0.iter().all(|&count| count == 0);
        (!is_empty).then_some(BIN_START + (bin + 0.5) * BIN_WIDTH)
    }
}

/// Chooses the threshold of b* by Otsu's method from some 16 000 pixels on a grid; `None` without pixels.
#[must_use]
pub fn adaptive_threshold(pixels: &[u8], width: usize, height: usize) -> Option<AdaptiveThreshold> {
    const SAMPLES_PER_SIDE: usize = 128;
    let steps = [width, height].map(|side| side.div_ceil(SAMPLES_PER_SIDE).max(1));
    let mut counts = Histogram::default();
    // The grid is centered, so that a mirrored or turned image has the same samples.
    let start = |side: usize, step: usize| (side.saturating_sub(1) % step) / 2;
    for row in (start(height, steps[1])..height).step_by(steps[1]) {
        for column in (start(width, steps[0])..width).step_by(steps[0]) {
            let at = 3 * (row * width + column);
            counts.add_color([pixels[at], pixels[at + 1], pixels[at + 2]]);
        }
    }
    threshold_of_histogram(&counts.0)
}

fn threshold_of_histogram(counts: &[u64]) -> Option<AdaptiveThreshold> {
    let total: u64 = counts.iter().sum();
    if total == 0 {
        return None;
    }
    let moment: f64 = counts.iter().enumerate().map(|(bin, &n)| bin as f64 * n as f64).sum();
    let (mut below, mut moment_below, mut best, mut split) = (0u64, 0.0, -1.0, 0usize);
    let mut split_end = 0;
    for (bin, &count) in counts.iter().enumerate() {
        below += count;
        moment_below += bin as f64 * count as f64;
        let above = total - below;
        let variance = if below == 0 || above == 0 {
            0.0
        } else {
            let gap = moment_below / below as f64 - (moment - moment_below) / above as f64;
            below as f64 * above as f64 * gap * gap
        };
        // A valley without pixels has the same variance in each of its bins: its middle is the threshold.
        if variance > best * (1.0 + 1e-12) {
            (best, split, split_end) = (variance, bin, bin);
        } else if variance >= best * (1.0 - 1e-12) {
            split_end = bin;
        }
    }
    let raw = BIN_START + ((split + split_end) as f64 / 2.0 + 1.0) * BIN_WIDTH;
    let threshold = (raw / THRESHOLD_QUANTUM).round() * THRESHOLD_QUANTUM;
    let threshold = threshold.clamp(THRESHOLD_RANGE[0], THRESHOLD_RANGE[1]);
    let cut = ((threshold - BIN_START) / BIN_WIDTH) as usize;
    let (lower, upper) = counts.split_at(cut.min(counts.len()));
    let (low, low_spread) = median_and_deviation(lower, 0);
    let (high, high_spread) = median_and_deviation(upper, cut);
    let above: u64 = upper.iter().sum();
    let contrast = if above == 0 || above == total { 0.0 } else { (high - low) * BIN_WIDTH };
    // A class whose pixels are all in one bin still has the spread of that bin.
    let separation = contrast / (BIN_WIDTH * (low_spread + high_spread).max(1.0));
    Some(AdaptiveThreshold { threshold, separation, contrast, share: above as f64 / total as f64 })
}

/// Returns the median bin of a histogram and the median distance from it, in bins.
fn median_and_deviation(counts: &[u64], first: usize) -> (f64, f64) {
    let total: u64 = counts.iter().sum();
    let mut seen = 0;
    let median = counts.iter().position(|&count| {
        seen += count;
        2 * seen >= total.max(1)
    });
    let median = median.unwrap_or(0);
    let mut inside = 0;
    let reach = (0..counts.len()).find(|&distance| {
        let left = median.checked_sub(distance).map_or(0, |bin| counts[bin]);
        let right = counts.get(median + distance).copied().unwrap_or(0);
        inside += left + if distance == 0 { 0 } else { right };
        2 * inside >= total
    });
    ((first + median) as f64, reach.unwrap_or(0) as f64)
}
