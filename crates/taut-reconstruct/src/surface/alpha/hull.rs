//! The hull that the filter of the thesis leaves: candidates of a surface, before any is chosen.
//!
//! The thesis' program could stop there (4.5): "sometimes the shrunk equatorial sphere test with a good α value is a good approximation to the mesh
//! desired", above all for uniform dense samples. It is no surface as a rule: on the sides of flat cells there are two sheets.

use taut_delaunay::Space;
use taut_points::parallel::{IntoParallel, ParallelSlice};

use crate::Error;
use crate::surface::filter::{AlphaFilter, Emptiness, Filter};
use crate::surface::sides::{Side, Sides};

/// Facets that pass the filter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilteredHull {
    /// As sites in ascending order; facets in their order. They are not oriented.
    pub triangles: Vec<[u32; 3]>,
    /// For each a witness: the site opposite in one of the Delaunay cells it is a facet of, the smaller one if there are two.
    pub apexes: Vec<u32>,
}

/// The Delaunay facets whose equatorial sphere, shrunk by 1 − `epsilon`, is empty, and that are small enough.
///
/// # Errors
/// [`Error::Flat`] if the sites do not span space, [`Error::Input`] if `epsilon` is not in [0, 1) or the radius of the filter is
/// negative or no number.
pub fn filtered_hull(
    space: &Space,
    epsilon: f64,
    emptiness: Emptiness,
    alpha: AlphaFilter,
) -> Result<FilteredHull, Error> {
    let filter = Filter::new(epsilon, emptiness, alpha)?;
    let sides = Sides::of(space, &alpha.lengths())?;
    let (triangles, own) = passing(&sides, &filter);
    let apex = |&side: &Side| sides.apexes(side).min().unwrap_or(u32::MAX);
    Ok(FilteredHull { apexes: own.iter().map(apex).collect(), triangles })
}

/// The facets that pass, in the order of their sites, and a side of each.
pub(in crate::surface) fn passing(sides: &Sides, filter: &Filter) -> (Vec<[u32; 3]>, Vec<Side>) {
    let of = |cell: u32| sides.facets_of(cell).filter(|&side| filter.passes(sides, side));
    let mut all: Vec<([u32; 3], Side)> = (0..sides.cell_count() as u32)
        .into_par_iter()
        .with_min_len(1 << 9)
        .flat_map_iter(of)
        .map(|side| (sides.sorted(side), side))
        .collect();
    all.par_sort_unstable();
    all.into_iter().unzip()
}
