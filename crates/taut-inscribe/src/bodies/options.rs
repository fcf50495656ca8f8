//! How to look for bodies.

use taut_points::{InputError, Monitor};

use super::directions::{Directions, KINDS};

/// The fewest facets of a body that are allowed: with fewer the planes through the nearest points hardly ever bound a body.
const FACETS_MIN: usize = 8;

/// The most facets of a body that a certificate may have.
const FACETS_MAX: usize = 256;

/// The facets of bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyShape<'a> {
    /// Facets in so many fixed directions (k-dops): 6, 14, 18 or 26.
    Dop(usize),
    /// Facets in these directions and against them: from 3 to 13, no two parallel, not all in one plane, in whole numbers whose
    /// absolute values add up to at most 63 in each.
    Directions(&'a [[i64; 3]]),
    /// Facets in any directions, at most so many of each body: from 8 to 256. More facets cover more.
    Free(usize),
}

taut_points::choice! { "objective", Objective {
    Volume = "volume", "by the part of the inside that bodies cover";
    Occlusion = "occlusion", "by the part of the lines through the mesh that meet a body";
} }

/// How the search tells which bodies are better.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Objective {
    /// By the part of the inside that they cover.
    #[default]
    Volume,
    /// By the part of the lines through the mesh that also meet a body: how much of the mesh the bodies hide.
    Occlusion,
}

/// Cells of the grid of seeds along the longest side that are allowed.
const CELLS: std::ops::RangeInclusive<usize> = 2..=256;

/// Vertices that may vote on a point.
const VOTES: std::ops::RangeInclusive<usize> = 1..=100;

taut_points::choice! { "seeds", ThesisSeeds {
    Grid = "grid", "the point of a grid farthest from all vertices and dops";
    Center = "center", "the center of the bounding box, then random points";
    Random = "random", "random points";
} }

/// Where the procedure of the thesis starts dops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ThesisSeeds {
    /// At the point of a grid that is farthest from all vertices and dops.
    #[default]
    Grid,
    /// At the center of the bounding box, then at random points.
    Center,
    /// At random points.
    Random,
}

/// What the procedure of the thesis leaves open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BodiesThesisOptions {
    /// Where dops start. Default [`ThesisSeeds::Grid`].
    pub seeds: ThesisSeeds,
    /// Cells of the grid of seeds along the longest side, from 2 to 256. Default 32.
    pub cells: usize,
    /// How many of the nearest vertices vote on whether a point is inside, from 1 to 100. Default 5.
    pub votes: usize,
    /// Whether a dop that has doubled its size moves away from what it touches, and doubles again. Default false: with seeds of a
    /// grid the thesis found it unnecessary.
    pub translate: bool,
    /// Whether a dop starts around the centers of two spheres, the largest one and its largest neighbor; with seeds of a grid.
    /// Default false.
    pub merge: bool,
}

impl BodiesThesisOptions {
    /// The defaults.
    pub const DEFAULT: Self = BodiesThesisOptions {
        seeds: ThesisSeeds::Grid,
        cells: 32,
        votes: 5,
        translate: false,
        merge: false,
    };

    fn check(&self) -> Result<(), InputError> {
        for (name, value, range, expected) in [
            ("cells", self.cells, CELLS, "from 2 to 256"),
            ("votes", self.votes, VOTES, "from 1 to 100"),
        ] {
            if !range.contains(&value) {
                return Err(InputError::Option { name, value: value.to_string(), expected });
            }
        }
        Ok(())
    }
}

impl Default for BodiesThesisOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}

taut_points::choice! { "method", BodiesMethod {
    Recreate = "recreate", "grow bodies by events, ruin them in a few facets and grow them again";
    Thesis(BodiesThesisOptions::DEFAULT) = "thesis",
        "disjoint k-dops by doubling and sliding, as in the thesis";
} }

/// The methods.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BodiesMethod {
    /// Bodies grow by events; random changes improve them against each other.
    #[default]
    Recreate,
    /// Disjoint k-dops by the procedure of section 8.5 of the thesis, step by step. It knows neither [`BodiesOptions::at`] nor
    /// [`Objective::Occlusion`], and ends by itself, without a budget of events.
    Thesis(BodiesThesisOptions),
}

