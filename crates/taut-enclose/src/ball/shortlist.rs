//! The few points that can matter, in memory: what the first pass leaves to be looked at again and again.
//!
//! *Idea.* A pass from c₀ lists all points farther from it than b. For another center c and any point that is not listed,
//! |x − c| ≤ b + |c − c₀|. Where that is less than the radius, a pass over the list tells as much as a pass over all points.
//! *Guarantee.* The bound holds with the rounding of the pass added to it; what is listed does not depend on threads.
//! *Trap.* A list is of use only if c₀ is near the end: that of the mean of points is for normal ones, not for the vertices
//! of a simplex. The ball of a sample has the center of that of all where few points are far out, and one as far off again
//! for normal points, whose far points are chance. So a sample chooses ([`of_sample`]). Points near a sphere cannot be told by any list; theirs
//! is given up after one pass.
//! *Measured.* 10⁶ × 3 and 10⁶ × 10, normal: one pass in place of three, and 0.7 and half of the time.

use taut_certify::Items;
use taut_kernels::{Center, relative_error, squared_distances};
use taut_points::{Monitor, Points};

use super::{BallOptions, core_set};
use crate::Error;
use crate::item_reader::{ItemReader, Pass, PassResult, Query, View};
use crate::top::Far;

/// The sample has this many rows.
const SAMPLE_ROWS: u64 = 2048;
/// A pass costs more than a sample and a list from this many times as many points on.
const POINTS_PER_SAMPLE_ROW: u64 = 32;
/// Measured: in the plane a pass takes less than the ball of a sample.
const DIMENSION_MIN: usize = 3;
/// Measured: in more dimensions the center of the sample is farther off than a list of any use reaches.
const DIMENSION_MAX: usize = 32;
/// Most points of a list.
const MOST_LISTED: usize = 4096;
/// At least this many points of the sample lie above the threshold of a list: fewer would say nothing.
const SAMPLE_RANK_MIN: u64 = 10;
/// The relative gap of the ball of a sample: its center is off by about the root of twice that, beside what a sample can know.
const SAMPLE_GAP: f64 = 1e-6;

/// Points of a source that lie far from a center, and what is known of those that are not among them.
pub(super) struct Shortlist {
    view: View,
    /// Row numbers, ascending.
    ids: Vec<u64>,
    rows: Vec<f64>,
    /// From where they are far.
    center: Center,
    /// No other point has a squared distance above this from there, as a pass finds it.
    listed_above: f64,
}

/// The first pass: its center, what it finds, and a list where the points are worth one.
pub(super) fn first(
    reader: &mut ItemReader<'_>,
    keep: usize,
    options: &BallOptions<'_>,
) -> Result<(Center, PassResult, Option<Shortlist>), Error> {
    // Whoever sets the size of a batch means batches of passes.
    let worth = reader.items() == Items::Points
        && options.batch.is_none()
        && (DIMENSION_MIN..=DIMENSION_MAX).contains(&reader.dim())
        && reader.len() >= POINTS_PER_SAMPLE_ROW * SAMPLE_ROWS;
    let start = if worth { of_sample(reader)? } else { None };
    let Some((center, above)) = start else {
        let (center, found) = reader.first(keep)?;
        return Ok((center, found, None));
    };
    let keep = keep.max(MOST_LISTED);
    match reader.first_from(Query { center: &center, above, keep, by_face_above: None })? {
        Some(found) => {
            let list = Shortlist::of(reader, center.clone(), &found)?;
            Ok((center, found, Some(list)))
        }
        None => {
            let (center, found) = reader.pass_from_mean(keep)?;
            Ok((center, found, None))
        }
    }
}

