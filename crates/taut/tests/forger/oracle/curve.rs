//! The truth about curves: lists, edges that meet, the band, tours, and each figure of the evidence.
//!
//! *Exact.* Lists, whether edges meet, and whether a row is within the band, by whole numbers; tours by lengths to 2⁻¹⁰⁰ of
//! the extent, beside the shortest tour of few points, or a tour that is found here.
//! *Evidence.* The figures are computed again from their definitions, over all pairs of vertices and edges. φ may be told up
//! to a 64th too large, and figures are in doubles; within that a figure is true.

mod doubts;
mod evidence;
mod features;
mod lists;
mod outliers;
mod planar;
#[cfg(test)]
mod tests;
mod tour;

use taut::Solution;
use taut::certify::Curve;
use taut::certify::{CurveDoubt, CurveVerdict};
use taut::points::{Monitor, Points, PointsHash, hash_points};

use self::lists::{apart, projection};
use self::planar::{Point, is_within, segments_meet};
use self::tour::Tours;
use super::Truth;

/// The amount by which a figure of the certificate may fall short of the one found, as documented: φ is told up to a 64th.
const FIGURE_SLACK: f64 = 0.05;

/// All that is true of a point set of the plane, whatever the curve.
pub(crate) struct CurveOracle {
    rows: Vec<Point>,
    points_hash: PointsHash,
    tours: Tours,
}

/// The reason to stop a judgment: a lie, or something the oracle cannot tell.
enum Stop {
    Lie(String),
    Unknown(String),
}

type Judged = Result<(), Stop>;

/// The lie, unless `is_true`.
fn ensure(is_true: bool, lie: impl FnOnce() -> String) -> Judged {
    if is_true { Ok(()) } else { Err(Stop::Lie(lie())) }
}

impl CurveOracle {
    /// Prepares finite points of the plane.
    pub(crate) fn new(values: &[f64], columns: usize) -> Self {
        let points = Points::new(values, columns).expect("rows of equal length");
        let points_hash = hash_points(&points, &Monitor::silent()).expect("points in memory");
        let rows: Vec<Point> = values.chunks(columns).map(|row| [row[0], row[1]]).collect();
        let tours = Tours::of(&rows);
        CurveOracle { rows, points_hash, tours }
    }

    /// Tests whether every claim of an accepted answer and of its verdict is true.
    pub(crate) fn judge(&self, solution: &Solution<Curve>, verdict: &CurveVerdict) -> Truth {
        match self.examine(solution, verdict) {
            Ok(()) => Truth::True,
            Err(Stop::Lie(lie)) => Truth::False(lie),
            Err(Stop::Unknown(why)) => Truth::Undecided(why),
        }
    }

    fn examine(&self, solution: &Solution<Curve>, verdict: &CurveVerdict) -> Judged {
        let (curve, certificate) = (&solution.answer, &solution.certificate);
        ensure(certificate.points_hash == self.points_hash, || "the hash of other points".into())?;
        lists::check(curve, certificate, &self.rows)?;
        let edges = edges(curve);
        self.crossings(solution, verdict, &edges)?;
        self.band(solution, verdict, &edges)?;
        lists::places(curve, &self.rows, &edges)?;
        self.tours.judge(solution, verdict)?;
        ensure(verdict.certified == verdict.doubt.is_none(), || "certified, with a doubt".into())?;
        ensure(!certificate.certified || verdict.certified, || "certified by itself only".into())?;
        for (what, claim, found) in [
            ("sampling ratio", certificate.sampling_ratio, verdict.sampling_ratio),
            ("noise ratio", certificate.noise_ratio, verdict.noise_ratio),
        ] {
            let is_covered = claim == f64::MAX || found <= claim * (1.0 + FIGURE_SLACK);
            ensure(is_covered, || format!("the {what} {claim} is less than {found}"))?;
        }
        evidence::judge(solution, verdict, &edges, &self.rows)
    }

