//! Rates of curve reconstruction over drawn inputs of every class: `cargo run --release --example curve_rates -- SECTION FIRST COUNT`.
//!
//! Sections: `smooth`, `borders`, `noisy`, `certificates`, `strands`, `folds`. Seeds from 0 are for development; those from 1 000 000 on are
//! held back until the end.

#[path = "../tests/reconstruct/curve_scenes/mod.rs"]
mod curve_scenes;

use std::collections::BTreeMap;

use curve_scenes::bands::{self, CLASSES, Noise};
use curve_scenes::{Noisy, borders, smooth};
use rayon::prelude::*;
use taut_certify::{Curve, Solution};
use taut_points::Points;
use taut_reconstruct::{CurveMethod, CurveOptions, curve};

fn solve(values: &[f64], method: CurveMethod) -> Solution<Curve> {
    let points = Points::new(values, 2).expect("pairs");
    let options = CurveOptions { method, ..Default::default() };
    curve(&points, &options).expect("finite points of the plane")
}

const CLEAN: [CurveMethod; 4] =
    [CurveMethod::NnCrust, CurveMethod::HnnCrust, CurveMethod::OneStepCrust, CurveMethod::Corners];

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |k: usize, usual: u64| {
        words.get(k).map_or(usual, |word| word.parse().expect("SECTION FIRST COUNT"))
    };
    let (first, count) = (number(1, 0), number(2, 40));
    let seeds = first..first + count;
    match words.first().map(String::as_str) {
        Some("smooth") => smooth_scenes(seeds),
        Some("borders") => border_scenes(seeds),
        Some("noisy") => noisy_scenes(seeds),
        Some("certificates") => certificates(seeds),
        Some("strands") => concentric(seeds),
        Some("folds") => folds(seeds),
        _ => println!("sections: smooth, borders, noisy, certificates, strands, folds"),
    }
}

type Seeds = std::ops::Range<u64>;

/// How many scenes are exact by each method, at each sampling ratio.
fn smooth_scenes(seeds: Seeds) {
    const RATIOS: [f64; 5] = [0.2, 0.25, 0.33, 0.4, 0.5];
    let count = seeds.end - seeds.start;
    let found: Vec<Vec<[bool; 6]>> = seeds
        .into_par_iter()
        .map(|seed| {
            let scene = smooth::Scene::draw(seed);
            let at = |epsilon: f64| {
                let sample = scene.sample(epsilon, seed);
                let values = sample.values();
                let auto = solve(&values, CurveMethod::Auto);
                let mut row = [false; 6];
                row[0] = sample.is_exact(&auto.answer);
                row[1] = auto.trace.method == "fit";
                for (k, method) in CLEAN.into_iter().enumerate() {
                    row[k + 2] = sample.is_exact(&solve(&values, method).answer);
                }
                if !row[0] && row[2..].contains(&true) {
                    eprintln!(
                        "smooth {seed} {epsilon} {} {}",
                        auto.trace.method,
                        sample.points.len()
                    );
                }
                row
            };
            RATIOS.iter().map(|&epsilon| at(epsilon)).collect()
        })
        .collect();
    println!("of {count} | auto exact | auto takes fit | nn | hnn | one-step | corners");
    for (k, epsilon) in RATIOS.iter().enumerate() {
        let sums = (0..6).map(|m| found.iter().filter(|rows| rows[k][m]).count().to_string());
        println!("{epsilon} | {}", sums.collect::<Vec<_>>().join(" | "));
    }
}

/// The share of the true edges by each method.
fn border_scenes(seeds: Seeds) {
    for is_thinned in [false, true] {
        let found: Vec<(u64, String, Vec<f64>, usize)> = seeds
            .clone()
            .into_par_iter()
            .map(|seed| {
                let sample = borders::draw(seed, is_thinned);
                let values = sample.values();
                let auto = solve(&values, CurveMethod::Auto);
                let mut row = vec![sample.recall(&auto.answer)];
                row.extend(CLEAN.map(|method| sample.recall(&solve(&values, method).answer)));
                (seed, auto.trace.method, row, sample.points.len())
            })
            .collect();
        let count = found.len() as f64;
        let best = |row: &[f64]| row[1..].iter().copied().fold(0.0, f64::max);
        let mean = |k: usize| found.iter().map(|one| one.2[k]).sum::<f64>() / count;
        let near = found.iter().filter(|one| one.2[0] >= best(&one.2) - 0.01).count();
        for (seed, method, row, _) in
            found.iter().filter(|one| one.2[0] < best(&one.2) - 0.01).take(12)
        {
            eprintln!("borders {seed} {is_thinned} {method} {row:.3?}");
        }
        let fits = found.iter().filter(|one| one.1 == "fit").count();
        let kind = if is_thinned { "thinned" } else { "full" };
        let points = found.iter().map(|one| one.3).sum::<usize>() / found.len();
        let means: Vec<String> = (0..5).map(|k| format!("{:.3}", mean(k))).collect();
        println!(
            "{kind}, {points} points on average: auto within 1 % of the best in {near} of {count}, takes fit in {fits}; mean edges of auto, nn, hnn, \
             one-step, corners: {}",
            means.join(", ")
        );
    }
}

