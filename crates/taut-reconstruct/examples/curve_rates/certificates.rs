//! Certificates of fits: how many of them are wrong, and how many right answers of dense draws get one.

use std::collections::BTreeMap;
use std::ops::Range;

use rayon::prelude::*;
use taut_points::Points;
use taut_reconstruct::CurveMethod;

use super::curve_scenes::bands::{self, CLASSES};
use super::record::Draw;
use super::solve;

/// A curve that crosses itself is no curve that an answer can be.
const CROSSING: &str = "crossing";

/// So many of the fair draws may be certified wrongly, of 10⁴.
const WRONG_MAX: usize = 5;
/// The least share of right answers of dense draws that are certified.
const CERTIFIED_SHARE_MIN: f64 = 0.85;

pub(crate) fn draw(seeds: Range<u64>) -> Vec<Draw> {
    let all: Vec<(usize, u64)> =
        seeds.flat_map(|seed| (0..CLASSES.len()).map(move |class| (class, seed))).collect();
    all.into_par_iter().map(|(class, seed)| certified(class, seed)).collect()
}

fn certified(class: usize, seed: u64) -> Draw {
    let scene = bands::draw(class, seed);
    let values = scene.values();
    let found = solve(&values, CurveMethod::Fit);
    let is_certified = found.certificate.certified;
    let is_right = CLASSES[class] != CROSSING && scene.is_right(&found.answer);
    let note = if scene.is_dense && is_right && !is_certified {
        let points = Points::new(&values, 2).expect("pairs");
        let verdict = found.check(&points).expect("the checker agrees");
        format!("{:?}", verdict.doubt.expect("not certified for a reason"))
    } else {
        String::new()
    };
    Draw {
        is_fair: scene.is_fair,
        is_dense: scene.is_dense,
        is_certified,
        ..Draw::of(CLASSES[class], seed, is_right).noted(note)
    }
}

/// Prints the certificates of each class, fair draws and those beyond, for each half.
pub(crate) fn print(draws: &[Draw]) {
    for (is_held_back, name) in [(false, "tuning half"), (true, "held-back half")] {
        let half = || draws.iter().filter(|draw| draw.is_held_back() == is_held_back);
        println!(
            "{name}\nclass | fair draws | right | certified | wrongly | beyond: draws | wrongly"
        );
        for class in CLASSES {
            let of = |is_fair: bool| {
                half().filter(move |draw| draw.class == class && draw.is_fair == is_fair)
            };
            let wrong = |is_fair| of(is_fair).filter(|draw| is_wrong(draw));
            let seeds: Vec<u64> = wrong(true).map(|draw| draw.seed).collect();
            println!(
                "{class} | {} | {} | {} | {} {:?} | {} | {}",
                of(true).count(),
                of(true).filter(|draw| draw.is_right).count(),
                of(true).filter(|draw| draw.is_certified).count(),
                seeds.len(),
                &seeds[..seeds.len().min(6)],
                of(false).count(),
                wrong(false).count()
            );
        }
        let fair = half().filter(|draw| draw.is_fair).count();
        let wrong = half().filter(|draw| draw.is_fair && is_wrong(draw)).count();
        let met = match wrong * 10_000 <= WRONG_MAX * fair {
            true if fair * WRONG_MAX < 10_000 => "too few draws to tell",
            true => "yes",
            false => "NO",
        };
        println!(
            "fair draws certified wrongly: {wrong} of {fair}; at most {WRONG_MAX} of 10⁴ asked: {met}"
        );
        let dense: Vec<&Draw> = half().filter(|draw| draw.is_dense && draw.is_right).collect();
        let certified = dense.iter().filter(|draw| draw.is_certified).count();
        let met =
            if certified as f64 >= CERTIFIED_SHARE_MIN * dense.len() as f64 { "yes" } else { "NO" };
        println!(
            "right dense draws certified: {certified} of {}; {:.0} % asked: {met}; why not: {:?}",
            dense.len(),
            100.0 * CERTIFIED_SHARE_MIN,
            reasons(&dense)
        );
    }
}

fn is_wrong(draw: &Draw) -> bool {
    draw.is_certified && !draw.is_right
}

/// The names of the doubts, and how many draws have each.
fn reasons<'a>(dense: &[&'a Draw]) -> BTreeMap<&'a str, usize> {
    let mut reasons = BTreeMap::new();
    for draw in dense.iter().filter(|draw| !draw.is_certified) {
        let name = draw.note.split([' ', '(']).next().unwrap_or_default();
        *reasons.entry(name).or_default() += 1;
    }
    reasons
}
