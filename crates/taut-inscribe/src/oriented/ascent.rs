//! A local optimum, by linear programs in a region of trust.
//!
//! *Idea.* Each edge near the rectangle is kept apart from it by a line: a side, beyond which both ends stay, or the line of the edge, on one
//! side of which the corners stay. The line with the most room is taken. The best step is scaled about its center until no edge enters;
//! a step that does not hold what it promises shrinks the region.

use crate::polygon::Segment;
use crate::program::{self, Column};

use super::cell::{SLOPE, height, point_at};
use super::rows::Terms;

/// Most steps of an ascent.
const STEPS_MAX: usize = 60;

/// First and largest change of an offset, in half sides.
const TRUST: (f64, f64) = (0.1, 0.3);

/// Region of trust below which an ascent ends.
const TRUST_MIN: f64 = 1e-10;

/// How many regions of trust an edge may be away to have a condition.
const TRUSTS_AWAY: f64 = 6.0;

/// A rectangle by its offsets and its slope.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) at: [f64; 5],
    pub(super) area: f64,
}

impl Candidate {
    /// The rectangle with offsets and a slope; `None` if it has no inside.
    pub(super) fn of(at: [f64; 5]) -> Option<Self> {
        let sums = [at[0] + at[2], at[1] + at[3]];
        let area = sums[0] * sums[1] / (1.0 + at[SLOPE] * at[SLOPE]);
        (sums[0] > 0.0 && sums[1] > 0.0 && area > 0.0).then_some(Candidate { at, area })
    }

    pub(super) fn center(&self) -> [f64; 2] {
        point_at(self.at[SLOPE], [0, 1].map(|k| 0.5 * (self.at[k] - self.at[k + 2])))
    }

    /// The largest image from the center, up to a scale, that none of the edges enters.
    pub(super) fn freed(&self, edges: impl Iterator<Item = Segment>, most: f64) -> Option<Self> {
        let scale = edges.fold(most, |least, edge| least.min(self.reach(edge)));
        let mut at = self.at;
        for k in 0..2 {
            let (middle, half) = (0.5 * (at[k] - at[k + 2]), 0.5 * (at[k] + at[k + 2]));
            at[k] = middle + scale * half;
            at[k + 2] = scale * half - middle;
        }
        Candidate::of(at)
    }

