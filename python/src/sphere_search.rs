//! `taut.SphereSearch`, behind its Python class.

use numpy::{PyArray1, ToPyArray};
use pyo3::prelude::*;
use taut::enclose::{Neighbor, QueryOptions, SearchError, SphereSearch, SphereSearchOptions};
use taut::{Items, PointSource};

use crate::items::{items_of_name, raise};
use crate::numbers::whole;
use crate::rows::Rows;
use crate::work::interruptible;

/// What queries found: where the rows of each begin, the rows, and their distances.
type Lists<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<f64>>);

/// A tree that answers queries.
#[pyclass(frozen, module = "taut._native")]
pub(crate) struct SearchTree {
    search: SphereSearch,
}

#[pymethods]
impl SearchTree {
    #[new]
    fn new(
        py: Python<'_>,
        rows: &Bound<'_, PyAny>,
        items: &str,
        threads: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let (inputs, threads) = (items_of_name(items)?, number_of_threads(threads)?);
        let rows = Rows::borrow(rows)?;
        let source = rows.source()?;
        let built = interruptible(py, |monitor| {
            let options = SphereSearchOptions { inputs, threads, monitor: *monitor };
            SphereSearch::new(source.as_ref(), &options)
        })?;
        Ok(SearchTree { search: built.map_err(|error| raise(error, inputs, source.dim()))? })
    }

    /// Rows, and coordinates of a place.
    fn shape(&self) -> (u64, usize) {
        (self.search.len(), self.search.dim())
    }

    /// The nearest rows to each place.
    fn nearest<'py>(
        &self,
        py: Python<'py>,
        places: &Bound<'py, PyAny>,
        k: &Bound<'py, PyAny>,
        threads: &Bound<'py, PyAny>,
    ) -> PyResult<Lists<'py>> {
        let k: usize = whole("k", k, "at least 1")?;
        self.ask(py, places, threads, |source, options| match k {
            1 => Ok(one_each(self.search.nearest(source, options)?)),
            k => self.search.nearest_k(source, k, options),
        })
    }

    /// All rows within a radius of each place.
    fn within<'py>(
        &self,
        py: Python<'py>,
        places: &Bound<'py, PyAny>,
        radius: f64,
        threads: &Bound<'py, PyAny>,
    ) -> PyResult<Lists<'py>> {
        self.ask(py, places, threads, |source, options| self.search.within(source, radius, options))
    }

    /// The farthest row from each place.
    fn farthest<'py>(
        &self,
        py: Python<'py>,
        places: &Bound<'py, PyAny>,
        epsilon: f64,
        threads: &Bound<'py, PyAny>,
    ) -> PyResult<Lists<'py>> {
        self.ask(py, places, threads, |source, options| {
            Ok(one_each(self.search.farthest(source, epsilon, options)?))
        })
    }

    /// The rows that each ray meets, or the first of them.
    fn hits<'py>(
        &self,
        py: Python<'py>,
        rays: &Bound<'py, PyAny>,
        hit_radius: f64,
        first_only: bool,
        threads: &Bound<'py, PyAny>,
    ) -> PyResult<Lists<'py>> {
        self.ask(py, rays, threads, |source, options| match first_only {
            false => self.search.hits(source, hit_radius, options),
            true => {
                let found = self.search.first_hits(source, hit_radius, options)?;
                Ok(found.into_iter().map(Vec::from_iter).collect())
            }
        })
    }

    /// All pairs within a distance: first rows, second rows, distances.
    fn pairs<'py>(
        &self,
        py: Python<'py>,
        other: Option<&Bound<'py, SearchTree>>,
        distance: f64,
        threads: &Bound<'py, PyAny>,
    ) -> PyResult<Lists<'py>> {
        let threads = number_of_threads(threads)?;
        let other = other.map(|other| &other.get().search);
        let found = interruptible(py, |monitor| {
            let options = QueryOptions { threads, monitor: *monitor };
            match other {
                Some(other) => self.search.pairs_with(other, distance, &options),
                None => self.search.pairs(distance, &options),
            }
        })?;
        let found = found.map_err(|error| raise(error, Items::Points, 0))?;
        let rows =
            |place: usize| found.iter().map(|pair| pair.rows[place] as i64).collect::<Vec<_>>();
        let distances: Vec<f64> = found.iter().map(|pair| pair.distance).collect();
        Ok((rows(0).to_pyarray(py), rows(1).to_pyarray(py), distances.to_pyarray(py)))
    }

    /// The two rows that are farthest apart, their distance, and an upper bound of all distances.
    fn diameter(&self, py: Python<'_>, epsilon: f64) -> PyResult<([u64; 2], f64, f64)> {
        let found = interruptible(py, |monitor| {
            self.search.diameter(epsilon, &QueryOptions { threads: None, monitor: *monitor })
        })?;
        let found = found.map_err(|error| raise(error, Items::Points, 0))?;
        Ok((found.rows, found.distance, found.upper_bound))
    }
}

impl SearchTree {
    fn ask<'py>(
        &self,
        py: Python<'py>,
        queries: &Bound<'py, PyAny>,
        threads: &Bound<'py, PyAny>,
        work: impl Fn(&dyn PointSource, &QueryOptions<'_>) -> Result<Vec<Vec<Neighbor>>, SearchError>
        + Send
        + Sync,
    ) -> PyResult<Lists<'py>> {
        let threads = number_of_threads(threads)?;
        let queries = Rows::borrow(queries)?;
        let source = queries.source()?;
        let found = interruptible(py, |monitor| {
            work(source.as_ref(), &QueryOptions { threads, monitor: *monitor })
        })?;
        let found = found.map_err(|error| raise(error, Items::Points, source.dim()))?;
        let mut starts = vec![0];
        let mut end = 0;
        starts.extend(found.iter().map(|found| {
            end += found.len() as i64;
            end
        }));
        let rows: Vec<i64> = found.iter().flatten().map(|found| found.row as i64).collect();
        let distances: Vec<f64> = found.iter().flatten().map(|found| found.distance).collect();
        Ok((starts.to_pyarray(py), rows.to_pyarray(py), distances.to_pyarray(py)))
    }
}

fn one_each(found: Vec<Neighbor>) -> Vec<Vec<Neighbor>> {
    found.into_iter().map(|found| vec![found]).collect()
}

fn number_of_threads(threads: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    whole("threads", threads, "1 to 1024, or None")
}
