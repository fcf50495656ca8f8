//! Curves that run beside each other, some half-widths apart: concentric circles, and folds.

use std::ops::Range;

use rayon::prelude::*;
use taut_reconstruct::CurveMethod;

use super::curve_scenes::Noisy;
use super::curve_scenes::bands::{self, Noise};
use super::record::Draw;
use super::solve;

/// The share of draws that must be right at the distances that are asked for.
const RIGHT_SHARE_MIN: f64 = 0.9;

/// Points on the denser of two circles, and how much denser it is than the other one.
const CIRCLES: [(f64, f64); 6] =
    [(500.0, 1.0), (500.0, 4.0), (1500.0, 1.0), (1500.0, 4.0), (2000.0, 4.0), (6000.0, 4.0)];

/// Distances in half-widths.
const CIRCLES_APART: [f64; 7] = [3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 10.0];
const FOLDS_APART: [f64; 5] = [4.0, 5.0, 6.0, 8.0, 10.0];

/// The draws of a class at a distance; a share is asked of it if it is a goal.
fn drawn(
    class: &str,
    seeds: &Range<u64>,
    is_asked: bool,
    draw: impl Fn(u64) -> Noisy + Sync,
) -> Vec<Draw> {
    let one = |seed: u64| {
        let scene = draw(seed);
        let found = solve(&scene.values(), CurveMethod::Fit);
        let is_right = scene.is_right(&found.answer);
        let closed = found.answer.curves.iter().filter(|one| one.closed).count();
        let note = format!("{} curves, {closed} closed", found.answer.curves.len());
        let made =
            Draw { is_certified: found.certificate.certified, ..Draw::of(class, seed, is_right) };
        let made = if is_asked { made.asked(RIGHT_SHARE_MIN) } else { made };
        made.noted(note)
    };
    seeds.clone().into_par_iter().map(one).collect()
}

pub(crate) fn concentric(seeds: Range<u64>) -> Vec<Draw> {
    let mut draws = vec![];
    for (noise, name) in [(Noise::Uniform, "uniform"), (Noise::Normal, "normal")] {
        for (per, ratio) in CIRCLES {
            for r in CIRCLES_APART {
                let least = match (per, ratio) {
                    (2000.0, _) | (500.0, 4.0) => 5.0,
                    (500.0, _) => 4.0,
                    _ => 3.0,
                };
                let class = format!("{name}, {per} on the denser, {ratio}:1, {r} apart");
                draws.extend(drawn(&class, &seeds, r >= least, |seed| {
                    bands::concentric(seed, per, ratio, r, noise)
                }));
            }
        }
    }
    draws
}

pub(crate) fn folds(seeds: Range<u64>) -> Vec<Draw> {
    let mut draws = vec![];
    for n in [1000, 2000, 4000] {
        for r in FOLDS_APART {
            let class = format!("{n} points, {r} apart");
            let is_asked = n >= 2000 && r >= 8.0;
            draws.extend(drawn(&class, &seeds, is_asked, |seed| bands::fold(seed, n, r)));
        }
    }
    draws
}
