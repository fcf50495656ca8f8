//! The minimum enclosing ball in the feature space of a kernel, and its certificate.

mod center;
mod check;
mod distance;
mod jensen;
mod kernel;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError};

pub use center::KernelCenter;
pub use kernel::Kernel;
pub use violation::KernelBallViolation;

/// A ball in the feature space of a kernel: its center is Σ λᵢφ(xᵢ) over few rows xᵢ.
///
/// The squared distance of a point x from the center is Σ λᵢρ(x, xᵢ) − D with ρ(x, y) = K(x, x) + K(y, y) − 2K(x, y) and
/// D = ½ Σ λᵢλⱼρ(xᵢ, xⱼ).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a ball of a kernel: an object with kernel, nu, support, multipliers and squared_radius"
)]
pub struct KernelBall {
    /// The kernel.
    pub kernel: Kernel,
    /// ν in (0, 1] of a soft ball, which minimizes R² + Σ max(0, |φ(x) − c|² − R²)/(νn) over the n points x: at most a share ν of them is
    /// outside. None for the smallest ball around all.
    pub nu: Option<f64>,
    /// Row numbers of the xᵢ, from 0, ascending.
    pub support: Vec<u64>,
    /// λᵢ > 0, in the order of `support`. They sum to 1 but for rounding, and are taken divided by their sum.
    pub multipliers: Vec<f64>,
    /// R².
    pub squared_radius: f64,
}

/// What proves a ball of a kernel: the multipliers of the answer prove a lower bound, and only the gap is claimed beside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of a ball of a kernel: an object with gap and points_hash"
)]
pub struct KernelBallCertificate {
    /// The gap claimed: the objective is at most (1 + gap) times its minimum. The objective is R² where all points are inside, and
    /// that of [`KernelBall::nu`] otherwise. Accepted when the gap found is at most gap·(1 + 1e-9) + 4e-16.
    pub gap: f64,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// The proved facts about a ball of a kernel.
///
/// They hold for kernels that are positive semidefinite. Gaussian, polynomial and linear ones are; that a precomputed matrix is, the
/// checker takes as given.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct KernelBallVerdict {
    /// No ball has a smaller objective.
    pub lower: f64,
    /// The objective of the answer is at most this.
    pub upper: f64,
    /// `upper / lower − 1`, rounded up; 0 where both are 0.
    pub gap: f64,
    /// Points that are outside, of those for which rounding leaves no doubt; 0 for a ball around all.
    pub outside: u64,
}

impl Answer for KernelBall {
    type Certificate = KernelBallCertificate;
    type Verdict = KernelBallVerdict;
    const KIND: &'static str = "kernel-ball";

    fn check(
        &self,
        certificate: &KernelBallCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<KernelBallVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
