//! The width of a Gaussian kernel, under each of the conventions in use, and what tells a bad one.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use taut_points::{InputError, shown_number};

use super::covariance::{total_variance, within_variance};
use super::data::Rows;
use crate::Error;

/// Rows for which the nearest neighbor is looked for, at most.
const LOOKED_AT_ROWS_MAX: usize = 512;

/// The width of a Gaussian kernel exp(−γ|x − y|²), named by its convention.
///
/// The thesis prints exp(−|x − y|²/θ) with θ = 125; figures near those of its table 3 come out with the convention of PRTools, which divides by
/// θ². So the convention is part of the value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "convention", deny_unknown_fields)]
#[non_exhaustive]
pub enum Width {
    /// exp(−|x − y|²/θ), as printed in the thesis: γ = 1/θ.
    Theta {
        /// θ > 0.
        theta: f64,
    },
    /// exp(−|x − y|²/θ²), as in PRTools: γ = 1/θ².
    ThetaSquared {
        /// θ > 0.
        theta: f64,
    },
    /// exp(−γ|x − y|²).
    Gamma {
        /// γ > 0.
        gamma: f64,
    },
    /// exp(−|x − y|²/(2σ²)): γ = 1/(2σ²).
    Sigma {
        /// σ > 0.
        sigma: f64,
    },
    /// γ = `factor` / (sum of the variances of all coordinates); with a factor of 1 it is what scikit-learn calls `scale`.
    Scale {
        /// The factor, > 0.
        factor: f64,
    },
    /// γ = 1/(4s), s being the sum of the variances of the coordinates within classes. In d dimensions after whitening γ = 1/(4d).
    #[default]
    Auto,
}

impl Width {
    /// The parameter of the convention; none for [`Width::Auto`].
    fn parameter(&self) -> Option<(&'static str, f64)> {
        match *self {
            Width::Theta { theta } => Some(("theta", theta)),
            Width::ThetaSquared { theta } => Some(("theta-squared", theta)),
            Width::Gamma { gamma } => Some(("gamma", gamma)),
            Width::Sigma { sigma } => Some(("sigma", sigma)),
            Width::Scale { factor } => Some(("scale", factor)),
            Width::Auto => None,
        }
    }

    /// γ for some training rows.
    pub(super) fn gamma(&self, rows: &Rows) -> Result<f64, Error> {
        if let Some((_, value)) = self.parameter()
            && !(value > 0.0 && value.is_finite())
        {
            let expected = "a finite number above 0";
            return Err(Error::option("width", shown_number(value), expected));
        }
        let of_spread = |factor: f64, spread: f64| match spread > 0.0 {
            true => factor / spread,
            // All points are equal: any width is as good.
            false => factor,
        };
        let gamma = match *self {
            Width::Theta { theta } => 1.0 / theta,
            Width::ThetaSquared { theta } => 1.0 / (theta * theta),
            Width::Gamma { gamma } => gamma,
            Width::Sigma { sigma } => 1.0 / (2.0 * sigma * sigma),
            Width::Scale { factor } => of_spread(factor, total_variance(rows)),
            Width::Auto => {
                let within = within_variance(rows);
                let spread = if within > 0.0 { within } else { total_variance(rows) };
                of_spread(0.25, spread)
            }
        };
        match gamma > 0.0 && gamma.is_finite() {
            true => Ok(gamma),
            false => Err(Error::Overflow),
        }
    }
}

impl fmt::Display for Width {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.parameter() {
            Some((name, value)) => write!(f, "{name}={}", shown_number(value)),
            None => f.write_str("auto"),
        }
    }
}

impl FromStr for Width {
    type Err = InputError;

    /// Reads `auto`, or a convention with its parameter, such as `theta-squared=125`.
    fn from_str(text: &str) -> Result<Self, InputError> {
        let wrong = || InputError::Option {
            name: "width",
            value: text.to_owned(),
            expected: "auto, or theta=, theta-squared=, gamma=, sigma= or scale= with a number above 0",
        };
        if text == "auto" {
            return Ok(Width::Auto);
        }
        let (name, number) = text.split_once('=').ok_or_else(wrong)?;
        let value: f64 = number.parse().map_err(|_| wrong())?;
        if !(value > 0.0 && value.is_finite()) {
            return Err(wrong());
        }
        match name {
            "theta" => Ok(Width::Theta { theta: value }),
            "theta-squared" => Ok(Width::ThetaSquared { theta: value }),
            "gamma" => Ok(Width::Gamma { gamma: value }),
            "sigma" => Ok(Width::Sigma { sigma: value }),
            "scale" => Ok(Width::Scale { factor: value }),
            _ => Err(wrong()),
        }
    }
}

/// The median over rows of the kernel between a row and its nearest other one: near 0 every point is alone, near 1 all are the same.
pub(super) fn nearest_kernel(rows: &Rows, gamma: f64) -> Option<f64> {
    let count = rows.len().min(LOOKED_AT_ROWS_MAX);
    if rows.len() < 2 {
        return None;
    }
    let mut nearest: Vec<f64> = (0..count)
        .map(|k| k * rows.len() / count)
        .map(|i| {
            let others = (0..rows.len()).filter(|&j| j != i);
            others.map(|j| squared_distance(rows.row(i), rows.row(j))).fold(f64::INFINITY, f64::min)
        })
        .collect();
    nearest.sort_by(f64::total_cmp);
    Some((-gamma * nearest[count / 2]).exp())
}

pub(super) fn squared_distance(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| (x - y) * (x - y)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conventions_are_read_and_mean_what_they_say() {
        let rows =
            Rows { values: vec![0.0, 2.0, 4.0, 6.0], dim: 1, labels: vec![0, 0, 1, 1], classes: 2 };
        for (text, gamma) in [
            ("theta=125", 1.0 / 125.0),
            ("theta-squared=125", 1.0 / 15625.0),
            ("gamma=0.5", 0.5),
            ("sigma=2", 0.125),
            // The variance of all is 5; that within classes is 2 with one degree of freedom each.
            ("scale=1", 0.2),
            ("auto", 0.125),
        ] {
            let width: Width = text.parse().unwrap();
            assert!((width.gamma(&rows).unwrap() / gamma - 1.0).abs() < 1e-15, "{text}");
            assert_eq!(width.to_string().parse::<Width>().unwrap(), width);
        }
        for text in ["", "125", "theta", "theta=", "theta=-1", "theta=nan", "sigma=inf", "b=1"] {
            assert!(
                text.parse::<Width>().unwrap_err().to_string().contains("theta-squared="),
                "{text}"
            );
        }
        assert!(Width::Gamma { gamma: f64::NAN }.gamma(&rows).is_err());
        assert!(matches!(Width::Sigma { sigma: 1e300 }.gamma(&rows), Err(Error::Overflow)));
    }

    #[test]
    fn degenerate_widths_show_in_the_nearest_kernel() {
        let rows = Rows { values: vec![0.0, 1.0, 2.0], dim: 1, labels: vec![0; 3], classes: 1 };
        assert_eq!(nearest_kernel(&rows, 2.0), Some((-2f64).exp()));
        let one = Rows { values: vec![0.0], dim: 1, labels: vec![0], classes: 1 };
        assert_eq!(nearest_kernel(&one, 2.0), None);
    }
}
