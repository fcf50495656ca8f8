//! Tours beside those of Concorde's Lin-Kernighan and of LKH.

use std::ops::Range;

use anyhow::{Result, ensure};
use serde_json::{Value, json};
use taut_points::{
    Distribution, Points, generate,
    generate::curves::{CurveNoise, TestCurve, sample_curve},
};
use taut_reconstruct::{CurveMethod, CurveOptions};

use super::drawn::{NOISE, solve, truth};
use crate::context::Context;
use crate::goals::Goals;
use crate::input::write_rows;
use crate::peer::{Answer, Peer, Silence};
use crate::stats::{seconds, times};
use crate::table::Table;

/// Units of the longer side of the box, as peers take whole numbers.
const UNITS: f64 = 1e6;

/// A tour and what it cost.
struct Tour {
    length: f64,
    seconds: f64,
    /// The proved lower bound of taut's.
    bound: Option<f64>,
    said: String,
}

fn length(points: &[f64], order: impl Iterator<Item = usize>) -> f64 {
    let at: Vec<[f64; 2]> = order.map(|row| [points[2 * row], points[2 * row + 1]]).collect();
    (0..at.len())
        .map(|i| {
            let (a, b) = (at[i], at[(i + 1) % at.len()]);
            (b[0] - a[0]).hypot(b[1] - a[1])
        })
        .sum()
}

/// taut's tour: the least time of all rounds.
fn ours(context: &Context, points: &[f64], threads: usize) -> Result<Tour> {
    let options = CurveOptions {
        method: CurveMethod::Tour,
        threads: Some(threads),
        ..CurveOptions::default()
    };
    let (found, mut least) = solve(points, &options)?;
    for _ in 1..context.runs {
        least = least.min(solve(points, &options)?.1);
    }
    let rows: Vec<usize> = found
        .answer
        .curves
        .iter()
        .flat_map(|curve| curve.rows.iter().map(|&row| row as usize))
        .collect();
    let is_one = found.answer.curves.len() == 1 && found.answer.curves[0].closed;
    let verdict = found.check(&Points::new(points, 2)?);
    let said = match (&verdict, is_one) {
        (Err(why), _) => format!("REJECTED: {why}"),
        (Ok(_), false) => "WRONG: no single closed curve".to_owned(),
        (Ok(_), true) if rows.len() != points.len() / 2 => format!("WRONG: {} points", rows.len()),
        (Ok(_), true) => "checked".to_owned(),
    };
    let bound = found.certificate.tour.as_ref().filter(|_| verdict.is_ok()).map(|tour| tour.lower);
    Ok(Tour { length: length(points, rows.into_iter()), seconds: least, bound, said })
}

/// A peer's tour of the points as whole numbers, measured as they are.
fn theirs(context: &Context, peer: &str, points: &[f64]) -> Result<Result<Tour, Silence>> {
    let (mut low, mut side) = ([f64::INFINITY; 2], 0.0f64);
    for p in points.chunks_exact(2) {
        low = [low[0].min(p[0]), low[1].min(p[1])];
    }
    for p in points.chunks_exact(2) {
        side = side.max(p[0] - low[0]).max(p[1] - low[1]);
    }
    let whole: Vec<f64> = points
        .iter()
        .enumerate()
        .map(|(i, v)| ((v - low[i % 2]) * (UNITS / side)).round())
        .collect();
    let file = context.temp.path().join("tour");
    write_rows(&file, &whole, 2)?;
    let mut running = match Peer::start(peer, &file, context.temp.path())? {
        Ok(running) => running,
        Err(silence) => return Ok(Err(silence)),
    };
    let Answer { seconds, center: order, .. } = match running.solve(context.limit)? {
        Ok(answer) => answer,
        Err(silence) => return Ok(Err(silence)),
    };
    let mut seen = vec![false; points.len() / 2];
    for &row in &order {
        let row = seen.get_mut(row as usize);
        ensure!(row.is_some_and(|seen| !std::mem::replace(seen, true)), "{peer}: not a tour");
    }
    ensure!(order.len() == seen.len(), "{peer}: {} of {} points", order.len(), seen.len());
    let length = length(points, order.into_iter().map(|row| row as usize));
    Ok(Ok(Tour { length, seconds, bound: None, said: "lengths rounded".to_owned() }))
}

