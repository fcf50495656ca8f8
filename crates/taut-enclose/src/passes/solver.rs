//! A solver that waits where it would read.

use std::collections::HashMap;
use std::ops::Range;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{JoinHandle, spawn};
use std::time::Duration;

use taut_certify::{AnySolution, Items, Placement, RobustMethod};
use taut_points::{
    Cancelled, Elsewhere, InputError, Monitor, PartsError, PointSource, Points, ReadError, Rows,
    Scalar, ScalarKind, Scratch,
};

use super::partial::Partial;
use super::query::{Query, Question};
use crate::{
    BallOptions, CentersMethod, CentersOptions, EllipsoidMethod, EllipsoidOptions, Error,
    RobustInParts, RobustOptions, StreamingCenters, ball, centers, ellipsoid, robust,
};

/// The interval at which a caller who waits for the next query is asked whether to go on. It delays a stop, never a query.
const ASK_INTERVAL: Duration = Duration::from_millis(50);

/// A solver with one open [`Query`] at a time; see the [module](super).
#[derive(Debug)]
pub struct Solver(Asking<AnySolution>);

/// A solver of robust ellipsoids. What it finds is no [`Solution`](taut_certify::Solution), as a certificate names half of all rows.
#[derive(Debug)]
pub struct RobustSolver(Asking<RobustInParts>);

/// A thread that solves and asks, and its end, once that was reached.
#[derive(Debug)]
struct Asking<T> {
    queries: Receiver<Query>,
    partials: Sender<Partial>,
    cancel: Arc<AtomicBool>,
    worker: Option<JoinHandle<Result<T, Error>>>,
    open: Option<Query>,
    solution: Option<Result<T, Error>>,
}

impl Solver {
    /// The smallest ball around `n` points or balls, rows of so many columns.
    ///
    /// # Errors
    /// Those of [`ball()`] for options; ellipsoids are refused, as their passes are others.
    pub fn ball(n: u64, columns: usize, options: BallOptions<'static>) -> Result<Self, Error> {
        options.check()?;
        if options.inputs == Items::Ellipsoids {
            let (name, value) = ("inputs", options.inputs.name().to_owned());
            let expected = "points or balls, as ellipsoids are solved in memory";
            return Err(Error::Input(InputError::Option { name, value, expected }));
        }
        Ok(Self::start(n, columns, move |source, monitor| {
            let options = BallOptions { monitor: *monitor, ..options };
            ball(source, &options).map(AnySolution::from)
        }))
    }

    /// The ellipsoid of least volume around `n` points of so many coordinates.
    ///
    /// # Errors
    /// Those of [`ellipsoid()`] for options; balls and ellipsoids, and methods other than
    /// [`Newton`](EllipsoidMethod::Newton), are refused, as their passes are others. Points that lie in a flat are refused when that is
    /// seen, with [`Error::FlatInParts`].
    pub fn ellipsoid(
        n: u64,
        columns: usize,
        options: EllipsoidOptions<'static>,
    ) -> Result<Self, Error> {
        options.check()?;
        let refused = |name, value: &str, expected| {
            Err(Error::Input(InputError::Option { name, value: value.to_owned(), expected }))
        };
        if options.inputs != Items::Points {
            let expected = "points, as others are solved in memory";
            return refused("inputs", options.inputs.name(), expected);
        }
        if options.method != EllipsoidMethod::Newton {
            let expected = "newton, as the other methods are for points in memory";
            return refused("method", options.method.name(), expected);
        }
        Ok(Self::start(n, columns, move |source, monitor| {
            let options = EllipsoidOptions { monitor: *monitor, ..options };
            ellipsoid(source, &options).map(AnySolution::from)
        }))
    }

    /// The centers of a stream, once all rows came by in their order: one pass measures them.
    ///
    /// The first pass is not a query, as each part takes over the cover of the one before it:
    /// [`to_bytes`](StreamingCenters::to_bytes) and [`from_bytes`](StreamingCenters::from_bytes) carry it there.
    pub fn centers(cover: StreamingCenters, placement: Placement) -> Self {
        Self::start(cover.len(), cover.dim(), move |source, monitor| {
            cover.solution(placement, source, monitor).map(AnySolution::from)
        })
    }

