//! What can be asked of centres.

use taut_certify::Placement;

/// How to look for centres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CentersMethod {
    /// A tree over a small growing core-set, to any proved gap; for centres among the points, covers by their balls.
    #[default]
    Tree,
    /// The algorithm of the thesis (Algorithm 2), with a bound that is valid in place of its own: each item that is
    /// farthest from all balls is given to each of them in turn. Free centres of points or balls, without weights and outliers.
    Thesis,
    /// Farthest-first traversal (Gonzalez 1985): at most twice the optimal radius, in O(nkd) for any n and d.
    FarthestFirst,
}

/// How to look for centres. Write `CentersOptions { epsilon: 1e-6, ..Default::default() }`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CentersOptions {
    /// Wanted relative gap, radius ≤ (1 + ε)·lower bound. Range [0, 1), default 0.01. Has no influence on
    /// [`CentersMethod::FarthestFirst`].
    pub epsilon: f64,
    /// Default [`CentersMethod::Tree`].
    pub method: CentersMethod,
    /// Where centres may be. Default [`Placement::Free`].
    pub placement: Placement,
    /// Most items that may be left out. Default 0.
    pub outliers: u64,
    /// Whether the last column holds weights w > 0: a point then counts with w times its distance. Default no.
    pub weights: bool,
    /// Most nodes of the search; then the best centres so far are returned with their gap. Default 10 million.
    pub max_nodes: u64,
    /// Whether the answer is to say which centre each item has. Default no.
    pub assignment: bool,
    /// Threads; `None` for those of the surrounding pool. The answer does not depend on it.
    pub threads: Option<usize>,
}

impl Default for CentersOptions {
    fn default() -> Self {
        CentersOptions {
            epsilon: 0.01,
            method: CentersMethod::Tree,
            placement: Placement::Free,
            outliers: 0,
            weights: false,
            max_nodes: 10_000_000,
            assignment: false,
            threads: None,
        }
    }
}
