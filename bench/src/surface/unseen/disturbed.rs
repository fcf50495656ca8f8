//! Smooth closed shapes of 5·10⁴ random points with noise, and with outliers: the pre-pass, beside CGAL's advancing front.

use std::collections::BTreeSet;

use super::shapes::{Class, RADIUS_MAX, shape};
use super::*;

/// Points of each shape.
const COUNT: usize = 50_000;
/// Shapes of each class.
const DRAWS: u64 = 2;
/// Classes without sharp edges.
const SMOOTH: [(Class, &str); 6] = [
    (Class::Blend, "blend"),
    (Class::Links, "links"),
    (Class::Balls, "balls"),
    (Class::Knot, "knot"),
    (Class::Coil, "coil"),
    (Class::Shells, "shells"),
];
/// The least width of walls and gaps that is asked for. (Of some shapes it is a little less.)
const THICKNESS: f64 = 0.25;

struct Smooth {
    name: &'static str,
    shape: Shape,
    points: Vec<Point>,
    diagonal: f64,
    seed: u64,
}

/// The shapes of one seed.
fn shapes(context: &Context) -> Result<Vec<Smooth>> {
    let mut all = vec![];
    for seed in context.seeds.clone() {
        for (k, draw) in (0..SMOOTH.len()).flat_map(|k| (0..DRAWS).map(move |draw| (k, draw))) {
            let (class, name) = SMOOTH[k];
            let seed = 10_000 * seed + 100 * k as u64 + draw;
            let shape = shape(class, THICKNESS, seed)?;
            let (points, _) = crossings(&shape.field, context.count(COUNT), 0.02, seed + 200)?;
            let side = |k: usize| {
                let all = || points.iter().map(|point| point[k]);
                all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min)
            };
            let diagonal = length([0, 1, 2].map(side));
            all.push(Smooth { name, shape, points, diagonal, seed });
        }
    }
    Ok(all)
}

/// Right parts and handles, closed; points may be unused.
fn is_right(judged: &Judged, shape: &Shape) -> bool {
    Judged { unused: 0, ..*judged }.is_exact(shape.components, shape.genus)
}

/// Noise of 0.1 and 0.5 % of the diagonal.
pub(in crate::surface) fn noise(context: &Context, out: &mut Outcome) -> Result<()> {
    let mut table = Table::new(
        "class | seed | noise:% | truth | program | components | genus | loops | bad edges | bad vertices | unused | right | certified | to the result 1e-4:2 | from the result 1e-4:2 | time:s | why",
    );
    let shapes = shapes(context)?;
    for (sigma, bounds) in [(0.001, [0.95, 0.95]), (0.005, [0.6, 0.9])] {
        let each = shapes.par_iter().map(|smooth| -> Result<_> {
            let Smooth { name, shape, points, diagonal, seed } = smooth;
            let (clean, _) = ours(points, &SurfaceOptions { threads: Some(1), ..Default::default() })?;
            let reference = Mesh::of_triangles(points.clone(), &clean.answer.triangles);
            let noisy = noisy(points, sigma * diagonal, seed + 7)?;
            let mut rows = vec![];
            let mut add = |who: &str, places: &[Point], triangles: &[[u32; 3]], rest: Value| -> Result<_> {
                let judged = Judged::of(places, triangles)?;
                let distances = Distances::of(&reference, places, triangles)?;
                let head = json!({
                    "class": name, "seed": seed, "noise": sigma, "program": who,
                    "truth": format!("{}/{}", shape.components, shape.genus),
                    "right": is_right(&judged, shape),
                    "to the result 1e-4": 1e4 * distances.missed.mean,
                    "from the result 1e-4": 1e4 * distances.invented.mean,
                });
                rows.push(joined([head, judged.cells(), rest]));
                Ok((is_right(&judged, shape), distances))
            };
            let denoise = Some(Denoise::default());
            let options = SurfaceOptions { denoise, threads: Some(1), ..Default::default() };
            let (found, seconds) = ours(&noisy, &options)?;
            let certified = found.check(&Points::new(noisy.as_flattened(), 3)?)?.certified;
            let rest = json!({ "certified": certified, "time": seconds, "counters": found.trace.counters });
            let (right, own) =
                add("taut, pre-pass", &found.answer.vertices, &found.answer.triangles, rest)?;
            let front = match theirs(context, FRONT, &noisy)? {
                Ok(theirs) => {
                    let rest = json!({ "time": theirs.first + theirs.second });
                    let (right, front) = add(FRONT, &noisy, &theirs.triangles, rest)?;
                    Some((right, (own.missed.mean + own.invented.mean) / (front.missed.mean + front.invented.mean)))
                }
                Err(why) => {
                    rows.push(json!({ "class": name, "seed": seed, "noise": sigma, "program": FRONT, "why": why }));
                    None
                }
            };
            Ok((rows, right, certified, front))
        });
        let each: Vec<_> = context.pool()?.install(|| each.collect::<Result<Vec<_>>>())?;
        each.iter().flat_map(|one| &one.0).for_each(|row| table.push(row.clone()));
        let share = |count: usize| count as f64 / each.len() as f64;
        let percent = 100.0 * sigma;
        let right = share(each.iter().filter(|one| one.1).count());
        out.at_least(format!("noise {percent} %: right topology"), right, bounds, Unit::Percent);
        let wrong = share(each.iter().filter(|one| one.2 && !one.1).count());
        out.at_most(
            format!("noise {percent} %: false certificates"),
            wrong,
            [0.015, 0.005],
            Unit::Percent,
        );
        let front: Vec<_> = each.iter().filter_map(|one| one.3).collect();
        let worst = front.iter().map(|one| one.1).reduce(f64::max);
        out.at_most(
            format!("noise {percent} %: mean distance over the advancing front's, the largest"),
            worst,
            1.0,
            Unit::Times,
        );
        let theirs = front.iter().filter(|one| one.0).count() as f64 / front.len() as f64;
        out.keep(&format!("advancing front, right at {percent} %"), json!(theirs));
    }
    out.table("", table);
    Ok(())
}

