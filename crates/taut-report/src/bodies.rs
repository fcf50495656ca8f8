//! The report about convex bodies in a mesh.

use taut::Solution;
use taut::certify::{BodiesVerdict, InscribedBodies};
use taut::inscribe::Occlusion;
use taut::points::PointSource;

use crate::numbers::{count, counted, exact};
use crate::{Claims, Field, Report, Summary};

impl Summary for InscribedBodies {
    const FOUND: &'static str = "the bodies found";

    fn title(report: &Report<'_, Self>) -> String {
        let found = report.found;
        let counter = |name: &str| found.trace.counters.get(name).copied().unwrap_or(0);
        let [triangles, points] = ["triangles", "obstacle_points"].map(counter);
        in_mesh(found.answer.bodies.len() as u64, triangles, points)
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, trace) = (&report.found.answer, &report.found.trace);
        let volume: f64 = answer.bodies.iter().map(|body| body.volume).sum();
        let largest = answer.bodies.iter().map(|body| body.volume).fold(0.0, f64::max);
        let counter = |name: &str| trace.counters.get(name).copied().unwrap_or(0);
        let points = counter("sample_points");
        let share = 100.0 * counter("covered") as f64 / points.max(1) as f64;
        let verified = match report.verdict {
            Some(verdict) => Field::new("verified", "yes").remark(match obstacles(&verdict) {
                Some(obstacles) => format!("{}; {obstacles}", inside(verdict.caps)),
                None => inside(verdict.caps),
            }),
            None => Field::new("verified", "not checked"),
        };
        let mut fields = vec![
            Field::new("volume", exact(volume)).remark("the sum over all bodies"),
            Field::new("largest", exact(largest)),
            Field::new("coverage", format!("{share:.1} %")).remark(format!(
                "of {} inside that the search did not see; an estimate",
                counted(points, "point")
            )),
            Field::new("disjoint", if answer.disjoint { "yes" } else { "no" }),
            Field::new("facets", count(counter("facets"))).remark("the sum over all bodies"),
            verified,
            Field::new("method", &*trace.method),
            Field::new("events", count(trace.iterations)),
            Field::new("grid", exact(2f64.powi(answer.exponent)))
                .remark("the unit to which coordinates are rounded; the proof allows for it"),
        ];
        if !answer.caps.is_empty() {
            let caps = count(answer.caps.len() as u64);
            fields.push(
                Field::new("caps", caps).remark("triangles that close the holes of the mesh"),
            );
        }
        fields
    }

    fn dim(_report: &Report<'_, Self>) -> usize {
        3
    }

    fn claims(
        found: &Solution<Self>,
        verdict: &Self::Verdict,
        _source: &dyn PointSource,
    ) -> Claims {
        let (lower, upper) = (exact(verdict.volume_lower), exact(verdict.volume_upper));
        let mut fields = vec![
            Field::proved("inside", inside(verdict.caps))
                .remark("in whole numbers, for the coordinates as given"),
            Field::proved("volume", format!("{lower} ≤ sum of the volumes ≤ {upper}")).remark(
                if verdict.disjoint { "of disjoint bodies" } else { "of bodies that may overlap" },
            ),
            Field::proved("largest", format!("a body of volume ≥ {}", exact(verdict.largest))),
        ];
        if verdict.at > 0 {
            let ends = &found.answer.ends;
            let segments = found.answer.at.iter().zip(ends).filter(|(at, end)| at != end).count();
            let given = match (segments as u64, verdict.at - segments as u64) {
                (0, points) => counted(points, "given point"),
                (segments, 0) => counted(segments, "given segment"),
                (segments, points) => {
                    format!(
                        "{} and {}",
                        counted(points, "given point"),
                        counted(segments, "given segment")
                    )
                }
            };
            fields.push(Field::proved("at", format!("{given} in as many bodies, in their order")));
        }
        if let Some(obstacles) = obstacles(verdict) {
            fields.push(Field::proved("obstacles", obstacles));
        }
        if verdict.disjoint {
            fields.push(Field::proved("disjoint", "no two bodies overlap"));
        }
        let what = in_mesh(verdict.bodies, verdict.triangles, verdict.points);
        Claims { what, gap: None, fields }
    }
}

/// Says what each body lies inside of.
fn inside(caps: u64) -> String {
    let closed = match caps {
        0 => String::new(),
        caps => format!(" closed by {}", counted(caps, "cap")),
    };
    format!("each body lies inside the mesh{closed}, by the even-odd rule")
}

/// Returns what is said about the share of lines that bodies hide.
pub fn occlusion(found: &Occlusion) -> Field {
    let percent = |share: f64| format!("{:.1}", 100.0 * share);
    let (share, error) = (percent(found.share), 100.0 * found.standard_error);
    Field::evidence(
        "occlusion",
        format!("{share} % of {} through the mesh", counted(found.lines, "line")),
    )
    .remark(format!(
        "standard error {error:.2} %; in the worst of {} {} %",
        counted(found.views, "view"),
        percent(found.least_view)
    ))
}

/// Says what bodies are clear of.
fn obstacles(verdict: &BodiesVerdict) -> Option<String> {
    let solids = (verdict.solids > 0)
        .then(|| format!("outside of {}", counted(verdict.solids, "closed obstacle")));
    let walls = (verdict.walls > 0).then(|| {
        format!("met by none of {} of open obstacles", counted(verdict.walls, "triangle"))
    });
    let points = (verdict.points > 0)
        .then(|| format!("none of {} is in a body", counted(verdict.points, "point")));
    let all: Vec<String> = [solids, walls, points].into_iter().flatten().collect();
    (!all.is_empty()).then(|| all.join("; "))
}

/// Bodies, and the triangles and points among which they are.
fn in_mesh(bodies: u64, triangles: u64, points: u64) -> String {
    let bodies = match bodies {
        1 => "1 convex body".to_owned(),
        more => format!("{} convex bodies", count(more)),
    };
    let triangles = counted(triangles, "triangle");
    match points {
        0 => format!("{bodies} in a mesh of {triangles}"),
        points => {
            format!("{bodies} in a mesh of {triangles} and among {}", counted(points, "point"))
        }
    }
}
