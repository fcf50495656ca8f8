//! Voronoi cells, clipped to a box.
//!
//! Idea: the cell of a site is cut from the box by the bisectors to the sites that the triangulation joins it with; no
//! other site has a say, and cells that reach to infinity, or sets that span a line only, are no special case.
//! Guarantee: the cells of all sites fill the box, to rounding. Which sites have a say is exact.

use taut_points::OrderBy;

use super::convex::{Body, HalfSpace, Polygon, Polyhedron};
use super::locator::Locator;
use crate::Triangulation;
use crate::vector::difference;

/// Farther than any site in the scale of the sites; boxes that reach beyond are cut off here, so that products stay
/// finite.
const COORDINATE_MAX: f64 = (1u64 << 50) as f64;

/// What of the box is nearer to `here` than to any of the other places, which come in the order of their coordinates, so that
/// the corners are one function of the set. Relative to `here`, as products of coordinates as they are given may leave the
/// range of `f64`.
pub(crate) fn clipped<const D: usize, B: Body<D>>(
    here: [f64; D],
    others: &mut [[f64; D]],
    [low, high]: [[f64; D]; 2],
) -> B {
    others.order_by(&|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    let relative =
        |p: [f64; D]| difference(p.map(|x| x.clamp(-COORDINATE_MAX, COORDINATE_MAX)), here);
    let mut body = B::from_box(relative(low), relative(high));
    for &mut there in others {
        if !body.is_empty() {
            body.cut(&HalfSpace::nearer_to([0.0; D], difference(there, here)));
        }
    }
    // Adding 0 turns −0 into 0.
    body.map(|p| std::array::from_fn(|i| p[i] + here[i] + 0.0))
}

impl<const D: usize, const V: usize> Locator<'_, D, V> {
    /// Returns what of the box is nearer to `site` than to any other site.
    fn cell<B: Body<D>>(&self, site: u32, low: [f64; D], high: [f64; D]) -> B {
        let Triangulation { sites, .. } = self.triangulation;
        let at = |&site: &u32| sites.coordinates[site as usize];
        let mut others: Vec<[f64; D]> = self.adjacent(site).iter().map(at).collect();
        let corners = [low, high].map(|p| p.map(|x| sites.scale.apply(x)));
        let back = sites.scale.inverse();
        clipped::<D, B>(at(&site), &mut others, corners).map(|p| p.map(|x| back.apply(x)))
    }
}

impl Locator<'_, 2, 3> {
    /// The Voronoi cell of a site, clipped to the box between two corners.
    ///
    /// O(k²) for k neighbors.
    ///
    /// # Panics
    /// If there is no such site.
    pub fn voronoi_cell(&self, site: u32, low: [f64; 2], high: [f64; 2]) -> Polygon {
        self.cell(site, low, high)
    }
}

impl Locator<'_, 3, 4> {
    /// The Voronoi cell of a site, clipped to the box between two corners.
    ///
    /// O(k²) for k neighbors.
    ///
    /// # Panics
    /// If there is no such site.
    pub fn voronoi_cell(&self, site: u32, low: [f64; 3], high: [f64; 3]) -> Polyhedron {
        self.cell(site, low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::Polygon;
    use crate::numbers::numbers;
    use crate::{DelaunayOptions, Plane, Space};
    use taut_points::Points;

    /// Cells have the same shape at any scale.
    #[test]
    fn cells_of_extreme_scales_are_the_same() {
        let values = numbers(300, 12);
        let area_in = |scale: f64| {
            let scaled: Vec<f64> = values.iter().map(|x| x * scale).collect();
            let points = Points::new(&scaled, 2).expect("whole rows");
            let plane = Plane::build(&points, &DelaunayOptions::default()).expect("finite");
            let cell = plane.locator().voronoi_cell(7, [0.0; 2], [scale; 2]);
            assert!(cell.corners.len() > 2);
            Polygon { corners: cell.corners.iter().map(|p| p.map(|x| x / scale)).collect() }.area()
        };
        let expected = area_in(1.0);
        for scale in [1e-300, 1e-150, 1e150, 1e300] {
            assert!((area_in(scale) / expected - 1.0).abs() < 1e-9, "{scale}");
        }
    }

    /// The cells of all sites fill the box, whatever the sites span.
    #[test]
    fn cells_fill_the_box() {
        let line: Vec<f64> =
            (0..20).flat_map(|i| [f64::from(i) * 0.05, f64::from(i) * 0.02]).collect();
        let flat: Vec<f64> =
            numbers(80, 11).chunks(2).flat_map(|p| [p[0], p[1], p[0] + p[1]]).collect();
        for values in [numbers(600, 11), line, vec![0.3, 0.4]] {
            let points = Points::new(&values, 2).expect("whole rows");
            let plane = Plane::build(&points, &DelaunayOptions::default()).expect("finite");
            let locator = plane.locator();
            let cells = (0..plane.site_count() as u32)
                .map(|s| locator.voronoi_cell(s, [-1.0, -1.0], [2.0, 3.0]));
            let area: f64 = cells.map(|cell| cell.area()).sum();
            assert!((area - 12.0).abs() < 1e-12, "{area}");
        }
        for values in [numbers(900, 11), flat] {
            let points = Points::new(&values, 3).expect("whole rows");
            let space = Space::build(&points, &DelaunayOptions::default()).expect("finite");
            let locator = space.locator();
            let cells = (0..space.site_count() as u32)
                .map(|s| locator.voronoi_cell(s, [-1.0; 3], [2.0; 3]));
            let volume: f64 = cells.map(|cell| cell.volume()).sum();
            assert!((volume - 27.0).abs() < 1e-11, "{volume}");
        }
    }
}
