//! Circles in outlines of countries.

use super::*;

/// Circles beside programs that find them to 1e-6 of the longest side, which is 1.
pub(super) fn circles(context: &Context, out: &mut Outcome) -> Result<()> {
    const PEERS: [&str; 3] = ["mic-shapely", "mic-polylabel", "polylabel-crate"];
    let Some(rings) = countries(COUNTRIES_10M)? else { return out.left_out() };
    let mut table = Table::new(
        "country | vertices | radius:6 | taut:s | mic-shapely:s | mic-polylabel:s | polylabel-crate:s \
         | shapely short:e",
    );
    for (name, ring) in rings {
        let points = Points::new(&ring, 2)?;
        let mut times = vec![];
        let mut radius = None;
        for _ in 0..context.runs {
            let start = Instant::now();
            let Ok(found) = inscribed_circle(&points, &CircleOptions::default()) else { break };
            times.push(start.elapsed().as_secs_f64());
            found.check(&points).with_context(|| name.clone())?;
            radius = Some(found.answer.radius);
        }
        let Some(radius) = radius else { continue };
        let taut = least(times);
        let mut row =
            json!({ "country": name, "vertices": ring.len() / 2, "radius": radius, "taut": taut });
        for peer in PEERS {
            let (answers, _) = peer::ask_often(context, peer, (&ring, 2), context.runs)?;
            let seconds = least(answers.iter().map(|answer| answer.seconds));
            row[peer] = json!(seconds);
            let (Some(answer), Some(seconds)) = (answers.first(), seconds) else { continue };
            if peer == PEERS[0] {
                let short = 1.0 - answer.radius / radius;
                row["shapely short"] = json!(short);
                out.at_most(
                    format!("{name}: shapely's radius short of ours"),
                    short,
                    2e-5,
                    Unit::Error,
                );
                let ratio = taut.map_or(f64::NAN, |taut| taut / seconds);
                // Outlines of fewer vertices take a millisecond or two with either program.
                let bounds = if ring.len() / 2 >= 20_000 { 1.0.into() } else { aim_only(1.0) };
                out.at_most(format!("{name}: time over shapely's"), ratio, bounds, Unit::Times);
            }
        }
        table.push(row);
    }
    out.table("1:10m, ε = 1e-9 against a tolerance of 1e-6", table);
    Ok(())
}
