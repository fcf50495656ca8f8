//! The few points that can matter, in memory: what one pass over all points leaves to be looked at again and again.
//!
//! *Idea.* A pass with the ellipsoid |M₀(x − c₀)|² lists all points beyond some b. For another ellipsoid, and any point
//! that is not listed, M(x − c) = Tz + s with T = MM₀⁻¹, s = M(c₀ − c) and |z|² ≤ b. Where the largest of such lengths
//! ([`reach2`]) is less than √d, a pass over the list tells as much as a pass over all points.
//! In the same way a pass over the list leaves a list of the few points of it that are near the border or outside.
//! *Guarantee.* The bound holds with the rounding of M₀⁻¹ added to it; what is listed does not depend on threads.
//! *Trap.* A list is of use only if M₀ is near the end: that of a covariance is for normal points, not for points near
//! an ellipsoid. So the ellipsoid of a sample comes first.

use taut_kernels::vector::dot;

use super::dense::divide_rows;
use super::point_reader::{PassResult, PointReader, Query, pass_of_squares, squares_of};
use super::sample::Sample;
use super::whitener::Whitener;
use super::working_set::{WorkingSet, rows_of_blocks};
use crate::Error;
use crate::shapes::eigen::eigen;

/// Most points of a list, on average.
const MOST_LISTED: f64 = 65536.0;
/// At least this many points of the sample lie above the threshold of a list, beside its share: as few as one would say
/// nothing.
const SAMPLE_RANK_MIN: usize = 10;
/// A block gives at most this many times its share to a list, which bounds what the order of the points can do.
const BLOCK_SHARE_MAX: f64 = 16.0;

/// Near points have a list of their own if they are at most this share of theirs. A half made no difference in time that could be told
/// from noise on 10⁵ × 10 normal points, and takes more memory.
const NEAR_SHARE_MAX: f64 = 0.25;
/// A shorter list is measured in about the time that it takes to bound what another leaves out, by a count of operations in ten
/// dimensions.
const NARROWED_LIST_MIN: usize = 1024;
/// Where the largest |y|² is more times d than this, near points reach so far down that roundings of their |y|² and of the border
/// differ.
const NARROWED_LARGEST_MAX: f64 = 4.0;

/// Rows of a source, or of another list, and what is known of those of it that are not among them.
pub(super) struct Shortlist {
    dim: usize,
    /// Row numbers.
    ids: Vec<u64>,
    /// Their coordinates as they are in the source, in parts.
    rows: Vec<Vec<f64>>,
    /// The ellipsoid that listed them, and the |y|² that no other point of the source or of the longer list exceeds; `None` if they
    /// are but a sample.
    listed: Option<(Whitener, f64)>,
    /// Those that were near the border or outside when all of this list were last measured.
    near: Option<Box<Shortlist>>,
}

impl Shortlist {
    /// A sample, of which nothing follows for other points.
    pub(super) fn of_sample(sample: &Sample) -> Self {
        let dim = sample.set.dim();
        let mut rows = rows_of_blocks(sample.set.blocks(), dim, sample.set.len());
        for row in rows.chunks_exact_mut(dim) {
            row.iter_mut().zip(&sample.origin).for_each(|(x, o)| *x += o);
        }
        Shortlist {
            dim,
            ids: sample.set.ids().to_vec(),
            rows: vec![rows],
            listed: None,
            near: None,
        }
    }

    /// One pass over all points, in which this whitener lists about a share of them, and what a pass over the list would find.
    pub(super) fn of_pass(
        reader: &mut PointReader<'_>,
        query: Query<'_>,
        whitener: &Whitener,
        sample: &Sample,
        share: f64,
    ) -> Result<(Self, PassResult), Error> {
        let share = share.min(MOST_LISTED / reader.len() as f64);
        let mut leverages = whitener.apply(&sample.set).leverages;
        let rank =
            ((share * leverages.len() as f64) as usize + SAMPLE_RANK_MIN).min(leverages.len() - 1);
        let (_, &mut above, _) = leverages.select_nth_unstable_by(rank, |a, b| b.total_cmp(a));
        let lower = Query { above: above.min(query.above), ..query };
        let Some(taken) = reader.take(lower, BLOCK_SHARE_MAX * share)? else {
            return Err(Error::Overflow);
        };
        // A list of a pass holds the points with a multiplier, unless numbers have left their range.
        if taken.ids.is_empty() {
            return Err(Error::Overflow);
        }
        let listed = Some((whitener.clone(), taken.above));
        let (dim, ids, rows) = (reader.dim(), taken.ids, taken.rows);
        let squares = taken.squares.unwrap_or_else(|| squares_of(dim, &rows, query));
        let found = pass_of_squares(&ids, &squares, query);
        let mut list = Shortlist { dim, ids, rows, listed, near: None };
        list.near = list.narrowed(&squares, found.largest, whitener);
        Ok((list, found))
    }

