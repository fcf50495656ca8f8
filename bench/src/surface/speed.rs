//! Times on four meshes beside CGAL's advancing front.

use super::*;

/// Total and extraction, of each the ratio that must be reached and the one that is hoped for.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let models = [BUNNY, DC, ANCHOR, HORSE];
    let mut table = Table::new(&format!("set | points | {}", Timed::COLUMNS));
    for model in &models[..context.size(models.len(), 1)] {
        let Some(shape) = model.read()? else { return out.left_out() };
        let timed = Timed::by_turns(context, &shape.vertices)?;
        let (name, [total, extraction, _]) = (model.name, timed.ratios());
        table.push(joined([json!({ "set": name, "points": shape.vertices.len() }), timed.cells()]));
        out.at_most(format!("{name}: total over CGAL's"), total, [0.40, 0.20], Unit::Times);
        let what = format!("{name}: extraction over CGAL's");
        out.at_most(what, extraction, [0.35, 0.15], Unit::Times);
    }
    let (threads, runs) = (context.last_threads(), context.runs);
    let caption = format!("taut on {threads} threads, all else on one; the least of {runs} rounds");
    out.table(&caption, table);
    Ok(())
}
