//! Searches of some 10⁵ cells by one thread and by two.

use taut_inscribe::{TriangleOptions, inscribed_triangle};

use super::*;

/// Outlines whose searches have some 10⁵ cells.
const OUTLINES: [(&str, &str); 4] = [
    (COUNTRIES_110M, "Chile"),
    (COUNTRIES_10M, "Chile"),
    (COUNTRIES_10M, "Canada"),
    (COUNTRIES_10M, "Norway"),
];

/// Cells of a search, at most; it stops there.
const CELLS_MAX: u64 = 100_000;

/// Cells from which on a search has goals.
const CELLS_JUDGED: usize = 60_000;

/// A search: the cells of its tree, and its answer as JSON.
type Search<'a> = &'a (dyn Fn() -> Result<(usize, String)> + Sync);

/// The time of one thread over that of two, which have to find the same.
///
/// Two searches of one thread each, side by side, tell what the machine gives to two threads that share nothing.
pub(super) fn threads(context: &Context, out: &mut Outcome) -> Result<()> {
    let [first, second, both] = [1, 1, 2].map(crate::context::pool);
    let pools = [first?, second?, both?];
    let mut table =
        Table::new("shape | outline | cells | one:s | two:s | ratio:2 | side by side:2");
    for (file, name) in OUTLINES {
        let Some(rings) = countries(file)? else { return out.left_out() };
        let Some((_, ring)) = rings.into_iter().find(|(own, _)| own == name) else { continue };
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
            let [first, second, both] = &pools;
            let mut answers = vec![];
            let mut timed = |search: &mut dyn FnMut() -> Result<Vec<(usize, String)>>| {
                let start = Instant::now();
                answers.extend(search()?);
                anyhow::Ok(start.elapsed().as_secs_f64())
            };
            let mut times = [vec![], vec![], vec![]];
            for _ in 0..context.runs {
                times[0].push(timed(&mut || Ok(vec![first.install(search)?]))?);
                times[1].push(timed(&mut || Ok(vec![both.install(search)?]))?);
                times[2].push(timed(&mut || {
                    std::thread::scope(|scope| {
                        let other = scope.spawn(|| second.install(search));
                        let own = first.install(search);
                        Ok(vec![own?, other.join().expect("a search does not panic")?])
                    })
                })?);
            }
            ensure!(answers.windows(2).all(|two| two[0] == two[1]), "{name}: other bytes");
            let [one, two, beside] = times.map(|times| least(times).unwrap_or(f64::NAN));
            let cells = answers[0].0;
            table.push(json!([shape, name, cells, one, two, one / two, 2.0 * one / beside]));
            if cells >= CELLS_JUDGED {
                let what =
                    format!("{shape} of {name}, {file}: time of one thread over that of two");
                out.at_least(what, one / two, [1.6, 1.8], Unit::Times);
            }
        }
    }
    out.table("at most 10⁵ cells; the same bytes", table);
    Ok(())
}
