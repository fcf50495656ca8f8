//! The conflict lists of diamonds dealt by both forms of the k-distributor (6.1), with misses counted beside the formula.

use taut_reference::algorithms::{Distributor, DistributorForm};
use taut_reference::simulate::{CacheShape, Simulator};

use super::diamonds::{Lists, factor};
use super::*;

/// Words of the simulated memories and of their blocks: tall caches, M = B².
const MEMORIES: [(usize, usize); 3] = [(1 << 8, 1 << 4), (1 << 10, 1 << 5), (1 << 12, 1 << 6)];
/// Bytes of a word: a diamond and a row.
const WORD: usize = 8;

/// Misses over (X/B)(1 + log_M k) + k, the worst of all memories.
const OF_FORMULA: Quantity =
    Quantity::new("misses of the k-distributor over the formula", Unit::Times);
/// Points are in so many lists, in the plane.
const IN_PLANE: Quantity = Quantity::new("copies of a point in the plane", Unit::Fixed(2));
const IN_SPACE: Quantity = Quantity::new("copies of a point in space", Unit::Fixed(2));

/// The copying factors, and what it costs to deal the copies.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let mut found = Found::default();
    let mut factors = Table::new("set | points | sample | diamonds | copies | factor:2");
    let mut misses = Table::new("set | X | k | M | B | form | misses | formula | ratio:2");
    // In space the share of points at the border, where cavities are smaller, falls slowly.
    for (name, dim, n, epsilon) in
        [("plane", 2, context.count(1_000_000), 0.75), ("space", 3, context.count(400_000), 0.77)]
    {
        let values: Vec<f64> = generate(Distribution::Uniform, n, dim, SEED)?;
        let (lists, sample) = factor(&values, dim, epsilon)?;
        factors.push(json!({
            "set": name, "points": n, "sample": sample, "diamonds": lists.edges.len(),
            "copies": lists.copies.len(), "factor": lists.factor(),
        }));
        found.add(if dim == 2 { IN_PLANE } else { IN_SPACE }, lists.factor());
        for row in dealt(name, &lists)? {
            found.add(OF_FORMULA, row["ratio"].as_f64());
            misses.push(row);
        }
    }
    out.table("Uniform points and the diamonds of a sample", factors);
    out.table("The copies dealt to k intervals of diamonds, words of 8 bytes", misses);
    const MUST: &[Goal] =
        &[IN_PLANE.near(9.0, 0.2 / 9.0), IN_SPACE.near(47.0, 3.0 / 47.0), OF_FORMULA.at_most(8.0)];
    out.judge_by([MUST, &[]], &found);
    Ok(())
}

/// A row for each memory and form. k is the number of intervals for which X = k³.
fn dealt(name: &str, lists: &Lists) -> Result<Vec<Value>> {
    let diamonds = lists.edges.len() as u64;
    let input: Vec<u64> = lists
        .copies
        .iter()
        .map(|&[diamond, row]| u64::from(diamond) << 32 | u64::from(row))
        .collect();
    let x = input.len() as f64;
    let k = (x.cbrt() as u64).clamp(2, diamonds.max(2));
    let splitters: Vec<u64> = (1..k).map(|i| (diamonds * i / k) << 32).collect();
    let mut rows = vec![];
    for (m, b) in MEMORIES {
        for (form, said) in
            [(DistributorForm::Recursive, "recursive"), (DistributorForm::Unfolded, "unfolded")]
        {
            let mut simulator = Simulator::new(&[CacheShape::lru(WORD * m, WORD * b)])?;
            let distributor = Distributor::new(&splitters, form)?;
            let buckets = distributor.distribute_instrumented(&input, &mut simulator);
            buckets.lift(&mut simulator);
            let misses = simulator.counts(0).misses as f64;
            let formula = x / b as f64 * (1.0 + (k as f64).ln() / (m as f64).ln()) + k as f64;
            rows.push(json!({
                "set": name, "X": input.len(), "k": k, "M": m, "B": b, "form": said,
                "misses": misses, "formula": formula.round(), "ratio": misses / formula,
            }));
        }
    }
    Ok(rows)
}
