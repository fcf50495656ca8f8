//! Options for tables as people keep them: with gaps, names, decimal commas, and columns in different units.

use anyhow::bail;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use taut::certify::{ReadingChoice, ScaleChoice};
use taut_io::{Decimal, Missing};

/// The word of `--columns` for all columns of numbers.
pub(super) const NUMERIC: &str = "numeric";

/// The word for rows that are left out.
const DROP: &str = "drop";

/// How the cells of a table are read.
#[derive(Clone, Debug, Default, clap::Args)]
pub(crate) struct TableOptions {
    /// What becomes of rows that lack a value: nothing, NaN, null, NA and the like [default: refuse]
    #[arg(long, value_name = "WHAT", value_parser = missing())]
    missing: Option<Missing>,
    /// A column, by name or number from 0, that names rows and is no coordinate: names stand in reports and tables
    #[arg(long, value_name = "COLUMN")]
    pub(super) id: Option<String>,
    /// The mark before the decimals of numbers in text: . or , [default: .]
    #[arg(long, value_name = "MARK", value_parser = decimal())]
    decimal: Option<Decimal>,
    /// The units that an answer is in.
    #[arg(skip)]
    pub(super) units: Option<ScaleChoice>,
    /// True if the column of names is that of an answer, so that a file need not have it: names are no part of an answer.
    #[arg(skip)]
    pub(super) is_id_stored: bool,
}

fn missing() -> impl TypedValueParser<Value = Missing> {
    let values = [
        PossibleValue::new("refuse").help("they are an error"),
        PossibleValue::new(DROP)
            .help("they are left out, and counted; other rows keep their numbers"),
    ];
    PossibleValuesParser::new(values).map(|word| match &*word {
        DROP => Missing::Drop,
        _ => Missing::Refuse,
    })
}

fn decimal() -> impl TypedValueParser<Value = Decimal> {
    PossibleValuesParser::new([".", ","]).map(|word| match &*word {
        "," => Decimal::Comma,
        _ => Decimal::Point,
    })
}

impl TableOptions {
    pub(super) fn missing(&self) -> Missing {
        self.missing.unwrap_or_default()
    }

    pub(super) fn decimal(&self) -> Decimal {
        self.decimal.unwrap_or_default()
    }

    /// Returns what was chosen, as the JSON of an answer keeps it.
    pub(super) fn choice(&self) -> ReadingChoice {
        ReadingChoice {
            columns: None,
            missing: (self.missing() == Missing::Drop).then(|| DROP.to_owned()),
            decimal: (self.decimal() == Decimal::Comma).then(|| ",".to_owned()),
            id: self.id.clone(),
            scale: self.units.clone(),
        }
    }

    /// The same, with what was chosen for an answer where nothing else is asked for.
    pub(super) fn as_for(&self, choice: &ReadingChoice) -> anyhow::Result<Self> {
        let missing = match choice.missing.as_deref() {
            None => None,
            Some(DROP) => Some(Missing::Drop),
            Some(word) => bail!("key `missing` of `reading` is {word:?}: expected {DROP:?}"),
        };
        let decimal = match choice.decimal.as_deref() {
            None => None,
            Some(",") => Some(Decimal::Comma),
            Some(mark) => bail!("key `decimal` of `reading` is {mark:?}: expected \",\""),
        };
        Ok(TableOptions {
            missing: self.missing.or(missing),
            decimal: self.decimal.or(decimal),
            id: self.id.clone().or_else(|| choice.id.clone()),
            units: choice.scale.clone(),
            is_id_stored: self.id.is_none() && choice.id.is_some(),
        })
    }
}
