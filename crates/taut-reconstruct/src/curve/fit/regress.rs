//! Local polynomials along an ordered curve, with windows as long as the curve lets them be.
//!
//! *Problem.* Points lie in a band around a curve, in order. Where is the middle line?
//! *Idea.* In the frame of a place on the curve as known so far, a parabola is fitted to the points of a window, by least squares or, for
//! noise with an edge, by the least largest residual. Windows grow by [`REGRESSION_WINDOW_GROWTH`] for as long as what each says of the place
//! agrees with what all shorter ones say, within their errors (Lepski's rule): then curvature does not bend the answer yet.
//! *Guarantee.* Error O(n^(−4/9)) for least squares and O(n^(−4/5)) for the least largest residual, of a smooth curve.
//! *Reference.* Lepski, Theory of Probability and its Applications 35 (1990), 454–466.

use taut_points::parallel::ParallelSlice;

use super::local::cholesky;
use super::minimax::{Minimax, minimax};
use super::noise::Noise;
use super::parameters::{
    HALF_LENGTH_RATIO, MINIMAX_ERROR, ONE_SIDED_ERROR_MIN, PEELED_OUTLIERS_MAX, PLACES_PER_WINDOW,
    REGRESSION_WINDOW_GROWTH, SLOPE_MAX, STANDARD_ERRORS_MAX, WINDOW_DEVIATION_RATIO_MAX,
    WINDOW_POINTS_MIN,
};
use super::spline::{Member, Node, Spline, hermite};

type Point = [f64; 2];

/// What windows say of one place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    /// Offset from the frame's origin, along its normal.
    pub(super) offset: f64,
    /// Slope there.
    pub(super) slope: f64,
    /// Standard error of the offset.
    pub(super) error: f64,
    /// Half the curvature.
    pub(super) bend: f64,
    /// Standard deviation of the residuals.
    pub(super) deviation: f64,
}

/// Nodes in the middle of the band, `parts` for each edge of the spline.
pub(super) fn regress(spline: &Spline, parts: usize, noise: &Noise) -> Vec<Node> {
    let places: Vec<Place> = (0..spline.edges() * parts + usize::from(!spline.closed))
        .map(|number| Place::new(spline, number, parts))
        .collect();
    let asked: Vec<&Place> = places.iter().step_by(PLACES_PER_WINDOW).collect();
    let halves: Vec<f64> = asked
        .par_iter()
        .with_min_len(16)
        .map_init(Window::default, |window, place| longest(spline, place, noise, window))
        .collect();
    let halves = median_around(spline, &asked, &halves);
    places
        .par_iter()
        .enumerate()
        .with_min_len(16)
        .map_init(Window::default, |window, (number, place)| {
            let half = between(&halves, number, spline.closed);
            let Frame { origin, tangent } = place.frame;
            match narrow(spline, place, half, noise, window) {
                Some(found) => Node {
                    at: place.frame.place(found.offset),
                    tangent: place.frame.direction(found.slope),
                    leaving: place.frame.direction(found.slope),
                    reach: place.reach,
                    deviation: found.deviation,
                    error: found.error,
                },
                None => Node {
                    at: origin,
                    tangent,
                    leaving: tangent,
                    reach: place.reach,
                    deviation: place.deviation,
                    error: place.deviation,
                },
            }
        })
        .collect()
}

/// The half at a place from those of the places that were asked, two of them around it.
fn between(halves: &[f64], number: usize, closed: bool) -> f64 {
    let (before, part) = (
        number / PLACES_PER_WINDOW,
        (number % PLACES_PER_WINDOW) as f64 / PLACES_PER_WINDOW as f64,
    );
    let after = match before + 1 {
        after if after < halves.len() => after,
        _ if closed => 0,
        _ => before,
    };
    (1.0 - part) * halves[before] + part * halves[after]
}

/// Where on a spline a node is to be.
struct Place {
    frame: Frame,
    arc: f64,
    reach: f64,
    deviation: f64,
}

impl Place {
    fn new(spline: &Spline, number: usize, parts: usize) -> Self {
        let (edge, t) = match number / parts {
            edge if edge < spline.edges() => (edge, (number % parts) as f64 / parts as f64),
            edge => (edge - 1, 1.0),
        };
        let (a, b) = spline.edge(edge);
        let (origin, slope) = hermite(a, b, t);
        let norm = slope[0].hypot(slope[1]);
        let between = |a: f64, b: f64| (1.0 - t) * a + t * b;
        Place {
            frame: Frame { origin, tangent: [slope[0] / norm, slope[1] / norm] },
            arc: between(spline.arc[edge], spline.arc[edge + 1]),
            reach: between(a.reach, b.reach),
            deviation: between(a.deviation, b.deviation),
        }
    }
}

