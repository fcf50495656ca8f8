//! Which facets of a triangulation can be part of a surface.
//!
//! *Problem.* Of the 14 facets a sample point has, two are triangles of the surface.
//! *Idea.* The shrunk equatorial sphere of a facet, its smallest sphere shrunk by 1 − ε about its center, is to be empty. The two
//! vertices opposite are asked; for ε = 0 that is the Gabriel property. Beside that, facets may be limited in size.
//! *Guarantee.* All signs are exact.
//! *Trap.* For ε > 0 two vertices are not all sites: where one of them lies inside the equatorial sphere by a hair and makes a flat
//! cell, another site beyond may lie deeper. [`Emptiness::Sites`] asks all that can.
//! *Reference.* Algorithm 6 of the thesis, section 4.2, and 4.5.1; Amenta and Choi, SoCG 2000.

use std::collections::{HashMap, HashSet};

use taut_delaunay::GHOST;
use taut_predicates::space::{
    equatorial_radius, in_equatorial_sphere, shrunk_sphere, sphere_radius,
};

use taut_points::{InputError, shown_number};

use super::sides::{Side, Sides};
use crate::Error;

/// Who must not lie inside the shrunk equatorial sphere of a facet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Emptiness {
    /// The vertices opposite in the cells of the facet: O(1).
    #[default]
    Apexes,
    /// All sites. The same for ε = 0.
    Sites,
}

/// Which facets are small enough. A radius is in the unit of the coordinates, and an infinite one lets all facets pass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaFilter {
    /// All.
    #[default]
    None,
    /// Those whose circumradius is at most so large, as in the thesis.
    Circumradius(f64),
    /// Those that an empty ball of at most this radius touches: the facets of the alpha complex.
    EmptyBall(f64),
}

impl AlphaFilter {
    fn radius(self) -> f64 {
        match self {
            Self::None => f64::INFINITY,
            Self::Circumradius(radius) | Self::EmptyBall(radius) => radius,
        }
    }

    /// The lengths in it that calculations need.
    pub(super) fn lengths(self) -> Vec<f64> {
        Some(self.radius()).filter(|radius| radius.is_finite()).into_iter().collect()
    }
}

/// The tests that a facet has to pass.
pub(super) struct Filter {
    epsilon: f64,
    emptiness: Emptiness,
    /// In the unit of the input.
    alpha: AlphaFilter,
}

impl Filter {
    pub(super) fn new(
        epsilon: f64,
        emptiness: Emptiness,
        alpha: AlphaFilter,
    ) -> Result<Self, Error> {
        let wrong = |name, value: f64, expected| {
            Error::Input(InputError::Option { name, value: shown_number(value), expected })
        };
        if !(0.0..1.0).contains(&epsilon) {
            return Err(wrong("epsilon", epsilon, "a number from 0 on, below 1"));
        }
        let radius = alpha.radius();
        if radius.is_nan() || radius < 0.0 {
            return Err(wrong("alpha", radius, "a radius of at least 0"));
        }
        Ok(Self { epsilon, emptiness, alpha })
    }

    /// Returns true if a finite facet passes all of it.
    pub(super) fn passes(&self, sides: &Sides, side: Side) -> bool {
        self.is_small(sides, side)
            && !sides.apexes(side).any(|site| self.shrunk_holds(sides, side, site))
            && (self.emptiness == Emptiness::Apexes || self.no_site_within(sides, side))
    }

    fn is_small(&self, sides: &Sides, side: Side) -> bool {
        let limit = sides.scaled(self.alpha.radius());
        match self.alpha {
            _ if limit == f64::INFINITY => true,
            AlphaFilter::EmptyBall(_) => in_complex(sides, side, limit),
            _ => facet_at_most(sides, side, limit),
        }
    }

    fn shrunk_holds(&self, sides: &Sides, side: Side, site: u32) -> bool {
        let [a, b, c] = facet(sides, side);
        shrunk_sphere(a, b, c, sides.points[site as usize], self.epsilon).is_positive()
    }

    /// Returns true if the shrunk sphere is empty of all sites. The sites within a ball are joined by Delaunay edges within it: so those
    /// inside the equatorial sphere or on it are met by walking through the stars of such sites, from the corners on.
    fn no_site_within(&self, sides: &Sides, side: Side) -> bool {
        let corners = facet(sides, side);
        let mut near: HashMap<u32, bool> =
            sides.triangle(side).into_iter().map(|site| (site, true)).collect();
        let mut seen: HashSet<u32> = HashSet::from([side >> 2]);
        let mut open = vec![side >> 2];
        while let Some(cell) = open.pop() {
            let vertices = sides.cell(cell);
            for site in vertices.into_iter().filter(|&site| site != GHOST) {
                if near.contains_key(&site) {
                    continue;
                }
                if self.shrunk_holds(sides, side, site) {
                    return false;
                }
                let [a, b, c] = corners;
                let outside = in_equatorial_sphere(a, b, c, sides.points[site as usize]);
                near.insert(site, !outside.is_negative());
            }
            for across in (0..4).map(|i| cell << 2 | i) {
                let next = sides.mirror(across) >> 2;
                let leads = |site: u32| near.get(&site).copied().unwrap_or(false);
                if sides.triangle(across).into_iter().any(leads) && seen.insert(next) {
                    open.push(next);
                }
            }
        }
        true
    }
}

fn facet(sides: &Sides, side: Side) -> [[f64; 3]; 3] {
    sides.sorted(side).map(|site| sides.points[site as usize])
}

/// Returns true if the smallest sphere of a facet has at most this radius.
pub(super) fn facet_at_most(sides: &Sides, side: Side, limit: f64) -> bool {
    let [a, b, c] = facet(sides, side);
    !equatorial_radius(a, b, c, limit).is_negative()
}

/// Returns true if the sphere of a cell has at most this radius; that of a ghost is infinite.
pub(super) fn cell_at_most(sides: &Sides, cell: u32, limit: f64) -> bool {
    if sides.is_ghost(cell) {
        return limit == f64::INFINITY;
    }
    let [a, b, c, d] = sides.corners(cell);
    limit == f64::INFINITY || !sphere_radius(a, b, c, d, limit).is_negative()
}

/// Returns true if the smallest sphere of a facet is empty of all sites.
pub(super) fn is_gabriel(sides: &Sides, side: Side) -> bool {
    let [a, b, c] = facet(sides, side);
    let inside = |site: u32| in_equatorial_sphere(a, b, c, sides.points[site as usize]);
    !sides.apexes(side).any(|site| inside(site).is_positive())
}

/// Returns true if an empty ball of at most this radius has a facet on its boundary.
pub(super) fn in_complex(sides: &Sides, side: Side, limit: f64) -> bool {
    let cells = [side, sides.mirror(side)].map(|side| side >> 2);
    let finite = |&cell: &u32| !sides.is_ghost(cell) && cell_at_most(sides, cell, limit);
    cells.iter().any(finite) || (is_gabriel(sides, side) && facet_at_most(sides, side, limit))
}
