//! Bounds and gap by pass, or by whatever steps a solver takes, from the trace.

use std::borrow::Cow;

use taut_certify::PassBounds;

use crate::number::count;
use crate::{Axis, DrawOptions, Plot, Scale, Series, SeriesStyle, Tone};

/// The words for the quantity that the bounds enclose.
pub(crate) struct Words {
    /// "radius"
    pub(crate) quantity: &'static str,
    /// "the smallest radius"
    pub(crate) answer: &'static str,
    pub(crate) gap: Gap,
    /// The step after which there is a pair of bounds, in singular and plural, and as the name of an axis.
    pub(crate) step: [&'static str; 3],
    /// The name of the upper bound, and its role; the same of the lower.
    pub(crate) upper: (&'static str, Tone),
    pub(crate) lower: (&'static str, Tone),
}

impl Words {
    /// The words that all shapes around points have in common; the rest is that of a ball.
    pub(crate) const ENCLOSING: Words = Words {
        quantity: "radius",
        answer: "the smallest radius",
        gap: Gap::Relative,
        step: ["pass", "passes", "pass over all points"],
        upper: ("upper bound: encloses all", Tone::Answer),
        lower: ("lower bound: proved", Tone::Bound),
    };
}

/// The way in which the two bounds are compared.
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
    let history = &*ended(history, words, options);
    let long = history.len() > 200;
    let drawn = chosen(history.len(), 400);
    let series = |name: &str, tone, style, value: &dyn Fn(usize) -> f64| Series {
        name: name.to_owned(),
        tone,
        style,
        points: drawn
            .iter()
            .map(|&i| [(i + 1) as f64, value(i)])
            .filter(|p| p[1].is_finite())
            .collect(),
    };
    let [step, plural, axis] = words.step;
    let steps = |n: u64| format!("{} {}", count(n), if n == 1 { step } else { plural });
    let shown = if drawn.len() < history.len() {
        format!(" {} of {} are drawn.", count(drawn.len() as u64), steps(history.len() as u64))
    } else {
        String::new()
    };
    let style = if long { SeriesStyle::Line } else { SeriesStyle::LineAndDots };
    let plot = |title: String, caption: String, y: Axis, y_scale, series| Plot {
        x_scale: if long { Scale::Log } else { Scale::Linear },
        y_scale,
        series,
        ..Plot::empty(title, caption, [Axis::named(axis), y], options)
    };
    let drawn_as = |tone: Tone| match tone {
        Tone::Bound if long => SeriesStyle::Dashed,
        _ => style,
    };
    let proved = options.proved_gap.filter(|gap| gap.is_finite());
    let gap = |i: usize| match (proved, words.gap, &history[i]) {
        // As it is: the difference of the bounds would round it.
        (Some(proved), ..) if i + 1 == history.len() => proved.max(0.0),
        (_, Gap::Relative, PassBounds { upper: 0.0, .. }) => 0.0,
        (_, Gap::Relative, bounds) => (bounds.upper / bounds.lower - 1.0).max(0.0),
        (_, Gap::Difference, bounds) => (bounds.upper - bounds.lower).max(0.0),
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
            if unbounded == 1 { step.to_owned() } else { steps(unbounded as u64) }
        );
    }
    if proved.is_some() {
        gap_words += " The last is the gap that the checker proved.";
    }
    if exact {
        gap_words += " An open mark at the lower edge is a gap of 0.";
    }
    vec![
        plot(
            format!("Bounds on the {} by {step}", words.quantity),
            format!("After each {step} {} lies between the two curves.{shown}", words.answer),
            Axis::named(words.quantity),
            Scale::Linear,
            vec![
                series(words.upper.0, words.upper.1, drawn_as(words.upper.1), &|i| {
                    history[i].upper
                }),
                series(words.lower.0, words.lower.1, drawn_as(words.lower.1), &|i| {
                    history[i].lower
                }),
            ],
        ),
        plot(
            format!("Gap by {step}"),
            gap_words,
            Axis::named(gap_name),
            Scale::Log,
            vec![series("", Tone::Third, style, &gap)],
        ),
    ]
}

/// The history with the bounds at its end that have the proved gap, where there is one: the answer has that, whatever the solver
/// knew of it.
fn ended<'a>(
    history: &'a [PassBounds],
    words: &Words,
    options: &DrawOptions,
) -> Cow<'a, [PassBounds]> {
    let mut history = Cow::Borrowed(history);
    let Some(proved) = options.proved_gap.filter(|gap| gap.is_finite()) else { return history };
    if let Some(last) = history.to_mut().last_mut() {
        // The bound that is the answer stays.
        match (words.gap, words.upper.1) {
            (Gap::Relative, Tone::Answer) => last.lower = last.upper / (1.0 + proved),
            (Gap::Relative, _) => last.upper = last.lower * (1.0 + proved),
            (Gap::Difference, Tone::Answer) => last.lower = last.upper - proved,
            (Gap::Difference, _) => last.upper = last.lower + proved,
        }
    }
    history
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
