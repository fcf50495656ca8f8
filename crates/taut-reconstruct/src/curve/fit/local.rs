//! A parabola through the points of a window, in the frame of its own main direction.
//!
//! *Idea.* The main direction of the window is the tangent to within its curvature; along it a parabola is fitted by least
//! squares, twice over what three times the median residual spares, so that points off the curve do not count.
//! *Guarantee.* A function of the points of the window alone, and it turns and scales with them.
//! *Trap.* A line would do for the tangent but not for the width: at the least feature size a window that is four times as
//! long as wide does not exist, since κr²/2 is wide by then; the residuals of a parabola stay narrow.

type Point = [f64; 2];

/// A parabola v = a + bu + cu² in a frame (u along the tangent, v to its left) at `origin`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parabola {
    /// Origin of the frame.
    pub(super) origin: Point,
    /// Unit vector of u.
    pub(super) tangent: Point,
    /// a, b, c.
    pub(super) coefficients: [f64; 3],
    /// Mean square of the residuals of the points that count, over their number less three.
    pub(super) variance: f64,
    /// Points that count.
    pub(super) kept: usize,
}

impl Parabola {
    /// The place on the parabola at u = 0.
    pub(super) fn projection(&self) -> Point {
        let [tx, ty] = self.tangent;
        let a = self.coefficients[0];
        [self.origin[0] - a * ty, self.origin[1] + a * tx]
    }

    /// The unit tangent there.
    pub(super) fn direction(&self) -> Point {
        let [tx, ty] = self.tangent;
        let b = self.coefficients[1];
        let norm = b.hypot(1.0);
        [(tx - b * ty) / norm, (ty + b * tx) / norm]
    }

    /// Half the curvature there, above 0 where it bends to the left.
    pub(super) fn bend(&self) -> f64 {
        let [_, b, c] = self.coefficients;
        c / b.hypot(1.0).powi(3)
    }

    /// The place on the parabola at u.
    pub(super) fn place(&self, u: f64) -> Point {
        let ([tx, ty], [a, b, c]) = (self.tangent, self.coefficients);
        let v = a + u * (b + u * c);
        [self.origin[0] + u * tx - v * ty, self.origin[1] + u * ty + v * tx]
    }

    /// The derivative of the place by u.
    pub(super) fn derivative(&self, u: f64) -> Point {
        let ([tx, ty], [_, b, c]) = (self.tangent, self.coefficients);
        let slope = b + 2.0 * u * c;
        [tx - slope * ty, ty + slope * tx]
    }

    /// The unit tangent at u.
    pub(super) fn direction_at(&self, u: f64) -> Point {
        let derivative = self.derivative(u);
        let norm = derivative[0].hypot(derivative[1]);
        derivative.map(|x| x / norm)
    }

    /// The same with u the other way.
    pub(super) fn reversed(&self) -> Self {
        let [a, b, c] = self.coefficients;
        Self { tangent: self.tangent.map(|x| -x), coefficients: [-a, b, -c], ..*self }
    }

    /// A point in the frame.
    #[inline]
    pub(super) fn local(&self, point: Point) -> Point {
        let (dx, dy) = (point[0] - self.origin[0], point[1] - self.origin[1]);
        let [tx, ty] = self.tangent;
        [dx * tx + dy * ty, dy * tx - dx * ty]
    }

    /// How far a point of the frame is above the parabola.
    #[inline]
    pub(super) fn residual(&self, [u, v]: Point) -> f64 {
        let [a, b, c] = self.coefficients;
        v - (a + u * (b + u * c))
    }
}

/// The window fitted; scratch space that is used again.
#[derive(Default)]
pub(super) struct Window {
    /// The points in the frame.
    pub(super) local: Vec<Point>,
    /// How far each of them is from the parabola; and the same in some other order.
    residuals: Vec<f64>,
    ranked: Vec<f64>,
}

