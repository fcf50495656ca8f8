//! How far the reference is from the result, over what it is from CGAL's advancing front.

use super::*;

/// Sets where the peer is far off.
const SHARP_MODELS: [&str; 3] = ["daratech", "fandisk", "mechpart"];

/// Distances on the seven, and their ratios.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let options = SurfaceOptions { threads: Some(context.last_threads()), ..Default::default() };
    let mut table = Table::new(&format!("set | program | {} | why", Distances::COLUMNS));
    for model in &SEVEN[..context.size(SEVEN.len(), 2)] {
        let Some(shape) = model.read()? else { return out.left_out() };
        let mut add = |who: &str, triangles: &[[u32; 3]]| -> Result<Distances> {
            let distances = Distances::of(&shape, &shape.vertices, triangles)?;
            let head = json!({ "set": model.name, "program": who });
            table.push(joined([head, distances.cells()]));
            Ok(distances)
        };
        let (found, _) = ours(&shape.vertices, &options)?;
        let taut = add("taut", &found.answer.triangles)?.missed;
        let cgal = match theirs(context, FRONT, &shape.vertices)? {
            Ok(found) => Some(add(FRONT, &found.triangles)?.missed),
            Err(why) => {
                table.push(json!({ "set": model.name, "program": FRONT, "why": why }));
                None
            }
        };
        let bound = if SHARP_MODELS.contains(&model.name) { 0.7 } else { 1.05 };
        let largest = cgal.map(|cgal| taut.hausdorff / cgal.hausdorff);
        let mean = cgal.map(|cgal| taut.mean / cgal.mean);
        out.at_most(format!("{}: largest over CGAL's", model.name), largest, bound, Unit::Times);
        out.at_most(format!("{}: mean over CGAL's", model.name), mean, bound, Unit::Times);
    }
    out.table("", table);
    Ok(())
}
