//! Opponents CGAL's reconstruction by optimal transport, which simplifies noisy points to a set of edges.

use super::*;

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

fn ask(context: &Context, points: &[f64]) -> Result<Result<Answer, Silence>> {
    let answer = match peer::ask(context, PEER, (points, 2))? {
        Ok(answer) => answer,
        Err(silence) => return Ok(Err(silence)),
    };
    // As many vertices as `support` says, then edges.
    let flat = answer.center;
    let (vertices, edges) = flat
        .split_at_checked(2 * answer.support as usize)
        .context("the peer's answer is cut off")?;
    let edges = edges.as_chunks::<2>().0.iter().map(|edge| edge.map(|row| row as usize)).collect();
    Ok(Ok((vertices.as_chunks().0.to_vec(), edges, answer.seconds)))
}

/// Errors, connectivity and times of both.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.size(2000, 500);
    let options = CurveOptions { threads: Some(context.threads[0]), ..CurveOptions::default() };
    let mut table = Table::new(
        "curve | program | vertices | rms:ee | Hausdorff:ee | curves | right | time:s | why",
    );
    for name in CURVES {
        let truth = truth(name, TestCurve::VERTICES)?;
        let lines = true_lines(&truth);
        let points = sample_curve(&truth, n, &NOISE, context.seeds.start).points;
        let mut row = |who: &str, vertices: usize, quality: &Quality, time: f64| {
            table.push(json!({
                "curve": name, "program": who, "vertices": vertices, "rms": quality.vertex_rms,
                "Hausdorff": quality.hausdorff, "curves": quality.loops_found, "right": quality.topology_right(),
                "time": time,
            }));
        };
        let (found, time) = solve(&points, &options)?;
        let ours = compare(&lines, &found_lines(&found.answer));
        let vertices = found.answer.curves.iter().map(|curve| curve.vertices.len()).sum();
        row("taut", vertices, &ours, time);
        let clock = Instant::now();
        let mut ratio = None;
        match ask(context, &points)? {
            Ok((vertices, edges, time)) => {
                let chains = chains(&vertices, &edges);
                let found: Vec<Polyline<'_>> = chains
                    .iter()
                    .map(|(vertices, closed)| Polyline { vertices, closed: *closed })
                    .collect();
                let theirs = compare(&lines, &found);
                row(PEER, vertices.len(), &theirs, time);
                ratio = Some(ours.vertex_rms / theirs.vertex_rms);
            }
            Err(silence) => table.push(json!({
                "curve": name, "program": PEER, "time": clock.elapsed().as_secs_f64(), "why": silence,
            })),
        }
        out.at_most(format!("{name}: rms over CGAL's"), ratio, aim_only(1.0), Unit::Times);
    }
    let rms = Unit::Error.show(NOISE.delta / 3f64.sqrt());
    out.table(&format!("n = {n}, noise of rms {rms}"), table);
    Ok(())
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
