//! A shape that was found, of whatever kind: what can be done with it in the browser.

use serde_json::{Value, json};
use taut::certify::{CheckError, Fault, Violation};
use taut::{Monitor, PointSource, Solution};
use taut_draw::{DrawOptions, Page, Section, to_html};
use taut_report::{Field, Report, Summary, text, worth_drawing};

use crate::input::Opened;

/// What the page asks of an answer.
pub(crate) trait Shape: std::fmt::Debug {
    /// Checks the answer, and describes what was found and what is proved, in the words of the command.
    fn check(&mut self, points: &Opened, monitor: &Monitor<'_>) -> Result<Value, String>;

    /// Returns the pictures as one page of HTML.
    fn picture(&self, points: &Opened) -> Result<String, String>;

    /// Returns answer, certificate and trace as JSON.
    fn json(&self) -> String;

    /// Returns the shape as a file of the format that the name tells.
    fn file(&self, points: &Opened, name: &str) -> Result<Vec<u8>, String>;
}

/// Writes a shape as the file of a name.
pub(crate) type FileWriter<A> = fn(&Solution<A>, &dyn PointSource, &str) -> Result<Vec<u8>, String>;

/// A solution with what the checker said.
pub(crate) struct Found<A: Summary> {
    solution: Solution<A>,
    verdict: Option<A::Verdict>,
    write: FileWriter<A>,
}

impl<A: Summary> Found<A> {
    /// A solution, and who writes it as a file.
    pub(crate) fn boxed(solution: Solution<A>, write: FileWriter<A>) -> Box<dyn Shape>
    where
        A: 'static,
    {
        Box::new(Found { solution, verdict: None, write })
    }
}

impl<A: Summary> std::fmt::Debug for Found<A> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(A::KIND)
    }
}

impl<A: Summary> Shape for Found<A> {
    fn check(&mut self, points: &Opened, monitor: &Monitor<'_>) -> Result<Value, String> {
        let Found { solution, verdict, .. } = self;
        let source = points.source();
        // A report takes the verdict, so that it is handed back afterwards.
        let judged = solution.answer.check(&solution.certificate, source, monitor);
        let (claims, refusal) = match judged {
            Ok(proved) => {
                let claims = A::claims(solution, &proved, source);
                *verdict = Some(proved);
                (Some(claims), None)
            }
            Err(CheckError::Rejected(violation)) => (None, Some(explain::<A>(&violation, points))),
            Err(error) => return Err(format!("{}: {error}", points.name())),
        };
        let report = Report { found: solution, points: source, verdict: verdict.take() };
        let (title, fields) = (report.title(), report.fields());
        *verdict = report.verdict;
        Ok(json!({
            "verified": claims.is_some(),
            "title": title,
            "fields": listed(&fields),
            "text": text(&title, &fields),
            "claims": claims.as_ref().map(|claims| listed(&claims.fields)),
            "verdict": match (&claims, &refusal) {
                (Some(claims), _) => claims.text(),
                (None, Some(why)) => format!("Rejected: {why}"),
                (None, None) => String::new(),
            },
        }))
    }

    fn picture(&self, points: &Opened) -> Result<String, String> {
        if let Some(why) = A::no_picture(&self.solution) {
            return Err(why.to_owned());
        }
        let report = Report { found: &self.solution, points: points.source(), verdict: None };
        let columns = points.columns(A::dim(&report));
        let claims =
            self.verdict.as_ref().map(|proved| A::claims(&self.solution, proved, points.source()));
        let proved_gap = claims.and_then(|claims| claims.gap);
        let options = DrawOptions { columns, proved_gap, ..DrawOptions::default() };
        let figures = A::figures(&self.solution, points.source(), &options)
            .map_err(|error| format!("{}: {error}", points.name()))?;
        let section = Section { figures: worth_drawing(figures), ..Section::default() };
        Ok(to_html(&Page { title: report.title(), sections: vec![section], ..Page::default() }))
    }

    fn json(&self) -> String {
        self.solution.to_json()
    }

    fn file(&self, points: &Opened, name: &str) -> Result<Vec<u8>, String> {
        (self.write)(&self.solution, points.source(), name)
    }
}

/// Why an answer was rejected, and where, as the command says it.
fn explain<A: Summary>(violation: &Violation, points: &Opened) -> String {
    let name = points.name();
    match violation.fault(points.source().len()) {
        // Points count from 0, rows of a file from 1.
        Fault::Row(row) => format!("{name}, row {}: {violation}", row + 1),
        Fault::Points => format!("{name} does not belong to {}: {violation}", A::FOUND),
        Fault::Answer => format!("{}: {violation}", A::FOUND),
    }
}

fn listed(fields: &[Field]) -> Vec<Value> {
    let one = |Field { name, value, remark, standing, .. }: &Field| {
        let standing = standing.map(|standing| standing.word());
        json!({ "name": name, "value": value, "remark": remark, "standing": standing })
    };
    fields.iter().map(one).collect()
}