/// A center not far from that of the ball, and a squared distance from it that few points exceed; `None` for points that
/// are equal, not finite or near an end of the range of `f64`.
///
/// The centers of the balls of two halves of a sample say how far off such a center is: their middle is taken, the mean of
/// the sample, or the middle of these, by what a list from there would have to reach.
fn of_sample(reader: &ItemReader<'_>) -> Result<Option<(Center, f64)>, Error> {
    let dim = reader.dim();
    let rows = reader.sample(SAMPLE_ROWS)?;
    let (odd, even) = rows.split_at(rows.len() / 2 / dim * dim);
    let (Some(a), Some(b)) = (ball_center(odd, dim)?, ball_center(even, dim)?) else {
        return Ok(None);
    };
    let between = |a: &[f64], b: &[f64]| -> Vec<f64> {
        a.iter().zip(b).map(|(a, b)| a + (b - a) / 2.0).collect()
    };
    let middle = between(&a, &b);
    let mean = mean(&rows, dim);
    let beside = between(&middle, &mean);
    let rank = MOST_LISTED as u64 / 2 * SAMPLE_ROWS / reader.len();
    let rank = rank.max(SAMPLE_RANK_MIN) as usize;
    let mut best: Option<(f64, Center, f64)> = None;
    let mut reaches = vec![0.0; rows.len() / dim];
    for high in [middle, beside, mean] {
        let moved = distance(&high, &a).max(distance(&high, &b));
        let center = Center { high, low: vec![] };
        squared_distances(&rows, dim, &center, &mut reaches);
        let (_, &mut above, _) = reaches.select_nth_unstable_by(rank, |a, b| b.total_cmp(a));
        let reach = above.sqrt() + moved;
        if best.as_ref().is_none_or(|(least, ..)| reach < *least) {
            // Just below, as the farthest points may all be equally far.
            best = Some((reach, center, above.next_down().max(0.0)));
        }
    }
    Ok(best.map(|(_, center, above)| (center, above)))
}

/// The center of the ball of a few rows.
fn ball_center(rows: &[f64], dim: usize) -> Result<Option<Vec<f64>>, Error> {
    /// Squares between this and its inverse are far from either end.
    const SQUARE_MIN: f64 = 1e-100;
    if !rows.iter().all(|v| v.is_finite()) {
        return Ok(None);
    }
    let points = Points::new(rows, dim).map_err(|_| Error::Overflow)?;
    let monitor = Monitor::silent();
    let options = BallOptions { epsilon: SAMPLE_GAP, ..BallOptions::default() };
    let mut reader = ItemReader::new(&points, Items::Points, &monitor)?;
    let (best, _) = core_set::solve(&mut reader, &options)?.into_best();
    let safe = SQUARE_MIN..1.0 / SQUARE_MIN;
    let is_safe = reader.scale() == 1.0 && safe.contains(&best.found.farthest.reach2);
    Ok(is_safe.then_some(best.center.high))
}

