//! Circles and ellipses in outlines of countries.

use super::*;

/// Ellipses within a gap of 1e-3, at both scales.
pub(super) fn ellipses(context: &Context, out: &mut Outcome) -> Result<()> {
    for (file, bounds) in [(COUNTRIES_110M, [0.5, 0.1]), (COUNTRIES_10M, [3.0, 1.3])] {
        let Some(rings) = countries(file)? else { return out.left_out() };
        let mut table = Table::new("country | vertices | area:6 | seconds:s | check:s | cells");
        let (mut slowest, mut checks, mut searches) = (0.0f64, 0.0, 0.0);
        for (name, ring) in rings {
            let points = Points::new(&ring, 2)?;
            let options = EllipseOptions { epsilon: 1e-3, ..EllipseOptions::default() };
            let start = Instant::now();
            // Rings that touch themselves are refused, and are not among what has to be solved.
            let Ok(found) = context.pool()?.install(|| inscribed_ellipse(&points, &options)) else {
                continue;
            };
            let seconds = start.elapsed().as_secs_f64();
            let start = Instant::now();
            let verdict = found.check(&points).with_context(|| name.clone())?;
            let check = start.elapsed().as_secs_f64();
            ensure!(verdict.gap <= 1.001e-3, "{name}: gap {}", verdict.gap);
            (slowest, checks, searches) =
                (slowest.max(seconds), checks + check, searches + seconds);
            let cells = found.certificate.tree.len();
            table.push(json!([name, ring.len() / 2, found.answer.area, seconds, check, cells]));
        }
        out.table(file, table);
        out.at_most(format!("{file}: slowest"), slowest, bounds, Unit::Seconds);
        let part = checks / searches;
        out.at_most(format!("{file}: checks / searches"), part, 0.2, Unit::Times);
        out.close(file);
    }
    Ok(())
}

/// Circles beside programs that find them to 1e-6 of the longest side, which is 1.
pub(super) fn circles(context: &Context, out: &mut Outcome) -> Result<()> {
    const PEERS: [&str; 2] = ["mic-shapely", "mic-polylabel"];
    let Some(rings) = countries(COUNTRIES_10M)? else { return out.left_out() };
    let mut table = Table::new(
        "country | vertices | radius:6 | taut:s | mic-shapely:s | mic-polylabel:s | shapely short:e",
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
