//! The alpha shape at a given radius.
//!
//! *Problem.* Given points of space and α, say what an eraser of radius α, which may not touch a point with its inside, leaves.
//! *Idea.* It leaves the Delaunay cells whose circumsphere is no larger than α, and the facets that are on the boundary of an empty ball
//! no larger than α. A facet with such cells on both sides is interior, with one on one side regular, with none singular.
//! *Guarantee.* Exact classes for all finite input. The regular facets, turned outward, are the boundary of the solid: each edge has as many
//! of them running one way as the other. O(facets).
//! *Trap.* More than two regular facets can share an edge: the boundary of a solid is no surface where it touches itself.
//! *Reference.* Edelsbrunner and Mücke, ACM Transactions on Graphics 13, 1994.

use taut_delaunay::Space;
use taut_points::parallel::IntoParallel;

use super::checked;
use crate::Error;
use crate::surface::filter::{cell_at_most, facet_at_most, is_gabriel};
use crate::surface::sides::{Side, Sides};

/// Where a facet is in an alpha shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FacetClass {
    /// Not in it: no empty ball of radius α or less has it on its boundary.
    Exterior,
    /// In it, with cells of the shape on neither side.
    Singular,
    /// With a cell of the shape on one side.
    Regular,
    /// With a cell of the shape on both sides.
    Interior,
}

/// An alpha shape, down to facets.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AlphaShape {
    /// The radius.
    pub alpha: f64,
    /// The boundary of the solid, as sites: counter-clockwise as seen from outside of it; the smallest site comes first, facets in their
    /// order.
    pub regular: Vec<[u32; 3]>,
    /// For each of them the vertex opposite in the cell inside: a witness, whose sphere with the facet is empty and at most α.
    pub apexes: Vec<u32>,
    /// Facets without a cell, as sites in ascending order; facets in their order.
    pub singular: Vec<[u32; 3]>,
    /// The number of facets that are interior.
    pub interior: usize,
    /// The number of facets that are exterior.
    pub exterior: usize,
    /// The number of cells.
    pub cells: usize,
    /// The number of sets of cells that hang together by facets.
    pub solids: usize,
}

/// The alpha shape of the sites of a triangulation.
///
/// An infinite `alpha` gives the convex hull.
///
/// ```
/// use taut_delaunay::{DelaunayOptions, Space};
/// use taut_points::{Monitor, Points};
/// use taut_reconstruct::alpha::alpha_shape;
/// let corners = [0., 0., 0., 2., 0., 0., 0., 2., 0., 0., 0., 2.];
/// let points = Points::new(&corners, 3)?;
/// let space = Space::build(&points, &DelaunayOptions::default())?;
/// let root = 3f64.sqrt();                                          // the circumradius, rounded down
/// assert_eq!(alpha_shape(&space, root.next_up())?.regular.len(), 4);
/// assert_eq!(alpha_shape(&space, root)?.singular.len(), 3);        // the largest facet comes with the cell
/// assert_eq!(alpha_shape(&space, 1.41)?.singular.len(), 0);        // the others need √2
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Flat`] if the sites do not span space, [`Error::Input`] if `alpha` is negative or no number.
pub fn alpha_shape(space: &Space, alpha: f64) -> Result<AlphaShape, Error> {
    let lengths: Vec<f64> = Some(checked(alpha)?).filter(|a| a.is_finite()).into_iter().collect();
    let sides = Sides::of(space, &lengths)?;
    let limit = sides.scaled(alpha);
    let all = 0..sides.cell_count() as u32;
    // A ghost has no sphere; the room outside belongs to no solid.
    let solid = |cell| !sides.is_ghost(cell) && cell_at_most(&sides, cell, limit);
    let inside: Vec<bool> = all.clone().into_par_iter().with_min_len(1 << 9).map(solid).collect();
    let classified = |cell| {
        let (sides, inside) = (&sides, &inside);
        sides.facets_of(cell).map(move |side| classify(sides, inside, side, limit))
    };
    let classes: Vec<(FacetClass, Side)> =
        all.into_par_iter().with_min_len(1 << 9).flat_map_iter(classified).collect();
    let of = |class| classes.iter().filter(move |&&(is, _)| is == class).map(|&(_, side)| side);
    let mut regular: Vec<([u32; 3], u32)> = of(FacetClass::Regular)
        .map(|side| (smallest_first(sides.triangle(sides.mirror(side))), sides.apex(side)))
        .collect();
    regular.sort_unstable();
    let (regular, apexes) = regular.into_iter().unzip();
    let mut singular: Vec<[u32; 3]> =
        of(FacetClass::Singular).map(|side| sides.sorted(side)).collect();
    singular.sort_unstable();
    Ok(AlphaShape {
        alpha,
        regular,
        apexes,
        singular,
        interior: of(FacetClass::Interior).count(),
        exterior: of(FacetClass::Exterior).count(),
        cells: inside.iter().filter(|&&is| is).count(),
        solids: solids(&sides, &inside),
    })
}

/// The class of a facet, and its side on which the solid is if it is on one side only.
fn classify(sides: &Sides, inside: &[bool], side: Side, limit: f64) -> (FacetClass, Side) {
    let mirror = sides.mirror(side);
    match [side, mirror].map(|side| inside[(side >> 2) as usize]) {
        [true, true] => (FacetClass::Interior, side),
        [true, false] => (FacetClass::Regular, side),
        [false, true] => (FacetClass::Regular, mirror),
        [false, false] => {
            let small = limit == f64::INFINITY || facet_at_most(sides, side, limit);
            let singular = small && is_gabriel(sides, side);
            (if singular { FacetClass::Singular } else { FacetClass::Exterior }, side)
        }
    }
}

fn smallest_first([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// Returns how many sets the cells of a solid make that hang together by facets.
fn solids(sides: &Sides, inside: &[bool]) -> usize {
    let mut seen = vec![false; inside.len()];
    let mut count = 0;
    let mut open = Vec::new();
    for start in (0..inside.len() as u32).filter(|&cell| inside[cell as usize]) {
        if std::mem::replace(&mut seen[start as usize], true) {
            continue;
        }
        count += 1;
        open.push(start);
        while let Some(cell) = open.pop() {
            for next in (0..4).map(|i| sides.mirror(cell << 2 | i) >> 2) {
                if inside[next as usize] && !std::mem::replace(&mut seen[next as usize], true) {
                    open.push(next);
                }
            }
        }
    }
    count
}
