//! Files larger than the memory that is allowed: sorted beside the crate extsort, and transposed.

use super::*;

/// How large things are.
struct Sizes {
    records: usize,
    sort_memory: usize,
    rows: usize,
    columns: usize,
    transpose_memory: usize,
}

const MEBIBYTE: f64 = 1048576.0;

/// A tenth and a sixteenth of what the goals speak of.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let usual = Sizes {
        records: 10_000_000,
        sort_memory: 26 << 20,
        rows: 8192,
        columns: 4096,
        transpose_memory: 16 << 20,
    };
    measure(
        context,
        out,
        &context.size(
            usual,
            Sizes {
                records: 400_000,
                sort_memory: 4 << 20,
                rows: 300,
                columns: 500,
                transpose_memory: 1 << 18,
            },
        ),
    )
}

/// 3.2 GB sorted and 4 GiB transposed, under 256 MiB.
pub(super) fn run_large(context: &Context, out: &mut Outcome) -> Result<()> {
    ensure!(context.scratch.is_some() && !context.quick, "give --scratch FOLDER, and not --quick");
    measure(
        context,
        out,
        &Sizes {
            records: 100_000_000,
            sort_memory: 256 << 20,
            rows: 32_768,
            columns: 16_384,
            transpose_memory: 256 << 20,
        },
    )
}

/// Both, in a folder that is removed at the end.
fn measure(context: &Context, out: &mut Outcome, sizes: &Sizes) -> Result<()> {
    let folder = match &context.scratch {
        Some(folder) => TempDir::new_in(folder)?,
        None => TempDir::new()?,
    };
    let mut table = Table::new(
        "work | file:MiB | limit:MiB | processor:s | clock:s | peak:MiB | I/O ÷ file:x | clock ÷ \
            copies:x",
    );
    let (from, to) = (folder.path().join("from"), folder.path().join("to"));
    let sorted = sort(context, sizes, [&from, &to], &mut table)?;
    let transposed = transposition(context, sizes, [&from, &to], &mut table)?;
    let [taut, extsort, queue, disk, _] = &sorted[..] else { bail!("five programs sort") };
    out.table("", table);
    let bytes = (sizes.records * RECORD_BYTES) as f64;
    let io = taut.counted.map_or(f64::NAN, |counted| counted as f64 / bytes);
    out.must("sort: I/O four times the file, within 1 %", times(io), (io - 4.0).abs() <= 0.04);
    // The program itself is among the bytes of the peak.
    let over = |cost: &FileCost, memory: usize| cost.peak.map(|peak| peak as f64 - memory as f64);
    let (sort, queue) = (over(taut, sizes.sort_memory), over(queue, sizes.sort_memory));
    out.at_most("sort: peak above the limit", sort, 32.0 * MEBIBYTE, Unit::Memory);
    out.at_most("queue: peak above the limit", queue, aim_only(16.0 * MEBIBYTE), Unit::Memory);
    let transposed = over(&transposed[0], sizes.transpose_memory);
    let what = "transposition: peak above the limit";
    out.at_most(what, transposed, 16.0 * MEBIBYTE, Unit::Memory);
    let ratio = extsort.cpu / taut.cpu;
    out.at_least("sort: processor time of extsort over taut's", ratio, 3.0, Unit::Times);
    let what = "sort: clock over that of the disk for as many bytes";
    out.at_most(what, taut.wall / (2.0 * disk.wall), aim_only(1.3), Unit::Times);
    Ok(())
}

/// taut, extsort, taut's queue, the disk alone, a copy; each sorted output is judged by taut's certificate, whose checker
/// shares no code with the sort. The disk alone needs a file system that can pass the cache.
fn sort(
    context: &Context,
    sizes: &Sizes,
    [from, to]: [&Path; 2],
    table: &mut Table,
) -> Result<Vec<FileCost>> {
    let mut draw = Draw(1);
    write(from, sizes.records * RECORD_BYTES / 8, || draw.word())?;
    let mut certificate = None;
    let judge = |work, cost: &FileCost| -> Result<()> {
        if matches!(work, Work::Disk | Work::Copy) {
            return Ok(());
        }
        if let Some((records, [high, low])) = cost.certificate {
            let hash = u128::from(high) << 64 | u128::from(low);
            certificate = Some((records, SortCertificate { hash: Hash128(hash) }));
        }
        let (records, certificate) = certificate.as_ref().context("taut comes first")?;
        ensure!(*records == sizes.records as u64, "records are missing");
        let answer = SortedFile {
            records: *records,
            width: RECORD_BYTES as u64,
            header: 0,
            key: [0, 8],
            key_kind: KeyKind::U64,
        };
        let mut output = File::open(to)?;
        let files = Files { input: None, output: &mut output };
        answer.check(certificate, files, &Monitor::silent())?;
        Ok(())
    };
    let works = [Work::Sort, Work::Extsort, Work::Queue, Work::Disk, Work::Copy];
    let file = (sizes.records * RECORD_BYTES) as u64;
    by_turns(context, &works, [from, to], (sizes.sort_memory, 1, file, 2.0), judge, table)
}

