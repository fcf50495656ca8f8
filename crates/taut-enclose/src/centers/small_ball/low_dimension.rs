//! The radius of the smallest ball of points and one more, in the plane and in space, where the ball without that is known.
//!
//! *Idea.* The new point lies on the border of the new ball, with at most d points of the old support: two are a diameter, more have one
//! smallest sphere through them. Of these spheres the smallest that holds the old support is its ball with the new point. A point
//! that this leaves outside is the next one to enter.
//! *Use.* A search asks for this radius far more often than for anything else, and mostly needs neither center nor multipliers.
//! *Trap.* Points that are nearly dependent, and rounds that rounding brings to no end, are left to the general method.

use super::super::items::{ItemSet, Position};
use super::{Ball, REACH_TOLERANCE};

/// More points than this do not enter one after the other, but by rounding.
const ROUNDS_MAX: usize = 16;
/// A triangle or tetrahedron whose size is a smaller part of that of the box of its edges is flat.
const SIZE_MIN: f64 = 1e-9;

/// Squares of edges whose products of three neither vanish nor overflow.
const SQUARES: std::ops::RangeInclusive<f64> = 1e-100..=1e100;

/// A squared distance may exceed that of a radius by this factor, which covers rounding.
const SQUARED_SLACK: f64 = (1.0 + REACH_TOLERANCE) * (1.0 + REACH_TOLERANCE);

/// Relative error of a squared radius, but for nearly dependent points. Spheres smaller than a known one by more than this do not hold its
/// support; to pass over others would leave a larger one than need be.
const SQUARED_ROUNDING: f64 = 1e-6;

/// Radii that are a smaller part of the coordinates of their center are left to the general method.
const LENGTH_MIN: f64 = 1e-7;

/// A sphere, and the points that determine it.
#[derive(Clone, Copy)]
struct Sphere<const D: usize> {
    center: [f64; D],
    radius_squared: f64,
    support: [[f64; D]; 4],
    count: usize,
}

/// Points of the plane or of space.
pub(super) trait Through: Copy {
    /// From the first of three or more points to the center of the smallest sphere through them; `None` where they are flat.
    fn to_center(edges: &[Self]) -> Option<Self>;
}

/// Returns the radius of the smallest ball of `members`, whose ball is given, and one point more; infinite where it is at least
/// `limit`, `None` where the point is inside already or rounding is in the way.
pub(super) fn radius_with<const D: usize, P: Position>(
    items: &ItemSet<P>,
    ball: &Ball<P>,
    members: &[u32],
    more: u32,
    limit: f64,
) -> Option<f64>
where
    [f64; D]: Through,
{
    let place = |item: u32| -> [f64; D] {
        let at = items.at(item as usize);
        std::array::from_fn(|axis| at[axis])
    };
    let center: [f64; D] = std::array::from_fn(|axis| ball.center.as_ref()[axis]);
    // Far from the origin, the rounding of coordinates is more than what is allowed for here.
    let largest = center.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if ball.radius < LENGTH_MIN * largest {
        return None;
    }
    let is_inside = square(place(more), center) <= ball.radius * ball.radius * SQUARED_SLACK;
    if is_inside || ball.support.len() > D + 1 {
        return None;
    }
    let mut support = [[0.0; D]; 4];
    support.iter_mut().zip(&ball.support).for_each(|(to, &item)| *to = place(item));
    let (mut count, mut entering) = (ball.support.len(), place(more));
    let mut before = ball.radius * ball.radius;
    for _ in 0..ROUNDS_MAX {
        let sphere = entered(&support[..count], entering, before)?;
        if sphere.radius_squared.sqrt() >= limit {
            return Some(f64::INFINITY);
        }
        if sphere.radius_squared <= before * SQUARED_SLACK {
            return None;
        }
        let mut most = sphere.radius_squared * SQUARED_SLACK;
        let mut farthest = None;
        let mut look_at = |item: u32| {
            let place = place(item);
            let reach = square(place, sphere.center);
            if reach > most {
                (farthest, most) = (Some(place), reach);
            }
        };
        members.iter().for_each(|&item| look_at(item));
        look_at(more);
        match farthest {
            None => return Some(sphere.radius_squared.sqrt()),
            Some(place) => entering = place,
        }
        (support, count, before) = (sphere.support, sphere.count, sphere.radius_squared);
    }
    None
}

/// The smallest sphere that holds a support and a point outside of its ball, whose squared radius is given.
#[inline(always)]
fn entered<const D: usize>(support: &[[f64; D]], p: [f64; D], before: f64) -> Option<Sphere<D>>
where
    [f64; D]: Through,
{
    match *support {
        [a] => Some(across(p, a)),
        [a, b] => of_triangle(p, a, b),
        _ => of_more(support, p, before),
    }
}

/// The sphere of which two points are a diameter.
fn across<const D: usize>(p: [f64; D], a: [f64; D]) -> Sphere<D> {
    let center = std::array::from_fn(|axis| 0.5 * (a[axis] + p[axis]));
    Sphere { center, radius_squared: 0.25 * square(a, p), support: [p, a, p, p], count: 2 }
}

