//! `taut tour`: every tool on a sample of its own, checked, on one page with pictures.

mod hands;
mod inside;
mod memory;
mod stations;
mod tiles;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use anyhow::{anyhow, bail};
use taut::certify::{CentersViolation, NO_NEIGHBOR};
use taut::certify::{Ellipsoid, Triangulation, Violation};
use taut::{
    BallOptions, CentersOptions, CurveOptions, DelaunayOptions, EllipsoidOptions, InscribedOptions,
    Items, RobustOptions, Solution, SurfaceOptions,
};
use taut_draw::{Field, Page, Section, to_html};

use crate::commands::verify::judge;
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::Opened;
use crate::output::numbers::{count, exact, gap, seconds, short};
use crate::output::picture::{Drawing, PictureOptions};
use crate::output::writing::{self, Outputs};
use crate::reports::surface::surface_of;
use crate::reports::{Report, Summary, worth_drawing};
use crate::watch::Watch;
use stations::{STATIONS, Station, Tool};

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
        let print_line = |line: &str| match self.effort.quiet || writing::is_stream(&self.out) {
            true => Ok(()),
            false => writing::print(line.as_bytes()),
        };
        let stops = STATIONS
            .iter()
            .map(|station| {
                let stop = || {
                    visit(station, &watch)
                        .map_err(|error| anyhow!("sample {}: {error}", station.file))
                };
                (station.heading, Box::new(stop) as Box<dyn Fn() -> anyhow::Result<Stop>>)
            })
            .chain([
                (tiles::HEADING, Box::new(tiles::stop) as _),
                (hands::HEADING, Box::new(hands::stop) as _),
                (memory::HEADING, Box::new(memory::stop) as _),
            ]);
        for (heading, stop) in stops {
            let clock = Instant::now();
            let stop = stop()?;
            let verified = if stop.verified { "yes" } else { "NO" };
            if !stop.verified {
                outcome = Outcome::CheckFailed;
            }
            print_line(&format!(
                "{heading:<37}{:<44} verified {verified:<4} {}\n",
                stop.summary,
                seconds(clock.elapsed())
            ))?;
            sections.push(stop.section);
        }
        let mut outputs = Outputs::default();
        if let Some(folder) = &self.samples {
            let mut written = BTreeSet::new();
            for station in STATIONS.iter().filter(|station| written.insert(station.file)) {
                outputs.add(&folder.join(station.file), station.bytes)?;
            }
        }
        outputs.add(&self.out, page(sections).as_bytes())?;
        if !self.effort.quiet && !writing::is_stream(&self.out) {
            let name = self.out.display().to_string();
            outputs.print(&format!("The page is {}\n", writing::printable(&name)));
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
        writing::check_writable(&[&self.out], &[])
    }
}

struct Stop {
    section: Section,
    summary: String,
    verified: bool,
}

fn visit(station: &Station, watch: &Watch) -> anyhow::Result<Stop> {
    let points = Opened::of_bytes(station.bytes, station.file)?;
    match station.tool {
        Tool::Ball(items) => ball(station, items, &points, watch),
        Tool::Ellipsoid => ellipsoid(station, &points, watch),
        Tool::Robust => robust(station, &points, watch),
        Tool::Inscribed => inscribed(station, &points, watch),
        Tool::Ellipse => inside::ellipse(station, &points, watch),
        Tool::Bodies(bodies) => inside::bodies(station, bodies, &points, watch),
        Tool::Centers(k) => centers(station, k, &points, watch),
        Tool::Delaunay => triangulation(station, &points, watch),
        Tool::Curve => curves(station, &points, watch),
        Tool::Surface => surfaces(station, &points, watch),
    }
}

fn ball(station: &Station, items: Items, points: &Opened, watch: &Watch) -> anyhow::Result<Stop> {
    let options = BallOptions { epsilon: 0.0, ..BallOptions::default() };
    let found = watch
        .during("solving", |monitor| {
            taut::ball(
                points.source(),
                &BallOptions { inputs: items, monitor: *monitor, ..options },
            )
        })
        .map_err(|error| points.explain(error))?;
    let doctor = || {
        let mut doctored = found.clone();
        doctored.answer.radius *= 1.0 - 1e-6;
        doctored
    };
    checked_and_drawn(station, &found, points, watch, ("a millionth smaller", &doctor), |verdict| {
        match verdict {
            Some(proved) => {
                format!("radius {:<12} gap {}", short(found.answer.radius), gap(proved.gap))
            }
            None => format!("radius {}", exact(found.answer.radius)),
        }
    })
}

fn ellipsoid(station: &Station, points: &Opened, watch: &Watch) -> anyhow::Result<Stop> {
    let options = EllipsoidOptions { epsilon: 0.0, ..EllipsoidOptions::default() };
    let found = watch
        .during("solving", |monitor| {
            taut::ellipsoid(points.source(), &EllipsoidOptions { monitor: *monitor, ..options })
        })
        .map_err(|error| points.explain(error))?;
    let doctor = || a_millionth_flatter(&found);
    checked_and_drawn(station, &found, points, watch, ("a millionth flatter", &doctor), |verdict| {
        volume_and_gap(found.answer.log_volume, verdict.map(|proved| proved.gap))
    })
}

