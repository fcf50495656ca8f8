//! Cells of rectangles: ranges of the offsets and of the slope.
//!
//! *Rounding.* Vertices are off by less than 2⁻⁵¹, and less the pivot by less than 2⁻⁵⁰, with coordinates from −2 to 2. Heights are
//! off by less than 2⁻⁴⁷, and those of points between the ends of edges by less than 2⁻⁴⁶. Numbers of cells are of size 2.25 or
//! less, and sums and quotients of them are right to some 2⁻⁵⁰ of the sizes at hand. [`MARGIN`] is above all of these.

/// The error of no height or range is as large as this: 2⁻⁴³.
pub(super) const MARGIN: f64 = f64::from_bits((1023 - 43) << 52);

/// Largest offset in size at the root.
pub(super) const OFFSET_MAX: f64 = 2.25;

/// The height of a point above a side is the first number plus the slope times the second.
pub(super) fn height_parts(side: usize, [x, y]: [f64; 2]) -> [f64; 2] {
    match side {
        0 => [x, y],
        1 => [y, -x],
        2 => [-x, -y],
        _ => [-y, x],
    }
}

/// Ranges of the four offsets, and of the slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub(super) offsets: [[f64; 2]; 4],
    pub(super) slopes: [f64; 2],
}

impl Cell {
    pub(super) fn root() -> Self {
        Cell { offsets: [[-OFFSET_MAX, OFFSET_MAX]; 4], slopes: [-1.0, 1.0] }
    }

    /// The halves of the range of an offset, or with number 4 of the slope; `None` where rounding leaves no middle.
    pub(super) fn halves(&self, coordinate: usize) -> Option<[Cell; 2]> {
        let (mut below, mut above) = (*self, *self);
        let [low, high] = match coordinate {
            0..=3 => self.offsets[coordinate],
            _ => self.slopes,
        };
        let middle = 0.5 * low + 0.5 * high;
        match coordinate {
            0..=3 => {
                (below.offsets[coordinate], above.offsets[coordinate]) =
                    ([low, middle], [middle, high]);
            }
            _ => (below.slopes, above.slopes) = ([low, middle], [middle, high]),
        }
        (low < middle && middle < high).then_some([below, above])
    }

    /// The least and the largest height of a point above a side, but for rounding.
    pub(super) fn heights(&self, side: usize, w: [f64; 2]) -> [f64; 2] {
        let [constant, linear] = height_parts(side, w);
        let [one, other] = self.slopes.map(|slope| constant + slope * linear);
        [one.min(other), one.max(other)]
    }

    /// Whether a point is surely below a side.
    pub(super) fn is_below(&self, side: usize, w: [f64; 2]) -> bool {
        self.heights(side, w)[1] < self.offsets[side][0] - MARGIN
    }

    /// Whether a point is surely beyond a side.
    pub(super) fn is_beyond(&self, side: usize, w: [f64; 2]) -> bool {
        self.heights(side, w)[0] > self.offsets[side][1] + MARGIN
    }

    /// Whether the sides are in order for all rectangles.
    pub(super) fn has_core(&self) -> bool {
        (0..2).all(|k| self.offsets[k][0] + self.offsets[k + 2][0] > MARGIN)
    }

    /// The ranges of the rectangles with more than an area and with no side beyond the polygon; `None` if there are none.
    pub(super) fn contracted(&self, extents: &[f64; 4], area: f64) -> Option<Cell> {
        let mut cell = *self;
        for ([_, high], extent) in cell.offsets.iter_mut().zip(extents) {
            *high = high.min(extent + MARGIN);
        }
        let high = cell.offsets.map(|range| range[1]);
        let sums = [high[0] + high[2], high[1] + high[3]];
        if sums.iter().any(|&sum| sum <= 0.0) {
            return None;
        }
        let [from, to] = self.slopes;
        let slope = if from <= 0.0 && to >= 0.0 { 0.0 } else { from.abs().min(to.abs()) };
        let least = area * (1.0 + slope * slope) * (1.0 - MARGIN);
        for (side, [low, _]) in cell.offsets.iter_mut().enumerate() {
            // A large quotient of a small divisor is as large as the exact one, but for a share.
            let needed = least / sums[1 - side % 2] * (1.0 - MARGIN);
            *low = low.max(needed - high[(side + 2) % 4] - MARGIN);
        }
        cell.offsets.iter().all(|[low, high]| low <= high).then_some(cell)
    }

