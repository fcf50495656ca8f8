//! The alpha complex tile by tile.
//!
//! *Idea.* A facet needs the simplices on its two sides, one of which may be in another tile. A facet of the boundary belongs to
//! the tile of the simplex that stays; a facet on its own to the tile with the smaller number.
//! *Guarantee.* The complex of [`Plane::alpha_complex`] and [`Space::alpha_complex`], each simplex and facet once.

use taut_points::Monitor;

use super::{Mosaic, View};
use crate::query::{Radii, ascending, is_singular, turned};
use crate::simplex::GHOST;
use crate::triangulation::hull_facet;
use crate::{Error, Plane, Space};

/// A part of an alpha complex, as rows of the input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum AlphaPart<'a> {
    /// A simplex with circumradius ≤ α, in positive order.
    Simplex(&'a [u64]),
    /// A facet that has such a simplex on one side only, turned outward.
    Boundary(&'a [u64]),
    /// A facet that has none on either side, though an empty ball of radius ≤ α has it on its boundary; rows ascend.
    Singular(&'a [u64]),
}

fn of_tile<R: Radii<D, V>, const D: usize, const V: usize>(
    mosaic: &Mosaic<D>,
    tile: u32,
    alpha: f64,
    monitor: &Monitor<'_>,
    put: &mut dyn FnMut(AlphaPart<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    monitor.check()?;
    let tile = mosaic.tile(tile)?;
    if tile.counts.vertices_per_simplex as usize == V {
        let view = View::new(mosaic, &tile);
        for simplex in 0..tile.counts.simplices as u32 {
            of_simplex::<R, D, V>(&view, simplex, alpha, put)?;
        }
    }
    monitor.points(tile.counts.simplices);
    Ok(())
}

fn of_simplex<R: Radii<D, V>, const D: usize, const V: usize>(
    view: &View<'_, D>,
    simplex: u32,
    alpha: f64,
    put: &mut dyn FnMut(AlphaPart<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let place = view.place(simplex);
    let corners = view.corners::<V>(place)?;
    let stays = |at: [[f64; D]; V]| R::circumradius(ascending(at)) <= alpha;
    let is_inside = stays(corners.at);
    if is_inside {
        put(AlphaPart::Simplex(&corners.rows))?;
    }
    for i in 0..V {
        let other = view.across(place, &corners, i);
        let there = other.map(|other| view.corners::<V>(other)).transpose()?;
        if there.is_some_and(|there| stays(there.at)) {
            continue;
        }
        let mut with_ghost: [u32; V] = std::array::from_fn(|k| k as u32);
        with_ghost[i] = GHOST;
        let facet = turned(hull_facet::<D, V>(with_ghost));
        let rows = facet.map(|k| corners.rows[k as usize]);
        if is_inside {
            put(AlphaPart::Boundary(&rows))?;
        } else if other.is_none_or(|other| place < other) {
            let at = facet.map(|k| corners.at[k as usize]);
            let far = there.and_then(|there| {
                there.rows.iter().position(|row| !rows.contains(row)).map(|k| there.at[k])
            });
            let opposite = [Some(corners.at[i]), far].into_iter().flatten();
            if is_singular::<R, D, V>(at, opposite, alpha) {
                let mut rows = rows;
                rows.sort_unstable();
                put(AlphaPart::Singular(&rows))?;
            }
        }
    }
    Ok(())
}

/// The same in the plane and in space.
macro_rules! alpha_complex {
    ($d:literal, $v:literal, $of:ident) => {
        impl Mosaic<$d> {
            #[doc = concat!("The alpha complex, as [`", stringify!($of), "::alpha_complex`]: its parts go to `put`,")]
            /// tile by tile. O(simplices).
            ///
            /// # Errors
            /// Those of `put`, of reading, and of the monitor.
            pub fn alpha_complex(
                &self,
                alpha: f64,
                monitor: &Monitor<'_>,
                put: &mut dyn FnMut(AlphaPart<'_>) -> Result<(), Error>,
            ) -> Result<(), Error> {
                monitor.pass(1, self.simplices());
                let mut parts = |&tile| self.alpha_complex_of(tile, alpha, monitor, put);
                self.tiles().iter().try_for_each(&mut parts)
            }

            /// The part of the alpha complex that belongs to one tile, as the whole.
            ///
            /// # Errors
            /// Those of `put`, of reading, and of the monitor.
            ///
            /// # Panics
            /// If there is no such tile.
            pub fn alpha_complex_of(
                &self,
                tile: u32,
                alpha: f64,
                monitor: &Monitor<'_>,
                put: &mut dyn FnMut(AlphaPart<'_>) -> Result<(), Error>,
            ) -> Result<(), Error> {
                of_tile::<$of, $d, $v>(self, tile, alpha, monitor, put)
            }
        }
    };
}
alpha_complex!(2, 3, Plane);
alpha_complex!(3, 4, Space);
