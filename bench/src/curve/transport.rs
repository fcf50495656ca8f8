//! Beside CGAL's reconstruction by optimal transport, which simplifies noisy points to a set of edges.

use std::ops::Range;
use std::time::Instant;

use anyhow::{Context as _, Result};
use serde_json::{Value, json};
use taut_mesh::{Polyline, Quality, compare};
use taut_points::generate::curves::{TestCurve, sample_curve};
use taut_reconstruct::CurveOptions;

use super::drawn::{CURVES, NOISE, error, found_lines, solve, true_lines, truth};
use crate::context::Context;
use crate::goals::Goals;
use crate::input::write_rows;
use crate::peer::Peer;
use crate::stats::seconds;
use crate::table::Table;

/// The tolerance of the peer, in units of the least local feature size.
const PEER: &str = "cgal-transport-0.03";

/// Chains of edges: each vertex with two edges is passed, others begin and end chains; what is left are closed ones.
fn chains(vertices: &[[f64; 2]], edges: &[[usize; 2]]) -> Vec<(Vec<[f64; 2]>, bool)> {
    let mut around = vec![vec![]; vertices.len()];
    for (number, &[a, b]) in edges.iter().enumerate() {
        around[a].push(number);
        around[b].push(number);
    }
    let mut used = vec![false; edges.len()];
    let walk = |start: usize, first: usize, used: &mut [bool]| {
        let (mut chain, mut at, mut edge) = (vec![vertices[start]], start, first);
        loop {
            used[edge] = true;
            at = edges[edge][0] + edges[edge][1] - at;
            if at == start {
                return (chain, around[start].len() == 2);
            }
            chain.push(vertices[at]);
            match around[at].iter().find(|&&next| !used[next]) {
                Some(&next) if around[at].len() == 2 => edge = next,
                _ => return (chain, false),
            }
        }
    };
    let mut found = vec![];
    let mut starts: Vec<usize> = (0..vertices.len()).collect();
    starts.sort_by_key(|&v| around[v].len() == 2);
    for start in starts {
        for &edge in &around[start] {
            if !used[edge] {
                found.push(walk(start, edge, &mut used));
            }
        }
    }
    found
}

/// What the peer found: vertices, edges and seconds.
type Answer = (Vec<[f64; 2]>, Vec<[usize; 2]>, f64);

fn ask(context: &Context, points: &[f64]) -> Result<Result<Answer, String>> {
    let file = context.temp.path().join("transport");
    write_rows(&file, points, 2)?;
    let mut running = match Peer::start(PEER, &file, context.temp.path())? {
        Ok(running) => running,
        Err(silence) => return Ok(Err(silence.to_string())),
    };
    let answer = match running.solve(context.limit)? {
        Ok(answer) => answer,
        Err(silence) => return Ok(Err(silence.to_string())),
    };
    // As many vertices as `support` says, then edges.
    let flat = answer.center;
    let (vertices, edges) = flat
        .split_at_checked(2 * answer.support as usize)
        .context("the peer's answer is cut off")?;
    let vertices = vertices.chunks_exact(2).map(|p| [p[0], p[1]]).collect();
    let edges = edges.chunks_exact(2).map(|e| [e[0] as usize, e[1] as usize]).collect();
    Ok(Ok((vertices, edges, answer.seconds)))
}

/// Errors, connectivity and times of both.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let n = if context.quick { 500 } else { 2000 };
    let options = CurveOptions { threads: Some(context.threads[0]), ..CurveOptions::default() };
    let head = ["curve", "program", "vertices", "rms", "Hausdorff", "curves", "right", "time", ""];
    let mut table = Table::new(&head);
    let (mut report, mut wins) = (vec![], vec![]);
    for name in CURVES {
        let truth = truth(name, TestCurve::VERTICES)?;
        let lines = true_lines(&truth);
        let points = sample_curve(&truth, n, &NOISE, seeds.start).points;
        let mut row = |who: &str, vertices: usize, quality: &Quality, time: f64| {
            let right = if quality.topology_right() { "yes" } else { "no" };
            table.push(vec![
                name.to_owned(),
                who.to_owned(),
                vertices.to_string(),
                error(quality.vertex_rms),
                error(quality.hausdorff),
                quality.loops_found.to_string(),
                right.to_owned(),
                seconds(time),
                String::new(),
            ]);
            report.push(json!({
                "curve": name, "program": who, "vertices": vertices, "vertex_rms": quality.vertex_rms,
                "hausdorff": quality.hausdorff, "curves": quality.loops_found, "right": quality.topology_right(),
                "seconds": time,
            }));
        };
        let (found, time) = solve(&points, &options)?;
        let ours = compare(&lines, &found_lines(&found.answer));
        row(
            "taut",
            found.answer.curves.iter().map(|curve| curve.vertices.len()).sum(),
            &ours,
            time,
        );
        let clock = Instant::now();
        match ask(context, &points)? {
            Ok((vertices, edges, time)) => {
                let chains = chains(&vertices, &edges);
                let found: Vec<Polyline<'_>> = chains
                    .iter()
                    .map(|(vertices, closed)| Polyline { vertices, closed: *closed })
                    .collect();
                let theirs = compare(&lines, &found);
                row(PEER, vertices.len(), &theirs, time);
                wins.push((name, Some((ours.vertex_rms, theirs.vertex_rms))));
            }
            Err(said) => {
                let mut cells = vec![name.to_owned(), PEER.to_owned()];
                cells.resize(head.len() - 2, String::new());
                cells.extend([seconds(clock.elapsed().as_secs_f64()), said]);
                table.push(cells);
                wins.push((name, None));
            }
        }
    }
    println!("n = {n}, noise of rms {}\n\n{table}", error(NOISE.delta / 3f64.sqrt()));
    let mut goals = Goals::default();
    for (name, rms) in wins {
        let shown = rms.map_or("no answer to compare with".to_owned(), |(ours, theirs)| {
            format!("{} and {}", error(ours), error(theirs))
        });
        goals.aim(
            format!("{name}: rms below CGAL's"),
            shown,
            rms.map(|(ours, theirs)| ours < theirs),
        );
    }
    Ok(json!({ "n": n, "rows": report, "goals": goals.json() }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_put_together_to_chains() {
        let vertices: Vec<[f64; 2]> = (0..8).map(|i| [f64::from(i), 0.0]).collect();
        // A triangle, and a path with a branch in its middle.
        let edges = [[0, 1], [2, 1], [2, 0], [3, 4], [4, 5], [4, 6], [6, 7]];
        let mut found = chains(&vertices, &edges);
        found.sort_by_key(|(chain, closed)| (*closed, chain.len()));
        let shape: Vec<_> = found.iter().map(|(chain, closed)| (chain.len(), *closed)).collect();
        assert_eq!(shape, [(2, false), (2, false), (3, false), (3, true)]);
    }
}