/// The smallest sphere that holds a point p and two others, where p lies outside of the ball whose diameter these are. Returns `None` where
/// squares of edges leave [`SQUARES`], or the triangle is flat.
fn of_triangle<const D: usize>(p: [f64; D], a: [f64; D], b: [f64; D]) -> Option<Sphere<D>>
where
    [f64; D]: Through,
{
    let edges: [[f64; D]; 2] = [a, b].map(|end| std::array::from_fn(|axis| end[axis] - p[axis]));
    let [uu, vv] = edges.map(|edge| square(edge, [0.0; D]));
    if !SQUARES.contains(&uu) || !SQUARES.contains(&vv) {
        return None;
    }
    let uv: f64 = (0..D).map(|axis| edges[0][axis] * edges[1][axis]).sum();
    // The angle at a, or at b, is not acute, so that point lies in the ball whose diameter is from p to the other one.
    if uu <= uv {
        return Some(across(p, b));
    }
    if vv <= uv {
        return Some(across(p, a));
    }
    let to_center = <[f64; D]>::to_center(&edges)?;
    let radius_squared = square(to_center, [0.0; D]);
    let center = std::array::from_fn(|axis| p[axis] + to_center[axis]);
    Some(Sphere { center, radius_squared, support: [p, a, b, p], count: 3 })
}

/// The smallest of the spheres through the point that enters and some of three or more others.
fn of_more<const D: usize>(support: &[[f64; D]], p: [f64; D], before: f64) -> Option<Sphere<D>>
where
    [f64; D]: Through,
{
    let holds_all = |center: [f64; D], r2: f64| {
        support.iter().all(|&a| square(a, center) <= r2 * SQUARED_SLACK)
    };
    // Smaller spheres do not hold the support.
    let least = before * (1.0 - SQUARED_ROUNDING);
    for &a in support {
        let sphere = across(p, a);
        if sphere.radius_squared >= least && holds_all(sphere.center, sphere.radius_squared) {
            return Some(sphere);
        }
    }
    let mut edges = [[0.0; D]; 4];
    for (edge, a) in edges.iter_mut().zip(support) {
        *edge = std::array::from_fn(|axis| a[axis] - p[axis]);
    }
    if edges[..support.len()].iter().any(|&edge| !SQUARES.contains(&square(edge, [0.0; D]))) {
        return None;
    }
    let mut best: Option<(Sphere<D>, &[usize])> = None;
    for &with in subsets(D, support.len()) {
        let mut chosen = [[0.0; D]; 3];
        chosen.iter_mut().zip(with).for_each(|(to, &at)| *to = edges[at]);
        let to_center = <[f64; D]>::to_center(&chosen[..with.len()])?;
        let r2 = square(to_center, [0.0; D]);
        let is_best = r2 >= least && best.is_none_or(|(best, _)| r2 < best.radius_squared);
        let center = std::array::from_fn(|axis| p[axis] + to_center[axis]);
        if is_best && holds_all(center, r2) {
            let sphere =
                Sphere { center, radius_squared: r2, support: [p; 4], count: with.len() + 1 };
            best = Some((sphere, with));
        }
    }
    let (mut sphere, with) = best?;
    sphere.support[1..].iter_mut().zip(with).for_each(|(to, &at)| *to = support[at]);
    Some(sphere)
}

/// The sets of two to d of three or more points.
fn subsets(dim: usize, points: usize) -> &'static [&'static [usize]] {
    match (dim, points) {
        (2, 3) => &[&[0, 1], &[0, 2], &[1, 2]],
        (3, 3) => &[&[0, 1], &[0, 2], &[1, 2], &[0, 1, 2]],
        (3, 4) => &[
            &[0, 1],
            &[0, 2],
            &[1, 2],
            &[0, 1, 2],
            &[0, 3],
            &[1, 3],
            &[0, 1, 3],
            &[2, 3],
            &[0, 2, 3],
            &[1, 2, 3],
        ],
        _ => &[],
    }
}

impl Through for [f64; 2] {
    fn to_center(edges: &[Self]) -> Option<Self> {
        let &[u, v] = edges else { return None };
        let (uu, vv) = (square(u, [0.0; 2]), square(v, [0.0; 2]));
        let area = u[0] * v[1] - u[1] * v[0];
        // Also where numbers are none.
        let is_clear = area * area > SIZE_MIN * SIZE_MIN * (uu * vv);
        let part = 0.5 / area;
        is_clear.then(|| [(v[1] * uu - u[1] * vv) * part, (u[0] * vv - v[0] * uu) * part])
    }
}

