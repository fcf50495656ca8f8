//! A file larger than the memory that is allowed: passes beside `cat`, and the peak memory of the process.

use super::*;

/// The process that solves one raw file and nothing else, so that its peak memory is that of the solver.
#[derive(Serialize, Deserialize)]
pub(crate) struct Task {
    /// The file: n · d little-endian single-precision values.
    path: PathBuf,
    n: u64,
    dim: usize,
    threads: usize,
}

/// What that process tells.
#[derive(Serialize, Deserialize)]
pub(crate) struct Solved {
    seconds: f64,
    /// Seconds of each pass, from its announcement to the last of its points.
    passes: Vec<f64>,
    stop: Stop,
    radius: f64,
    /// What the checker proves, or why it rejects the answer.
    gap: Result<f64, String>,
    core_set: u64,
    support: usize,
    /// Peak resident memory of the process up to the answer, bytes; `None` where /proc is missing.
    peak: Option<u64>,
}

impl Task {
    /// Solves the file, and verifies the answer.
    pub(crate) fn perform(&self) -> Result<Solved> {
        let source = FileSource::open(&self.path, 0, self.n, self.dim, ScalarKind::F32)?;
        // Of each pass: when it began, how many of its points are done, when the last was.
        let clock: Mutex<Vec<(Instant, u64, Instant)>> = Mutex::new(Vec::new());
        let lock = || clock.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        let on_pass = |_, _| {
            let now = Instant::now();
            lock().push((now, 0, now));
        };
        let on_points = |points| {
            if let Some((_, done, last)) = lock().last_mut() {
                *done += points;
                if *done <= self.n {
                    *last = Instant::now();
                }
            }
        };
        let monitor =
            Monitor { on_points: Some(&on_points), on_pass: Some(&on_pass), cancel: None };
        let threads = Some(self.threads);
        let options = BallOptions { epsilon: 0.0, threads, monitor, ..BallOptions::default() };
        let start = Instant::now();
        let found = ball(&source, &options)?;
        let seconds = start.elapsed().as_secs_f64();
        let peak = meter::peak();
        let verdict = found.check(&source);
        let spent = |(began, _, ended): &(Instant, u64, Instant)| (*ended - *began).as_secs_f64();
        let passes = lock().iter().map(spent).collect();
        Ok(Solved {
            seconds,
            passes,
            stop: found.trace.stop,
            radius: found.answer.radius,
            gap: verdict.map(|verdict| verdict.gap).map_err(|why| why.to_string()),
            core_set: found.trace.core_set,
            support: found.certificate.support.len(),
            peak,
        })
    }
}

/// Makes the file unless it is there, then solves and reads it by turns.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let (n, dim) = (context.size(1_000_000, 20_000), 2500);
    let Some(folder) = context.folder("10 GB") else { return out.left_out() };
    let path = raw::make(&folder, n, dim)?;
    let threads = context.last_threads();
    let mut table = Table::new(
        "run | cat before:s | cat after:s | solve:s | passes | seconds of each pass:2 | speed of \
            each pass:% | peak memory:MiB | radius:12 | core-set | support",
    );
    let (mut of_cat, mut found) = (Vec::new(), Found::default());
    cat(&path)?; // so that all runs find what memory can hold in memory
    let mut before = cat(&path)?;
    for run in 0..context.runs.min(3) {
        let task = Task { path: path.clone(), n, dim, threads };
        let solved: Solved = Job::Ball(task).finish()?;
        let after = cat(&path)?;
        let beside = 0.5 * (before + after);
        let speeds: Vec<f64> = solved.passes.iter().map(|pass| beside / pass).collect();
        table.push(json!({
            "run": run + 1, "cat before": before, "cat after": after, "solve": solved.seconds,
            "passes": solved.passes.len(), "seconds of each pass": solved.passes, "speed of each pass": speeds,
            "peak memory": solved.peak, "radius": solved.radius, "core-set": solved.core_set,
            "support": solved.support,
        }));
        of_cat.extend(speeds);
        before = after;
        found.check(solved.gap);
        found.add(PASSES, solved.passes.len() as f64);
        found.add(MEMORY, solved.peak.map(|peak| peak as f64));
        found.add_with_text(BUDGET_STOPS, Some(stops(solved.stop)));
    }
    let slowest = Summary::of(&of_cat);
    found.add_with_text(OF_CAT, slowest.map(|s| (s.min, format!("slowest: {}", range(s, times)))));
    let size = (n * dim as u64 * 4) as f64 / 1e9;
    let path = path.display();
    let caption = format!(
        "{path}: {size:.2} GB, {threads} threads; speed is that of `cat` beside it = 100 %"
    );
    out.table(&caption, table);
    out.judge(&found);
    Ok(())
}

/// Seconds of `cat FILE > /dev/null`.
fn cat(path: &Path) -> Result<f64> {
    let start = Instant::now();
    let status = Command::new("cat").arg(path).stdout(Stdio::null()).status().context("cat")?;
    ensure!(status.success(), "cat failed on {}", path.display());
    Ok(start.elapsed().as_secs_f64())
}
