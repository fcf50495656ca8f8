//! Centers among the points: many small sets beside set-cover programs, and the cities alone.

use super::*;

const RANDOM_SETS: u64 = 200;
const DIM: usize = 2;

/// Centers among the points, exact.
fn options() -> CentersOptions<'static> {
    CentersOptions { epsilon: 0.0, placement: Placement::Rows, ..CentersOptions::default() }
}

/// A small set and the number of its centers.
struct Small {
    values: Vec<f64>,
    k: usize,
}

impl Small {
    /// 80 to 119 points after one of four laws, 2 to 6 centers.
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

/// All sets as the peers read them: number of the set, number of its centers, point.
fn rows(sets: &[Small]) -> Vec<f64> {
    let mut rows = Vec::new();
    for (number, set) in sets.iter().enumerate() {
        for point in set.values.chunks_exact(DIM) {
            rows.extend([number as f64, set.k as f64]);
            rows.extend(point);
        }
    }
    rows
}

/// Runs the small sets, then the cities.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let count = context.size(RANDOM_SETS, RANDOM_SETS / 10);
    let sets = (0..count).map(Small::draw).collect::<Result<Vec<_>>>()?;
    let (mut clocks, mut judgements) = (vec![], vec![]);
    for set in &sets {
        let points = Points::new(&set.values, DIM)?;
        let (mut least, mut last) = (f64::INFINITY, None);
        for _ in 0..context.runs {
            let start = Instant::now();
            let answer = centers(&points, set.k, &options())?;
            least = least.min(start.elapsed().as_secs_f64());
            last = Some(answer);
        }
        judgements.push(judge(&last.context("no round")?, &points));
        clocks.push(least);
    }
    let mut found = judgement::found(&judgements);
    let mut table = Table::new(
        "program | sets | time of a set:s | times taut's:x | radius ÷ taut's:4 | largest:4 | why",
    );
    let ours: Vec<f64> = judgements.iter().map(|of| of.radius).collect();
    table.push(json!({
        "program": "taut", "sets": count, "time of a set": Summary::of(&clocks), "times taut's": 1.0,
        "radius ÷ taut's": 1.0, "largest": 1.0, "seconds": clocks, "radii": ours,
    }));
    let rows = rows(&sets);
    for peer in ["set-cover", "medoids"] {
        let (answers, silence) = peer::ask_often(context, peer, (&rows, DIM + 2), sets.len())?;
        let theirs: Vec<f64> = answers.iter().map(|answer| answer.seconds).collect();
        let radii: Vec<f64> = answers.iter().map(|answer| answer.radius).collect();
        let ratios = Summary::of_ratios(&radii, &ours);
        table.push(json!({
            "program": peer, "sets": answers.len(), "time of a set": Summary::of(&theirs),
            "times taut's": Summary::of_ratios(&theirs, &clocks),
            "radius ÷ taut's": ratios.map(|s| s.median), "largest": ratios.map(|s| s.max),
            "why": silence, "seconds": theirs, "radii": radii,
        }));
        if peer == "set-cover" {
            let differs = largest_deviation(&radii, &ours).filter(|_| silence.is_none());
            found.add(DIFFERS, differs);
        }
    }
    let caption = format!(
        "{count} sets of 80 to 119 points of the plane, k from 2 to 6; the least of {} runs of each",
        context.runs
    );
    out.table(&caption, table);
    out.judge(&found);
    out.close("small sets");
    run_cities(out)
}

/// The largest |a/b − 1|; NaN is larger than any number, `None` where there is no pair or one has no partner.
fn largest_deviation(theirs: &[f64], ours: &[f64]) -> Option<f64> {
    if theirs.len() != ours.len() {
        return None;
    }
    let off = theirs.iter().zip(ours).map(|(a, b)| (a / b - 1.0).abs());
    off.reduce(|a, b| if a.is_nan() || a > b { a } else { b })
}

/// Centers among the cities, exact, without a peer: their distances alone are 10⁸.
fn run_cities(out: &mut Outcome) -> Result<()> {
    let super::case::Set::Cities(name) = GERMANY else { return Ok(()) };
    let Some(values) = cities::read(name)? else { return out.left_out() };
    let points = Points::new(&values, DIM)?;
    let mut table = Table::new(&format!("k | clock:s | nodes | {COLUMNS}"));
    for k in [5, 10] {
        let start = Instant::now();
        let found = centers(&points, k, &options())?;
        let clock = start.elapsed().as_secs_f64();
        let head = json!({ "k": k, "clock": clock, "nodes": found.trace.iterations });
        table.push(joined([head, judge(&found, &points).cells()]));
    }
    out.table(&format!("{name}, {} × {DIM}, centers among the cities, exact", points.len()), table);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_small_and_their_centers_few() {
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
