//! One pass: every block is measured, compared with what is known to be far, and its best merged with that.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use taut_certify::Items;
use taut_kernels::extremes::{all_finite, largest};
use taut_kernels::{Center, squared_distances};
use taut_points::{BlockHash, Monitor, PointSource, Points, Rows, Scalar, hash_block, map_blocks};

use super::row_bounds::{KnownRows, distance_at_most};
use super::{PassResult, Query, View};
use crate::Error;
use crate::top::{Face, Far, Top, TopByFace};

/// Rows whose distances are worked out before they are compared: 4 KiB of results.
const ROWS_AT_ONCE: usize = 512;
/// One comparison disposes of this many reaches.
const GROUP_SIZE: usize = 64;

/// A pass under way, shared by all threads.
pub(crate) struct Pass<'p> {
    view: &'p View,
    query: Query<'p>,
    /// The number of the first row of the source.
    first_row: u64,
    lists: Mutex<(Top, TopByFace)>,
    /// The bits of a squared reach below which nothing can be listed any more. It only saves work: what is listed in
    /// the end does not depend on when threads see it.
    bound: AtomicU64,
    /// What is known of the rows, if anything.
    known: Option<KnownRows<'p>>,
    /// Whether the pass tells how far each row is at most.
    tells_distances: bool,
}

/// What a pass finds over some rows, and, merged, over all.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Found {
    pub(crate) farthest: Far,
    /// Farthest first.
    pub(crate) far: Vec<Far>,
    pub(crate) by_face: TopByFace,
}

impl Found {
    /// What is found in these rows and in others.
    pub(crate) fn merge(mut self, other: Self, keep: usize) -> Self {
        let mut top = Top::new(keep);
        self.far.into_iter().chain(other.far).for_each(|far| top.offer(far));
        self.by_face.merge(other.by_face);
        let farthest = farther(self.farthest, other.farthest);
        Found { farthest, far: top.into_sorted(), by_face: self.by_face }
    }

    /// The answer, once this is of all rows.
    pub(crate) fn settle(self, query: Query<'_>) -> PassResult {
        let listed_above = match self.far.last() {
            Some(last) if self.far.len() == query.keep => last.reach2,
            _ => query.above,
        };
        let by_face = self.by_face.into_sorted(query.keep);
        PassResult { farthest: self.farthest, far: self.far, listed_above, by_face }
    }
}

/// The facts that the first pass finds beside the farthest items.
pub(crate) struct FirstReport {
    pub(crate) found: Found,
    /// Hashes of the blocks, in their order.
    pub(crate) hashes: Vec<BlockHash>,
    /// The largest radius, in the place of a reach; balls only.
    pub(crate) largest: Option<Far>,
    /// True if a square exceeded the largest `f64`.
    pub(crate) overflow: bool,
    /// How far each row is at most, where that is told.
    pub(super) distances: Vec<f64>,
}

struct Measured {
    farthest: Far,
    /// True if every reach is a number.
    finite: bool,
    distances: Vec<f64>,
}

/// The contribution of one block to the first pass.
struct BlockReport {
    farthest: Far,
    hash: BlockHash,
    largest: Option<Far>,
    overflow: bool,
    distances: Vec<f64>,
}

impl<'p> Pass<'p> {
    /// A pass over rows that are numbered from `first_row` on.
    pub(crate) fn new(view: &'p View, query: Query<'p>, first_row: u64) -> Self {
        let lists = Mutex::new((Top::new(query.keep), TopByFace::default()));
        let bound = AtomicU64::new(query.above.to_bits());
        Pass { view, query, first_row, lists, bound, known: None, tells_distances: false }
    }

    /// The same, which also tells how far each row is at most, and reads only those of which that is not known to be near enough.
    pub(super) fn telling_distances(self, known: Option<KnownRows<'p>>) -> Self {
        Pass { known, tells_distances: true, ..self }
    }

