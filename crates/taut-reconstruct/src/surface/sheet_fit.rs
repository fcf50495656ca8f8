//! A paraboloid fitted to the points near a place, robustly.
//!
//! *Problem.* Points near a place lie on one sheet with noise. A few of them are outliers, or lie on another sheet.
//! *Idea.* Height over the plane of least variance as a quadratic function, by weighted least squares: weights fall with the distance from
//! the place, and, from the second round on, with the residual (Tukey's biweight, scaled by the median of absolute residuals). Rounds after
//! the first turn the plane into the tangent plane of the last fit.
//! *Guarantee.* A function of the points in their order. Where they are too few for a paraboloid, or on too few lines, a plane is fitted.
//! *Reference.* Cazals and Pouget, *Estimating differential quantities using polynomial fitting of osculating jets*, Comput. Aided Geom.
//! Des. 22(2), 2005; Fleishman, Cohen-Or and Silva, *Robust moving least-squares fitting with sharp features*, ACM Trans. Graph. 24(3), 2005.

use taut_points::OrderBy;

use super::spheres::{Point, cross, dot, minus};

/// The biweight is 0 beyond this many standard deviations: 95 % efficient for normal residuals.
const BIWEIGHT_CUTOFF: f64 = 4.685;
/// Standard deviation of a normal variable over the median of its magnitude.
const DEVIATION_OVER_MEDIAN: f64 = 1.4826;
/// The kernel of distances reaches this far, over the distance of the farthest point.
const KERNEL_REACH: f64 = 1.1;
/// Places are moved at most this share of the distance of the farthest point.
const HEIGHT_MAX: f64 = 0.5;
/// The least pivot of the normal equations, whose entries are sums of weights at most 1.
const PIVOT_MIN: f64 = 1e-6;

/// A fitted sheet, seen from a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheet {
    /// Unit vector across the sheet, of either sign.
    pub(super) normal: Point,
    /// From the place along the normal to the sheet.
    pub(super) height: f64,
    /// Robust standard deviation of the points from the sheet.
    pub(super) deviation: f64,
    /// The distance of the farthest point.
    pub(super) reach: f64,
    /// The larger principal curvature next to the place, without sign.
    pub(super) curvature: f64,
    /// Share of the points that the last round gave no weight.
    pub(super) rejected: f64,
}

impl Sheet {
    /// The place moved onto the sheet, or itself if a move leads far away, as then the fit says nothing.
    pub(super) fn onto(&self, place: Point) -> Point {
        let is_far = self.height.abs() > HEIGHT_MAX * self.reach;
        let height = if is_far { 0.0 } else { self.height };
        [0, 1, 2].map(|k| place[k] + height * self.normal[k])
    }
}

/// Scratch of fits, kept between them.
#[derive(Debug, Default)]
pub(super) struct Fitting {
    /// Coordinates of each point in the frame, and the weight by distance.
    local: Vec<[f64; 4]>,
    residuals: Vec<f64>,
    sorted: Vec<f64>,
}

impl Fitting {
    /// Fits a sheet to points around a place in some rounds, at least one.
    pub(super) fn fit(&mut self, place: Point, points: &[Point], rounds: u32) -> Sheet {
        let mut axes = directions(covariance(points));
        let far = points.iter().map(|&p| dot(minus(p, place), minus(p, place)));
        let reach = far.fold(0.0, f64::max).sqrt();
        let mut sheet = Sheet {
            normal: axes[2],
            height: 0.0,
            deviation: 0.0,
            reach,
            curvature: 0.0,
            rejected: 0.0,
        };
        self.residuals.clear();
        if points.is_empty() || reach == 0.0 {
            return sheet;
        }
        let mut scale = f64::INFINITY;
        for round in 0..rounds.max(1) {
            self.set_frame(place, points, axes, KERNEL_REACH * reach);
            let terms = self.solve(scale);
            self.residuals.clear();
            self.residuals.extend(self.local.iter().map(|p| p[2] - value(&terms, p)));
            scale = self.deviation();
            let unit = KERNEL_REACH * reach;
            let [a, b, c, d, e, f] = terms;
            sheet.normal = axes[2];
            sheet.height = a * unit;
            sheet.deviation = scale * unit;
            // Eigenvalues of the second derivatives.
            let (mean, off) = (d + f, (d - f).hypot(e));
            sheet.curvature = (mean.abs() + off) / unit;
            sheet.rejected = self.rejected(scale);
            // The next plane is the tangent plane, if this one is steep.
            if round + 1 < rounds && b.hypot(c) < 1.0 {
                axes = tilted(axes, [b, c]);
            }
        }
        sheet
    }

