//! Where a point lies, and which site is nearest.

use std::cell::Cell;

use taut_predicates::Sign;

use crate::cells::{Geometry, InPlane, InSpace, Index, conflicts, star_of};
use crate::simplex::{GHOST, Slots, decode};
use crate::{Complex, Triangulation};

/// Where a point lies in a triangulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// It is this site.
    Site(u32),
    /// In this simplex or on its boundary.
    Inside(u32),
    /// Outside the hull: the ghost of a hull facet that it lies beyond.
    Outside(u32),
    /// The sites do not span all dimensions, so there are no simplices to lie in.
    Flat,
}

/// Answers questions about points, one after another, in about a microsecond each.
///
/// Takes O(n) to make, and five bytes a site.
pub struct Locator<'a, const D: usize, const V: usize> {
    pub(super) triangulation: &'a Triangulation<D, V>,
    index: Index<D>,
    /// For each site a simplex of it; on a line its place there.
    at_site: Vec<u32>,
}

impl<const D: usize, const V: usize> Triangulation<D, V> {
    /// Makes ready for questions.
    pub fn locator(&self) -> Locator<'_, D, V> {
        let mut at_site = vec![0; self.site_count()];
        let mut note = |t: usize, vertices: &[u32]| {
            vertices
                .iter()
                .filter(|&&v| v < GHOST - 1)
                .for_each(|&v| at_site[v as usize] = t as u32);
        };
        match &self.complex {
            Complex::Nothing | Complex::Point => {}
            Complex::Line(chain) => {
                chain.iter().enumerate().for_each(|(place, &site)| note(place, &[site]))
            }
            Complex::Flat(triangles) => {
                triangles
                    .iter()
                    .enumerate()
                    .filter(|(_, s)| !s.is_ghost())
                    .for_each(|(t, s)| note(t, &s.vertices));
            }
            Complex::Full => self.simplices().for_each(|t| note(t as usize, &self.vertices(t))),
        }
        Locator { triangulation: self, index: Index::build(&self.sites.coordinates), at_site }
    }
}

