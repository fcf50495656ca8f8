//! Arrow IPC, file and stream, message by message.
//!
//! *Idea.* A file is a stream between a mark and a footer, so both are read as streams, compressed or piped as well.
//! *Trap.* A stream may end at any message without a word. Here it has to end with the mark that all writers set,
//! and the footer of a file has to count the same batches; else points would be lost in silence.
//! *Reference.* Arrow columnar format 1.0, "Serialization and Interprocess Communication".

use std::collections::HashMap;
use std::io::{self, BufRead, Read};

use arrow_array::RecordBatch;
use arrow_buffer::Buffer;
use arrow_ipc::convert::fb_to_schema;
use arrow_ipc::{Message, MessageHeader, root_as_message};
use arrow_schema::{Schema, SchemaRef};

use super::columnar::Plan;
use super::{Decoded, first_line, guarded};
use crate::input::Job;
use crate::limits;
use crate::{Error, FilePlace, Format};

const MAGIC: &[u8] = b"ARROW1";

/// The most that a buffer may say to grow when it is decompressed: zstd writes 128 KiB of one byte as 4 bytes.
const LARGEST_RATIO: u64 = 1 << 15;

pub(super) fn read(job: &Job<'_>, stream: Box<dyn BufRead>) -> Result<Decoded, Error> {
    guarded(job, || {
        let mut batches = Batches::new(job, stream)?;
        let plan = Plan::new(job, &batches.schema)?;
        let held = plan.held();
        batches.held = held.clone();
        plan.read(job, &held, batches)
    })
}

/// The batches of a stream, of which only the columns `held` are decoded.
struct Batches<'a> {
    job: &'a Job<'a>,
    stream: Box<dyn BufRead>,
    /// True if a footer follows the stream.
    file: bool,
    schema: SchemaRef,
    held: Vec<usize>,
    count: usize,
    ended: bool,
}

impl<'a> Batches<'a> {
    fn new(job: &'a Job<'a>, mut stream: Box<dyn BufRead>) -> Result<Self, Error> {
        let head = upto(job, &mut stream, MAGIC.len() as u64)?;
        let file = head == MAGIC;
        // The first bytes of a stream belong to its first message.
        let head = match file {
            true => after_padding(job, &mut stream)?,
            false => head,
        };
        let stream = Box::new(io::Cursor::new(head).chain(stream));
        let schema = SchemaRef::new(Schema::empty());
        let mut batches =
            Batches { job, stream, file, schema, held: Vec::new(), count: 0, ended: false };
        let first = batches.message()?;
        let message = first.as_deref().map(|bytes| batches.parse(bytes)).transpose()?;
        let schema = message.and_then(|message| message.header_as_schema());
        let schema = schema.ok_or_else(|| damaged(job, "it does not begin with a schema"))?;
        batches.schema = SchemaRef::new(fb_to_schema(schema));
        Ok(batches)
    }

    /// Decodes up to the next batch; none at the end.
    fn step(&mut self) -> Result<Option<RecordBatch>, Error> {
        loop {
            let Some(bytes) = self.message()? else {
                self.end()?;
                return Ok(None);
            };
            let message = self.parse(&bytes)?;
            let length = u64::try_from(message.bodyLength())
                .map_err(|_| damaged(self.job, "a message has a negative length"))?;
            limits::check_held(
                self.job.path,
                "each batch of rows",
                length,
                self.job.options.memory,
                "allow more memory, or write it in smaller batches",
            )?;
            let body = Buffer::from_vec(self.exactly(length)?);
            match message.header_type() {
                MessageHeader::RecordBatch => {
                    self.count += 1;
                    return self.decode(message, &body).map(Some);
                }
                // No column with a dictionary is held.
                MessageHeader::DictionaryBatch | MessageHeader::NONE => {}
                _ => {
                    return Err(damaged(self.job, "a message is neither a batch nor a dictionary"));
                }
            }
        }
    }

    fn decode(&self, message: Message<'_>, body: &Buffer) -> Result<RecordBatch, Error> {
        let batch = message
            .header_as_record_batch()
            .ok_or_else(|| damaged(self.job, "a batch has no header"))?;
        if batch.compression().is_some() {
            for buffer in batch.buffers().into_iter().flatten() {
                self.check_growth(body, buffer.offset(), buffer.length())?;
            }
        }
        arrow_ipc::reader::read_record_batch(
            body,
            batch,
            self.schema.clone(),
            &HashMap::new(),
            Some(&self.held),
            &message.version(),
        )
        .map_err(|e| damaged(self.job, &first_line(&e)))
    }