    /// Puts points into the frame of a place, in units of the kernel's reach.
    fn set_frame(&mut self, place: Point, points: &[Point], axes: [Point; 3], unit: f64) {
        self.local.clear();
        self.local.extend(points.iter().map(|&point| {
            let off = minus(point, place).map(|x| x / unit);
            let [x, y, z] = axes.map(|axis| dot(off, axis));
            [x, y, z, (1.0 - dot(off, off)).powi(2)]
        }));
    }

    /// The coefficients of 1, x, y, x², xy, y²; residuals of the round before, if there are any, lower weights.
    fn solve(&self, scale: f64) -> [f64; 6] {
        // The normal equations, with the right-hand side in the last column.
        let mut a = [[0.0; 7]; 6];
        for (k, &[x, y, z, near]) in self.local.iter().enumerate() {
            let weight = near * self.residuals.get(k).map_or(1.0, |&r| biweight(r, scale));
            let terms = [1.0, x, y, x * x, x * y, y * y, z];
            for i in 0..6 {
                (i..7).for_each(|j| a[i][j] += weight * terms[i] * terms[j]);
            }
        }
        let quadratic = solved::<6>(a);
        let plane = || solved::<3>(a).map(|[a, b, c, ..]| [a, b, c, 0.0, 0.0, 0.0]);
        // Without two directions, the mean.
        let mean = || if a[0][0] > 0.0 { a[0][6] / a[0][0] } else { 0.0 };
        quadratic.or_else(plane).unwrap_or_else(|| [mean(), 0.0, 0.0, 0.0, 0.0, 0.0])
    }

    /// The robust standard deviation of residuals, corrected for the number of unknowns.
    fn deviation(&mut self) -> f64 {
        let count = self.residuals.len();
        self.sorted.clear();
        self.sorted.extend(self.residuals.iter().map(|r| r.abs()));
        let middle = count / 2;
        let (_, median, _) = self.sorted.select_nth_unstable_by(middle, f64::total_cmp);
        let freedom = count as f64 / (count as f64 - 6.0).max(1.0);
        DEVIATION_OVER_MEDIAN * *median * freedom.sqrt()
    }

    fn rejected(&self, scale: f64) -> f64 {
        let out = self.residuals.iter().filter(|&&r| biweight(r, scale) == 0.0);
        out.count() as f64 / self.residuals.len() as f64
    }
}

/// Tukey's weight of a residual, 1 where nothing is known of the scale.
fn biweight(residual: f64, scale: f64) -> f64 {
    if !(scale > 0.0 && scale.is_finite()) {
        return 1.0;
    }
    let share = residual / (BIWEIGHT_CUTOFF * scale);
    if share.abs() < 1.0 { (1.0 - share * share).powi(2) } else { 0.0 }
}

fn value(&[a, b, c, d, e, f]: &[f64; 6], &[x, y, ..]: &[f64; 4]) -> f64 {
    a + b * x + c * y + d * x * x + e * x * y + f * y * y
}

/// Solves the first `N` equations, of which the upper half and the right-hand side in column 6 are given.
fn solved<const N: usize>(mut a: [[f64; 7]; 6]) -> Option<[f64; 6]> {
    // Gauss without pivots, as the matrix is positive; from the last unknown up.
    for last in (0..N).rev() {
        if a[last][last].is_nan() || a[last][last] <= PIVOT_MIN {
            return None;
        }
        for i in 0..last {
            let factor = a[i][last] / a[last][last];
            (i..last).for_each(|j| a[i][j] -= factor * a[j][last]);
            a[i][6] -= factor * a[last][6];
        }
    }
    let mut found = [0.0; 6];
    for i in 0..N {
        let known: f64 = (0..i).map(|j| a[j][i] * found[j]).sum();
        found[i] = (a[i][6] - known) / a[i][i];
    }
    Some(found)
}

