//! Refusals before any half-space is read: lengths, ranges and the list of rows.

use taut_points::PointSource;

use super::super::{InscribedCertificate, InscribedEllipsoid};
use crate::Violation;

pub(super) fn check(
    answer: &InscribedEllipsoid,
    certificate: &InscribedCertificate,
    source: &dyn PointSource,
) -> Result<(), Violation> {
    let dim = source.dim().saturating_sub(1);
    let found = answer.center.len();
    if found != dim || dim == 0 {
        return Err(Violation::Dimension { found, expected: dim });
    }
    let length = |what, found, expected| match found == expected {
        true => Ok(()),
        false => Err(Violation::Length { what, found, expected }),
    };
    length("the list of axes", answer.axes.len(), dim)?;
    for row in &answer.axes {
        length("a row of the axes", row.len(), dim)?;
    }
    let numbers = answer.center.iter().chain(answer.axes.iter().flatten());
    if let Some(&value) = numbers.chain([&answer.log_volume]).find(|v| !v.is_finite()) {
        let what = "a number of the answer".into();
        return Err(Violation::Number { what, value, expected: "a finite number" });
    }
    let value = certificate.gap;
    if !(value >= 0.0 && value.is_finite()) {
        let what = "the claimed gap".into();
        return Err(Violation::Number { what, value, expected: "a finite number, at least 0" });
    }
    let InscribedCertificate { support, multipliers, .. } = certificate;
    if support.is_empty() {
        return Err(Violation::EmptySupport);
    }
    length("the list of multipliers", multipliers.len(), support.len())?;
    if let Some((position, &value)) =
        multipliers.iter().enumerate().find(|(_, v)| !(**v > 0.0 && v.is_finite()))
    {
        let what = format!("multiplier {position}");
        return Err(Violation::Number { what, value, expected: "a finite number above 0" });
    }
    for (position, &point) in support.iter().enumerate() {
        let problem = match position.checked_sub(1).map(|before| support[before]) {
            _ if point >= source.len() => "but there are not so many",
            Some(before) if before >= point => "which is no more than the entry before it",
            _ => continue,
        };
        return Err(Violation::Support { position, point, problem });
    }
    Ok(())
}
