//! How fast the simulator is, and the misses of algorithms beside their bounds.

use super::*;

/// Bytes of a word; M and B below are in words.
const WORD: usize = 8;

/// Three memories at once, and all sizes at once.
const THREE: &str = "L1, L2 and DTLB at once";
const STACK: &str = "stack distances";

/// A sort whose accesses are recorded.
type Sort = fn(&mut [u64], &mut Simulator);

/// M and B.
type Shape = (usize, usize);

/// Accesses per second, then misses.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let mut table = Table::new("memory | product:x | sort:x | at random:x");
    for (name, [product, sort, scattered]) in rates(context)? {
        table.push(json!([name, product, sort, scattered]));
        let least = product.min(sort).min(scattered);
        // Stack distances answer for all sizes of memory at once, in O(log n).
        let must = if name == STACK { 5.0 } else { 20.0 };
        if name != THREE {
            out.at_least(format!("{name}: million accesses per second"), least, must, Unit::Times);
        }
    }
    out.table("million accesses per second", table);
    bounds(context, out)
}

/// Million accesses per second of a product, a sort, and accesses at random in 32 MiB.
fn rates(context: &Context) -> Result<Vec<(&'static str, [f64; 3])>> {
    let mut found = vec![];
    for (name, shapes) in [
        ("LRU, 32 KiB", vec![CacheShape::lru(1 << 15, 64)]),
        ("LRU, 1 MiB", vec![CacheShape::lru(1 << 20, 64)]),
        ("FIFO, 1 MiB", vec![CacheShape::fifo(1 << 20, 64)]),
        ("L1", vec![CacheShape::L1]),
        (THREE, vec![CacheShape::L1, CacheShape::L2, CacheShape::DTLB]),
    ] {
        let fresh = || -> Result<_> { Ok(Simulator::new(&shapes)?) };
        let accesses = |simulator: &Simulator| simulator.counts(0).accesses;
        found.push((name, fastest(context, fresh, accesses)?));
    }
    let fresh = || -> Result<_> { Ok(StackDistances::new(64)?) };
    found.push((STACK, fastest(context, fresh, StackDistances::accesses)?));
    Ok(found)
}

/// The best of some rounds of each of the three.
fn fastest<P: Probe>(
    context: &Context,
    fresh: impl Fn() -> Result<P>,
    accesses: impl Fn(&P) -> u64,
) -> Result<[f64; 3]> {
    let works: [fn(&mut P) -> Result<()>; 3] = [product, sort, scattered];
    let mut best = [0.0f64; 3];
    for _ in 0..context.runs {
        for (best, work) in best.iter_mut().zip(works) {
            let mut probe = fresh()?;
            let start = thread_cpu();
            work(&mut probe)?;
            *best = best.max(accesses(&probe) as f64 / (thread_cpu() - start) * 1e-6);
        }
    }
    Ok(best)
}

fn product<P: Probe>(probe: &mut P) -> Result<()> {
    let n = 100;
    let (a, b, mut c) = (vec![1.0; n * n], vec![1.0; n * n], vec![0.0; n * n]);
    Ok(multiply_instrumented(&a, &b, &mut c, MatrixSizes::square(n), 1, probe)?)
}

fn sort<P: Probe>(probe: &mut P) -> Result<()> {
    let mut keys = Draw(1).words(50_000);
    mergesort_instrumented(&mut keys, probe);
    ensure!(keys.is_sorted(), "not in order");
    Ok(())
}

/// Every access a miss, or nearly.
fn scattered<P: Probe>(probe: &mut P) -> Result<()> {
    let (array, mut draw) = (vec![0u64; 1 << 22], Draw(1));
    probe.place(&array);
    for _ in 0..2_000_000 {
        let at = (draw.word() >> 42) as usize;
        probe.read(std::slice::from_ref(&array[at]));
    }
    Ok(())
}

/// The bounds that take seconds; `cargo test -p taut-reference --test reference io_bounds` has all of them.
fn bounds(context: &Context, out: &mut Outcome) -> Result<()> {
    let mut table = Table::new("algorithm | formula | largest ratio:3 | allowed:3");
    let mut add = |name: String, formula: &str, largest: f64, allowed: f64| {
        table.push(json!([name, formula, largest, allowed]));
        let what = format!("{name}: largest ratio to {formula}");
        out.at_most(what, largest, allowed, Unit::Fixed(3));
    };
    let side = context.size(1024, 256);
    let (from, mut to) = (vec![1.0f64; side * side], vec![0.0; side * side]);
    let largest = ratio(
        &[(4096, 8), (4096, 32), (32_768, 64)],
        |probe| Ok(transpose_instrumented(&from, &mut to, side, side, 1, probe)?),
        |_, b| 2.0 * (side * side) as f64 / b,
    )?;
    add(format!("transposition, n = {side}"), "2n²/B", largest, 1.001);
    let side = context.size(256, 128);
    let (a, b, mut c) = (vec![1.0; side * side], vec![1.0; side * side], vec![0.0; side * side]);
    let largest = ratio(
        &[(1024, 8), (4096, 8), (4096, 32), (16_384, 32)],
        |probe| Ok(multiply_instrumented(&a, &b, &mut c, MatrixSizes::square(side), 1, probe)?),
        |m, b| (side as f64).powi(3) / (b * m.sqrt()),
    )?;
    add(format!("product, n = {side}"), "n³/(B√M)", largest, 5.5);
    let n = context.size(1 << 18, 10_000);
    // All pairs with M at least B².
    let sizes = [1024, 4096, 16_384].into_iter().flat_map(|m| [8, 16, 32, 64].map(|b| (m, b)));
    let grid: Vec<Shape> = sizes.filter(|&(m, b)| m >= b * b).collect();
    let sorts: [(&str, Sort); 2] = [
        ("funnelsort", |keys, probe| funnelsort_instrumented(keys, probe)),
        ("distribution sort", |keys, probe| distribution_sort_instrumented(keys, 7, probe)),
    ];
    for (name, sort) in sorts {
        let mut keys = Draw(1).words(n);
        let work = |probe: &mut Simulator| {
            sort(&mut keys, probe);
            Ok(())
        };
        let largest = ratio(&grid, work, |m, b| {
            let scan = n as f64 / b;
            scan * (1.0 + scan.ln() / (m / b).ln())
        })?;
        ensure!(keys.is_sorted(), "{name}: not in order");
        add(format!("{name}, n = {n}"), "(n/B)(1 + log_{M/B}(n/B))", largest, 6.0);
    }
    out.table("misses of LRU memories, M ≥ B², over the formula", table);
    Ok(())
}

/// The largest ratio of misses to a formula of M and B, of memories that all record the same run.
fn ratio(
    grid: &[Shape],
    work: impl FnOnce(&mut Simulator) -> Result<()>,
    formula: impl Fn(f64, f64) -> f64,
) -> Result<f64> {
    let shapes: Vec<CacheShape> =
        grid.iter().map(|&(m, b)| CacheShape::lru(m * WORD, b * WORD)).collect();
    let mut simulator = Simulator::new(&shapes)?;
    work(&mut simulator)?;
    ensure!(simulator.unannounced() == 0, "an access outside all arrays");
    let ratio = |(at, &(m, b)): (usize, &Shape)| {
        simulator.counts(at).misses as f64 / formula(m as f64, b as f64)
    };
    Ok(grid.iter().enumerate().map(ratio).fold(0.0, f64::max))
}
