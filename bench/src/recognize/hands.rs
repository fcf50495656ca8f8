//! Parts of the measurement of hands beside OpenCV and imageproc, and the whole of it.

use taut_recognize::hand::color::{ThresholdTable, adaptive_threshold};
use taut_recognize::hand::components::largest_component;
use taut_recognize::hand::distance::{Border, distance_transform};
use taut_recognize::hand::mask::Mask;
use taut_recognize::hand::outline::follow_cracks;
use taut_recognize::hand::synthetic::{Generator, Scan};
use taut_recognize::hand::{Hand, HandOptions};

use super::*;

/// Makes pages of a million pixels.
const DOTS_PER_INCH: f64 = 100.3;
/// Scans without defects.
const SCANS: usize = 20;
/// Seconds for a scan: what must and what should be reached.
const BOUNDS: [f64; 2] = [4e-3, 2e-3];
/// The radius of the opening in pixels.
const OPENING: usize = 2;

/// Times from decoded pixels to all features; then those of its parts on the first scan.
pub(super) fn hands(context: &Context, out: &mut Outcome) -> Result<()> {
    let generator = Generator { seed: SEED, dots_per_inch: DOTS_PER_INCH, ..Generator::default() };
    let scans: Vec<Scan> = (0..context.count(SCANS) as u64)
        .map(|person| generator.scan_with(person, 0, None))
        .collect();
    let mut table = Table::new("scan | pixels | first:s | least:s");
    let (mut all, mut largest) = (vec![], 0.0f64);
    for (number, scan) in scans.iter().enumerate() {
        let measure = || Hand::from_rgb(&scan.image, &HandOptions::default());
        // A hand that is not on the page as a whole is not measured, and takes less.
        if measure().is_err() {
            continue;
        }
        let mut times = vec![];
        for _ in 0..context.runs {
            let start = Instant::now();
            context.pool()?.install(measure)?;
            times.push(start.elapsed().as_secs_f64());
        }
        let (first, best) = (times[0], least(times).unwrap_or(f64::NAN));
        let pixels = scan.image.width() * scan.image.height();
        table.push(json!([number, pixels, first, best]));
        largest = largest.max(best);
        all.push(best);
    }
    ensure!(!all.is_empty(), "no scan can be measured");
    all.sort_by(f64::total_cmp);
    out.table("from pixels to features", table);
    out.at_most("median of a scan of a million pixels", all[all.len() / 2], BOUNDS, Unit::Seconds);
    out.at_most("slowest scan", largest, BOUNDS, Unit::Seconds);
    out.close("scans");

    let mut table = Table::new("part | taut:s | OpenCV:s | imageproc:s | why");
    distances(context, &scans[0], &mut table, out)?;
    outlines(context, &scans[0], &mut table)?;
    out.table("the first scan; OpenCV's distances have 32 bits", table);
    Ok(())
}

/// The distance transform of the hand.
fn distances(context: &Context, scan: &Scan, table: &mut Table, out: &mut Outcome) -> Result<()> {
    let mask = &scan.truth.mask;
    let (width, height) = (mask.width(), mask.height());
    let places = || (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let values: Vec<f64> =
        places().map(|(x, y)| f64::from(u8::from(mask.contains(x as i64, y as i64)))).collect();
    let mut times = vec![];
    let mut squares = vec![];
    for _ in 0..context.runs {
        let start = Instant::now();
        let found = distance_transform(mask, Border::Ignored);
        times.push(start.elapsed().as_secs_f64());
        squares = places().map(|(x, y)| found.squared(x, y).unwrap_or(0) as f64).collect();
    }
    let own = least(times).unwrap_or(f64::NAN);
    let mut row = json!({ "part": "distance transform", "taut": own });
    for (peer, column, error) in
        [("opencv-distance", "OpenCV", 1e-5), ("imageproc", "imageproc", 0.0)]
    {
        let (answers, silence) = peer::ask_often(context, peer, (&values, width), context.runs)?;
        let Some(answer) = answers.last() else {
            row["why"] = json!(silence.unwrap_or(Silence::Ended));
            continue;
        };
        let apart = squares.iter().zip(&answer.center).map(|(a, b)| (a - b).abs() / a.max(1.0));
        let apart = apart.fold(0.0, f64::max);
        ensure!(
            answer.center.len() == squares.len() && apart <= error,
            "{peer}: squared distances are {apart:e} apart"
        );
        let theirs = least(answers.iter().map(|answer| answer.seconds)).unwrap_or(f64::NAN);
        row[column] = json!(theirs);
        let what = format!("distance transform: {column}'s time over ours");
        match column {
            "imageproc" => out.at_least(what, theirs / own, [1.0, 1.5], Unit::Times),
            _ => out.at_least(what, theirs / own, aim_only(1.0), Unit::Times),
        }
    }
    table.push(row);
    Ok(())
}

/// From pixels to the outline of the hand, on the pixels' sides.
fn outlines(context: &Context, scan: &Scan, table: &mut Table) -> Result<()> {
    let (pixels, width, height) = (scan.image.pixels(), scan.image.width(), scan.image.height());
    let mut times = vec![];
    let mut area = 0.0;
    // The table of a threshold is made once for all scans that have it.
    let threshold = || adaptive_threshold(pixels, width, height).context("no pixels");
    let colors = ThresholdTable::new(threshold()?.threshold);
    for _ in 0..context.runs {
        let start = Instant::now();
        ensure!(threshold()?.threshold == colors.threshold(), "another threshold");
        let mask = Mask::from_rgb(pixels, width, height, &colors).opened(OPENING);
        let hand = largest_component(&mask).context("no hand")?;
        let outline = follow_cracks(&hand.mask);
        times.push(start.elapsed().as_secs_f64());
        ensure!(!outline.is_empty(), "no outline");
        area = hand.area as f64;
    }
    let mut row = json!({ "part": "outline", "taut": least(times) });
    let values: Vec<f64> = pixels.iter().map(|&value| f64::from(value)).collect();
    let rows = (&values[..], 3 * width);
    let (answers, silence) = peer::ask_often(context, "opencv-outline", rows, context.runs)?;
    match answers.last() {
        None => row["why"] = json!(silence.unwrap_or(Silence::Ended)),
        Some(answer) => {
            row["OpenCV"] = json!(least(answers.iter().map(|answer| answer.seconds)));
            // Its outline is through the middles of pixels, and its b* has 256 levels.
            let ratio = answer.radius / area;
            ensure!((0.95..1.05).contains(&ratio), "OpenCV's hand has {ratio} times our area");
        }
    }
    table.push(row);
    Ok(())
}
