//! taut as a program of its own: one surface, one line, as the Delaunay peers do it.

use super::*;

/// What to reconstruct.
#[derive(Serialize, Deserialize)]
pub(crate) struct Task {
    threads: usize,
    /// Little-endian doubles, row by row.
    file: PathBuf,
}

impl Task {
    /// Reconstructs, and tells what it cost; then the triangles are judged.
    pub(crate) fn perform(&self) -> Result<Build> {
        let values = read_raw(&self.file)?;
        let points = Points::new(&values, 3)?;
        let options = SurfaceOptions { threads: Some(self.threads), ..Default::default() };
        let meter = Meter::start();
        let found = surface(&points, &options)?;
        let cost = meter.stop();
        let triangles = &found.answer.triangles;
        let judged = Judged::of(values.as_chunks().0, triangles)?;
        Ok(Build::of_taut(points.len(), triangles.len() as u64, cost, judged.counters()))
    }
}

/// The surface of the points in `file`, in a process of its own.
pub(super) fn alone(
    threads: usize,
    file: &Path,
    limit: Duration,
) -> Result<Result<Build, Silence>> {
    Job::Surface(Task { threads, file: file.to_owned() }).run(limit)
}
