//! How much ten bodies hide, by their facets and by what the search counts.

use taut_inscribe::Objective;

use super::*;

/// All models; three have to reach shares of lines, for which the packings have goals.
const ALL: [&str; 13] = [
    "beethoven",
    "porsche",
    "bunny_res2",
    "horse",
    "chinese_dragon_10k",
    "rocker_arm",
    "fandisk",
    "cow",
    "homer",
    "f16",
    "turbine",
    "galleon",
    "beetle",
];

/// Models on which free bodies have to hide more lines than 18-dops, by three points.
const JUDGED: usize = 3;

const DOPS: BodyShape<'_> = BodyShape::Dop(18);
const FREE: BodyShape<'_> = BodyShape::Free(256);

/// Lines hidden by ten 18-dops and ten free bodies, as the search counts the volume that they cover or the lines that they hide.
pub(super) fn occlusions(context: &Context, out: &mut Outcome) -> Result<()> {
    let mut table = Table::new(
        "model | 18-dops by volume:% | by lines:% | free by volume:% | by lines:% | slowest:s",
    );
    let (mut compared, mut better) = ([0; 2], [0; 2]);
    for (at, name) in ALL.into_iter().enumerate() {
        let Some(mesh) = shapes::read(name)? else { return out.left_out() };
        let points = Points::new(mesh.as_flattened().as_flattened(), 9)?;
        let mut slowest = 0.0f64;
        let mut hidden = |shape, objective| -> Result<Option<f64>> {
            let events = context.size(200_000, 20_000);
            let options = BodiesOptions {
                shape,
                objective,
                count: 10,
                events,
                close_holes: true,
                ..Default::default()
            };
            let start = Instant::now();
            let found = match context.pool()?.install(|| inscribed_bodies(&points, &options)) {
                // Caps can be too large to tell what is inside.
                Err(taut_inscribe::Error::Ambiguous) => return Ok(None),
                found => found?,
            };
            slowest = slowest.max(start.elapsed().as_secs_f64());
            found.check(&points)?;
            let options = OcclusionOptions { lines: 1_000_000, ..Default::default() };
            Ok(Some(occlusion(&points, &found.answer, &options)?.share))
        };
        let mut shares = [[None; 2]; 2];
        for (of_shape, shape) in shares.iter_mut().zip([DOPS, FREE]) {
            for (share, objective) in
                of_shape.iter_mut().zip([Objective::Volume, Objective::Occlusion])
            {
                *share = hidden(shape, objective)?;
            }
        }
        for (k, of_shape) in shares.iter().enumerate() {
            let [Some(by_volume), Some(by_lines)] = *of_shape else { continue };
            compared[k] += 1;
            better[k] += usize::from(by_lines > by_volume);
        }
        if at < JUDGED {
            let best = |of_shape: [Option<f64>; 2]| of_shape.into_iter().flatten().reduce(f64::max);
            let more = best(shares[1]).zip(best(shares[0])).map(|(free, dops)| free - dops);
            let what = format!("{name}: lines that free bodies hide above those of 18-dops");
            out.at_least(what, more, 0.03, Unit::Percent);
        }
        let [[a, b], [c, d]] = shares;
        table.push(json!([name, a, b, c, d, slowest]));
    }
    out.table("ten bodies; a million lines", table);
    for (kind, compared, better) in
        [("18-dops", compared[0], better[0]), ("free bodies", compared[1], better[1])]
    {
        let measured = format!("{better} of {compared}");
        out.must(
            format!("{kind} hide more by lines than by volume on most models"),
            measured,
            2 * better > compared,
        );
    }
    Ok(())
}