fn inscribed(station: &Station, sides: &Opened, watch: &Watch) -> anyhow::Result<Stop> {
    let options = InscribedOptions::default();
    let found = watch
        .during("solving", |monitor| {
            taut::inscribed_ellipsoid(
                sides.source(),
                &InscribedOptions { monitor: *monitor, ..options },
            )
        })
        .map_err(|error| sides.explain(error))?;
    let doctor = || {
        let mut doctored = found.clone();
        doctored.answer.axes.iter_mut().for_each(|row| row[0] *= 1.0 + 1e-6);
        doctored.answer.log_volume += f64::ln_1p(1e-6);
        doctored
    };
    checked_and_drawn(station, &found, sides, watch, ("a millionth longer", &doctor), |verdict| {
        volume_and_gap(found.answer.log_volume, verdict.map(|proved| proved.gap))
    })
}

fn robust(station: &Station, points: &Opened, watch: &Watch) -> anyhow::Result<Stop> {
    let options = RobustOptions::default();
    let found = watch
        .during("solving", |monitor| {
            taut::robust_ellipsoid(points.source(), &RobustOptions { monitor: *monitor, ..options })
        })
        .map_err(|error| points.explain(error))?;
    let doctor = || {
        let mut doctored = found.clone();
        doctored.answer.flagged.pop();
        doctored
    };
    checked_and_drawn(station, &found, points, watch, ("an outlier less", &doctor), |_| {
        let outliers = count(found.answer.flagged.len() as u64);
        format!("{outliers} outliers of {} points", count(points.source().len()))
    })
}

fn centers(station: &Station, k: usize, points: &Opened, watch: &Watch) -> anyhow::Result<Stop> {
    let options = CentersOptions { epsilon: 1e-6, ..CentersOptions::default() };
    let found = watch
        .during("solving", |monitor| {
            taut::centers(points.source(), k, &CentersOptions { monitor: *monitor, ..options })
        })
        .map_err(|error| points.explain(error))?;
    let doctor = || {
        let mut doctored = found.clone();
        // The lower bound as well, or the two would contradict each other.
        doctored.answer.radius *= 1.0 - 1e-6;
        doctored.answer.lower_bound *= 1.0 - 1e-6;
        doctored
    };
    checked_and_drawn(station, &found, points, watch, ("a millionth smaller", &doctor), |verdict| {
        let radius = short(found.answer.radius);
        match verdict {
            Some(proved) => format!("radius {radius:<12} gap {}", gap(proved.gap)),
            None => format!("radius {radius}"),
        }
    })
}

fn volume_and_gap(volume: f64, proved: Option<f64>) -> String {
    let volume = short(volume);
    match proved {
        Some(proved) => format!("log-volume {volume:<12} gap {}", gap(proved)),
        None => format!("log-volume {volume}"),
    }
}

/// The ellipsoid with one row of F longer by a millionth, so flatter, and all else to match.
fn a_millionth_flatter(found: &Solution<Ellipsoid>) -> Solution<Ellipsoid> {
    let mut doctored = found.clone();
    let Ellipsoid { factor, matrix, log_volume, .. } = &mut doctored.answer;
    if let Some(first) = factor.first_mut() {
        first.iter_mut().for_each(|f| *f *= 1.0 + 1e-6);
        *log_volume -= f64::ln_1p(1e-6);
    }
    for (i, row) in matrix.iter_mut().enumerate() {
        for (j, q) in row.iter_mut().enumerate() {
            *q = factor.iter().map(|f| f[i] * f[j]).sum();
        }
    }
    doctored
}

fn triangulation(station: &Station, points: &Opened, watch: &Watch) -> anyhow::Result<Stop> {
    let found = watch
        .during("solving", |monitor| {
            taut::delaunay(
                points.source(),
                &DelaunayOptions { monitor: *monitor, ..Default::default() },
            )
        })
        .map_err(|error| points.explain(error))?;
    let doctor = || with_an_edge_turned(&found);
    let counts = found.certificate.counts;
    checked_and_drawn(station, &found, points, watch, ("an edge turned", &doctor), |_| {
        format!("{} simplices, {} hull facets", count(counts.simplices), count(counts.hull))
    })
}

fn curves(station: &Station, points: &Opened, watch: &Watch) -> anyhow::Result<Stop> {
    let options = CurveOptions::default();
    let found = watch
        .during("solving", |monitor| {
            taut::curve(points.source(), &CurveOptions { monitor: *monitor, ..options })
        })
        .map_err(|error| points.explain(error))?;
    let doctor = || {
        let mut doctored = found.clone();
        // Onto another vertex of the same curve: its edges then cross, or a point lies outside the band.
        for curve in doctored.answer.curves.iter_mut().take(1) {
            let across = curve.vertices.len() / 2;
            curve.vertices[0] = curve.vertices[across];
        }
        doctored
    };
    checked_and_drawn(station, &found, points, watch, ("a vertex moved", &doctor), |verdict| {
        let closed = found.answer.curves.iter().filter(|curve| curve.closed).count();
        let band = verdict.map_or(found.certificate.band, |proved| proved.band);
        let curves = count(found.answer.curves.len() as u64);
        format!("{curves} curves, {closed} of them closed, band {}", short(band))
    })
}

