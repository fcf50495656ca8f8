//! The ellipsoids in the units of the search, and how far each reaches from centers.

use taut_kernels::vector::dot;
use taut_kernels::{Center, DoubleDouble};
use taut_points::parallel::{IntoParallel, ParallelSlice};

use crate::Error;
use crate::centers::items::Position;
use crate::shapes::Shapes;
use crate::shapes::axes::{Axes, diagonal, power_below, units};
use crate::shapes::eigen::eigen;
use crate::shapes::frame::{Framed, Map};
use crate::shapes::reach::{alternatives, farthest};

/// Beyond a coordinate, in the units of the search, as many roundings as places pass.
const PLACE_ROUNDINGS: f64 = f64::EPSILON;

/// Reaches that differ by no more than this part of them are measured again.
const REACH_DOUBT: f64 = 1e-12;

/// Ellipsoids about an origin among them.
pub(super) struct Bodies<'a> {
    shapes: &'a Shapes,
    origin: Center,
    /// The unit of the search, a power of two.
    pub(super) scale: f64,
    unit: Vec<f64>,
    framed: Framed,
    axes: Vec<Axes>,
    /// The longest half axis of each.
    pub(super) longest: Vec<f64>,
    /// No coordinate of a point is off by more.
    pub(super) place_error: f64,
}

/// How an ellipsoid is served.
#[derive(Clone, Copy, Debug)]
pub(super) struct ServedWhole {
    /// The center from which it reaches least far, the first of several.
    pub(super) center: usize,
    pub(super) reach: f64,
}

impl<'a> Bodies<'a> {
    pub(super) fn of(shapes: &'a Shapes) -> Result<Self, Error> {
        let (origin, scale) = units(shapes)?;
        let unit = diagonal(shapes.dim(), 1.0 / scale);
        let framed = Framed::of(shapes, Map { matrix: &unit, center: &origin });
        if !framed.is_finite() {
            return Err(Error::Overflow);
        }
        let axes = Axes::of_all(&framed);
        let longest: Vec<f64> = axes
            .iter()
            .map(|axes| axes.squares.iter().copied().fold(0.0, f64::max).sqrt())
            .collect();
        let extent = |i: usize| framed.center(i).iter().map(|x| x.abs() + longest[i]).sum::<f64>();
        let extent = (0..framed.len()).map(extent).fold(0.0, f64::max);
        let place_error = PLACE_ROUNDINGS * extent;
        Ok(Bodies { shapes, origin, scale, unit, framed, axes, longest, place_error })
    }

    pub(super) fn len(&self) -> usize {
        self.framed.len()
    }

    pub(super) fn dim(&self) -> usize {
        self.framed.rank
    }

    pub(super) fn center(&self, i: usize) -> &[f64] {
        self.framed.center(i)
    }

    /// How far an ellipsoid reaches from a place.
    pub(super) fn reach(&self, i: usize, from: &[f64]) -> f64 {
        let axes = &self.axes[i];
        farthest(&axes.squares, &axes.along(self.center(i), from)).square.sqrt()
    }

    /// The directions of the ends of a longest axis; that of the center, for a point.
    pub(super) fn ends(&self, i: usize) -> Vec<Vec<f64>> {
        let (axes, dim) = (&self.axes[i], self.dim());
        if self.shapes.is_point(i) {
            return vec![vec![0.0; dim]];
        }
        let order = |a: &usize, b: &usize| axes.squares[*a].total_cmp(&axes.squares[*b]);
        let longest = (0..dim).max_by(order).unwrap_or(0);
        let axis = &axes.directions[longest * dim..][..dim];
        vec![axis.to_vec(), axis.iter().map(|v| -v).collect()]
    }

    /// The directions of the points that lie farthest from a place, and of those that are nearly as far, but none within `beyond`.
    pub(super) fn farthest(&self, i: usize, from: &[f64], beyond: f64) -> Vec<Vec<f64>> {
        let axes = &self.axes[i];
        let h = axes.along(self.center(i), from);
        let best = farthest(&axes.squares, &h);
        let mut directions = vec![];
        alternatives(&axes.squares, &h, &best, &[], |square, beta| {
            if square > beyond * beyond {
                directions.push(axes.direction(beta));
            }
        });
        directions
    }

