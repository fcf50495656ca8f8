//! Samples without replacement, in order.

use super::*;
use taut_oblivious::sample;

/// 2²⁰ of 2⁴⁰, and all items in random order.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let (n, k) = (1u64 << 40, context.size(1u64 << 20, 1 << 14));
    let mut lanes = Lanes::default();
    for round in 0..context.runs as u64 {
        let drawn = lanes.time("taut", || sample(round, n, k))?;
        judge(&drawn, n, k as usize..=k as usize)?;
        let drawn: Vec<u64> = lanes.time("taut, one by one (Vitter)", || {
            Sequential::new(round, n, k).map(Iterator::collect)
        })?;
        judge(&drawn, n, k as usize..=k as usize)?;
        let p = k as f64 / n as f64;
        let drawn = lanes.time("taut, each with p = k/n", || bernoulli(round, n, p))?;
        // The number is random, with mean k; ten standard deviations are not left.
        let slack = 10 * k.isqrt() as usize;
        judge(&drawn, n, k as usize - slack..=k as usize + slack)?;
        let drawn = lanes.time("draws, std's sort, equal ones out", || {
            let mut draw = Draw(round);
            let mut drawn: Vec<u64> = (0..k).map(|_| draw.word() >> 24).collect();
            drawn.sort_unstable();
            drawn.dedup();
            drawn
        });
        judge(&drawn, n, 0..=k as usize)?;
    }
    let caption = format!("{k} of 2⁴⁰; the last row may have less than k");
    out.table(&caption, lanes.table(k as usize));
    let items = context.size(10_000_000, 100_000);
    let shuffled = shuffles(context, items)?;
    out.table(&format!("{items} u64 in random order"), shuffled.table(items));
    out.at_most("a sample", lanes.of("taut") / k as f64, 20e-9, Unit::Nanoseconds);
    Ok(())
}

/// In order, distinct, below n, and as many as there should be.
fn judge(drawn: &[u64], n: u64, count: std::ops::RangeInclusive<usize>) -> Result<()> {
    ensure!(count.contains(&drawn.len()), "{} samples", drawn.len());
    ensure!(drawn.is_sorted_by(|a, b| a < b), "samples are not in order, or not distinct");
    ensure!(drawn.last().is_none_or(|&last| last < n), "a sample is too large");
    Ok(())
}

/// Opponents Fisher and Yates' method, with the generator of this bench, which is a fast one, and as the crate rand has it.
fn shuffles(context: &Context, n: usize) -> Result<Lanes> {
    let mut items: Vec<u64> = (0..n as u64).collect();
    let mut lanes = Lanes::default();
    for round in 0..context.runs as u64 {
        lanes.time("taut", || shuffle(&mut items, round));
        ensure!(permutes(&items), "taut: an item is lost");
        let mut draw = Draw(round);
        lanes.time("Fisher–Yates", || {
            for last in (1..items.len()).rev() {
                let other = (u128::from(draw.word()) * (last as u128 + 1)) >> 64;
                items.swap(last, other as usize);
            }
        });
        ensure!(permutes(&items), "Fisher–Yates: an item is lost");
        lanes.time("rand", || items.shuffle(&mut StdRng::seed_from_u64(round)));
        ensure!(permutes(&items), "rand: an item is lost");
    }
    Ok(lanes)
}

/// Whether every number below the length is there once.
fn permutes(items: &[u64]) -> bool {
    is_permutation(items.iter().map(|&item| item as usize), items.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_samples_are_told() {
        assert!(judge(&[1, 2, 5], 6, 3..=3).is_ok());
        for wrong in [&[1, 2][..], &[1, 2, 2], &[2, 1, 5], &[1, 2, 6]] {
            assert!(judge(wrong, 6, 3..=3).is_err());
        }
        assert!(permutes(&[2, 0, 1]) && !permutes(&[2, 0, 2]) && !permutes(&[3, 0, 1]));
    }
}