impl<const D: usize, const V: usize> Locator<'_, D, V> {
    /// A point in the coordinates of the sites.
    fn scaled(&self, point: [f64; D]) -> [f64; D] {
        point.map(|x| self.triangulation.scale().apply(x))
    }

    /// The site nearest to a point, in `f64` distances; of several the first along the Hilbert curve. `None` if there
    /// are no sites or the point is not finite.
    pub fn nearest(&self, point: [f64; D]) -> Option<u32> {
        let q = self.scaled(point);
        if self.triangulation.site_count() == 0 || q.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let best = Cell::new((f64::INFINITY, u32::MAX));
        let distance = |site: u32| {
            let p = self.triangulation.sites.coordinates[site as usize];
            (0..D).map(|i| (p[i] - q[i]) * (p[i] - q[i])).sum::<f64>()
        };
        let open =
            |index: &Index<D>, node| index.bounds(node).distance_squared_to(q) <= best.get().0;
        self.index.visit_nearest(q, open, |leaf| {
            for site in self.index.run(leaf) {
                let candidate = (distance(site), site);
                if candidate < best.get() {
                    best.set(candidate);
                }
            }
        });
        Some(best.get().1).filter(|&site| site != u32::MAX)
    }

    /// The sites whose Voronoi cells share a facet with that of `site`, in order.
    ///
    /// # Panics
    /// If there is no such site.
    pub fn adjacent(&self, site: u32) -> Vec<u32> {
        let at = self.at_site[site as usize];
        match &self.triangulation.complex {
            Complex::Nothing | Complex::Point => Vec::new(),
            Complex::Line(chain) => {
                let place = at as usize;
                let ends =
                    [place.checked_sub(1), Some(place + 1).filter(|&next| next < chain.len())];
                let mut around: Vec<u32> =
                    ends.into_iter().flatten().map(|place| chain[place]).collect();
                around.sort_unstable();
                around
            }
            Complex::Flat(triangles) => around(triangles, at, site),
            Complex::Full => around(self.triangulation.slots(), at, site),
        }
    }

    /// The simplices that would go if `q`, in the coordinates of the sites, were inserted. `first` is one of them.
    fn cavity<G: Geometry<D, V>>(&self, q: [f64; D], first: u32) -> Vec<u32> {
        let simplices = self.triangulation.slots();
        let site = |v: u32| self.triangulation.sites.coordinates[v as usize];
        let mut cavity = vec![first];
        let mut seen = std::collections::HashSet::from([first]);
        let mut next = 0;
        while next < cavity.len() {
            for code in simplices[cavity[next] as usize].neighbors {
                let (other, _) = decode(code);
                if seen.insert(other) && conflicts::<D, V, G>(simplices, other, site, q) {
                    cavity.push(other);
                }
            }
            next += 1;
        }
        cavity
    }

    fn locate_by<G: Geometry<D, V>>(&self, point: [f64; D]) -> Location {
        let simplices = self.triangulation.slots();
        let q = self.scaled(point);
        let Some(near) = self.nearest(point).filter(|_| !simplices.is_empty()) else {
            return Location::Flat;
        };
        if self.triangulation.sites.coordinates[near as usize] == q {
            return Location::Site(near);
        }
        // A visibility walk: step through any facet that q lies beyond. In a Delaunay triangulation it ends.
        let mut here = self.at_site[near as usize];
        loop {
            let simplex = simplices[here as usize];
            if simplex.is_ghost() {
                return Location::Outside(here);
            }
            let corners =
                simplex.vertices.map(|v| self.triangulation.sites.coordinates[v as usize]);
            let beyond = (0..V).find(|&i| {
                let mut with_q = corners;
                with_q[i] = q;
                G::orientation(with_q) == Sign::Negative
            });
            match beyond {
                None => return Location::Inside(here),
                Some(i) => here = decode(simplex.neighbors[i]).0,
            }
        }
    }

    fn natural_neighbors_by<G: Geometry<D, V>>(&self, point: [f64; D]) -> Vec<u32> {
        let first = match self.locate_by::<G>(point) {
            Location::Inside(t) | Location::Outside(t) => t,
            Location::Site(site) => return vec![site],
            Location::Flat => return Vec::new(),
        };
        let simplices = self.triangulation.slots();
        let cavity = self.cavity::<G>(self.scaled(point), first);
        let mut sites: Vec<u32> =
            cavity.iter().flat_map(|&t| simplices[t as usize].vertices).collect();
        sites.sort_unstable();
        sites.dedup();
        sites.retain(|&v| v != GHOST);
        sites
    }
}

/// The other vertices of the simplices at `site`, one of which is `t`; ascending.
fn around<const W: usize>(simplices: &Slots<W>, t: u32, site: u32) -> Vec<u32> {
    let mut star = Vec::new();
    star_of(simplices, t, site, &mut star);
    let mut sites: Vec<u32> = star.iter().flat_map(|&t| simplices[t as usize].vertices).collect();
    sites.sort_unstable();
    sites.dedup();
    sites.retain(|&v| v != site && v != GHOST);
    sites
}

/// The same two questions in the plane and in space.
macro_rules! questions {
    ($d:literal, $v:literal, $geometry:ty) => {
        impl Locator<'_, $d, $v> {
            /// Where a point lies. Exact, for coordinates that can be scaled like those of the sites without loss.
            pub fn locate(&self, point: [f64; $d]) -> Location {
                self.locate_by::<$geometry>(point)
            }

            /// The natural neighbours of a point: the sites whose Voronoi cells would lose to it, ascending. The site
            /// itself if it is one; none if the sites do not span all dimensions.
            pub fn natural_neighbors(&self, point: [f64; $d]) -> Vec<u32> {
                self.natural_neighbors_by::<$geometry>(point)
            }
        }
    };
}
questions!(2, 3, InPlane);
questions!(3, 4, InSpace);
