//! One solution as one JSON document: `{ "schema", "kind", "answer", "certificate", "trace" }`.

use serde::{Deserialize, Serialize, de::DeserializeOwned};

use crate::{Answer, Ball, CheckError, Solution, Trace, Verdict};

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
}

impl<A: Answer> Solution<A> {
    /// The document, in lines. Numbers are the shortest that read back to the same bits.
    ///
    /// # Panics
    /// Never: all parts are plain data with string keys.
    pub fn to_json(&self) -> String {
        let document = Document {
            schema: SCHEMA,
            kind: A::KIND,
            answer: &self.answer,
            certificate: &self.certificate,
            trace: &self.trace,
        };
        serde_json::to_string_pretty(&document).expect("plain data always has a JSON form")
    }
}

/// A solution of any kind, as read from a file.
#[derive(Clone, Debug, PartialEq)]
pub enum AnySolution {
    /// A minimum enclosing ball.
    Ball(Solution<Ball>),
}

impl AnySolution {
    /// Reads a document, whatever its kind.
    ///
    /// # Errors
    /// [`JsonError`].
    pub fn from_json(text: &str) -> Result<Self, JsonError> {
        #[derive(Deserialize)]
        #[serde(expecting = "an object with schema, kind, answer, certificate and trace")]
        struct Head {
            schema: u32,
            kind: String,
        }
        // Editors of some systems put a byte order mark first.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        // A row of numbers begins like JSON, and serde would take a list for an object.
        if !text.trim_start().starts_with('{') {
            return Err(JsonError::Syntax { line: 1, column: 1 });
        }
        let head: Head = serde_json::from_str(text)?;
        if head.schema != SCHEMA {
            return Err(JsonError::Schema { found: head.schema });
        }
        match head.kind.as_str() {
            Ball::KIND => Ok(AnySolution::Ball(parse(text)?)),
            _ => Err(JsonError::Kind { found: head.kind }),
        }
    }

    /// Judges the answer over `source`, whatever its kind.
    ///
    /// # Errors
    /// As [`Solution::check`].
    pub fn check(
        &self,
        source: &dyn taut_points::PointSource,
        monitor: &taut_points::Monitor<'_>,
    ) -> Result<Verdict, CheckError> {
        match self {
            AnySolution::Ball(found) => found.answer.check(&found.certificate, source, monitor),
        }
    }
}

fn parse<A: Answer + DeserializeOwned>(text: &str) -> Result<Solution<A>, JsonError> {
    let document: Document<String, A, A::Certificate, Trace> = serde_json::from_str(text)?;
    Ok(Solution {
        answer: document.answer,
        certificate: document.certificate,
        trace: document.trace,
    })
}
