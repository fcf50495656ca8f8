//! Where a point lies, and which site is nearest.

use std::borrow::Cow;
use std::cell::Cell;
use std::collections::HashSet;

use taut_predicates::Sign;

use crate::geometry::{Geometry, InPlane, InSpace, Index, conflicts};
use crate::simplex::{GHOST, Slots, decode};
use crate::{Complex, Triangulation};

/// Coordinates are cut off here: farther than any site in the scale of the sites, with squares that are finite.
const COORDINATE_MAX: f64 = 1e150;

/// Where a point lies in a triangulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// It is this site.
    Site(u32),
    /// In this simplex or on its boundary.
    Inside(u32),
    /// Outside the hull: the ghost of a hull facet that it lies beyond.
    Outside(u32),
    /// In no simplex, as the sites do not span all dimensions, or as a coordinate of the point is not finite.
    Nowhere,
}

/// Answers questions about points, one after another.
///
/// Takes O(simplices) to make, and five bytes a site. Sites, not rows of the input, go in and come out:
/// [`Triangulation::row`] translates.
pub struct Locator<'a, const D: usize, const V: usize> {
    pub(super) triangulation: &'a Triangulation<D, V>,
    directory: Cow<'a, Directory<D>>,
}

/// The data by which a [`Locator`] finds where to begin.
#[derive(Clone)]
pub(super) struct Directory<const D: usize> {
    index: Index<D>,
    /// For each site a simplex of it; on a line its place there.
    pub(super) at_site: Vec<u32>,
}

impl<const D: usize, const V: usize> Triangulation<D, V> {
    /// Makes ready for questions.
    pub fn locator(&self) -> Locator<'_, D, V> {
        Locator { triangulation: self, directory: Cow::Owned(self.directory()) }
    }

    /// The same with a directory that was made before.
    pub(super) fn locator_by<'a>(&'a self, directory: &'a Directory<D>) -> Locator<'a, D, V> {
        Locator { triangulation: self, directory: Cow::Borrowed(directory) }
    }

    pub(super) fn directory(&self) -> Directory<D> {
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
        Directory { index: Index::build(&self.sites.coordinates), at_site }
    }
}

impl<const D: usize, const V: usize> Locator<'_, D, V> {
    /// The site nearest to a point, in `f64` distances; of several the first along the Hilbert curve. `None` if there
    /// are no sites or a coordinate of the point is not finite. O(log n) for well-spread sites.
    pub fn nearest(&self, point: [f64; D]) -> Option<u32> {
        if self.triangulation.site_count() == 0 || point.iter().any(|x| !x.is_finite()) {
            return None;
        }
        // So far away, rounding makes all sites equally near; squares must stay finite to see even that.
        let q = point
            .map(|x| self.triangulation.scale().apply(x).clamp(-COORDINATE_MAX, COORDINATE_MAX));
        let best = Cell::new((f64::INFINITY, u32::MAX));
        let distance = |site: u32| {
            let p = self.triangulation.sites.coordinates[site as usize];
            (0..D).map(|i| (p[i] - q[i]) * (p[i] - q[i])).sum::<f64>()
        };
        let open =
            |index: &Index<D>, node| index.bounds(node).distance_squared_to(q) <= best.get().0;
        let index = &self.directory.index;
        index.visit_nearest(q, open, |leaf| {
            for site in index.run(leaf) {
                let candidate = (distance(site), site);
                if candidate < best.get() {
                    best.set(candidate);
                }
            }
        });
        Some(best.get().1).filter(|&site| site != u32::MAX)
    }

    /// The sites that the triangulation joins with `site`, ascending: their Voronoi cells share a facet with that of
    /// `site`, or less where more than D + 1 sites lie on one empty sphere.
    ///
    /// # Panics
    /// If there is no such site.
    pub fn adjacent(&self, site: u32) -> Vec<u32> {
        let at = self.directory.at_site[site as usize];
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

    /// The simplices that would go if `q` were inserted. `first` is one of them.
    fn cavity<G: Geometry<D, V>>(&self, q: [f64; D], first: u32) -> Vec<u32> {
        let simplices = self.triangulation.slots();
        let site = |v: u32| self.triangulation.site(v);
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
        let Some(near) = self.nearest(point).filter(|_| !simplices.is_empty()) else {
            return Location::Nowhere;
        };
        if self.triangulation.site(near) == point {
            return Location::Site(near);
        }
        // A visibility walk: step through any facet that the point lies beyond. In a Delaunay triangulation it ends. It
        // goes by the coordinates as they were given, as those of the point may not survive the scale of the sites.
        let mut here = self.directory.at_site[near as usize];
        loop {
            let simplex = simplices[here as usize];
            if simplex.is_ghost() {
                return Location::Outside(here);
            }
            let corners = simplex.vertices.map(|v| self.triangulation.site(v));
            let beyond = (0..V).find(|&i| {
                let mut with_q = corners;
                with_q[i] = point;
                G::orientation(with_q) == Sign::Negative
            });
            match beyond {
                None => return Location::Inside(here),
                Some(i) => here = decode(simplex.neighbors[i]).0,
            }
        }
    }

    fn conflicts_by<G: Geometry<D, V>>(&self, point: [f64; D]) -> Vec<u32> {
        match self.locate_by::<G>(point) {
            Location::Inside(t) | Location::Outside(t) => self.cavity::<G>(point, t),
            Location::Site(_) | Location::Nowhere => Vec::new(),
        }
    }

    fn natural_neighbors_by<G: Geometry<D, V>>(&self, point: [f64; D]) -> Vec<u32> {
        let first = match self.locate_by::<G>(point) {
            Location::Inside(t) | Location::Outside(t) => t,
            Location::Site(site) => return vec![site],
            Location::Nowhere => return Vec::new(),
        };
        let simplices = self.triangulation.slots();
        let cavity = self.cavity::<G>(point, first);
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
            /// Where a point lies: exact for any finite point. One walk of a few steps from the nearest site.
            pub fn locate(&self, point: [f64; $d]) -> Location {
                self.locate_by::<$geometry>(point)
            }

            /// The simplices, ghosts among them, that would go if the point were inserted: those whose spheres hold it,
            /// ties decided by the perturbation. None for a site, and where the point lies
            /// [`Nowhere`](Location::Nowhere).
            pub fn conflicts(&self, point: [f64; $d]) -> Vec<u32> {
                self.conflicts_by::<$geometry>(point)
            }

            /// The natural neighbors of a point: the sites it would be joined with if it were one, ascending. Their
            /// Voronoi cells would lose to it, or nothing where many sites lie on one sphere. The site itself if the
            /// point is one; none if it lies [`Nowhere`](Location::Nowhere).
            pub fn natural_neighbors(&self, point: [f64; $d]) -> Vec<u32> {
                self.natural_neighbors_by::<$geometry>(point)
            }
        }
    };
}
/// The simplices at vertex `v`, one of which is `t`.
pub(super) fn star_of<const V: usize>(simplices: &Slots<V>, t: u32, v: u32, star: &mut Vec<u32>) {
    star.clear();
    star.push(t);
    let mut seen = HashSet::from([t]);
    let mut next = 0;
    while next < star.len() {
        let simplex = &simplices[star[next] as usize];
        for i in 0..V {
            let (neighbor, _) = decode(simplex.neighbors[i]);
            if simplex.vertices[i] != v && seen.insert(neighbor) {
                star.push(neighbor);
            }
        }
        next += 1;
    }
}

questions!(2, 3, InPlane);
questions!(3, 4, InSpace);
