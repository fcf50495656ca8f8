//! The radius against the number of centers: how much a further one is worth.

use taut_points::OrderBy;

use crate::marks::all_finite;
use crate::number::count;
use crate::{Axis, DrawOptions, Error, Figure, Plot, Scale, Series, SeriesStyle, Tone};

/// The radius of k centers, and what no k centers have less than.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElbowStep {
    /// The number of centers.
    pub k: u64,
    /// Their radius.
    pub radius: f64,
    /// A lower bound on it.
    pub lower_bound: f64,
}

/// A chart of radius and lower bound against k, for any number of `steps`, in any order.
///
/// # Errors
/// [`Error::NonFinite`], [`Error::Option`].
pub fn elbow_figure(steps: &[ElbowStep], options: &DrawOptions) -> Result<Figure, Error> {
    options.check()?;
    let numbers = |step: &'_ ElbowStep| [("a radius", step.radius), ("a bound", step.lower_bound)];
    let numbers: Vec<_> = steps.iter().flat_map(numbers).collect();
    all_finite(numbers.iter().map(|(what, value)| (*what, value)))?;
    let mut steps = steps.to_vec();
    steps.order_by_key(|step| step.k);
    let series = |name: &str, tone, value: fn(&ElbowStep) -> f64| Series {
        name: name.to_owned(),
        tone,
        style: SeriesStyle::LineAndDots,
        points: steps.iter().map(|step| [step.k as f64, value(step)]).collect(),
    };
    let range = match (steps.first(), steps.last()) {
        (Some(first), Some(last)) => format!(", k = {} to {}", count(first.k), count(last.k)),
        _ => String::new(),
    };
    Ok(Figure::Plot(Plot {
        title: format!("Radius by number of centers{range}"),
        caption: "For each k the least radius lies between the two curves. Where the curve has an elbow, a further \
                  center is worth less than the one before it."
            .to_owned(),
        x: Axis::named("centers, k"),
        y: Axis::named("radius"),
        x_scale: Scale::Linear,
        y_scale: Scale::Linear,
        series: vec![
            series("radius found", Tone::Answer, |step| step.radius),
            series("lower bound: proved", Tone::Bound, |step| step.lower_bound),
        ],
        bars: Vec::new(),
        levels: Vec::new(),
        width: options.width,
        height: (options.height * 0.75).max(180.0),
    }))
}
