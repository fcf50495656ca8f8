//! Whitening by itself: a map of points that makes the covariance within classes the identity.

use serde::{Deserialize, Serialize};
use taut_points::InputError;

use super::method::Scaling;
use super::prepare::Preparation;
use super::{Labeled, Method, Rule};
use crate::Error;

/// A linear map after which the pooled, shrunk covariance within classes is the identity.
///
/// The squared distance of two mapped points is their squared Mahalanobis distance: that of [`Rule::Mahalanobis`] with the pooled
/// covariance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Whitener(Preparation);

impl Whitener {
    /// Learns the map from points with the z-score of [`Scaling::ZScore`]; classes are those of `data`.
    ///
    /// # Errors
    /// [`Error::ClassCount`] where no class has two points, and [`Error::Overflow`].
    pub fn learn(data: Labeled<'_>) -> Result<Self, Error> {
        Ok(Whitener(Preparation::learn(&data.all(), Scaling::ZScore, true)?))
    }

    /// The method whose distances these are.
    pub fn method() -> Method {
        let rule = Rule::Mahalanobis { covariance: super::Covariance::Pooled };
        Method { rule, ..Method::default() }
    }

    /// Coordinates of a point.
    pub fn dim(&self) -> usize {
        self.0.dim()
    }

    /// Maps a point.
    ///
    /// # Errors
    /// [`Error::Dimension`], [`InputError::NonFinite`], and [`Error::Overflow`].
    pub fn apply(&self, x: &[f64]) -> Result<Vec<f64>, Error> {
        if x.len() != self.dim() {
            return Err(Error::Dimension { found: x.len(), expected: self.dim() });
        }
        if let Some(column) = x.iter().position(|value| !value.is_finite()) {
            return Err(InputError::NonFinite { row: 0, column, value: x[column] }.into());
        }
        let mapped = self.0.point(x);
        match mapped.iter().all(|value| value.is_finite()) {
            true => Ok(mapped),
            false => Err(Error::Overflow),
        }
    }

    /// Tests whether a map that was read has parts of sizes that fit.
    pub(crate) fn is_sound(&self) -> bool {
        self.0.is_sound(self.0.dim())
    }
}