    /// Refuses a compressed buffer that says it grows to more than it can: memory would be asked for by its word.
    fn check_growth(&self, body: &Buffer, offset: i64, length: i64) -> Result<(), Error> {
        let damaged = || damaged(self.job, "a compressed buffer has an impossible length");
        let start = usize::try_from(offset).map_err(|_| damaged())?;
        let length = usize::try_from(length).map_err(|_| damaged())?;
        let end = start.checked_add(length).ok_or_else(damaged)?;
        let bytes = body.as_slice().get(start..end).ok_or_else(damaged)?;
        let Some((claimed, packed)) = bytes.split_first_chunk::<8>() else { return Ok(()) };
        // A negative length means that the buffer is not compressed after all.
        let claimed = u64::try_from(i64::from_le_bytes(*claimed)).unwrap_or(0);
        if claimed > (packed.len() as u64).saturating_mul(LARGEST_RATIO) {
            return Err(damaged());
        }
        Ok(())
    }

    /// The header of the next message; none at the mark of the end.
    fn message(&mut self) -> Result<Option<Vec<u8>>, Error> {
        let mut length = self.exactly(4)?;
        if length == [0xff; 4] {
            length = self.exactly(4)?;
        }
        match u32::from_le_bytes(length[..].try_into().expect("4 bytes were read")) {
            0 => Ok(None),
            length => self.exactly(length.into()).map(Some),
        }
    }

    fn parse<'b>(&self, bytes: &'b [u8]) -> Result<Message<'b>, Error> {
        root_as_message(bytes).map_err(|e| damaged(self.job, &first_line(&e)))
    }

    /// Checks what follows the end of the stream.
    fn end(&mut self) -> Result<(), Error> {
        let mut rest = Vec::new();
        self.stream.read_to_end(&mut rest).map_err(|e| Error::reading(self.job.path, e))?;
        if !self.file {
            return match rest.is_empty() {
                true => Ok(()),
                false => Err(damaged(self.job, "more bytes follow the end of its stream")),
            };
        }
        let footer = rest
            .strip_suffix(MAGIC)
            .and_then(|rest| rest.split_last_chunk::<4>())
            .filter(|(footer, length)| {
                footer.len() as u64 == u64::from(u32::from_le_bytes(**length))
            })
            .ok_or_else(|| damaged(self.job, "its footer is missing or cut short"))?
            .0;
        let footer =
            arrow_ipc::root_as_footer(footer).map_err(|e| damaged(self.job, &first_line(&e)))?;
        let expected = footer.recordBatches().map_or(0, |batches| batches.len());
        if expected == self.count {
            return Ok(());
        }
        Err(Error::Count {
            path: self.job.path.to_owned(),
            format: Format::Arrow,
            expected: expected as u64,
            found: self.count as u64,
            unit: ("batch", "batches"),
        })
    }

    fn exactly(&mut self, count: u64) -> Result<Vec<u8>, Error> {
        let bytes = upto(self.job, &mut self.stream, count)?;
        match bytes.len() as u64 == count {
            true => Ok(bytes),
            false => Err(damaged(self.job, "it ends before the mark of its end")),
        }
    }
}

impl Iterator for Batches<'_> {
    type Item = Result<RecordBatch, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ended {
            return None;
        }
        let step = self.step().transpose();
        self.ended = !matches!(step, Some(Ok(_)));
        step
    }
}

/// The first bytes after the mark of a file, which some writers pad to 8 bytes and others to 64.
fn after_padding(job: &Job<'_>, stream: &mut dyn BufRead) -> Result<Vec<u8>, Error> {
    upto(job, stream, 2)?;
    for _ in 0..16 {
        let word = upto(job, stream, 4)?;
        if word != [0; 4] {
            return Ok(word);
        }
    }
    Err(damaged(job, "it does not begin with a schema"))
}

/// Up to `count` bytes; memory grows with the bytes that are there, not with a count that a file claims.
fn upto(job: &Job<'_>, stream: &mut dyn BufRead, count: u64) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    stream.take(count).read_to_end(&mut bytes).map_err(|e| Error::reading(job.path, e))?;
    Ok(bytes)
}

fn damaged(job: &Job<'_>, problem: &str) -> Error {
    Error::Damaged {
        path: job.path.to_owned(),
        format: Format::Arrow,
        place: FilePlace::File,
        problem: problem.to_owned(),
    }
}
