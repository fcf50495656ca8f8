//! The options of centers.

use taut_certify::{Items, Placement};
use taut_points::{InputError, Monitor, check_threads, choice, shown_number};

use crate::{Error, StreamingOptions};

/// The way to look for centers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum CentersMethod {
    /// A tree over a small growing core-set, to any proved gap; for centers among the points, covers by their balls.
    #[default]
    Tree,
    /// The algorithm of the thesis (Algorithm 2), with a bound that is valid in place of its own: each item that is
    /// farthest from all balls is given to each of them in turn. Free centers of points or balls, without weights and outliers.
    Thesis,
    /// Farthest-first traversal (Gonzalez 1985): at most twice the optimal radius, in O(nkd) for any n and d. Balls, points
    /// with weights and sets with outliers are held in memory and gone through 2k + z + d times; with weights or outliers
    /// the factor is not promised, the gap that is proved is in the certificate.
    FarthestFirst,
    /// A [`StreamingCenters`](crate::StreamingCenters): two passes over a source of any size, by default in memory for some 8k points, at most 2.96
    /// times the optimal radius. Points without weights and outliers, and without assignment.
    Stream(StreamingOptions),
}

choice! { "method", CentersMethod {
    Tree = "tree", "a tree over a small growing core-set: the best";
    Thesis = "thesis", "Algorithm 2, with a bound that holds; free centers, no weights, no outliers";
    FarthestFirst = "farthest-first",
        "at most twice the least radius, whatever --epsilon says; for any k, fast";
    Stream(StreamingOptions::DEFAULT) = "stream",
        "at most 2.96 times the least radius, whatever --epsilon says; two passes over files of any size, which are \
         not held in memory; no balls, weights, outliers or assignment";
}}

/// Options to look for centers. Write `CentersOptions { epsilon: 1e-6, ..Default::default() }`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CentersOptions<'a> {
    /// The kind of the rows: points, balls or ellipsoids. Ellipsoids have free centers, the method [`CentersMethod::Tree`], and neither
    /// weights nor groups. Default [`Items::Points`].
    pub inputs: Items,
    /// Wanted relative gap, radius ≤ (1 + ε)·lower bound. Range [0, 1), default 0.01. Has no influence on
    /// [`CentersMethod::FarthestFirst`] and [`CentersMethod::Stream`].
    pub epsilon: f64,
    /// Default [`CentersMethod::Tree`].
    pub method: CentersMethod,
    /// Where centers may be. Default [`Placement::Free`].
    pub placement: Placement,
    /// Most items that may be left out, or groups of them. Default 0.
    pub outliers: u64,
    /// True if the last column holds weights w > 0: a point then counts with w times its distance. Default no.
    pub weights: bool,
    /// The column, from 0, whose value says to which group a row belongs: one ball is to hold all rows of a group, as it has to hold a
    /// polytope that is given by its vertices. The column is not a coordinate, radius or weight, and [`Self::outliers`] counts groups.
    /// Default `None`: each row stands for itself. Not for [`CentersMethod::Thesis`] and [`CentersMethod::Stream`].
    pub group: Option<usize>,
    /// Most nodes of the search; then the best centers so far are returned with their gap. A node with k clusters beside a
    /// core-set of m items in d dimensions counts once more for each 20,000 of kmd. A large tree of points in the plane is left for a search that
    /// records nogoods, each step of which counts as ten nodes. A search ends up to some hundred nodes
    /// before the last. Writing down the proof may take trees of twenty times the nodes of the search, and 10,000; where it
    /// takes more, the bound before is proved. Default 10 million.
    pub max_nodes: u64,
    /// True if the answer is to say which center each item has. Default no.
    pub assignment: bool,
    /// Threads, 1 to 1024; `None` for those of the surrounding pool. The answer does not depend on it.
    pub threads: Option<usize>,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for CentersOptions<'_> {
    fn default() -> Self {
        CentersOptions {
            inputs: Items::Points,
            epsilon: 0.01,
            method: CentersMethod::Tree,
            placement: Placement::Free,
            outliers: 0,
            weights: false,
            group: None,
            max_nodes: 10_000_000,
            assignment: false,
            threads: None,
            monitor: Monitor::silent(),
        }
    }
}

impl CentersOptions<'_> {
    pub(crate) fn check(&self, k: usize) -> Result<(), Error> {
        let wrong = |name, value: String, expected| {
            Err(Error::Input(InputError::Option { name, value, expected }))
        };
        if k == 0 {
            return wrong("k", "0".into(), "at least 1");
        }
        if !(0.0..1.0).contains(&self.epsilon) {
            return wrong("epsilon", shown_number(self.epsilon), "a number in [0, 1)");
        }
        if let Some(threads) = self.threads
            && let Err(refused) = check_threads(threads)
        {
            return wrong("threads", threads.to_string(), refused.expected);
        }
        if self.inputs == Items::Ellipsoids {
            if self.method != CentersMethod::Tree {
                let expected = "tree, the one method for ellipsoids";
                return wrong("method", self.method.to_string(), expected);
            }
            if self.placement == Placement::Rows {
                return wrong("placement", "rows".into(), "free for ellipsoids");
            }
            if self.weights {
                return wrong("weights", "true".into(), "false for ellipsoids");
            }
            if let Some(group) = self.group {
                return wrong("group", group.to_string(), "none for ellipsoids");
            }
        }
        if self.method == CentersMethod::Thesis {
            if self.placement == Placement::Rows {
                return wrong("placement", "rows".into(), "free for the method thesis");
            }
            if self.outliers > 0 {
                return wrong("outliers", self.outliers.to_string(), "0 for the method thesis");
            }
            if self.weights {
                return wrong("weights", "true".into(), "false for the method thesis");
            }
            if let Some(group) = self.group {
                return wrong("group", group.to_string(), "none for the method thesis");
            }
        }
        if let CentersMethod::Stream(_) = self.method {
            if self.inputs != Items::Points {
                return wrong("method", self.method.to_string(), "one of the others for balls");
            }
            if self.outliers > 0 {
                return wrong("outliers", self.outliers.to_string(), "0 for the method stream");
            }
            if self.weights {
                return wrong("weights", "true".into(), "false for the method stream");
            }
            if let Some(group) = self.group {
                return wrong("group", group.to_string(), "none for the method stream");
            }
            if self.assignment {
                return wrong("assignment", "true".into(), "false for the method stream");
            }
        }
        Ok(())
    }
}