fn surfaces(station: &Station, points: &Opened, watch: &Watch) -> anyhow::Result<Stop> {
    let options = SurfaceOptions::default();
    let found = watch
        .during("solving", |monitor| {
            taut::surface(points.source(), &SurfaceOptions { monitor: *monitor, ..options.clone() })
        })
        .map_err(|error| points.explain(error))?;
    let doctor = || {
        let mut doctored = found.clone();
        doctored.answer.triangles.iter_mut().take(1).for_each(|triangle| triangle.swap(0, 1));
        doctored
    };
    checked_and_drawn(station, &found, points, watch, ("a triangle turned over", &doctor), |_| {
        let triangles = count(found.answer.triangles.len() as u64);
        format!("{triangles} triangles: {}", surface_of(&found))
    })
}

/// The triangulation with the other diagonal in the first two triangles that share an edge.
fn with_an_edge_turned(found: &Solution<Triangulation>) -> Solution<Triangulation> {
    let mut doctored = found.clone();
    // Without neighbors the checker finds them by itself, as in a file of bare triangles.
    let neighbors = std::mem::take(&mut doctored.certificate.neighbors);
    let simplices = &mut doctored.answer.simplices;
    let Some(facet) = neighbors.iter().position(|&across| across != NO_NEIGHBOR) else {
        return doctored;
    };
    let (first, second) = (facet / 3 * 3, neighbors[facet] as usize * 3);
    let [a, b, c] = [0, 1, 2].map(|i| simplices[first + (facet + i - first) % 3]);
    let beyond = simplices[second..second + 3].iter().find(|&id| ![a, b, c].contains(id));
    if let Some(&d) = beyond {
        simplices[first..first + 3].copy_from_slice(&[a, b, d]);
        simplices[second..second + 3].copy_from_slice(&[a, d, c]);
    }
    doctored
}

/// Checks an answer, and where the station says so a doctored one, which must be rejected; then tells and draws.
fn checked_and_drawn<A: Summary>(
    station: &Station,
    found: &Solution<A>,
    points: &Opened,
    watch: &Watch,
    (name, doctored): (&str, &dyn Fn() -> Solution<A>),
    summary: impl FnOnce(Option<&A::Verdict>) -> String,
) -> anyhow::Result<Stop> {
    let (mut verified, mut further) = (true, Vec::new());
    let verdict = match judge(found, points, watch)? {
        Ok(verdict) => Some(verdict),
        Err(violation) => {
            let why = points.explain_violation(&violation, A::FOUND);
            further.push(Field::new("rejected", why));
            verified = false;
            None
        }
    };
    if station.doctored {
        match judge(&doctored(), points, watch)? {
            Err(violation) => {
                further.push(Field::new(name, format!("rejected: {}", in_short(&violation))));
            }
            Ok(_) => verified = false,
        }
    }
    let summary = summary(verdict.as_ref());
    let report = Report { found, points: points.source(), verdict };
    let drawing = Drawing::of(&report, points, &PictureOptions::default())?;
    let section = Section {
        heading: station.heading.to_owned(),
        text: station.text.to_owned(),
        command: station.command.to_owned(),
        fields: drawing.fields.into_iter().chain(further).collect(),
        figures: worth_drawing(drawing.figures),
    };
    Ok(Stop { section, summary, verified })
}

/// Why a doctored answer was rejected, with as many digits as a page needs.
fn in_short(violation: &Violation) -> String {
    match violation {
        Violation::Outside { row, excess, .. }
        | Violation::Centers(CentersViolation::Outside { row, excess, .. })
        | Violation::OutsideEllipsoid { row, excess, .. } => {
            format!("point {row} is outside by {}", gap(*excess))
        }
        Violation::OutsideHalfSpace { row, excess } => {
            format!("half-space {row} is crossed by {}", gap(*excess))
        }
        other => other.to_string(),
    }
}

fn page(sections: Vec<Section>) -> String {
    to_html(&Page {
        title: "A tour of taut".to_owned(),
        intro: "Tight shapes around, through and inside point sets, with proof. Each section shows one tool on one \
                sample, the command that does the same, and what was found.\n\n\
                Verified means: a checker that shares no code with the solver read the points again and proved the \
                answer from its certificate: every point is inside and no smaller shape of its kind, and no eight smaller \
                discs, could hold them all, or none larger could fit; the triangles are those of Delaunay and there are no others; the curves meet nowhere and no point but the outliers \
                leaves their band; the surface has the parts and handles that are told and meets itself nowhere; no count of \
                misses is above its bound. Of \
                outliers it proves all but that no other half of the points lies closer together."
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
        writing::print_error(&format!("no browser could be started: open {page} by hand"));
    }
}