/// Times, lengths and bounds.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let seed = seeds.start;
    let threads = context.threads[context.threads.len() - 1];
    let clean = CurveNoise { delta: 0.0, ..NOISE };
    let (small, large) = if context.quick { (500, 10_000) } else { (5000, 100_000) };
    let flower = truth("flower5", TestCurve::VERTICES)?;
    let bumpy = truth("bumpy", TestCurve::VERTICES)?;
    let on = |truth, n| sample_curve(truth, n, &clean, seed).points;
    let uniform = |n| generate::<f64>(Distribution::Uniform, n, 2, seed);
    let inputs: [(&str, Vec<f64>, &[&str]); 5] = [
        ("flower5", on(&flower, small), &["concorde", "elkai"]),
        ("bumpy", on(&bumpy, small), &["concorde"]),
        ("uniform", uniform(small)?, &["concorde"]),
        ("bumpy", on(&bumpy, large), &[]),
        ("uniform", uniform(large)?, &[]),
    ];
    let mut table = Table::new(&[
        "points",
        "n",
        "program",
        "length ÷ taut's",
        "time",
        "÷ taut's",
        "over its bound",
        "",
    ]);
    let (mut goals, mut report, mut judged) = (Goals::default(), vec![], vec![]);
    for (name, points, peers) in &inputs {
        let n = points.len() / 2;
        let ours = ours(context, points, threads)?;
        let gap = ours.bound.map(|bound| ours.length / bound - 1.0);
        table.push(vec![
            name.to_string(),
            n.to_string(),
            "taut".into(),
            "1".into(),
            seconds(ours.seconds),
            "1".into(),
            gap.map(|gap| format!("{:.4} %", 100.0 * gap)).unwrap_or_default(),
            ours.said.clone(),
        ]);
        let mut others = vec![];
        for peer in *peers {
            let (cells, json) = match theirs(context, peer, points)? {
                Ok(tour) => {
                    let ratios = (tour.length / ours.length, tour.seconds / ours.seconds);
                    others.push((*peer, Some(ratios)));
                    (
                        [
                            format!("{:.6}", ratios.0),
                            seconds(tour.seconds),
                            times(ratios.1),
                            tour.said,
                        ],
                        json!({ "peer": peer, "length": tour.length, "seconds": tour.seconds }),
                    )
                }
                Err(silence) => {
                    others.push((*peer, None));
                    let said = silence.to_string();
                    let json = json!({ "peer": peer, "silence": said });
                    ([String::new(), String::new(), String::new(), said], json)
                }
            };
            let [length, time, ratio, said] = cells;
            table.push(vec![
                name.to_string(),
                n.to_string(),
                peer.to_string(),
                length,
                time,
                ratio,
                String::new(),
                said,
            ]);
            report.push(json!({ "points": name, "n": n, "peer": json }));
        }
        report.push(json!({
            "points": name, "n": n, "length": ours.length, "seconds": ours.seconds, "bound": ours.bound, "said": ours.said,
        }));
        judged.push((*name, n, ours, others));
    }
    println!("{threads} threads\n\n{table}");
    for (name, n, ours, others) in judged {
        let verified = ours.bound.is_some() && ours.said == "checked";
        let shown = ours.bound.map_or(ours.said.clone(), |bound| {
            format!(
                "{}, tour at most {:.4} % longer",
                ours.said,
                100.0 * (ours.length / bound - 1.0)
            )
        });
        goals.must(format!("{name}, n = {n}: bound verified"), shown, verified);
        for (peer, ratios) in others {
            if peer != "concorde" {
                continue;
            }
            let faster = ratios.map(|(_, time)| time);
            let shown =
                faster.map_or("not measured".into(), |time| format!("{} times", times(time)));
            let goal = format!("{name}, n = {n}: 10 times faster than Concorde's Lin-Kernighan");
            let length = ratios.map(|(length, _)| length);
            // Whole numbers are 1e-6 of the box apart.
            let no_longer = length.map(|length| length >= 1.0 - 1e-9);
            let length = length.map_or("not measured".into(), |length| {
                format!("its length is {length:.6} of taut's")
            });
            let shorter = format!("{name}, n = {n}: no longer than Concorde's");
            if name == "uniform" {
                goals.aim(goal, shown, faster.map(|time| time >= 10.0));
                goals.aim(shorter, length, no_longer);
            } else {
                goals.must(goal, shown, faster.map(|time| time >= 10.0));
                goals.must(shorter, length, no_longer);
            }
        }
        if n == large {
            goals.at_most(
                &format!("{name}, n = {n}: time"),
                Some(ours.seconds),
                (2.0, Some(1.0)),
                seconds,
            );
        }
    }
    Ok(json!({ "tours": report, "goals": goals.json() }))
}
