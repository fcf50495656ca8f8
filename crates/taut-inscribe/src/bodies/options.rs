//! How to look for bodies.

use taut_points::{InputError, Monitor};

use super::directions::KINDS;

/// The fewest facets of a body that are allowed: with fewer the planes through the nearest points hardly ever bound a body.
const FACETS_MIN: usize = 8;

/// The most facets of a body that a certificate may have.
const FACETS_MAX: usize = 256;

/// The facets of bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyShape {
    /// Facets in so many fixed directions (k-dops): 6, 14, 18 or 26.
    Dop(usize),
    /// Facets in any directions, at most so many of each body: from 8 to 256. More facets cover more.
    Free(usize),
}

/// How to look for bodies. Write `BodiesOptions { count: 10, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct BodiesOptions<'a> {
    /// The facets of bodies. Default [`BodyShape::Free`] with 256 facets.
    pub shape: BodyShape,
    /// Most bodies to find, from 1 to 1000; fewer are found where no more fit. Default 1.
    pub count: usize,
    /// Whether no two bodies may overlap. Default false.
    pub disjoint: bool,
    /// Points that the first bodies contain, one each, in the coordinates of the mesh. Where they are more than `count`, there
    /// are as many bodies as points. Default none.
    pub at: &'a [[f64; 3]],
    /// The part of the inside that is to be covered, above 0 and at most 1: no more bodies are added once they cover it, by the
    /// points that the search counts. Default none.
    pub coverage: Option<f64>,
    /// Whether the holes of a mesh that is not closed are closed by triangles, which the answer names. Default false.
    pub close_holes: bool,
    /// How many facet events one search may compute, at least 1: a facet of a k-dop that moves, or a plane of a body with free
    /// facets. A search for k-dops is preceded by those with fewer directions. Default 200,000.
    pub events: u64,
    /// Where the random choices begin. Default 0.
    pub seed: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for BodiesOptions<'_> {
    fn default() -> Self {
        BodiesOptions {
            shape: BodyShape::Free(FACETS_MAX),
            count: 1,
            disjoint: false,
            at: &[],
            coverage: None,
            close_holes: false,
            events: 200_000,
            seed: 0,
            monitor: Monitor::silent(),
        }
    }
}

impl BodiesOptions<'_> {
    /// Refuses options out of range.
    pub(super) fn check(&self) -> Result<(), InputError> {
        let wrong =
            |name, value: String, expected| Err(InputError::Option { name, value, expected });
        match self.shape {
            BodyShape::Dop(directions) if !KINDS.contains(&directions) => {
                return wrong("directions", directions.to_string(), "6, 14, 18 or 26");
            }
            BodyShape::Free(facets) if !(FACETS_MIN..=FACETS_MAX).contains(&facets) => {
                return wrong("facets", facets.to_string(), "from 8 to 256");
            }
            _ => {}
        }
        if !(1..=1000).contains(&self.count) {
            return wrong("count", self.count.to_string(), "from 1 to 1000");
        }
        if self.at.len() > 1000 {
            return wrong("at", format!("{} points", self.at.len()), "at most 1000 points");
        }
        if let Some(part) = self.coverage
            && !(part > 0.0 && part <= 1.0)
        {
            return wrong("coverage", format!("{part:?}"), "above 0 and at most 1");
        }
        if self.events == 0 {
            return wrong("events", "0".to_owned(), "at least 1");
        }
        Ok(())
    }
}