    /// The scale from the center at which the rectangle reaches an edge.
    fn reach(&self, edge: Segment) -> f64 {
        let [a, b] = edge.map(|w| {
            [0, 1].map(|k| {
                let (middle, half) =
                    (0.5 * (self.at[k] - self.at[k + 2]), 0.5 * (self.at[k] + self.at[k + 2]));
                (height(k, self.at[SLOPE], w) - middle) / half
            })
        });
        // The larger of |x| and |y| is convex along the edge, and least at an end or where one of these is 0.
        let crossings =
            [(a[0], b[0]), (a[1], b[1]), (a[0] - a[1], b[0] - b[1]), (a[0] + a[1], b[0] + b[1])];
        let inner = crossings.map(|(of_a, of_b)| (of_a / (of_a - of_b)).clamp(0.0, 1.0));
        let size = |share: f64| {
            let p = [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
            p[0].abs().max(p[1].abs())
        };
        // An edge parallel to such a line has no crossing: NaN is the least of no two numbers.
        inner.into_iter().map(size).fold(size(0.0).min(size(1.0)), f64::min)
    }

    /// Returns a local optimum, or a rectangle near one.
    pub(super) fn climbed(self, edges: &[Segment]) -> Self {
        let Some(mut best) = self.freed(edges.iter().copied(), f64::INFINITY) else { return self };
        let mut trust = TRUST.0;
        for _ in 0..STEPS_MAX {
            let at = best.at;
            let half = best.half(trust);
            let columns = best.columns(edges, trust, &half);
            let mut target = [0.0; 5];
            for k in 0..4 {
                target[k] = half[k] * (at[(k + 1) % 4] + at[(k + 3) % 4]);
            }
            target[SLOPE] = -2.0 * best.area * at[SLOPE] * half[SLOPE];
            let found = program::best(&columns, &target, f64::NEG_INFINITY);
            let promised = found.value / (1.0 + at[SLOPE] * at[SLOPE]);
            if promised.is_nan() || promised <= best.area * TRUST_MIN {
                break;
            }
            let mut next = at;
            for k in 0..5 {
                next[k] += half[k] * found.step[k];
            }
            let next = Candidate::of(next)
                .filter(|next| next.at[SLOPE].abs() <= 1.0)
                .and_then(|next| next.freed(edges.iter().copied(), f64::INFINITY));
            let held = next.map_or(f64::NEG_INFINITY, |next| next.area - best.area);
            if held > 0.7 * promised {
                trust = (2.0 * trust).min(TRUST.1);
            } else if held < 0.3 * promised {
                trust *= 0.35;
            }
            if let Some(next) = next.filter(|_| held > 0.0) {
                best = next;
            }
            if trust < TRUST_MIN {
                break;
            }
        }
        best
    }

    /// The largest changes of the coordinates in a region of trust.
    fn half(&self, trust: f64) -> [f64; 5] {
        let halves = [0, 1].map(|k| 0.5 * (self.at[k] + self.at[k + 2]));
        let turn = halves[0].min(halves[1]) / halves[0].max(halves[1]);
        let [one, other] = halves.map(|half| trust * half);
        [one, other, one, other, (trust * turn).min(0.5)]
    }

    /// The conditions of the edges near the rectangle.
    fn columns(&self, edges: &[Segment], trust: f64, half: &[f64; 5]) -> Vec<Column<5>> {
        let at = &self.at;
        let m = at[SLOPE];
        let away = TRUSTS_AWAY * trust * 0.5 * (at[0] + at[2]).max(at[1] + at[3]);
        let signed = |side: usize| if side < 2 { at[side] } else { -at[side] };
        let corners =
            [[0, 1], [2, 1], [2, 3], [0, 3]].map(|[x, y]| point_at(m, [signed(x), signed(y)]));
        let length = (1.0 + m * m).sqrt();
        let mut found = vec![];
        let mut push = |terms: Terms| {
            let gradient = terms.gradient(at);
            let gradient = [0, 1, 2, 3, 4].map(|k| -gradient[k] * half[k]);
            found.push(Column::new(-terms.value(at), gradient));
        };
        for &[a, b] in edges {
            let (mut room, mut side) = (f64::NEG_INFINITY, 0);
            for k in 0..4 {
                let rooms = [a, b].map(|w| (height(k, m, w) - at[k]) / length);
                if rooms[0].min(rooms[1]) > room {
                    (room, side) = (rooms[0].min(rooms[1]), k);
                }
            }
            let across = [b[1] - a[1], a[0] - b[0]];
            let size = across[0].hypot(across[1]);
            let mut line = None;
            for sign in [1.0, -1.0] {
                let normal = across.map(|x| sign * x / size);
                let offset = normal[0] * a[0] + normal[1] * a[1];
                let rooms = corners.map(|p| offset - normal[0] * p[0] - normal[1] * p[1]);
                let least = rooms.into_iter().fold(f64::INFINITY, f64::min);
                if least > room {
                    room = least;
                    line = Some((normal, offset));
                }
            }
            if room > away {
                continue;
            }
            match line {
                Some((normal, offset)) => {
                    (0..4).for_each(|corner| push(Terms::of_corner(corner, normal, offset)));
                }
                None => [a, b].into_iter().for_each(|w| push(Terms::of_point(side, w))),
            }
        }
        found.retain(Column::can_bind);
        found
    }
}

/// Rectangles of several shapes and directions around a point.
pub(super) fn around(center: [f64; 2]) -> impl Iterator<Item = Candidate> {
    /// Slopes tried, evenly in the angle.
    const TURN_ANGLES_TRIED: usize = 8;
    /// Ratios of the half sides tried.
    const RATIOS: [f64; 5] = [1.0, 2.5, 0.4, 7.0, 1.0 / 7.0];
    (0..TURN_ANGLES_TRIED).flat_map(move |turn| {
        let angle =
            std::f64::consts::FRAC_PI_2 * ((turn as f64 + 0.5) / TURN_ANGLES_TRIED as f64 - 0.5);
        let slope = angle.tan();
        RATIOS.into_iter().filter_map(move |ratio| {
            let [x, y] = [height(0, slope, center), height(1, slope, center)];
            Candidate::of([x + ratio, y + 1.0, ratio - x, 1.0 - y, slope])
        })
    })
}

/// Rectangles around a point along the longest edge and along the axis of least inertia of the vertices, as long and as wide as the
/// polygon is there, and less long: in a thin polygon those of fixed directions and ratios are tiny.
pub(super) fn along(edges: &[Segment], center: [f64; 2]) -> impl Iterator<Item = Candidate> {
    slopes_of(edges).into_iter().flat_map(move |slope| {
        let [x, y] = [height(0, slope, center), height(1, slope, center)];
        let reach = [0, 1, 2, 3].map(|side| {
            edges.iter().fold(0.0f64, |most, edge| most.max(height(side, slope, edge[0])))
        });
        let ratio = (reach[0] + reach[2]) / (reach[1] + reach[3]);
        [ratio, ratio.sqrt()]
            .into_iter()
            .filter_map(move |ratio| Candidate::of([x + ratio, y + 1.0, ratio - x, 1.0 - y, slope]))
    })
}

/// The slopes of the longest edge and of the axis of least inertia.
fn slopes_of(edges: &[Segment]) -> [f64; 2] {
    let (mut longest, mut length, mut moments) = ([1.0, 0.0], 0.0, [0.0; 3]);
    let count = edges.len() as f64;
    let mean = [0, 1].map(|k| edges.iter().map(|edge| edge[0][k]).sum::<f64>() / count);
    for [a, b] in edges {
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
        if dx.hypot(dy) > length {
            (longest, length) = ([dx, dy], dx.hypot(dy));
        }
        let [x, y] = [a[0] - mean[0], a[1] - mean[1]];
        moments = [moments[0] + x * x, moments[1] + x * y, moments[2] + y * y];
    }
    let angle = 0.5 * (2.0 * moments[1]).atan2(moments[0] - moments[2]);
    let slope = |[dx, dy]: [f64; 2]| if dx.abs() >= dy.abs() { dy / dx } else { -dx / dy };
    [slope(longest), slope([angle.cos(), angle.sin()])]
}
