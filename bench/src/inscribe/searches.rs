//! Ellipses and triangles in outlines of countries: searches over all shapes, and the checks of what they prove.

use taut_certify::CheckError;
use taut_inscribe::{Error, TriangleOptions, inscribed_triangle};

use super::*;

/// Outlines of one file, and the gap within which the best shape is looked for.
struct Case {
    file: &'static str,
    /// Outlines with more vertices than the first and at most as many as the second number.
    vertices: [usize; 2],
    epsilon: f64,
    /// Seconds of the slowest outline of those that are named in no other limit.
    slowest: Bounds,
    /// Outlines with limits of their own.
    named: &'static [(&'static str, f64)],
    /// Whether each search has to reach the gap.
    is_reached: bool,
    /// Known results that have to be reached.
    known: Known,
}

/// What a shape is known to reach: areas, or parts of the area of the outline; to the digits that are behind them.
type Known = &'static [(&'static str, f64)];

/// Parts of the outlines at 1:110m that ellipses fill, less half of the last digit known.
const ELLIPSES: Known = &[
    ("France", 0.6505),
    ("Italy", 0.4015),
    ("Chile", 0.2175),
    ("Croatia", 0.3445),
    ("Vietnam", 0.2605),
    ("Russia", 0.4825),
    ("Switzerland", 0.6755),
    ("Kenya", 0.6705),
    ("Brazil", 0.5775),
    ("Norway", 0.4145),
    ("Japan", 0.3445),
    ("India", 0.4825),
    ("United_States_of_America", 0.7445),
    ("Canada", 0.5005),
];

/// Areas of triangles in the outlines at 1:110m, less half of the last digit known.
const TRIANGLES: Known = &[
    ("France", 0.232_35),
    ("Italy", 0.094_65),
    ("Vietnam", 0.032_05),
    ("Croatia", 0.079_55),
    ("Switzerland", 0.153_85),
    ("Kenya", 0.273_05),
];

const ALL: [usize; 2] = [0, usize::MAX];