    /// Makes a pass over the list, or only over those of it that can be above the threshold of the query, which has the ellipsoid of
    /// the whitener.
    pub(super) fn pass(&mut self, query: Query<'_>, whitener: &Whitener, doubt: f64) -> PassResult {
        debug_assert_eq!(query.matrix, whitener.matrix());
        if let Some(near) = &mut self.near
            && near.others(whitener, doubt) < query.above
        {
            return near.pass(query, whitener, doubt);
        }
        let squares = squares_of(self.dim, &self.rows, query);
        let found = pass_of_squares(&self.ids, &squares, query);
        self.near = self.narrowed(&squares, found.largest, whitener);
        found
    }

    /// Lists the points that will probably matter in the next passes; `None` where they are not few.
    ///
    /// The ellipsoid is expected to change by at most (largest/d)², in |y|². That is a guess, on which no answer depends: of 10⁵ × 10
    /// normal points and points near an ellipsoid (example `ellipsoids`), lists by largest/d were too short for most passes, those by its
    /// square for few.
    fn narrowed(&self, squares: &[f64], largest: f64, whitener: &Whitener) -> Option<Box<Self>> {
        let dim = self.dim;
        let border = dim as f64;
        let is_moderate = border < largest && largest <= NARROWED_LARGEST_MAX * border;
        if !is_moderate || squares.len() < NARROWED_LIST_MIN {
            return None;
        }
        let above = border * (border / largest).powi(2);
        let count = squares.iter().filter(|&&square| square > above).count();
        if count as f64 > NEAR_SHARE_MAX * squares.len() as f64 {
            return None;
        }
        let mut ids = Vec::with_capacity(count);
        let mut rows = Vec::with_capacity(count * dim);
        let mut measured = self.ids.iter().zip(squares);
        for part in &self.rows {
            for (row, (&id, &square)) in part.chunks_exact(dim).zip(&mut measured) {
                if square > above {
                    ids.push(id);
                    rows.extend_from_slice(row);
                }
            }
        }
        let listed = Some((whitener.clone(), above));
        Some(Box::new(Shortlist { dim, ids, rows: vec![rows], listed, near: None }))
    }

    /// A bound on |y|² under this whitener of the points of the source, or of the longer list, that are not listed; `doubt` bounds the
    /// relative rounding of |y|² in a pass with either ellipsoid.
    pub(super) fn others(&self, whitener: &Whitener, doubt: f64) -> f64 {
        let Some((old, above)) = &self.listed else { return f64::INFINITY };
        let dim = self.dim;
        let (new, old_matrix) = (whitener.matrix(), old.matrix());
        let mut inverse = vec![0.0; dim * dim];
        (0..dim).for_each(|a| inverse[a * dim + a] = 1.0);
        divide_rows(old_matrix, dim, &mut inverse);
        // T = MM₀⁻¹, lower triangular.
        let mut t = vec![0.0; dim * dim];
        for a in 0..dim {
            for b in 0..=a {
                t[a * dim + b] = (b..=a).map(|k| new[a * dim + k] * inverse[k * dim + b]).sum();
            }
        }
        let mut square = vec![0.0; dim * dim];
        for a in 0..dim {
            for b in 0..dim {
                square[a * dim + b] = dot(&t[a * dim..(a + 1) * dim], &t[b * dim..(b + 1) * dim]);
            }
        }
        if !square.iter().all(|v| v.is_finite()) {
            return f64::INFINITY;
        }
        let (values, vectors) = eigen(&mut square, dim);
        let moved: Vec<f64> =
            old.center().iter().zip(whitener.center()).map(|(old, new)| old - new).collect();
        let shift: Vec<f64> = new.chunks_exact(dim).map(|row| dot(row, &moved)).collect();
        let along = vectors.chunks_exact(dim).map(|vector| dot(vector, &shift));
        let terms: Vec<(f64, f64)> = values.into_iter().zip(along).collect();
        reach2(&terms, *above) * (1.0 + 4.0 * doubt)
    }
}

