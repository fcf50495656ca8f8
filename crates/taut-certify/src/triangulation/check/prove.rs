//! The steps of the proof in order, for each dimension of the hull.

use std::borrow::Cow;

use rayon::prelude::*;

use super::super::{MeshViolation, TriangulationCounts, TriangulationVerdict};
use super::facets::{Complex, Facets, Paired};
use super::geometry::{Geometry, Tetrahedra, Triangles};
use super::input::Input;
use super::signs::Signs;
use super::sites::Sites;
use super::{line, listed, pairing, polygon, polyhedron};

pub(super) struct Claim<'a> {
    pub(super) hull_dimension: Option<u8>,
    pub(super) simplices: &'a [u32],
    /// Empty where they are not known.
    pub(super) neighbors: &'a [u32],
    /// Facets of the hull and duplicates. Without them any order of vertices is accepted in a simplex, and of equal
    /// rows any one may be the vertex.
    pub(super) lists: Option<(&'a [u32], &'a [[u32; 2]])>,
}

impl Claim<'_> {
    fn width(&self) -> usize {
        self.hull_dimension.map_or(1, |dimension| usize::from(dimension) + 1)
    }

    fn hull(&self) -> Option<&[u32]> {
        self.lists.map(|(hull, _)| hull)
    }

    /// Returns true if all is given that [`Complex::check`] needs.
    fn is_whole<const D: usize>(&self) -> bool {
        let is_full = self.hull_dimension.is_some_and(|dimension| usize::from(dimension) == D);
        is_full && self.lists.is_some() && !self.neighbors.is_empty()
    }

    /// Steps before any geometry: every id is a row, unless that is found on the way, and there are points if and only if
    /// this is said.
    fn begin<'i, const D: usize>(
        &self,
        input: &'i Input<'i, D>,
    ) -> Result<Sites<'i, D>, MeshViolation> {
        let is_possible = self.hull_dimension.is_none_or(|dimension| usize::from(dimension) <= D)
            && self.hull_dimension.is_none() == (input.len() == 0);
        // Full dimension is proved by the orientation of a simplex.
        let is_low = self.hull_dimension.is_some_and(|dimension| usize::from(dimension) < D);
        if !is_possible || is_low {
            let found = input.hull_dimension();
            if found != self.hull_dimension {
                return Err(MeshViolation::HullDimension { claimed: self.hull_dimension, found });
            }
        }
        let sites = Sites::of(input);
        if !self.is_whole::<D>() {
            sites.have_all(self.simplices, self.width(), 0)?;
        }
        Ok(sites)
    }

    /// Every row is a vertex or stands for one. All vertices were named.
    pub(super) fn covers<const D: usize>(&self, sites: &Sites<'_, D>) -> Result<(), MeshViolation> {
        match self.lists {
            Some((_, duplicates)) => sites.covers(duplicates),
            None => sites.covers_all_places(),
        }
    }
}

/// The proof for points of the plane.
pub(super) fn plane(
    input: &Input<'_, 2>,
    claim: &Claim<'_>,
) -> Result<TriangulationVerdict, MeshViolation> {
    let sites = claim.begin(input)?;
    match claim.hull_dimension {
        Some(2) => triangles(input.signs(), &sites, claim),
        _ => line::check(&sites, claim),
    }
}

/// The proof for points of space.
pub(super) fn space(
    input: &Input<'_, 3>,
    claim: &Claim<'_>,
) -> Result<TriangulationVerdict, MeshViolation> {
    let sites = claim.begin(input)?;
    match claim.hull_dimension {
        Some(3) => tetrahedra(input.signs(), &sites, claim),
        Some(2) => {
            let [a, b, c] = match claim.simplices.first_chunk() {
                Some(first) => sites.gather(first),
                None => return Err(MeshViolation::Missing { row: 0 }),
            };
            let Some([i, j]) = input.axes(&a, &b, &c) else {
                return Err(MeshViolation::Orientation { simplex: 0 });
            };
            // The lexicographic order stays: in an upright plane, equal first coordinates make equal dropped ones.
            triangles(input.signs(), &sites.with_axes([i, j, 3 - i - j]), claim)
        }
        _ => line::check(&sites, claim),
    }
}