/// Has the answer checked, and returns the gap that is proved.
type Check = Box<dyn FnOnce(&Points<'_, f64>) -> Result<f64, CheckError> + Send>;

/// What one search finds.
struct Searched {
    area: f64,
    cells: usize,
    check: Check,
}

/// A search in an outline, within a gap; the area of the outline comes last.
type Search<'a> = &'a (dyn Fn(&Points<'_, f64>, f64, f64) -> Result<Searched, Error> + Sync);

/// Ellipses within two gaps, at both scales.
pub(super) fn ellipses(context: &Context, out: &mut Outcome) -> Result<()> {
    let (few, many) = (COUNTRIES_110M, COUNTRIES_10M);
    let case = |file, epsilon, slowest: Bounds, named, is_reached, known| Case {
        file,
        vertices: ALL,
        epsilon,
        slowest,
        named,
        is_reached,
        known,
    };
    let cases = [
        case(few, 1e-3, 0.5.into(), &[], true, ELLIPSES),
        case(few, 1e-6, aim_only(0.1), &[("Chile", 0.3)], true, &[]),
        case(many, 1e-3, 3.0.into(), &[], true, &[]),
        case(many, 1e-6, aim_only(1.3), &[], true, &[]),
    ];
    search_all(context, out, cases, &|points, epsilon, area| {
        let options = EllipseOptions { epsilon, ..EllipseOptions::default() };
        let found = inscribed_ellipse(points, &options)?;
        Ok(Searched {
            area: found.answer.area / area,
            cells: found.certificate.tree.len(),
            check: Box::new(move |points| Ok(found.check(points)?.gap)),
        })
    })
}

/// Triangles within two gaps at both scales; the longest outlines with the gap that they reach.
pub(super) fn triangles(context: &Context, out: &mut Outcome) -> Result<()> {
    let (few, many) = (COUNTRIES_110M, COUNTRIES_10M);
    let case = |file, vertices, epsilon, slowest: Bounds, is_reached, known| Case {
        file,
        vertices,
        epsilon,
        slowest,
        named: &[],
        is_reached,
        known,
    };
    let cases = [
        case(few, ALL, 1e-3, 2.0.into(), true, TRIANGLES),
        case(few, ALL, 1e-6, aim_only(1.0), false, &[]),
        case(many, [0, 3500], 1e-2, 10.0.into(), true, &[]),
        case(many, [0, 3500], 1e-3, aim_only(3.0), false, &[]),
        case(many, [3500, usize::MAX], 1e-2, aim_only(f64::INFINITY), false, &[]),
    ];
    search_all(context, out, cases, &|points, epsilon, _| {
        let options = TriangleOptions { epsilon, ..TriangleOptions::default() };
        let found = inscribed_triangle(points, &options)?;
        Ok(Searched {
            area: found.answer.area,
            cells: found.certificate.tree.len(),
            check: Box::new(move |points| Ok(found.check(points)?.gap)),
        })
    })
}

fn search_all<const N: usize>(
    context: &Context,
    out: &mut Outcome,
    cases: [Case; N],
    search: Search<'_>,
) -> Result<()> {
    for case in cases {
        let Some(rings) = countries(case.file)? else { return out.left_out() };
        let what = format!("{}, gap {:.0e}", case.file, case.epsilon);
        search_case(context, out, case, &rings, search).with_context(|| what)?;
    }
    Ok(())
}

fn search_case(
    context: &Context,
    out: &mut Outcome,
    case: Case,
    rings: &[(String, Vec<f64>)],
    search: Search<'_>,
) -> Result<()> {
    let Case { file, vertices: [above, most], epsilon, .. } = case;
    let vertices = match [above, most] {
        ALL => String::new(),
        [0, most] => format!(", at most {most} vertices"),
        [above, _] => format!(", more than {above} vertices"),
    };
    let what = format!("{file}, gap {epsilon:.0e}{vertices}");
    let mut table = Table::new(
        "country | vertices | area:6 | gap:e | seconds:s | check:s | check / search:2 | cells",
    );
    let pool = context.pool()?;
    let (mut slowest, mut part, mut least_known) = (0.0f64, 0.0f64, f64::INFINITY);
    for (name, ring) in
        rings.iter().filter(|(_, ring)| (above + 1..=most).contains(&(ring.len() / 2)))
    {
        let points = Points::new(ring, 2)?;
        let (mut searches, mut checks, mut last) = (vec![], vec![], None);
        for _ in 0..context.runs {
            let start = Instant::now();
            let found = pool.install(|| search(&points, epsilon, area(ring)));
            // Rings that touch themselves are refused, and are not among what has to be solved.
            let Ok(Searched { area, cells, check }) = found else { break };
            searches.push(start.elapsed().as_secs_f64());
            let start = Instant::now();
            let gap = pool.install(|| check(&points)).with_context(|| name.clone())?;
            checks.push(start.elapsed().as_secs_f64());
            last = Some((area, cells, gap));
        }
        let Some((found, cells, gap)) = last else { continue };
        let is_reached = gap <= epsilon * (1.0 + 1e-6);
        ensure!(is_reached || !case.is_reached, "{name}: gap {gap}");
        let [seconds, check] = [searches, checks].map(|times| least(times).unwrap_or(f64::NAN));
        match case.named.iter().find(|named| named.0 == name) {
            Some(&(_, limit)) => {
                out.at_most(
                    format!("{name}, {what}: time"),
                    seconds,
                    aim_only(limit),
                    Unit::Seconds,
                );
            }
            None => slowest = slowest.max(seconds),
        }
        part = part.max(check / seconds);
        if let Some(known) = case.known.iter().find(|known| known.0 == name) {
            least_known = least_known.min(found / known.1);
        }
        let vertices = ring.len() / 2;
        table.push(json!([name, vertices, found, gap, seconds, check, check / seconds, cells]));
    }
    out.table(&what, table);
    out.at_most(format!("{what}: slowest"), slowest, case.slowest, Unit::Seconds);
    out.at_most(format!("{what}: check over search"), part, 0.2, Unit::Times);
    if least_known < f64::INFINITY {
        out.at_least(format!("{what}: area over the best known"), least_known, 1.0, Unit::Times);
    }
    out.close(&what);
    Ok(())
}

/// The area of a ring.
fn area(ring: &[f64]) -> f64 {
    let points = ring.as_chunks::<2>().0;
    let next = points.iter().cycle().skip(1);
    let twice = points.iter().zip(next).map(|(p, q)| p[0] * q[1] - p[1] * q[0]);
    0.5 * twice.sum::<f64>().abs()
}
