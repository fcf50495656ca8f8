//! Convex bodies in meshes.

use super::*;

/// A share that is shown and not judged.
const NONE: [f64; 2] = [0.0; 2];

/// Shares that must be reached and are the aim; the largest volumes are known to four digits behind the point: these are
/// the least numbers that round to them. Of Beethoven 15 of 16 searches with 3·10⁶ events each end at 0.041083 to 0.041094, which is
/// 0.0411 rounded.
const MODELS: [Model; 5] = [
    model("beethoven", 15, [[0.78, 0.82], [0.69, 0.74], [0.88, 0.92], [0.86, 0.90]], 0.041_05),
    model("porsche", 10, [[0.78, 0.82], [0.71, 0.76], NONE, [0.79, 0.84]], 0.024_45),
    model("bunny_res2", 45, [[0.86, 0.89], [0.76, 0.81], [0.93, 0.96], [0.78, 0.83]], 0.092_15),
    model("horse", 10, [[0.67, 0.72], [0.57, 0.62], [0.82, 0.88], NONE], 0.0),
    model("chinese_dragon_10k", 17, [NONE; 4], 0.048_25),
];

/// Events for one body that is compared with a region of drake: some 5 bodies of 50 planes. Four times as many change the volume by
/// less than 1 %.
const REGION_EVENTS: u64 = 250;

/// Facets of the body that is compared with drake's on the bunny with a budget of facets.
const BUDGET_FACETS: usize = 26;

/// Bodies with what they cost.
struct Packed {
    found: Solution<InscribedBodies>,
    seconds: f64,
    check: f64,
}

fn pack(context: &Context, mesh: &Mesh, options: &BodiesOptions<'_>) -> Result<Packed> {
    let points = Points::new(mesh.as_flattened().as_flattened(), 9)?;
    let pool = context.pool()?;
    let solve = || inscribed_bodies(&points, options);
    let mut found = pool.install(solve)?;
    let (mut searches, mut checks) = (vec![], vec![]);
    for _ in 0..context.runs {
        let start = Instant::now();
        found = pool.install(solve)?;
        searches.push(start.elapsed().as_secs_f64());
        let start = Instant::now();
        pool.install(|| found.check(&points))?;
        checks.push(start.elapsed().as_secs_f64());
    }
    let [seconds, check] = [searches, checks].map(|times| least(times).unwrap_or(f64::NAN));
    Ok(Packed { found, seconds, check })
}

/// Coverage, times, sizes of certificates, the largest single body, and the lines that ten bodies hide.
pub(super) fn packing(context: &Context, out: &mut Outcome) -> Result<()> {
    let mut table = Table::new(
        "model | triangles | what | bodies | covered:% | over the best known:6 | s:s | check of a body:s | bytes of a body \
         | lines | hidden:% | standard error:% | worst view:%",
    );
    for &Model { name, count, overlapping, disjoint, free, hidden, largest } in &MODELS {
        let Some(mesh) = shapes::read(name)? else { return out.left_out() };
        let base = BodiesOptions {
            shape: BodyShape::Dop(18),
            events: context.size(200_000, 20_000),
            ..Default::default()
        };
        let packings = [
            ("one", 1, None),
            ("ten", 10, None),
            ("overlapping", count, Some(overlapping)),
            ("disjoint", count, Some(disjoint)),
            ("free facets", count, Some(free)),
        ];
        let inside = coverage::points(&mesh);
        ensure!(!inside.is_empty(), "{name}: no point inside");
        for (what, count, bounds) in packings {
            let disjoint = what == "disjoint";
            let is_free = what == "free facets";
            let shape = if is_free { BodiesOptions::default().shape } else { base.shape };
            let options = BodiesOptions { count, disjoint, shape, ..base.clone() };
            let packed = pack(context, &mesh, &options)?;
            let answer = &packed.found.answer;
            let covered = coverage::share(&inside, answer);
            let bodies = answer.bodies.len();
            let check = packed.check / bodies as f64;
            let mut row = json!({
                "model": name, "triangles": mesh.len(), "what": what, "bodies": bodies, "covered": covered,
                "s": packed.seconds, "check of a body": check, "bytes of a body": packed.found.to_json().len() / bodies,
            });
            let of = |quantity: &str| format!("{name}, {what}: {quantity}");
            if what == "one" && largest > 0.0 {
                let ratio = answer.bodies[0].volume / largest;
                row["over the best known"] = json!(ratio);
                out.at_least(of("volume over the best known"), ratio, [1.0, 1.1], Unit::Times);
                out.at_most(of("time"), packed.seconds, 1.0, Unit::Seconds);
            }
            if what == "ten" {
                let points = Points::new(mesh.as_flattened().as_flattened(), 9)?;
                let options = OcclusionOptions { lines: 1_000_000, ..Default::default() };
                let found = occlusion(&points, answer, &options)?;
                row["lines"] = json!(found.lines);
                row["hidden"] = json!(found.share);
                row["standard error"] = json!(found.standard_error);
                row["worst view"] = json!(found.least_view);
                if hidden != NONE {
                    out.at_least(of("lines hidden"), found.share, hidden, Unit::Percent);
                }
            }
            if let Some(bounds) = bounds.filter(|bounds| *bounds != NONE) {
                out.at_least(of("covered"), covered, bounds, Unit::Percent);
                let limit = if is_free { 3.0 } else { 2.0 };
                out.at_most(of("time"), packed.seconds, limit, Unit::Seconds);
                out.at_most(of("check of a body"), check, 3e-3, Unit::Seconds);
            }
            table.push(row);
        }
    }
    out.table("k = 18 but for free facets; coverage by 2²⁰ points on 65,536 lines that the search does not see", table);
    Ok(())
}

