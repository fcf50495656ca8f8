//! The part of a segment or a ray that lies in a box, by the parameters at which it enters and leaves (Liang and Barsky, ACM
//! Transactions on Graphics 3(1), 1984).

/// A box of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
}

impl Frame {
    /// The corners, counter-clockwise.
    pub(super) fn corners(&self) -> [[f64; 2]; 4] {
        let ([a, b], [c, d]) = (self.low, self.high);
        [[a, b], [c, b], [c, d], [a, d]]
    }

    pub(super) fn holds(&self, at: [f64; 2]) -> bool {
        (0..2).all(|k| self.low[k] <= at[k] && at[k] <= self.high[k])
    }

    pub(super) fn segment(&self, a: [f64; 2], b: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        self.part(a, [b[0] - a[0], b[1] - a[1]], 1.0)
    }

    /// The part of the ray that begins at `from`.
    pub(super) fn ray(&self, from: [f64; 2], along: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        self.part(from, along, f64::INFINITY)
    }

    /// Of the points from + t · along with 0 ≤ t ≤ `most`, the first and the last in the box.
    fn part(&self, from: [f64; 2], along: [f64; 2], most: f64) -> Option<[[f64; 2]; 2]> {
        if !from.iter().chain(&along).all(|x| x.is_finite()) {
            return None;
        }
        let (mut enter, mut leave) = (0.0_f64, most);
        for k in 0..2 {
            if along[k] == 0.0 {
                if from[k] < self.low[k] || from[k] > self.high[k] {
                    return None;
                }
                continue;
            }
            let [a, b] = [self.low[k], self.high[k]].map(|bound| (bound - from[k]) / along[k]);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        let at = |t: f64| [0, 1].map(|k| from[k] + t * along[k]);
        (enter < leave && leave.is_finite()).then(|| [at(enter), at(leave)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_and_rays_end_at_the_box() {
        let frame = Frame { low: [0.0, 0.0], high: [2.0, 1.0] };
        assert_eq!(frame.segment([-1.0, 0.5], [3.0, 0.5]), Some([[0.0, 0.5], [2.0, 0.5]]));
        assert_eq!(frame.segment([0.5, 0.5], [1.0, 0.5]), Some([[0.5, 0.5], [1.0, 0.5]]));
        assert_eq!(frame.segment([-1.0, 2.0], [3.0, 2.0]), None);
        assert_eq!(frame.segment([-2.0, 0.0], [0.0, 2.5]), None);
        assert_eq!(frame.ray([1.0, 0.5], [0.0, -3.0]), Some([[1.0, 0.5], [1.0, 0.0]]));
        assert_eq!(frame.ray([3.0, 0.5], [1.0, 0.0]), None);
        for bad in [f64::NAN, f64::INFINITY] {
            assert_eq!(frame.ray([bad, 0.5], [1.0, 0.0]), None);
            assert_eq!(frame.segment([bad, bad], [1.0, 0.0]), None);
        }
    }
}
