//! Rectangles, and boxes of rectangles.

use taut_predicates::plane::orient;

use crate::polygon::Segment;

/// A rectangle along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
}

/// The four coordinates that a rectangle has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Axis {
    Left,
    Bottom,
    Right,
    Top,
}

impl Axis {
    pub(super) const ALL: [Axis; 4] = [Axis::Left, Axis::Bottom, Axis::Right, Axis::Top];

    /// The coordinate: 0 for x.
    fn coordinate(self) -> usize {
        usize::from(matches!(self, Axis::Bottom | Axis::Top))
    }

    /// Its letter in a certificate.
    pub(super) fn letter(self) -> char {
        match self {
            Axis::Left => 'l',
            Axis::Bottom => 'b',
            Axis::Right => 'r',
            Axis::Top => 't',
        }
    }
}

/// All rectangles whose lower corner is in one rectangle and whose upper corner is in another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub(super) lower: Rectangle,
    pub(super) upper: Rectangle,
}

impl Rectangle {
    /// The bounding box of edges.
    pub(super) fn around(edges: &[Segment]) -> Self {
        let fold = |most: fn(f64, f64) -> f64, k: usize| {
            edges.iter().map(|edge| edge[0][k]).reduce(most).unwrap_or_default()
        };
        Rectangle {
            low: [0, 1].map(|k| fold(f64::min, k)),
            high: [0, 1].map(|k| fold(f64::max, k)),
        }
    }

    /// The area; 0 if it is empty.
    pub(super) fn area(&self) -> f64 {
        let side = |k: usize| (self.high[k] - self.low[k]).max(0.0);
        side(0) * side(1)
    }

    pub(super) fn center(&self) -> [f64; 2] {
        [0, 1].map(|k| 0.5 * self.low[k] + 0.5 * self.high[k])
    }

    fn corners(&self) -> [[f64; 2]; 4] {
        let (low, high) = (self.low, self.high);
        [low, [high[0], low[1]], high, [low[0], high[1]]]
    }

    /// Whether an edge enters the open rectangle, by exact signs.
    pub(super) fn is_entered(&self, [a, b]: Segment) -> bool {
        let is_apart = |k: usize| {
            a[k].max(b[k]) <= self.low[k]
                || a[k].min(b[k]) >= self.high[k]
                || self.low[k] >= self.high[k]
        };
        if is_apart(0) || is_apart(1) {
            return false;
        }
        let signs = self.corners().map(|corner| orient(a, b, corner));
        signs.iter().any(|sign| sign.is_positive()) && signs.iter().any(|sign| sign.is_negative())
    }

    /// Whether an edge meets the closed rectangle, which may be a point, by exact signs.
    pub(super) fn is_met(&self, [a, b]: Segment) -> bool {
        if (0..2).any(|k| a[k].max(b[k]) < self.low[k] || a[k].min(b[k]) > self.high[k]) {
            return false;
        }
        let signs = self.corners().map(|corner| orient(a, b, corner));
        !(signs.iter().all(|sign| sign.is_positive())
            || signs.iter().all(|sign| sign.is_negative()))
    }
}

impl Cell {
    /// All rectangles in a rectangle.
    pub(super) fn of(whole: Rectangle) -> Self {
        Cell { lower: whole, upper: whole }
    }

    /// What all rectangles of the cell lie in.
    pub(super) fn hull(&self) -> Rectangle {
        Rectangle { low: self.lower.low, high: self.upper.high }
    }

    /// What all rectangles of the cell contain; empty where the ends are not in order.
    pub(super) fn core(&self) -> Rectangle {
        Rectangle { low: self.lower.high, high: self.upper.low }
    }

    /// The rectangle in the middle of the cell.
    pub(super) fn middle(&self) -> Rectangle {
        Rectangle { low: self.lower.center(), high: self.upper.center() }
    }

    /// Where the four corners of its rectangles are, counterclockwise from the lower left one.
    pub(super) fn corner_boxes(&self) -> [Rectangle; 4] {
        let (l, u, hull) = (self.lower, self.upper, self.hull());
        // Where the ranges of opposite sides overlap, they reach beyond the hull, and no corner is there.
        let mixed = |x: Rectangle, y: Rectangle| Rectangle {
            low: [x.low[0].max(hull.low[0]), y.low[1].max(hull.low[1])],
            high: [x.high[0].min(hull.high[0]), y.high[1].min(hull.high[1])],
        };
        [mixed(l, l), mixed(u, l), mixed(u, u), mixed(l, u)]
    }