/// How to look for bodies. Write `BodiesOptions { count: 10, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct BodiesOptions<'a> {
    /// The facets of bodies. Default [`BodyShape::Free`] with 256 facets.
    pub shape: BodyShape<'a>,
    /// How bodies are found. Default [`BodiesMethod::Recreate`].
    pub method: BodiesMethod,
    /// How the search tells which bodies are better. Default [`Objective::Volume`].
    pub objective: Objective,
    /// Most bodies to find, from 1 to 1000; fewer are found where no more fit. Default 1.
    pub count: usize,
    /// Whether no two bodies may overlap. Default false.
    pub disjoint: bool,
    /// Points that the first bodies contain, one each, in the coordinates of the mesh. Where they are more than `count`, there
    /// are as many bodies as points. Default none.
    pub at: &'a [[f64; 3]],
    /// Other ends of segments, if not none one for each point in `at`: the bodies contain the segments between both. Where the
    /// ends are equal, that is a point. Default none.
    pub ends: &'a [[f64; 3]],
    /// The part of the inside that is to be covered, above 0 and at most 1: no more bodies are added once they cover it, by the
    /// points that the search counts. Default none.
    pub coverage: Option<f64>,
    /// The part of the lines through the mesh that is to be hidden, above 0 and at most 1: no more bodies are added once they hide
    /// it, by the lines that the search counts. With [`Objective::Occlusion`] only. Default none.
    pub hidden: Option<f64>,
    /// The part of what bodies cover, or hide, that may be lost to have fewer of them, from 0 to below 1: needless bodies go, and
    /// pairs of bodies give way to one. Merging takes half as many events as the search in addition. Default none: no merging.
    pub merge_within: Option<f64>,
    /// Whether the holes of a mesh that is not closed are closed by triangles, which the answer names. Default false.
    pub close_holes: bool,
    /// How many facet events one search may take, at least 1: a facet of a k-dop that moves or tries to, or a plane of a body with
    /// free facets. A search for k-dops is preceded by those with fewer directions. Default 200,000.
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
            method: BodiesMethod::Recreate,
            objective: Objective::Volume,
            count: 1,
            disjoint: false,
            at: &[],
            ends: &[],
            coverage: None,
            hidden: None,
            merge_within: None,
            close_holes: false,
            events: 200_000,
            seed: 0,
            monitor: Monitor::silent(),
        }
    }
}

impl BodiesOptions<'_> {
    /// Whether no two bodies may overlap: those of the thesis never do.
    pub(super) fn is_disjoint(&self) -> bool {
        self.disjoint || matches!(self.method, BodiesMethod::Thesis(_))
    }

    /// Refuses options out of range.
    pub(super) fn check(&self) -> Result<(), InputError> {
        let wrong =
            |name, value: String, expected| Err(InputError::Option { name, value, expected });
        match self.shape {
            BodyShape::Dop(directions) if !KINDS.contains(&directions) => {
                return wrong("directions", directions.to_string(), "6, 14, 18 or 26");
            }
            BodyShape::Directions(directions) => {
                Directions::given(directions)?;
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
        if !self.ends.is_empty() && self.ends.len() != self.at.len() {
            let expected = "none, or one for each point of `at`";
            return wrong("ends", format!("{} points", self.ends.len()), expected);
        }
        if let Some(part) = self.coverage
            && !(part > 0.0 && part <= 1.0)
        {
            return wrong("coverage", format!("{part:?}"), "above 0 and at most 1");
        }
        if let Some(part) = self.hidden
            && !(part > 0.0 && part <= 1.0 && self.objective == Objective::Occlusion)
        {
            let expected = "above 0 and at most 1, with objective occlusion";
            return wrong("hidden", format!("{part:?}"), expected);
        }
        if let Some(part) = self.merge_within
            && !(0.0..1.0).contains(&part)
        {
            return wrong("merge_within", format!("{part:?}"), "from 0 to below 1");
        }
        if self.events == 0 {
            return wrong("events", "0".to_owned(), "at least 1");
        }
        let BodiesMethod::Thesis(thesis) = self.method else { return Ok(()) };
        if matches!(self.shape, BodyShape::Free(_)) {
            return wrong("method", self.method.to_string(), "recreate for free facets");
        }
        if self.objective == Objective::Occlusion {
            return wrong("objective", self.objective.to_string(), "volume with method thesis");
        }
        if !self.at.is_empty() {
            return wrong("at", format!("{} points", self.at.len()), "none with method thesis");
        }
        if let Some(part) = self.merge_within {
            return wrong("merge_within", format!("{part:?}"), "none with method thesis");
        }
        thesis.check()
    }
}