/// For each place the median of the halves of the places within its own half.
fn median_around(spline: &Spline, places: &[&Place], halves: &[f64]) -> Vec<f64> {
    let count = places.len();
    let whole = spline.length();
    (0..count)
        .map(|i| {
            let mut around = vec![halves[i]];
            for forward in [true, false] {
                for k in 1..count / 2 {
                    let j = match (forward, spline.closed) {
                        (true, true) => (i + k) % count,
                        (false, true) => (i + count - k) % count,
                        (true, false) if i + k < count => i + k,
                        (false, false) if i >= k => i - k,
                        _ => break,
                    };
                    let apart = (places[j].arc - places[i].arc).abs();
                    let apart = if spline.closed { apart.min(whole - apart) } else { apart };
                    if apart > halves[i] {
                        break;
                    }
                    around.push(halves[j]);
                }
            }
            around.sort_unstable_by(f64::total_cmp);
            around[around.len() / 2]
        })
        .collect()
}

/// A place on a curve and the direction it has there.
pub(super) struct Frame {
    origin: Point,
    tangent: Point,
}

impl Frame {
    fn local(&self, p: Point) -> Point {
        let (dx, dy) = (p[0] - self.origin[0], p[1] - self.origin[1]);
        let [tx, ty] = self.tangent;
        [dx * tx + dy * ty, dy * tx - dx * ty]
    }

    fn place(&self, offset: f64) -> Point {
        [self.origin[0] - offset * self.tangent[1], self.origin[1] + offset * self.tangent[0]]
    }

    fn direction(&self, slope: f64) -> Point {
        let norm = slope.hypot(1.0);
        let [tx, ty] = self.tangent;
        [(tx - slope * ty) / norm, (ty + slope * tx) / norm]
    }
}

/// Half the length of the longest window that agrees with all shorter ones.
fn longest(spline: &Spline, place: &Place, noise: &Noise, window: &mut Window) -> f64 {
    let longest = spline.length() / if spline.closed { 6.0 } else { 2.0 };
    let mut half = 0.5 * place.reach;
    let mut best = half;
    let mut agreed = [f64::NEG_INFINITY, f64::INFINITY];
    while half <= longest {
        if let Some(found) = measure(spline, place, half, noise, window) {
            let interval = [
                found.offset - STANDARD_ERRORS_MAX * found.error,
                found.offset + STANDARD_ERRORS_MAX * found.error,
            ];
            agreed = [agreed[0].max(interval[0]), agreed[1].min(interval[1])];
            if agreed[0] > agreed[1]
                || found.deviation > WINDOW_DEVIATION_RATIO_MAX * place.deviation
            {
                break;
            }
            best = half;
            if found.slope.abs() + 2.0 * found.bend.abs() * half > SLOPE_MAX {
                break;
            }
        }
        half *= REGRESSION_WINDOW_GROWTH;
    }
    best
}

/// What the window of a length says, or the longest of those it holds in which residuals are as small as noise is.
///
/// Lengths come from the places around, and where few points lie around a bend, none of those may be there.
fn narrow(
    spline: &Spline,
    place: &Place,
    mut half: f64,
    noise: &Noise,
    window: &mut Window,
) -> Option<Estimate> {
    let mut found = measure(spline, place, half, noise, window)?;
    while found.deviation > WINDOW_DEVIATION_RATIO_MAX * place.deviation {
        half /= REGRESSION_WINDOW_GROWTH;
        let Some(shorter) = measure(spline, place, half, noise, window) else { break };
        found = shorter;
    }
    Some(found)
}

/// The points of a window, in the frame of a place; memory that is used again.
#[derive(Default)]
struct Window {
    points: Vec<Point>,
    /// Those near the edges of the band, by their place along the parabola and their distance from it.
    edges: Vec<Point>,
}

/// What the window of one length says of a place; none where it holds too few points or all on one side.
fn measure(
    spline: &Spline,
    place: &Place,
    half: f64,
    noise: &Noise,
    window: &mut Window,
) -> Option<Estimate> {
    window.points.clear();
    for members in around(spline, place.arc, half / HALF_LENGTH_RATIO) {
        let local = members.iter().map(|m| place.frame.local(m.at));
        window.points.extend(local.filter(|p| p[0].abs() <= half));
    }
    let count = window.points.len();
    if count < WINDOW_POINTS_MIN {
        return None;
    }
    let found = least_squares(&window.points, half, place.deviation)?;
    if found.error > ONE_SIDED_ERROR_MIN * place.deviation {
        return None;
    }
    let Some(edge) = noise.edge.map(|edge| edge * place.deviation) else { return Some(found) };
    let error = MINIMAX_ERROR * edge / count as f64;
    if error > found.error {
        return Some(found);
    }
    // The minimax parabola is so near to that of least squares that points further inside the band than this do not decide it. If
    // it turns out to be farther off, all are asked. Those far beyond the edge are outliers.
    let inside = (0.95 * edge - 6.0 * found.error).max(0.0);
    let most = 1.05 * edge + 3.0 * found.error;
    let peels = if noise.outliers { PEELED_OUTLIERS_MAX } else { 0 };
    let fitted = window.minimax(&found, inside, most, 1.05 * edge, peels).and_then(|fitted| {
        let [a, b, c] = fitted.coefficients;
        match inside + a.abs() + half * (b.abs() + half * c.abs()) <= fitted.width {
            true => Some(fitted),
            false => window.minimax(&found, 0.0, most, 1.05 * edge, peels),
        }
    })?;
    let [offset, slope, bend] = fitted.coefficients;
    Some(Estimate {
        offset: found.offset + offset * found.slope.hypot(1.0),
        slope: found.slope + slope,
        bend: found.bend + bend,
        error,
        ..found
    })
}

