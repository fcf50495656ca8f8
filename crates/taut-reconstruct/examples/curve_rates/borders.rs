//! Borders and coasts, all points and every third: the share of the true edges beside that of the best method for clean points.

use std::ops::Range;

use rayon::prelude::*;
use taut_reconstruct::CurveMethod;

use super::curve_scenes::borders;
use super::record::Draw;
use super::{CLEAN, solve};

/// `auto` may find a smaller share of the edges than the best method by this much, in one of twenty maps.
const LESS_MAX: f64 = 0.01;
const WITHIN_SHARE_MIN: f64 = 0.95;

pub(crate) fn draw(seeds: Range<u64>) -> Vec<Draw> {
    let mut draws = vec![];
    for (is_thinned, class) in [(false, "full"), (true, "thinned")] {
        let one = |seed: u64| {
            let sample = borders::draw(seed, is_thinned);
            let values = sample.values();
            let auto = solve(&values, CurveMethod::Auto);
            let recall = sample.recall(&auto.answer);
            let clean = CLEAN.map(|method| sample.recall(&solve(&values, method).answer));
            let best = clean.into_iter().fold(0.0, f64::max);
            let note = format!(
                "{recall:.3} by {}, of nn, hnn, one-step, corners {clean:.3?}",
                auto.trace.method
            );
            let is_near = recall >= best - LESS_MAX;
            Draw::of(class, seed, is_near).asked(WITHIN_SHARE_MIN).noted(note)
        };
        draws.extend(seeds.clone().into_par_iter().map(one).collect::<Vec<Draw>>());
    }
    draws
}
