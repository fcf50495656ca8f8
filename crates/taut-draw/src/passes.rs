//! Bounds and gap by pass, from the trace.

use taut_certify::PassBounds;

use crate::number::{count, counted};
use crate::{Axis, DrawOptions, Plot, Scale, Series, SeriesLook, Tone};

/// What the bounds are bounds of.
pub(crate) struct Words {
    /// "radius"
    pub(crate) quantity: &'static str,
    /// "the smallest radius"
    pub(crate) answer: &'static str,
    pub(crate) gap: Gap,
}

/// How the two bounds are compared.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Gap {
    /// upper/lower − 1, for quantities that are at least 0; no lower bound is a lower bound of 0.
    Relative,
    /// upper − lower, for logarithms; no lower bound is one that is not finite.
    Difference,
}

/// Bounds and gap after each pass; nothing where there is no history.
pub(crate) fn passes(history: &[PassBounds], words: &Words, options: &DrawOptions) -> Vec<Plot> {
    if history.is_empty() {
        return Vec::new();
    }
    let long = history.len() > 200;
    let drawn = chosen(history.len(), 400);
    let series = |name: &str, tone, look, value: &dyn Fn(usize) -> f64| Series {
        name: name.to_owned(),
        tone,
        look,
        points: drawn
            .iter()
            .map(|&i| [(i + 1) as f64, value(i)])
            .filter(|p| p[1].is_finite())
            .collect(),
    };
    let shown = if drawn.len() < history.len() {
        format!(
            " {} of {} are drawn.",
            count(drawn.len() as u64),
            counted(history.len() as u64, "pass").replace("passs", "passes")
        )
    } else {
        String::new()
    };
    let look = if long { SeriesLook::Line } else { SeriesLook::LineAndDots };
    let plot = |title: &str, caption: String, y: Axis, y_scale, series| Plot {
        title: title.to_owned(),
        caption,
        x: Axis::named("pass over all points"),
        y,
        x_scale: if long { Scale::Log } else { Scale::Linear },
        y_scale,
        series,
        bars: Vec::new(),
        levels: Vec::new(),
        width: options.width,
        height: (options.height * 0.62).max(180.0),
    };
    let gap = |i: usize| match (words.gap, &history[i]) {
        (Gap::Relative, PassBounds { upper: 0.0, .. }) => 0.0,
        (Gap::Relative, bounds) => (bounds.upper / bounds.lower - 1.0).max(0.0),
        (Gap::Difference, bounds) => (bounds.upper - bounds.lower).max(0.0),
    };
    let is_unbounded = |pass: &&PassBounds| match words.gap {
        Gap::Relative => pass.lower <= 0.0 && pass.upper > 0.0,
        Gap::Difference => !pass.lower.is_finite(),
    };
    let unbounded = history.iter().filter(is_unbounded).count();
    let exact = drawn.iter().any(|&i| gap(i) == 0.0);
    let (compared, gap_name) = match words.gap {
        Gap::Relative => ("divided by lower bound, minus 1", "relative gap"),
        Gap::Difference => ("minus lower bound", "gap"),
    };
    let mut gap_words = format!("Upper bound {compared}, on a logarithmic scale.{shown}");
    if unbounded > 0 {
        gap_words += &format!(
            " The first {} had no lower bound yet.",
            if unbounded == 1 {
                "pass".to_owned()
            } else {
                format!("{} passes", count(unbounded as u64))
            }
        );
    }
    if exact {
        gap_words += " An open mark at the lower edge is a gap of 0.";
    }
    vec![
        plot(
            &format!("Bounds on the {} by pass", words.quantity),
            format!("After each pass {} lies between the two curves.{shown}", words.answer),
            Axis::named(words.quantity),
            Scale::Linear,
            vec![
                series("upper bound: encloses all", Tone::Answer, look, &|i| history[i].upper),
                series(
                    "lower bound: proved",
                    Tone::Bound,
                    if long { SeriesLook::Dashed } else { look },
                    &|i| history[i].lower,
                ),
            ],
        ),
        plot(
            "Gap by pass",
            gap_words,
            Axis::named(gap_name),
            Scale::Log,
            vec![series("", Tone::Third, look, &gap)],
        ),
    ]
}

/// At most about `most` of `n` indices, evenly on a logarithmic axis, with the first and the last.
fn chosen(n: usize, most: usize) -> Vec<usize> {
    if n <= most {
        return (0..n).collect();
    }
    let step = (n as f64).ln() / (most - 1) as f64;
    let mut indices: Vec<usize> =
        (0..most).map(|k| ((k as f64 * step).exp().round() as usize).clamp(1, n) - 1).collect();
    indices.push(n - 1);
    indices.dedup();
    indices
}
