//! The outline of a synthetic hand as the zero of a function: parts, their distances, and how they are joined.
//!
//! Coordinates are millimeters in the frame of the hand: the wrist at the origin, fingers up, the thumb on the left.
//! *Idea.* A finger is a strip of changing width around a bent axis, with a round end; the palm and the webs are
//! polygons; joints are filled by a quarter of a circle, as skin does between fingers.

use super::random::length;

/// A part of a hand.
#[derive(Clone, Debug)]
pub(super) enum Part {
    /// A finger, or a bone of the thumb.
    Strip(Strip),
    /// A polygon grown by a radius.
    Polygon(Vec<[f64; 2]>, f64),
}

impl Part {
    /// Returns the distance of a point, negative inside, exact near the boundary only.
    pub(super) fn distance(&self, p: [f64; 2]) -> f64 {
        match self {
            Self::Strip(strip) => strip.distance(p),
            Self::Polygon(corners, radius) => distance_to_polygon(corners, p) - radius,
        }
    }
}

/// A strip of changing width around a bent axis.
#[derive(Clone, Debug)]
pub(super) struct Strip {
    pub(super) origin: [f64; 2],
    /// The direction of the axis at the origin.
    pub(super) direction: [f64; 2],
    /// Where the strip begins and where the round end has its center, along the axis.
    pub(super) range: [f64; 2],
    /// Half widths at increasing places, and their slopes.
    knots: Vec<[f64; 3]>,
    /// Places and slopes of the bends.
    bends: Vec<[f64; 2]>,
}

/// Half the length along which the axis bends at a joint, in mm.
const BEND_MM: f64 = 3.0;

impl Strip {
    /// Makes a strip with half widths at increasing places; between them the width is a cubic without corners.
    pub(super) fn new(
        origin: [f64; 2],
        direction: [f64; 2],
        range: [f64; 2],
        widths: &[[f64; 2]],
        bends: Vec<[f64; 2]>,
    ) -> Self {
        let last = widths.len() - 1;
        let knots = (0..=last)
            .map(|k| {
                let (a, b) = (widths[k.saturating_sub(1)], widths[(k + 1).min(last)]);
                // The ends are level: the round end follows without a corner.
                let slope = if k == 0 || k == last { 0.0 } else { (b[1] - a[1]) / (b[0] - a[0]) };
                [widths[k][0], widths[k][1], slope]
            })
            .collect();
        Self { origin, direction, range, knots, bends }
    }

    /// Returns the coordinates of a point along and across the direction at the origin.
    pub(super) fn local(&self, p: [f64; 2]) -> [f64; 2] {
        let (x, y) = (p[0] - self.origin[0], p[1] - self.origin[1]);
        let [c, s] = self.direction;
        [x * c + y * s, x * s - y * c]
    }

    /// Returns the place of the axis across the direction, and its slope.
    pub(super) fn axis(&self, t: f64) -> [f64; 2] {
        self.bends.iter().fold([0.0, 0.0], |[offset, slope], &[place, bend]| {
            let x = t - place;
            if x <= -BEND_MM {
                [offset, slope]
            } else if x >= BEND_MM {
                [offset + bend * x, slope + bend]
            } else {
                let into = x + BEND_MM;
                [
                    offset + bend * into * into / (4.0 * BEND_MM),
                    slope + bend * into / (2.0 * BEND_MM),
                ]
            }
        })
    }

    /// Returns half the width at a place along the axis.
    pub(super) fn half_width(&self, t: f64) -> f64 {
        let last = self.knots.len() - 1;
        if t <= self.knots[0][0] {
            return self.knots[0][1];
        }
        if t >= self.knots[last][0] {
            return self.knots[last][1];
        }
        let k = self.knots.iter().position(|knot| knot[0] > t).unwrap_or(last);
        let (a, b) = (self.knots[k - 1], self.knots[k]);
        let span = b[0] - a[0];
        let s = (t - a[0]) / span;
        let rise = s * s * (3.0 - 2.0 * s);
        a[1] + (b[1] - a[1]) * rise + span * s * (1.0 - s) * ((1.0 - s) * a[2] - s * b[2])
    }

    /// Returns a point of the plane from its coordinates along and across.
    pub(super) fn point(&self, t: f64, v: f64) -> [f64; 2] {
        let [c, s] = self.direction;
        [self.origin[0] + t * c + v * s, self.origin[1] + t * s - v * c]
    }

    /// Returns the point of the outline to which the axis leads.
    pub(super) fn tip(&self) -> [f64; 2] {
        let [offset, slope] = self.axis(self.range[1]);
        let scale = self.half_width(self.range[1]) / length(1.0, slope);
        self.point(self.range[1] + scale, offset + slope * scale)
    }

    fn distance(&self, p: [f64; 2]) -> f64 {
        let [t, v] = self.local(p);
        let inside = t.clamp(self.range[0], self.range[1]);
        let [offset, slope] = self.axis(inside);
        if inside == t {
            return ((v - offset).abs() - self.half_width(t)) / length(1.0, slope);
        }
        length(t - inside, v - offset) - self.half_width(inside)
    }
}

/// Returns the distance of a point to a polygon, negative inside.
pub(super) fn distance_to_polygon(corners: &[[f64; 2]], p: [f64; 2]) -> f64 {
    let (mut square, mut is_inside) = (f64::INFINITY, false);
    let mut a = corners[corners.len() - 1];
    for &b in corners {
        let (dx, dy, px, py) = (b[0] - a[0], b[1] - a[1], p[0] - a[0], p[1] - a[1]);
        let share = ((px * dx + py * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
        let (x, y) = (px - share * dx, py - share * dy);
        square = square.min(x * x + y * y);
        if (a[1] > p[1]) != (b[1] > p[1]) && px < dx * py / dy {
            is_inside = !is_inside;
        }
        a = b;
    }
    if is_inside { -square.sqrt() } else { square.sqrt() }
}

/// Returns the distance to the union of two parts whose corner is filled by a circle of the given radius.
pub(super) fn round_union(a: f64, b: f64, radius: f64) -> f64 {
    if a >= radius || b >= radius {
        return a.min(b);
    }
    let (x, y) = ((radius - a).max(0.0), (radius - b).max(0.0));
    a.min(b).max(radius) - length(x, y)
}

/// Parts with the radius by which each is joined to those before.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) parts: Vec<(Part, f64)>,
    /// Where the webs end along the strips of the fingers, in mm: above, fingers that touch have a sharp valley.
    pub(super) web_end: f64,
}

/// The length along which the radius of a web falls to zero, in mm.
const WEB_FADE_MM: f64 = 4.0;

impl Body {
    /// Returns the distance of a point to the union of the parts that `is_near` names.
    pub(super) fn distance(&self, p: [f64; 2], is_near: &[bool]) -> f64 {
        let mut sum = f64::INFINITY;
        for ((part, radius), _) in self.parts.iter().zip(is_near).filter(|(_, near)| **near) {
            let share = match part {
                Part::Strip(strip) => {
                    let above = strip.local(p)[0] - self.web_end;
                    (1.0 - above / WEB_FADE_MM).clamp(0.0, 1.0)
                }
                Part::Polygon(..) => 1.0,
            };
            sum = round_union(sum, part.distance(p), radius * share);
        }
        sum
    }
}