fn triangles<const D: usize>(
    signs: Signs,
    sites: &Sites<'_, D>,
    claim: &Claim<'_>,
) -> Result<TriangulationVerdict, MeshViolation> {
    let simplices = rows::<3>(claim.simplices);
    let simplices = facing::<Triangles, D, 3>(sites, &signs, simplices, claim);
    let neighbors = neighbors::<3, 2>(sites.rows(), &simplices, claim)?;
    let complex = Complex { sites, signs, simplices: &simplices, neighbors: &neighbors };
    let paired = complex.check::<Triangles, 2>()?;
    claim.covers(sites)?;
    let hull = paired.open.len();
    if let Some(list) = claim.hull() {
        listed::check::<3, 2>(&paired.open, list, sites.rows(), |place| complex.open_facet(place))?;
    }
    polygon::check(sites, &signs, paired.open)?;
    let counts = counted(sites, simplices.len(), hull);
    debug_assert_eq!(counts.simplices + 2 + counts.hull, 2 * counts.sites);
    let Paired { fingerprint, ties, refined, .. } = paired;
    Ok(TriangulationVerdict { counts, fingerprint, ties, refined })
}

fn tetrahedra(
    signs: Signs,
    sites: &Sites<'_, 3>,
    claim: &Claim<'_>,
) -> Result<TriangulationVerdict, MeshViolation> {
    let simplices = rows::<4>(claim.simplices);
    let simplices = facing::<Tetrahedra, 3, 4>(sites, &signs, simplices, claim);
    let neighbors = neighbors::<4, 3>(sites.rows(), &simplices, claim)?;
    let complex = Complex { sites, signs, simplices: &simplices, neighbors: &neighbors };
    let paired = complex.check::<Tetrahedra, 3>()?;
    claim.covers(sites)?;
    let hull = paired.open.len();
    if let Some(list) = claim.hull() {
        listed::check::<4, 3>(&paired.open, list, sites.rows(), |place| complex.open_facet(place))?;
    }
    polyhedron::check(sites, &signs, &simplices[0], paired.open)?;
    let counts = counted(sites, simplices.len(), hull);
    let Paired { fingerprint, ties, refined, .. } = paired;
    Ok(TriangulationVerdict { counts, fingerprint, ties, refined })
}

fn rows<const V: usize>(values: &[u32]) -> &[[u32; V]] {
    values.as_chunks().0
}

/// The simplices as they are; positively oriented where the claim says nothing of their orientation.
fn facing<'a, G: Geometry<D, V>, const D: usize, const V: usize>(
    sites: &Sites<'_, D>,
    signs: &Signs,
    simplices: &'a [[u32; V]],
    claim: &Claim<'_>,
) -> Cow<'a, [[u32; V]]> {
    if claim.lists.is_some() {
        return Cow::Borrowed(simplices);
    }
    let face = |simplex: &[u32; V]| {
        let mut simplex = *simplex;
        if signs.orientation::<G, D, V>(&sites.gather(&simplex)).is_lt() {
            simplex.swap(V - 2, V - 1);
        }
        simplex
    };
    Cow::Owned(simplices.par_iter().map(face).collect())
}

fn neighbors<'a, const V: usize, const F: usize>(
    sites: usize,
    simplices: &[[u32; V]],
    claim: &Claim<'a>,
) -> Result<Cow<'a, [[u32; V]]>, MeshViolation>
where
    [u32; V]: Facets<F>,
{
    match claim.neighbors {
        [] => Ok(Cow::Owned(pairing::pair(simplices, sites)?)),
        given => Ok(Cow::Borrowed(rows(given))),
    }
}

pub(super) fn counted<const D: usize>(
    sites: &Sites<'_, D>,
    simplices: usize,
    hull: usize,
) -> TriangulationCounts {
    TriangulationCounts {
        sites: sites.count() as u64,
        simplices: simplices as u64,
        hull: hull as u64,
    }
}
