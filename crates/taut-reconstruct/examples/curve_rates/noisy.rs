//! Noisy loops: how often `auto` takes the fit, and whether it is right, by half-width over spacing.

use std::ops::Range;

use rayon::prelude::*;
use taut_reconstruct::CurveMethod;

use super::curve_scenes::bands;
use super::record::Draw;
use super::solve;

/// Half-widths over mean spacings; from 0.7 on the fit is asked for.
const LAMBDAS: [[f64; 2]; 5] = [[0.05, 0.15], [0.15, 0.35], [0.35, 0.7], [0.7, 1.5], [1.5, 10.0]];
const FIT_LAMBDA_MIN: f64 = 0.7;
const FIT_SHARE_MIN: f64 = 0.99;

pub(crate) fn draw(seeds: Range<u64>) -> Vec<Draw> {
    let mut draws = vec![];
    for [low, high] in LAMBDAS {
        let one = |seed: u64| {
            let share = (seed % 97) as f64 / 97.0;
            let lambda = low * f64::powf(high / low, share);
            let scene = bands::scene(seed, lambda);
            let found = solve(&scene.values(), CurveMethod::Auto);
            let method = &found.trace.method;
            let note = format!("λ {lambda:.2}, {} points, by {method}", scene.points.len());
            let fit = Draw::of(format!("λ {low}–{high} takes fit"), seed, method == "fit");
            let fit = if low >= FIT_LAMBDA_MIN { fit.asked(FIT_SHARE_MIN) } else { fit };
            let is_right = scene.is_right(&found.answer);
            [fit.noted(note), Draw::of(format!("λ {low}–{high} is right"), seed, is_right)]
        };
        draws.extend(seeds.clone().into_par_iter().flat_map_iter(one).collect::<Vec<Draw>>());
    }
    draws
}
