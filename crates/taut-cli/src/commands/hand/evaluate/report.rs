//! The figures in words, as JSON, and as pictures.

use serde_json::{Value, json};
use taut::recognize::evaluate::{
    Contender, DetPoint, Interval, Protocol, ProtocolRates, ProtocolRow,
};
use taut_draw::{DetCurve, Field, det_figure};

use super::scans::Scans;
use crate::output::numbers::{count, counted};
use crate::output::picture::{Drawing, PictureOptions};

/// What the thesis says of its own scans (table 2): training scans, and the errors in percent of nearest boxes and of balls.
const THESIS: [(usize, [f64; 2]); 3] = [(3, [2.81, 1.53]), (4, [1.74, 0.94]), (5, [1.72, 0.39])];

/// What is reported.
pub(super) struct Report<'a> {
    pub(super) scans: &'a Scans,
    pub(super) contenders: &'a [Contender],
    pub(super) found: &'a Protocol,
    pub(super) splits: usize,
    pub(super) folds: usize,
    pub(super) far: f64,
    /// Where the scans come from.
    pub(super) heading: String,
}

impl Report<'_> {
    fn name(&self, row: &ProtocolRow) -> &str {
        &self.contenders[row.contender].name
    }

    pub(super) fn to_words(&self) -> String {
        let people = self.scans.people.len() as u64;
        let people =
            if people == 1 { "1 person".to_owned() } else { format!("{} people", count(people)) };
        let mut text = format!("{} of {people}\n", counted(self.scans.len() as u64, "scan"));
        text += &format!("  measured  all but {} (FTA)\n", percent(self.found.fta));
        for (reason, times) in self.scans.failures() {
            text += &format!("  refused   {times:>5}  {reason}\n");
        }
        text += &format!(
            "  protocol  {}; intervals have a confidence of 95 %\n",
            counted(self.splits as u64, "random split")
        );
        let mut before = None;
        for row in &self.found.rows {
            if before != Some(row.training) {
                text += &self.head_of(row);
                before = Some(row.training);
            }
            text += &self.line_of(row);
        }
        text += "\nNotes\n";
        let mut before = None;
        for row in &self.found.rows {
            if before != Some(row.training) {
                let which = [("", false), (", unseen people", true)];
                for (which, is_unseen) in which {
                    if let Some(warning) = self.impostors_warning(row, is_unseen) {
                        text += &format!("  {} training scans{which}: {warning}\n", row.training);
                    }
                }
                before = Some(row.training);
            }
        }
        for row in &self.found.rows {
            let rates = [("", &row.seen), (", unseen people", &row.unseen)];
            for (which, rates) in rates {
                if let Some(warning) = rates.warning {
                    text += &format!(
                        "  {}, {} training scans{which}, by different scans: {warning}\n",
                        self.name(row),
                        row.training
                    );
                }
            }
        }
        text
    }

    /// Says so if impostors are too few for the false acceptance rate that was asked for.
    ///
    /// Splits compare the same scans and people again and again; different comparisons are those of a scan with another person,
    /// of the same fold where people are unseen.
    fn impostors_warning(&self, row: &ProtocolRow, is_unseen: bool) -> Option<String> {
        let (rates, people) = match is_unseen {
            true => (&row.unseen, row.people.div_ceil(self.folds)),
            false => (&row.seen, row.people),
        };
        let different = rates.impostors.min(rates.samples * people.saturating_sub(1) as u64);
        // The rule of 3: so many trials without an error show the rate with a confidence of 95 %.
        let needed = (3.0 / self.far).ceil();
        ((different as f64) < needed).then(|| {
            format!(
                "{} of impostors, at most: {} are needed to tell rejections at FAR ≤ {} (rule of 3, confidence 95 %)",
                counted(different, "different comparison"),
                if needed < 1e15 { count(needed as u64) } else { "more than 10¹⁵".to_owned() },
                percent(self.far)
            )
        })
    }

    /// The words above the methods of one number of training scans.
    fn head_of(&self, row: &ProtocolRow) -> String {
        let mut text = format!(
            "\nTraining with {} of {} people (FTE {}), {} probes\n",
            counted(row.training as u64, "scan"),
            row.people,
            percent(row.fte),
            count(row.seen.probes)
        );
        if let Some((_, [boxes, balls])) = THESIS.iter().find(|known| known.0 == row.training) {
            text += &format!(
                "  the thesis on its own scans: nearest boxes {boxes} %, balls {balls} % not identified\n"
            );
        }
        let far = format!("FRR at FAR ≤ {}", percent(self.far));
        text += &format!(
            "  {:<21}{:>33}{:>9}{:>18}   unseen people:{:>20}{:>9}{:>18}{:>8}\n",
            "", "not identified, %", "EER, %", far, "not identified", "EER", far, "FNIR"
        );
        text
    }

    fn line_of(&self, row: &ProtocolRow) -> String {
        let part = |rates: &ProtocolRates| {
            format!(
                "{:>8.3} [{:>6.3}, {:>6.3}]{:>9.3}{:>18.3}",
                100.0 * rates.error_rate(),
                100.0 * rates.interval.low,
                100.0 * rates.interval.high,
                100.0 * rates.equal_error_rate,
                100.0 * rates.at.fnmr
            )
        };
        let open = row.open.map_or_else(String::new, |open| format!("{:>8.3}", 100.0 * open.fnir));
        let (seen, unseen) = (part(&row.seen), part(&row.unseen));
        format!("  {:<21}{seen:>60}{:>18}{unseen:>52}{open}\n", self.name(row), "")
    }

    pub(super) fn to_json(&self) -> String {
        let rows: Vec<Value> = self
            .found
            .rows
            .iter()
            .map(|row| {
                json!({
                    "method": self.name(row),
                    "training": row.training,
                    "people": row.people,
                    "fte": row.fte,
                    "seen": json_of(&row.seen),
                    "unseen": json_of(&row.unseen),
                    "impostors_warning": self.impostors_warning(row, false),
                    "unseen_impostors_warning": self.impostors_warning(row, true),
                    "open_set": row.open.map(|open| json!({
                        "unknown": open.unknown,
                        "enrolled": open.enrolled,
                        "fpir": open.fpir,
                        "fnir": open.fnir,
                    })),
                })
            })
            .collect();
        let thesis: Vec<Value> = THESIS
            .iter()
            .map(|(training, [boxes, balls])| {
                json!({ "training": training, "nearest_box_percent": boxes, "ball_percent": balls })
            })
            .collect();
        let value = json!({
            "scans": self.scans.len(),
            "people": self.scans.people.len(),
            "fta": self.found.fta,
            "failures": self.scans.failures(),
            "splits": self.splits,
            "far_max": self.far,
            "rows": rows,
            "thesis": thesis,
        });
        value.to_string() + "\n"
    }

    /// Trade-offs of verification and of identification, for the largest number of training scans.
    pub(super) fn drawing(&self, options: &PictureOptions) -> Drawing {
        let most = self.found.rows.iter().map(|row| row.training).max().unwrap_or(0);
        let rows = || self.found.rows.iter().filter(move |row| row.training == most);
        let curves = |of: &dyn Fn(&ProtocolRow) -> Vec<DetPoint>| -> Vec<DetCurve> {
            let curve = |row: &ProtocolRow| DetCurve {
                name: self.name(row).to_owned(),
                points: of(row).iter().map(|point| [point.fmr, point.fnmr]).collect(),
            };
            rows().map(curve).collect()
        };
        let caption = |what: &str| {
            format!(
                "{what} {}, {} training scans of each person, {} random splits.",
                self.heading, most, self.splits
            )
        };
        let options = options.options(vec![]);
        let figures = vec![
            det_figure(
                "Verification: people who were seen in training",
                &caption("Scores against the own person and against other ones."),
                curves(&|row| row.seen.det.clone()),
                &options,
            ),
            det_figure(
                "Verification: people from whom nothing was learned",
                &caption(
                    "Scores against the own person and against others of whom none was in the training of the method.",
                ),
                curves(&|row| row.unseen.det.clone()),
                &options,
            ),
            det_figure(
                "Identification: accepted under a wrong name, and rejected",
                &caption("The best of all people is named if it passes the threshold."),
                curves(&|row| row.seen.identification.clone()),
                &options,
            ),
        ];
        let field = |row: &ProtocolRow| {
            let errors = percent(row.seen.error_rate());
            Field::new(self.name(row), format!("{errors} not identified"))
        };
        Drawing {
            title: "People recognized by their hands".to_owned(),
            heading: self.heading.clone(),
            fields: rows().map(field).collect(),
            figures,
        }
    }
}

fn json_of(rates: &ProtocolRates) -> Value {
    let interval = |interval: Interval| json!([interval.low, interval.high]);
    json!({
        "probes": rates.probes,
        "errors": rates.errors,
        "error_rate": rates.error_rate(),
        "interval": interval(rates.interval),
        "scans": rates.samples,
        "scans_wrong": rates.samples_wrong,
        "warning": rates.warning.map(|warning| warning.to_string()),
        "equal_error_rate": rates.equal_error_rate,
        "threshold": rates.at.threshold,
        "fmr": rates.at.fmr,
        "fnmr": rates.at.fnmr,
        "fnmr_interval": interval(rates.fnmr_interval),
        "far": rates.transaction.far,
        "frr": rates.transaction.frr,
        "generalized_far": rates.transaction.generalized_far,
        "generalized_frr": rates.transaction.generalized_frr,
        "impostors": rates.impostors,
        "identification_frr": rates.rejected,
    })
}

/// A share in percent.
fn percent(share: f64) -> String {
    let shown = format!("{:.2}", 100.0 * share);
    format!("{} %", shown.trim_end_matches('0').trim_end_matches('.'))
}
