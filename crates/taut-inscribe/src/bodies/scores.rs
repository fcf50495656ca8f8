//! How many points a body with fixed directions covers.

use super::directions::{Directions, Offsets};

/// Points to cover, with their heights along the directions.
#[derive(Default)]
pub(super) struct Scores {
    pub(super) points: Vec<[i32; 3]>,
    /// The heights along every second direction, direction by direction.
    heights: Vec<Vec<i32>>,
}

impl Scores {
    pub(super) fn of(directions: &Directions, points: Vec<[i32; 3]>) -> Self {
        let along = |j: usize| points.iter().map(|&p| directions.along(j, p) as i32).collect();
        let heights = (0..directions.len()).step_by(2).map(along).collect();
        Scores { points, heights }
    }

    /// How many of the points are in the interior of a body.
    pub(super) fn count(&self, h: &Offsets) -> u64 {
        let mut is_in = vec![1u8; self.points.len()];
        for (pair, heights) in self.heights.iter().enumerate() {
            let (low, high) = (-h[2 * pair + 1], h[2 * pair]);
            for (is_in, &height) in is_in.iter_mut().zip(heights) {
                *is_in &= u8::from(low < height) & u8::from(height < high);
            }
        }
        is_in.iter().map(|&one| u64::from(one)).sum()
    }
}
