//! Numbers and records in order, in memory.

use std::time::Duration;

use anyhow::{Result, ensure};
use rdst::RadixSort;
use serde_json::{Value, json};
use voracious_radix_sort::RadixSort as _;

use super::draw::{PATTERNS, Pattern};
use super::guests::Guests;
use super::lanes::{Lanes, have_memory};
use crate::context::Context;
use crate::goals::Goals;
use crate::stats::times;
use crate::table::Table;

/// 32 bytes, of which eight are the key.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Record {
    key: u64,
    rest: [u64; 3],
}

const STD: &str = "std unstable";
const STABLE: &str = "std stable";
/// taut when no memory was taken or given back for a while; see `lanes`.
const TAUT_RESTED: &str = "taut, after a rest";
/// The pause before a rested run: a host takes free memory back after two seconds.
const REST_TIME: Duration = Duration::from_secs(4);
/// numpy's sort, with the vectors that it chooses and with shorter ones: where compressed stores are slow, these are faster.
const NUMPY: [&str; 2] = ["numpy-sort", "numpy-sort-avx2"];

/// Uniform keys at full size, then all patterns at a tenth of it.
pub(super) fn run(context: &Context) -> Result<Value> {
    let n = if context.quick { 100_000 } else { 10_000_000 };
    let mut goals = Goals::default();
    let mut measured = vec![];
    let uniform = keys(context, &PATTERNS[0], n, &NUMPY)?;
    measured.push(report("keys", &PATTERNS[0], n, &uniform));
    let whole = records(context, &PATTERNS[0], n, true)?;
    measured.push(report("records", &PATTERNS[0], n, &whole));
    for (what, lanes) in [("u64", &uniform), ("records of 32 bytes", &whole)] {
        println!("{n} {what}, uniform\n\n{}", lanes.table(n));
    }
    let n = n / 10;
    let mut table = Table::new(&["pattern", "ns, key", "std ÷ taut", "ns, record", "std ÷ taut"]);
    let mut worst = [(0.0, ""); 2];
    for pattern in &PATTERNS {
        let both = [keys(context, pattern, n, &[])?, records(context, pattern, n, false)?];
        let mut cells = vec![pattern.name.to_owned()];
        for (lanes, worst) in both.iter().zip(&mut worst) {
            let slower = lanes.faster(STD, "taut");
            if slower > worst.0 {
                *worst = (slower, pattern.name);
            }
            cells.push(format!("{:.2}", lanes.of("taut") / n as f64 * 1e9));
            cells.push(times(1.0 / slower));
        }
        table.push(cells);
        measured.push(report("keys", pattern, n, &both[0]));
        measured.push(report("records", pattern, n, &both[1]));
    }
    println!("{n} of each pattern\n\n{table}");
    let over = |lanes: &Lanes, other| lanes.faster("taut", other);
    goals.at_least("u64: std unstable over taut", over(&uniform, STD), (2.0, None));
    goals.at_least("u64: rdst over taut", over(&uniform, "rdst"), (1.0, None));
    let numpy = NUMPY.map(|name| uniform.faster(name, "taut"));
    // NaN, of one that is missing, is no larger.
    let numpy = numpy.into_iter().fold(f64::NAN, f64::max);
    let met = (!numpy.is_nan()).then_some(numpy <= 1.1);
    goals.aim("u64: taut over the faster numpy at most 1.1".into(), times(numpy), met);
    let what = "records: std unstable over taut";
    goals.at_least(what, over(&whole, STD), (1.7, Some(2.0)));
    let rested = whole.faster(TAUT_RESTED, STD);
    goals.at_least("records, after a rest: std unstable over taut", rested, (1.7, Some(2.0)));
    for ((slower, name), what) in worst.into_iter().zip(["u64", "records"]) {
        let what = format!("{what}, worst pattern ({name}): taut over std unstable");
        goals.at_most(&what, Some(slower), (1.2, None), times);
    }
    Ok(json!({ "measured": measured, "goals": goals.json() }))
}

/// Numbers; all programs must leave what std's stable sort leaves. Peers by name are processes, which take turns too.
fn keys(context: &Context, pattern: &Pattern, n: usize, names: &[&'static str]) -> Result<Lanes> {
    let given = (pattern.keys)(n);
    let mut expected = given.clone();
    expected.sort();
    let mut guests = Guests::invite(context, &given, 1, names)?;
    let mut lanes = Lanes::default();
    let mut work = given.clone();
    for _ in 0..context.runs {
        let mut run = |name, sort: fn(&mut Vec<u64>)| {
            work.copy_from_slice(&given);
            have_memory(2 * size_of_val(&given[..]))?;
            lanes.time(name, || sort(&mut work));
            ensure!(work == expected, "{name}: {} is not in order", pattern.name);
            Ok(())
        };
        run("taut", |keys| taut_oblivious::sort(keys))?;
        run(STD, |keys| keys.sort_unstable())?;
        run("rdst", |keys| {
            keys.radix_sort_builder().with_low_mem_tuner().with_parallel(false).sort()
        })?;
        run("voracious", |keys| keys.voracious_sort())?;
        guests.turn(context, &mut lanes, |name, sorted| {
            ensure!(sorted == expected, "{name}: {} is not in order", pattern.name);
            Ok(())
        })?;
    }
    Ok(lanes)
}

/// Records by key. taut is stable and must leave what std's stable sort leaves; the unstable one, keys in order.
/// With `rest` it also sorts after a pause, in memory that a host may have taken back.
fn records(context: &Context, pattern: &Pattern, n: usize, rest: bool) -> Result<Lanes> {
    let record = |(at, key): (usize, u64)| Record { key, rest: [at as u64, !key, key] };
    let given: Vec<Record> = (pattern.keys)(n).into_iter().enumerate().map(record).collect();
    let mut expected = given.clone();
    expected.sort_by_key(|record| record.key);
    let mut lanes = Lanes::default();
    let mut work = given.clone();
    let names: &[_] =
        if rest { &["taut", STD, STABLE, TAUT_RESTED] } else { &["taut", STD, STABLE] };
    for _ in 0..context.runs {
        for &name in names {
            work.copy_from_slice(&given);
            match name {
                TAUT_RESTED => std::thread::sleep(REST_TIME),
                _ => have_memory(2 * size_of_val(&given[..]))?,
            }
            lanes.time(name, || match name {
                STD => work.sort_unstable_by_key(|record| record.key),
                STABLE => work.sort_by_key(|record| record.key),
                _ => taut_oblivious::sort_records(&mut work, |record| record.key),
            });
            let right = match name {
                STD => work.is_sorted_by_key(|record| record.key),
                _ => work == expected,
            };
            ensure!(right, "{name}: records of {} are not in order", pattern.name);
        }
    }
    Ok(lanes)
}

/// One input, for the report.
fn report(what: &str, pattern: &Pattern, n: usize, lanes: &Lanes) -> Value {
    json!({ "what": what, "pattern": pattern.name, "n": n, "lanes": lanes.json(n) })
}
