//! Defines how a triangulation is built. Nothing here changes which simplices it has.

use taut_points::{Monitor, choice};

/// Options to build a triangulation; [`Default`] is what most people want.
#[derive(Clone, Debug, PartialEq)]
pub struct DelaunayOptions<'a> {
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. At most 255 insert at once. The answer does not depend on it.
    pub threads: Option<usize>,
    /// In which order sites are inserted; by one thread in the orders without rounds. The answer does not depend on it.
    pub order: InsertionOrder,
    /// Seeds the random orders; the others do without.
    pub seed: u64,
    /// The least number of sites of a round for each thread that takes part in it, at least 1; `None` takes 1500 in space and 4000
    /// in the plane. The answer does not depend on it.
    pub sites_per_thread: Option<usize>,
    /// True if vector instructions are used where the machine has them. The answer does not depend on it.
    pub vectors: bool,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for DelaunayOptions<'_> {
    fn default() -> Self {
        Self {
            threads: None,
            order: InsertionOrder::Strided,
            seed: 0,
            sites_per_thread: None,
            vectors: true,
            monitor: Monitor::silent(),
        }
    }
}

/// In which order sites are inserted. All but [`Hilbert`](Self::Hilbert) begin with few sites all over the set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum InsertionOrder {
    /// Rounds of every 8ᵏ-th site along the Hilbert curve, each round in the order of the curve.
    #[default]
    Strided,
    /// Rounds of randomly chosen sites, each eight times the last, each in the order of the curve: the biased randomized
    /// insertion order of Amenta, Choi and Rote (2003). Expected optimal for any input.
    Random,
    /// Local RIC: a random order cut in blocks of growing size; the points of a block are located first and then
    /// inserted simplex by simplex, within one in random order (the thesis, section 6.3.1).
    LocalRic,
    /// Along the Hilbert curve in a single round. Fast on well-spread points, quadratic on the worst.
    Hilbert,
}

choice! { "order", InsertionOrder {
    Strided = "strided", "rounds of every 8ᵏ-th point along the Hilbert curve: the best";
    Random = "random", "rounds of random points, each eight times the last (BRIO)";
    LocalRic = "local-ric", "random within blocks of growing size, simplex by simplex";
    Hilbert = "hilbert", "along the Hilbert curve, in one round";
}}
