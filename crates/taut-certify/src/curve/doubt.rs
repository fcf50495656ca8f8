//! Why a curve is not certified.

use serde::{Serialize, Serializer};

/// The first reason not to call a curve homeomorphic to the one that was sampled, and where.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveDoubt {
    /// There are no curves.
    #[error("there are no curves")]
    Empty,
    /// Two edges of a tour meet.
    #[error("curve {curve} meets itself at edge {edge}")]
    Crossing {
        /// Curve, from 0.
        curve: usize,
        /// The edge after this vertex, from 0.
        edge: usize,
    },
    /// A curve has ends, and an end may be a gap.
    #[error("curve {curve} has ends, which may be those of a gap")]
    Open {
        /// Curve, from 0.
        curve: usize,
    },
    /// A curve has too few rows to tell anything.
    #[error("curve {curve} has {rows} rows, fewer than {least}")]
    Few {
        /// Curve, from 0.
        curve: usize,
        /// Rows that are not outliers and nearest to it.
        rows: usize,
        /// Fewest that would do.
        least: usize,
    },
    /// A curve turns too sharply: at a vertex if vertices are rows, else within a few bands of one.
    #[error("curve {curve} turns by {degrees:.0} degrees around vertex {vertex}")]
    Corner {
        /// Curve, from 0.
        curve: usize,
        /// Vertex, from 0.
        vertex: usize,
        /// How much.
        degrees: f64,
    },
    /// Samples are too far apart beside the features of the curve.
    #[error(
        "half the gap between samples of curve {curve}, after vertex {vertex}, is {ratio:.3} of the feature size there; at most {most} would do"
    )]
    Sparse {
        /// Curve, from 0.
        curve: usize,
        /// The vertex before the gap begins, from 0.
        vertex: usize,
        /// Half the gap over φ.
        ratio: f64,
        /// The most that would do.
        most: f64,
    },
    /// A gap is much longer than those beside it.
    #[error(
        "a gap between samples of curve {curve}, after vertex {vertex}, is {times:.0} times as long as those beside it"
    )]
    Lacuna {
        /// Curve, from 0.
        curve: usize,
        /// The vertex before the gap begins, from 0.
        vertex: usize,
        /// Length of the gap over the mean of those beside it.
        times: f64,
    },
    /// A stretch has far fewer rows than those beside it.
    #[error(
        "{rows} rows lie along a stretch of curve {curve}, after vertex {vertex}, where {expected:.0} would if it were sampled as what is beside it"
    )]
    Vacant {
        /// Curve, from 0.
        curve: usize,
        /// The vertex before the stretch begins, from 0.
        vertex: usize,
        /// Rows within it.
        rows: usize,
        /// How many there would be.
        expected: f64,
    },
    /// Noise is too large beside the features of the curve.
    #[error(
        "row {row} lies {ratio:.3} of the feature size off curve {curve}; at most {most} would do"
    )]
    Noisy {
        /// Row, from 0.
        row: u64,
        /// Curve, from 0.
        curve: usize,
        /// Distance over φ.
        ratio: f64,
        /// The most that would do.
        most: f64,
    },
    /// Rows lie in two or more bands beside each other, as the samples of two curves would.
    #[error(
        "the rows beside curve {curve}, after vertex {vertex}, lie in bands: between them they are {share:.2} times as dense"
    )]
    Split {
        /// Curve, from 0.
        curve: usize,
        /// The vertex after which they lie, from 0.
        vertex: usize,
        /// How dense they are between two bands, over the sparser of those.
        share: f64,
    },
    /// Rows lie off the curve to the side their neighbors lie on, as samples of a curve that winds about it would.
    #[error(
        "the rows beside curve {curve}, after vertex {vertex}, follow each other about it: differences of neighbors make {share:.2} of what chance would"
    )]
    Winding {
        /// Curve, from 0.
        curve: usize,
        /// The vertex after which they lie, from 0.
        vertex: usize,
        /// Mean squared difference of neighbors over twice the variance.
        share: f64,
    },
    /// A stretch is wider and denser than what is beside it, as one would be along which the curve runs forth, back and forth again.
    #[error(
        "the rows beside curve {curve}, after vertex {vertex}, lie {wider:.1} times as far off and {denser:.1} times as densely as on both sides, as those of a fold would"
    )]
    Swollen {
        /// Curve, from 0.
        curve: usize,
        /// The vertex after which they lie, from 0.
        vertex: usize,
        /// Root mean square of their distance, over that beside them.
        wider: f64,
        /// Their density along the curve, over that beside them.
        denser: f64,
    },
    /// Rows lie much farther off the curve in one place than they usually do.
    #[error(
        "the rows beside curve {curve}, after vertex {vertex}, lie {times:.1} times as far off as rows of it usually do"
    )]
    Wide {
        /// Curve, from 0.
        curve: usize,
        /// The vertex after which they lie, from 0.
        vertex: usize,
        /// Distance that four fifths of them do not exceed, over the median of that along the curve.
        times: f64,
    },
    /// Too few outliers to tell whether they are a small curve.
    #[error("{outliers} outliers are too few to tell them from the samples of a small curve")]
    Handful {
        /// How many.
        outliers: u64,
    },
    /// Too many rows are said to be outliers.
    #[error("{outliers} of {rows} rows are outliers")]
    Outliers {
        /// Outliers.
        outliers: u64,
        /// Rows there are.
        rows: u64,
    },
    /// Too many outliers are as near to the curve as other rows.
    #[error("{outliers} outliers are no farther from the curves than other rows")]
    Inside {
        /// How many.
        outliers: u64,
    },
    /// Outliers lie just beside the band of other rows, more of them than chance puts there.
    #[error(
        "{outliers} outliers lie just beside the band of other rows, more than chance puts there"
    )]
    Beside {
        /// How many.
        outliers: u64,
    },
    /// Outliers lie nearer to each other than chance would put them.
    #[error(
        "{rows} outliers, row {row} among them, lie nearer to each other than chance would put them: {near:.2} of that on average"
    )]
    Gathered {
        /// One of those that have the most others around them.
        row: u64,
        /// How many outliers there are.
        rows: usize,
        /// Their mean distance from the next, over what chance makes it.
        near: f64,
    },
    /// Outliers lie along one arc, as the samples of a sparse curve among them would.
    #[error(
        "{rows} outliers around row {row} lie along one arc, where chance puts {expected:.1} of them"
    )]
    Arc {
        /// The one in the middle.
        row: u64,
        /// How many.
        rows: usize,
        /// How many chance puts there, of those around that one.
        expected: f64,
    },
    /// The answer is a tour: it passes all points, from whatever curves they are.
    #[error("a tour passes all points, of whatever curves they are")]
    Tour,
    /// Outliers lie as near to each other as samples of a curve.
    #[error(
        "{rows} outliers, row {row} among them, lie as near to each other as the samples of a curve"
    )]
    Cluster {
        /// The first of them.
        row: u64,
        /// How many.
        rows: usize,
    },
}

/// As its sentence.
impl Serialize for CurveDoubt {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