impl Window {
    /// The parabola, beside the one of least squares, whose largest residual is least, of the points whose distance from the latter is
    /// in some range.
    fn minimax(
        &mut self,
        found: &Estimate,
        inside: f64,
        most: f64,
        widest: f64,
        peels: usize,
    ) -> Option<Minimax> {
        self.edges.clear();
        for &[u, v] in &self.points {
            let above = v - (found.offset + u * (found.slope + u * found.bend));
            let rise = found.slope + 2.0 * u * found.bend;
            if above * above >= inside * inside * (1.0 + rise * rise) {
                let straight = straightened([u, v], found);
                if straight[1].abs() <= most {
                    self.edges.push(straight);
                }
            }
        }
        peeled(&mut self.edges, widest, peels)
    }
}

/// The place of a point along a parabola, and its distance from it.
///
/// The band that noise fills has its edges at one distance along the normal, not above: where it slopes, it is higher than it is
/// wide, and a parabola in the frame would be held at the ends of the window only.
fn straightened([u, v]: Point, parabola: &Estimate) -> Point {
    let Estimate { offset, slope, bend, .. } = *parabola;
    let mut projection = u;
    for _ in 0..2 {
        // Newton's step for (projection − u) + (p(projection) − v)·p′(projection) = 0.
        let above = offset + projection * (slope + projection * bend) - v;
        let rise = slope + 2.0 * projection * bend;
        projection -=
            (projection - u + above * rise) / (1.0 + rise * rise + 2.0 * above * bend).max(0.25);
    }
    let above = v - (offset + projection * (slope + projection * bend));
    [projection, (((projection - u) * (projection - u) + above * above).sqrt()).copysign(above)]
}

/// The parabola of least squares.
fn least_squares(window: &[Point], half: f64, deviation: f64) -> Option<Estimate> {
    let mut powers = [0.0; 5];
    let mut moments = [0.0; 3];
    let mut squares = 0.0;
    for &[u, v] in window {
        let u = u / half;
        let u2 = u * u;
        powers[0] += 1.0;
        powers[1] += u;
        powers[2] += u2;
        powers[3] += u2 * u;
        powers[4] += u2 * u2;
        moments[0] += v;
        moments[1] += u * v;
        moments[2] += u2 * v;
        squares += v * v;
    }
    let [s0, s1, s2, s3, s4] = powers;
    let matrix = [[s0, s1, s2], [s1, s2, s3], [s2, s3, s4]];
    let solution = cholesky(matrix, moments)?;
    let inverse = cholesky(matrix, [1.0, 0.0, 0.0])?[0];
    let fitted: f64 = solution.iter().zip(moments).map(|(a, m)| a * m).sum();
    let variance = ((squares - fitted) / (window.len() as f64 - 3.0)).max(0.0);
    Some(Estimate {
        offset: solution[0],
        slope: solution[1] / half,
        bend: solution[2] / (half * half),
        error: deviation * inverse.sqrt(),
        deviation: variance.sqrt(),
    })
}

/// The minimax parabola without the points that make it wider than noise is.
fn peeled(window: &mut Vec<Point>, widest: f64, most: usize) -> Option<Minimax> {
    let mut found = minimax(window)?;
    for _ in 0..most {
        if found.width <= widest || window.len() <= WINDOW_POINTS_MIN {
            break;
        }
        let mut best: Option<(usize, Minimax)> = None;
        for i in found.reference {
            let last = window.len() - 1;
            window.swap(i, last);
            let Some(point) = window.pop() else { break };
            if let Some(without) = minimax(window)
                && best.is_none_or(|(_, b)| without.width < b.width)
            {
                best = Some((i, without));
            }
            window.push(point);
            window.swap(i, last);
        }
        let (i, _) = best?;
        window.swap_remove(i);
        found = minimax(window)?;
    }
    Some(found)
}

/// The members of a spline within some length of a place along it: one run, or two where it goes over the seam.
pub(super) fn around(spline: &Spline, arc: f64, half: f64) -> [&[Member]; 2] {
    let members = &spline.members[..];
    let before = |arc: f64| members.partition_point(|m| m.arc < arc);
    let (low, high) = (arc - half, arc + half);
    let whole = spline.length();
    match (spline.closed, low < 0.0, high > whole) {
        (true, true, _) => [&members[before(low + whole)..], &members[..before(high)]],
        (true, _, true) => [&members[before(low)..], &members[..before(high - whole)]],
        _ => [&members[before(low)..before(high)], &[]],
    }
}
