//! Numbers and records in order, in memory.

use super::*;

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
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.size(10_000_000, 100_000);
    let uniform = keys(context, &PATTERNS[0], n, &NUMPY)?;
    let whole = records(context, &PATTERNS[0], n, true)?;
    for (what, lanes) in [("u64", &uniform), ("records of 32 bytes", &whole)] {
        out.table(&format!("{n} {what}, uniform"), lanes.table(n));
    }
    let n = n / 10;
    let mut table = Table::new("pattern | key:ns | std ÷ taut:x | record:ns | its std ÷ taut:x");
    let mut worst = [(0.0, ""); 2];
    for pattern in &PATTERNS {
        let both = [keys(context, pattern, n, &[])?, records(context, pattern, n, false)?];
        for (lanes, worst) in both.iter().zip(&mut worst) {
            let slower = lanes.faster(STD, "taut");
            if slower > worst.0 {
                *worst = (slower, pattern.name);
            }
        }
        let [key, record] = both.each_ref().map(|lanes| lanes.of("taut") / n as f64);
        let [faster, record_faster] = both.each_ref().map(|lanes| lanes.faster("taut", STD));
        table.push(json!({
            "pattern": pattern.name, "key": key, "std ÷ taut": faster, "record": record, "its std ÷ taut": record_faster,
            "lanes": both.map(|lanes| lanes.json(n)),
        }));
    }
    out.table(&format!("{n} of each pattern"), table);
    let over = |lanes: &Lanes, other| lanes.faster("taut", other);
    out.at_least("u64: std unstable over taut", over(&uniform, STD), 2.0, Unit::Times);
    out.at_least("u64: rdst over taut", over(&uniform, "rdst"), 1.0, Unit::Times);
    let numpy = NUMPY.map(|name| uniform.faster(name, "taut"));
    // NaN, of one that is missing, is no larger.
    let numpy = numpy.into_iter().fold(f64::NAN, f64::max);
    let numpy = (!numpy.is_nan()).then_some(numpy);
    out.at_most("u64: taut over the faster numpy", numpy, aim_only(1.1), Unit::Times);
    let what = "records: std unstable over taut";
    out.at_least(what, over(&whole, STD), [1.7, 2.0], Unit::Times);
    let rested = whole.faster(TAUT_RESTED, STD);
    let what = "records, after a rest: std unstable over taut";
    out.at_least(what, rested, [1.7, 2.0], Unit::Times);
    for ((slower, name), what) in worst.into_iter().zip(["u64", "records"]) {
        let what = format!("{what}, worst pattern ({name}): taut over std unstable");
        out.at_most(what, slower, 1.2, Unit::Times);
    }
    Ok(())
}

/// Numbers; all programs must leave what std's stable sort leaves. Peers by name are processes, which take turns too.
fn keys(context: &Context, pattern: &Pattern, n: usize, names: &[&'static str]) -> Result<Lanes> {
    let given = (pattern.keys)(n);
    let mut expected = given.clone();
    expected.sort();
    let mut peers = Peers::start(context, &given, 1, names)?;
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
        peers.turn(context, &mut lanes, |name, sorted| {
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
