//! The report about centers.

use taut::certify::Centers;
use taut::certify::{CentersCertificate, LowerBound, Placement};
use taut::points::PointSource;
use taut::{Items, Solution};

use crate::numbers::{abridged, coordinates, count, counted, exact, gap};
use crate::{Claims, Field, Report, Summary, noun, rows_of, share, stopped};

/// The coordinates of at most this many centers are shown; more are in the JSON.
const SHOWN_CENTERS_MAX: usize = 20;

impl Summary for Centers {
    const FOUND: &'static str = "the centers found";

    fn title(report: &Report<'_, Self>) -> String {
        let certificate = &report.found.certificate;
        let centers = match certificate.placement {
            Placement::Free => counted(certificate.k, "center"),
            Placement::Rows => format!("{} among them", counted(certificate.k, "center")),
        };
        let items = items_of(certificate, report.points.len(), Self::dim(report));
        format!("{items}: {centers}")
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let (trace, noun) = (&report.found.trace, noun(certificate.items));
        let mut fields = report.centers();
        let [radius, lower] = [answer.radius, answer.lower_bound].map(exact);
        let counts = if answer.outliers.is_empty() { "" } else { " that counts" };
        let together = if certificate.group.is_some() { ", all of a group of one" } else { "" };
        fields.extend([
            Field::new("radius", radius).remark(format!(
                "no {noun}{counts} is farther from the center next to it{together}"
            )),
            Field::new("lower bound", &*lower)
                .remark(format!("no {} have a smaller radius", counted(certificate.k, "center"))),
        ]);
        fields.push(match &report.verdict {
            Some(proved) => gap_of(answer, proved.gap),
            None => gap_of(answer, certificate.gap).remark("as the solver says"),
        });
        fields.push(match &report.verdict {
            Some(_) => Field::new("verified", "yes").remark(format!(
                "every {noun}{counts} is in a ball{together}, and the gap is proved"
            )),
            None => Field::new("verified", "not checked"),
        });
        if certificate.outliers > 0 {
            fields.push(rows_of("left out", &answer.outliers));
        }
        fields.push(Field::new("method", &*trace.method).remark(stopped(trace.stop)));
        let proof = match certificate.proof {
            LowerBound::Separated => match certificate.group {
                None => "no two of which fit in one ball".to_owned(),
                Some(_) => "no two of whose groups fit in one ball".to_owned(),
            },
            LowerBound::Branches { ref items } | LowerBound::Avoiding { ref items, .. } => {
                format!("with {} of a search", counted_branches(items.len() as u64))
            }
            LowerBound::Nogoods { ref nogoods } => {
                format!(
                    "with {} that fewer balls do not hold",
                    counted(nogoods.len() as u64, "set")
                )
            }
        };
        let core_set = match certificate.items {
            Items::Ellipsoids => {
                let points = counted(certificate.core_set.len() as u64, "point");
                format!("{points} of {}", counted(different(&certificate.core_set), noun))
            }
            _ => counted(certificate.core_set.len() as u64, noun),
        };
        fields.extend([
            Field::new("nodes", count(trace.iterations)),
            match certificate.core_set.len() {
                0 => Field::new("core-set", core_set),
                _ => Field::new("core-set", core_set).remark(proof),
            },
            Field::new("passes", count(trace.passes)),
        ]);
        fields
    }

    fn dim(report: &Report<'_, Self>) -> usize {
        dim_of(&report.found.certificate, report.points.dim())
    }

