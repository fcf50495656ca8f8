//! Queries of sphere trees: the nearest row beside kiddo, and touching pairs of balls beside parry3d's hierarchy of boxes.
//!
//! All on one thread, as the peers have one, in processor time. Answers are compared before times: distances to the last bit, and pairs one by one.

use kiddo::{ImmutableKdTree, SquaredEuclidean};
use taut_certify::Items;
use taut_search::{QueryOptions, SphereSearch, SphereSearchOptions};

use super::*;

/// Balls have as many neighbors that touch them, on average.
const TOUCHING: f64 = 4.0;
/// The sides of the cube of far places, in units of that of the points.
const FAR_SIDE: f64 = 3.0;
/// How far near places are from a row, in units of the side of a cube that holds one row on average.
const NEAR_SHIFT: f64 = 0.5;

/// Points, as they are drawn.
#[derive(Clone, Copy)]
struct Cloud {
    law: Distribution,
    n: usize,
    dim: usize,
}

const NEAREST: [Cloud; 6] = [
    Cloud { law: Distribution::Uniform, n: 1_000_000, dim: 3 },
    Cloud { law: Distribution::Uniform, n: 100_000, dim: 3 },
    Cloud { law: Distribution::Clusters { count: 5, spread: 0.05 }, n: 1_000_000, dim: 3 },
    Cloud { law: Distribution::Sphere, n: 1_000_000, dim: 3 },
    Cloud { law: Distribution::Uniform, n: 1_000_000, dim: 2 },
    Cloud { law: Distribution::Clusters { count: 5, spread: 0.05 }, n: 1_000_000, dim: 2 },
];

const PAIRS: [Cloud; 4] = [NEAREST[0], NEAREST[1], NEAREST[2], NEAREST[3]];

/// Runs all inputs.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    for cloud in NEAREST {
        let cloud = Cloud { n: context.count(cloud.n), ..cloud };
        match cloud.dim {
            2 => nearest::<2>(context, out, cloud)?,
            _ => nearest::<3>(context, out, cloud)?,
        }
    }
    for cloud in PAIRS {
        pairs(context, out, Cloud { n: context.count(cloud.n), ..cloud })?;
    }
    Ok(())
}

/// The median of times.
fn median(times: &[f64]) -> f64 {
    Summary::of(times).map_or(f64::NAN, |summary| summary.median)
}

/// Does the work, and adds its processor time.
fn timed<R>(times: &mut Vec<f64>, work: impl FnOnce() -> R) -> R {
    let meter = Meter::start();
    let found = work();
    times.push(meter.stop().cpu);
    found
}