impl Window {
    /// The parabola of a window around `origin`; none for fewer than five points, or where they do not determine one.
    pub(super) fn fit(
        &mut self,
        origin: Point,
        points: impl Iterator<Item = Point> + Clone,
    ) -> Option<Parabola> {
        let tangent = main_direction(origin, points.clone())?;
        let mut parabola =
            Parabola { origin, tangent, coefficients: [0.0; 3], variance: f64::INFINITY, kept: 0 };
        self.local.clear();
        self.local.extend(points.map(|p| parabola.local(p)));
        let (mut most, reach) = (f64::INFINITY, reach(&self.local));
        self.residuals.clear();
        self.residuals.resize(self.local.len(), 0.0);
        for _ in 0..3 {
            let counted = self.local.iter().zip(&self.residuals).filter(|(_, r)| **r <= most);
            let (coefficients, kept) = least_squares(counted.map(|(&p, _)| p), reach)?;
            let fitted = Parabola { coefficients, kept, ..parabola };
            let residuals = self.local.iter().map(|&p| fitted.residual(p).abs());
            residuals.zip(&mut self.residuals).for_each(|(r, place)| *place = r);
            self.ranked.clone_from(&self.residuals);
            let middle = self.ranked.len() / 2;
            let (_, &mut median, _) = self.ranked.select_nth_unstable_by(middle, f64::total_cmp);
            // 1.4826 times the median residual is σ for normal noise; for uniform noise the edge is at 1.35 of it.
            most = 3.0 * 1.4826 * median;
            let inside = self.residuals.iter().filter(|r| **r <= most);
            let (count, sum) =
                inside.fold((0usize, 0.0), |(count, sum), r| (count + 1, sum + r * r));
            parabola =
                Parabola { variance: sum / (count.max(4) - 3) as f64, kept: count, ..fitted };
            if count == self.local.len() {
                break;
            }
        }
        Some(parabola)
    }
}

/// The unit vector along which points spread most, from `origin`'s surroundings; none if they are all in one place.
fn main_direction(origin: Point, points: impl Iterator<Item = Point> + Clone) -> Option<Point> {
    let shifted = points.map(|p| [p[0] - origin[0], p[1] - origin[1]]);
    let (count, sum) =
        shifted.clone().fold((0.0, [0.0; 2]), |(n, s), p| (n + 1.0, [s[0] + p[0], s[1] + p[1]]));
    if count < 5.0 {
        return None;
    }
    let mean = [sum[0] / count, sum[1] / count];
    let [xx, xy, yy] = shifted.fold([0.0; 3], |[xx, xy, yy], p| {
        let (x, y) = (p[0] - mean[0], p[1] - mean[1]);
        [xx + x * x, xy + x * y, yy + y * y]
    });
    // tan 2φ = 2·xy/(xx − yy), φ the angle of the larger eigenvalue.
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    (xx + yy > 0.0).then(|| [angle.cos(), angle.sin()])
}

/// How far from the origin points are, along the first axis.
pub(super) fn reach(points: &[Point]) -> f64 {
    points.iter().fold(0.0, |most, p| if p[0].abs() > most { p[0].abs() } else { most })
}

/// The parabola of least squares through points no farther along than `reach`, and how many they are; none where they do not determine it.
pub(super) fn least_squares(
    points: impl Iterator<Item = Point>,
    reach: f64,
) -> Option<([f64; 3], usize)> {
    if reach == 0.0 {
        return None;
    }
    // Powers of u/reach are at most 1, so that the sums are of one size.
    let mut powers = [0.0; 5];
    let mut moments = [0.0; 3];
    let mut kept = 0;
    for [u, v] in points {
        let u = u / reach;
        let u2 = u * u;
        powers = [
            powers[0] + 1.0,
            powers[1] + u,
            powers[2] + u2,
            powers[3] + u2 * u,
            powers[4] + u2 * u2,
        ];
        moments = [moments[0] + v, moments[1] + u * v, moments[2] + u2 * v];
        kept += 1;
    }
    let [s0, s1, s2, s3, s4] = powers;
    let solution = cholesky([[s0, s1, s2], [s1, s2, s3], [s2, s3, s4]], moments)?;
    Some(([solution[0], solution[1] / reach, solution[2] / (reach * reach)], kept))
}

/// The solution of a positive definite system of three; none where it is not safely so.
pub(super) fn cholesky(m: [[f64; 3]; 3], right: [f64; 3]) -> Option<[f64; 3]> {
    let mut l = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..=i {
            let mut sum = m[i][j];
            for k in 0..j {
                sum -= l[i][k] * l[j][k];
            }
            if i == j {
                if sum.is_nan() || sum <= 1e-12 * m[i][i] {
                    return None;
                }
                l[i][i] = sum.sqrt();
            } else {
                l[i][j] = sum / l[j][j];
            }
        }
    }
    let mut y = [0.0; 3];
    for i in 0..3 {
        y[i] = (0..i).fold(right[i], |sum, k| sum - l[i][k] * y[k]) / l[i][i];
    }
    for i in (0..3).rev() {
        y[i] = (i + 1..3).fold(y[i], |sum, k| sum - l[k][i] * y[k]) / l[i][i];
    }
    Some(y)
}