/// How often `auto` takes the fit, by half-width over spacing.
fn noisy_scenes(seeds: Seeds) {
    for [low, high] in [[0.05, 0.15], [0.15, 0.35], [0.35, 0.7], [0.7, 1.5], [1.5, 10.0]] {
        let one = |seed: u64| {
            let share = (seed % 97) as f64 / 97.0;
            let lambda = low * f64::powf(high / low, share);
            let scene = bands::scene(seed, lambda);
            let found = solve(&scene.values(), CurveMethod::Auto);
            if lambda > 0.7 && found.trace.method != "fit" {
                eprintln!("noisy {seed} {lambda:.2} {} {}", found.trace.method, scene.points.len());
            }
            let fit = solve(&scene.values(), CurveMethod::Fit);
            (
                found.trace.method == "fit",
                scene.is_right(&found.answer),
                scene.is_right(&fit.answer),
            )
        };
        let found: Vec<_> = seeds.clone().into_par_iter().map(one).collect();
        let fits = found.iter().filter(|f| f.0).count();
        let (right, fit) =
            (found.iter().filter(|f| f.1).count(), found.iter().filter(|f| f.2).count());
        println!(
            "λ {low}–{high}: of {} auto takes fit in {fits}; auto right {right}, fit right {fit}",
            found.len()
        );
    }
}

#[derive(Default)]
struct Count {
    draws: usize,
    right: usize,
    certified: usize,
    wrong: Vec<u64>,
    doubts: BTreeMap<String, usize>,
}

impl Count {
    fn add(&mut self, seed: u64, right: bool, certified: bool, doubt: Option<String>) {
        self.draws += 1;
        self.right += usize::from(right);
        self.certified += usize::from(certified);
        if certified && !right {
            self.wrong.push(seed);
        }
        if let (true, Some(doubt)) = (right, doubt) {
            *self.doubts.entry(doubt).or_default() += 1;
        }
    }
}

/// Draws of every class: certified, right, and certified wrongly.
fn certificates(seeds: Seeds) {
    let all: Vec<(usize, u64)> =
        seeds.flat_map(|seed| (0..CLASSES.len()).map(move |class| (class, seed))).collect();
    let found: Vec<_> = all
        .into_par_iter()
        .map(|(class, seed)| {
            let draw: Noisy = bands::draw(class, seed);
            let values = draw.values();
            let found = solve(&values, CurveMethod::Fit);
            let certified = found.certificate.certified;
            let dense = draw.is_dense;
            let right = (dense || certified) && class != 16 && draw.is_right(&found.answer);
            let doubt = (dense && right && !certified).then(|| {
                let verdict =
                    found.check(&Points::new(&values, 2).expect("pairs")).expect("checked");
                format!("{:?}", verdict.doubt).split([' ', '(']).nth(1).unwrap_or("").to_owned()
            });
            (class, seed, draw.is_fair, dense, right, certified, doubt)
        })
        .collect();
    for is_fair in [true, false] {
        println!("{}", if is_fair { "fair draws" } else { "draws beyond" });
        let mut wrong = 0;
        for (class, name) in CLASSES.iter().enumerate() {
            let (mut count, mut dense) = (Count::default(), Count::default());
            for one in found.iter().filter(|one| one.0 == class && one.2 == is_fair) {
                count.add(one.1, one.4, one.5, None);
                if one.3 {
                    dense.add(one.1, one.4, one.5, one.6.clone());
                }
            }
            if count.draws > 0 {
                println!(
                    "{name} | draws {} | certified {} | wrongly {} {:?}",
                    count.draws,
                    count.certified,
                    count.wrong.len(),
                    &count.wrong[..count.wrong.len().min(8)]
                );
                wrong += count.wrong.len();
            }
            if dense.draws > 0 {
                println!(
                    "  dense | draws {} | right {} | certified {} | wrongly {} | why not {:?}",
                    dense.draws,
                    dense.right,
                    dense.certified,
                    dense.wrong.len(),
                    dense.doubts
                );
            }
        }
        println!(
            "wrongly certified: {wrong} of {}",
            found.iter().filter(|f| f.2 == is_fair).count()
        );
    }
}

/// How many of the draws a fit gets right.
fn right(seeds: &Seeds, draw: impl Fn(u64) -> Noisy + Sync) -> usize {
    let one = |&seed: &u64| {
        let scene = draw(seed);
        scene.is_right(&solve(&scene.values(), CurveMethod::Fit).answer)
    };
    seeds.clone().collect::<Vec<_>>().par_iter().filter(|seed| one(seed)).count()
}

fn concentric(seeds: Seeds) {
    let distances = [2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 10.0];
    println!("concentric, of {} each | r = {distances:?}", seeds.end - seeds.start);
    for (name, noise) in [("uniform", Noise::Uniform), ("normal", Noise::Normal)] {
        for per in [500.0, 1500.0] {
            for ratio in [1.0, 2.0, 4.0] {
                let row = distances
                    .map(|r| right(&seeds, |s| bands::concentric(s, per, ratio, r, noise)));
                println!("{name}, {per} per strand, {ratio}:1 | {row:?}");
            }
        }
    }
}

fn folds(seeds: Seeds) {
    let distances = [3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    println!("folds, of {} each | r = {distances:?}", seeds.end - seeds.start);
    for n in [500, 1000, 2000, 4000] {
        let row = distances.map(|r| right(&seeds, |seed| bands::fold(seed, n, r)));
        println!("n = {n} | {row:?}");
    }
}
