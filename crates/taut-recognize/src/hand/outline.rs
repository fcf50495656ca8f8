//! The outline of a set of pixels: crack following, sub-pixel refinement, smoothing and unit arc length.
//!
//! *Idea.* A crack is the edge between a pixel of the set and one outside. Following the cracks with the set on one
//! side gives a closed polygon without dead ends and cycles, so that nothing has to be cleaned.
//! *Guarantee.* The polygon of the cracks has the area of the set exactly; it is simple, except that it may touch
//! itself at a corner that two pixels of the set share diagonally.
//! *Trap.* Sampling depends on where it begins. It begins at the corner farthest from the mean of all corners, and the
//! number of samples is whole, so that a mirrored image or one turned by 90° has the same samples.

use super::mask::Mask;

/// Steps of the four directions: right, down, left, up; the set is on the side of the next one.
const STEP: [[i64; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];

/// The pixel ahead inside and the one ahead outside, relative to a corner, for each direction.
const PIXELS_AHEAD: [[[i64; 2]; 2]; 4] =
    [[[0, 0], [0, -1]], [[-1, 0], [0, 0]], [[-1, -1], [-1, 0]], [[0, -1], [-1, -1]]];

/// One edge between a pixel of a set and one outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crack {
    /// The corner at which the edge begins, in pixels.
    pub corner: [i64; 2],
    /// The pixel of the set.
    pub inside: [i64; 2],
    /// The pixel outside, which may be beyond the border of the image.
    pub outside: [i64; 2],
}

/// Follows the cracks of the 4-connected component of the first pixel of a set; empty for an empty set.
#[must_use]
pub fn follow_cracks(mask: &Mask) -> Vec<Crack> {
    let first = (0..mask.height()).find_map(|y| {
        let (index, word) = mask.row(y).iter().enumerate().find(|&(_, &word)| word != 0)?;
        Some([(64 * index) as i64 + i64::from(word.trailing_zeros()), y as i64])
    });
    let Some(start) = first else { return vec![] };
    let add = |a: [i64; 2], b: [i64; 2]| [a[0] + b[0], a[1] + b[1]];
    let is_member = |pixel: [i64; 2]| mask.contains(pixel[0], pixel[1]);
    let mut cracks = vec![];
    let (mut corner, mut direction) = (start, 0);
    loop {
        let [inside, outside] = PIXELS_AHEAD[direction].map(|offset| add(corner, offset));
        cracks.push(Crack { corner, inside, outside });
        corner = add(corner, STEP[direction]);
        let [inside, outside] = PIXELS_AHEAD[direction].map(|offset| add(corner, offset));
        // Turning to the set where the pixel ahead is outside separates diagonal pixels: the set is 4-connected.
        direction = match (is_member(inside), is_member(outside)) {
            (false, _) => (direction + 1) % 4,
            (true, false) => direction,
            (true, true) => (direction + 3) % 4,
        };
        // The corner alone may come again before the end, the corner with its direction does not.
        if corner == start && direction == 0 {
            return cracks;
        }
    }
}

/// A closed curve sampled at equal arc lengths of about one pixel; corners of the image are at whole coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    points: Vec<[f64; 2]>,
    step: f64,
}

impl Outline {
    /// Samples the curve through one point on each crack, smoothed by a Gaussian of `sigma` cracks.
    ///
    /// `level` is a function of pixels that is positive for hands and negative for background: the curve passes where
    /// it is 0 on the line through the centers of the two pixels of a crack, between these two as marching squares
    /// does, or else up to two pixels farther; where it is 0 nowhere there, as at the border of the image, the curve
    /// passes through the middle of the crack. `None` for less than 16 cracks.
    #[must_use]
    pub fn new(
        cracks: &[Crack],
        sigma: f64,
        level: impl Fn([i64; 2]) -> Option<f64>,
    ) -> Option<Self> {
        const CRACKS_MIN: usize = 16;
        if cracks.len() < CRACKS_MIN {
            return None;
        }
        let start = farthest_corner(cracks);
        let turned = cracks[start..].iter().chain(&cracks[..start]);
        let rough: Vec<[f64; 2]> = turned
            .map(|crack| {
                let share = crossing(crack, &level).unwrap_or(0.5);
                [0, 1].map(|axis| {
                    let (from, to) = (crack.inside[axis] as f64, crack.outside[axis] as f64);
                    from + 0.5 + share * (to - from)
                })
            })
            .collect();
        // The corner itself is between two cracks: followed the other way round, the curve begins at the same point.
        let mut curve = smooth(&rough, sigma);
        let corner = between(curve[curve.len() - 1], curve[0], 0.5);
        curve.insert(0, corner);
        Some(Self::sample(&curve))
    }

    /// Samples the closed polygon through some points, smoothed by a Gaussian of `sigma` points.
    #[must_use]
    pub fn smoothed(points: &[[f64; 2]], sigma: f64) -> Self {
        Self::sample(&smooth(points, sigma))
    }

    /// Samples a closed polygon at equal arc lengths of about 1.
    #[must_use]
    pub fn sample(polygon: &[[f64; 2]]) -> Self {
        let next = |index: usize| polygon[(index + 1) % polygon.len()];
        let lengths: Vec<f64> =
            (0..polygon.len()).map(|index| distance(polygon[index], next(index))).collect();
        let total: f64 = lengths.iter().sum();
        let count = (total.round() as usize).max(1);
        let step = total / count as f64;
        let (mut edge, mut before) = (0, 0.0);
        let points = (0..count)
            .map(|sample| {
                let arc = sample as f64 * step;
                while edge + 1 < polygon.len() && before + lengths[edge] <= arc {
                    before += lengths[edge];
                    edge += 1;
                }
                let share = if lengths[edge] > 0.0 { (arc - before) / lengths[edge] } else { 0.0 };
                between(polygon[edge], next(edge), share.min(1.0))
            })
            .collect();
        Self { points, step }
    }

