//! Pictures of classifiers: the decision map of one for two features, and the error rates over all thresholds.

use taut::Points;
use taut::recognize::classify::Model;
use taut::recognize::evaluate::ScoreSet;
use taut_draw::{DecisionPoints, DetCurve, DrawOptions, Figure, decision_figure, det_figure};

/// Points of a curve.
const CURVE_POINTS_MAX: usize = 400;

/// The decision map among labeled points, if they are in the plane.
pub(super) fn decision_map(
    model: &Model,
    points: &Points<'_, f64>,
    labels: &[u32],
    options: &DrawOptions,
) -> anyhow::Result<Option<Figure>> {
    if points.dim() != 2 {
        return Ok(None);
    }
    let (places, _) = points.values().as_chunks::<2>();
    let decide = |at: [f64; 2]| {
        let found = Points::new(&at, 2).ok().and_then(|point| model.predict(point).ok());
        let Some(found) = found.and_then(|mut found| found.pop()) else {
            return (None, f64::NEG_INFINITY);
        };
        let best = found.scores.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (found.class, best)
    };
    let data = DecisionPoints { points: places, labels, classes: model.classes() };
    Ok(Some(decision_figure(data, &decide, options)?))
}

/// The error rates of scores against the own class and against others.
pub(super) fn trade_off(scores: &ScoreSet, options: &DrawOptions) -> Figure {
    let points = scores.curve(CURVE_POINTS_MAX);
    let curve = DetCurve {
        name: "model".to_owned(),
        points: points.iter().map(|point| [point.fmr, point.fnmr]).collect(),
    };
    let caption = format!(
        "{} scores against the own class and {} against others, each accepted above one threshold.",
        scores.genuine().len(),
        scores.impostor().len()
    );
    det_figure("Error rates over all thresholds", &caption, vec![curve], options)
}
