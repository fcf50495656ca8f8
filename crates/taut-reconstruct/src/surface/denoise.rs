//! Noise taken out of points before a surface is sought: outliers left out, the others moved towards the sheet they are around.
//!
//! *Idea.* An outlier is a point whose neighbors are much farther from it than theirs are from them. Each other point is moved along the
//! normal of its nearest neighbors onto the paraboloid that fits them best, a few times over.
//! *Guarantee.* A function of the points: neighbors come in the order of their distances, equal ones in that of their coordinates.
//! O(n log n).
//! *Trap.* Edges are rounded by about the distance of the neighbors, and thin plates pulled together; hence never by default. Planes
//! in the place of paraboloids, motion by mean curvature, shrink the bunny by two thousandths of its diagonal in four rounds: more
//! than the noise.
//! *Reference.* Cazals and Pouget, *Estimating differential quantities using polynomial fitting of osculating jets*, Comput. Aided Geom.
//! Des. 22(2), 2005; the scale space of Digne, Morel, Souzani and Lartigue, Comput. Graph. Forum 30(6), 2011, is the plane's.

use std::cmp::Ordering;

use rayon::prelude::*;
use taut_points::{InputError, Monitor};

use super::Denoise;
use super::neighbors::of_neighbors;
use super::spheres::{Point, dot, minus};
use crate::Error;

/// A point must be this many times farther from its neighbors than they are from theirs for an outlier.
const OUTLIER_DISTANCE_RATIO: f64 = 3.0;

/// Points after the pre-pass.
pub(super) struct Denoised {
    /// Those that are no outliers, moved.
    pub(super) points: Vec<Point>,
    pub(super) rows: Vec<u32>,
    /// The rows of the others.
    pub(super) outliers: Vec<u32>,
}

/// Takes out noise. Coordinates are of a magnitude whose squares are numbers.
///
/// # Errors
/// [`Error::Input`].
pub(super) fn denoise(
    all: &[Point],
    options: &Denoise,
    monitor: &Monitor<'_>,
) -> Result<Denoised, Error> {
    if u32::try_from(all.len()).is_err() {
        return Err(Error::Input(InputError::TooManyPoints {
            points: all.len() as u64,
            most: u32::MAX.into(),
        }));
    }
    // Equal points are one: each is where its first is moved, or left out with it.
    let first = firsts(all);
    let (distinct, place): (Vec<u32>, Vec<u32>) = {
        let mut place = vec![0; all.len()];
        let distinct: Vec<u32> =
            (0..all.len() as u32).filter(|&row| first[row as usize] == row).collect();
        (0u32..).zip(&distinct).for_each(|(k, &row)| place[row as usize] = k);
        let of_first = first.iter().map(|&row| place[row as usize]).collect();
        (distinct, of_first)
    };
    let once: Vec<Point> = distinct.iter().map(|&row| all[row as usize]).collect();
    let is_outlier = outliers(&once, options.neighbors)?;
    let kept: Vec<u32> = (0..once.len() as u32).filter(|&k| !is_outlier[k as usize]).collect();
    let mut points: Vec<Point> = kept.iter().map(|&k| once[k as usize]).collect();
    for _ in 0..options.iterations {
        monitor.check()?;
        points = of_neighbors(&points, options.neighbors, |point, near| {
            onto_sheet(points[point], near.iter().map(|near| points[near.row as usize]))
        })?;
    }
    let mut moved = once;
    kept.iter().zip(points).for_each(|(&k, point)| moved[k as usize] = point);
    let (outliers, rows): (Vec<u32>, Vec<u32>) =
        (0..all.len() as u32).partition(|&row| is_outlier[place[row as usize] as usize]);
    let points = rows.iter().map(|&row| moved[place[row as usize] as usize]).collect();
    Ok(Denoised { points, rows, outliers })
}

/// For each point the first one that equals it.
pub(super) fn firsts(points: &[Point]) -> Vec<u32> {
    // −0 equals 0, but is another pattern of bits.
    let plain = |row: u32| points[row as usize].map(|x| x + 0.0);
    let by_place = |&a: &u32, &b: &u32| {
        let (a_place, b_place) = (plain(a), plain(b));
        let pairs = a_place.iter().zip(&b_place);
        pairs.fold(Ordering::Equal, |order, (x, y)| order.then(x.total_cmp(y))).then(a.cmp(&b))
    };
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.par_sort_unstable_by(by_place);
    let mut first = vec![0; points.len()];
    for same in order.chunk_by(|&a, &b| plain(a) == plain(b)) {
        same.iter().for_each(|&row| first[row as usize] = same[0]);
    }
    first
}