    fn claims(found: &Solution<Self>, proved: &Self::Verdict, source: &dyn PointSource) -> Claims {
        let certificate = &found.certificate;
        let items = items_of(certificate, source.len(), dim_of(certificate, source.dim()));
        let noun = noun(certificate.items);
        let placement = match certificate.placement {
            Placement::Free => "anywhere".to_owned(),
            Placement::Rows => format!("among the {noun}s"),
        };
        let (left_out, rests_on) = match certificate.outliers {
            0 => (Field::proved("left out", "none"), String::new()),
            most => {
                let left_out = found.answer.outliers.len() as u64;
                let field = Field::proved("left out", share(left_out, source.len()));
                let thing = if certificate.group.is_some() { "group" } else { noun };
                let field = field.remark(format!("of at most {}", counted(most, thing)));
                (field, format!(", all but at most {}", count(most)))
            }
        };
        let bracket = format!("{} ≤ least radius ≤ {}", exact(proved.lower), exact(proved.upper));
        let (k, radius) = (count(certificate.k), exact(found.answer.radius));
        let fields = vec![
            Field::proved(
                "centers",
                format!("{}, {placement}", count(found.answer.centers.len() as u64)),
            )
            .remark(format!("of at most {k}")),
            left_out,
            Field::proved("bracket", bracket),
            Field::proved("gap", gap(proved.gap)).remark("relative, from the points alone"),
            Field::new("branches", count(proved.branches)).remark("replayed for the lower bound"),
        ];
        Claims {
            what: format!(
                "centers, k = {k}, {placement}, of radius {radius}, around {items}{rests_on}"
            ),
            gap: Some(proved.gap),
            fields,
        }
    }
}

impl Report<'_, Centers> {
    /// A line for each of the first centers: its place, of which row it is, how many are next to it.
    fn centers(&self) -> Vec<Field> {
        let answer = &self.found.answer;
        let mut sizes = vec![0u64; answer.centers.len()];
        for &center in &answer.assignment {
            if let Some(size) = sizes.get_mut(center as usize) {
                *size += 1;
            }
        }
        let mut fields = Vec::new();
        for (j, center) in answer.centers.iter().enumerate().take(SHOWN_CENTERS_MAX) {
            let name = match j {
                0 if answer.centers.len() == 1 => "center",
                0 => "centers",
                _ => "",
            };
            let mut place = coordinates(center, answer.radius);
            if abridged(center) {
                place += &format!(" {} in all", count(center.len() as u64));
            }
            let row = answer.rows.get(j).map(|row| format!("row {}", row.saturating_add(1)));
            let next = (!answer.assignment.is_empty())
                .then(|| format!("next to {}", counted(sizes[j], noun(self.items()))));
            let mut field = Field::new(name, place);
            let remarks: Vec<String> = [row, next].into_iter().flatten().collect();
            if !remarks.is_empty() {
                field = field.remark(remarks.join(", "));
            }
            field.rows = answer.rows.get(j).copied().into_iter().collect();
            fields.push(field);
        }
        if answer.centers.len() > SHOWN_CENTERS_MAX {
            let all = count(answer.centers.len() as u64);
            fields.push(Field::new("", format!("… {all} in all; the JSON holds them (-o FILE)")));
        }
        fields
    }

    fn items(&self) -> Items {
        self.found.certificate.items
    }
}

/// The gap, where there is a bound to have one.
fn gap_of(answer: &Centers, value: f64) -> Field {
    match answer.lower_bound > 0.0 || answer.radius == 0.0 {
        true => Field::new("gap", gap(value)),
        false => Field::new("gap", "none"),
    }
}

/// The number of different rows.
fn different(rows: &[u64]) -> u64 {
    let mut rows = rows.to_vec();
    rows.sort_unstable();
    rows.dedup();
    rows.len() as u64
}

fn counted_branches(branches: u64) -> String {
    format!("{} branch{}", count(branches), if branches == 1 { "" } else { "es" })
}

fn items_of(certificate: &CentersCertificate, rows: u64, dim: usize) -> String {
    let items = counted(rows, noun(certificate.items));
    let weights = if certificate.weights { " with weights" } else { "" };
    let groups = match certificate.group {
        Some(column) => format!(", grouped by column {column},"),
        None => String::new(),
    };
    format!("{items}{weights}{groups} in {}", counted(dim as u64, "dimension"))
}

/// The dimension of rows of so many columns.
fn dim_of(certificate: &CentersCertificate, columns: usize) -> usize {
    let columns = columns.saturating_sub(usize::from(certificate.group.is_some()));
    match certificate.weights {
        true => columns.saturating_sub(1),
        false => certificate.items.dim(columns),
    }
}
