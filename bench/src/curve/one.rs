//! taut as a program of its own: one reconstruction, one line, as the Delaunay peers do it.

use super::*;

/// What to reconstruct.
#[derive(Serialize, Deserialize)]
pub(crate) struct Task {
    method: String,
    threads: usize,
    /// Little-endian doubles, row by row.
    file: PathBuf,
}

impl Task {
    /// Reconstructs, and tells what it cost.
    pub(crate) fn perform(&self) -> Result<Build> {
        let values = read_raw(&self.file)?;
        let points = Points::new(&values, 2)?;
        let method: CurveMethod = self.method.parse()?;
        let options = CurveOptions { method, threads: Some(self.threads), ..Default::default() };
        let meter = Meter::start();
        let found = curve(&points, &options)?;
        let cost = meter.stop();
        let curves = &found.answer.curves;
        let edges =
            curves.iter().map(|curve| curve.vertices.len() as u64 - u64::from(!curve.closed));
        let counters = [("curves", curves.len() as u64)];
        Ok(Build::of_taut(points.len(), edges.sum(), cost, counters))
    }
}

/// One reconstruction of the points in `file`, in a process of its own.
pub(super) fn alone(
    method: CurveMethod,
    threads: usize,
    file: &Path,
    limit: Duration,
) -> Result<Result<Build, Silence>> {
    let method = method.name().to_owned();
    Job::Curve(Task { method, threads, file: file.to_owned() }).run(limit)
}
