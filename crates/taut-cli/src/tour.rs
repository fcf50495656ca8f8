//! `taut tour`: every tool on a sample of its own, checked, on one page with pictures.

mod stations;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use anyhow::{anyhow, bail};
use taut::{BallOptions, Violation, ball_of_source};
use taut_draw::{Fact, Page, Section, to_html};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::numbers::{exact, gap, seconds, short};
use crate::picture::{Look, facts, figures, telling};
use crate::reading::Opened;
use crate::report::Report;
use crate::verify::judge;
use crate::watch::Watch;
use crate::writing::{self, Outputs};
use stations::{STATIONS, Station};

/// See every tool at work on samples: one page with pictures, each answer checked.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Exit: 0 each answer verified · 1 a check failed
Example: taut tour --open")]
pub(crate) struct Args {
    /// The page
    #[arg(short, long, value_name = "FILE", default_value = "tour.html")]
    out: PathBuf,
    /// Show the page in the browser
    #[arg(long)]
    open: bool,
    /// Write the samples to this folder too, to try the commands of the page
    #[arg(long, value_name = "DIR")]
    samples: Option<PathBuf>,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        self.look_at_places()?;
        let watch = self.effort.start()?;
        let mut outcome = Outcome::Done;
        let mut sections = Vec::new();
        // Where the page goes to standard output, nothing else does.
        let say = |line: &str| match self.effort.quiet || writing::is_stream(&self.out) {
            true => Ok(()),
            false => writing::say(line.as_bytes()),
        };
        for station in STATIONS {
            let clock = Instant::now();
            let stop = visit(station, &watch)
                .map_err(|error| anyhow!("sample {}: {error}", station.file))?;
            let verified = if stop.verified { "yes" } else { "NO" };
            if !stop.verified {
                outcome = Outcome::CheckFailed;
            }
            say(&format!(
                "{:<24}{:<44} verified {verified:<4} {}\n",
                station.heading,
                stop.said,
                seconds(clock.elapsed())
            ))?;
            sections.push(stop.section);
        }
        let mut outputs = Outputs::default();
        if let Some(folder) = &self.samples {
            for station in STATIONS {
                outputs.add(&folder.join(station.file), station.bytes)?;
            }
        }
        outputs.add(&self.out, page(sections).as_bytes())?;
        if !self.effort.quiet && !writing::is_stream(&self.out) {
            let name = self.out.display().to_string();
            outputs.say(&format!("The page is {}\n", writing::printable(&name)));
        }
        outputs.finish()?;
        if self.open {
            show(&self.out);
        }
        Ok(outcome)
    }

    /// Refuses what could not be written in the end, and makes the folder for the samples.
    fn look_at_places(&self) -> anyhow::Result<()> {
        let name = self.out.display();
        if self.out.extension().is_some_and(|e| e != "html" && e != "htm") {
            bail!("{name}: the tour is a page of HTML; name it .html");
        }
        if self.open && writing::is_stream(&self.out) {
            bail!("--open shows a file, but the page goes to standard output: name a file with -o");
        }
        if let Some(folder) = &self.samples {
            std::fs::create_dir_all(folder)
                .map_err(|source| anyhow!("{}: could not be made: {source}", folder.display()))?;
        }
        writing::look_at(&[&self.out], &[])
    }
}

/// What came of a station.
struct Stop {
    section: Section,
    said: String,
    verified: bool,
}

fn visit(station: &Station, watch: &Watch) -> anyhow::Result<Stop> {
    let points = Opened::of_bytes(station.bytes, station.file)?;
    let options = BallOptions { epsilon: 0.0, ..BallOptions::default() };
    let found = watch
        .during("solving", |monitor| {
            ball_of_source(points.source(), station.items, &options, monitor)
        })
        .map_err(|error| points.explain(error))?;

    let mut verdict = None;
    let mut verified = true;
    let mut further = Vec::new();
    match judge(&found, &points, watch)? {
        Ok(proved) => verdict = Some(proved),
        Err(violation) => {
            verified = false;
            further.push(Fact::new(
                "rejected",
                points.explain_violation(&violation, "the ball found"),
            ));
        }
    }
    if station.doctored {
        let mut doctored = found.clone();
        doctored.answer.radius *= 1.0 - 1e-6;
        match judge(&doctored, &points, watch)? {
            Err(Violation::Outside { row, excess, .. }) => further.push(Fact::new(
                "a millionth smaller",
                format!("rejected: point {row} is outside by {}", gap(excess)),
            )),
            _ => verified = false,
        }
    }
    let report = Report { found: &found, points: &points, verdict };
    let said = match verdict {
        Some(proved) => {
            format!("radius {:<12} gap {}", short(found.answer.radius), gap(proved.gap))
        }
        None => format!("radius {}", exact(found.answer.radius)),
    };
    let section = Section {
        heading: station.heading.to_owned(),
        text: station.text.to_owned(),
        command: station.command.to_owned(),
        facts: facts(&report).into_iter().chain(further).collect(),
        figures: telling(figures(&report, &Look::default())?),
    };
    Ok(Stop { section, said, verified })
}

fn page(sections: Vec<Section>) -> String {
    to_html(&Page {
        title: "A tour of taut".to_owned(),
        intro: "Tight shapes around, through and inside point sets, with proof. Each section shows one tool on one \
                sample, the command that does the same, and what was found.\n\n\
                Verified means: a checker that shares no code with the solver read the points again, found every \
                one of them inside, and proved from the certificate that no smaller ball could hold them all."
            .to_owned(),
        sections,
        footer: format!("Made by taut {}: taut tour. The samples: taut tour --samples DIR.", env!("CARGO_PKG_VERSION")),
    })
}

/// Hands the page to whatever the system opens pages with.
fn show(page: &Path) {
    let (program, words): (_, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        "windows" => ("cmd", &["/C", "start", ""]),
        _ => ("xdg-open", &[]),
    };
    let status = Command::new(program).args(words).arg(page).status();
    if !status.is_ok_and(|status| status.success()) {
        let page = page.display();
        writing::complain(&format!("no browser could be started: open {page} by hand"));
    }
}