/// What a peer makes of a mesh: drake's one region, or the parts of a decomposition, which may reach outside.
pub(super) fn peers(context: &Context, out: &mut Outcome) -> Result<()> {
    const COLUMNS: &str =
        "model | program | parts | s:s | covered:% | outside, of the solid:% | largest:4 | why";
    let mut table = Table::new(COLUMNS);
    for model in &MODELS[..3] {
        let Some(mesh) = shapes::read(model.name)? else { return out.left_out() };
        let options = BodiesOptions { count: model.count, ..Default::default() };
        let inside = coverage::points(&mesh);
        let Packed { found, seconds, .. } = pack(context, &mesh, &options)?;
        let coverage = coverage::share(&inside, &found.answer);
        let bodies = found.answer.bodies;
        let largest = bodies.iter().map(|body| body.volume).fold(0.0, f64::max);
        table.push(json!([model.name, "taut", bodies.len(), seconds, coverage, 0.0, largest]));
        for peer in ["solid-iris", "solid-vhacd", "solid-parry3d", "solid-coacd"] {
            let theirs = match peer::ask(context, peer, (mesh.as_flattened().as_flattened(), 9))? {
                Ok(theirs) => theirs,
                Err(why) => {
                    table.push(json!({ "model": model.name, "program": peer, "why": why }));
                    continue;
                }
            };
            // What is found goes to the file: covered, outside, volume of the largest part; of Iris then its seed.
            let (judged, seed) = theirs.center.split_at(theirs.center.len().min(3));
            ensure!(judged.len() == 3, "{peer}: three numbers expected");
            let row = json!([model.name, peer, theirs.support, theirs.seconds]);
            let row: Vec<Value> = row.as_array().into_iter().flatten().cloned().collect();
            table.push([row, judged.iter().map(|x| json!(x)).collect()].concat());
            if let [x, y, z] = *seed {
                // One body around the seed that Iris had, with few events, as Iris has at most five rounds.
                let (at, events) = ([[x, y, z]], REGION_EVENTS);
                let options = BodiesOptions { at: &at, events, ..Default::default() };
                let Packed { found, seconds, .. } = pack(context, &mesh, &options)?;
                let volume = found.answer.bodies[0].volume;
                let covered = coverage::share(&inside, &found.answer);
                let program = "taut, from its seed";
                table.push(json!([model.name, program, 1, seconds, covered, 0.0, volume]));
                let of =
                    |what: &str| format!("{}: {what} of one free body over drake's", model.name);
                out.at_least(of("volume"), volume / judged[2], [1.0, 1.1], Unit::Times);
                let what = format!("{}: drake's time for one region over ours", model.name);
                out.at_least(what, theirs.seconds / seconds, [100.0, 1000.0], Unit::Times);
                if model.name == "bunny_res2" {
                    let shape = BodyShape::Free(BUDGET_FACETS);
                    let options = BodiesOptions { at: &at, shape, ..Default::default() };
                    let Packed { found, seconds, .. } = pack(context, &mesh, &options)?;
                    let volume = found.answer.bodies[0].volume;
                    let covered = coverage::share(&inside, &found.answer);
                    let program = format!("taut, from its seed, at most {BUDGET_FACETS} facets");
                    table.push(json!([model.name, program, 1, seconds, covered, 0.0, volume]));
                    let what = format!("volume of a body with {BUDGET_FACETS} facets over drake's");
                    out.at_least(what, volume / judged[2], [0.8, 0.9], Unit::Times);
                }
            }
        }
    }
    out.table(
        "Parts of V-HACD (its own program and that of parry3d) and CoACD reach outside: none of theirs is proved to be inside.",
        table,
    );
    Ok(())
}