    /// Ranges of heights above sides 0 and 1 that hold corner 0, 1, 2 or 3 of all rectangles, or their center.
    pub(super) fn place(&self, point: usize) -> [[f64; 2]; 2] {
        let opposite = |side: usize| self.offsets[side].map(|x| -x);
        let ranges = [0, 1].map(|k| [self.offsets[k], [opposite(k + 2)[1], opposite(k + 2)[0]]]);
        match point {
            0 => [ranges[0][0], ranges[1][0]],
            1 => [ranges[0][1], ranges[1][0]],
            2 => [ranges[0][1], ranges[1][1]],
            3 => [ranges[0][0], ranges[1][1]],
            _ => ranges.map(|[one, other]| [0, 1].map(|end| 0.5 * (one[end] + other[end]))),
        }
    }

    /// Ranges of heights above sides 0 and 1 that hold all rectangles.
    pub(super) fn hull(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|k| [-self.offsets[k + 2][1], self.offsets[k][1]])
    }

    /// Whether an edge surely does not come to a place.
    pub(super) fn is_apart(&self, place: &[[f64; 2]; 2], edge: [[f64; 2]; 2]) -> bool {
        place.iter().enumerate().any(|(side, [low, high])| {
            let heights = edge.map(|w| self.heights(side, w));
            heights.iter().all(|range| range[1] < low - 2.0 * MARGIN)
                || heights.iter().all(|range| range[0] > high + 2.0 * MARGIN)
        }) || self.is_beside_line(place, edge)
    }

    /// Whether a place surely lies on one side of the line of an edge.
    ///
    /// With a normal whose largest coordinate is 1 in size, n·p − h for p = (x·u₀ + y·u₁)/(1 + m²), times 1 + m², has the errors of
    /// some ten products of numbers up to 4.5.
    fn is_beside_line(&self, place: &[[f64; 2]; 2], [a, b]: [[f64; 2]; 2]) -> bool {
        let across = [b[1] - a[1], a[0] - b[0]];
        let size = across[0].abs().max(across[1].abs());
        let excess = |sign: f64, x: f64, y: f64| {
            let normal = across.map(|part| sign * part / size);
            let offset = normal[0] * a[0] + normal[1] * a[1];
            let ([c0, c1], [d0, d1]) = (height_parts(0, normal), height_parts(1, normal));
            largest([x * c0 + y * d0 - offset, x * c1 + y * d1, -offset], self.slopes)
        };
        // An edge of no length has no line: NaN is not below.
        [1.0, -1.0].into_iter().any(|sign| {
            place[0].iter().all(|&x| place[1].iter().all(|&y| excess(sign, x, y) < -8.0 * MARGIN))
        })
    }

    /// A point of a place, up to rounding.
    pub(super) fn point_of(&self, place: &[[f64; 2]; 2]) -> [f64; 2] {
        let slope = 0.5 * (self.slopes[0] + self.slopes[1]);
        let [x, y] = place.map(|[low, high]| 0.5 * (low + high));
        let square = 1.0 + slope * slope;
        [(x - slope * y) / square, (y + slope * x) / square]
    }
}

/// The largest value of a polynomial of degree 2 in a range.
pub(super) fn largest([c0, c1, c2]: [f64; 3], [from, to]: [f64; 2]) -> f64 {
    let at = |m: f64| c0 + m * (c1 + m * c2);
    let ends = [at(from), at(to)];
    let most = if ends[0] >= ends[1] { ends[0] } else { ends[1] };
    let top = -0.5 * c1 / c2;
    match c2 < 0.0 && from < top && top < to {
        true => most.max(at(top)),
        false => most,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_is_largest_at_its_top_or_an_end() {
        assert_eq!(largest([1.0, 2.0, -1.0], [0.0, 3.0]), 2.0);
        assert_eq!(largest([1.0, 2.0, -1.0], [2.0, 3.0]), 1.0);
        assert_eq!(largest([1.0, -2.0, 1.0], [0.0, 3.0]), 4.0);
        assert_eq!(largest([1.0, 0.0, 0.0], [-1.0, 1.0]), 1.0);
    }
}
