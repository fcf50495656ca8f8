//! Natural-neighbor interpolation.
//!
//! Idea: put the point among the sites; its Voronoi cell is taken from the cells of its natural neighbors, and the
//! share that each of them loses is its weight.
//! Guarantee: weights are at least 0 and sum to 1, and the weighted mean of the sites is the point (to rounding), so
//! linear functions are reproduced. Between the sites the interpolant is smooth, at the sites continuous.
//! Trap: next to the hull the cell of the point is long; the box it is cut from grows until it is not felt.
//! Reference: Sibson 1980, *A vector identity for the Dirichlet tessellation*.

use super::convex::{Body, HalfSpace, Polygon, Polyhedron};
use super::locator::{Location, Locator};
use crate::vector::{difference, largest};

/// The box grows by this factor until the cell keeps clear of it.
const BOX_GROWTH: f64 = 16.0;
/// The box grows at most this often; then the point is on the hull as far as `f64` can tell, and the part that counts
/// is inside anyway.
const BOX_GROWTHS_MAX: u32 = 12;

/// The operations that `weights_in` needs of a body.
trait Touches<const D: usize>: Body<D> {
    /// Tests whether a corner reaches beyond the box around `center`.
    fn touches(&self, center: [f64; D], half: f64) -> bool;
}

fn outside<const D: usize>(p: &[f64; D], center: [f64; D], half: f64) -> bool {
    (0..D).any(|i| (p[i] - center[i]).abs() > half * (1.0 - 1e-9))
}

impl Touches<2> for Polygon {
    fn touches(&self, center: [f64; 2], half: f64) -> bool {
        self.corners.iter().any(|p| outside(p, center, half))
    }
}

impl Touches<3> for Polyhedron {
    fn touches(&self, center: [f64; 3], half: f64) -> bool {
        self.faces.iter().flatten().any(|p| outside(p, center, half))
    }
}

/// The shares that sites at `neighbors` lose to a new site at 0.
fn weights<const D: usize, B: Touches<D>>(neighbors: &[[f64; D]]) -> Vec<f64> {
    // Blown up to size 1, so that volumes are neither 0 nor infinite.
    let size = largest(neighbors);
    let neighbors: Vec<[f64; D]> = neighbors.iter().map(|n| n.map(|x| x / size)).collect();
    let mut half = 4.0;
    let mut taken = B::from_box([-half; D], [half; D]);
    for _ in 0..BOX_GROWTHS_MAX {
        taken = B::from_box([-half; D], [half; D]);
        neighbors.iter().for_each(|&n| taken.cut(&HalfSpace::nearer_to([0.0; D], n)));
        if !taken.touches([0.0; D], half) {
            break;
        }
        half *= BOX_GROWTH;
    }
    let shares: Vec<f64> = (0..neighbors.len())
        .map(|k| {
            let mut share = taken.clone();
            for (other, &n) in neighbors.iter().enumerate() {
                if other != k && !share.is_empty() {
                    share.cut(&HalfSpace::nearer_to(neighbors[k], n));
                }
            }
            share.volume().max(0.0)
        })
        .collect();
    let whole: f64 = shares.iter().sum();
    shares.into_iter().map(|share| share / whole).collect()
}

/// Sibson's weights of the natural neighbors of the origin of the plane; they sum to 1.
///
/// They are the same bits for the same neighbors in the same order.
pub(crate) fn sibson_weights(neighbors: &[[f64; 2]]) -> Vec<f64> {
    weights::<2, Polygon>(neighbors)
}

/// Interpolation in the plane and in space.
macro_rules! interpolation {
    ($d:literal, $v:literal, $body:ty) => {
        impl Locator<'_, $d, $v> {
            /// Sibson's coordinates of a point: its natural neighbors with the shares they lose to it; they sum to 1.
            ///
            /// `None` outside the hull, where they mean nothing, and where it lies [`Nowhere`](Location::Nowhere).
            /// O(k²) cuts for k natural neighbors.
            pub fn natural_coordinates(&self, point: [f64; $d]) -> Option<Vec<(u32, f64)>> {
                match self.locate(point) {
                    Location::Site(site) => return Some(vec![(site, 1.0)]),
                    Location::Inside(_) => {}
                    Location::Outside(_) | Location::Nowhere => return None,
                }
                let sites = self.natural_neighbors(point);
                // Inside the hull the scale of the sites does the point no harm.
                let scale = self.triangulation.scale();
                let here = point.map(|x| scale.apply(x));
                let site =
                    |&s: &u32| difference(self.triangulation.sites.coordinates[s as usize], here);
                let relative: Vec<[f64; $d]> = sites.iter().map(site).collect();
                Some(sites.into_iter().zip(weights::<$d, $body>(&relative)).collect())
            }

            /// The natural-neighbor interpolant at a point of values given for each row of the input.
            ///
            /// `None` where [`natural_coordinates`](Self::natural_coordinates) are. Of equal rows the value of the
            /// first counts.
            ///
            /// # Panics
            /// If there are fewer values than rows.
            pub fn interpolate(&self, values: &[f64], point: [f64; $d]) -> Option<f64> {
                let coordinates = self.natural_coordinates(point)?;
                Some(
                    coordinates
                        .iter()
                        .map(|&(s, w)| w * values[self.triangulation.row(s) as usize])
                        .sum(),
                )
            }
        }
    };
}
interpolation!(2, 3, Polygon);
interpolation!(3, 4, Polyhedron);

