//! `taut ball --kernel`: the smallest ball in the feature space of a kernel.

use anyhow::bail;
use taut::certify::{Kernel, KernelBall, Stop};
use taut::enclose::{KernelBallMethod, KernelBallOptions, kernel_ball};
use taut::{BallMethod, Monitor, Solution};

use super::Args;
use crate::exit::Outcome;
use crate::input::reading::Opened;
use crate::output::tables::{self, TableFiles, Tables};
use crate::pipeline::{Find, Input, Output};
use crate::reports;
use crate::watch::Watch;

/// The names of the kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum KernelName {
    /// exp(−γ|x − y|²)
    Gaussian,
    /// (γ x·y + c)ᵖ
    Polynomial,
    /// x·y: the ball of the points themselves
    Linear,
    /// Row i of the file holds K(xᵢ, xⱼ) for all j
    Precomputed,
}

/// The options for balls in the feature space of a kernel.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Kernels")]
pub(super) struct KernelArgs {
    /// Find the ball in the feature space of a kernel
    #[arg(long, value_name = "NAME", conflicts_with_all = ["balls", "ellipsoids", "batch", "delta"])]
    kernel: Option<KernelName>,
    /// γ of a Gaussian or polynomial kernel, above 0 [default: 1]
    #[arg(long, value_name = "REAL", requires = "kernel", allow_negative_numbers = true)]
    gamma: Option<f64>,
    /// c of a polynomial kernel, at least 0 [default: 1]
    #[arg(long, value_name = "REAL", requires = "kernel", allow_negative_numbers = true)]
    offset: Option<f64>,
    /// p of a polynomial kernel, 1 to 16 [default: 2]
    #[arg(long, value_name = "N", requires = "kernel")]
    degree: Option<u32>,
    /// Find the soft ball, which leaves at most this share of the points outside, above 0 and at most 1
    #[arg(long, value_name = "REAL", requires = "kernel", allow_negative_numbers = true)]
    nu: Option<f64>,
    /// Take so many steps of Algorithm 11 of the thesis in place of the default method, at least 2, whatever the gap
    #[arg(long, value_name = "N", requires = "kernel", conflicts_with_all = ["nu", "epsilon"])]
    thesis_steps: Option<u64>,
}

/// The subcommand with a kernel.
pub(super) struct WithKernel<'a> {
    args: &'a Args,
    kernel: Kernel,
}

impl KernelArgs {
    /// The subcommand with the kernel that the options name, if they name one.
    pub(super) fn of<'a>(&self, args: &'a Args) -> anyhow::Result<Option<WithKernel<'a>>> {
        let Some(name) = self.kernel else { return Ok(None) };
        if args.method != BallMethod::default() {
            bail!(
                "option `--method` is for balls without --kernel: --thesis-steps takes the method of the thesis"
            );
        }
        let unused = match name {
            KernelName::Gaussian => {
                [("offset", self.offset.is_some()), ("degree", self.degree.is_some())].to_vec()
            }
            KernelName::Polynomial => vec![],
            _ => [
                ("gamma", self.gamma.is_some()),
                ("offset", self.offset.is_some()),
                ("degree", self.degree.is_some()),
            ]
            .to_vec(),
        };
        if let Some((option, _)) = unused.into_iter().find(|(_, is_given)| *is_given) {
            bail!("option `--{option}` is no parameter of this kernel");
        }
        let (gamma, offset) = (self.gamma.unwrap_or(1.0), self.offset.unwrap_or(1.0));
        let kernel = match name {
            KernelName::Gaussian => Kernel::Gaussian { gamma },
            KernelName::Polynomial => {
                Kernel::Polynomial { gamma, offset, degree: self.degree.unwrap_or(2) }
            }
            KernelName::Linear => Kernel::Linear,
            KernelName::Precomputed => Kernel::Precomputed,
        };
        Ok(Some(WithKernel { args, kernel }))
    }
}

impl WithKernel<'_> {
    fn options(&self) -> KernelBallOptions<'static> {
        let (args, base) = (self.args, KernelBallOptions::default());
        KernelBallOptions {
            kernel: self.kernel,
            nu: args.kernel.nu,
            epsilon: args.epsilon.unwrap_or(base.epsilon),
            method: match args.kernel.thesis_steps {
                Some(_) => KernelBallMethod::Thesis,
                None => KernelBallMethod::WorkingSet,
            },
            steps: args.kernel.thesis_steps.unwrap_or(base.steps),
            max_passes: args.max_passes.min(base.max_passes),
            seed: args.seed,
            ..base
        }
    }
}

impl Find for WithKernel<'_> {
    type Answer = KernelBall;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        self.args.input()
    }

    fn output(&self) -> Output<'_> {
        self.args.output()
    }

    fn solve(&self, points: &Opened, watch: &Watch) -> anyhow::Result<(Solution<KernelBall>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            kernel_ball(points.source(), &KernelBallOptions { monitor: *monitor, ..self.options() })
        };
        let found = watch.during("solving", solve).map_err(|error| points.explain(error))?;
        Ok((found, ()))
    }

    fn table_files(&self) -> Option<(&TableFiles, &'static [&'static str])> {
        Some((&self.args.tables, &["support"]))
    }

    fn tables(&self, found: &Solution<KernelBall>, points: &Opened) -> Tables {
        vec![("support", tables::rows(points, &found.answer.support))]
    }

    fn outcome(&self, found: &Solution<KernelBall>) -> Outcome {
        match self.args.kernel.thesis_steps {
            // So many steps were asked for, and no gap; a step takes a pass.
            Some(steps)
                if found.trace.iterations < steps && found.trace.stop == Stop::PassBudget =>
            {
                Outcome::StoppedEarly
            }
            Some(_) => Outcome::Done,
            None => {
                reports::outcome(found.trace.stop, found.certificate.gap, self.options().epsilon)
            }
        }
    }
}