    /// The point of an ellipsoid that lies farthest in a direction, rounded once.
    pub(super) fn point(&self, i: usize, direction: &[f64]) -> Vec<f64> {
        self.map(&self.origin).touching(self.shapes, i, direction)
    }

    /// The way in which each ellipsoid is served by these centers, of which there is one at least.
    pub(super) fn served<P: Position>(&self, centers: &[P]) -> Vec<ServedWhole> {
        let serve = |i: usize| {
            let distance = |center: &P| length(self.center(i), center.as_ref());
            let distances: Vec<f64> = centers.iter().map(distance).collect();
            let near = |a: &usize, b: &usize| distances[*a].total_cmp(&distances[*b]);
            let first = (0..centers.len()).min_by(near).unwrap_or(0);
            let reach = self.reach(i, centers[first].as_ref());
            let mut served = ServedWhole { center: first, reach };
            for (center, place) in centers.iter().enumerate() {
                // Its own center is a point of the ellipsoid.
                if center == first || distances[center] > served.reach {
                    continue;
                }
                let reach = self.reach(i, place.as_ref());
                let is_first = reach == served.reach && center < served.center;
                if reach < served.reach || is_first {
                    served = ServedWhole { center, reach };
                }
            }
            served
        };
        (0..self.len()).into_par_iter().with_min_len(64).map(serve).collect()
    }

    /// The same for centers among the rows. Where it is open from which of them an ellipsoid reaches least far, those are measured as
    /// they are.
    pub(super) fn served_from(&self, centers: &[Vec<f64>]) -> Vec<ServedWhole> {
        let inside: Vec<Vec<f64>> = centers.iter().map(|center| self.bring_in(center)).collect();
        let mut served = self.served(&inside);
        served.par_iter_mut().enumerate().with_min_len(64).for_each(|(i, served)| {
            let most = served.reach * (1.0 + REACH_DOUBT) + 8.0 * self.place_error;
            let could_serve = |&center: &usize| {
                length(self.center(i), &inside[center]) <= most
                    && self.reach(i, &inside[center]) <= most
            };
            let open: Vec<usize> = (0..centers.len()).filter(could_serve).collect();
            if open.len() > 1 {
                let measured =
                    |center: usize| (self.reach_from(i, &centers[center]) / self.scale, center);
                let least = open.into_iter().map(measured).min_by(|a, b| a.0.total_cmp(&b.0));
                if let Some((reach, center)) = least {
                    *served = ServedWhole { center, reach };
                }
            }
        });
        served
    }

    /// A place of the search in the space of the rows, rounded.
    pub(super) fn bring_out(&self, place: &[f64]) -> Vec<f64> {
        let coordinates = self.origin.high.iter().zip(place);
        coordinates.map(|(&o, &y)| DoubleDouble::sum(o, y * self.scale).high).collect()
    }

    /// A place among the rows in the units of the search.
    fn bring_in(&self, place: &[f64]) -> Vec<f64> {
        self.map(&self.origin).point(place)
    }

    /// How far an ellipsoid reaches from a place among the rows, in the unit of the rows, but for the rounding of a few sums; whatever
    /// its size, which decides the unit of these sums.
    pub(super) fn reach_from(&self, i: usize, place: &[f64]) -> f64 {
        let parts = self.shapes.center(i).iter().zip(place).enumerate();
        let size = parts.map(|(j, (m, c))| (m - c).abs().max(self.shapes.width(i, j)));
        let size = size.fold(0.0, f64::max);
        if size == 0.0 || !size.is_finite() {
            return size;
        }
        let scale = power_below(size);
        let (unit, center) =
            (diagonal(self.dim(), 1.0 / scale), Center { high: place.to_vec(), low: vec![] });
        let map = Map { matrix: &unit, center: &center };
        let (squares, vectors) = eigen(&mut map.shape_of(self.shapes, i), self.dim());
        let offset = map.center_of(self.shapes, i);
        let h: Vec<f64> = vectors.chunks_exact(self.dim()).map(|v| dot(v, &offset)).collect();
        farthest(&squares, &h).square.sqrt() * scale
    }

    fn map<'b>(&'b self, center: &'b Center) -> Map<'b> {
        Map { matrix: &self.unit, center }
    }
}

/// |a − b|.
pub(super) fn length(a: &[f64], b: &[f64]) -> f64 {
    crate::centers::items::distance(a, b)
}
