//! What is said about an ellipsoid: the same facts on the terminal, beside pictures and in the tour.

use taut::{Ellipsoid, EllipsoidVerdict, Items, Solution};
use taut_draw::ellipsoid_figures;

use crate::numbers::{abridged, coordinates, count, counted, exact, gap};
use crate::picture::{self, Drawing, Look};
use crate::reading::Opened;
use crate::report::{Fact, stopped};

/// An ellipsoid, the points it belongs to, and what the checker proved (`None` where it was not asked).
pub(crate) struct EllipsoidReport<'a> {
    pub(crate) found: &'a Solution<Ellipsoid>,
    pub(crate) points: &'a Opened,
    pub(crate) verdict: Option<EllipsoidVerdict>,
}

impl EllipsoidReport<'_> {
    /// What this is, in one line.
    pub(crate) fn title(&self) -> String {
        let (source, left_out) = (self.points.source(), &self.found.certificate.left_out);
        let inside = counted(source.len() - left_out.len() as u64, self.noun());
        let of = match left_out.len() {
            0 => String::new(),
            _ => format!(" of {}", count(source.len())),
        };
        let dim = self.found.answer.dim() as u64;
        format!("Smallest ellipsoid around {inside}{of} in {}", counted(dim, "dimension"))
    }

    /// The numbers, each with its name.
    pub(crate) fn facts(&self) -> Vec<Fact> {
        let (answer, certificate) = (&self.found.answer, &self.found.certificate);
        let trace = &self.found.trace;
        let (dim, rank) = (answer.dim(), answer.rank());
        // The points may lie far from the origin: digits of the centre count beside the extent of the ellipsoid.
        let longest = answer.factor.iter().flatten().fold(0.0f64, |m, f| m.max(f.abs()));
        let size = if longest > 0.0 { 1.0 / longest } else { 1.0 };
        let mut centre = Fact::new("centre", coordinates(&answer.center, size));
        if abridged(&answer.center) {
            centre.value += &format!(" {} in all", count(answer.center.len() as u64));
            centre = centre.remark("the JSON holds them (-o FILE)");
        }
        let volume = Fact::new("log-volume", exact(answer.log_volume));
        let volume = match (rank, dim) {
            (0, _) => volume.remark("all are one point"),
            (r, d) if r < d => {
                volume.remark(format!("of dimension {r}: all lie in a flat of {d} dimensions"))
            }
            _ => volume,
        };
        let (gap, verified) = match &self.verdict {
            Some(proved) => (
                Fact::new("gap", gap(proved.gap)).remark(format!(
                    "no enclosing ellipsoid has a log-volume below {}",
                    exact(proved.lower)
                )),
                Fact::new("verified", "yes")
                    .remark(format!("every {} is inside, and the gap is proved", self.noun())),
            ),
            None => (
                Fact::new("gap", gap(certificate.gap)).remark("as the solver says"),
                Fact::new("verified", "not checked"),
            ),
        };
        let support = count(certificate.support.len() as u64);
        let mut facts = vec![volume, centre, gap, verified];
        if !certificate.left_out.is_empty() {
            facts.push(Fact::new(
                "left out",
                counted(certificate.left_out.len() as u64, self.noun()),
            ));
        }
        facts.extend([
            Fact::new("method", &*trace.method).remark(stopped(trace.stop)),
            Fact::new("core-set", counted(trace.core_set, self.noun()))
                .remark(format!("{support} of them in the support")),
            Fact::new("passes", count(trace.passes)).remark(counted(trace.iterations, "iteration")),
        ]);
        facts
    }

    /// Pictures and what stands beside them.
    pub(crate) fn drawing(&self, look: &Look) -> anyhow::Result<Drawing> {
        let options = look.options(self.points.names(self.found.answer.dim()));
        let figures = ellipsoid_figures(self.found, self.points.source(), &options)
            .map_err(|error| picture::refused(error, self.points))?;
        Ok(Drawing {
            title: self.title(),
            heading: self.points.name().to_owned(),
            facts: self.facts().into_iter().map(picture::fact).collect(),
            figures,
        })
    }

    fn noun(&self) -> &'static str {
        match self.found.certificate.items {
            Items::Points => "point",
            Items::Balls => "ball",
            Items::Ellipsoids => "ellipsoid",
        }
    }
}

/// What the checker proved.
pub(crate) fn proved_of_ellipsoid(verdict: &EllipsoidVerdict) -> Vec<Fact> {
    let bracket = format!("{} ≤ least log-volume ≤ {}", exact(verdict.lower), exact(verdict.upper));
    vec![
        Fact::new("bracket", bracket),
        Fact::new("gap", gap(verdict.gap)).remark("in log-volume, proved from the points alone"),
        Fact::new("dimension", verdict.rank.to_string()),
        Fact::new("excess", gap(verdict.excess))
            .remark("by which |F(x − c)| exceeds 1 at worst; it is part of the gap"),
        Fact::new("matrix", gap(verdict.matrix_excess))
            .remark("by which (x − c)ᵀQ(x − c) can exceed 1 at worst"),
    ]
}
