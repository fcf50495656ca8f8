//! Whether certificates can be believed: random trials of every kind, each with its truth.

use std::ops::Range;

use anyhow::Result;
use rayon::prelude::*;
use serde_json::{Value, json};
use taut_mesh::compare;
use taut_points::{
    Points,
    generate::curves::{CurveNoise, TestCurve, TruthCurves, epsilon_sample, sample_curve},
};
use taut_reconstruct::{CurveMethod, CurveOptions};

use super::drawn::{CURVES, found_lines, pool, solve, true_lines};
use crate::context::Context;
use crate::goals::Goals;
use crate::table::Table;

/// Kinds of trials, by turns.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Without noise, ε = 0.15.
    Dense,
    /// Without noise, ε between 0.3 and 0.95, where methods begin to go wrong.
    Sparse,
    /// Without noise, many points, a share of them left out along a stretch.
    Gap,
    /// Noise up to half the least feature, from few points to many.
    Noisy,
    /// Noise of 0.05 and points enough: the default method is right nearly always.
    DenseNoisy,
    /// The same with outliers.
    Outliers,
}

const KINDS: [(Kind, &str); 6] = [
    (Kind::Dense, "dense"),
    (Kind::Sparse, "sparse"),
    (Kind::Gap, "gap"),
    (Kind::Noisy, "noisy"),
    (Kind::DenseNoisy, "dense, noisy"),
    (Kind::Outliers, "outliers"),
];

const CLEAN_METHODS: [CurveMethod; 5] = [
    CurveMethod::Auto,
    CurveMethod::NnCrust,
    CurveMethod::HnnCrust,
    CurveMethod::Crust,
    CurveMethod::Corners,
];

/// A number in [0, 1) that the seed determines, another one for each `salt`.
fn lot(seed: u64, salt: u64) -> f64 {
    // The finaliser of SplitMix64.
    let mut x = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(salt);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// One trial: truth, points and method.
fn draw(kind: Kind, seed: u64) -> (TruthCurves, Vec<f64>, CurveMethod) {
    let pick = |salt, of: usize| (lot(seed, salt) * of as f64) as usize;
    let truth = match TestCurve::named(CURVES[pick(1, CURVES.len())]) {
        Some(named) if pick(2, 4) == 0 => named.build_with(3000),
        _ => TestCurve::random(seed).build_with(3000),
    };
    let clean = CLEAN_METHODS[pick(3, CLEAN_METHODS.len())];
    let between = |salt, low: f64, high: f64| low + (high - low) * lot(seed, salt);
    let count = |per: f64| ((per * truth.length_over_feature) as usize).clamp(10, 20_000);
    let noisy = |n, delta, outliers| {
        let noise =
            CurveNoise { delta, outliers, gaussian: pick(4, 3) == 0, ..CurveNoise::default() };
        sample_curve(&truth, n, &noise, seed).points
    };
    let (points, method) = match kind {
        Kind::Dense => (epsilon_sample(&truth, 0.15, seed).points, clean),
        Kind::Sparse => (epsilon_sample(&truth, between(5, 0.3, 0.95), seed).points, clean),
        Kind::Gap => {
            let all = epsilon_sample(&truth, between(5, 0.1, 0.4), seed).points;
            // All but those in a disk around one of them.
            let middle = 2 * pick(6, all.len() / 2);
            let (x, y, radius) = (all[middle], all[middle + 1], between(7, 0.3, 3.0));
            let far = |p: &&[f64]| (p[0] - x).hypot(p[1] - y) > radius;
            (all.chunks_exact(2).filter(far).flatten().copied().collect(), clean)
        }
        Kind::Noisy => {
            (noisy(count(between(5, 2.0, 300.0)), between(6, 0.02, 0.5), 0.0), CurveMethod::Auto)
        }
        Kind::DenseNoisy => (noisy(count(200.0), 0.05, 0.0), CurveMethod::Auto),
        Kind::Outliers => {
            (noisy(count(between(5, 20.0, 200.0)), 0.05, between(6, 0.02, 0.3)), CurveMethod::Auto)
        }
    };
    (truth, points, method)
}

/// What became of a trial.
#[derive(Clone, Copy, Default)]
struct Outcome {
    certified: bool,
    right: bool,
    rejected: bool,
}

/// All trials.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let pool = pool(context.threads[context.threads.len() - 1])?;
    let seeds: Vec<u64> = seeds.collect();
    let kind_of = |seed: u64| KINDS[seed as usize % KINDS.len()];
    let outcomes: Vec<Outcome> = pool.install(|| {
        seeds
            .par_iter()
            .map(|&seed| {
                let (kind, _) = kind_of(seed);
                let (truth, points, method) = draw(kind, seed);
                let options = CurveOptions { method, ..CurveOptions::default() };
                let (found, _) = solve(&points, &options)?;
                let verdict = found.check(&Points::new(&points, 2)?);
                let quality = compare(&true_lines(&truth), &found_lines(&found.answer));
                Ok(Outcome {
                    // What the checker confirms counts, not what the solver claims.
                    certified: verdict.as_ref().is_ok_and(|verdict| verdict.certified),
                    right: quality.topology_right(),
                    rejected: verdict.is_err(),
                })
            })
            .collect::<Result<_>>()
    })?;
    let mut table = Table::new(&[
        "trials",
        "all",
        "right",
        "certified",
        "wrongly",
        "rejected",
        "seeds of the wrong",
    ]);
    let (mut goals, mut report) = (Goals::default(), vec![]);
    let (mut wrong_all, mut rejected_all, mut dense) = (0, 0, None);
    for (kind, name) in KINDS {
        let of: Vec<(u64, Outcome)> = seeds
            .iter()
            .zip(&outcomes)
            .filter(|(seed, _)| kind_of(**seed).0 == kind)
            .map(|(&seed, &outcome)| (seed, outcome))
            .collect();
        let count =
            |what: fn(&Outcome) -> bool| of.iter().filter(|(_, outcome)| what(outcome)).count();
        let (right, certified) = (count(|o| o.right), count(|o| o.certified));
        let wrong: Vec<u64> =
            of.iter().filter(|(_, o)| o.certified && !o.right).map(|&(seed, _)| seed).collect();
        let rejected = count(|o| o.rejected);
        let few: Vec<String> = wrong.iter().take(5).map(u64::to_string).collect();
        table.push(vec![
            name.to_owned(),
            of.len().to_string(),
            right.to_string(),
            certified.to_string(),
            wrong.len().to_string(),
            rejected.to_string(),
            few.join(" "),
        ]);
        report.push(json!({
            "kind": name, "all": of.len(), "right": right, "certified": certified, "wrong_seeds": wrong, "rejected": rejected,
        }));
        wrong_all += wrong.len();
        rejected_all += rejected;
        if kind == Kind::Dense {
            dense = Some((certified, of.len()));
        }
    }
    println!("{table}");
    goals.must(
        format!("no false certificate in {}", seeds.len()),
        wrong_all.to_string(),
        wrong_all == 0,
    );
    goals.must(
        "no answer rejected by the checker".into(),
        rejected_all.to_string(),
        rejected_all == 0,
    );
    if let Some((certified, all)) = dense.filter(|(_, all)| *all > 0) {
        let share = certified as f64 / all as f64;
        let shown = format!("{certified} of {all}");
        goals.must(
            "at least 70 % of the dense trials certified".into(),
            shown.clone(),
            share >= 0.7,
        );
        goals.aim("at least 80 % of the dense trials certified".into(), shown, share >= 0.8);
    }
    Ok(json!({ "trials": report, "goals": goals.json() }))
}
