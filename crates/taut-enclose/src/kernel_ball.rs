//! The minimum enclosing ball in the feature space of a kernel, hard or soft.
//!
//! *Problem.* For points xₖ and a kernel K(x, y) = ⟨φ(x), φ(y)⟩ find the smallest ball around all φ(xₖ); or, for ν in (0, 1], the ball
//! of least R² + Σ max(0, |φ(xₖ) − c|² − R²)/(νn).
//! *Dual.* Over λ ≥ 0 with Σλ = 1, and λ ≤ 1/(νn) where it is soft, maximize D(λ) = ½ Σ λᵢλⱼρ(xᵢ, xⱼ), where ρ is the squared distance in
//! the feature space. Then c = Σ λᵢφ(xᵢ), and |φ(x) − c|² = Σ λᵢρ(x, xᵢ) − D.
//! *Idea.* Few λᵢ are not 0. Pairs of multipliers of a working set take steps to their optimum ([`pairs`]); a pass over all points looks
//! for those outside, most of which one distance to the mean of the support proves to be inside ([`screen`]), or what an earlier pass
//! found ([`distance_bounds`]); these come into the working set, until there are none.
//! *Guarantee.* The objective is at most (1 + ε) times its minimum: D is a lower bound, and a pass measures the objective.
//! *Cost.* O(nd) for each of three to seven passes where the kernel is wide, O(nkd) with a support of k where it is narrow or no Gaussian;
//! O(|W|) for each step on a working set W.
//! *Reference.* Tax and Duin, Support vector data description, Mach. Learn. 54, 2004; Tsang, Kwok and Cheung, Core vector machines,
//! JMLR 6, 2005; second-order pairs: Fan, Chen and Lin, JMLR 6, 2005. The screen is new here.

mod cluster;
mod decay;
mod distance_bounds;
mod features;
mod first;
mod pairs;
mod screen;
mod solve;
mod thesis;

use taut_certify::{Kernel, KernelBall, KernelBallViolation, Solution};
use taut_points::{InputError, Monitor, PointSource, choice, on_threads, shown_number};

use crate::Error;

/// The ways to find a ball of a kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum KernelBallMethod {
    /// Pairs of multipliers of a working set, and screened passes: the best, and the default.
    #[default]
    WorkingSet,
    /// Algorithm 11 of the thesis: a given number of steps to the farthest point, each over all points.
    Thesis,
}

choice! { "method", KernelBallMethod {
    WorkingSet = "working-set", "pairs of multipliers of a working set, and screened passes: the best";
    Thesis = "thesis", "Algorithm 11: a given number of steps to the farthest point";
}}

/// How to look for a ball of a kernel. Write `KernelBallOptions { nu: Some(0.01), ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct KernelBallOptions<'a> {
    /// The kernel. Default: Gaussian with γ = 1.
    pub kernel: Kernel,
    /// ν in (0, 1] for a soft ball, which leaves at most a share ν of the points outside. Default `None`: all are inside.
    pub nu: Option<f64>,
    /// Wanted relative gap of the objective, which is a squared radius. Range (0, 1), default 1e-6.
    pub epsilon: f64,
    /// The way to find it.
    pub method: KernelBallMethod,
    /// Steps of [`KernelBallMethod::Thesis`], at least 2. Default 100.
    pub steps: u64,
    /// Most passes over all points, by default 10,000; then the best ball so far is returned with its gap. At least 1, but the start of
    /// [`KernelBallMethod::WorkingSet`] takes two or three and that of [`KernelBallMethod::Thesis`] four in any case.
    pub max_passes: u64,
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. The answer does not depend on it.
    pub threads: Option<usize>,
    /// Chooses the sample from which the search starts, and the first point of the thesis. Default 0.
    pub seed: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for KernelBallOptions<'_> {
    fn default() -> Self {
        KernelBallOptions {
            kernel: Kernel::Gaussian { gamma: 1.0 },
            nu: None,
            epsilon: 1e-6,
            method: KernelBallMethod::default(),
            steps: 100,
            max_passes: 10_000,
            threads: None,
            seed: 0,
            monitor: Monitor::silent(),
        }
    }
}

/// Finds the minimum enclosing ball of points in the feature space of a kernel.
///
/// With ν it is a support vector data description: the ball that trades its squared radius for points outside. The certificate holds the
/// gap of the objective; that of the radius of a hard ball is half of it. A precomputed kernel is a source of n rows of n columns,
/// symmetric and positive semidefinite, which is not checked here; the checker refuses matrices that clearly are not.
///
/// ```
/// use taut_certify::Kernel;
/// use taut_enclose::{KernelBallOptions, kernel_ball};
///
/// let points = taut_points::Points::new(&[0.0, 1.0, 3.0], 1)?;
/// let options = KernelBallOptions { kernel: Kernel::Linear, ..Default::default() };
/// let found = kernel_ball(&points, &options)?;
/// assert_eq!(found.answer.support, [0, 2]);
/// assert!((found.answer.squared_radius - 2.25).abs() < 1e-5);
/// assert!(found.check(&points)?.gap <= 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Empty`]; [`Error::Overflow`] where distances are out of the range of numbers; [`Error::Input`] for bad points, options and
/// kernels, and for what reading says.
pub fn kernel_ball(
    source: &dyn PointSource,
    options: &KernelBallOptions<'_>,
) -> Result<Solution<KernelBall>, Error> {
    options.check(source)?;
    on_threads(options.threads, || match options.method {
        KernelBallMethod::WorkingSet => solve::solve(source, options),
        KernelBallMethod::Thesis => thesis::solve(source, options),
    })
}

impl KernelBallOptions<'_> {
    fn check(&self, source: &dyn PointSource) -> Result<(), Error> {
        let wrong = |name, value: String, expected| {
            Err(Error::Input(InputError::Option { name, value, expected }))
        };
        if source.is_empty() {
            return Err(Error::Empty);
        }
        if let Err(violation) = self.kernel.check(source.len(), source.dim()) {
            return match violation {
                KernelBallViolation::Parameter { name, value, expected } => {
                    wrong(name, shown_number(value), expected)
                }
                _ => {
                    let (dim, expected) =
                        (source.dim(), "the number of rows, as a precomputed kernel is square");
                    Err(InputError::Dimension { dim, expected }.into())
                }
            };
        }
        if !(self.epsilon > 0.0 && self.epsilon < 1.0) {
            return wrong("epsilon", shown_number(self.epsilon), "a number above 0 and below 1");
        }
        if let Some(nu) = self.nu
            && !(nu > 0.0 && nu <= 1.0)
        {
            return wrong("nu", shown_number(nu), "a number above 0, at most 1");
        }
        if self.method == KernelBallMethod::Thesis && self.nu.is_some() {
            return wrong("method", "thesis".to_owned(), "working-set for a soft ball");
        }
        if self.steps < 2 {
            return wrong("thesis_steps", self.steps.to_string(), "at least 2");
        }
        if self.max_passes == 0 {
            return wrong("max_passes", "0".to_owned(), "at least 1");
        }
        Ok(())
    }
}
