//! The violations of centers.

/// Why centers or their certificate are wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CentersViolation {
    /// There are no items.
    #[error("there are no rows: centers need at least one")]
    Empty,
    /// The certificate says of ellipsoids what cannot be.
    #[error("the items are said to be ellipsoids, {problem}")]
    Ellipsoids {
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// A point of an ellipsoid of the core-set is beyond the largest number, seen from the first center.
    #[error("ellipsoid {row} of the core-set is too far from the first center to be measured")]
    TooFar {
        /// The row, from 0.
        row: u64,
    },
    /// The certificate speaks of balls with weights.
    #[error("the items are said to be balls with weights: points alone can have weights")]
    WeightsOfBalls,
    /// The certificate speaks of groups, but the rows have no room for them.
    #[error(
        "column {column} is said to hold the group of a row, but rows have {columns}, of which one at least is a coordinate"
    )]
    GroupColumn {
        /// The column named, from 0.
        column: u64,
        /// Columns there are.
        columns: usize,
    },
    /// Rows of one group are treated in different ways.
    #[error("point {row} is of the same group as point {first}, {problem}")]
    GroupSplit {
        /// The row, from 0.
        row: u64,
        /// The first row of its group.
        first: u64,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// A group that counts lies in none of the balls.
    #[error(
        "no ball of radius {radius:?} holds all points of group {group:?}, that of point {row}"
    )]
    GroupOutside {
        /// The first row of the group, from 0.
        row: u64,
        /// Its value in the column of groups.
        group: f64,
        /// The claimed radius.
        radius: f64,
    },
    /// The certificate speaks of weights, but the rows have no room for them.
    #[error("a point with a weight needs two columns or more, but rows have {columns}")]
    NoWeight {
        /// Columns there are.
        columns: usize,
    },
    /// A weight of the input is not positive.
    #[error("point {row} has weight {value:?}: weights are the last column and must be above 0")]
    Weight {
        /// Point, from 0.
        row: u64,
        /// Its weight.
        value: f64,
    },
    /// There are no centers, or more than were asked for.
    #[error("there are {found} centers: expected at least 1 and at most k = {k}")]
    Count {
        /// Centers there are.
        found: usize,
        /// Most centers.
        k: u64,
    },
    /// A center has another dimension than the points.
    #[error("center {center} has {found} coordinates, but the points have dimension {expected}")]
    Dimension {
        /// Center, from 0.
        center: usize,
        /// Its coordinates.
        found: usize,
        /// Dimension of the points.
        expected: usize,
    },
    /// A center is not the row it is said to be.
    #[error("center {center} is said to be point {row}, {problem}")]
    Row {
        /// Center, from 0.
        center: usize,
        /// The row it is said to be.
        row: u64,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// More rows are left out than may be.
    #[error("{found} are left out, but at most {most} may be")]
    Outliers {
        /// Rows left out, or groups of them.
        found: usize,
        /// Most that may be.
        most: u64,
    },
    /// The lower bound is larger than the radius.
    #[error("the lower bound {lower:?} is larger than the radius {radius:?}")]
    Order {
        /// The lower bound.
        lower: f64,
        /// The radius.
        radius: f64,
    },
    /// The gap between the bounds is larger than the gap claimed.
    #[error("the bounds are {found:e} apart, relatively; the certificate claims {claimed:e}")]
    Gap {
        /// The value that the certificate claims.
        claimed: f64,
        /// `radius / lower_bound − 1`, rounded up.
        found: f64,
    },
    /// An item that counts lies in none of the balls.
    #[error(
        "point {row} reaches {distance:?} from center {center}, the next, outside the radius {radius:?} by {excess:e}"
    )]
    Outside {
        /// The first such row, from 0.
        row: u64,
        /// The center next to it, from 0.
        center: usize,
        /// The distance that it reaches from there.
        distance: f64,
        /// The claimed radius.
        radius: f64,
        /// distance − radius.
        excess: f64,
    },
    /// An item is assigned to a center that does not exist.
    #[error("point {row} is assigned to center {center}, but there are not so many")]
    NoSuchCenter {
        /// The first such row, from 0.
        row: u64,
        /// The center named.
        center: u32,
    },
    /// An item is assigned to a center that is not the nearest.
    #[error("point {row} is assigned to center {center}, but center {nearer} is nearer to it")]
    Assignment {
        /// The first such row, from 0.
        row: u64,
        /// The center named.
        center: u32,
        /// One that is nearer.
        nearer: usize,
    },
    /// The core-set names a row that does not exist, or one twice.
    #[error("entry {position} of the core-set names point {row}, {problem}")]
    CoreSet {
        /// Position in the list, from 0.
        position: usize,
        /// The row it names.
        row: u64,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// The core-set is larger than a proof of its kind may have.
    #[error("the core-set has {rows} rows, but a proof by {proof} is taken of at most {most}")]
    CoreSetSize {
        /// Rows of the core-set.
        rows: usize,
        /// Most there may be.
        most: usize,
        /// The kind of proof.
        proof: &'static str,
    },
    /// The core-set has too few rows to prove anything.
    #[error(
        "the core-set has {rows} rows: k balls and {outliers} rows left out make do for k + {outliers}"
    )]
    TooFew {
        /// Rows of the core-set.
        rows: usize,
        /// Most rows that may be left out.
        outliers: u64,
    },
    /// Two rows of the core-set fit in one ball.
    #[error(
        "rows {first} and {second} are said to be apart, but one ball of a radius less than the lower bound holds both"
    )]
    NotApart {
        /// One row.
        first: u64,
        /// The other.
        second: u64,
    },
    /// An entry of the log of branches cannot be.
    #[error("branch {entry} gives item {item} of the core-set, {problem}")]
    Branch {
        /// Position in the log, from 0.
        entry: usize,
        /// The item it gives.
        item: u32,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// The log of branches ends where a node is neither refuted nor branched on.
    #[error("the log ends after {branches} branches, before all cases are refuted")]
    LogEnds {
        /// Branches there are.
        branches: usize,
    },
    /// The log of branches goes on where all cases are refuted.
    #[error("all cases are refuted after {used} branches, but the log has {branches}")]
    LogGoesOn {
        /// Branches that were needed.
        used: usize,
        /// Branches there are.
        branches: usize,
    },
    /// A node of the log is not refuted by the items left out.
    #[error("after {at} branches, cluster {cluster} is said to hold an item left out, {problem}")]
    HeldOut {
        /// Branches before the node.
        at: u64,
        /// The cluster.
        cluster: u32,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// A proof by nogoods is not to be had for such a question.
    #[error("nogoods prove nothing of this question: {problem}")]
    NogoodsApply {
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// A nogood of the log is not shown.
    #[error("nogood {number} of the log {problem}")]
    Nogood {
        /// Nogoods before it.
        number: usize,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// To go back in the log of branches takes too much memory.
    #[error("to come back from {branches} branches of the log takes more than {most} bytes")]
    Kept {
        /// Branches that are open.
        branches: usize,
        /// Bytes that are granted.
        most: u64,
    },
    /// The places that centers among the rows can take are too many to be held.
    #[error(
        "centers among the rows cannot be judged by so large a core-set: what each row is near to takes more than {most} bytes"
    )]
    Memory {
        /// The largest value that is accepted.
        most: u64,
    },
}
