//! Queries of points and of balls by a tree of boxes and balls: nearest, within a distance, along a ray, farthest, pairs, diameter.
//!
//! *Problem.* Which rows are nearest to a place, near it, met by a ray, farthest from it; which rows of one or two sets are near each
//! other; which two are farthest apart.
//! *Idea.* Blocks of sixteen rows, and above them nodes of eight children, each with a box and a ball around its rows ([`nodes`]).
//! Bounds of eight children are calculated at once; what cannot be in the answer is left out ([`traverse`]). Searches that look for
//! what is near climb from a home block ([`cuts`]) and prune by boxes, rays prune by balls, and what is far by both.
//! *Guarantee.* The rows of brute force over distances as calculated in `f64`: the root of ((x² + y²) + z²) + … of differences, and
//! of equal ones the lowest row; for coordinates of any finite size ([`measure`]). The same for any number of threads.
//! *Trap.* Distances that differ by less than their rounding, some 10⁻¹⁶ of them, are ordered as calculated, not as they are.
//! *Reference.* S. M. Omohundro: Five balltree construction algorithms, ICSI TR-89-063, 1989, for trees of balls; sections 2 and 2.4
//! of the thesis name such trees as an application of enclosing balls.

mod batch;
mod build;
mod collect;
mod cuts;
mod diameter;
mod dim;
mod measure;
mod nodes;
mod pairs;
mod places;
mod rays;
mod traverse;

use taut_certify::Items;
use taut_points::{InputError, Monitor, PointSource, ReadError, Rows, Scratch, on_threads};

use crate::Error;
use batch::run_one;
use dim::AnyDim;
use nodes::{BLOCK_SIZE, Nodes};
use places::{FindFarthest, FindNearest, FindNearestK, FindWithin};
use rays::FindHits;

/// Options to build the tree. Write `SphereSearchOptions { inputs: Items::Balls, ..Default::default() }`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereSearchOptions<'a> {
    /// The kind of the rows: points, or balls, whose last column is the radius. Default points.
    pub inputs: Items,
    /// Threads, 1 to 1024; `None` for those of the surrounding pool. The tree does not depend on it.
    pub threads: Option<usize>,
    /// Can stop the work before the tree is built. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for SphereSearchOptions<'_> {
    fn default() -> Self {
        SphereSearchOptions { inputs: Items::Points, threads: None, monitor: Monitor::silent() }
    }
}

/// Options of a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QueryOptions<'a> {
    /// Threads, 1 to 1024; `None` for those of the surrounding pool. No answer depends on it.
    pub threads: Option<usize>,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for QueryOptions<'_> {
    fn default() -> Self {
        QueryOptions { threads: None, monitor: Monitor::silent() }
    }
}

/// A row found from a place or along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// The row, from 0.
    pub row: u64,
    /// Its distance, infinite beyond the largest `f64`. From a place to a ball it is that to the near side, negative inside, or for
    /// the farthest that to the far side; along a ray that to where it enters the ball, 0 where it begins inside.
    pub distance: f64,
}

/// Two rows that are near each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowPair {
    /// The row of the first set and that of the second; of one set the lower one first.
    pub rows: [u64; 2],
    /// Their distance, less the radii of balls: negative where these overlap.
    pub distance: f64,
}

/// Two rows that are far apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diameter {
    /// The rows, the lower one first; twice the same where all points are equal, or where one ball is wider than any two.
    pub rows: [u64; 2],
    /// Their distance, with the radii of balls.
    pub distance: f64,
    /// No two rows are farther apart, as calculated; at most (1 + ε) times the distance.
    pub upper_bound: f64,
}

