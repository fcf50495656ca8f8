//! Ball pivoting and Poisson reconstruction beside taut: what they find, how far it is off, and how long they take.

use super::*;

/// Everybody, once, on two meshes.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let columns = [Judged::COLUMNS, Distances::COLUMNS].join(" | ");
    let mut table = Table::new(&format!("set | program | {columns} | time:s | why"));
    for model in &[BUNNY, DC][..context.size(2, 1)] {
        let Some(shape) = model.read()? else { return out.left_out() };
        let points = &shape.vertices;
        let options = SurfaceOptions { threads: Some(1), ..SurfaceOptions::default() };
        let (found, time) = ours(points, &options)?;
        let row = |who, places: Option<&[Point]>, triangles: &[[u32; 3]], time| -> Result<Value> {
            let judged = Judged::of(places.unwrap_or(points), triangles)?;
            let distances = Distances::of(&shape, places.unwrap_or(points), triangles)?;
            let mut topology = judged.cells();
            if places.is_some() {
                // Its vertices are none of the points.
                topology["unused"] = "all".into();
            }
            let head = json!({ "set": model.name, "program": who, "time": time });
            Ok(joined([head, topology, distances.cells()]))
        };
        table.push(row("taut", None, &found.answer.triangles, time)?);
        for way in PEERS {
            table.push(match theirs(context, way, points)? {
                Ok(found) => {
                    let time = found.first + found.second;
                    row(way, found.places.as_deref(), &found.triangles, time)?
                }
                Err(why) => json!({ "set": model.name, "program": way, "why": why }),
            });
        }
    }
    out.table("One thread, once", table);
    Ok(())
}