/// The mean of rows, taken from the first on.
fn mean(rows: &[f64], dim: usize) -> Vec<f64> {
    let (first, count) = (&rows[..dim], (rows.len() / dim) as f64);
    let mut sum = vec![0.0; dim];
    for row in rows.chunks_exact(dim) {
        sum.iter_mut().zip(row).zip(first).for_each(|((s, x), f)| *s += x - f);
    }
    sum.iter().zip(first).map(|(s, f)| f + s / count).collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

impl Shortlist {
    fn of(reader: &ItemReader<'_>, center: Center, found: &PassResult) -> Result<Self, Error> {
        let mut ids: Vec<u64> = found.far.iter().map(|far| far.id).collect();
        ids.sort_unstable();
        let rows = reader.rows(&ids)?;
        let view = View { items: Items::Points, dim: reader.dim(), scale: 1.0, shift: vec![] };
        Ok(Shortlist { view, ids, rows, center, listed_above: found.listed_above })
    }

    /// What a pass would find among the listed points, and whether it would find nothing else above the threshold.
    pub(super) fn pass(&self, query: Query<'_>) -> Result<(PassResult, bool), Error> {
        let points = Points::new(&self.rows, self.view.dim).map_err(|_| Error::Overflow)?;
        let found = Pass::new(&self.view, query, 0).run(&points, &Monitor::silent())?;
        let mut found = found.settle(query);
        // Positions ascend as row numbers do, so ties were decided alike.
        let far = found.far.iter_mut().chain(&mut found.by_face).chain([&mut found.farthest]);
        for Far { id, .. } in far {
            *id = self.ids[*id as usize];
        }
        Ok((found, self.others(query.center) < query.above))
    }

    /// A bound on the squared distance, as a pass finds it, of the points that are not listed.
    fn others(&self, center: &Center) -> f64 {
        let term = |center: &Center, j: usize| center.low.get(j).copied().unwrap_or(0.0);
        let moved: f64 = (0..self.view.dim)
            .map(|j| {
                let high = center.high[j] - self.center.high[j];
                let low = term(center, j) - term(&self.center, j);
                (high + low).powi(2)
            })
            .sum();
        let reach = self.listed_above.sqrt() + moved.sqrt();
        reach * reach * (1.0 + 8.0 * relative_error(self.view.dim))
    }
}

#[cfg(test)]
mod tests {
    use taut_points::{Distribution, generate};

    use super::*;
    use crate::ball;

    const N: usize = (POINTS_PER_SAMPLE_ROW * SAMPLE_ROWS) as usize;

    /// One pass where points differ enough; the ball of the rounds over all points everywhere.
    #[test]
    fn lists_save_passes_and_change_no_ball() {
        let cases = [
            (Distribution::Normal, 2, false),
            (Distribution::Normal, 3, true),
            (Distribution::Normal, 10, false),
            (Distribution::Uniform, 3, true),
            (Distribution::Clusters { count: 7, spread: 0.01 }, 5, false),
            (Distribution::Sphere, 4, false),
            (Distribution::CubeVertices, 8, false),
        ];
        for (distribution, dim, is_one) in cases {
            let values: Vec<f64> = generate(distribution, N, dim, 11).unwrap();
            let points = Points::new(&values, dim).unwrap();
            let options = BallOptions { epsilon: 0.0, ..BallOptions::default() };
            let listed = ball(&points, &options).unwrap();
            let plain = ball(&points, &BallOptions { batch: Some(16), ..options }).unwrap();
            let (a, b) = (listed.answer.radius, plain.answer.radius);
            assert!((a - b).abs() <= 1e-12 * b, "{distribution:?}: {a} for {b}");
            assert!(listed.check(&points).unwrap().gap <= 1e-12, "{distribution:?}");
            assert!(!is_one || listed.trace.passes == 1, "{distribution:?}: {:?}", listed.trace);
        }
    }

    /// What is not listed stays within the bound from other centers, also far from the origin, and the bound is not idle.
    #[test]
    fn points_that_are_not_listed_are_bounded() {
        for (dim, offset) in [(2, 0.0), (5, 1e6)] {
            let mut values: Vec<f64> = generate(Distribution::Normal, 5000, dim, 3).unwrap();
            values.iter_mut().for_each(|v| *v += offset);
            let points = Points::new(&values, dim).unwrap();
            let monitor = Monitor::silent();
            let mut reader = ItemReader::new(&points, Items::Points, &monitor).unwrap();
            let center = Center { high: vec![offset; dim], low: vec![] };
            let query = Query { center: &center, above: 0.0, keep: 100, by_face_above: None };
            let found = reader.farthest(query).unwrap();
            let list = Shortlist::of(&reader, center, &found).unwrap();
            for moved in [0.0, 0.3, -1.0] {
                let high = (0..dim).map(|j| offset + moved * j as f64).collect();
                let other = Center { high, low: vec![1e-3 * moved; dim] };
                let query = Query { center: &other, above: 0.0, keep: 5000, by_face_above: None };
                let all = reader.farthest(query).unwrap();
                let free = all.far.iter().find(|far| list.ids.binary_search(&far.id).is_err());
                let (reached, bound) = (free.unwrap().reach2, list.others(&other));
                assert!(reached <= bound && bound <= 2.0 * reached, "{reached} {bound}");
                let listed = list.pass(query).unwrap().0.far;
                let wanted: Vec<Far> =
                    all.far.into_iter().filter(|far| list.ids.contains(&far.id)).collect();
                assert_eq!(listed, wanted);
            }
        }
    }
}
