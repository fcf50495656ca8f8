//! Voronoi cells, clipped to a box.
//!
//! Idea: the cell of a site is cut from the box by the bisectors to the sites that the triangulation joins it with; no
//! other site has a say, and cells that reach to infinity, or sets that span a line only, are no special case.
//! Guarantee: the cells of all sites fill the box, to rounding. Which sites have a say is exact.

use super::convex::{Body, HalfSpace, Polygon, Polyhedron};
use super::locator::Locator;

impl<const D: usize, const V: usize> Locator<'_, D, V> {
    /// Cuts `body` down to what is nearer to `site` than to any other site.
    fn cut_to_cell<B: Body<D>>(&self, site: u32, mut body: B) -> B {
        let here = self.triangulation.site(site);
        for other in self.adjacent(site) {
            if !body.is_empty() {
                body.cut(&HalfSpace::nearer_to(here, self.triangulation.site(other)));
            }
        }
        body
    }
}

impl Locator<'_, 2, 3> {
    /// The Voronoi cell of a site, clipped to the box between two corners.
    ///
    /// O(k²) for k neighbours.
    ///
    /// # Panics
    /// If there is no such site.
    pub fn voronoi_cell(&self, site: u32, low: [f64; 2], high: [f64; 2]) -> Polygon {
        self.cut_to_cell(site, Polygon::from_box(low, high))
    }
}

impl Locator<'_, 3, 4> {
    /// The Voronoi cell of a site, clipped to the box between two corners.
    ///
    /// O(k²) for k neighbours.
    ///
    /// # Panics
    /// If there is no such site.
    pub fn voronoi_cell(&self, site: u32, low: [f64; 3], high: [f64; 3]) -> Polyhedron {
        self.cut_to_cell(site, Polyhedron::from_box(low, high))
    }
}

#[cfg(test)]
mod tests {
    use crate::numbers::numbers;
    use crate::{DelaunayOptions, Plane, Space};
    use taut_points::{Monitor, Points};

    /// The cells of all sites fill the box, whatever the sites span.
    #[test]
    fn cells_fill_the_box() {
        let line: Vec<f64> =
            (0..20).flat_map(|i| [f64::from(i) * 0.05, f64::from(i) * 0.02]).collect();
        let flat: Vec<f64> =
            numbers(80, 11).chunks(2).flat_map(|p| [p[0], p[1], p[0] + p[1]]).collect();
        for values in [numbers(600, 11), line, vec![0.3, 0.4]] {
            let points = Points::new(&values, 2).expect("whole rows");
            let plane = Plane::build(&points, &DelaunayOptions::default(), &Monitor::silent())
                .expect("finite");
            let locator = plane.locator();
            let cells = (0..plane.site_count() as u32)
                .map(|s| locator.voronoi_cell(s, [-1.0, -1.0], [2.0, 3.0]));
            let area: f64 = cells.map(|cell| cell.area()).sum();
            assert!((area - 12.0).abs() < 1e-12, "{area}");
        }
        for values in [numbers(900, 11), flat] {
            let points = Points::new(&values, 3).expect("whole rows");
            let space = Space::build(&points, &DelaunayOptions::default(), &Monitor::silent())
                .expect("finite");
            let locator = space.locator();
            let cells = (0..space.site_count() as u32)
                .map(|s| locator.voronoi_cell(s, [-1.0; 3], [2.0; 3]));
            let volume: f64 = cells.map(|cell| cell.volume()).sum();
            assert!((volume - 27.0).abs() < 1e-11, "{volume}");
        }
    }
}
