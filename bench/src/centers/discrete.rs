//! Centres among the points: many small sets beside set-cover programs, and the cities alone.

use std::time::Instant;

use anyhow::Result;
use serde_json::{Value, json};
use taut_certify::{Items, Placement};
use taut_enclose::{CentersOptions, centers};
use taut_points::{Distribution, Monitor, Points, generate};

use super::case::{Case, GERMANY};
use super::judgement::{self, COLUMNS, judge};
use super::{Context, cities};
use crate::goals;
use crate::input::{SEED, write_rows};
use crate::peer::{Answer, Peer, Silence};
use crate::stats::{Summary, seconds, times};
use crate::table::Table;

const RANDOM_SETS: u64 = 200;
const DIM: usize = 2;
const OPTIONS: CentersOptions<'static> = CentersOptions {
    inputs: Items::Points,
    epsilon: 0.0,
    method: taut_enclose::CentersMethod::Tree,
    placement: Placement::Rows,
    outliers: 0,
    weights: false,
    max_nodes: 10_000_000,
    assignment: false,
    threads: None,
    monitor: Monitor::silent(),
};

/// A small set and the number of its centres.
struct Small {
    values: Vec<f64>,
    k: usize,
}

impl Small {
    /// 80 to 119 points after one of four laws, 2 to 6 centres.
    fn draw(number: u64) -> Result<Self> {
        let law = match number % 4 {
            0 => Distribution::Uniform,
            1 => Distribution::Normal,
            2 => Distribution::Clusters { count: 7, spread: 0.05 },
            _ => Distribution::Kuzmin,
        };
        let n = 80 + (number * 7 % 40) as usize;
        Ok(Small { values: generate(law, n, DIM, SEED + number)?, k: 2 + (number % 5) as usize })
    }
}

/// One run of `peer` over all sets: its answers, as far as it came.
fn ask(context: &Context, peer: &str, sets: &[Small]) -> Result<(Vec<Answer>, Option<Silence>)> {
    let file = context.temp.path().join("sets");
    let mut rows = Vec::new();
    for (number, set) in sets.iter().enumerate() {
        for point in set.values.chunks_exact(DIM) {
            rows.extend([number as f64, set.k as f64]);
            rows.extend(point);
        }
    }
    write_rows(&file, &rows, DIM + 2)?;
    let mut running = match Peer::start(peer, &file, context.temp.path())? {
        Ok(running) => running,
        Err(silence) => return Ok((vec![], Some(silence))),
    };
    let mut answers = Vec::new();
    for _ in sets {
        match running.solve(context.limit)? {
            Ok(answer) => answers.push(answer),
            Err(silence) => return Ok((answers, Some(silence))),
        }
    }
    Ok((answers, None))
}

