//! Surfaces through samples of space by the algorithm of the thesis, Reviver.
//!
//! *Problem.* Samples of a smooth surface, without normals. Choose among the facets of their Delaunay triangulation a surface through
//! them.
//! *Idea.* (1) Candidates are the facets whose shrunk equatorial sphere is empty (`filter`). (2) Begin with the highest of
//! them. (3) Grow over the edge whose best candidate has the nearest circumcenter, as Prim's algorithm does for the dual of the
//! surface (`front`); candidates on slivers come last, and of a system of slivers the topmost is taken (`ring`). (4) No
//! edge gets a third triangle, no vertex a second fan beside a closed one (`fans`).
//! *Guarantee.* Facets of one triangulation do not intersect, and the surface is oriented. Correct on smooth surfaces sampled so densely
//! that the front never meets a sliver (Theorem 4.4.1); nothing is promised for others. The answer depends on the point set alone,
//! and not on its scale by powers of two.
//! *Trap.* What the text leaves open, and how it is closed: emptiness of the shrunk sphere is asked of the two vertices opposite
//! ([`Emptiness`]); ε is relative, so nothing has to be scaled; the seed faces up; several open fans at a vertex are allowed until
//! the front has passed, and [`Pinches`] says what becomes of those that stay; after a candidate that would spoil the surface the
//! next one by distance is tried. Sharp edges below π/4 stay open.
//! *Reference.* Sections 4.2 to 4.5 of the thesis.

mod angles;
mod answer;
mod candidates;
mod fans;
mod front;
mod joggle;
mod options;
mod pinches;
mod ring;

use taut_delaunay::{DelaunayOptions, Space};
use taut_points::{Monitor, Points, Scalar, on_threads};

use super::sides::Sides;
use crate::Error;
use candidates::Candidates;
use front::Front;

pub use super::filter::{AlphaFilter, Emptiness};
pub use answer::{ThesisCounters, ThesisSurface};
pub use options::{Extent, Pinches, Priority, ThesisOptions};

/// The surface that the thesis' front grows through the sites of a triangulation; its option `joggle` is for
/// [`thesis_surface_of_points`] alone.
///
/// # Errors
/// [`Error::Flat`] if the sites do not span space, [`Error::Input`] when the monitor says so.
pub fn thesis_surface(
    space: &Space,
    options: &ThesisOptions,
    monitor: &Monitor<'_>,
) -> Result<ThesisSurface, Error> {
    let filter = options.checked()?;
    on_threads(options.threads, || {
        let sides = Sides::of(space, &options.alpha.lengths())?;
        monitor.check()?;
        let candidates = Candidates::of(&sides, &filter, options.priority);
        monitor.check()?;
        let mut surface = if options.extent == Extent::Candidates {
            answer::of_candidates(&sides, &candidates)
        } else {
            let mut front = Front::new(&sides, &candidates, options);
            front.grow(options.extent, monitor)?;
            answer::of_front(&sides, &front, options.pinches)
        };
        surface.counters.candidates = candidates.len() as u64;
        surface.counters.facets = sides.facet_count() as u64;
        Ok(surface)
    })
}

/// The same for points: with their triangulation, which is that of the joggled points if that is asked for.
///
/// # Errors
/// As [`thesis_surface`], and [`Error::Input`] for points that are not of space, not finite, or too many.
pub fn thesis_surface_of_points<T: Scalar>(
    points: &Points<'_, T>,
    options: &ThesisOptions,
    monitor: &Monitor<'_>,
) -> Result<(Space, ThesisSurface), Error> {
    options.checked()?;
    let how = DelaunayOptions {
        threads: options.threads,
        monitor: *monitor,
        ..DelaunayOptions::default()
    };
    let space = match options.joggle {
        // Only points that a triangulation would accept are moved.
        Some(seed) if points.dim() == 3 && first_not_finite(points).is_none() => {
            let given: Vec<[f64; 3]> = (0..points.len())
                .map(|row| [0, 1, 2].map(|i| points.row(row)[i].into() + 0.0))
                .collect();
            let moved = joggle::joggle(&given, seed);
            let moved = Points::new(moved.as_flattened(), 3).expect("three coordinates each");
            Space::build(&moved, &how)?.renumbered()
        }
        _ => Space::build(points, &how)?.renumbered(),
    };
    let surface = thesis_surface(&space, options, monitor)?;
    Ok((space, surface))
}

fn first_not_finite<T: Scalar>(points: &Points<'_, T>) -> Option<usize> {
    points.values().iter().position(|&x| !Into::<f64>::into(x).is_finite())
}
