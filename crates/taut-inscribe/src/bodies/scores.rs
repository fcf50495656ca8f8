//! How many points a body with fixed directions covers, and how many lines it hides.

use super::directions::{Directions, Offsets};
use super::lines::Line;
use super::vectors::dot;

/// Points to cover, with their heights along the directions, and lines to hide, if that is the objective.
#[derive(Default)]
pub(super) struct Scores {
    pub(super) points: Vec<[i32; 3]>,
    /// The heights along every second direction, direction by direction.
    heights: Vec<Vec<i32>>,
    lines: Option<LineScores>,
}

impl Scores {
    pub(super) fn of(
        directions: &Directions,
        points: Vec<[i32; 3]>,
        lines: Option<&[Line]>,
    ) -> Self {
        let along = |j: usize| points.iter().map(|&p| directions.along(j, p) as i32).collect();
        let heights = (0..directions.len()).step_by(2).map(along).collect();
        Scores { points, heights, lines: lines.map(|lines| LineScores::of(directions, lines)) }
    }

    /// How many of the lines, or else of the points, meet the interior of a body.
    pub(super) fn count(&self, h: &Offsets) -> u64 {
        match &self.lines {
            Some(lines) => lines.count(h),
            None => self.count_points(h),
        }
    }

    fn count_points(&self, h: &Offsets) -> u64 {
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

/// Lines that are clipped together, so that their ends stay in the cache of the first level.
const BLOCK_LINES: usize = 256;

/// The least |u·d| of a line: closer to the plane of a facet it is taken as crossing that at a small angle.
const SLOPE_MIN: f64 = 1e-6;

/// Lines as the part of each between two opposite facets: from l·a − b to h·a − b for heights l and h, in single precision, as
/// a score needs no more.
pub(super) struct LineScores {
    count: usize,
    /// The numbers a and b of each line, for every second direction.
    slabs: Vec<Vec<[f32; 2]>>,
}

impl LineScores {
    pub(super) fn of(directions: &Directions, lines: &[Line]) -> Self {
        let slab = |j: usize| {
            let u = directions.floats[j];
            let of_line = |line: &Line| {
                let slope = dot(u, line.direction);
                let slope = if slope.abs() < SLOPE_MIN { SLOPE_MIN.copysign(slope) } else { slope };
                [(1.0 / slope) as f32, (dot(u, line.point) / slope) as f32]
            };
            lines.iter().map(of_line).collect()
        };
        let slabs = (0..directions.len()).step_by(2).map(slab).collect();
        LineScores { count: lines.len(), slabs }
    }

    /// How many of the lines meet the interior of a body.
    pub(super) fn count(&self, h: &Offsets) -> u64 {
        let (mut near, mut far) = ([0f32; BLOCK_LINES], [0f32; BLOCK_LINES]);
        let mut met = 0;
        for first in (0..self.count).step_by(BLOCK_LINES) {
            let end = self.count.min(first + BLOCK_LINES);
            near.fill(f32::NEG_INFINITY);
            far.fill(f32::INFINITY);
            for (pair, slab) in self.slabs.iter().enumerate() {
                let (low, high) = (-h[2 * pair + 1] as f32, h[2 * pair] as f32);
                let ends = near.iter_mut().zip(&mut far);
                for ((near, far), &[a, b]) in ends.zip(&slab[first..end]) {
                    let (one, other) = (low * a - b, high * a - b);
                    let (least, most) = if one < other { (one, other) } else { (other, one) };
                    *near = if *near < least { least } else { *near };
                    *far = if *far < most { *far } else { most };
                }
            }
            let is_met = near[..end - first].iter().zip(&far).map(|(near, far)| near < far);
            met += is_met.filter(|&is_met| is_met).count() as u64;
        }
        met
    }
}
