//! From the rows kept to the final estimate, in the subspace where most rows lie.

use taut_certify::{Enclosure, RobustMethod, RobustScale, Unweighted};
use taut_points::{Monitor, Points};

use super::chi_square::{
    consistency, mcd_reweighted_scale, mcd_scale, mve_reweighted_scale, mve_scale, quantile,
};
use super::concentrate::{ConcentrationResult, Criterion, Raw};
use super::enclosing::EnclosingMetric;
use super::estimate::{Estimate, RankedEstimate};
use super::flat::{Flat, Part, hull};
use super::{RobustOptions, enclosing, search};
use crate::Error;
use crate::ellipsoid::point_reader::PointReader;

/// An estimate with all it was made from.
pub(super) struct Fit {
    pub(super) kept: Vec<bool>,
    pub(super) objective: f64,
    pub(super) raw_scale: f64,
    /// Rows not weighed out.
    pub(super) weighed: Vec<bool>,
    /// Their mean and covariance; the scatter is `scale` times that.
    pub(super) estimate: Estimate,
    pub(super) scale: f64,
    pub(super) cutoff: f64,
    /// Why the estimate is that of the rows kept, if it is.
    pub(super) unweighted: Option<Unweighted>,
    pub(super) enclosure: Option<Enclosure>,
}

/// A fit and where it is.
pub(super) struct Placed {
    /// The subspace, unless it is the whole space, and the rows on it.
    pub(super) flat: Option<Flat>,
    pub(super) ids: Option<Vec<u64>>,
    /// In coordinates of the subspace, over the rows on it.
    pub(super) fit: Fit,
}

impl Placed {
    /// The rows of all n that are not marked.
    pub(super) fn others(&self, marked: &[bool], n: u64) -> Vec<u64> {
        let Some(ids) = &self.ids else {
            return (0..n).zip(marked).filter(|(_, marked)| !**marked).map(|(id, _)| id).collect();
        };
        let mut here = ids.iter().zip(marked).filter(|(_, m)| **m).map(|(id, _)| *id).peekable();
        (0..n).filter(|id| here.next_if_eq(id).is_none()).collect()
    }
}

/// Rows kept, in the subspace where h of them lie.
struct Descent {
    part: Option<Part>,
    /// None where the subspace is a point.
    raw: Option<Raw>,
}

/// Finds the rows to keep, within a subspace if h rows lie in one.
fn descend(
    data: &mut PointReader<'_>,
    h: usize,
    options: &RobustOptions<'_>,
    steps: &mut u64,
) -> Result<Descent, Error> {
    let flat = match search::solve(Criterion::of(options), data, h, steps)? {
        ConcentrationResult::Full(raw) => return Ok(Descent { part: None, raw: Some(raw) }),
        ConcentrationResult::Flat(flat) => flat,
    };
    let part = flat.holding(data, h)?;
    if part.flat.rank() == 0 {
        return Ok(Descent { part: Some(part), raw: None });
    }
    let points = Points::new(&part.values, part.flat.rank()).expect("rows of the rank");
    let silent = Monitor::silent();
    let mut within = PointReader::new(&points, &silent)?;
    let inner = descend(&mut within, h, options, steps)?;
    data.count(within.passes());
    let part = match inner.part {
        None => part,
        Some(deeper) => Part {
            flat: part.flat.within(&deeper.flat),
            ids: deeper.ids.into_iter().map(|id| part.ids[id as usize]).collect(),
            values: deeper.values,
        },
    };
    Ok(Descent { part: Some(part), raw: inner.raw })
}

/// Finds the rows to keep and fits, within a subspace if h rows lie in one.
pub(super) fn place(
    data: &mut PointReader<'_>,
    h: usize,
    options: &RobustOptions<'_>,
    steps: &mut u64,
) -> Result<Placed, Error> {
    let Descent { part, raw } = descend(data, h, options, steps)?;
    if options.method == RobustMethod::Mcd {
        return finish(data, part, raw, None, h, options);
    }
    let kept: Vec<u64> = match (&part, &raw) {
        (Some(part), None) => part.ids.clone(),
        (Some(part), Some(raw)) => marked(&raw.kept, |row| part.ids[row]),
        (None, raw) => raw.as_ref().map_or(vec![], |raw| marked(&raw.kept, |row| row as u64)),
    };
    let EnclosingMetric { enclosure, kept, part, metric } =
        enclosing::enclose(data, kept, options.epsilon)?;
    let mark = |ids: &mut dyn Iterator<Item = u64>| -> Vec<bool> {
        let mut kept = kept.iter().copied().peekable();
        ids.map(|id| kept.next_if_eq(&id).is_some()).collect()
    };
    let marks = match &part {
        Some(part) => mark(&mut part.ids.iter().copied()),
        None => mark(&mut (0..data.len())),
    };
    let raw = (metric.dim() > 0).then_some(Raw { estimate: metric, kept: marks });
    finish(data, part, raw, Some(enclosure), h, options)
}