/// Points or balls in a tree that answers queries.
///
/// The source has n rows of d coordinates, for balls with the radius behind them; queries have m rows of d coordinates, in the same
/// unit, and answers come in the order of the queries. Distances are in that unit, and what is found is that of brute force over
/// distances as calculated in `f64`. Trees of balls are those of Omohundro (ICSI TR-89-063, 1989) and of section 2.4 of the thesis.
///
/// The rows are copied: 8·d + 4 bytes each, and about a fifth of that for boxes and balls.
///
/// ```
/// use taut_search::{QueryOptions, SphereSearch, SphereSearchOptions};
///
/// let points = taut_points::Points::new(&[0.0, 0.0, 2.0, 0.0, 2.0, 0.0, 1.0, 5.0], 2)?;
/// let search = SphereSearch::new(&points, &SphereSearchOptions::default())?;
/// let places = taut_points::Points::new(&[1.5, 0.0, 1.0, 9.0], 2)?;
/// let found = search.nearest(&places, &QueryOptions::default())?;
/// assert_eq!((found[0].row, found[0].distance), (1, 0.5));                // of equal distances the lowest row
/// assert_eq!((found[1].row, found[1].distance), (3, 4.0));
/// let near = search.within(&places, 2.0, &QueryOptions::default())?;
/// assert_eq!(near[0].iter().map(|found| found.row).collect::<Vec<_>>(), [1, 2, 0]);
/// assert_eq!(search.diameter(0.0, &QueryOptions::default())?.rows, [0, 3]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SphereSearch {
    nodes: Nodes,
    items: Items,
    len: u64,
    /// All coordinates and radii are [`measure::is_plain`].
    is_plain: bool,
    /// The largest absolute value of a coordinate or a radius.
    size: f64,
}

impl SphereSearch {
    /// Builds the tree over the rows of a source, which are read into memory.
    ///
    /// *Cost.* O(n log n) for the order of the rows, and O(n) for each of the ⌈log₈(n/16)⌉ levels.
    ///
    /// # Errors
    /// [`Error::Empty`]; [`Error::NegativeRadius`] and [`Error::NoRadius`] of balls; [`Error::Input`] for coordinates that are not
    /// finite, ellipsoids, 2³² − 1 rows or more, and when the source fails or the monitor stops the work.
    pub fn new(source: &dyn PointSource, options: &SphereSearchOptions<'_>) -> Result<Self, Error> {
        on_threads(options.threads, || Self::build(source, options))
    }

    fn build(source: &dyn PointSource, options: &SphereSearchOptions<'_>) -> Result<Self, Error> {
        let (len, columns) = (source.len(), source.dim());
        if options.inputs == Items::Ellipsoids {
            let (name, value) = ("inputs", "ellipsoids".to_owned());
            return Err(InputError::Option { name, value, expected: "points or balls" }.into());
        }
        if options.inputs == Items::Balls && columns < 2 {
            return Err(Error::NoRadius { columns });
        }
        if len == 0 {
            return Err(Error::Empty);
        }
        let values = read(source, &options.monitor)?;
        let size = values.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        let is_plain = measure::is_plain(&values);
        let (values, dim, radii) = match options.inputs {
            Items::Balls => {
                let (centers, radii) = balls(&values, columns)?;
                (centers, columns - 1, radii)
            }
            _ => (values, columns, vec![]),
        };
        let nodes = Nodes::of(&values, dim, &radii);
        Ok(SphereSearch { nodes, items: options.inputs, len, is_plain, size })
    }

    /// Rows.
    #[allow(clippy::len_without_is_empty)] // There is at least one.
    pub fn len(&self) -> u64 {
        self.len
    }

    /// Coordinates of a place, without the radius of balls.
    pub fn dim(&self) -> usize {
        self.nodes.dim
    }

    /// The kind of the rows.
    pub fn items(&self) -> Items {
        self.items
    }

    /// The row nearest to each of m places, of several the lowest: m answers. About O(d log n) for each where places are near the rows and d is
    /// small, O(nd) at worst.
    ///
    /// # Errors
    /// [`Error::Input`] for places with other dimensions or coordinates that are not finite, and when the monitor stops the work.
    pub fn nearest(
        &self,
        places: &dyn PointSource,
        options: &QueryOptions<'_>,
    ) -> Result<Vec<Neighbor>, Error> {
        self.ask(places, self.dim(), options, &FindNearest)
    }

    /// The row nearest to one place, by this thread alone; `None` unless the place has as many coordinates as the rows, all finite.
    pub fn nearest_to(&self, place: &[f64]) -> Option<Neighbor> {
        let fits = place.len() == self.dim() && place.iter().all(|x| x.is_finite());
        if fits { run_one(self, place, &FindNearest) } else { None }
    }

