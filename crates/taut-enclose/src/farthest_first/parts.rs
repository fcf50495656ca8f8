//! The traversal where rows lie elsewhere: a pass lists the rows that are farthest, and the traversal goes on among these.
//!
//! *Idea.* Distances only fall as points are chosen. A listed row that is still as far as the last of the list was in its pass is farther
//! than all that are not listed: it is the next one, and no pass is made for it.
//! *Guarantee.* The order is the one in memory. Passes are at most as many as points, and few where the farthest points are apart.

use taut_certify::{Stop, Trace};
use taut_kernels::{Center, squared_distances};
use taut_points::{Elsewhere, ReadError, gather};

use super::FarthestFirst;
use super::lazy::{Job, Key};
use crate::Error;
use crate::frame::{Frame, SQUARE_MIN};
use crate::passes::{ask_farthest, ask_reach};
use crate::streaming::Reach;
use crate::top::Far;

/// Rows that a pass lists: with ten coordinates 50 kB for each part.
const ROWS_LISTED: usize = 512;

/// The traversal; the frame of the job is known by now, from a pass.
pub(super) fn run(job: &Job<'_>, elsewhere: &dyn Elsewhere) -> Result<FarthestFirst, Error> {
    let (source, frame) = (job.source, &job.frame);
    let (mut order, mut radii, mut chosen) = (vec![], vec![], vec![]);
    let (mut list, mut passes, mut distances) = (Shortlist::default(), 1, 0);
    let mut row = job.start;
    let next = loop {
        job.monitor.check().map_err(ReadError::from)?;
        order.push(row);
        let place = frame.gather(source, &[row])?;
        list.compare(&place);
        chosen.push(place);
        let top = match list.farthest() {
            Some(top) => top,
            None => {
                passes += 1;
                distances += source.len() * chosen.len() as u64;
                job.monitor.pass(passes, source.len());
                let far = ask_farthest(elsewhere, source, frame, &chosen, ROWS_LISTED)?;
                let is_all = far.len() as u64 == source.len();
                list = Shortlist::of(far, is_all, |ids| frame.gather(source, ids))?;
                list.farthest().unwrap_or(Key::MIN)
            }
        };
        if top.value < SQUARE_MIN {
            passes += 1;
            // What is too small to be squared is told from a copy by its distance.
            let places: Vec<f64> = gather(source, &order)?;
            let places: Vec<Vec<f64>> =
                places.chunks_exact(source.dim()).map(<[f64]>::to_vec).collect();
            if ask_reach(elsewhere, source, &places, Reach::Distance)?.0 > 0.0 {
                return Err(Error::Overflow);
            }
            radii.push(0.0);
            break None;
        }
        radii.push(frame.bring_out(top.value.sqrt())?);
        if order.len() as u64 == job.count {
            break Some(top.row);
        }
        row = top.row;
    };
    let trace = Trace {
        method: "farthest-first".into(),
        stop: Stop::Converged,
        passes,
        iterations: order.len() as u64,
        core_set: order.len() as u64 + u64::from(next.is_some()),
        history: vec![],
        counters: [("distances".to_owned(), distances)].into(),
    };
    Ok(FarthestFirst { order, radii, next, points_hash: job.points_hash, trace })
}

/// Rows that were farthest in a pass, with their distances from what was chosen since as well.
#[derive(Default)]
pub(crate) struct Shortlist {
    keys: Vec<Key>,
    /// The rows in the units of the frame.
    places: Vec<f64>,
    /// No row that is not listed is above it; `None` where all are listed.
    floor: Option<Key>,
}

impl Shortlist {
    /// The list of a pass, of rows with these places; `is_all` says that there are no others.
    pub(crate) fn of(
        far: Vec<Far>,
        is_all: bool,
        places: impl FnOnce(&[u64]) -> Result<Vec<f64>, Error>,
    ) -> Result<Self, Error> {
        let keys: Vec<Key> = far.iter().map(|far| Key { value: far.reach2, row: far.id }).collect();
        let ids: Vec<u64> = far.iter().map(|far| far.id).collect();
        let floor = if is_all { None } else { keys.last().copied() };
        Ok(Shortlist { places: places(&ids)?, keys, floor })
    }

    /// Takes note of a chosen point.
    pub(crate) fn compare(&mut self, place: &[f64]) {
        let center = Center { high: place.to_vec(), low: vec![] };
        let mut squares = vec![0.0; self.keys.len()];
        squared_distances(&self.places, place.len(), &center, &mut squares);
        for (key, square) in self.keys.iter_mut().zip(squares) {
            key.value = if square < key.value { square } else { key.value };
        }
    }

    /// The farthest of all rows, where the list tells it.
    pub(super) fn farthest(&self) -> Option<Key> {
        let top = self.keys.iter().copied().max()?;
        self.floor.is_none_or(|floor| top >= floor).then_some(top)
    }

    /// The farthest row that is listed, and its place.
    pub(crate) fn farthest_listed(&self, dim: usize) -> Option<(Far, &[f64])> {
        let (at, key) = self.keys.iter().enumerate().max_by_key(|(_, key)| **key)?;
        let far = Far { id: key.row, reach2: key.value };
        Some((far, &self.places[at * dim..(at + 1) * dim]))
    }
}

/// The first points of the traversal, and the units in which distances were measured.
pub(super) fn with_frame(
    job: Job<'_>,
    elsewhere: &dyn Elsewhere,
) -> Result<(FarthestFirst, Frame), Error> {
    let found = run(&job, elsewhere)?;
    Ok((found, job.frame))
}
