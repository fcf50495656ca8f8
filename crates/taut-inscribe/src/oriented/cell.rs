//! Cells: ranges of the slope m and of the four offsets s₀ to s₃ of a rectangle.
//!
//! A rectangle is {q : uₖ·q ≤ sₖ for k = 0, 1, 2, 3} with u₀ = (1, m) and each next normal a quarter turn further, m in [−1, 1]. The
//! *height* of a point above side k is uₖ·q. The area is (s₀ + s₂)(s₁ + s₃)/(1 + m²).

use taut_points::two_to;

use crate::polygon::Segment;

/// Place of the slope among the five coordinates.
pub(super) const SLOPE: usize = 4;

/// Largest offset in size at the root: heights are below √2·√2 in size.
const OFFSET_MAX: f64 = 2.25;

/// How surely one number has to be below another, in units, besides errors of coordinates: 2⁻⁴², twice
/// that of a checker.
pub(super) const MARGIN: f64 = two_to(-42);

/// The height of a point above a side is the first number plus m times the second.
pub(super) fn height_parts(side: usize, w: [f64; 2]) -> [f64; 2] {
    match side {
        0 => w,
        1 => [w[1], -w[0]],
        2 => [-w[0], -w[1]],
        _ => [-w[1], w[0]],
    }
}

/// The height of a point above a side of a rectangle with a slope.
pub(super) fn height(side: usize, slope: f64, w: [f64; 2]) -> f64 {
    let [constant, linear] = height_parts(side, w);
    constant + slope * linear
}

/// Ranges of the four offsets and of the slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub(super) low: [f64; 5],
    pub(super) high: [f64; 5],
}

impl Cell {
    /// All rectangles.
    pub(super) fn root() -> Self {
        let mut high = [OFFSET_MAX; 5];
        high[SLOPE] = 1.0;
        Cell { low: high.map(|x| -x), high }
    }

    pub(super) fn slopes(&self) -> [f64; 2] {
        [self.low[SLOPE], self.high[SLOPE]]
    }

    /// The least and the largest height of a point above a side.
    pub(super) fn heights(&self, side: usize, w: [f64; 2]) -> [f64; 2] {
        let [one, other] = self.slopes().map(|slope| height(side, slope, w));
        [one.min(other), one.max(other)]
    }

    /// The least 1 + m².
    pub(super) fn least_square(&self) -> f64 {
        let [low, high] = self.slopes();
        let least = if low <= 0.0 && high >= 0.0 { 0.0 } else { low.abs().min(high.abs()) };
        1.0 + least * least
    }

    /// A bound of the area of all rectangles of the cell, which a checker finds in spite of its rounding.
    pub(super) fn hull_area(&self) -> f64 {
        let sums = [0, 1].map(|k| (self.high[k] + self.high[k + 2]).max(0.0));
        (sums[0] * sums[1] + 4.0 * MARGIN) / self.least_square() * (1.0 + 8.0 * f64::EPSILON)
    }

    /// The ranges that rectangles of more than an area have whose sides are no farther out than the polygon is; `None` if there are none.
    pub(super) fn contracted(&self, extents: &[f64; 4], area: f64) -> Option<Cell> {
        let mut cell = *self;
        for (high, extent) in cell.high.iter_mut().zip(extents) {
            *high = high.min(extent + MARGIN);
        }
        let sums = [0, 1].map(|k| cell.high[k] + cell.high[k + 2]);
        if sums[0] <= 0.0 || sums[1] <= 0.0 {
            return None;
        }
        let least = area * self.least_square() * (1.0 - MARGIN);
        for side in 0..4 {
            let needed = least / sums[1 - side % 2] - cell.high[(side + 2) % 4] - MARGIN;
            cell.low[side] = cell.low[side].max(needed);
        }
        (0..4).all(|side| cell.low[side] <= cell.high[side]).then_some(cell)
    }

    /// Where a point of the rectangles is, by ranges of its heights above sides 0 and 1: corner k between sides k and k + 1, or the
    /// center.
    pub(super) fn place(&self, point: usize) -> [[f64; 2]; 2] {
        let range = |side: usize| match side {
            0 | 1 => [self.low[side], self.high[side]],
            _ => [-self.high[side], -self.low[side]],
        };
        match point {
            0 => [range(0), range(1)],
            1 => [range(2), range(1)],
            2 => [range(2), range(3)],
            3 => [range(0), range(3)],
            _ => [0, 1].map(|k| {
                let (one, other) = (range(k), range(k + 2));
                [0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])]
            }),
        }
    }

    /// What all rectangles of the cell lie in, by ranges of heights above sides 0 and 1.
    pub(super) fn hull(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|k| [-self.high[k + 2], self.high[k]])
    }

    /// Whether an edge surely does not come to a place.
    pub(super) fn is_apart(&self, place: &[[f64; 2]; 2], [a, b]: Segment, error: f64) -> bool {
        (0..2).any(|side| {
            let (of_a, of_b) = (self.heights(side, a), self.heights(side, b));
            let [low, high] = place[side];
            of_a[1].max(of_b[1]) < low - error || of_a[0].min(of_b[0]) > high + error
        }) || self.is_beside_line(place, [a, b], error)
    }

    /// Whether a place surely lies on one side of the line of an edge.
    fn is_beside_line(&self, place: &[[f64; 2]; 2], [a, b]: Segment, error: f64) -> bool {
        let across = [b[1] - a[1], a[0] - b[0]];
        let size = across[0].abs().max(across[1].abs());
        [size, -size].into_iter().any(|size| {
            let normal = across.map(|x| x / size);
            let offset = normal[0] * a[0] + normal[1] * a[1];
            let parts = [0, 1].map(|side| height_parts(side, normal));
            // With p = (x·u₀ + y·u₁)/(1 + m²): n·p < h.
            (0..4).all(|corner| {
                let p = [place[0][corner & 1], place[1][corner >> 1]];
                let of_part = |part: usize| p[0] * parts[0][part] + p[1] * parts[1][part];
                let polynomial = [of_part(0) - offset, of_part(1), -offset];
                largest_value(polynomial, self.slopes()) < -4.0 * error
            })
        })
    }

    /// The middle of a coordinate.
    pub(super) fn middle(&self, coordinate: usize) -> f64 {
        0.5 * self.low[coordinate] + 0.5 * self.high[coordinate]
    }

    pub(super) fn half(&self, coordinate: usize) -> f64 {
        0.5 * (self.high[coordinate] - self.low[coordinate])
    }

    /// The halves of a range; `None` where rounding leaves no middle.
    pub(super) fn halves(&self, coordinate: usize) -> Option<[Cell; 2]> {
        let at = self.middle(coordinate);
        let (mut below, mut above) = (*self, *self);
        (below.high[coordinate], above.low[coordinate]) = (at, at);
        (self.low[coordinate] < at && at < self.high[coordinate]).then_some([below, above])
    }
}

/// The largest value of c₀ + c₁m + c₂m² in a range of m.
pub(super) fn largest_value([c0, c1, c2]: [f64; 3], [from, to]: [f64; 2]) -> f64 {
    let at = |m: f64| c0 + m * (c1 + m * c2);
    let most = at(from).max(at(to));
    let top = -0.5 * c1 / c2;
    if c2 < 0.0 && from < top && top < to { most.max(at(top)) } else { most }
}

/// The point with heights above sides 0 and 1.
pub(super) fn point_at(slope: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    let square = 1.0 + slope * slope;
    [(x - slope * y) / square, (y + slope * x) / square]
}