/// taut and a copy; the output is compared whole.
fn transposition(
    context: &Context,
    sizes: &Sizes,
    [from, to]: [&Path; 2],
    table: &mut Table,
) -> Result<Vec<FileCost>> {
    let mut draw = Draw(2);
    write(from, sizes.rows * sizes.columns, || draw.word())?;
    let (rows, columns) = (sizes.rows as u64, sizes.columns as u64);
    let answer = TransposedFile {
        rows,
        columns,
        width: 8,
        order: ElementOrder::Rows,
        input_offset: 0,
        output_offset: 0,
        dtype: None,
    };
    let judge = |work, _: &FileCost| -> Result<()> {
        if work == Work::Transpose {
            let [mut input, mut output] = [File::open(from)?, File::open(to)?];
            let files = Files { input: Some(&mut input), output: &mut output };
            answer.certify(files, &Monitor::silent())?;
        }
        Ok(())
    };
    let works = [Work::Transpose, Work::Copy];
    let file = rows * columns * 8;
    by_turns(context, &works, [from, to], (sizes.transpose_memory, rows, file, 1.0), judge, table)
}

/// Each in a process of its own, by turns. Of times the least counts, of peaks the largest.
fn by_turns(
    context: &Context,
    works: &[Work],
    [from, to]: [&Path; 2],
    (memory, rows, bytes, copies): (usize, u64, u64, f64),
    mut judge: impl FnMut(Work, &FileCost) -> Result<()>,
    table: &mut Table,
) -> Result<Vec<FileCost>> {
    let mut rounds = vec![vec![]; works.len()];
    for _ in 0..context.runs {
        for (&work, costs) in works.iter().zip(&mut rounds) {
            let [from, to] = [from, to].map(Path::to_owned);
            // A host that took free memory back gives it again at the cost of whoever accesses it first.
            have_memory(memory)?;
            let output = to.clone();
            let cost: FileCost = Job::File(Task { work, memory, rows, from, to }).finish()?;
            judge(work, &cost)?;
            std::fs::remove_file(output)?;
            costs.push(cost);
        }
    }
    let best: Vec<FileCost> = rounds.iter().filter_map(|costs| best(costs)).collect();
    let copy = copies * best[best.len() - 1].wall;
    for ((work, cost), rounds) in works.iter().zip(&best).zip(&rounds) {
        table.push(json!({
            "work": work, "file": bytes, "limit": memory, "processor": cost.cpu, "clock": cost.wall, "peak": cost.peak,
            "I/O ÷ file": cost.io.map(|io| io as f64 / bytes as f64), "clock ÷ copies": cost.wall / copy,
            "rounds": rounds,
        }));
    }
    Ok(best)
}

/// The least times, and the most of all else.
fn best(costs: &[FileCost]) -> Option<FileCost> {
    let mut costs = costs.iter().cloned();
    let mut best = costs.next()?;
    for cost in costs {
        best.cpu = best.cpu.min(cost.cpu);
        best.wall = best.wall.min(cost.wall);
        best.peak = best.peak.max(cost.peak);
        best.io = best.io.max(cost.io);
        best.counted = best.counted.max(cost.counted);
    }
    Some(best)
}

/// Words, least significant byte first.
fn write(path: &Path, words: usize, mut word: impl FnMut() -> u64) -> Result<()> {
    let mut file = BufWriter::with_capacity(1 << 20, File::create(path)?);
    for _ in 0..words {
        file.write_all(&word().to_le_bytes())?;
    }
    // Not to be written while something else is timed.
    Ok(file.into_inner()?.sync_data()?)
}
