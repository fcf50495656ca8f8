//! The bunny with noise: the pre-pass beside an interpolation of the noise.

use super::*;

/// Standard deviation of each coordinate over the diagonal of the bunny.
const SIGMA: f64 = 1e-3;

/// Means of distances and topology, with and without the pre-pass.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let Some(shape) = BUNNY.read()? else { return out.left_out() };
    let corner = |pick: fn(f64, f64) -> f64, k: usize| {
        shape.vertices.iter().map(|point| point[k]).reduce(pick).unwrap_or(0.0)
    };
    let sides = [0, 1, 2].map(|k| corner(f64::max, k) - corner(f64::min, k));
    let deviation = SIGMA * sides.iter().map(|side| side * side).sum::<f64>().sqrt();
    let mut table = Table::new(&format!(
        "seed | program | components | genus | loops | χ | {} | why",
        Distances::COLUMNS
    ));
    for seed in context.seeds.clone() {
        let points = noisy(&shape.vertices, deviation, seed)?;
        let mut add = |who: &str, places: &[Point], triangles: &[[u32; 3]]| -> Result<_> {
            let judged = Judged::of(places, triangles)?;
            let distances = Distances::of(&shape, places, triangles)?;
            let head = json!({ "seed": seed, "program": who });
            table.push(joined([head, judged.cells(), distances.cells()]));
            Ok((judged, distances))
        };
        let threads = Some(context.last_threads());
        let mut taut = |who: &str, denoise: Option<Denoise>| -> Result<_> {
            let options = SurfaceOptions { denoise, threads, ..Default::default() };
            let answer = ours(&points, &options)?.0.answer;
            let places = if answer.vertices.is_empty() { &points } else { &answer.vertices };
            add(who, places, &answer.triangles)
        };
        taut("taut, without", None)?;
        let (judged, taut) = taut("taut, pre-pass", Some(Denoise::default()))?;
        let cgal = match theirs(context, FRONT, &points)? {
            Ok(found) => Some(add(FRONT, &points, &found.triangles)?.1),
            Err(why) => {
                table.push(json!({ "seed": seed, "program": FRONT, "why": why }));
                None
            }
        };
        let missed = cgal.map(|cgal| taut.missed.mean / cgal.missed.mean);
        let invented = cgal.map(|cgal| taut.invented.mean / cgal.invented.mean);
        let what = format!("seed {seed}: mean from reference to result over CGAL's");
        out.at_most(what, missed, [0.75, 0.6], Unit::Times);
        let what = format!("seed {seed}: mean from result to reference over CGAL's");
        out.at_most(what, invented, [0.75, 0.6], Unit::Times);
        let is_ball = (judged.components, judged.euler, judged.loops) == (1, 2, 0);
        let shown = format!("{}, χ = {}", judged.shape(), judged.euler);
        out.must(format!("seed {seed}: one closed component with χ = 2"), shown, is_ball);
    }
    out.table("", table);
    Ok(())
}