    /// k centers of `n` points of so many coordinates, by farthest-first traversal or by a search over a core-set, to the gap that is
    /// wanted ([`CentersMethod::Tree`]).
    ///
    /// Answer and certificate of a traversal are those of [`centers()`]; the trace counts the passes that were made here. A search
    /// over a core-set proves the gap as well, with other centers.
    ///
    /// # Errors
    /// Those of [`centers()`] for options; balls and ellipsoids, weights, groups, outliers, an assignment, other methods, and centers
    /// among the rows by a search are refused, as they need all rows in one place.
    pub fn k_centers(
        n: u64,
        columns: usize,
        k: usize,
        options: CentersOptions<'static>,
    ) -> Result<Self, Error> {
        options.check(k)?;
        let refused = |name, value: &str, expected| {
            Err(Error::Input(InputError::Option { name, value: value.to_owned(), expected }))
        };
        if !matches!(options.method, CentersMethod::Tree | CentersMethod::FarthestFirst) {
            let expected = "tree or farthest-first; streams have a solver of their own";
            return refused("method", options.method.name(), expected);
        }
        if options.inputs != Items::Points || options.weights {
            return refused("inputs", options.inputs.name(), "points without weights, in parts");
        }
        if options.group.is_some() || options.outliers > 0 || options.assignment {
            let expected = "neither groups, outliers nor an assignment, in parts";
            return refused("options", "more than centers", expected);
        }
        if options.method == CentersMethod::Tree && options.placement == Placement::Rows {
            return refused("placement", "rows", "free for a search over a core-set");
        }
        Ok(Self::start(n, columns, move |source, monitor| {
            let options = CentersOptions { monitor: *monitor, ..options };
            centers(source, k, &options).map(AnySolution::from)
        }))
    }

    fn start(
        n: u64,
        columns: usize,
        solve: impl FnOnce(&dyn PointSource, &Monitor<'_>) -> Result<AnySolution, Error>
        + Send
        + 'static,
    ) -> Self {
        Solver(Asking::start(n, columns, solve))
    }

    /// The query that waits for its answer; `None` once there is a solution.
    ///
    /// # Errors
    /// [`Cancelled`] when the monitor stops the wait. The query can be asked for again.
    pub fn query(&mut self, monitor: &Monitor<'_>) -> Result<Option<&Query>, Cancelled> {
        self.0.query(monitor)
    }

    /// Hands over the answer of all rows to the open query.
    ///
    /// # Errors
    /// [`PartsError`] where it is none; then the query stays open.
    pub fn feed(&mut self, partial: Partial) -> Result<(), PartsError> {
        self.0.feed(partial)
    }

    /// The solution.
    ///
    /// # Errors
    /// Those of the function in memory; [`PartsError::Open`] while a query waits for its answer.
    pub fn solution(self, monitor: &Monitor<'_>) -> Result<AnySolution, Error> {
        self.0.solution(monitor)
    }
}

impl RobustSolver {
    /// Center and scatter of most of `n` points of so many coordinates, by minimum covariance determinant.
    ///
    /// The search of [`robust_ellipsoid`](crate::robust_ellipsoid) runs over a sample. From what that finds, C-steps over all points
    /// lead to rows that are the h nearest in their own metric.
    ///
    /// # Errors
    /// Those of [`robust_ellipsoid`](crate::robust_ellipsoid) for options; other methods than [`RobustMethod::Mcd`] are refused.
    pub fn new(n: u64, columns: usize, options: RobustOptions<'static>) -> Result<Self, Error> {
        options.check()?;
        if options.method != RobustMethod::Mcd {
            let (name, value) = ("method", options.method.name().to_owned());
            let expected = "mcd, as the other methods are for points in memory";
            return Err(Error::Input(InputError::Option { name, value, expected }));
        }
        Ok(RobustSolver(Asking::start(n, columns, move |source, monitor| {
            robust::in_parts(source, &RobustOptions { monitor: *monitor, ..options })
        })))
    }

    /// As [`Solver::query`].
    ///
    /// # Errors
    /// As [`Solver::query`].
    pub fn query(&mut self, monitor: &Monitor<'_>) -> Result<Option<&Query>, Cancelled> {
        self.0.query(monitor)
    }

    /// As [`Solver::feed`].
    ///
    /// # Errors
    /// As [`Solver::feed`].
    pub fn feed(&mut self, partial: Partial) -> Result<(), PartsError> {
        self.0.feed(partial)
    }

