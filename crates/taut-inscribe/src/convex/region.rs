//! A convex polygon, as the intersection of half-planes and by its corners.

/// A half-plane {p : n·p ≤ h}; n has the length 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Side {
    pub(super) normal: [f64; 2],
    pub(super) offset: f64,
}

impl Side {
    /// The half-plane with a point on its border.
    pub(super) fn through(point: [f64; 2], normal: [f64; 2]) -> Option<Self> {
        let length = normal[0].hypot(normal[1]);
        let normal = normal.map(|x| x / length);
        let offset = dot(normal, point);
        (length > 0.0 && offset.is_finite()).then_some(Side { normal, offset })
    }

    /// How far a point is outside; below 0 inside.
    pub(super) fn excess(&self, p: [f64; 2]) -> f64 {
        dot(self.normal, p) - self.offset
    }

    /// The least excess in a box, which rounding makes no larger than that of any point there.
    pub(super) fn least_excess(&self, [low, high]: &[[f64; 2]; 2]) -> f64 {
        self.excess([0, 1].map(|k| if self.normal[k] > 0.0 { low[k] } else { high[k] }))
    }
}

/// Corners in counterclockwise order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Region {
    pub(super) corners: Vec<[f64; 2]>,
}

/// Centroid and second moments about it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    pub(super) centroid: [f64; 2],
    /// The means of x², xy and y².
    pub(super) second: [f64; 3],
}

impl Region {
    /// The rectangle between two corners.
    pub(super) fn rectangle(low: [f64; 2], high: [f64; 2]) -> Self {
        Region { corners: vec![low, [high[0], low[1]], high, [low[0], high[1]]] }
    }

    /// The part in a half-plane; without corners if there is none.
    pub(super) fn clipped(&self, side: &Side) -> Self {
        let corners = &self.corners;
        let mut kept = Vec::with_capacity(corners.len() + 1);
        for (i, &p) in corners.iter().enumerate() {
            let q = corners[if i + 1 == corners.len() { 0 } else { i + 1 }];
            let (here, there) = (side.excess(p), side.excess(q));
            if here <= 0.0 {
                kept.push(p);
            }
            if (here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0) {
                let share = here / (here - there);
                kept.push([0, 1].map(|k| p[k] + share * (q[k] - p[k])));
            }
        }
        match kept.len() {
            0..3 => Region::default(),
            _ => Region { corners: kept },
        }
    }

    /// The part in all of some half-planes.
    pub(super) fn within(&self, sides: &[Side]) -> Self {
        sides.iter().fold(self.clone(), |region, side| region.clipped(side))
    }

    pub(super) fn area(&self) -> f64 {
        let Some(&first) = self.corners.first() else { return 0.0 };
        let pairs = self.corners.windows(2);
        pairs.map(|pair| 0.5 * cross(minus(pair[0], first), minus(pair[1], first))).sum()
    }

    /// The smallest rectangle around it.
    pub(super) fn bounds(&self) -> [[f64; 2]; 2] {
        let all = self.corners.iter();
        all.fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], p| {
            [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
        })
    }

    /// `None` without area.
    pub(super) fn moments(&self) -> Option<Moments> {
        let &first = self.corners.first()?;
        let (mut area, mut sum, mut squares) = (0.0, [0.0; 2], [0.0; 3]);
        for pair in self.corners.windows(2) {
            // The triangle of 0, u and v, with the first corner as 0.
            let (u, v) = (minus(pair[0], first), minus(pair[1], first));
            let piece = 0.5 * cross(u, v);
            area += piece;
            for k in 0..2 {
                sum[k] += piece * (u[k] + v[k]) / 3.0;
            }
            for (square, (i, j)) in squares.iter_mut().zip([(0, 0), (0, 1), (1, 1)]) {
                let mixed = 0.5 * (u[i] * v[j] + u[j] * v[i]);
                *square += piece * (u[i] * u[j] + v[i] * v[j] + mixed) / 6.0;
            }
        }
        if area.is_nan() || area <= 0.0 {
            return None;
        }
        let mean = sum.map(|x| x / area);
        let centroid = [first[0] + mean[0], first[1] + mean[1]];
        let [xx, xy, yy] = squares.map(|x| x / area);
        let second = [xx - mean[0] * mean[0], xy - mean[0] * mean[1], yy - mean[1] * mean[1]];
        Some(Moments { centroid, second })
    }

    /// The part of a segment that is farther inside than `depth`.
    pub(super) fn inner_part(
        sides: impl Iterator<Item = Side>,
        [a, b]: [[f64; 2]; 2],
        depth: f64,
    ) -> Option<[[f64; 2]; 2]> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for side in sides {
            let (here, there) = (side.excess(a) + depth, side.excess(b) + depth);
            if here >= 0.0 && there >= 0.0 {
                return None;
            }
            let share = here / (here - there);
            if here > 0.0 {
                from = from.max(share);
            } else if there > 0.0 {
                to = to.min(share);
            }
            if from >= to {
                return None;
            }
        }
        let at = |share: f64| [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
        Some([if from > 0.0 { at(from) } else { a }, if to < 1.0 { at(to) } else { b }])
    }
}

pub(super) fn dot(u: [f64; 2], v: [f64; 2]) -> f64 {
    u[0] * v[0] + u[1] * v[1]
}

pub(super) fn cross(u: [f64; 2], v: [f64; 2]) -> f64 {
    u[0] * v[1] - u[1] * v[0]
}

pub(super) fn minus(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    [p[0] - q[0], p[1] - q[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_of_the_integrals() {
        let region = Region::rectangle([1.0, 2.0], [4.0, 4.0]);
        let found = region.moments().unwrap();
        assert_eq!(found.centroid, [2.5, 3.0]);
        for (second, expected) in found.second.into_iter().zip([9.0 / 12.0, 0.0, 4.0 / 12.0]) {
            assert!((second - expected).abs() < 1e-14, "{second} for {expected}");
        }
    }

    #[test]
    fn half_planes_cut_areas() {
        let square = Region::rectangle([0.0, 0.0], [2.0, 2.0]);
        let diagonal = Side::through([1.0, 1.0], [1.0, 1.0]).unwrap();
        assert!((square.clipped(&diagonal).area() - 2.0).abs() < 1e-14);
        let apart = Side::through([-1.0, 0.0], [1.0, 0.0]).unwrap();
        assert_eq!(square.clipped(&apart), Region::default());
        assert_eq!(Side::through([0.0, 0.0], [0.0, 0.0]), None);
    }

    #[test]
    fn only_what_is_deep_inside_counts() {
        let sides = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]]
            .map(|normal| Side { normal, offset: 1.0 });
        let part = |edge, depth| Region::inner_part(sides.into_iter(), edge, depth);
        assert_eq!(part([[-2.0, 0.0], [2.0, 0.0]], 0.0), Some([[-1.0, 0.0], [1.0, 0.0]]));
        assert_eq!(part([[-2.0, 0.9], [2.0, 0.9]], 0.2), None);
        assert_eq!(part([[1.0, -1.0], [1.0, 1.0]], 0.0), None);
        assert_eq!(part([[0.0, 0.5], [0.0, 0.25]], 0.0), Some([[0.0, 0.5], [0.0, 0.25]]));
    }
}
