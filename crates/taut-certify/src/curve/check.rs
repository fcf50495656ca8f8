//! The checker of curves, in arithmetic of its own.
//!
//! *Problem.* Given rows and polylines, prove that no two edges meet but neighbors at their vertex, that every row but the
//! outliers is within the band, and judge whether the rows sample the polylines densely enough beside their features.
//! *Simplicity.* By exact signs over pairs of edges whose boxes meet: [`simple`].
//! *Band.* The distance to the nearest edge, rounded up, or equality with a vertex where vertices are rows: [`band`].
//! *Evidence.* φ, a feature size of the polylines themselves ([`features`]), the gaps between the places of rows and what lies
//! across the band ([`sampling`], [`bands`]), stretches with few rows ([`vacancy`]), whether the band is wider and denser somewhere ([`swell`]), and
//! whether outliers could be a curve ([`outliers`]).
//! *Tours.* Held and Karp's bound from the potentials: [`tour`].
//! *Tolerances.* Lists, rows, signs and the band have none. A figure of the evidence may be claimed to be less than found by 5 %
//! of it, as φ is told up to a 64th.
//! *Cost.* O(n log n) for curves whose edges crowd nowhere; E² pairs in the worst case, of edges that are long and side by side.

mod arcs;
mod band;
mod bands;
mod edges;
pub(super) mod evidence;
mod features;
mod outliers;
mod run;
mod sampling;
mod signs;
mod simple;
mod structure;
mod swell;
mod tangent;
pub(super) mod tour;
mod tree;
mod vacancy;
mod valley;

use taut_points::{Monitor, PointSource, PointsHash, ReadError};

use self::edges::Edges;
use self::evidence::CurveEvidence;
use self::tour::{tour_bound, tour_length};
use super::{Curve, CurveCertificate, CurveDoubt, CurveVerdict, CurveViolation};
use crate::CheckError;
use crate::hashed_pass::{WantedRows, all_finite, hashed_pass};

/// How much less than found a figure may be claimed to be, relatively: φ is told up to a 64th.
const FIGURE_SLACK: f64 = 0.05;

/// How much more than proved a lower bound may be claimed to be, relatively, for those who sum in an order of their own. The gap in
/// the verdict is that of the lesser.
const BOUND_SLACK: f64 = 1e-9;

pub(super) fn check(
    curve: &Curve,
    certificate: &CurveCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<CurveVerdict, CheckError> {
    structure::check(curve, certificate, source)?;
    monitor.pass(1, source.len());
    let rows = read(source, certificate.points_hash, monitor)?;
    structure::rows(curve, &rows)?;
    let edges = Edges::of(&curve.curves, &rows);
    let crossing = simple::crossing(&edges, monitor)?;
    if let (Some([one, other]), None) = (crossing, &certificate.tour) {
        let [(curve, edge), (other, other_edge)] = [one, other].map(|edge| edges.name(edge));
        return Err(CurveViolation::Crossing { curve, edge, other, other_edge }.into());
    }
    let placed = band::place(curve, certificate, &edges, &rows, monitor)?;
    let evidence = match (&certificate.tour, crossing) {
        (Some(_), Some([one, _])) => {
            let (curve, edge) = edges.name(one);
            CurveEvidence::unknown(placed.band, CurveDoubt::Crossing { curve, edge })
        }
        (Some(_), None) => CurveEvidence::unknown(placed.band, CurveDoubt::Tour),
        (None, _) => {
            evidence::judge(&curve.curves, &edges, &placed, monitor).map_err(ReadError::from)?
        }
    };
    claims(certificate, &evidence)?;
    let tour_gap = tour_gap(curve, certificate, &edges, monitor)?;
    Ok(CurveVerdict {
        rows: source.len(),
        outliers: curve.outliers.len() as u64,
        band: placed.band,
        is_simple: crossing.is_none(),
        sampling_ratio: evidence.sampling_ratio,
        noise_ratio: evidence.noise_ratio,
        certified: evidence.doubt.is_none(),
        doubt: evidence.doubt,
        tour_gap,
    })
}

/// All rows, if they are finite and those of the hash.
fn read(
    source: &dyn PointSource,
    claimed: PointsHash,
    monitor: &Monitor<'_>,
) -> Result<Vec<[f64; 2]>, CheckError> {
    let (blocks, _) = hashed_pass(source, claimed, WantedRows::none(), monitor, |first, rows| {
        all_finite(first, rows)?;
        let mut point = [0.0; 2];
        let points: Vec<[f64; 2]> = (0..rows.len())
            .map(|row| {
                rows.copy_row(row, &mut point);
                point
            })
            .collect();
        Ok(points)
    })?;
    Ok(blocks.into_iter().flatten().collect())
}

/// Whether no more is claimed than the evidence gives.
fn claims(certificate: &CurveCertificate, evidence: &CurveEvidence) -> Result<(), CurveViolation> {
    let figures = [
        ("sampling ratio", certificate.sampling_ratio, evidence.sampling_ratio),
        ("noise ratio", certificate.noise_ratio, evidence.noise_ratio),
    ];
    for (figure, claimed, found) in figures {
        let is_covered = claimed == f64::MAX || found <= claimed * (1.0 + FIGURE_SLACK);
        if !is_covered {
            return Err(CurveViolation::Figure { figure, claimed, found });
        }
    }
    match evidence.doubt {
        Some(doubt) if certificate.certified => Err(CurveViolation::NotCertified { doubt }),
        _ => Ok(()),
    }
}

/// length / bound − 1, rounded up.
fn tour_gap(
    curve: &Curve,
    certificate: &CurveCertificate,
    edges: &Edges,
    monitor: &Monitor<'_>,
) -> Result<Option<f64>, CheckError> {
    let (Some(bound), [component]) = (&certificate.tour, curve.curves.as_slice()) else {
        return Ok(None);
    };
    let (is_open, cancelled) = (!component.closed, ReadError::from);
    let scaled: Vec<f64> = bound.potentials.iter().map(|p| p * edges.scale).collect();
    let lower = tour_bound(&edges.points, &scaled, is_open, monitor).map_err(cancelled)?;
    let claimed = bound.lower * edges.scale;
    let is_proved = claimed <= lower * (1.0 + BOUND_SLACK);
    if !is_proved {
        let proved = lower / edges.scale;
        return Err(CurveViolation::TourBound { claimed: bound.lower, proved }.into());
    }
    let (length, lower) = (tour_length(&edges.points, is_open), lower.min(claimed));
    let gap = length / lower * (1.0 + 4.0 * f64::EPSILON) - 1.0;
    Ok(Some(match length <= lower {
        true => 0.0,
        // A bound of 0, of either sign, says nothing.
        false if gap.is_nan() || lower <= 0.0 => f64::INFINITY,
        false => gap.max(0.0),
    }))
}
