//! Figures 49 and 50, times of distribution sort with one and two levels of recursion over a library's sort, and the random subset
//! that 5.2.2 times.
//!
//! *What is rerun.* The thesis has C++'s sort beside its own and below it; here it is the unstable sort of Rust's standard library.
//! The machine of the thesis is a laptop with 1 GHz for 5.2.2; it names none for the figures. One thread.

use taut_reference::algorithms::distribution_sort_over_library;

use super::*;
use crate::context::pool;

/// The sizes of sorts, as powers of 2.
const POWERS: &[u32] = &[10, 12, 14, 16, 18, 20, 22, 24, 26];

/// Times of sorts against the number of elements, one figure for each number of levels.
pub(super) fn sorts(plan: &Plan) -> Result<()> {
    let powers = plan.upto(POWERS, 2, 7);
    for (number, levels) in [(49, 1), (50, 2)] {
        let words = if levels == 1 { "one level" } else { "two levels" };
        let mut figure = Figure::of_times(number, format!("distribution sort, {words} over a library's sort"), "log2 n")
            .note("The thesis (5.6.1): one level is quite competitive with the library's sort, more levels are slower.");
        for (name, levels) in [("library's sort", 0), (words, levels)] {
            let sweep = Sweep::run(plan, name, plan.context.limit, powers, f64::from, |power| {
                sorted(plan, power, levels).map(Ok)
            })?;
            sweep.draw(&mut figure, "", |value| value.seconds);
        }
        figure.show(plan)?;
    }
    Ok(())
}

/// The time of one sort of uniform words.
fn sorted(plan: &Plan, power: u32, levels: u32) -> Result<Measured> {
    let numbers: Vec<f64> = generate(Distribution::Uniform, 1 << power, 1, SEED)?;
    let words: Vec<u64> = numbers.iter().map(|x| x.to_bits()).collect();
    let mut seconds = f64::INFINITY;
    let mut array = vec![];
    // Small arrays are sorted often, as one sort is no time.
    for _ in 0..plan.context.runs.max(1 << 18 >> power) {
        array.clone_from(&words);
        let start = Instant::now();
        distribution_sort_over_library(&mut array, SEED, levels);
        seconds = seconds.min(start.elapsed().as_secs_f64());
    }
    ensure!(array.is_sorted(), "{levels} levels do not sort 2^{power} words");
    Ok(Measured { x: power.into(), seconds, core_set: f64::NAN, support: f64::NAN, warning: None })
}

/// Draws 2¹⁵ of 2³⁰ numbers in order.
pub(super) fn subset(plan: &Plan) -> Result<()> {
    let (n, k) = (1 << 30, 1 << 15);
    let pool = pool(1)?;
    let (found, seconds) =
        plan.best_of(|| Ok(pool.install(|| taut_oblivious::sample(SEED, n, k))?))?;
    ensure!(
        found.len() as u64 == k && found.is_sorted_by(|a, b| a < b),
        "the subset is not {k} numbers in order"
    );
    let csv = format!("k,n,seconds\n{k},{n},{seconds:.6}\n");
    println!(
        "## Section 5.2.2: {k} of {n} numbers in order in {seconds:.6} s; the thesis: 0.2 s on a laptop with 1 GHz\n"
    );
    Ok(fs::write(plan.out.join("section-5.2.2.csv"), csv)?)
}
