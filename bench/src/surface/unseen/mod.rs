//! Inputs that no setting was chosen on: closed bodies of sixteen classes, sampled in three ways, with the thinnest wall or gap from 1.2 to
//! 6 spacings. Rates of exact answers by class, and of certificates that are false.

mod bordered;
mod disturbed;
mod fields;
mod samplers;
mod shapes;
mod sheets;

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::*;
use fields::length;
use samplers::{Sampling, crossings, sample};
use shapes::{Class, RADIUS_MAX, Shape, shape};

pub(super) use bordered::{even, scans};
pub(super) use disturbed::{noise, outliers};

/// Shapes of each class, each in its own band of thickness.
const BANDS: [[f64; 2]; 4] = [[1.2, 2.0], [2.0, 3.0], [3.0, 4.5], [4.5, 6.0]];
/// Random points for each one wanted, from which the others are chosen.
const POOL: usize = 5;

/// One shape, ready to be sampled.
struct Subject {
    class: &'static str,
    shape: Shape,
    /// Points to be sampled, and √(area / that).
    count: usize,
    spacing: f64,
    pool: Vec<Point>,
}

impl Subject {
    /// The shape of a class whose thickness is in a band, in spacings of so many points.
    fn of(
        (class, name): (Class, &'static str),
        band: usize,
        count: usize,
        seed: u64,
    ) -> Result<Self> {
        const PROBES: usize = 2000;
        let [from, to] = BANDS[band];
        let share = chances::<1>(1, seed)?[0][0];
        let spacings = from * (to / from).powf(share);
        // The thickness changes the area, and that the spacing.
        let mut spacing = (12.0 / count as f64).sqrt();
        let mut shape = self::shape(class, spacings * spacing, seed)?;
        for round in 0..4 {
            let step = 0.1 * shape.thickness;
            let (_, area) = crossings(&shape.field, PROBES, step, seed + 100 + round)?;
            spacing = (area / count as f64).sqrt();
            shape = self::shape(class, spacings * spacing, seed)?;
        }
        let directions = generate(Distribution::Sphere, PROBES, 3, seed + 300)?;
        let is_out = |direction: &Point| shape.field.value(direction.map(|x| RADIUS_MAX * x)) > 0.0;
        let is_within = directions.as_chunks().0.iter().all(is_out);
        ensure!(is_within, "the shape reaches farther than {RADIUS_MAX}");
        let step = (0.05 * shape.thickness).min(0.1 * spacing);
        let (pool, area) = crossings(&shape.field, POOL * count, step, seed + 200)?;
        let spacing = (area / count as f64).sqrt();
        Ok(Self { class: name, shape, count, spacing, pool })
    }

    fn spacings(&self) -> f64 {
        self.shape.thickness / self.spacing
    }
}

/// What became of one sample.
#[derive(Clone, Debug)]
struct Trial {
    class: &'static str,
    sampling: &'static str,
    seed: u64,
    /// Thickness over spacing.
    spacings: f64,
    points: usize,
    judged: Judged,
    truth: (usize, u64),
    is_exact: bool,
    is_certified: bool,
    seconds: f64,
    counters: BTreeMap<String, u64>,
}

impl Trial {
    fn of(
        subject: &Subject,
        (sampling, name): (Sampling, &'static str),
        seed: u64,
    ) -> Result<Self> {
        let Subject { shape, spacing, .. } = subject;
        let points = sample(&shape.field, sampling, &subject.pool, (subject.count, *spacing));
        let options = SurfaceOptions { threads: Some(1), ..Default::default() };
        let (found, seconds) = ours(&points, &options)?;
        let verdict = found.check(&Points::new(points.as_flattened(), 3)?)?;
        let judged = Judged::of(&points, &found.answer.triangles)?;
        Ok(Self {
            class: subject.class,
            sampling: name,
            seed,
            spacings: subject.spacings(),
            points: points.len(),
            judged,
            truth: (shape.components, shape.genus),
            is_exact: judged.is_exact(shape.components, shape.genus),
            is_certified: verdict.certified,
            seconds,
            counters: found.trace.counters,
        })
    }

    fn cells(&self) -> Value {
        let head = json!({
            "class": self.class, "sampling": self.sampling, "seed": self.seed,
            "spacings": self.spacings, "points": self.points, "exact": self.is_exact,
            "certified": self.is_certified, "truth": format!("{}/{}", self.truth.0, self.truth.1),
            "seconds": self.seconds, "counters": self.counters,
        });
        joined([head, self.judged.cells()])
    }
}

/// How many of some trials are exact, in words.
fn rate<'a>(trials: impl Iterator<Item = &'a Trial>) -> String {
    let (mut all, mut exact) = (0, 0);
    for trial in trials {
        all += 1;
        exact += usize::from(trial.is_exact);
    }
    if all == 0 { String::new() } else { format!("{exact}/{all}") }
}

/// Tables of rates, and goals.
fn report(trials: &[Trial], out: &mut Outcome) {
    let mut failures = Table::new(
        "class | sampling | seed | spacings:1 | points | truth | components | genus | bad vertices | unused | certified",
    );
    trials.iter().filter(|trial| !trial.is_exact).for_each(|trial| failures.push(trial.cells()));
    out.table("not exact", failures);
    let mut table = Table::new(
        "class | –1.2 | 1.2–2 | 2–3 | 3–4.5 | 4.5– | random | Poisson disk | scan lines | all",
    );
    let mut row = |name: &str, some: &[&Trial]| {
        let mut cells = vec![json!(name)];
        let ends: Vec<f64> = BANDS.iter().map(|[from, _]| *from).collect();
        for band in 0..=BANDS.len() {
            let of = |trial: &Trial| ends.partition_point(|&end| end <= trial.spacings);
            cells.push(json!(rate(some.iter().filter(|trial| of(trial) == band).copied())));
        }
        for (_, sampling) in Sampling::ALL {
            cells
                .push(json!(rate(some.iter().filter(|trial| trial.sampling == sampling).copied())));
        }
        cells.push(json!(rate(some.iter().copied())));
        table.push(cells);
    };
    for (_, class) in Class::ALL {
        let some: Vec<&Trial> = trials.iter().filter(|trial| trial.class == class).collect();
        row(class, &some);
    }
    row("all", &trials.iter().collect::<Vec<_>>());
    out.table("exact, by class, thickness in spacings, and sampling", table);
    let share = |part: usize, all: usize| (all > 0).then(|| part as f64 / all as f64);
    let thick: Vec<&Trial> = trials.iter().filter(|trial| trial.spacings >= 2.0).collect();
    let exact = |some: &[&Trial]| some.iter().filter(|trial| trial.is_exact).count();
    let shown = share(exact(&thick), thick.len());
    out.at_least("exact at 2 spacings or more", shown, [0.92, 0.97], Unit::Percent);
    // What is thinner than the first band no sample of this spacing shows.
    let fair: Vec<&Trial> = trials.iter().filter(|trial| trial.spacings >= BANDS[0][0]).collect();
    let is_false = |trial: &&&Trial| trial.is_certified && !trial.is_exact;
    let wrong = share(fair.iter().filter(is_false).count(), fair.len());
    let name = "false certificates, of all answers at 1.2 spacings or more,";
    out.at_most(name, wrong, [0.015, 0.005], Unit::Percent);
    let right: Vec<&&Trial> = fair.iter().filter(|trial| trial.is_exact).collect();
    let kept = share(right.iter().filter(|trial| trial.is_certified).count(), right.len());
    let name = "certified, of the exact answers at 1.2 spacings or more,";
    out.at_least(name, kept, [0.9, 0.9], Unit::Percent);
    let seconds = trials.iter().map(|trial| trial.seconds).sum::<f64>();
    out.keep("trials", json!(trials.iter().map(Trial::cells).collect::<Vec<_>>()));
    out.keep("seconds", json!(seconds));
}

/// All classes, each band of thickness and each sampling, at so many points.
fn judge(count: usize, context: &Context, out: &mut Outcome) -> Result<()> {
    let mut trials = vec![];
    for seed in context.seeds.clone() {
        let each: Vec<(usize, usize)> = (0..Class::ALL.len())
            .flat_map(|class| (0..BANDS.len()).map(move |band| (class, band)))
            .collect();
        let found = each.into_par_iter().map(|(class, band)| -> Result<Vec<Trial>> {
            let seed = 10_000 * seed + 100 * class as u64 + band as u64;
            let subject = Subject::of(Class::ALL[class], band, count, seed)
                .with_context(|| format!("{} {seed}", Class::ALL[class].1))?;
            Sampling::ALL.into_iter().map(|way| Trial::of(&subject, way, seed)).collect()
        });
        let found: Vec<Vec<Trial>> = context.pool()?.install(|| found.collect::<Result<_>>())?;
        trials.extend(found.into_iter().flatten());
    }
    report(&trials, out);
    Ok(())
}

/// At 5000 points.
pub(super) fn small(context: &Context, out: &mut Outcome) -> Result<()> {
    judge(5_000, context, out)
}

/// At 20 000 points.
pub(super) fn middling(context: &Context, out: &mut Outcome) -> Result<()> {
    judge(20_000, context, out)
}

/// At 80 000 points.
pub(super) fn large(context: &Context, out: &mut Outcome) -> Result<()> {
    judge(80_000, context, out)
}
