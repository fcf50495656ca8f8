//! Smooth scenes without noise: all edges and no other.

use std::ops::Range;

use rayon::prelude::*;
use taut_reconstruct::CurveMethod;

use super::curve_scenes::smooth::Scene;
use super::record::{Draw, share};
use super::{CLEAN, solve};

const RATIOS: [f64; 5] = [0.2, 0.25, 0.33, 0.4, 0.5];

/// `auto` is exact in so many of the scenes in which the best method for clean points is.
const BEST_SHARE_MIN: f64 = 0.99;

/// A class for each sampling ratio and method.
fn class(epsilon: f64, method: CurveMethod) -> String {
    format!("ε {epsilon} {}", method.name())
}

pub(crate) fn draw(seeds: Range<u64>) -> Vec<Draw> {
    let one = |seed: u64| {
        let scene = Scene::draw(seed);
        let mut draws = vec![];
        for epsilon in RATIOS {
            let sample = scene.sample(epsilon, seed);
            let values = sample.values();
            for method in [CurveMethod::Auto].into_iter().chain(CLEAN) {
                let found = solve(&values, method);
                let is_exact = sample.is_exact(&found.answer);
                let note = format!("by {}, {} points", found.trace.method, sample.points.len());
                draws.push(Draw::of(class(epsilon, method), seed, is_exact).noted(note));
            }
        }
        draws
    };
    seeds.into_par_iter().flat_map_iter(one).collect()
}

/// Prints how many scenes are exact by each method, and whether `auto` is as good as the best.
pub(crate) fn print(draws: &[Draw]) {
    println!("ε | half | auto | nn, hnn, one-step, corners | asked | as asked");
    for epsilon in RATIOS {
        for (half, name) in [(false, "tuning"), (true, "held-back")] {
            let count = |method: CurveMethod| {
                let class = class(epsilon, method);
                let of: Vec<&Draw> = draws.iter().filter(|draw| draw.class == class).collect();
                share(&of, half)
            };
            let [auto, all] = count(CurveMethod::Auto);
            let clean = CLEAN.map(|method| count(method)[0]);
            let best = clean.into_iter().max().unwrap_or(0);
            let is_met = auto as f64 >= BEST_SHARE_MIN * best as f64;
            println!(
                "{epsilon} | {name} | {auto}/{all} | {clean:?} | {:.0} % of the best | {}",
                100.0 * BEST_SHARE_MIN,
                if is_met { "yes" } else { "NO" }
            );
        }
    }
}