    /// Returns the samples, in pixels.
    #[must_use]
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Returns the arc length between two samples, in pixels.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Returns the point at a place on the curve, counted in samples and taken modulo their number.
    #[must_use]
    pub fn at(&self, place: f64) -> [f64; 2] {
        let count = self.points.len();
        let place = place.rem_euclid(count as f64);
        let index = (place as usize).min(count - 1);
        between(self.points[index], self.points[(index + 1) % count], place - index as f64)
    }

    /// Returns the points from one place to a later one: both, and the samples between them.
    #[must_use]
    pub fn piece(&self, from: f64, to: f64) -> Vec<[f64; 2]> {
        let mut piece = vec![self.at(from)];
        let (first, end) = (from.floor() as i64 + 1, to.ceil() as i64);
        let count = self.points.len() as i64;
        piece.extend((first..end).map(|index| self.points[index.rem_euclid(count) as usize]));
        piece.push(self.at(to));
        piece
    }

    /// Returns the same curve, followed the other way round; place s becomes −s.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let count = self.points.len();
        let points = (0..count).map(|index| self.points[(count - index) % count]).collect();
        Self { points, step: self.step }
    }
}

/// Returns where a function of pixels becomes 0 on the line through the two pixels of a crack, 0 at the center of the
/// pixel inside and 1 at that of the pixel outside.
fn crossing(crack: &Crack, level: &impl Fn([i64; 2]) -> Option<f64>) -> Option<f64> {
    /// Pixels on each side of the crack that are looked at: the edge of a hand is blurred over as many.
    const SIDE_PIXELS: i64 = 3;
    let value = |place: i64| {
        level([0, 1].map(|c| crack.inside[c] + place * (crack.outside[c] - crack.inside[c])))
    };
    let own = value(0)?;
    let step = if own > 0.0 { 1 } else { -1 };
    let (mut place, mut before) = (0, own);
    for _ in 0..SIDE_PIXELS {
        let next = value(place + step)?;
        if (next > 0.0) != (own > 0.0) {
            return Some(place as f64 + step as f64 * (before / (before - next)));
        }
        (place, before) = (place + step, next);
    }
    None
}

/// Returns the crack whose corner is farthest from the mean of all, the first of equals.
fn farthest_corner(cracks: &[Crack]) -> usize {
    let count = cracks.len() as i128;
    let sum = |axis: usize| cracks.iter().map(|crack| i128::from(crack.corner[axis])).sum::<i128>();
    let sums = [sum(0), sum(1)];
    let offset = |crack: &Crack, axis: usize| count * i128::from(crack.corner[axis]) - sums[axis];
    let mut best = (0, -1);
    for (index, crack) in cracks.iter().enumerate() {
        let square = offset(crack, 0).pow(2) + offset(crack, 1).pow(2);
        if square > best.1 {
            best = (index, square);
        }
    }
    best.0
}

/// Smooths a closed sequence of points by a Gaussian of `sigma` places.
fn smooth(points: &[[f64; 2]], sigma: f64) -> Vec<[f64; 2]> {
    let weights = gaussian_weights(sigma);
    let count = points.len();
    let radius = (weights.len() - 1).min((count - 1) / 2);
    // The ends are repeated, so that the inner loop needs no modulo.
    let padded: Vec<[f64; 2]> =
        (0..count + 2 * radius).map(|index| points[(index + count - radius) % count]).collect();
    (0..count)
        .map(|index| {
            let own = padded[index + radius];
            [0, 1].map(|axis| {
                let sum: f64 = (1..=radius)
                    .map(|k| {
                        let (a, b) = (padded[index + radius - k], padded[index + radius + k]);
                        weights[k] * (a[axis] - own[axis] + (b[axis] - own[axis]))
                    })
                    .sum();
                own[axis] + sum
            })
        })
        .collect()
}

/// Returns half a Gaussian, center first; the whole one has the sum 1.
pub(super) fn gaussian_weights(sigma: f64) -> Vec<f64> {
    let radius = (3.0 * sigma).ceil().max(0.0) as usize;
    let raw: Vec<f64> = (0..=radius)
        .map(|k| if k == 0 { 1.0 } else { (-0.5 * (k as f64 / sigma).powi(2)).exp() })
        .collect();
    let sum = 2.0 * raw.iter().sum::<f64>() - raw[0];
    raw.iter().map(|weight| weight / sum).collect()
}

/// Returns the distance between two points.
pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    ((b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2)).sqrt()
}

/// Returns the point at a share of the way from `a` to `b`.
pub(super) fn between(a: [f64; 2], b: [f64; 2], share: f64) -> [f64; 2] {
    [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]
}

/// Returns twice the signed area of a closed polygon, positive if the set is on the side that [`follow_cracks`] has it.
#[must_use]
pub fn twice_signed_area(polygon: &[[f64; 2]]) -> f64 {
    let origin = polygon.first().copied().unwrap_or_default();
    let offset = |p: [f64; 2]| [p[0] - origin[0], p[1] - origin[1]];
    (0..polygon.len())
        .map(|index| {
            let (a, b) = (offset(polygon[index]), offset(polygon[(index + 1) % polygon.len()]));
            a[0] * b[1] - a[1] * b[0]
        })
        .sum()
}
