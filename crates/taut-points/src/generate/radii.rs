//! Radii, by which points become balls.

use std::str::FromStr;

use crate::Error;

/// The way in which radii are distributed. Written as `equal:R`, `uniform:A:B` or `exponential:MEAN`.
///
/// ```
/// use taut_points::generate::RadiusLaw;
/// let law: RadiusLaw = "uniform:1:3".parse()?;
/// assert_eq!(law.radius(0.25), 1.5);
/// # Ok::<(), taut_points::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RadiusLaw {
    /// Each the same.
    Equal(f64),
    /// Uniform between two bounds.
    Uniform(f64, f64),
    /// Exponential with a mean.
    Exponential(f64),
}

impl RadiusLaw {
    /// The radius that belongs to a number in [0, 1): uniform numbers give radii of this law.
    pub fn radius(self, lot: f64) -> f64 {
        match self {
            RadiusLaw::Equal(radius) => radius,
            RadiusLaw::Uniform(low, high) => (low + (high - low) * lot).min(high),
            RadiusLaw::Exponential(mean) => -mean * (-lot).ln_1p(),
        }
    }
}

impl FromStr for RadiusLaw {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let wrong = || Error::Parameter {
            name: "radii",
            value: format!("`{text}`"),
            expected: "equal:R, uniform:A:B or exponential:MEAN with numbers ≥ 0",
        };
        let mut parts = text.split(':');
        let name = parts.next();
        let numbers: Vec<f64> =
            parts.map(str::parse).collect::<Result<_, _>>().map_err(|_| wrong())?;
        if !numbers.iter().all(|number| number.is_finite() && *number >= 0.0) {
            return Err(wrong());
        }
        match (name, &numbers[..]) {
            (Some("equal"), &[radius]) => Ok(RadiusLaw::Equal(radius)),
            (Some("uniform"), &[low, high]) if low <= high => Ok(RadiusLaw::Uniform(low, high)),
            (Some("exponential"), &[mean]) => Ok(RadiusLaw::Exponential(mean)),
            _ => Err(wrong()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laws_have_their_range_and_mean() {
        for (law, low, high, mean) in [
            ("equal:0.5", 0.5, 0.5, 0.5),
            ("uniform:1:3", 1.0, 3.0, 2.0),
            ("exponential:2", 0.0, f64::INFINITY, 2.0),
        ] {
            let law: RadiusLaw = law.parse().unwrap();
            let radii: Vec<f64> = (0..20_000).map(|i| law.radius(i as f64 / 2e4)).collect();
            assert!(radii.iter().all(|&r| (low..=high).contains(&r)), "{law:?}");
            let found = radii.iter().sum::<f64>() / radii.len() as f64;
            assert!((found - mean).abs() <= 1e-3 * mean, "{law:?}: {found}");
        }
    }

    #[test]
    fn other_laws_are_refused_and_named() {
        for text in
            ["", "equal", "equal:-1", "uniform:2:1", "uniform:1", "exponential:NaN", "normal:1"]
        {
            let refused = text.parse::<RadiusLaw>().unwrap_err().to_string();
            assert!(refused.contains(&format!("`{text}`")), "{refused}");
        }
    }
}
