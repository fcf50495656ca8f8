//! A composable core-set: the summary of the points of one place, for those who combine the answers of all places.
//!
//! *Idea.* The first points of a farthest-first traversal, and how far all others are from them. Put together, such summaries are
//! again some points and a distance within which all others are. Centers of these few are centers of all, the distance being
//! added; and since the few are rows of the input, a proof that k balls of some radius do not hold them is one for all.
//! *Guarantee.* Summaries of k + 1 points each and a farthest-first root give at most 4 times the optimum, every summary being
//! within 2 times the optimum of its points and the root within as much of the summaries, and at most 6 times the bound that
//! they prove. More points, or a better root, give less; what is reached is measured by one pass over all points.
//! *Trap.* With k points a summary may be k copies of one place for all that the root can see, and nothing is proved.
//! *Reference.* Malkomes, Kusner, Chen, Weinberger and Moseley, NeurIPS 2015 (factor 4); Ceccarello, Pietracaprina and Pucci,
//! VLDB 2019 (larger summaries).

use taut_certify::{Centers, CentersCertificate, Items, LowerBound, Placement, Solution};
use taut_points::{InputError, Monitor, OrderBy, PointSource, Points, Scalar, hash_points};

use super::measure::measure;
use crate::separated_set::{gap, rounded_up};
use crate::{Error, FarthestFirst, FarthestFirstOptions, farthest_first};

/// A few rows of a point set, and how far all others are from them.
///
/// ```
/// use taut_certify::Placement;
/// use taut_enclose::CoreSetSummary;
/// use taut_points::{Distribution, Monitor, Points, generate};
///
/// let all: Vec<f64> = generate(Distribution::Uniform, 3000, 2, 7)?;
/// let part = |range: std::ops::Range<usize>| Points::new(&all[2 * range.start..2 * range.end], 2);
/// // Three places, each with a thousand of the points:
/// let summaries = [0, 1000, 2000].map(|first| {
///     CoreSetSummary::of(&part(first..first + 1000).unwrap(), first as u64, 50)
/// });
/// // In one place:
/// let mut root = CoreSetSummary::default();
/// for summary in summaries {
///     root = root.merge(summary?)?;
/// }
/// assert_eq!(root.rows().len(), 150);
/// let all = Points::new(&all, 2)?;
/// let found = root.solve(5, Placement::Free, &all, &Monitor::silent())?;
/// assert!(found.answer.radius <= 2.0 * found.answer.lower_bound + root.radius() + 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CoreSetSummary {
    dim: usize,
    /// Ascending.
    rows: Vec<u64>,
    /// Of these rows, row-major.
    coordinates: Vec<f64>,
    radius: f64,
    len: u64,
}

impl CoreSetSummary {
    /// The first `size` points of `points` in farthest-first order from the first row on; `first_row` is the number that row has
    /// in the whole.
    ///
    /// # Errors
    /// As [`farthest_first()`].
    pub fn of<T: Scalar>(points: &Points<'_, T>, first_row: u64, size: u64) -> Result<Self, Error> {
        let found = farthest_first(points, size, &FarthestFirstOptions::default())?;
        let mut order: Vec<usize> = found.order.iter().map(|&row| row as usize).collect();
        order.sort_unstable();
        Ok(CoreSetSummary {
            dim: points.dim(),
            rows: order.iter().map(|&row| first_row + row as u64).collect(),
            coordinates: order
                .iter()
                .flat_map(|&row| points.row(row))
                .map(|&value| value.into())
                .collect(),
            radius: reach(&found, points.dim()),
            len: points.len() as u64,
        })
    }

    /// These rows, in ascending order, as they are chosen by someone who measures the others himself; `len` points in all.
    pub(crate) fn of_rows(dim: usize, rows: Vec<u64>, coordinates: Vec<f64>, len: u64) -> Self {
        CoreSetSummary { dim, rows, coordinates, radius: f64::INFINITY, len }
    }

    /// The rows chosen, in ascending order.
    pub fn rows(&self) -> &[u64] {
        &self.rows
    }