#[cfg(test)]
mod tests {
    use crate::numbers::numbers;
    use crate::{DelaunayOptions, Plane, Space};
    use taut_points::Points;

    #[test]
    fn linear_functions_are_reproduced() {
        let values = numbers(1000, 23);
        let points = Points::new(&values, 2).expect("whole rows");
        let plane = Plane::build(&points, &DelaunayOptions::default()).expect("finite");
        let heights: Vec<f64> = values.chunks(2).map(|p| 3.0 * p[0] - 2.0 * p[1] + 0.5).collect();
        let locator = plane.locator();
        let mut inside = 0;
        for q in numbers(400, 24).chunks(2) {
            if let Some(height) = locator.interpolate(&heights, [q[0], q[1]]) {
                inside += 1;
                assert!((height - (3.0 * q[0] - 2.0 * q[1] + 0.5)).abs() < 1e-9, "{q:?}: {height}");
            }
        }
        assert!(inside > 150);
        assert_eq!(locator.interpolate(&heights, [values[0], values[1]]), Some(heights[0]));
        assert_eq!(locator.interpolate(&heights, [2.0, 2.0]), None);
    }

    #[test]
    fn weights_are_the_same_at_any_scale() {
        let values = numbers(300, 23);
        let weights_at = |scale: f64| {
            let scaled: Vec<f64> = values.iter().map(|x| x * scale).collect();
            let points = Points::new(&scaled, 3).expect("whole rows");
            let space = Space::build(&points, &DelaunayOptions::default()).expect("finite");
            space
                .locator()
                .natural_coordinates([0.5 * scale, 0.4 * scale, 0.6 * scale])
                .expect("inside")
        };
        let expected = weights_at(1.0);
        for scale in [2f64.powi(-1000), 2f64.powi(-300), 2f64.powi(300), 2f64.powi(1000)] {
            for ((s, w), (t, v)) in weights_at(scale).into_iter().zip(&expected) {
                assert!(s == *t && (w - v).abs() < 1e-12, "{scale}");
            }
        }
    }

    #[test]
    fn linear_functions_are_reproduced_in_space() {
        let values = numbers(1500, 23);
        let points = Points::new(&values, 3).expect("whole rows");
        let space = Space::build(&points, &DelaunayOptions::default()).expect("finite");
        let heights: Vec<f64> = values.chunks(3).map(|p| 3.0 * p[0] - 2.0 * p[1] + p[2]).collect();
        let locator = space.locator();
        let mut inside = 0;
        for q in numbers(300, 24).chunks(3) {
            if let Some(height) = locator.interpolate(&heights, [q[0], q[1], q[2]]) {
                inside += 1;
                assert!(
                    (height - (3.0 * q[0] - 2.0 * q[1] + q[2])).abs() < 1e-8,
                    "{q:?}: {height}"
                );
            }
        }
        assert!(inside > 50);
    }

    /// In the middle of a square grid all four corners lose alike.
    #[test]
    fn symmetric_neighbors_have_equal_weights() {
        let grid: Vec<f64> = (0..25).flat_map(|i| [f64::from(i % 5), f64::from(i / 5)]).collect();
        let points = Points::new(&grid, 2).expect("whole rows");
        let plane = Plane::build(&points, &DelaunayOptions::default()).expect("finite");
        let found = plane.locator().natural_coordinates([1.5, 2.5]).expect("inside");
        let heavy: Vec<f64> = found.iter().map(|&(_, w)| w).filter(|&w| w > 1e-12).collect();
        assert_eq!(heavy.len(), 4);
        assert!(heavy.iter().all(|w| (w - 0.25).abs() < 1e-12), "{heavy:?}");
    }
}
