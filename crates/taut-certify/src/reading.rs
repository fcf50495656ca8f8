//! How the rows of an answer were read from their file, kept beside it in its JSON.
//!
//! *Guarantee.* Nothing of it is believed: the certificate knows its points by a hash, so that rows that are read in another way are
//! other points. It only saves a reader from having to say it again.

use serde::{Deserialize, Serialize};

use crate::JsonError;
use crate::json::without_mark;

/// The choices that were made when the points were read. What is not there was left as it is by default.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "how rows were read: an object")]
pub struct ReadingChoice {
    /// The columns that are coordinates, as the option `--columns` takes them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub columns: Option<String>,
    /// The word `drop`, if rows that lack a value were left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missing: Option<String>,
    /// The mark before decimals, if it was no point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decimal: Option<String>,
    /// The column with the name of each row.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// The unit of each column.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<ScaleChoice>,
}

/// The units by which columns were divided.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "units of columns: an object with method and units")]
pub struct ScaleChoice {
    /// The name of the rule for them.
    pub method: String,
    /// A positive number for each column.
    pub units: Vec<f64>,
}

impl ReadingChoice {
    /// Reads the choices of a document, if it has some.
    ///
    /// # Errors
    /// [`JsonError`].
    pub fn of_json(text: &str) -> Result<Option<Self>, JsonError> {
        #[derive(Deserialize)]
        #[serde(expecting = "an answer: an object")]
        struct Part {
            #[serde(default)]
            reading: Option<ReadingChoice>,
        }
        let part: Part = serde_json::from_str(without_mark(text))?;
        Ok(part.reading)
    }
}