/// Places beside rows, and places in a cube around them all.
fn places(cloud: Cloud, values: &[f64]) -> Result<[(&'static str, Vec<f64>); 2]> {
    let (count, dim) = (cloud.n.min(100_000), cloud.dim);
    let draws: Vec<f64> = generate(Distribution::Uniform, count, dim, SEED + 1)?;
    let end = |axis: usize, most: fn(f64, f64) -> f64| {
        values.iter().skip(axis).step_by(dim).copied().reduce(most).unwrap_or(0.0)
    };
    let ends: Vec<[f64; 2]> =
        (0..dim).map(|axis| [end(axis, f64::min), end(axis, f64::max)]).collect();
    let side = ends.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
    let shift = NEAR_SHIFT * side / (cloud.n as f64).powf(1.0 / dim as f64);
    let step = cloud.n / count;
    let near = draws.iter().enumerate().map(|(i, x)| {
        let (place, axis) = (i / dim, i % dim);
        values[place * step * dim + axis] + (2.0 * x - 1.0) * shift
    });
    let far = draws.iter().enumerate().map(|(i, x)| {
        let [low, high] = ends[i % dim];
        (low + high) / 2.0 + (x - 0.5) * FAR_SIDE * side
    });
    Ok([("near", near.collect()), ("far", far.collect())])
}

/// The nearest row to places, beside kiddo's immutable tree: at once, and one by one.
fn nearest<const D: usize>(context: &Context, out: &mut Outcome, cloud: Cloud) -> Result<()> {
    let Cloud { law, n, dim } = cloud;
    let values: Vec<f64> = generate(law, n, dim, SEED)?;
    let rows = values.as_chunks::<D>().0;
    let (pool, options) = (pool(1)?, QueryOptions::default());
    let mut build: [Vec<f64>; 2] = Default::default();
    let points = Points::new(&values, dim)?;
    let search = timed(&mut build[0], || {
        pool.install(|| SphereSearch::new(&points, &SphereSearchOptions::default()))
    })?;
    let theirs: ImmutableKdTree<f64, D> =
        timed(&mut build[1], || ImmutableKdTree::new_from_slice(rows))
            .map_err(|error| anyhow!("kiddo: {error:?}"))?;
    let mut table = Table::new(
        "places | taut at once:s | taut one by one:s | kiddo:s | at once:x | one by one:x",
    );
    let what = format!("{law}, {n} × {dim}");
    let mut ratios = vec![];
    for (name, places) in places(cloud, &values)? {
        let queries = Points::new(&places, dim)?;
        let mut times: [Vec<f64>; 3] = Default::default();
        for _ in 0..context.runs {
            let found =
                timed(&mut times[0], || pool.install(|| search.nearest(&queries, &options)))?;
            let single: Vec<_> = timed(&mut times[1], || {
                queries.rows().map(|place| search.nearest_to(place)).collect()
            });
            let peer: Vec<f64> = timed(&mut times[2], || {
                let nearest = |&place: &[f64; D]| {
                    theirs.query(&place).nearest_one::<SquaredEuclidean<f64>>().execute().distance
                };
                places.as_chunks::<D>().0.iter().map(nearest).collect()
            });
            ensure!(single.iter().flatten().eq(&found), "one by one and at once differ");
            let same = found.iter().zip(&peer).all(|(found, peer)| found.distance == peer.sqrt());
            ensure!(same, "taut and kiddo differ");
        }
        let [ours, single, peer] = times.each_ref().map(|times| median(times));
        ratios.push((name, peer / ours, peer / single));
        table.push(json!({
            "places": name, "taut at once": ours, "taut one by one": single, "kiddo": peer,
            "at once": peer / ours, "one by one": peer / single,
        }));
    }
    out.table(&format!("{what}: the nearest of {} places", n.min(100_000)), table);
    let mut built = Table::new("build | taut:s | kiddo:s");
    built.push(json!({ "build": "", "taut": median(&build[0]), "kiddo": median(&build[1]) }));
    out.table("", built);
    for (name, at_once, single) in ratios {
        out.at_least(
            format!("{name} places at once: kiddo over taut"),
            at_once,
            [1.0, 2.0],
            Unit::Times,
        );
        out.at_least(
            format!("{name} places one by one: kiddo over taut"),
            single,
            [1.0, 1.5],
            Unit::Times,
        );
    }
    out.close(&what);
    Ok(())
}

/// Touching pairs of balls of various radii, beside the hierarchy of boxes of parry3d.
fn pairs(context: &Context, out: &mut Outcome, cloud: Cloud) -> Result<()> {
    let Cloud { law, n, dim } = cloud;
    let centers: Vec<f64> = generate(law, n, dim, SEED)?;
    let draws: Vec<f64> = generate(Distribution::Uniform, n, 1, SEED + 2)?;
    let (pool, options) = (pool(1)?, QueryOptions::default());
    // The distance within which a row has so many neighbors, by a sample.
    let reach = {
        let search = SphereSearch::new(&Points::new(&centers, dim)?, &Default::default())?;
        let k = TOUCHING as usize + 1;
        let sample = Points::new(&centers[..dim * n.min(1000)], dim)?;
        let mut far: Vec<f64> = search
            .nearest_k(&sample, k, &options)?
            .iter()
            .filter_map(|found| found.last())
            .map(|found| found.distance)
            .collect();
        far.sort_by(f64::total_cmp);
        far[far.len() / 2]
    };
    let radii = draws.iter().map(|x| reach / 2.0 * (0.5 + x));
    let balls: Vec<f64> =
        centers.chunks_exact(dim).zip(radii).flat_map(|(c, r)| [c[0], c[1], c[2], r]).collect();
    let rows = Points::new(&balls, dim + 1)?;
    let tree = SphereSearchOptions { inputs: Items::Balls, ..Default::default() };
    let (mut build, mut times, mut found) = (vec![], vec![], vec![]);
    for _ in 0..context.runs {
        let search = timed(&mut build, || pool.install(|| SphereSearch::new(&rows, &tree)))?;
        found = timed(&mut times, || pool.install(|| search.pairs(0.0, &options)))?;
    }
    let what = format!("{law}, {n} balls in space");
    let mut table = Table::new("program | build:s | pairs:s | found");
    let (own_build, own) = (median(&build), median(&times));
    table
        .push(json!({ "program": "taut", "build": own_build, "pairs": own, "found": found.len() }));
    let (answers, silence) =
        peer::ask_often(context, "parry3d-pairs", (&balls, dim + 1), context.runs)?;
    if let Some(silence) = silence {
        println!("parry3d-pairs: {silence}\n");
    }
    let theirs: Vec<f64> = answers.iter().map(|answer| answer.seconds).collect();
    let builds: Vec<f64> = answers.iter().map(|answer| answer.radius).collect();
    if let Some(answer) = answers.last() {
        let rows = found.iter().flat_map(|pair| pair.rows).map(|row| row as f64);
        ensure!(rows.eq(answer.center.iter().copied()), "taut and parry3d differ");
        table.push(json!({
            "program": "parry3d", "build": median(&builds), "pairs": median(&theirs),
            "found": answer.center.len() / 2,
        }));
    }
    out.table(&what, table);
    let ratio = |ours: f64, theirs: f64| if answers.is_empty() { f64::NAN } else { theirs / ours };
    out.at_least(
        "touching pairs: parry3d over taut",
        ratio(own, median(&theirs)),
        [1.0, 2.0],
        Unit::Times,
    );
    let both = (own + own_build, median(&theirs) + median(&builds));
    out.at_least(
        "with the tree: parry3d over taut",
        ratio(both.0, both.1),
        [1.0, 2.0],
        Unit::Times,
    );
    out.close(&what);
    Ok(())
}