    /// The range of an axis.
    fn range(&self, axis: Axis) -> [f64; 2] {
        let (k, of) = match axis {
            Axis::Left | Axis::Bottom => (axis.coordinate(), &self.lower),
            Axis::Right | Axis::Top => (axis.coordinate(), &self.upper),
        };
        [of.low[k], of.high[k]]
    }

    /// How much the range of an axis changes the area of the hull.
    pub(super) fn influence(&self, axis: Axis) -> f64 {
        let hull = self.hull();
        let other = 1 - axis.coordinate();
        let [low, high] = self.range(axis);
        (high - low) * (hull.high[other] - hull.low[other])
    }

    /// The two halves along an axis; `None` where rounding leaves no middle.
    pub(super) fn halves(&self, axis: Axis) -> Option<[Cell; 2]> {
        let [low, high] = self.range(axis);
        let middle = 0.5 * low + 0.5 * high;
        if !(low < middle && middle < high) {
            return None;
        }
        let (mut below, mut above) = (*self, *self);
        let k = axis.coordinate();
        match axis {
            Axis::Left | Axis::Bottom => {
                (below.lower.high[k], above.lower.low[k]) = (middle, middle)
            }
            Axis::Right | Axis::Top => (below.upper.high[k], above.upper.low[k]) = (middle, middle),
        }
        Some([below, above])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_on_the_border_meet_but_do_not_enter() {
        let unit = Rectangle { low: [0.0; 2], high: [1.0; 2] };
        for (edge, enters, meets) in [
            ([[0.0, 0.0], [1.0, 0.0]], false, true),
            ([[-1.0, 0.0], [2.0, 0.0]], false, true),
            ([[0.5, -1.0], [0.5, 0.0]], false, true),
            ([[0.5, -1.0], [0.5, 0.1]], true, true),
            ([[-1.0, 1.0], [1.0, -1.0]], false, true),
            ([[-1.0, 0.5], [0.5, -1.0]], false, false),
            ([[0.2, 0.2], [0.3, 0.4]], true, true),
            ([[-1.0, -1.0], [2.0, 2.0]], true, true),
            ([[2.0, 0.0], [3.0, 1.0]], false, false),
        ] {
            assert_eq!(unit.is_entered(edge), enters, "{edge:?}");
            assert_eq!(unit.is_met(edge), meets, "{edge:?}");
        }
        let point = Rectangle { low: [0.5; 2], high: [0.5; 2] };
        assert!(!point.is_entered([[0.0, 0.0], [1.0, 1.0]]));
        assert!(point.is_met([[0.0, 0.0], [1.0, 1.0]]));
    }

    #[test]
    fn all_rectangles_of_a_cell_are_between_core_and_hull() {
        let lower = Rectangle { low: [0.0, 0.0], high: [1.0, 2.0] };
        let upper = Rectangle { low: [3.0, 4.0], high: [5.0, 6.0] };
        let cell = Cell { lower, upper };
        assert_eq!(cell.core(), Rectangle { low: [1.0, 2.0], high: [3.0, 4.0] });
        assert_eq!(cell.hull(), Rectangle { low: [0.0, 0.0], high: [5.0, 6.0] });
        assert_eq!(cell.corner_boxes()[1], Rectangle { low: [3.0, 0.0], high: [5.0, 2.0] });
        let [below, above] = cell.halves(Axis::Right).unwrap();
        assert_eq!((below.hull().high[0], above.core().high[0]), (4.0, 4.0));
        assert_eq!(cell.influence(Axis::Top), 10.0);
        // The ranges of both sides overlap: no corner is below the least left side.
        let overlapping = Cell { lower, upper: Rectangle { low: [-2.0, 4.0], high: [0.5, 6.0] } };
        let boxes = overlapping.corner_boxes();
        assert_eq!(boxes[1], Rectangle { low: [0.0, 0.0], high: [0.5, 2.0] });
        assert_eq!(boxes[0], Rectangle { low: [0.0, 0.0], high: [0.5, 2.0] });
    }
}
