//! Runs of vertices along a dense part of a curve: which edges can meet circles of the size that is sought, for a whole run at once.
//!
//! *Idea.* Where all edges around the run have directions within α of one, tangents and chords between their points have too: for a point
//! of them w away from a vertex, |n·w| ≤ |w| sin 2α, and |w| is at least cos α times the way along the curve. A circle of radius r that
//! touches at the vertex has |w|² ≤ 2r|n·w| for what is in it: no end of an edge is from the way 4r sin α on. An edge g long that is at
//! least 2g off loses g²/4 against its ends, a fifteenth of |w|² for α ≤ 0.3. So edges off by more than 4.3r sin α cannot meet the
//! circle: on dense samples nearly all of them. Other strands are sought once for the run: a circle reaches no farther than 2r.
//! *Guarantee.* R is the one that a search over all edges finds.

use std::ops::Range;

use super::features::Course;
use super::tree::Area;

/// The part of the curve around a run that belongs to it, over the diameter of circles: a curve that turns is not quite as far off as it is
/// long.
const WIDTH_FACTOR: f64 = 1.125;

/// The largest sine of α for which the bound above holds.
const SINE_MOST: f64 = 0.29;

/// No edge from this way on meets a circle, over r sin α.
const CLEAR_WAY_RATIO: f64 = 4.3;

/// Returns the way along the curve, over R, from which on no edge can meet a circle of a run of vertices; none where another strand is within
/// reach, or the curve turns too much, or is too short.
pub(super) fn clear_way(course: &Course<'_>, sight: &[f64], run: Range<usize>) -> Option<f64> {
    let count = course.points.len();
    let diameter = 2.0 * sight[run.clone()].iter().copied().fold(0.0, f64::max);
    // The run is at count and on, and has edges first..last around it.
    let (mut first, mut last) = (count + run.start, count + run.end - 1);
    let (from, to) = (course.way(first), course.way(last));
    while last - first < count && from - course.way(first) < WIDTH_FACTOR * diameter {
        first -= 1;
    }
    while last - first < count && course.way(last) - to < WIDTH_FACTOR * diameter {
        last += 1;
    }
    if last - first >= count {
        return None;
    }
    let sine = spread(course, first..last)?;
    let center = course.points[(run.start + run.end - 1) / 2];
    let apart = |p: &[f64; 2]| (p[0] - center[0]).hypot(p[1] - center[1]);
    let reach = diameter + course.points[run].iter().map(apart).fold(0.0, f64::max);
    let is_own = |start: usize, end: usize| {
        course.base <= start && end < course.base + count && {
            let on = (start - course.base + 2 * count - first) % count;
            on + (end - start) < last - first
        }
    };
    let mut square = reach * reach;
    course.edges.tree.least(
        &mut square,
        |area, [start, end]| match is_own(start, end) {
            true => f64::INFINITY,
            false => area.distance_squared(center),
        },
        |edge, square| {
            let area = Area::of(&course.edges.segment(edge));
            // No bound is below 0: the search ends.
            if !is_own(edge, edge) && area.distance_squared(center) < *square {
                *square = 0.0;
            }
        },
    );
    (square > 0.0).then_some(CLEAR_WAY_RATIO * sine)
}

/// Returns the sine of α, the most that the direction of an edge, counted on around the curve, is off that of the chord of all of them.
fn spread(course: &Course<'_>, around: Range<usize>) -> Option<f64> {
    let point = |k: usize| course.points[k % course.points.len()];
    let [from, to] = [point(around.start), point(around.end)];
    let (ux, uy) = (to[0] - from[0], to[1] - from[1]);
    let mut square = 0.0f64;
    let mut a = from;
    for k in around {
        let b = point(k + 1);
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        let (along, across) = (x * ux + y * uy, x * uy - y * ux);
        // tan²; NaN of an edge that is too short to have a direction is not small.
        let slope = (across / along) * (across / along);
        if !(along > 0.0 && slope <= SINE_MOST * SINE_MOST) {
            return None;
        }
        square = square.max(slope);
        a = b;
    }
    Some(square.sqrt())
}