/// The frame whose third axis is normal to the plane that rises by `slope` along the first two.
fn tilted([u, v, normal]: [Point; 3], slope: [f64; 2]) -> [Point; 3] {
    let unit = |a: Point| {
        let size = dot(a, a).sqrt();
        a.map(|x| x / size)
    };
    let along = |k: usize| u[k] + slope[0] * normal[k];
    let first = unit([0, 1, 2].map(along));
    let across = |k: usize| normal[k] - slope[0] * u[k] - slope[1] * v[k];
    let third = unit([0, 1, 2].map(across));
    [first, cross(third, first), third]
}

/// The covariance of points, times their number.
pub(super) fn covariance(points: &[Point]) -> [[f64; 3]; 3] {
    let mut center = [0.0; 3];
    for point in points {
        (0..3).for_each(|k| center[k] += point[k] / points.len() as f64);
    }
    let mut covariance = [[0.0; 3]; 3];
    for &point in points {
        let off = minus(point, center);
        for i in 0..3 {
            (0..3).for_each(|j| covariance[i][j] += off[i] * off[j]);
        }
    }
    covariance
}

/// The directions of most, middle and least variance, by Jacobi's rotations.
pub(super) fn directions(a: [[f64; 3]; 3]) -> [Point; 3] {
    principal(a).map(|(_, axis)| axis)
}

/// Eigenvalues and unit eigenvectors of a symmetric matrix, the largest first.
pub(super) fn principal(mut a: [[f64; 3]; 3]) -> [(f64, Point); 3] {
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
    order.order_by(&|&p: &usize, &q: &usize| a[q][q].total_cmp(&a[p][p]));
    order.map(|k| (a[k][k], axes[k]))
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

    /// Points of z = 0.3 + 0.2x − 0.1y + 0.05x² − 0.1y² around the origin.
    fn saddle() -> Vec<Point> {
        let place = |k: i32| [f64::from(k % 7 - 3), f64::from(k / 7 - 3)];
        let lift = |[x, y]: [f64; 2]| [x, y, 0.3 + 0.2 * x - 0.1 * y + 0.05 * x * x - 0.1 * y * y];
        (0..49).map(place).map(lift).collect()
    }

    #[test]
    fn a_paraboloid_is_found_through_outliers() {
        let mut points = saddle();
        for k in 0..4 {
            points.push([f64::from(k), 1.5 - f64::from(k), 4.0]);
        }
        let sheet = Fitting::default().fit([0.0; 3], &points, 6);
        let place = sheet.normal.map(|x| sheet.height * x);
        let [x, y, z] = place;
        let truth = 0.3 + 0.2 * x - 0.1 * y + 0.05 * x * x - 0.1 * y * y;
        assert!((z - truth).abs() < 0.02, "{place:?}");
        assert!(sheet.deviation < 0.05, "{sheet:?}");
        assert!((sheet.rejected - 4.0 / 53.0).abs() < 1e-9, "{sheet:?}");
    }

    #[test]
    fn few_points_and_lines_have_a_plane_or_a_mean() {
        let line: Vec<Point> = (0..9).map(|k| [f64::from(k), 0.0, 1.0]).collect();
        let sheet = Fitting::default().fit([4.0, 0.0, 0.0], &line, 2);
        assert!(sheet.height.is_finite() && sheet.deviation.is_finite());
        let sheet = Fitting::default().fit([1.0; 3], &[[1.0; 3]], 2);
        assert_eq!((sheet.height, sheet.reach), (0.0, 0.0));
        assert_eq!(Fitting::default().fit([1.0; 3], &[], 2).height, 0.0);
    }
}
