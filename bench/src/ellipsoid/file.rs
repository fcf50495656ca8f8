//! A file larger than the memory that is allowed: reads of it, and the peak memory of the process that solves it.

use super::*;

const D: usize = 3;

/// The process that solves one raw file and nothing else, so that its peak memory is that of the solver.
#[derive(Serialize, Deserialize)]
pub(crate) struct Task {
    /// The file: n · 3 little-endian single-precision values.
    path: PathBuf,
    n: u64,
    threads: usize,
}

/// What that process tells.
#[derive(Serialize, Deserialize)]
pub(crate) struct Solved {
    seconds: f64,
    passes: u64,
    log_volume: f64,
    /// What the checker proves, or why it rejects the answer.
    gap: Result<f64, String>,
    support: usize,
    /// Peak resident memory of the process up to the answer, bytes; `None` where /proc is missing.
    peak: Option<u64>,
}

impl Task {
    /// Solves the file, and verifies the answer.
    pub(crate) fn perform(&self) -> Result<Solved> {
        let source = FileSource::open(&self.path, 0, self.n, D, ScalarKind::F32)?;
        let options = EllipsoidOptions { threads: Some(self.threads), ..Default::default() };
        let start = Instant::now();
        let found = ellipsoid(&source, &options)?;
        let seconds = start.elapsed().as_secs_f64();
        let peak = meter::peak();
        Ok(Solved {
            seconds,
            passes: found.trace.passes,
            log_volume: found.answer.log_volume,
            gap: found.check(&source).map(|verdict| verdict.gap).map_err(|why| why.to_string()),
            support: found.certificate.support.len(),
            peak,
        })
    }
}

/// Makes the file unless it is there, then solves it in a process of its own.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.size(100_000_000, 1_000_000);
    let Some(folder) = context.folder("1.2 GB") else { return out.left_out() };
    let path = raw::make(&folder, n, D)?;
    let mut table =
        Table::new("threads | time:s | passes | verified gap | support | peak memory:MiB");
    let mut found = Found::default();
    for &threads in &context.threads {
        let solved: Solved = Job::Ellipsoid(Task { path: path.clone(), n, threads }).finish()?;
        table.push(json!({
            "threads": threads, "time": solved.seconds, "passes": solved.passes,
            "verified gap": shown_gap(&solved.gap), "support": solved.support, "peak memory": solved.peak,
            "log_volume": solved.log_volume,
        }));
        found.check(solved.gap);
        found.add(PASSES, solved.passes as f64);
        found.add(MEMORY, solved.peak.map(|peak| peak as f64));
    }
    out.table(&format!("{}: {:.2} GB", path.display(), (n * 4 * D as u64) as f64 / 1e9), table);
    out.judge(&found);
    Ok(())
}
