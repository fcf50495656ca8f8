//! Surfaces with boundaries that no setting was chosen on: pieces of surfaces of fifteen classes, each with small holes and with larger
//! ones, in open mode. Rates of answers with the right parts, handles and boundary loops.

use super::samplers::{disk, lines};
use super::sheets::{Kind, Sheet, sheet};
use super::*;

/// The least radius of holes, in spacings, from and to.
const HOLES: [[f64; 2]; 2] = [[3.5, 6.0], [6.0, 12.0]];
/// Points of each sheet.
const COUNT: usize = 20_000;

/// How points lie on a sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    Random,
    Disk,
    /// Along lines, this many times as far from each other as points on them are at least.
    Lines(f64),
}

impl Way {
    /// The ways of the first section: spacings differ by at most 2 : 1 between directions.
    const EVEN_WAYS: [(Self, &'static str); 3] =
        [(Self::Random, "random"), (Self::Disk, "Poisson disk"), (Self::Lines(2.0), "lines 2:1")];
    /// The ways of the second section: spacings differ by 3 : 1 to 8 : 1 between directions.
    const SCAN_WAYS: [(Self, &'static str); 3] = [
        (Self::Lines(3.0), "lines 3:1"),
        (Self::Lines(5.0), "lines 5:1"),
        (Self::Lines(8.0), "lines 8:1"),
    ];

    /// The distance that holes have to be wide beside, over √(area/n): that of lines, where there are some.
    fn widest(self) -> f64 {
        match self {
            Way::Random | Way::Disk => 1.0,
            Way::Lines(ratio) => ratio.sqrt(),
        }
    }
}

/// What became of one sample.
struct Trial {
    kind: &'static str,
    way: &'static str,
    band: usize,
    cells: Value,
    is_right: bool,
}

/// Random points of a sheet, several for each one wanted, and its area.
fn pool(sheet: &Sheet, count: usize, seed: u64) -> Result<(Vec<Point>, f64)> {
    const STEP: f64 = 0.02;
    let (probes, area) = crossings(&sheet.field, 4000, STEP, seed)?;
    let on = probes.iter().filter(|&&point| sheet.has(point)).count();
    let share = on as f64 / probes.len() as f64;
    ensure!(share > 0.0, "nothing is left of the sheet");
    let wanted = (POOL * count) as f64 / share;
    let (mut points, _) = crossings(&sheet.field, (1.03 * wanted) as usize, STEP, seed + 1)?;
    points.retain(|&point| sheet.has(point));
    Ok((points, area * share))
}

fn trial(
    (kind, name): (Kind, &'static str),
    (way, way_name): (Way, &'static str),
    (band, count): (usize, usize),
    seed: u64,
) -> Result<Trial> {
    let [from, to] = HOLES[band];
    let holes = from * (to / from).powf(chances::<1>(1, seed)?[0][0]);
    // Holes change the area, and that the spacing.
    let mut spacing = (10.0 / count as f64).sqrt();
    for round in 0..3 {
        let rough = sheet(kind, holes * way.widest() * spacing, seed)?;
        let (_, area) = pool(&rough, 400, seed + 10 * round)?;
        spacing = (area / count as f64).sqrt();
    }
    let sheet = sheet(kind, holes * way.widest() * spacing, seed)?;
    let (pool, area) = pool(&sheet, count, seed + 100)?;
    let spacing = (area / count as f64).sqrt();
    let mut points = match way {
        Way::Random => pool[..count.min(pool.len())].to_vec(),
        Way::Disk => disk(&sheet.field, &pool, spacing),
        Way::Lines(ratio) => {
            lines(&sheet.field, &pool, spacing * ratio.sqrt(), spacing / ratio.sqrt())
        }
    };
    points.retain(|&point| sheet.has(point));
    let options = SurfaceOptions {
        method: SurfaceMethod::Tree(SurfaceMode::Open),
        threads: Some(1),
        ..Default::default()
    };
    let (found, seconds) = ours(&points, &options)?;
    let verdict = found.check(&Points::new(points.as_flattened(), 3)?)?;
    let judged = Judged::of(&points, &found.answer.triangles)?;
    let truth = (sheet.components, Some(sheet.genus), sheet.loops);
    let is_right = (judged.components, judged.genus, judged.loops) == truth
        && judged.bad_edges + judged.bad_vertices == 0;
    let head = json!({
        "class": name, "sampling": way_name, "seed": seed, "holes": holes, "points": points.len(),
        "truth": format!("{}/{}/{}", sheet.components, sheet.genus, sheet.loops),
        "right": is_right, "certified": verdict.certified, "seconds": seconds,
        "counters": found.trace.counters,
    });
    let cells = joined([head, judged.cells()]);
    Ok(Trial { kind: name, way: way_name, band, cells, is_right })
}

/// All classes and both sizes of holes, sampled in some ways.
fn judge(
    ways: [(Way, &'static str); 3],
    context: &Context,
    out: &mut Outcome,
) -> Result<Vec<Trial>> {
    let mut trials = vec![];
    for seed in context.seeds.clone() {
        let each: Vec<(usize, usize)> = (0..Kind::ALL.len())
            .flat_map(|kind| (0..HOLES.len()).map(move |band| (kind, band)))
            .collect();
        let found = each.into_par_iter().map(|(kind, band)| -> Result<Vec<Trial>> {
            let seed = 10_000 * seed + 1_000 * band as u64 + kind as u64;
            let size = (band, context.count(COUNT));
            ways.into_iter().map(|way| trial(Kind::ALL[kind], way, size, seed)).collect()
        });
        let found: Vec<Vec<Trial>> = context.pool()?.install(|| found.collect::<Result<_>>())?;
        trials.extend(found.into_iter().flatten());
    }
    let mut failures = Table::new(
        "class | sampling | seed | holes:1 | points | truth | components | genus | loops | bad edges | bad vertices | unused | certified",
    );
    trials
        .iter()
        .filter(|trial| !trial.is_right)
        .for_each(|trial| failures.push(trial.cells.clone()));
    out.table("not right", failures);
    let head = ways.map(|(_, name)| name).join(" | ");
    let mut table = Table::new(&format!("class | {head} | small holes | larger ones | all"));
    let rate = |some: &mut dyn Iterator<Item = &Trial>| {
        let (mut all, mut right) = (0, 0);
        some.for_each(|trial| {
            all += 1;
            right += usize::from(trial.is_right);
        });
        json!(format!("{right}/{all}"))
    };
    let names = Kind::ALL.map(|(_, name)| name);
    for class in names.iter().map(Some).chain([None]) {
        let own =
            || trials.iter().filter(move |trial| class.is_none_or(|name| trial.kind == *name));
        let mut cells = vec![json!(class.unwrap_or(&"all"))];
        for (_, way) in ways {
            cells.push(rate(&mut own().filter(|trial| trial.way == way)));
        }
        for band in 0..HOLES.len() {
            cells.push(rate(&mut own().filter(|trial| trial.band == band)));
        }
        cells.push(rate(&mut own()));
        table.push(cells);
    }
    out.table("right parts, handles and loops, by class, sampling and size of holes", table);
    out.keep("trials", json!(trials.iter().map(|trial| trial.cells.clone()).collect::<Vec<_>>()));
    let is_false = |trial: &&Trial| trial.cells["certified"] == true && !trial.is_right;
    out.keep("false certificates", json!(trials.iter().filter(is_false).count()));
    let wrong = trials.iter().filter(is_false).count() as f64 / trials.len() as f64;
    out.at_most("false certificates, of all answers,", wrong, [0.015, 0.005], Unit::Percent);
    Ok(trials)
}

fn share(trials: &[Trial]) -> f64 {
    trials.iter().filter(|trial| trial.is_right).count() as f64 / trials.len() as f64
}

/// Samples that are about as dense in all directions.
pub(in crate::surface) fn even(context: &Context, out: &mut Outcome) -> Result<()> {
    let trials = judge(Way::EVEN_WAYS, context, out)?;
    out.at_least("right loops", share(&trials), [0.75, 0.9], Unit::Percent);
    Ok(())
}

/// Scan lines that are much farther apart than points on them.
pub(in crate::surface) fn scans(context: &Context, out: &mut Outcome) -> Result<()> {
    let trials = judge(Way::SCAN_WAYS, context, out)?;
    out.at_least("right loops", share(&trials), 0.8, Unit::Percent);
    Ok(())
}
