//! Little-endian values without a header.

use std::io::{self, BufRead, Read};

use taut_points::{Scalar, ScalarKind};

use super::Decoded;
use crate::input::Job;
use crate::limits;
use crate::sink::Sink;
use crate::{Error, Missing, Place, RawLayout};

/// The layout the options must give.
pub(super) fn layout(job: &Job<'_>) -> Result<RawLayout, Error> {
    let known = job.options.raw.filter(|layout| layout.dim > 0);
    known.ok_or_else(|| Error::RawLayout { path: job.path.to_owned() })
}

/// Number of points in `bytes` bytes, those before the first value included.
pub(super) fn count(job: &Job<'_>, layout: RawLayout, bytes: u64) -> Result<u64, Error> {
    let size = (layout.dim as u64).saturating_mul(layout.scalar.size() as u64);
    let values = bytes.saturating_sub(layout.offset);
    match values % size {
        0 if values == 0 => Err(Error::NoRows { path: job.path.to_owned() }),
        0 => Ok(values / size),
        rest => Err(Error::RawRagged {
            path: job.path.to_owned(),
            bytes: values,
            offset: layout.offset,
            size,
            rest,
        }),
    }
}

/// Decodes values of a stream, or selected columns.
pub(super) fn decode(job: &Job<'_>, stream: Box<dyn BufRead>) -> Result<Decoded, Error> {
    let layout = layout(job)?;
    match layout.scalar {
        ScalarKind::F32 => decode_as::<f32>(job, layout, stream),
        ScalarKind::F64 => decode_as::<f64>(job, layout, stream),
    }
}

fn decode_as<T: Scalar>(
    job: &Job<'_>,
    layout: RawLayout,
    mut stream: Box<dyn BufRead>,
) -> Result<Decoded, Error> {
    let dim = layout.dim;
    let read_failed = |source| Error::reading(job.path, source);
    let skipped =
        io::copy(&mut (&mut stream).take(layout.offset), &mut io::sink()).map_err(read_failed)?;
    let selection = job.options.columns.as_ref();
    let mut numbers = None;
    let mut sink: Option<Sink<'_, T>> = None;
    let (mut bytes, mut chosen, mut read) = (Vec::new(), Vec::new(), 0);
    let size = dim.saturating_mul(size_of::<T>());
    limits::check_point(job.path, size as u64, job.options.memory)?;
    loop {
        bytes.clear();
        (&mut stream).take(size as u64).read_to_end(&mut bytes).map_err(read_failed)?;
        if bytes.len() < size {
            // The end, or a point cut short: the count says which.
            let layout = RawLayout { offset: skipped, ..layout };
            count(job, layout, skipped + read * size as u64 + bytes.len() as u64)?;
            break;
        }
        let sink = match &mut sink {
            Some(sink) => sink,
            // Only now, when a whole point has been seen, does a wild dimension cost nothing.
            none => {
                let choose = |columns: &crate::Columns| columns.resolve(job.path, &[], dim);
                numbers = selection.map(choose).transpose()?;
                none.insert(Sink::new(job, numbers.as_ref().map_or(dim, Vec::len)))
            }
        };
        chosen.clear();
        let value = |column: usize| -> Result<T, Error> {
            let at = column * size_of::<T>();
            let value: T = bytemuck::pod_read_unaligned(&bytes[at..at + size_of::<T>()]);
            let wide: f64 = value.into();
            if wide.is_finite() || wide.is_nan() && job.options.missing != Missing::Refuse {
                return Ok(value);
            }
            let path = job.path.to_owned();
            let place = Place { path, row: read + 1, line: None, column, name: None };
            Err(Error::NonFinite { place, value: wide.to_string() })
        };
        match &numbers {
            None => (0..dim).try_for_each(|column| value(column).map(|v| chosen.push(v)))?,
            Some(numbers) => {
                numbers.iter().try_for_each(|&column| value(column).map(|v| chosen.push(v)))?;
            }
        }
        sink.push(&chosen)?;
        read += 1;
    }
    let sink = sink.ok_or_else(|| Error::NoRows { path: job.path.to_owned() })?;
    Ok(Decoded { source: sink.finish()?, columns: Vec::new(), numbers, labels: Vec::new() })
}