/// Runs the small sets, then the cities.
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let count = if context.quick { RANDOM_SETS / 10 } else { RANDOM_SETS };
    let sets = (0..count).map(Small::draw).collect::<Result<Vec<_>>>()?;
    let (mut clocks, mut judgements) = (vec![], vec![]);
    for set in &sets {
        let points = Points::new(&set.values, DIM)?;
        let mut least = f64::INFINITY;
        let mut found = None;
        for _ in 0..context.runs {
            let start = Instant::now();
            let answer = centers(&points, set.k, &OPTIONS)?;
            least = least.min(start.elapsed().as_secs_f64());
            found = Some(answer);
        }
        if let Some(found) = &found {
            judgements.push(judge(found, &points));
            clocks.push(least);
        }
    }
    let mut measured = judgement::measured(&judgements);
    let head = ["program", "sets", "time of a set", "times taut's", "radius ÷ taut's", "largest"];
    let mut table = Table::new(&head);
    let spread = |summary: Option<Summary>, show: fn(f64) -> String| {
        summary.map_or(String::new(), |s| {
            format!("{} ({}–{})", show(s.median), show(s.min), show(s.max))
        })
    };
    let own = spread(Summary::of(&clocks), seconds);
    table.push(vec!["taut".into(), count.to_string(), own, "1".into(), "1".into(), "1".into()]);
    let mut peers = Vec::new();
    for peer in ["set-cover", "medoids"] {
        let (answers, silence) = ask(context, peer, &sets)?;
        let theirs: Vec<f64> = answers.iter().map(|answer| answer.seconds).collect();
        let radii: Vec<f64> = answers.iter().map(|answer| answer.radius).collect();
        let ours: Vec<f64> = judgements.iter().map(|of| of.radius).collect();
        let ratios = Summary::of_ratios(&radii, &ours);
        let said = silence
            .as_ref()
            .map_or(answers.len().to_string(), |silence| format!("{} ({silence})", answers.len()));
        table.push(vec![
            peer.to_owned(),
            said,
            spread(Summary::of(&theirs), seconds),
            spread(Summary::of_ratios(&theirs, &clocks), times),
            ratios.map_or(String::new(), |s| format!("{:.4}", s.median)),
            ratios.map_or(String::new(), |s| format!("{:.4}", s.max)),
        ]);
        if peer == "set-cover" && silence.is_none() {
            measured.differs = largest_deviation(&radii, &ours);
        }
        peers.push(json!({
            "peer": peer, "seconds": theirs, "radii": radii, "silence": silence.map(|s| s.to_string()),
        }));
    }
    println!(
        "{count} sets of 80 to 119 points of the plane, k from 2 to 6; the least of {} runs of each\n\n{table}",
        context.runs
    );
    let goals = goals::print(&[case.must], &[], &measured);
    println!();
    let small: Vec<Value> = judgements
        .iter()
        .zip(&clocks)
        .map(|(judgement, clock)| json!({ "seconds": clock, "judgement": judgement.json() }))
        .collect();
    let cities = run_cities()?;
    context.report.add(json!({
        "name": case.name, "sets": small, "peers": peers, "goals": goals, "cities": cities,
    }));
    Ok(())
}

/// The largest |a/b − 1|; NaN is larger than any number, `None` where there is no pair or one has no partner.
fn largest_deviation(theirs: &[f64], ours: &[f64]) -> Option<f64> {
    if theirs.len() != ours.len() {
        return None;
    }
    let off = theirs.iter().zip(ours).map(|(a, b)| (a / b - 1.0).abs());
    off.reduce(|a, b| if a.is_nan() || a > b { a } else { b })
}

/// Centres among the cities, exact, without a peer: their distances alone are 10⁸.
fn run_cities() -> Result<Value> {
    let super::case::Set::Cities(name) = GERMANY else { return Ok(Value::Null) };
    let Some(values) = cities::read(name)? else { return Ok(json!("no TAUT_DATA")) };
    let points = Points::new(&values, DIM)?;
    let mut table = Table::new(&[&["k", "clock", "nodes"], &COLUMNS[..]].concat());
    let mut all = Vec::new();
    for k in [5, 10] {
        let start = Instant::now();
        let found = centers(&points, k, &OPTIONS)?;
        let clock = start.elapsed().as_secs_f64();
        let judgement = judge(&found, &points);
        let nodes = found.trace.iterations;
        table.push(
            [vec![k.to_string(), seconds(clock), nodes.to_string()], judgement.cells()].concat(),
        );
        all.push(
            json!({ "k": k, "seconds": clock, "nodes": nodes, "judgement": judgement.json() }),
        );
    }
    println!("{name}, {} × {DIM}, centres among the cities, exact\n\n{table}", points.len());
    Ok(json!(all))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_small_and_their_centres_few() {
        let sets: Vec<Small> = (0..40).map(|number| Small::draw(number).unwrap()).collect();
        assert!(sets.iter().all(|set| (160..240).contains(&set.values.len())));
        for k in 2..=6 {
            assert_eq!(sets.iter().filter(|set| set.k == k).count(), 8);
        }
    }

    #[test]
    fn one_radius_that_is_off_is_found() {
        assert_eq!(largest_deviation(&[1.0, 2.0], &[1.0, 2.0]), Some(0.0));
        assert_eq!(largest_deviation(&[1.0, 3.0], &[1.0, 2.0]), Some(0.5));
        assert!(largest_deviation(&[f64::NAN, 3.0], &[1.0, 2.0]).unwrap().is_nan());
        assert!(largest_deviation(&[3.0, f64::NAN], &[1.0, 2.0]).unwrap().is_nan());
        assert_eq!(largest_deviation(&[1.0], &[1.0, 2.0]), None);
    }
}