    /// Tests whether the edges meet is as told.
    fn crossings(
        &self,
        solution: &Solution<Curve>,
        verdict: &CurveVerdict,
        edges: &[Edge],
    ) -> Judged {
        let pairs = || {
            let all = edges.iter().enumerate();
            all.flat_map(|(k, one)| edges[k + 1..].iter().map(move |other| (one, other)))
        };
        let found = pairs().find(|(one, other)| have_more_in_common(one, other));
        ensure(verdict.is_simple == found.is_none(), || {
            format!("simple is told to be {}: {:?}", verdict.is_simple, found.map(|(a, b)| [a, b]))
        })?;
        ensure(verdict.is_simple || solution.certificate.tour.is_some(), || {
            "edges meet, and it is no tour".into()
        })?;
        if let Some(CurveDoubt::Crossing { curve, edge }) = verdict.doubt {
            let mut at_edge = pairs().filter(|(one, other)| {
                [one, other].iter().any(|one| (one.curve, one.number) == (curve, edge))
            });
            return ensure(at_edge.any(|(one, other)| have_more_in_common(one, other)), || {
                format!("edge {edge} of curve {curve} meets no other")
            });
        }
        Ok(())
    }

    /// No row but the outliers is farther off than either band told.
    fn band(&self, solution: &Solution<Curve>, verdict: &CurveVerdict, edges: &[Edge]) -> Judged {
        let outliers = &solution.answer.outliers;
        let rows = (0u64..).zip(&self.rows);
        for (row, &p) in rows.filter(|(row, _)| outliers.binary_search(row).is_err()) {
            // The nearest edge as doubles tell it comes first, and nearly always settles it.
            let distance = |edge: &&Edge| apart(p, edge.ends, projection(p, edge.ends));
            let by_distance =
                |one: &&Edge, other: &&Edge| distance(one).total_cmp(&distance(other));
            let nearest = edges.iter().min_by(by_distance);
            for band in [verdict.band, solution.certificate.band] {
                let mut edges = nearest.into_iter().chain(edges);
                let is_near = edges.any(|edge| is_within(p, edge.ends, band));
                ensure(is_near, || format!("row {row} is farther off than {band:e}"))?;
            }
        }
        Ok(())
    }
}

/// An edge of a curve; of a curve of one vertex, from there to there.
#[derive(Clone, Copy, Debug)]
struct Edge {
    curve: usize,
    /// The vertex it begins at, within the curve.
    number: usize,
    /// The vertices it has, within the curve.
    vertices: [usize; 2],
    ends: [Point; 2],
}

fn edges(curve: &Curve) -> Vec<Edge> {
    let mut edges = vec![];
    for (number, one) in curve.curves.iter().enumerate() {
        let count = one.vertices.len();
        let steps = if one.closed || count == 1 { count } else { count - 1 };
        edges.extend((0..steps).map(|k| {
            let vertices = [k, (k + 1) % count];
            Edge { curve: number, number: k, vertices, ends: vertices.map(|v| one.vertices[v]) }
        }));
    }
    edges
}

/// Returns true if two edges share a point that is not the one vertex they share as neighbors.
fn have_more_in_common(one: &Edge, other: &Edge) -> bool {
    let ([a, b], [c, d]) = (one.ends, other.ends);
    let are_neighbors =
        |i: usize, j: usize| one.curve == other.curve && one.vertices[i] == other.vertices[j];
    // Beyond the vertex they share, one has its end on the other, or they are apart.
    let folded = |tail: Point, shared: Point, head: Point| {
        segments_meet([tail, shared], [head, head]) || segments_meet([shared, head], [tail, tail])
    };
    match () {
        () if are_neighbors(1, 0) => folded(a, b, d),
        () if are_neighbors(0, 1) => folded(b, a, c),
        () => segments_meet([a, b], [c, d]),
    }
}
