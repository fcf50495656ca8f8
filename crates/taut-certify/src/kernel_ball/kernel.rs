//! Kernels by name and parameters.

use serde::{Deserialize, Serialize};

use super::KernelBallViolation;

/// A positive semidefinite kernel K(x, y) = ⟨φ(x), φ(y)⟩.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "name", try_from = "Parameters")]
#[non_exhaustive]
pub enum Kernel {
    /// exp(−γ|x − y|²), γ > 0.
    Gaussian {
        /// γ, in units of one over the squared unit of the coordinates.
        gamma: f64,
    },
    /// (γ x·y + c)ᵖ with γ > 0, c ≥ 0 and p from 1 to [`Kernel::DEGREE_MAX`].
    Polynomial {
        /// γ.
        gamma: f64,
        /// c.
        offset: f64,
        /// p.
        degree: u32,
    },
    /// x·y: the ball of the points themselves.
    Linear,
    /// Row i of the source holds K(xᵢ, xⱼ) for all j: an n × n matrix, symmetric and positive semidefinite.
    Precomputed,
}

/// A kernel as JSON has it. A tagged enum would let kernels without parameters have any.
#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a kernel: an object with name, and gamma, offset and degree where it has them"
)]
struct Parameters {
    name: String,
    gamma: Option<f64>,
    offset: Option<f64>,
    degree: Option<u32>,
}

impl TryFrom<Parameters> for Kernel {
    type Error = String;

    fn try_from(found: Parameters) -> Result<Self, String> {
        let Parameters { name, gamma, offset, degree } = found;
        match (name.as_str(), gamma, offset, degree) {
            ("gaussian", Some(gamma), None, None) => Ok(Kernel::Gaussian { gamma }),
            ("polynomial", Some(gamma), Some(offset), Some(degree)) => {
                Ok(Kernel::Polynomial { gamma, offset, degree })
            }
            ("linear", None, None, None) => Ok(Kernel::Linear),
            ("precomputed", None, None, None) => Ok(Kernel::Precomputed),
            _ => Err(format!(
                "{name:?} with these parameters is no kernel: expected \"gaussian\" with gamma, \"polynomial\" with gamma, offset and \
                 degree, or \"linear\" or \"precomputed\" alone"
            )),
        }
    }
}

impl Kernel {
    /// The largest degree of a polynomial kernel.
    pub const DEGREE_MAX: u32 = 16;

    /// The name of the kernel, as in JSON.
    pub fn name(&self) -> &'static str {
        match self {
            Kernel::Gaussian { .. } => "gaussian",
            Kernel::Polynomial { .. } => "polynomial",
            Kernel::Linear => "linear",
            Kernel::Precomputed => "precomputed",
        }
    }

    /// Checks the parameters, and that `dim` columns of `rows` rows are what the kernel asks for.
    ///
    /// # Errors
    /// [`KernelBallViolation::Parameter`], [`KernelBallViolation::NotSquare`].
    pub fn check(&self, rows: u64, dim: usize) -> Result<(), KernelBallViolation> {
        let wrong =
            |name, value, expected| Err(KernelBallViolation::Parameter { name, value, expected });
        match *self {
            Kernel::Gaussian { gamma } | Kernel::Polynomial { gamma, .. }
                if !(gamma > 0.0 && gamma.is_finite()) =>
            {
                wrong("gamma", gamma, "a finite number above 0")
            }
            Kernel::Polynomial { offset, .. } if !(offset >= 0.0 && offset.is_finite()) => {
                wrong("offset", offset, "a finite number, at least 0")
            }
            Kernel::Polynomial { degree, .. } if !(1..=Self::DEGREE_MAX).contains(&degree) => {
                wrong("degree", f64::from(degree), "a whole number from 1 to 16")
            }
            Kernel::Precomputed if dim as u64 != rows => {
                Err(KernelBallViolation::NotSquare { rows, columns: dim })
            }
            _ => Ok(()),
        }
    }
}
