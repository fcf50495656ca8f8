//! The report about a triangulation.

use taut::certify::Triangulation;
use taut::certify::TriangulationVerdict;
use taut::{PointSource, Solution};

use crate::numbers::{count, counted};
use crate::{Claims, Field, Report, Summary};

impl Summary for Triangulation {
    const FOUND: &'static str = "the triangulation found";

    fn title(report: &Report<'_, Self>) -> String {
        let answer = &report.found.answer;
        let place = if answer.dimension == 2 { "the plane" } else { "space" };
        let points = counted(report.points.len(), "point");
        format!("Delaunay triangulation of {points} in {place}")
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let counts = certificate.counts;
        let sites =
            Field::new("sites", count(counts.sites)).remark(match answer.duplicates.len() {
                0 => "no two points are equal".to_owned(),
                1 => "1 point equals an earlier one".to_owned(),
                more => format!("{} points equal an earlier one", count(more as u64)),
            });
        let hull_dimension = answer.hull_dimension;
        let span = match (hull_dimension, answer.dimension) {
            (None, _) => "there are no points",
            (Some(0), _) => "all points are equal",
            (Some(1), _) => "all points are on a line",
            (Some(2), 3) => "all points are on a plane",
            _ => "the points span all dimensions",
        };
        let [simplex, facet] = match hull_dimension {
            Some(3) => ["tetrahedron", "triangle"],
            Some(2) => ["triangle", "edge"],
            Some(1) => ["edge", "end"],
            _ => ["point", "facet"],
        };
        let simplices = match (counts.simplices, simplex) {
            (more, "tetrahedron") if more != 1 => format!("{} tetrahedra", count(more)),
            (some, noun) => counted(some, noun),
        };
        let verified = match &report.verdict {
            Some(proved) => Field::new("verified", "yes").remark(format!(
                "the only one, with {} decided by the perturbation",
                counted(proved.ties, "tie")
            )),
            None => Field::new("verified", "not checked"),
        };
        vec![
            sites,
            Field::new("simplices", simplices),
            Field::new("hull", counted(counts.hull, facet)),
            Field::new("dimension", hull_dimension.map_or("–".to_owned(), |d| d.to_string()))
                .remark(span),
            verified,
            Field::new("hash", certificate.fingerprint.to_string())
                .remark("of the simplices, whatever their order"),
        ]
    }

    fn dim(report: &Report<'_, Self>) -> usize {
        report.points.dim()
    }

    fn claims(
        _: &Solution<Self>,
        verdict: &TriangulationVerdict,
        source: &dyn PointSource,
    ) -> Claims {
        claims_of_triangulation(verdict, source.len(), source.dim())
    }
}

/// Returns what the checker proved, where there is nothing but simplices.
pub fn claims_of_triangulation(verdict: &TriangulationVerdict, rows: u64, dim: usize) -> Claims {
    let counts = verdict.counts;
    let place = if dim == 2 { "the plane" } else { "space" };
    Claims {
        what: format!("the Delaunay triangulation of {} in {place}", counted(rows, "point")),
        gap: None,
        fields: vec![
            Field::proved("sites", count(counts.sites)).remark("distinct points"),
            Field::proved("simplices", count(counts.simplices)),
            Field::proved("hull", counted(counts.hull, "facet")),
            Field::proved("ties", count(verdict.ties))
                .remark("facets with both simplices on one sphere"),
            Field::new("refined", count(verdict.refined))
                .remark("signs that double precision left open, decided exactly"),
            Field::proved("hash", verdict.fingerprint.to_string())
                .remark("of the simplices, whatever their order"),
        ],
    }
}
