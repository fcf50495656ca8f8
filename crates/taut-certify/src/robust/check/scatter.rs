//! Decides whether the scatter is (F′F)⁻¹ over the border, within the hull: symmetric, F S F′ = I/border, and nothing off it.

use super::super::RobustEllipsoid;
use crate::Violation;
use crate::arithmetic::{DoubleDouble, Field, Ring, U};
use crate::ellipsoid::check::frame::{Frame, power_of_two_below};
use crate::ellipsoid::check::hull::{HullTest, length};

pub(super) fn check(
    answer: &RobustEllipsoid,
    frame: &Frame<'_>,
    hull: Option<&HullTest<'_>>,
    border: f64,
    slack: f64,
) -> Result<(), Violation> {
    let (dim, rank, scatter) = (frame.dim, frame.rank, &answer.scatter);
    let wrong = |what: String, claimed, found| Err(Violation::Estimate { what, claimed, found });
    for j in 0..dim {
        for k in 0..j {
            if scatter[j][k] != scatter[k][j] {
                let what = format!("entry ({j}, {k}) of the scatter");
                return wrong(what, scatter[j][k], scatter[k][j]);
            }
        }
    }
    // Columns are brought to deviations of about 1, by powers of two, as their squares may differ by more than `f64`
    // bears.
    let deviation = |j: usize| scatter[j][j].max(0.0).sqrt();
    let units: Vec<f64> = (0..dim).map(|j| power_of_two_below(deviation(j))).collect();
    let sizes: Vec<f64> = (0..dim).map(|j| deviation(j) / units[j]).collect();
    let scaled = |j: usize, k: usize| scatter[j][k] / units[j] / units[k];
    let factor: Vec<Vec<f64>> = (answer.factor.iter())
        .map(|row| row.iter().zip(&units).map(|(f, unit)| f * unit).collect())
        .collect();
    for a in 0..rank {
        // SF′, row a of it.
        let product: Vec<DoubleDouble> = (0..dim)
            .map(|j| {
                let terms = factor[a].iter().enumerate();
                terms.fold(DoubleDouble::of(0.0), |sum, (k, &f)| {
                    sum.plus(&DoubleDouble::of(f).times(&DoubleDouble::of(scaled(j, k))))
                })
            })
            .collect();
        let terms = |row: &[f64]| -> f64 { row.iter().zip(&sizes).map(|(f, s)| f.abs() * s).sum() };
        for b in 0..=a {
            let row = &factor[b];
            let entry = row.iter().zip(&product).fold(DoubleDouble::of(0.0), |sum, (&f, p)| {
                sum.plus(&DoubleDouble::of(f).times(p))
            });
            let wanted = if a == b { 1.0 / border } else { 0.0 };
            // Entries of S are rounded, each relative to its deviations.
            let rounding = 8.0 * (dim + 4) as f64 * U * terms(&factor[a]) * terms(row);
            let tolerance = slack / border + rounding;
            let agrees = (entry.rounded() - wanted).abs() <= tolerance && tolerance.is_finite();
            if !agrees {
                let what = format!("entry ({a}, {b}) of FSF′");
                return wrong(what, entry.rounded(), wanted);
            }
        }
    }
    // Directions off the hull know of no units: all coordinates in that of the largest.
    let unit = units.iter().copied().fold(0.0, f64::max);
    let whole = length(&(0..dim).map(|j| deviation(j) / unit).collect::<Vec<_>>());
    for j in 0..dim {
        let row: Vec<f64> = (0..dim).map(|k| scatter[j][k] / unit / unit).collect();
        let off = hull.map_or(0.0, |hull| length(&hull.off(&row)));
        // Rounding of S, and of a basis that is orthonormal but for rounding.
        let is_within = off <= 64.0 * (dim + 4) as f64 * U * whole * whole;
        if !is_within {
            return wrong(format!("row {j} of the scatter, off the hull,"), off, 0.0);
        }
    }
    Ok(())
}
