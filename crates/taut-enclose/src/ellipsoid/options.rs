//! Options to look for the ellipsoid.

use taut_certify::Items;
use taut_points::{InputError, Monitor, check_threads, choice, shown_number};

use crate::Error;

/// The ways to find the ellipsoid; all of them end in the same certificate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum EllipsoidMethod {
    /// Working sets of far points, and Newton's method on the dual of each: the best, and the default.
    #[default]
    Newton,
    /// Algorithm 3 of the thesis: at most 2d points of which the ellipsoid is no more than d²ᵈ times too small.
    ///
    /// It ends with its last pass, whatever ε is, so its trace says [`Stop::PassBudget`](taut_certify::Stop::PassBudget)
    /// unless the gap happens to be as small as wanted.
    ThesisInitial,
    /// Algorithm 4 of the thesis, Khachiyan's: weight moves to the farthest point, from equal weights on all points.
    ThesisKhachiyan,
    /// Algorithm 5 of the thesis, Kumar and Yıldırım's: the same steps from Algorithm 3, which leaves a small core-set.
    ThesisCoreSet,
    /// The same with steps away from near points, after Todd and Yıldırım.
    AwaySteps,
}

choice! { "method", EllipsoidMethod {
    Newton = "newton", "pools of far points, Newton's method on each: the best";
    ThesisInitial = "thesis-initial", "Algorithm 3: at most 2d points, no search; its gap may be large";
    ThesisKhachiyan = "thesis-khachiyan",
        "Algorithm 4: steps to the farthest point, from equal weights on all; needs ε > 0";
    ThesisCoreSet = "thesis-core-set",
        "Algorithm 5: the same steps from Algorithm 3, for a small core-set; needs ε > 0";
    AwaySteps = "away-steps", "the same with steps away from near points; needs ε > 0";
}}

/// Options to look for the ellipsoid. Write `EllipsoidOptions { epsilon: 1e-6, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct EllipsoidOptions<'a> {
    /// The kind of the rows: points, balls or ellipsoids. Default [`Items::Points`].
    pub inputs: Items,
    /// Wanted gap, log-volume ≤ optimum + ε; 0 asks for as little as rounding allows. Range [0, 1), default 1e-9.
    ///
    /// The volume is then at most e^ε times the smallest, each axis on average e^(ε/d) times. A bound η on the relative
    /// leverages, as the literature on optimal design has it, is a gap of about (d + 1)·η/2.
    pub epsilon: f64,
    /// The way to find it. Default [`EllipsoidMethod::Newton`].
    pub method: EllipsoidMethod,
    /// Most reads of all points; then the best ellipsoid so far is returned with its gap. At least 2. Default 1,000,000.
    /// Where points turn out to be flat, or so large or small that squares are no `f64`, a read or two more are made.
    pub max_passes: u64,
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. The answer does not depend on it.
    pub threads: Option<usize>,
    /// Chooses the directions of Algorithm 3. Default 0.
    pub seed: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for EllipsoidOptions<'_> {
    fn default() -> Self {
        EllipsoidOptions {
            inputs: Items::Points,
            epsilon: 1e-9,
            method: EllipsoidMethod::default(),
            max_passes: 1_000_000,
            threads: None,
            seed: 0,
            monitor: Monitor::silent(),
        }
    }
}

impl EllipsoidOptions<'_> {
    pub(crate) fn check(&self) -> Result<(), Error> {
        let wrong = |name, value: String, expected| {
            Err(Error::Input(InputError::Option { name, value, expected }))
        };
        if !(0.0..1.0).contains(&self.epsilon) {
            return wrong("epsilon", shown_number(self.epsilon), "a number in [0, 1)");
        }
        let exact = [EllipsoidMethod::Newton, EllipsoidMethod::ThesisInitial];
        if self.epsilon == 0.0 && !exact.contains(&self.method) {
            return wrong(
                "epsilon",
                "0".into(),
                "more than 0, as this method needs about d²/ε passes",
            );
        }
        if self.max_passes < 2 {
            return wrong(
                "max_passes",
                self.max_passes.to_string(),
                "at least 2: one to choose points, one to prove",
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
