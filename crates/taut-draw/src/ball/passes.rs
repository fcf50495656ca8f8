//! Bounds and gap by pass, from the trace.

use super::Picture;
use crate::number::{count, counted};
use crate::{Axis, Plot, Scale, Series, SeriesLook, Tone};

impl Picture<'_> {
    /// Bounds and gap after each pass.
    pub(super) fn passes(&self) -> Vec<Plot> {
        let history = &self.solution.trace.history;
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
            width: self.options.width,
            height: (self.options.height * 0.62).max(180.0),
        };
        let gap = |i: usize| history[i].upper / history[i].lower - 1.0;
        let gap = |i: usize| if history[i].upper == 0.0 { 0.0 } else { gap(i).max(0.0) };
        let unbounded = history.iter().filter(|pass| pass.lower <= 0.0 && pass.upper > 0.0).count();
        let exact = drawn.iter().any(|&i| gap(i) == 0.0);
        let mut gap_words =
            format!("Upper bound divided by lower bound, minus 1, on a logarithmic scale.{shown}");
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
                "Bounds on the radius by pass",
                format!("After each pass the smallest radius lies between the two curves.{shown}"),
                Axis::named("radius"),
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
                Axis::named("relative gap"),
                Scale::Log,
                vec![series("", Tone::Third, look, &gap)],
            ),
        ]
    }
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