/// By point, whether its neighbors are much farther from it than theirs from them.
fn outliers(points: &[Point], neighbors: usize) -> Result<Vec<bool>, Error> {
    let distances: Vec<(f64, Vec<u32>)> = of_neighbors(points, neighbors, |_, near| {
        let sum: f64 = near.iter().map(|near| near.distance2.sqrt()).sum();
        (sum, near.iter().map(|near| near.row).collect())
    })?;
    let is_outlier = |(own, near): &(f64, Vec<u32>)| {
        let mut theirs: Vec<f64> = near.iter().map(|&other| distances[other as usize].0).collect();
        theirs.sort_unstable_by(f64::total_cmp);
        theirs.get(theirs.len() / 2).is_some_and(|median| *own > OUTLIER_DISTANCE_RATIO * median)
    };
    Ok(distances.par_iter().map(is_outlier).collect())
}

/// A point moved along the normal of others onto the paraboloid that fits them best; onto the plane that does, if they are too few or
/// on too few lines for a paraboloid.
fn onto_sheet(point: Point, others: impl Iterator<Item = Point> + Clone) -> Point {
    let count = others.clone().count() as f64;
    let mut center = [0.0; 3];
    for other in others.clone() {
        (0..3).for_each(|k| center[k] += other[k] / count);
    }
    let mut covariance = [[0.0; 3]; 3];
    for other in others.clone() {
        let off = minus(other, center);
        for i in 0..3 {
            (0..3).for_each(|j| covariance[i][j] += off[i] * off[j]);
        }
    }
    let [u, v, normal] = directions(covariance);
    let height = paraboloid(point, others, [u, v, normal])
        .unwrap_or_else(|| dot(minus(center, point), normal));
    [0, 1, 2].map(|k| point[k] + height * normal[k])
}

/// The height at a point of the function a + bx + cy + dx² + exy + fy² that fits others best in the directions given, near ones more.
fn paraboloid(
    point: Point,
    others: impl Iterator<Item = Point> + Clone,
    [u, v, normal]: [Point; 3],
) -> Option<f64> {
    let square = |other: Point| dot(minus(other, point), minus(other, point));
    let reach = others.clone().map(square).fold(0.0, f64::max).sqrt() * 1.1;
    // The normal equations, with the right-hand side in the last column; lengths in units of the reach.
    let mut a = [[0.0; 7]; 6];
    for other in others {
        let off = minus(other, point).map(|x| x / reach);
        let (x, y, z) = (dot(off, u), dot(off, v), dot(off, normal));
        let weight = (1.0 - dot(off, off)).powi(2);
        let terms = [1.0, x, y, x * x, x * y, y * y, z];
        for i in 0..6 {
            (i..7).for_each(|j| a[i][j] += weight * terms[i] * terms[j]);
        }
    }
    // Gauss without pivots, as the matrix is positive; from the last unknown up, so that the first is had without the others.
    for last in (1..6).rev() {
        if a[last][last].is_nan() || a[last][last] <= 1e-6 {
            return None;
        }
        for i in 0..last {
            let factor = a[i][last] / a[last][last];
            (i..last).for_each(|j| a[i][j] -= factor * a[j][last]);
            a[i][6] -= factor * a[last][6];
        }
    }
    let height = reach * a[0][6] / a[0][0];
    // A fit that leads far away is none.
    (height.abs() <= 0.5 * reach).then_some(height)
}

/// The directions of most, middle and least variance, by Jacobi's rotations.
fn directions(mut a: [[f64; 3]; 3]) -> [Point; 3] {
    let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // Each sweep squares what is off the diagonal; six leave nothing.
    for _ in 0..6 {
        for [p, q] in [[0, 1], [0, 2], [1, 2]] {
            if a[p][q] == 0.0 {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let c = 1.0 / t.hypot(1.0);
            let s = t * c;
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            for k in 0..3 {
                (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
                (axes[p][k], axes[q][k]) =
                    (c * axes[p][k] - s * axes[q][k], s * axes[p][k] + c * axes[q][k]);
            }
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&p: &usize, &q: &usize| a[q][q].total_cmp(&a[p][p]));
    order.map(|k| axes[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_direction_of_a_tilted_plane() {
        // Points of x + 2y + 2z = 0.
        let (u, v) = ([2.0, -1.0, 0.0], [2.0, 0.0, -1.0]);
        let mut covariance = [[0.0; 3]; 3];
        for i in 0..3 {
            (0..3).for_each(|j| covariance[i][j] = 3.0 * u[i] * u[j] + v[i] * v[j]);
        }
        let [_, _, normal] = directions(covariance);
        let cosine = (normal[0] + 2.0 * normal[1] + 2.0 * normal[2]) / 3.0;
        assert!((cosine.abs() - 1.0).abs() < 1e-12, "{normal:?}");
        assert!((dot(normal, normal) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_bump_is_flattened_and_an_outlier_left_out() {
        let mut points: Vec<Point> =
            (0..400).map(|k| [f64::from(k % 20), f64::from(k / 20), 0.0]).collect();
        points[210][2] = 0.2;
        points.push([10.0, 10.0, 30.0]);
        let found = denoise(&points, &Denoise::default(), &Monitor::silent()).expect("not stopped");
        assert_eq!(found.outliers, [400]);
        assert!(found.points[210][2].abs() < 0.1, "{:?}", found.points[210]);
    }
}
