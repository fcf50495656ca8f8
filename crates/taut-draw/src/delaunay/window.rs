//! The part of a crowded picture that is drawn again, large enough to see.

use super::Picture;
use super::clip::Frame;
use crate::axes::unit;

/// Beyond so many points the edges of the whole can no longer be told apart.
pub(super) const CROWDED: usize = 3000;

/// Points in a window.
const WITHIN: usize = 600;

/// Room around all points, as a part of their extent: Voronoi edges run on beyond the hull.
const MARGIN: f64 = 0.08;

impl Picture<'_> {
    /// The square around the middle of the points that holds some [`WITHIN`] of them; `None` if all of them can be seen.
    pub(super) fn window(&self) -> Option<Frame> {
        let n = self.places.len();
        if n <= CROWDED {
            return None;
        }
        let unit = unit(self.places.iter().flatten().copied());
        let middle = [0, 1].map(|k| {
            let mut along: Vec<f64> = self.places.iter().map(|at| at[k] / unit).collect();
            *along.select_nth_unstable_by(n / 2, f64::total_cmp).1
        });
        let reach =
            |at: &[f64; 3]| (at[0] / unit - middle[0]).abs().max((at[1] / unit - middle[1]).abs());
        // Copies of the middle reach nowhere; a window needs a width.
        let mut reaches: Vec<f64> = self.places.iter().map(reach).filter(|&r| r > 0.0).collect();
        let place = WITHIN.min(reaches.len().checked_sub(1)?);
        let half = *reaches.select_nth_unstable_by(place, f64::total_cmp).1;
        Some(Frame {
            low: middle.map(|x| (x - half) * unit),
            high: middle.map(|x| (x + half) * unit),
        })
    }

    /// The box of all points, with room around it.
    pub(super) fn frame(&self) -> Frame {
        let unit = unit(self.places.iter().flatten().copied());
        let ends = [0, 1].map(|k| {
            let along = self.places.iter().map(|at| at[k] / unit);
            along.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
        });
        let room = ends.iter().map(|(low, high)| MARGIN * (high - low)).fold(0.0, f64::max);
        Frame {
            low: ends.map(|(low, _)| (low - room) * unit),
            high: ends.map(|(_, high)| (high + room) * unit),
        }
    }
}