/// Bounds |Tz + s|² for |z|² ≤ b, rounding included, from the eigenvalues of TT′ and s in the basis of its eigenvectors.
///
/// For any λ above the eigenvalues νᵢ it is at most λb + Σ sᵢ²λ/(λ − νᵢ), by duality. Several λ are tried: the best is rarely
/// needed. The square of the sum of the largest |Tz| and |s| is what the best λ gives where s points to where T stretches most or where it
/// stretches all alike; near the end both are so near to 1 and 0 that no λ of the list comes as near.
fn reach2(terms: &[(f64, f64)], b: f64) -> f64 {
    let largest = terms.iter().fold(0.0f64, |m, (value, _)| m.max(*value));
    let shift = terms.iter().map(|(_, s)| s * s).sum::<f64>().sqrt();
    let plain = (largest.sqrt() * b.sqrt() + shift).powi(2) * (1.0 + 1e-12);
    let bound = |lambda: f64| {
        let term = |(value, s): &(f64, f64)| s * s * lambda / (lambda - value);
        (lambda * b + terms.iter().map(term).sum::<f64>()) * (1.0 + 1e-9)
    };
    // Nearer to the largest eigenvalue rounding would be seen.
    (-32..8).map(|k| bound(largest * (1.0 + 2f64.powf(f64::from(k) / 4.0)))).fold(plain, f64::min)
}

