//! taut as a program of its own: one build, one line, as the peers do it.

use super::*;

/// What to build.
#[derive(Serialize, Deserialize)]
pub(crate) struct Task {
    /// 2 or 3.
    pub(super) dim: usize,
    pub(super) threads: usize,
    /// Whether the answer is judged as well, when the build is over.
    pub(super) check: bool,
    /// Little-endian doubles, row by row.
    pub(super) file: PathBuf,
}

impl Task {
    /// Builds the triangulation, and tells what it cost.
    pub(crate) fn perform(&self) -> Result<Build> {
        let values = read_raw(&self.file)?;
        let points = Points::new(&values, self.dim)?;
        let options = DelaunayOptions { threads: Some(self.threads), ..Default::default() };
        let meter = Meter::start();
        match self.dim {
            2 => self.report(&points, &Plane::build(&points, &options)?, meter),
            3 => self.report(&points, &Space::build(&points, &options)?, meter),
            dim => bail!("the dimension is {dim}: expected 2 or 3"),
        }
    }

    fn report<const D: usize, const V: usize>(
        &self,
        points: &Points<'_, f64>,
        built: &Triangulation<D, V>,
        meter: Meter,
    ) -> Result<Build> {
        let build = line(points.len(), meter.stop(), built);
        Ok(Build { judged: self.judge(built, points)?, ..build })
    }

    /// What it takes to have an answer of the triangulation and to judge it, with as many threads as the build.
    fn judge<const D: usize, const V: usize>(
        &self,
        built: &Triangulation<D, V>,
        points: &Points<'_, f64>,
    ) -> Result<Option<Judged>> {
        if !self.check {
            return Ok(None);
        }
        pool(self.threads)?.install(|| {
            let meter = Meter::start();
            let solution = built.solution(points, &Monitor::silent())?;
            let answer = meter.stop().cpu;
            let meter = Meter::start();
            let verdict = solution.check(points);
            let check = meter.stop().cpu;
            Ok(Some(Judged { answer, check, rejected: verdict.err().map(|why| why.to_string()) }))
        })
    }
}

fn line<const D: usize, const V: usize>(
    points: usize,
    cost: Cost,
    built: &Triangulation<D, V>,
) -> Build {
    let simplices = match built.complex() {
        Complex::Nothing => 0,
        Complex::Point => 1,
        Complex::Line(chain) => chain.len() as u64 - 1,
        Complex::Flat(triangles) => triangles.iter().filter(|t| !t.is_ghost()).count() as u64,
        Complex::Full => built.simplices().count() as u64,
    };
    let Counters { insertions, walk_steps, orientations, conflict_tests, replaced, stages } =
        *built.counters();
    let open = stages.calls() - stages.filter;
    let calls = orientations + conflict_tests;
    let counters = [
        ("sites", built.site_count() as u64),
        ("insertions", insertions),
        ("walk_steps", walk_steps),
        ("orientations", orientations),
        ("conflict_tests", conflict_tests),
        ("replaced", replaced),
        ("integer", stages.integer),
        ("double_double", stages.double_double),
        ("wide", stages.wide),
        ("unbounded", stages.unbounded),
        ("ties", stages.ties),
    ];
    let exact = (calls > 0).then(|| open as f64 / calls as f64);
    Build { exact, ..Build::of_taut(points, simplices, cost, counters) }
}
