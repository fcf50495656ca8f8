//! The part of a crowded picture that is drawn again, large enough to see.

use super::Picture;
use super::clip::Frame;
use crate::axes::unit;

/// Beyond this many points the edges of the whole can no longer be told apart.
pub(super) const POINTS_MAX: usize = 3000;

/// A window holds this many points.
const WINDOW_POINTS: usize = 600;

/// Room around all points, as a part of their extent: Voronoi edges run on beyond the hull.
const MARGIN: f64 = 0.08;

impl Picture<'_> {
    /// Tests whether there are more points than an eye can tell apart, or than may be drawn.
    pub(super) fn is_crowded(&self) -> bool {
        self.places.len() > POINTS_MAX.min(self.options.max_points)
    }

    /// The square around the middle of crowded points that holds some [`WINDOW_POINTS`] distinct ones; `None` if all can be seen,
    /// or if so many are equally far from the middle that there is no such square.
    pub(super) fn window(&self) -> Option<Frame> {
        if !self.is_crowded() {
            return None;
        }
        let n = self.places.len();
        let unit = unit(self.places.iter().flatten().copied());
        let middle = [0, 1].map(|k| {
            let mut along: Vec<f64> = self.places.iter().map(|at| at[k] / unit).collect();
            *along.select_nth_unstable_by(n / 2, f64::total_cmp).1
        });
        let reach =
            |at: &[f64; 3]| (at[0] / unit - middle[0]).abs().max((at[1] / unit - middle[1]).abs());
        let distinct = self.distinct();
        let reaches = distinct.iter().map(|&id| reach(&self.places[id as usize]));
        // The middle itself reaches nowhere; a window needs a width.
        let mut reaches: Vec<f64> = reaches.filter(|&r| r > 0.0).collect();
        let most = self.options.max_points;
        let place = WINDOW_POINTS.min(most.saturating_sub(2)).min(reaches.len().checked_sub(1)?);
        let half = *reaches.select_nth_unstable_by(place, f64::total_cmp).1;
        let frame = Frame {
            low: middle.map(|x| (x - half) * unit),
            high: middle.map(|x| (x + half) * unit),
        };
        (self.within(&frame).len() <= most).then_some(frame)
    }

    /// The distinct points in a window, ascending.
    pub(super) fn within(&self, frame: &Frame) -> Vec<u32> {
        let mut ids = self.distinct();
        ids.retain(|&id| {
            let [x, y, _] = self.places[id as usize];
            frame.holds([x, y])
        });
        ids
    }

    /// All points that equal no earlier one, ascending.
    fn distinct(&self) -> Vec<u32> {
        let mut is_copy = vec![false; self.places.len()];
        for [copy, _] in &self.answer().duplicates {
            is_copy[*copy as usize] = true;
        }
        (0..is_copy.len() as u32).filter(|&id| !is_copy[id as usize]).collect()
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