/// Returns what share of n points a first list should hold so that it covers the end; `None` where a list saves nothing.
///
/// As many of k random points as determine an ellipsoid, p, lie on the border of theirs, and about p/k of all points
/// outside. The list has to hold several times as many.
pub(super) fn share(dim: usize, sample: &WorkingSet, n: u64) -> Option<f64> {
    /// The list has this many times the points that determine the ellipsoid. Of 65,536 and 300,000 points in 2 to 10 dimensions (normal,
    /// in a cube, in clusters, near a sphere; 1344 sets) it fell short for 2 %, which takes a second pass; with 6 for 11 %, with 9 for
    /// 1.6 %, with 12 for 0.4 %. But 10⁵ × 10 normal points take a tenth longer with 12.
    const LIST_FACTOR: f64 = 8.0;
    /// Beyond this share of all points, a pass over the list costs a good part of one over all.
    const LIST_SHARE_MAX: f64 = 1.0 / 6.0;
    let determine = (dim * (dim + 3) / 2) as f64;
    let share = LIST_FACTOR * determine / sample.len() as f64;
    (n >= 16 * sample.len() as u64 && share <= LIST_SHARE_MAX).then_some(share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ellipsoid::rounds::center_of;
    use crate::top::Far;
    use taut_points::{Distribution, Monitor, Points, generate};

    /// The bound is one, and is reached within a little where the maximum is known.
    #[test]
    fn reaches_are_bounded_closely() {
        let b = 2.0f64;
        // Along the longest axis the lengths add up; beside it the longest is found among many directions.
        let (long, short) = (1.5f64, 0.4f64);
        let most = (long * b.sqrt() + 0.3).powi(2);
        let bound = reach2(&[(long * long, 0.3), (short * short, 0.0)], b);
        assert!(bound >= most && bound <= 1.01 * most, "{bound} {most}");
        let length = |turn: f64| {
            let (x, y) = (turn.cos() * b.sqrt(), turn.sin() * b.sqrt());
            (long * x).powi(2) + (short * y + 0.8).powi(2)
        };
        let most = (0..100_000).map(|k| length(f64::from(k) * 1e-4)).fold(0.0, f64::max);
        let bound = reach2(&[(long * long, 0.0), (short * short, 0.8)], b);
        assert!(bound >= most && bound <= 1.01 * most, "{bound} {most}");
        assert!(bound < 0.8 * (long * b.sqrt() + 0.8).powi(2));
        // Near the end it has to tell points apart that differ by little.
        let bound = reach2(&[(1.0 + 1e-9, 1e-9), (1.0 - 1e-9, -1e-9)], b);
        assert!(bound >= b && bound <= b * (1.0 + 1e-8), "{bound}");
    }

    /// What is not listed stays within the bound under other ellipsoids, and the bound is not idle.
    #[test]
    fn points_that_are_not_listed_are_bounded() {
        for dim in [2, 3, 7] {
            let values: Vec<f64> = generate(Distribution::Normal, 20_000, dim, 4).unwrap();
            let points = Points::new(&values, dim).unwrap();
            let monitor = Monitor::silent();
            let mut reader = PointReader::new(&points, &monitor).unwrap();
            let sample = Sample::new(&reader).unwrap();
            let (whitener, _) = sample.whitener(&sample.extents());
            let center = center_of(&sample.origin, &whitener);
            let query = Query { matrix: whitener.matrix(), center: &center, above: 1e9, keep: 10 };
            let (mut list, _) =
                Shortlist::of_pass(&mut reader, query, &whitener, &sample, 0.05).unwrap();
            assert!((600..1700).contains(&list.ids.len()), "{}", list.ids.len());
            // Steps to single points change shape and center.
            let mut other = whitener.clone();
            for (step, beta) in [(3, 0.02), (500, 0.05), (4000, -0.0001)] {
                other.step(&values[step * dim..][..dim], beta);
                let center = center_of(&sample.origin, &other);
                let query =
                    Query { matrix: other.matrix(), center: &center, above: 0.0, keep: 20_000 };
                let found = reader.pass(query).unwrap();
                let ids = list.ids.clone();
                let free = |far: &&Far| ids.binary_search(&far.id).is_err();
                let reached = found.far.iter().find(free).unwrap().reach2;
                let bound = list.others(&other, 1e-12);
                assert!(reached <= bound && bound <= 2.5 * reached, "{reached} {bound}");
                let listed = list.pass(query, &other, 1e-12).far;
                let wanted: Vec<Far> = found.far.iter().filter(|far| !free(far)).copied().collect();
                assert_eq!(listed, wanted);
            }
        }
    }

    /// Passes over ever fewer points find what passes over all find, farthest points, largest square and threshold.
    #[test]
    fn nested_lists_miss_no_point_above_the_threshold() {
        for dim in [2, 5, 10] {
            let values: Vec<f64> = generate(Distribution::Normal, 20_000, dim, 9).unwrap();
            let points = Points::new(&values, dim).unwrap();
            let monitor = Monitor::silent();
            let mut reader = PointReader::new(&points, &monitor).unwrap();
            let sample = Sample::new(&reader).unwrap();
            let (mut whitener, _) = sample.whitener(&sample.extents());
            let mut list = Shortlist {
                dim,
                ids: (0..20_000).collect(),
                rows: values.chunks(dim * 6000).map(<[f64]>::to_vec).collect(),
                listed: None,
                near: None,
            };
            let (mut passes, mut near_passes) = (0, 0);
            for _ in 0..100 * dim {
                let center = center_of(&sample.origin, &whitener);
                let query = Query {
                    matrix: whitener.matrix(),
                    center: &center,
                    above: dim as f64 * (1.0 - 1e-9),
                    keep: 50,
                };
                // Without the rows of the longest list, only a shorter one can have the answer.
                let near = list.near.as_ref();
                let is_near = near.is_some_and(|near| near.others(&whitener, 1e-12) < query.above);
                let rows = if is_near { std::mem::take(&mut list.rows) } else { vec![] };
                let found = list.pass(query, &whitener, 1e-12);
                if is_near {
                    list.rows = rows;
                }
                passes += 1;
                near_passes += i32::from(is_near);
                let wanted = reader.pass(query).unwrap();
                assert_eq!(found.far, wanted.far);
                assert_eq!(found.largest, wanted.largest);
                assert_eq!(found.listed_above, wanted.listed_above);
                // Khachiyan's step to the farthest point.
                let (d, far) = (dim as f64, found.largest);
                let beta = (far - d) / ((d + 1.0) * far);
                let row: Vec<f64> = values[found.far[0].id as usize * dim..][..dim]
                    .iter()
                    .zip(&sample.origin)
                    .map(|(x, o)| x - o)
                    .collect();
                whitener.step(&row, beta);
            }
            assert!(10 * near_passes > 6 * passes, "{near_passes} of {passes}, dimension {dim}");
        }
    }
}
