//! The state that a kernel carries from call to call: what it knows of its coordinates, and what its calls took.

use std::ops::AddAssign;

/// The numbers of calls decided at each stage. Each call counts once in one of the first five.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stages {
    /// By a floating-point filter. A kernel that calls the filters itself may add its own count here; the
    /// functions of this crate that take an [`Exact`] begin after the filter and leave it alone.
    pub filter: u64,
    /// By `f64` arithmetic that was exact, as all coordinates are integers and close together.
    pub integer: u64,
    /// In integers of fixed width.
    pub wide: u64,
    /// In double-double arithmetic, where magnitudes are too mixed for that.
    pub double_double: u64,
    /// In integers of any length.
    pub unbounded: u64,
    /// Of all these, the calls of `conflict_exact` whose determinant is zero: the perturbation decided.
    pub ties: u64,
}

impl Stages {
    /// All calls that were decided, at whatever stage.
    #[must_use]
    pub fn calls(&self) -> u64 {
        self.filter + self.integer + self.double_double + self.wide + self.unbounded
    }
}

impl AddAssign for Stages {
    fn add_assign(&mut self, other: Stages) {
        self.filter += other.filter;
        self.integer += other.integer;
        self.double_double += other.double_double;
        self.wide += other.wide;
        self.unbounded += other.unbounded;
        self.ties += other.ties;
    }
}

/// The knowledge of the exact stages about the input, and what they count.
///
/// *Trap.* A ghost with NaN for coordinates makes every filter answer "uncertain", but it has no exact sign: a kernel
/// tells ghosts apart before it calls an exact function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exact {
    /// A promise: every coordinate that is ever passed beside this is a whole number. Then the stage of
    /// exact `f64` arithmetic is tried first, which makes grids cheap. A broken promise gives wrong signs.
    pub integral: bool,
    /// The counters, for the caller to read and to clear.
    pub stages: Stages,
}

impl Exact {
    /// Nothing counted yet; `integral` if every coordinate to come is a whole number.
    #[must_use]
    pub fn new(integral: bool) -> Exact {
        Exact { integral, stages: Stages::default() }
    }
}
