//! Options to look for the ball.

use taut_certify::Items;
use taut_points::{InputError, Monitor, check_threads, choice, shown_number};

use crate::Error;

/// The ways to find the ball; all of them end in the same certificate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BallMethod {
    /// Batches of far points and an exact active set over their Gram matrix: the best, and the default.
    #[default]
    CoreSet,
    /// Algorithm 1 of the thesis: one far point per pass, a conic solver on the core-set.
    ThesisPure,
    /// The thesis' fast variant: d/3 steps of Algorithm 10, then Algorithm 1 from the far points these met.
    ThesisFast,
    /// Algorithm 10 of the thesis: steps of Bădoiu and Clarkson to the farthest point, and nothing else.
    BadoiuClarkson,
}

choice! { "method", BallMethod {
    CoreSet = "core-set", "batches of far points, exact on the core-set: the best";
    ThesisPure = "thesis-pure", "Algorithm 1: one far point per pass, a conic solver on the core-set";
    ThesisFast = "thesis-fast", "d/3 steps of Bădoiu and Clarkson, then Algorithm 1";
    BadoiuClarkson = "badoiu-clarkson", "Algorithm 10: steps to the farthest point; needs ε > 0";
}}

/// Options to look for the ball. Write `BallOptions { epsilon: 1e-6, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct BallOptions<'a> {
    /// The kind of the rows: points, balls or ellipsoids. Default [`Items::Points`].
    pub inputs: Items,
    /// Wanted relative gap, R ≤ (1 + ε)·R*; 0 asks for the exact ball, to rounding. Range [0, 1), default 1e-9.
    pub epsilon: f64,
    /// The way to find it. Default [`BallMethod::CoreSet`].
    pub method: BallMethod,
    /// Far points taken to the core-set per pass, by [`BallMethod::CoreSet`]; `None` chooses by dimension. At least 1.
    pub batch: Option<usize>,
    /// Relative accuracy δ to which the conic solver is asked for the ball of a core-set, by [`BallMethod::ThesisPure`] and
    /// [`BallMethod::ThesisFast`], which take a finer one where it turns out to be too coarse; with other methods it is an error.
    /// Range (0, 1); `None` is ε², as in the experiments of the thesis (2.4).
    pub delta: Option<f64>,
    /// Most reads of all points; then the best ball so far is returned with its gap. At least 3, and 4 for the methods
    /// of the thesis, which read thrice before their first ball. Default 1,000,000.
    /// A read or two more are made where nothing could be said of the radius otherwise, and one where all rows that a read left out, as they
    /// are known to be near, have to be read after all.
    pub max_passes: u64,
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. The answer does not depend on it.
    pub threads: Option<usize>,
    /// Chooses the point from which the thesis' methods start. Default 0.
    pub seed: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for BallOptions<'_> {
    fn default() -> Self {
        BallOptions {
            inputs: Items::Points,
            epsilon: 1e-9,
            method: BallMethod::default(),
            batch: None,
            delta: None,
            max_passes: 1_000_000,
            threads: None,
            seed: 0,
            monitor: Monitor::silent(),
        }
    }
}

impl BallOptions<'_> {
    pub(crate) fn check(&self) -> Result<(), Error> {
        let wrong = |name, value: String, expected| {
            Err(Error::Input(InputError::Option { name, value, expected }))
        };
        if !(0.0..1.0).contains(&self.epsilon) {
            return wrong("epsilon", shown_number(self.epsilon), "a number in [0, 1)");
        }
        if self.epsilon == 0.0 && self.method == BallMethod::BadoiuClarkson {
            return wrong(
                "epsilon",
                "0".into(),
                "more than 0, as badoiu-clarkson needs about 1/ε² passes",
            );
        }
        if self.batch == Some(0) {
            return wrong("batch", "0".into(), "at least 1");
        }
        if let Some(delta) = self.delta {
            if !(delta > 0.0 && delta < 1.0) {
                return wrong("delta", shown_number(delta), "a number in (0, 1)");
            }
            if !matches!(self.method, BallMethod::ThesisPure | BallMethod::ThesisFast) {
                let expected = "none but for the methods thesis-pure and thesis-fast";
                return wrong("delta", shown_number(delta), expected);
            }
        }
        if self.max_passes < 3 {
            return wrong(
                "max_passes",
                self.max_passes.to_string(),
                "at least 3: two to find a diameter, one to prove",
            );
        }
        if self.max_passes < 4 && self.method != BallMethod::CoreSet {
            return wrong(
                "max_passes",
                self.max_passes.to_string(),
                "at least 4 for the methods of the thesis, which read thrice before their first ball",
            );
        }
        if let Some(threads) = self.threads
            && let Err(refused) = check_threads(threads)
        {
            return wrong("threads", threads.to_string(), refused.expected);
        }
        Ok(())
    }
}