    /// The `k` rows nearest to each place, nearest first, and lower rows first where they are equally near; all rows where there are
    /// no more than `k`.
    ///
    /// # Errors
    /// As [`SphereSearch::nearest`], and for a `k` of 0.
    pub fn nearest_k(
        &self,
        places: &dyn PointSource,
        k: usize,
        options: &QueryOptions<'_>,
    ) -> Result<Vec<Vec<Neighbor>>, Error> {
        if k == 0 {
            return Err(refused("k", 0.0, "at least 1"));
        }
        let k = k.min(self.len as usize);
        self.ask(places, self.dim(), options, &FindNearestK(k))
    }

    /// All rows within a radius of each place, the border included, nearest first and lower rows first where they are equally near.
    ///
    /// # Errors
    /// As [`SphereSearch::nearest`], and for a radius that is NaN.
    pub fn within(
        &self,
        places: &dyn PointSource,
        radius: f64,
        options: &QueryOptions<'_>,
    ) -> Result<Vec<Vec<Neighbor>>, Error> {
        if radius.is_nan() {
            return Err(refused("radius", radius, "a number"));
        }
        self.ask(places, self.dim(), options, &FindWithin(radius))
    }

    /// The row farthest from each place, of several the lowest; with ε > 0 a row so that no other is farther than 1 + ε times.
    ///
    /// # Errors
    /// As [`SphereSearch::nearest`], and for an ε that is negative or not finite.
    pub fn farthest(
        &self,
        places: &dyn PointSource,
        epsilon: f64,
        options: &QueryOptions<'_>,
    ) -> Result<Vec<Neighbor>, Error> {
        check_epsilon(epsilon)?;
        self.ask(places, self.dim(), options, &FindFarthest(1.0 + epsilon))
    }

    /// The rows whose balls each ray meets, in the order in which it enters them, lower rows first where it enters several at once.
    /// A ray is a row of 2d numbers, its origin and its direction, of any length. A point is a ball of radius `hit_radius`, and a ball
    /// has that much more.
    ///
    /// # Errors
    /// As [`SphereSearch::nearest`]; [`Error::NoDirection`]; for a hit radius that is negative or not finite.
    pub fn hits(
        &self,
        rays: &dyn PointSource,
        hit_radius: f64,
        options: &QueryOptions<'_>,
    ) -> Result<Vec<Vec<Neighbor>>, Error> {
        self.ask_rays(rays, options, &FindHits { hit_radius, first_only: false })
    }

    /// The first row that each ray meets; see [`SphereSearch::hits`].
    ///
    /// # Errors
    /// As [`SphereSearch::hits`].
    pub fn first_hits(
        &self,
        rays: &dyn PointSource,
        hit_radius: f64,
        options: &QueryOptions<'_>,
    ) -> Result<Vec<Option<Neighbor>>, Error> {
        let found = self.ask_rays(rays, options, &FindHits { hit_radius, first_only: true })?;
        Ok(found.into_iter().map(|hits| hits.first().copied()).collect())
    }

    /// All pairs of rows within a distance of each other, sorted; of balls those that touch, for 0.
    ///
    /// # Errors
    /// For a distance that is NaN, and when the monitor stops the work.
    pub fn pairs(&self, distance: f64, options: &QueryOptions<'_>) -> Result<Vec<RowPair>, Error> {
        self.find_pairs(None, distance, options)
    }

    /// All pairs of a row of this tree and one of another within a distance of each other, sorted.
    ///
    /// # Errors
    /// For trees of other dimensions, a distance that is NaN, and when the monitor stops the work.
    pub fn pairs_with(
        &self,
        other: &SphereSearch,
        distance: f64,
        options: &QueryOptions<'_>,
    ) -> Result<Vec<RowPair>, Error> {
        if other.dim() != self.dim() {
            return Err(other_dimension(other.dim()));
        }
        self.find_pairs(Some(other), distance, options)
    }

    /// The two rows that are farthest apart, of several the lowest; with ε > 0 two rows so that no two are farther apart than 1 + ε
    /// times, by pairs of nodes (Har-Peled, SoCG 2001). Runs on one thread. O(n log n) for most sets; see docs/sphere-tree.md for rows on a sphere.
    ///
    /// # Errors
    /// For an ε that is negative or not finite, and when the monitor stops the work.
    pub fn diameter(&self, epsilon: f64, options: &QueryOptions<'_>) -> Result<Diameter, Error> {
        check_epsilon(epsilon)?;
        on_threads(options.threads, || diameter::diameter(self, epsilon, &options.monitor))
    }