    pub(crate) fn run(
        self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Found, Error> {
        Ok(self.run_with_distances(source, monitor)?.0)
    }

    /// Runs the pass and returns also how far each row is at most, where that is told.
    pub(super) fn run_with_distances(
        self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<(Found, Vec<f64>), Error> {
        let blocks = map_blocks(source, monitor, |row, rows| {
            let row = self.first_row + row;
            Ok::<_, Error>(match rows {
                Rows::F32(points) => self.block(row, &points),
                Rows::F64(points) => self.block(row, &points),
            })
        })?;
        let distances = concat(blocks.iter().map(|block| &block.distances[..]));
        Ok((self.found(blocks.iter().map(|block| block.farthest)), distances))
    }

    pub(crate) fn first(
        self,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<FirstReport, Error> {
        let reports = map_blocks(source, monitor, |row, rows| {
            let row = self.first_row + row;
            match rows {
                Rows::F32(points) => self.first_block(row, &points),
                Rows::F64(points) => self.first_block(row, &points),
            }
        })?;
        Ok(FirstReport {
            hashes: reports.iter().map(|report| report.hash).collect(),
            largest: reports.iter().filter_map(|report| report.largest).reduce(farther),
            overflow: reports.iter().any(|report| report.overflow),
            distances: concat(reports.iter().map(|report| &report.distances[..])),
            found: self.found(reports.iter().map(|report| report.farthest)),
        })
    }

    fn found(self, farthest: impl Iterator<Item = Far>) -> Found {
        let (top, by_face) = self.lists.into_inner().unwrap_or_else(PoisonError::into_inner);
        Found {
            farthest: farthest.reduce(farther).expect("a source that is not empty has a block"),
            far: top.into_sorted(),
            by_face,
        }
    }

    /// Rows that are not finite have no place in a solver; nor have negative radii.
    fn first_block<T: Scalar>(
        &self,
        first_row: u64,
        points: &Points<'_, T>,
    ) -> Result<BlockReport, Error> {
        let rows = T::rows(*points);
        let Measured { farthest, finite, distances } = self.block(first_row, points);
        // A coordinate that is not finite makes a reach that is not; large coordinates do, too.
        if !finite {
            rows.check_finite(first_row)?;
        }
        let largest = match self.view.items {
            Items::Balls => Some(largest_radius(first_row, points)?),
            Items::Points | Items::Ellipsoids => None,
        };
        let hash = hash_block(&rows);
        Ok(BlockReport { farthest, hash, largest, overflow: !finite, distances })
    }

    /// Measures a block; its far items are merged with those of the pass.
    fn block<T: Scalar>(&self, first_row: u64, points: &Points<'_, T>) -> Measured {
        if self.view.scale == 1.0 {
            return self.measure(first_row, points);
        }
        // Rare and not worth a kernel of its own: scale the block, then go on as usual.
        let mut scaled: Vec<f64> = points.values().iter().map(|&v| v.into()).collect();
        self.view.scale_rows(&mut scaled);
        let scaled = Points::new(&scaled, points.dim()).expect("the shape is that of the block");
        self.measure(first_row, &scaled)
    }

    fn measure<T: Scalar>(&self, first_row: u64, points: &Points<'_, T>) -> Measured {
        let query = &self.query;
        let mut farthest = Far { id: first_row, reach2: 0.0 };
        let mut finite = true;
        let mut top = Top::new(query.keep);
        let mut by_face = TopByFace::default();
        let face_above = query.by_face_above.unwrap_or(f64::INFINITY);
        let mut reaches = [0.0; ROWS_AT_ONCE];
        let mut distances = Vec::with_capacity(if self.tells_distances { points.len() } else { 0 });
        for start in (0..points.len()).step_by(ROWS_AT_ONCE) {
            let part = points.slice(start..points.len().min(start + ROWS_AT_ONCE));
            let reaches = &mut reaches[..part.len()];
            self.squared_distances(first_row as usize + start, &part, reaches, &mut distances);
            if self.view.items == Items::Balls {
                add_radii(&part, reaches);
            }
            finite &= all_finite(reaches);
            // Rows come in order, so what equals the bound of this block loses to the row that set it; what equals a
            // bound set by another block may still win by its number, and `Top` decides.
            let shared = f64::from_bits(self.bound.load(Ordering::Relaxed));
            let worth =
                |reach2: f64, top: &Top| reach2 > query.above.max(top.bound()) && reach2 >= shared;
            for (group, chunk) in reaches.chunks(GROUP_SIZE).enumerate() {
                let first_id = first_row + (start + group * GROUP_SIZE) as u64;
                let largest = largest(chunk);
                if largest > farthest.reach2 {
                    let at = chunk.iter().position(|&v| v == largest).expect("it is one of them");
                    farthest = Far { id: first_id + at as u64, reach2: largest };
                }
                if !worth(largest, &top) && largest <= face_above {
                    continue;
                }
                for (at, &reach2) in chunk.iter().enumerate() {
                    let far = Far { id: first_id + at as u64, reach2 };
                    if worth(reach2, &top) {
                        top.offer(far);
                    }
                    if reach2 > face_above {
                        let row = &part.row(group * GROUP_SIZE + at)[..self.view.dim];
                        by_face.offer(face(row, query.center), far);
                    }
                }
            }
        }
        let mut lists = self.lists.lock().unwrap_or_else(PoisonError::into_inner);
        lists.0.merge(top);
        lists.1.merge(by_face);
        self.bound.fetch_max(lists.0.bound().to_bits(), Ordering::Relaxed);
        Measured { farthest, finite, distances }
    }

    /// The squared distances of the rows from this one on; 0 of those that need not be read. Adds to the bounds on distances.
    fn squared_distances<T: Scalar>(
        &self,
        first: usize,
        part: &Points<'_, T>,
        reaches: &mut [f64],
        distances: &mut Vec<f64>,
    ) {
        let (center, dim) = (self.query.center, part.dim());
        // Where most rows have to be read, reading all of them takes less than finding them.
        let known = self.known.filter(|known| {
            let near = (first..first + part.len()).filter(|&row| known.is_near(row)).count();
            2 * near >= part.len()
        });
        let is_near = |at: usize| known.is_some_and(|known| known.is_near(first + at));
        let mut at = 0;
        while at < part.len() {
            if is_near(at) {
                reaches[at] = 0.0;
                at += 1;
                continue;
            }
            let end = (at + 1..part.len()).find(|&at| is_near(at)).unwrap_or(part.len());
            squared_distances(part.slice(at..end).values(), dim, center, &mut reaches[at..end]);
            at = end;
        }
        if self.tells_distances {
            distances.extend(reaches.iter().enumerate().map(|(at, &reach2)| match known {
                Some(known) if known.is_near(first + at) => known.distance(first + at),
                _ => distance_at_most(reach2, dim),
            }));
        }
    }
}

/// The numbers of all blocks, in their order.
fn concat<'a>(blocks: impl Iterator<Item = &'a [f64]>) -> Vec<f64> {
    blocks.collect::<Vec<_>>().concat()
}

/// The one that reaches farther; the lower row of two that reach equally far.
pub(crate) fn farther(a: Far, b: Far) -> Far {
    let is_farther = b.reach2 > a.reach2 || b.reach2 == a.reach2 && b.id < a.id;
    if is_farther { b } else { a }
}

fn largest_radius<T: Scalar>(first_row: u64, balls: &Points<'_, T>) -> Result<Far, Error> {
    let mut largest = Far { id: first_row, reach2: f64::NEG_INFINITY };
    for (id, ball) in (first_row..).zip(balls.rows()) {
        let radius: f64 = ball[balls.dim() - 1].into();
        if radius < 0.0 {
            return Err(Error::NegativeRadius { row: id, value: radius });
        }
        largest = farther(largest, Far { id, reach2: radius });
    }
    Ok(largest)
}

/// Turns |x − c|² into (|x − c| + r)², the radius r being the last value of each row.
fn add_radii<T: Scalar>(balls: &Points<'_, T>, reaches: &mut [f64]) {
    for (reach2, ball) in reaches.iter_mut().zip(balls.rows()) {
        let reach = reach2.sqrt() + ball[balls.dim() - 1].into();
        *reach2 = reach * reach;
    }
}

/// The face of the cube around the center towards which a row lies.
fn face<T: Scalar>(row: &[T], center: &Center) -> Face {
    let mut face = (0, false);
    let mut largest = -1.0;
    for (j, (&x, &c)) in row.iter().zip(&center.high).enumerate() {
        let difference = x.into() - c;
        if difference.abs() > largest {
            largest = difference.abs();
            face = (j, difference < 0.0);
        }
    }
    face
}
