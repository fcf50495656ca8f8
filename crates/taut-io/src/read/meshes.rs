//! Meshes as points: their vertices, in the order of the file, used by a triangle or not.

use super::Decoded;
use crate::input::{Job, Medium};
use crate::mesh::read_stream;
use crate::sink::Sink;
use crate::{Content, Error};

pub(super) fn read(job: &Job<'_>, medium: Medium) -> Result<Decoded, Error> {
    let memory = job.options.memory;
    let content = Content::Surface;
    let mesh =
        read_stream(medium.stream(), job.format, content, job.path.as_ref(), job.path, memory)?;
    let names = ["x", "y", "z"].map(str::to_owned);
    let numbers = match &job.options.columns {
        Some(columns) => columns.resolve(job.path, &names, 3)?,
        None => vec![0, 1, 2],
    };
    let mut sink = Sink::new(job, numbers.len());
    let mut row = Vec::with_capacity(numbers.len());
    for vertex in &mesh.vertices {
        row.clear();
        row.extend(numbers.iter().map(|&number| vertex[number]));
        sink.push(&row)?;
    }
    let columns = numbers.iter().map(|&number| names[number].clone()).collect();
    Ok(Decoded { source: sink.finish()?, columns, numbers: Some(numbers), labels: Vec::new() })
}
