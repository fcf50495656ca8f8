//! One solution as one JSON document: `{ "schema", "kind", "answer", "certificate", "trace" }`, and `"reading"` where the rows of its file
//! were chosen.

use std::io;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::DeserializeOwned};
use serde_json::ser::{Formatter, PrettyFormatter};
use taut_points::PointsHash;

use crate::{Answer, ReadingChoice, Solution, Trace};

/// Version of the document; it grows by one when a reader of the old one would misread the new.
pub const SCHEMA: u32 = 1;

/// Why a document could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JsonError {
    /// No JSON object.
    #[error(
        "not an answer of taut: it is no JSON object, or one cut short (line {line}, column {column})"
    )]
    Syntax {
        /// Where reading ended: the line, from 1.
        line: usize,
        /// And the column, from 1.
        column: usize,
    },
    /// JSON, but not of the expected shape.
    #[error("not an answer of taut: {0}")]
    Shape(serde_json::Error),
    /// A version this reader does not know.
    #[error("schema {found} is not known here: this is a reader of schema {SCHEMA}")]
    Schema {
        /// The version the document states.
        found: u32,
    },
    /// A kind of answer this reader does not know.
    #[error("answers of kind {found:?} are not known here")]
    Kind {
        /// The kind the document states.
        found: String,
    },
}

impl From<serde_json::Error> for JsonError {
    fn from(error: serde_json::Error) -> Self {
        match error.is_data() {
            true => JsonError::Shape(error),
            false => JsonError::Syntax { line: error.line(), column: error.column() },
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an object with schema, kind, answer, certificate and trace"
)]
struct Document<K, A, C, T> {
    schema: u32,
    kind: K,
    answer: A,
    certificate: C,
    trace: T,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    reading: Option<ReadingChoice>,
}

impl<A: Answer> Solution<A> {
    /// The document, in lines. Numbers are the shortest that read back to the same bits.
    ///
    /// # Panics
    /// Never: all parts are plain data with string keys.
    pub fn to_json(&self) -> String {
        let mut text = Vec::new();
        self.write_json(&mut text).expect("plain data always has a JSON form");
        String::from_utf8(text).expect("JSON is text")
    }

    /// Writes the document to `out`, in small pieces: give a buffer. It ends without a line feed.
    ///
    /// # Errors
    /// The error that `out` returns.
    pub fn write_json(&self, out: impl io::Write) -> io::Result<()> {
        self.write_json_with(None, out)
    }

    /// Writes the document with how its points were read, as [`write_json`](Self::write_json).
    ///
    /// # Errors
    /// The error that `out` returns.
    pub fn write_json_with(
        &self,
        reading: Option<&ReadingChoice>,
        out: impl io::Write,
    ) -> io::Result<()> {
        let parts = (&self.answer, &self.certificate, &self.trace);
        write_document(A::KIND, parts, reading, out)
    }
}

pub(crate) fn write_document(
    kind: &str,
    (answer, certificate, trace): (&impl Serialize, &impl Serialize, &Trace),
    reading: Option<&ReadingChoice>,
    out: impl io::Write,
) -> io::Result<()> {
    let reading = reading.cloned();
    let document = Document { schema: SCHEMA, kind, answer, certificate, trace, reading };
    let mut serializer = serde_json::Serializer::with_formatter(out, RowFormatter::default());
    Ok(document.serialize(&mut serializer)?)
}

/// One item a line, as people read it, but a list within a list on one line: tables may have millions of rows.
#[derive(Default)]
struct RowFormatter {
    pretty: PrettyFormatter<'static>,
    /// For each open list or object, whether it is a list.
    open: Vec<bool>,
    /// The number of innermost lists on one line.
    inline: usize,
}

impl Formatter for RowFormatter {
    fn begin_array<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        let within_list = self.open.last() == Some(&true);
        self.open.push(true);
        if within_list {
            self.inline += 1;
            return out.write_all(b"[");
        }
        self.pretty.begin_array(out)
    }

    fn end_array<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.open.pop();
        if self.inline > 0 {
            self.inline -= 1;
            return out.write_all(b"]");
        }
        self.pretty.end_array(out)
    }

    fn begin_array_value<W: ?Sized + io::Write>(
        &mut self,
        out: &mut W,
        first: bool,
    ) -> io::Result<()> {
        match (self.inline > 0, first) {
            (true, true) => Ok(()),
            (true, false) => out.write_all(b", "),
            (false, _) => self.pretty.begin_array_value(out, first),
        }
    }

    fn end_array_value<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        if self.inline > 0 { Ok(()) } else { self.pretty.end_array_value(out) }
    }

    fn begin_object<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.open.push(false);
        self.pretty.begin_object(out)
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.open.pop();
        self.pretty.end_object(out)
    }

    fn begin_object_key<W: ?Sized + io::Write>(
        &mut self,
        out: &mut W,
        first: bool,
    ) -> io::Result<()> {
        self.pretty.begin_object_key(out, first)
    }

    fn begin_object_value<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.pretty.begin_object_value(out)
    }

    fn end_object_value<W: ?Sized + io::Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.pretty.end_object_value(out)
    }
}

pub(crate) fn hash_to_hex<S: Serializer>(
    hash: &PointsHash,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_str(hash)
}

pub(crate) fn hash_from_hex<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<PointsHash, D::Error> {
    String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
}

/// Answer, certificate and trace of a document whose kind is known.
pub(crate) fn parse_document<A: DeserializeOwned, C: DeserializeOwned>(
    text: &str,
) -> Result<(A, C, Trace), JsonError> {
    let document: Document<String, A, C, Trace> = serde_json::from_str(text)?;
    Ok((document.answer, document.certificate, document.trace))
}

/// The text without the byte order mark that editors of some systems put first.
pub(crate) fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// The kind that a document of this schema states.
pub(crate) fn kind_of(text: &str) -> Result<String, JsonError> {
    #[derive(Deserialize)]
    #[serde(expecting = "an object with schema, kind, answer, certificate and trace")]
    struct Head {
        schema: u32,
        kind: String,
    }
    // A row of numbers begins like JSON, and serde would take a list for an object.
    if !text.trim_start().starts_with('{') {
        return Err(JsonError::Syntax { line: 1, column: 1 });
    }
    let head: Head = serde_json::from_str(text)?;
    if head.schema != SCHEMA {
        return Err(JsonError::Schema { found: head.schema });
    }
    Ok(head.kind)
}