    /// The estimate.
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::Overflow`], [`Error::MostFlatInParts`]; [`PartsError::Open`] while a query waits for its answer.
    pub fn solution(self, monitor: &Monitor<'_>) -> Result<RobustInParts, Error> {
        self.0.solution(monitor)
    }
}

impl<T: Send + 'static> Asking<T> {
    fn start(
        n: u64,
        columns: usize,
        solve: impl FnOnce(&dyn PointSource, &Monitor<'_>) -> Result<T, Error> + Send + 'static,
    ) -> Self {
        let (ask, queries) = channel();
        let (partials, answers) = channel();
        let cancel = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&cancel);
        let worker = spawn(move || {
            let line = Mutex::new(Line { ask, answers, rows: HashMap::new() });
            let monitor = Monitor { cancel: Some(&flag), ..Monitor::silent() };
            solve(&Remote { n, columns, line }, &monitor)
        });
        let (open, solution) = (None, None);
        Asking { queries, partials, cancel, worker: Some(worker), open, solution }
    }
}

impl<T> Asking<T> {
    fn query(&mut self, monitor: &Monitor<'_>) -> Result<Option<&Query>, Cancelled> {
        while self.open.is_none() && self.solution.is_none() {
            match self.queries.recv_timeout(ASK_INTERVAL) {
                Ok(query) => self.open = Some(query),
                Err(RecvTimeoutError::Timeout) => monitor.check()?,
                Err(RecvTimeoutError::Disconnected) => {
                    let worker = self.worker.take().expect("it is taken once, here");
                    let ended = worker.join().unwrap_or_else(|panic| resume_unwind(panic));
                    self.solution = Some(ended);
                }
            }
        }
        Ok(self.open.as_ref())
    }

    fn feed(&mut self, partial: Partial) -> Result<(), PartsError> {
        let query = self.open.as_ref().ok_or(PartsError::Question)?;
        partial.check(query)?;
        self.open = None;
        // A worker that ended nevertheless has a solution or an error, which the next call finds.
        let _ = self.partials.send(partial);
        Ok(())
    }

    fn solution(mut self, monitor: &Monitor<'_>) -> Result<T, Error> {
        if self.query(monitor).map_err(InputError::from)?.is_some() {
            return Err(PartsError::Open.into());
        }
        self.solution.take().unwrap_or(Err(PartsError::Open.into()))
    }
}

impl<T> Drop for Asking<T> {
    fn drop(&mut self) {
        self.cancel.store(true, Ordering::Relaxed);
    }
}

/// Rows that are held elsewhere, as the solver sees them.
struct Remote {
    n: u64,
    columns: usize,
    line: Mutex<Line>,
}

struct Line {
    ask: Sender<Query>,
    answers: Receiver<Partial>,
    /// Every row that came with an answer: solvers ask for few others.
    rows: HashMap<u64, Vec<f64>>,
}

impl Line {
    /// One question and its answer; a solver that was dropped cancels the work.
    fn exchange(&mut self, query: Query) -> Result<Partial, ReadError> {
        self.ask.send(query).map_err(|_| Cancelled)?;
        let partial = self.answers.recv().map_err(|_| Cancelled)?;
        self.rows.extend(partial.rows.iter().map(|(&id, row)| (id, row.clone())));
        Ok(partial)
    }
}

impl Elsewhere for Remote {
    fn rows(&self, ids: &[u64]) -> Result<Vec<f64>, ReadError> {
        let mut line = self.line.lock().unwrap_or_else(PoisonError::into_inner);
        let mut missing: Vec<u64> =
            ids.iter().copied().filter(|id| !line.rows.contains_key(id)).collect();
        missing.sort_unstable();
        missing.dedup();
        if let Some(&last) = missing.last() {
            if last >= self.n {
                return Err(ReadError::OutOfRange { first: last, end: last + 1, n: self.n });
            }
            line.exchange(Query::new(self.n, self.columns, Question::Rows(missing)))?;
        }
        Ok(ids.iter().flat_map(|id| line.rows[id].iter().copied()).collect())
    }

    fn ask(&self, question: &[u8]) -> Result<Vec<u8>, ReadError> {
        let query = Query::from_bytes(question).expect("a solver asks in its own words");
        let mut line = self.line.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(line.exchange(query)?.to_bytes())
    }
}

impl PointSource for Remote {
    fn len(&self) -> u64 {
        self.n
    }

    fn dim(&self) -> usize {
        self.columns
    }

    fn scalar(&self) -> ScalarKind {
        ScalarKind::F64
    }

    fn read<'a>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let values = scratch.values::<f64>(range.end - range.start, self.columns)?;
        let ids: Vec<u64> = range.collect();
        values.copy_from_slice(&self.rows(&ids)?);
        Ok(f64::rows(Points::new(values, self.columns).expect("whole rows were read")))
    }

    fn elsewhere(&self) -> Option<&dyn Elsewhere> {
        Some(self)
    }
}
