//! Rows that are ellipsoids, and whether a ball holds them: the ellipsoid around them that it is, in the frame I.

use taut::Items;

use super::body::{Body, Framed};
use super::interval::Interval;
use super::linear::exact;

/// Reads rows; none if one of them is no ellipsoid.
pub fn shapes(values: &[f64], columns: usize) -> Option<Vec<Shape>> {
    let dim = Items::Ellipsoids.dim(columns);
    let rows = values.chunks_exact(columns);
    rows.map(|row| Body::of(Items::Ellipsoids, dim, row).map(Shape)).collect()
}

/// An ellipsoid; where rounding has made its matrix indefinite, the narrowest one that the documentation lets it stand for.
pub struct Shape(Body);

impl Shape {
    /// Tests whether the item lies in a ball; `None` where 256 bits do not tell.
    pub fn is_within(&self, center: &[f64], tail: &[f64], radius: f64) -> Option<bool> {
        let dim = center.len();
        let tails = tail.iter().copied().chain(std::iter::repeat(0.0)).take(dim);
        let tails = exact(&tails.collect::<Vec<f64>>())?;
        let center: Vec<Interval> =
            exact(center)?.iter().zip(&tails).map(|(c, t)| c.plus(t)).collect();
        let unit = |j: usize| {
            (0..dim).map(|k| Interval::integer(i64::from(j == k))).collect::<Vec<Interval>>()
        };
        let frame: Vec<Vec<Interval>> = (0..dim).map(unit).collect();
        let limit = Interval::exact(radius)?.square();
        Framed::of(&frame, &center, &self.0).is_within(&limit)
    }
}

#[test]
fn an_ellipse_reaches_as_far_as_its_longer_axis() {
    let shape = &shapes(&[1.0, 0.0, 4.0, 0.0, 1.0], 5).unwrap()[0];
    assert_eq!(shape.is_within(&[0.0, 0.0], &[], 3.0f64.next_down()), Some(false));
    assert_eq!(shape.is_within(&[0.0, 0.0], &[], 3.0f64.next_up()), Some(true));
}