    fn find_pairs(
        &self,
        other: Option<&SphereSearch>,
        distance: f64,
        options: &QueryOptions<'_>,
    ) -> Result<Vec<RowPair>, Error> {
        if distance.is_nan() {
            return Err(refused("distance", distance, "a number"));
        }
        on_threads(options.threads, || pairs::within(self, other, distance, options))
    }

    fn ask<W: batch::Work>(
        &self,
        queries: &dyn PointSource,
        width: usize,
        options: &QueryOptions<'_>,
        work: &W,
    ) -> Result<Vec<W::Found>, Error> {
        if queries.dim() != width && !(queries.is_empty()) {
            return Err(other_dimension(queries.dim()));
        }
        on_threads(options.threads, || {
            let values = read(queries, &options.monitor)?;
            batch::run(self, &values, width, options, work)
        })
    }

    fn ask_rays(
        &self,
        rays: &dyn PointSource,
        options: &QueryOptions<'_>,
        work: &FindHits,
    ) -> Result<Vec<Vec<Neighbor>>, Error> {
        let (hit_radius, dim) = (work.hit_radius, self.dim());
        if !(hit_radius >= 0.0 && hit_radius.is_finite()) {
            return Err(refused("hit_radius", hit_radius, "a finite number of at least 0"));
        }
        if rays.dim() != 2 * dim && !rays.is_empty() {
            let expected = "twice as many as the rows of the tree, an origin and a direction";
            return Err(InputError::Dimension { dim: rays.dim(), expected }.into());
        }
        on_threads(options.threads, || {
            let values = read(rays, &options.monitor)?;
            let has_direction = |ray: &[f64]| ray[dim..].iter().any(|&x| x != 0.0);
            match values.chunks_exact(2 * dim).position(|ray| !has_direction(ray)) {
                Some(row) => Err(Error::NoDirection { row: row as u64 }),
                None => batch::run(self, &values, 2 * dim, options, work),
            }
        })
    }

    /// The radius of a row, 0 of a point.
    #[inline(always)]
    fn row_radius(&self, block: usize, lane: usize) -> f64 {
        match self.items {
            Items::Points => 0.0,
            _ => self.nodes.radii_of(block)[lane],
        }
    }

    /// The coordinates of the row in a lane of all blocks.
    fn row(&self, lane: usize) -> Vec<f64> {
        let block = self.nodes.block(AnyDim(self.dim()), lane / BLOCK_SIZE);
        block.iter().map(|column| column[lane % BLOCK_SIZE]).collect()
    }
}

fn refused(name: &'static str, value: f64, expected: &'static str) -> Error {
    InputError::Option { name, value: value.to_string(), expected }.into()
}

fn check_epsilon(epsilon: f64) -> Result<(), Error> {
    match epsilon >= 0.0 && epsilon.is_finite() {
        true => Ok(()),
        false => Err(refused("epsilon", epsilon, "a finite number of at least 0")),
    }
}

fn other_dimension(dim: usize) -> Error {
    InputError::Dimension { dim, expected: "as many as the rows of the tree" }.into()
}

/// All rows in double precision, finite or refused.
fn read(source: &dyn PointSource, monitor: &Monitor<'_>) -> Result<Vec<f64>, Error> {
    /// Rows and queries have numbers of 32 bits.
    const ROWS_MAX: u64 = u32::MAX as u64 - 1;
    if source.len() > ROWS_MAX {
        return Err(InputError::TooManyPoints { points: source.len(), most: ROWS_MAX }.into());
    }
    monitor.check().map_err(ReadError::from)?;
    let mut scratch = Scratch::new();
    let rows = source.read(0..source.len(), &mut scratch)?;
    rows.check_finite(0)?;
    Ok(match rows {
        Rows::F32(points) => points.values().iter().map(|&x| x.into()).collect(),
        Rows::F64(points) => points.values().to_vec(),
    })
}

/// Centers and radii.
fn balls(values: &[f64], columns: usize) -> Result<(Vec<f64>, Vec<f64>), Error> {
    let radii: Vec<f64> = values.iter().skip(columns - 1).step_by(columns).copied().collect();
    if let Some(row) = radii.iter().position(|&radius| radius < 0.0) {
        return Err(Error::NegativeRadius { row: row as u64, value: radii[row] });
    }
    let centers = values.chunks_exact(columns).flat_map(|row| &row[..columns - 1]).copied();
    Ok((centers.collect(), radii))
}
