//! The nearest of a million templates, beside comparing with all of them.

use taut_recognize::template::{Index, Template};

use super::*;

/// Coordinates of a template of hands.
const DIM: usize = 61;
/// Scans of a template.
const SCANS: u32 = 3;
/// Probes: every other one is a scan of an enrolled person.
const PROBES: usize = 40;
/// The standard deviation of a scan from a mean of three: the square root of 1 + 1/3.
const SCAN_DEVIATION: f64 = 1.155;
/// Seconds for a probe: what must and what should be reached.
const BOUNDS: [f64; 2] = [0.015, 0.007];

/// How far people are apart along a coordinate, in standard deviations within people.
struct Spread {
    name: &'static str,
    of: fn(usize) -> f64,
}

const SPREADS: [Spread; 3] = [
    Spread { name: "3.3 each", of: |_| 3.3 },
    Spread { name: "20/√j", of: |j| 20.0 / ((j + 1) as f64).sqrt() },
    Spread { name: "1.5 each", of: |_| 1.5 },
];

/// Times of single queries; all answers are compared with those of all distances.
pub(super) fn nearest(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.size(1_000_000, 20_000);
    let mut table = Table::new("spread | templates | index:s | query:s | all distances:s");
    for Spread { name, of } in SPREADS {
        let drawn = generate(Distribution::Normal, n, DIM, SEED)?;
        let means: Vec<f32> = drawn
            .iter()
            .enumerate()
            .map(|(i, &x): (usize, &f64)| (x * of(i % DIM)) as f32)
            .collect();
        let probes = probes(&means, n, of)?;
        let start = Instant::now();
        let index = Index::from_parts(means.clone(), vec![SCANS; n], DIM)?;
        let build = start.elapsed().as_secs_f64();
        let (mut times, mut all) = (vec![], vec![]);
        for probe in &probes {
            let mut runs = vec![];
            let mut found = None;
            for _ in 0..context.runs {
                let start = Instant::now();
                found = index.nearest(probe, f64::INFINITY)?;
                runs.push(start.elapsed().as_secs_f64());
            }
            times.extend(least(runs));
            let start = Instant::now();
            let expected = nearest_of_all(&means, probe)?;
            all.push(start.elapsed().as_secs_f64());
            ensure!(
                found.map(|found| (found.place, found.distance)) == expected,
                "{name}: another answer"
            );
        }
        times.sort_by(f64::total_cmp);
        all.sort_by(f64::total_cmp);
        let (median, all) = (times[times.len() / 2], all[all.len() / 2]);
        table.push(json!({
            "spread": name, "templates": n, "index": build, "query": median, "all distances": all,
        }));
        out.at_most(format!("{name}: time of a query"), median, BOUNDS, Unit::Seconds);
    }
    out.table("the nearest template of 61 coordinates, exactly; medians of 40 probes", table);
    Ok(())
}

/// Scans of enrolled people and of others by turns.
fn probes(means: &[f32], n: usize, of: fn(usize) -> f64) -> Result<Vec<Vec<f64>>> {
    let drawn = generate(Distribution::Normal, PROBES, DIM, SEED + 1)?;
    let probe = |(i, noise): (usize, &[f64])| -> Vec<f64> {
        let own = (i / 2 * 7919 + i) % n;
        let mean = &means[own * DIM..(own + 1) * DIM];
        let is_enrolled = i % 2 == 0;
        noise
            .iter()
            .zip(mean)
            .enumerate()
            .map(|(j, (x, &m))| match is_enrolled {
                true => f64::from(m) + SCAN_DEVIATION * x,
                false => of(j) * x,
            })
            .collect()
    };
    Ok(drawn.chunks_exact(DIM).enumerate().map(probe).collect())
}

/// The answer by definition.
fn nearest_of_all(means: &[f32], probe: &[f64]) -> Result<Option<(usize, f64)>> {
    let mut best = None;
    for (place, mean) in means.chunks_exact(DIM).enumerate() {
        let distance = Template::from_parts(mean.to_vec(), SCANS)?.distance(probe)?;
        if best.is_none_or(|(_, least)| distance < least) {
            best = Some((place, distance));
        }
    }
    Ok(best)
}
