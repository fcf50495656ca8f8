//! Options that take one of a few names.

use std::str::FromStr;

use anyhow::bail;
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

/// Refuses options that are given but that the method does not have, rather than ignoring them.
pub(crate) fn check_method_options<M: Choice>(
    method: &str,
    given: &[(&str, bool)],
    has: impl Fn(&str, &M) -> bool,
) -> anyhow::Result<()> {
    for (option, _) in given.iter().filter(|(_, is_given)| *is_given) {
        let of = M::CHOICES.iter().filter(|(_, choice, _)| has(option, choice));
        let names: Vec<&str> = of.map(|(name, ..)| *name).collect();
        if !names.contains(&method) {
            bail!("--{option} is of --method {}, not of {method}", names.join(" and "));
        }
    }
    Ok(())
}
