//! The steps of the proof in order, for each dimension of the hull.

use std::borrow::Cow;

use rayon::prelude::*;

use super::super::{MeshViolation, TriangulationCounts, TriangulationVerdict};
use super::facets::{Complex, Facets, Paired};
use super::geometry::{Geometry, Tetrahedra, Triangles};
use super::signs::Signs;
use super::sites::{Input, Sites};
use super::{line, pairing, polygon, polyhedron};

/// What is to be proved.
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

    /// Steps before any geometry: the vertices, and that there are points if and only if this is said.
    fn begin<const D: usize>(
        &self,
        input: &Input<'_, D>,
    ) -> Result<(Sites<D>, Vec<u32>), MeshViolation> {
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
        let (sites, simplices) = Sites::of(input, self.simplices, self.width())?;
        match self.lists {
            Some((_, duplicates)) => sites.covers(input, duplicates)?,
            None => sites.covers_all_places(input)?,
        }
        Ok((sites, simplices))
    }
}

/// The proof for points of the plane.
pub(super) fn plane(
    input: &Input<'_, 2>,
    claim: &Claim<'_>,
) -> Result<TriangulationVerdict, MeshViolation> {
    let (sites, simplices) = claim.begin(input)?;
    match claim.hull_dimension {
        Some(2) => triangles(input.signs(), &sites, simplices, claim),
        _ => line::check(&sites, &simplices, claim),
    }
}

/// The proof for points of space.
pub(super) fn space(
    input: &Input<'_, 3>,
    claim: &Claim<'_>,
) -> Result<TriangulationVerdict, MeshViolation> {
    let (mut sites, simplices) = claim.begin(input)?;
    match claim.hull_dimension {
        Some(3) => tetrahedra(input.signs(), &sites, simplices, claim),
        Some(2) => {
            let [a, b, c] = match simplices.first_chunk() {
                Some(first) => sites.gather(first),
                None => return Err(MeshViolation::Missing { row: 0 }),
            };
            let Some([i, j]) = input.axes(&a, &b, &c) else {
                return Err(MeshViolation::Orientation { simplex: 0 });
            };
            // The lexicographic order stays: in an upright plane, equal first coordinates make equal dropped ones.
            for point in &mut sites.points {
                *point = [point[i], point[j], point[3 - i - j]];
            }
            triangles(input.signs(), &sites, simplices, claim)
        }
        _ => line::check(&sites, &simplices, claim),
    }
}

fn triangles<const D: usize>(
    signs: Signs,
    sites: &Sites<D>,
    simplices: Vec<u32>,
    claim: &Claim<'_>,
) -> Result<TriangulationVerdict, MeshViolation> {
    let simplices = rows::<3>(&simplices);
    let simplices = facing::<Triangles, D, 3>(sites, &signs, simplices, claim);
    let neighbors = neighbors::<3, 2>(sites.points.len(), &simplices, claim)?;
    let complex = Complex { sites, signs, simplices: &simplices, neighbors: &neighbors };
    let paired = complex.check::<Triangles, 2>()?;
    polygon::check(sites, &signs, &simplices, &paired.open, claim.hull())?;
    let counts = counted(sites, simplices.len(), paired.open.len());
    debug_assert_eq!(counts.simplices + 2 + counts.hull, 2 * counts.sites);
    let Paired { fingerprint, ties, refined, .. } = paired;
    Ok(TriangulationVerdict { counts, fingerprint, ties, refined })
}

fn tetrahedra(
    signs: Signs,
    sites: &Sites<3>,
    simplices: Vec<u32>,
    claim: &Claim<'_>,
) -> Result<TriangulationVerdict, MeshViolation> {
    let simplices = rows::<4>(&simplices);
    let simplices = facing::<Tetrahedra, 3, 4>(sites, &signs, simplices, claim);
    let neighbors = neighbors::<4, 3>(sites.points.len(), &simplices, claim)?;
    let complex = Complex { sites, signs, simplices: &simplices, neighbors: &neighbors };
    let paired = complex.check::<Tetrahedra, 3>()?;
    polyhedron::check(sites, &signs, &simplices, &paired.open, claim.hull())?;
    let counts = counted(sites, simplices.len(), paired.open.len());
    let Paired { fingerprint, ties, refined, .. } = paired;
    Ok(TriangulationVerdict { counts, fingerprint, ties, refined })
}

fn rows<const V: usize>(values: &[u32]) -> &[[u32; V]] {
    values.as_chunks().0
}

/// The simplices as they are; positively oriented where the claim says nothing of their orientation.
fn facing<'a, G: Geometry<D, V>, const D: usize, const V: usize>(
    sites: &Sites<D>,
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
    sites: &Sites<D>,
    simplices: usize,
    hull: usize,
) -> TriangulationCounts {
    TriangulationCounts {
        sites: sites.points.len() as u64,
        simplices: simplices as u64,
        hull: hull as u64,
    }
}
