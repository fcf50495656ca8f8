//! A million random points of dc.

use super::*;

/// Topology, seconds and bytes. One round is enough: it is the size that is tried.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let (n, threads) = (context.count(1_000_000), context.last_threads());
    let Some(shape) = DC.read()? else { return out.left_out() };
    let file = context.file("points.f64");
    let mut table = Table::new(&format!("seed | {} | time:s | B/point:0 | why", Judged::COLUMNS));
    let mut builds: Vec<Build> = vec![];
    for seed in context.seeds.clone() {
        write_raw(&file, on_triangles(&shape, n, seed)?.as_flattened())?;
        match one::alone(threads, &file, context.limit)? {
            Ok(build) => {
                let head = json!({
                    "seed": seed, "time": build.wall, "B/point": build.bytes_per_point(), "build": build,
                });
                table.push(joined([head, json!(build.counters)]));
                builds.push(build);
            }
            Err(silence) => table.push(json!({ "seed": seed, "why": silence })),
        }
    }
    out.table(&format!("n = {n}, {threads} threads"), table);
    let wanted = [
        ("components", 1),
        ("genus", DC.genus),
        ("loops", 0),
        ("bad edges", 0),
        ("bad vertices", 0),
    ];
    let is_right =
        |build: &Build| wanted.iter().all(|(name, count)| build.counters.get(*name) == Some(count));
    let right = builds.iter().filter(|build| is_right(build)).count();
    let met = (!builds.is_empty()).then_some(right == builds.len());
    out.must("one closed surface of genus 8", format!("{right} of {}", builds.len()), met);
    let worst = |of: fn(&Build) -> Option<f64>| builds.iter().filter_map(of).max_by(f64::total_cmp);
    out.at_most("time", worst(|build| Some(build.wall)), [5.0, 2.2], Unit::Seconds);
    let bytes = worst(Build::bytes_per_point);
    out.at_most("bytes per point", bytes, [850.0, 500.0], Unit::Fixed(0));
    Ok(())
}
