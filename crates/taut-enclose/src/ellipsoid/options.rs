//! How to look for the ellipsoid.

use std::fmt;
use std::str::FromStr;

use taut_points::{InputError, check_threads, shown_number};

use crate::Error;

/// The ways to find the ellipsoid; all of them end in the same certificate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum EllipsoidMethod {
    /// Pools of far points, and Newton's method on the dual of each: the best, and the default.
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

impl EllipsoidMethod {
    /// All methods, the default first.
    pub const ALL: [EllipsoidMethod; 5] = [
        EllipsoidMethod::Newton,
        EllipsoidMethod::ThesisInitial,
        EllipsoidMethod::ThesisKhachiyan,
        EllipsoidMethod::ThesisCoreSet,
        EllipsoidMethod::AwaySteps,
    ];

    /// The name on the command line, in Python and in the trace.
    pub const fn name(self) -> &'static str {
        match self {
            EllipsoidMethod::Newton => "newton",
            EllipsoidMethod::ThesisInitial => "thesis-initial",
            EllipsoidMethod::ThesisKhachiyan => "thesis-khachiyan",
            EllipsoidMethod::ThesisCoreSet => "thesis-core-set",
            EllipsoidMethod::AwaySteps => "away-steps",
        }
    }
}

impl fmt::Display for EllipsoidMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for EllipsoidMethod {
    type Err = Error;
    fn from_str(name: &str) -> Result<Self, Error> {
        EllipsoidMethod::ALL.into_iter().find(|method| method.name() == name).ok_or_else(|| {
            Error::Input(InputError::Option {
                name: "method",
                value: name.to_owned(),
                expected: "newton, thesis-initial, thesis-khachiyan, thesis-core-set or away-steps",
            })
        })
    }
}

/// How to look for the ellipsoid. Write `EllipsoidOptions { epsilon: 1e-6, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct EllipsoidOptions {
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
}

impl Default for EllipsoidOptions {
    fn default() -> Self {
        EllipsoidOptions {
            epsilon: 1e-9,
            method: EllipsoidMethod::default(),
            max_passes: 1_000_000,
            threads: None,
            seed: 0,
        }
    }
}

impl EllipsoidOptions {
    pub(super) fn check(&self) -> Result<(), Error> {
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