    /// The points in these rows.
    ///
    /// # Errors
    /// [`Error::Empty`] for the summary of nothing.
    pub fn points(&self) -> Result<Points<'_, f64>, Error> {
        Points::new(&self.coordinates, self.dim).map_err(|_| Error::Empty)
    }

    /// Each of the points that this stands for is at most so far from one of those chosen.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// For how many points this stands.
    pub fn len(&self) -> u64 {
        self.len
    }

    /// Returns true if it stands for none, as [`CoreSetSummary::default`] does.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The summary of the points of both, which have no row in common: all rows of one and of the other. The order in which
    /// summaries are put together does not matter.
    ///
    /// # Errors
    /// [`Error::Input`] when the points are of different dimensions, or a row is in both.
    pub fn merge(self, other: CoreSetSummary) -> Result<Self, Error> {
        if self.is_empty() {
            return Ok(other);
        }
        if other.is_empty() {
            return Ok(self);
        }
        if self.dim != other.dim {
            return Err(Error::Input(InputError::Option {
                name: "other",
                value: format!("of dimension {}", other.dim),
                expected: "a summary of points of the same dimension",
            }));
        }
        let dim = self.dim;
        let both = self.rows.iter().zip(self.coordinates.chunks_exact(dim));
        let others = other.rows.iter().zip(other.coordinates.chunks_exact(dim));
        let mut all: Vec<(u64, &[f64])> = both.chain(others).map(|(&row, x)| (row, x)).collect();
        all.order_by_key(|&(row, _)| row);
        if let Some(twice) = all.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(Error::Input(InputError::Option {
                name: "other",
                value: format!("with row {}", twice[0].0),
                expected: "a summary of other rows than those of the first",
            }));
        }
        Ok(CoreSetSummary {
            dim,
            rows: all.iter().map(|&(row, _)| row).collect(),
            coordinates: all.iter().flat_map(|&(_, x)| x).copied().collect(),
            radius: self.radius.max(other.radius),
            len: self.len + other.len,
        })
    }

    /// A summary of at most `size` of these rows, whose radius is larger by what that leaves out.
    ///
    /// # Errors
    /// As [`farthest_first()`].
    pub fn reduce(self, size: u64) -> Result<Self, Error> {
        if self.rows.len() as u64 <= size {
            return Ok(self);
        }
        let mut reduced = CoreSetSummary::of(&self.points()?, 0, size)?;
        reduced.rows.iter_mut().for_each(|row| *row = self.rows[*row as usize]);
        reduced.radius = rounded_up(reduced.radius + self.radius, self.dim);
        reduced.len = self.len;
        Ok(reduced)
    }

    /// k centers for the points of `source`, found among these rows by farthest-first traversal and measured by one pass.
    ///
    /// # Errors
    /// As [`farthest_first()`] and [`CoreSetSummary::lift`].
    pub fn solve(
        &self,
        k: u64,
        placement: Placement,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Solution<Centers>, Error> {
        let points = self.points()?;
        let found = farthest_first(&points, k, &FarthestFirstOptions::default())?;
        self.lift(found.solution(k, placement, &points)?, source, monitor)
    }

    /// Centers of [`CoreSetSummary::points`], by whatever solver, as centers of the points of `source`: row numbers become those of
    /// the whole, the lower bound and its proof hold as they are, and the radius is measured by one pass.
    ///
    /// What is proved of centers among these rows need not hold among all rows, of which some may lie better. So centers
    /// among the rows are taken only with a proof that speaks of centers anywhere, by points apart, as [`CoreSetSummary::solve`] and
    /// [`farthest_first()`] give it.
    ///
    /// # Errors
    /// [`Error::Input`] for centers of anything but all of these points, without weights, for those among the rows with
    /// another proof, and for those whose lower bound is 0 while points are left out, as happens with summaries of no more
    /// rows than centers; [`Error::Input`], [`Error::Overflow`], [`Error::Input`].
    pub fn lift(
        &self,
        found: Solution<Centers>,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Solution<Centers>, Error> {
        let Solution { mut answer, mut certificate, mut trace } = found;
        let wrong = |value: &str| {
            Error::Input(InputError::Option {
                name: "found",
                value: value.into(),
                expected: "centers of the points of the summary with a lower bound, without weights and outliers",
            })
        };
        if certificate.items != Items::Points || certificate.weights || certificate.outliers > 0 {
            return Err(wrong("of weighted points, of balls, or with outliers"));
        }
        if certificate.points_hash != hash_points(&self.points()?, monitor)? {
            return Err(wrong("of other points"));
        }
        if certificate.placement == Placement::Rows
            && !self.are_apart_anywhere(&answer, &certificate)
        {
            return Err(wrong("among the rows, with a proof that holds of these rows only"));
        }
        if answer.centers.is_empty() || answer.centers.iter().any(|c| c.len() != source.dim()) {
            return Err(wrong("of another dimension"));
        }
        for row in certificate.core_set.iter_mut().chain(&mut answer.rows) {
            let place = usize::try_from(*row).ok().and_then(|row| self.rows.get(row));
            *row = *place.ok_or_else(|| wrong("with rows that the summary does not have"))?;
        }
        let measured = measure(source, &answer.centers, monitor)?;
        if answer.lower_bound == 0.0 && measured.radius > 0.0 {
            return Err(wrong(
                "without a bound: summaries of more rows than there are centers prove one",
            ));
        }
        answer.radius = rounded_up(measured.radius, source.dim());
        answer.assignment.clear();
        certificate.gap = gap(answer.radius, answer.lower_bound)?;
        certificate.points_hash = measured.points_hash;
        trace.passes += measured.passes;
        Ok(Solution { answer, certificate, trace })
    }
}

impl CoreSetSummary {
    /// Returns true if the lower bound is that no two of the core-set fit in one ball, wherever its center is.
    fn are_apart_anywhere(&self, answer: &Centers, certificate: &CentersCertificate) -> bool {
        let rows = &certificate.core_set;
        let place = |row: u64| {
            let at = usize::try_from(row).ok()?.checked_mul(self.dim)?;
            self.coordinates.get(at..at.checked_add(self.dim)?)
        };
        let Some(places) = rows.iter().map(|&row| place(row)).collect::<Option<Vec<_>>>() else {
            return false;
        };
        let is_apart = |a: &[f64], b: &[f64]| {
            let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
            // The bound of a traversal leaves more room than this rounds.
            square.sqrt() >= 2.0 * answer.lower_bound
        };
        certificate.proof == LowerBound::Separated
            && (0..places.len()).all(|i| (0..i).all(|j| is_apart(places[i], places[j])))
    }
}

/// The radius of all points of a traversal, rounded up.
fn reach(found: &FarthestFirst, dim: usize) -> f64 {
    rounded_up(found.radii.last().copied().unwrap_or(0.0), dim)
}