fn marked(marks: &[bool], id: impl Fn(usize) -> u64) -> Vec<u64> {
    marks.iter().enumerate().filter(|(_, marked)| **marked).map(|(row, _)| id(row)).collect()
}

/// Weighs outliers out where the rows kept are.
fn finish(
    data: &mut PointReader<'_>,
    part: Option<Part>,
    raw: Option<Raw>,
    enclosure: Option<Enclosure>,
    h: usize,
    options: &RobustOptions<'_>,
) -> Result<Placed, Error> {
    let mut fit = match (&part, raw) {
        (None, Some(raw)) => reweighted(data, raw, h, options)?,
        (Some(part), Some(raw)) => {
            let points = Points::new(&part.values, part.flat.rank()).expect("rows of the rank");
            let silent = Monitor::silent();
            reweighted(&mut PointReader::new(&points, &silent)?, raw, h, options)?
        }
        (part, None) => {
            let rows = part.as_ref().map_or(0, |part| part.ids.len());
            let kept = if options.method == RobustMethod::Mcd { h } else { rows };
            point(rows, kept)
        }
    };
    if let Some(enclosure) = enclosure {
        fit.objective = enclosure.ellipsoid.log_volume;
        fit.enclosure = Some(enclosure);
    }
    let (flat, ids) = part.map(|part| (part.flat, part.ids)).unzip();
    Ok(Placed { flat, ids, fit })
}

/// The fit of rows that are all one point; h of them are kept.
fn point(rows: usize, h: usize) -> Fit {
    Fit {
        kept: (0..rows).map(|row| row < h).collect(),
        objective: 0.0,
        raw_scale: 1.0,
        weighed: vec![true; rows],
        estimate: Estimate { center: vec![], tail: vec![], matrix: vec![] },
        scale: 1.0,
        cutoff: 0.0,
        unweighted: None,
        enclosure: None,
    }
}

/// Weighs out what lies beyond the quantile in the metric of the rows kept.
fn reweighted(
    data: &mut PointReader<'_>,
    raw: Raw,
    h: usize,
    options: &RobustOptions<'_>,
) -> Result<Fit, Error> {
    let (n, dim) = (data.len() as usize, data.dim());
    let (objective, kept) = (raw.estimate.log_det(), raw.kept);
    let cutoff = quantile(options.level, dim);
    let raw_scale = match options.method {
        RobustMethod::Mcd => mcd_scale(h, n, dim),
        _ => mve_scale(h, n, dim),
    };
    let distances = raw.estimate.distances(data)?;
    let weighed: Vec<bool> = distances.iter().map(|d| *d <= cutoff * raw_scale).collect();
    let left = weighed.iter().filter(|weighed| **weighed).count();
    let settled = match options.method {
        RobustMethod::Trim => Some(Unweighted::Trimmed),
        _ => (h == n).then_some(Unweighted::AllKept),
    };
    let ranked = match settled {
        Some(_) => RankedEstimate::Singular,
        None => match raw.estimate.of_rows(data, &weighed)? {
            // What rounding alone gave a determinant has none.
            RankedEstimate::Noise(_) if hull(data, &weighed)?.is_some() => RankedEstimate::Singular,
            ranked => ranked,
        },
    };
    let (estimate, weighed, scale, unweighted) = match ranked {
        RankedEstimate::Full(estimate) | RankedEstimate::Noise(estimate) => {
            let scale = match (options.scale, options.method) {
                (RobustScale::Level, _) => consistency(options.level, dim),
                (RobustScale::Share, RobustMethod::Mcd) => mcd_reweighted_scale(left, h, n, dim),
                (RobustScale::Share, _) => mve_reweighted_scale(left, n, dim),
            };
            (estimate, weighed, scale, None)
        }
        // Of all rows nothing is weighed out, trimming is done; and what is left must not be flat.
        RankedEstimate::Singular => {
            (raw.estimate, kept.clone(), raw_scale, settled.or(Some(Unweighted::Flat)))
        }
    };
    let enclosure = None;
    Ok(Fit { kept, objective, raw_scale, weighed, estimate, scale, cutoff, unweighted, enclosure })
}
