//! Options that take one of a few names.

use std::str::FromStr;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use taut::points::Choice;

/// A parser that takes the names of `T`, and the help that explains them.
pub(crate) fn choice<T>() -> impl TypedValueParser<Value = T>
where
    T: Choice + FromStr<Err: std::error::Error + Send + Sync>,
{
    let explained = T::CHOICES.iter().map(|(name, _, help)| PossibleValue::new(*name).help(*help));
    PossibleValuesParser::new(explained).try_map(|name| name.parse::<T>())
}