/// One outlier for a hundred points, anywhere in a box a tenth wider than the shape.
///
/// With noise of a sixth to a third of a spacing, more outliers than a twentieth lie as near to the surface as its own points do: their recall is
/// only an aim.
pub(in crate::surface) fn outliers(context: &Context, out: &mut Outcome) -> Result<()> {
    let mut table = Table::new(
        "class | seed | noise:% | truth | components | genus | loops | bad edges | bad vertices | right | added | named | of them added | recall:% | precision:% | certified",
    );
    let shapes = shapes(context)?;
    let mut sums = vec![];
    for sigma in [0.0, 0.001] {
        let each = shapes.par_iter().map(|smooth| -> Result<_> {
            let Smooth { name, shape, points, diagonal, seed } = smooth;
            let mut all = noisy(points, sigma * diagonal, seed + 7)?;
            let added = points.len() / 100;
            let ends = [0, 1, 2].map(|k| {
                let on = || points.iter().map(|point| point[k]);
                let (low, high) =
                    (on().fold(RADIUS_MAX, f64::min), on().fold(-RADIUS_MAX, f64::max));
                [low - 0.05 * (high - low), high + 0.05 * (high - low)]
            });
            let place =
                |lot: [f64; 3]| [0, 1, 2].map(|k| ends[k][0] + (ends[k][1] - ends[k][0]) * lot[k]);
            all.extend(chances::<3>(added, seed + 8)?.into_iter().map(place));
            let denoise = Some(Denoise::default());
            let options = SurfaceOptions { denoise, threads: Some(1), ..Default::default() };
            let (found, _) = ours(&all, &options)?;
            let certified = found.check(&Points::new(all.as_flattened(), 3)?)?.certified;
            let named: BTreeSet<u32> = found.answer.unused.outliers.iter().copied().collect();
            let hit = named.range(points.len() as u32..).count();
            let judged = Judged::of(&found.answer.vertices, &found.answer.triangles)?;
            let right = is_right(&judged, shape);
            let row = json!({
                "class": name, "seed": seed, "noise": sigma, "right": right, "certified": certified,
                "truth": format!("{}/{}", shape.components, shape.genus),
                "added": added, "named": named.len(), "of them added": hit,
                "recall": hit as f64 / added as f64,
                "precision": hit as f64 / named.len().max(1) as f64,
            });
            Ok((joined([row, judged.cells()]), right, certified, [hit, added, named.len()]))
        });
        let each: Vec<_> = context.pool()?.install(|| each.collect::<Result<Vec<_>>>())?;
        each.iter().for_each(|one| table.push(one.0.clone()));
        sums.push((sigma, each));
    }
    out.table("", table);
    for (sigma, each) in sums {
        let what = |text: &str| format!("noise {} %: {text}", 100.0 * sigma);
        let sum = |k: usize| each.iter().map(|one| one.3[k]).sum::<usize>() as f64;
        let share = |count: usize| count as f64 / each.len() as f64;
        let bounds = if sigma > 0.0 { aim_only(0.95) } else { 0.95.into() };
        out.at_least(what("recall"), sum(0) / sum(1), bounds, Unit::Percent);
        out.at_least(what("precision"), sum(0) / sum(2), 0.95, Unit::Percent);
        let right = share(each.iter().filter(|one| one.1).count());
        out.at_least(what("right topology"), right, 0.9, Unit::Percent);
        let wrong = share(each.iter().filter(|one| one.2 && !one.1).count());
        out.at_most(what("false certificates"), wrong, [0.015, 0.005], Unit::Percent);
    }
    Ok(())
}
