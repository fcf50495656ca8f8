//! Searches of 10⁵ cells by one thread and by two.

use taut_inscribe::{TriangleOptions, inscribed_triangle};

use super::*;

/// Outlines of the map 1:110m: with a small gap their searches have some 10⁵ cells.
const OUTLINES: [&str; 3] = ["Chile", "Vietnam", "Italy"];

/// Cells of a search, at most; it stops there.
const CELLS_MAX: u64 = 100_000;

/// A search: the cells of its tree, and its answer as JSON.
type Search<'a> = &'a (dyn Fn() -> Result<(usize, String)> + Sync);

/// The time of one thread over that of two, which have to find the same.
pub(super) fn threads(context: &Context, out: &mut Outcome) -> Result<()> {
    let Some(rings) = countries(COUNTRIES_110M)? else { return out.left_out() };
    let pools = [crate::context::pool(1)?, crate::context::pool(2)?];
    let mut table = Table::new("shape | country | cells | one:s | two:s | ratio:2");
    for (name, ring) in rings.into_iter().filter(|(name, _)| OUTLINES.contains(&name.as_str())) {
        let points = Points::new(&ring, 2)?;
        let ellipse = || -> Result<(usize, String)> {
            let options =
                EllipseOptions { epsilon: 1e-9, max_cells: CELLS_MAX, ..Default::default() };
            let found = inscribed_ellipse(&points, &options)?;
            Ok((found.certificate.tree.len(), found.to_json()))
        };
        let triangle = || -> Result<(usize, String)> {
            let options =
                TriangleOptions { epsilon: 1e-9, max_cells: CELLS_MAX, ..Default::default() };
            let found = inscribed_triangle(&points, &options)?;
            Ok((found.certificate.tree.len(), found.to_json()))
        };
        let searches: [(&str, Search<'_>); 2] = [("ellipse", &ellipse), ("triangle", &triangle)];
        for (shape, search) in searches {
            let mut times = [vec![], vec![]];
            let mut answers = vec![];
            for _ in 0..context.runs {
                for (pool, times) in pools.iter().zip(&mut times) {
                    let start = Instant::now();
                    answers.push(pool.install(search)?);
                    times.push(start.elapsed().as_secs_f64());
                }
            }
            ensure!(answers.windows(2).all(|two| two[0] == two[1]), "{name}: other bytes");
            let [one, two] = times.map(|times| least(times).unwrap_or(f64::NAN));
            table.push(json!([shape, name, answers[0].0, one, two, one / two]));
            let what = format!("{shape} of {name}: time of one thread over that of two");
            out.at_least(what, one / two, [1.6, 1.8], Unit::Times);
        }
    }
    out.table("1:110m, at most 10⁵ cells; the same bytes", table);
    Ok(())
}