impl Through for [f64; 3] {
    fn to_center(edges: &[Self]) -> Option<Self> {
        let [u, v] = [edges[0], edges[1]];
        let [uu, vv] = [u, v].map(|edge| square(edge, [0.0; 3]));
        let normal = cross(u, v);
        let nn = square(normal, [0.0; 3]);
        let (sum, size, is_clear) = match edges {
            [_, _] => {
                let (a, b) = (cross(normal, u), cross(v, normal));
                let sum = std::array::from_fn(|axis| vv * a[axis] + uu * b[axis]);
                (sum, nn, nn > SIZE_MIN * SIZE_MIN * uu * vv)
            }
            _ => {
                let w = edges[2];
                let ww = square(w, [0.0; 3]);
                let (a, b) = (cross(v, w), cross(w, u));
                let sum =
                    std::array::from_fn(|axis| uu * a[axis] + vv * b[axis] + ww * normal[axis]);
                let size = normal[0] * w[0] + normal[1] * w[1] + normal[2] * w[2];
                (sum, size, size.abs() > SIZE_MIN * (uu * vv * ww).sqrt())
            }
        };
        is_clear.then(|| sum.map(|x: f64| 0.5 * x / size))
    }
}

fn cross(u: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// |a − b|².
#[inline(always)]
fn square<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    let mut sum = 0.0;
    for axis in 0..D {
        sum += (a[axis] - b[axis]) * (a[axis] - b[axis]);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::super::items::Shape;
    use super::super::Workspace;
    use super::*;

    /// Counts the sets for which the general method is left to do the work; all others have its radius.
    fn left_to_others<const D: usize>(grid: bool, scale: f64) -> (usize, usize)
    where
        [f64; D]: Through + Position,
    {
        let mut state = 5u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695);
            let value = (state >> 33) as f64 / 2f64.powi(31);
            scale * if grid { (value * 4.0).floor() } else { value }
        };
        let (mut left, mut all) = (0, 0);
        for round in 0..2000 {
            let mut items = ItemSet::<[f64; D]>::new(Shape::Points, D);
            let count = 3 + round % 10;
            (0..count).for_each(|_| items.push(&[(); D].map(|()| draw()), 0.0));
            let members: Vec<u32> = (0..count as u32 - 1).collect();
            let (more, mut work) = (count as u32 - 1, Workspace::new(D));
            let ball = Ball::of_all(&items, &members, &mut work);
            if ball.holds(&items, more) {
                assert_eq!(radius_with::<D, _>(&items, &ball, &members, more, 9.0 * scale), None);
                continue;
            }
            let mut grown = ball.clone();
            grown.grow(&items, &members, more, f64::INFINITY, &mut work);
            all += 1;
            match radius_with::<D, _>(&items, &ball, &members, more, f64::INFINITY) {
                Some(radius) => assert!((radius / grown.radius - 1.0).abs() < 1e-12, "{radius}"),
                None => left += 1,
            }
            let limit = 0.999 * grown.radius;
            let limited = radius_with::<D, _>(&items, &ball, &members, more, limit);
            assert!(limited.is_none_or(|radius| radius == f64::INFINITY));
        }
        (left, all)
    }

    #[test]
    fn triangles_that_are_none_have_the_diameter_that_holds_all() {
        let radius = |p: [f64; 2], a: [f64; 2], b: [f64; 2]| {
            of_triangle(p, a, b).map(|sphere| (sphere.radius_squared.sqrt(), sphere.count))
        };
        // A right angle at a, or at b; the third point on the line of the others; twice the same.
        assert_eq!(radius([2.0, 0.0], [0.0, 0.0], [0.0, 2.0]), Some((2f64.sqrt(), 2)));
        assert_eq!(radius([2.0, 0.0], [0.0, 2.0], [0.0, 0.0]), Some((2f64.sqrt(), 2)));
        assert_eq!(radius([4.0, 0.0], [0.0, 0.0], [1.0, 0.0]), Some((2.0, 2)));
        assert_eq!(radius([4.0, 0.0], [1.0, 0.0], [0.0, 0.0]), Some((2.0, 2)));
        assert_eq!(radius([3.0, 0.0], [1.0, 0.0], [1.0, 0.0]), Some((1.0, 2)));
        // Three on a circle, and edges whose products leave the range of numbers.
        let (found, count) = radius([0.0, 5.0], [-4.0, -3.0], [4.0, -3.0]).unwrap();
        assert!((found - 5.0).abs() < 1e-14 && count == 3);
        for scale in [1e-170, 1e160] {
            let place = |x: f64, y: f64| [scale * x, scale * y];
            assert_eq!(radius(place(0.0, 5.0), place(-4.0, -3.0), place(4.0, -3.0)), None);
        }
    }

    #[test]
    fn radii_are_those_of_the_general_method() {
        for scale in [1.0, 1e-48, 1e48] {
            for (left, all) in
                [left_to_others::<2>(false, scale), left_to_others::<3>(false, scale)]
            {
                assert!(all > 500 && left * 100 < all, "{left} of {all}, {scale}");
            }
            for (left, all) in [left_to_others::<2>(true, scale), left_to_others::<3>(true, scale)]
            {
                assert!(all > 500 && left < all, "{left} of {all}, {scale}");
            }
        }
        // Squares of edges leave the range in which products of three are safe.
        for scale in [1e-60, 1e60, 1e-150] {
            left_to_others::<2>(false, scale);
            left_to_others::<3>(true, scale);
        }
    }
}
