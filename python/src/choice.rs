//! Options that are words.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use taut::points::Choice;

/// Returns what a word stands for; another word is a `ValueError` that names those that are known.
pub(crate) fn choice<T: Choice>(option: &str, word: &str) -> PyResult<T> {
    one_of(option, word, T::CHOICES.iter().map(|&(name, value, _)| (name, value)))
}

/// Returns what a word out of a list stands for; another word is a `ValueError` that names those that are known.
pub(crate) fn one_of<T>(
    option: &str,
    word: &str,
    known: impl IntoIterator<Item = (&'static str, T)>,
) -> PyResult<T> {
    let (mut names, mut meant) = (Vec::new(), None);
    for (name, value) in known {
        names.push(name);
        meant = meant.or((name == word).then_some(value));
    }
    meant.ok_or_else(|| {
        let names = names.join(", ");
        PyValueError::new_err(format!("option `{option}` is {word:?}: expected one of {names}"))
    })
}

/// Refuses options with another value than the usual one that the method does not have, rather than ignoring them.
pub(crate) fn check_method_options<M: Choice>(
    method: &str,
    changed: &[(&str, bool)],
    has: impl Fn(&str, &M) -> bool,
) -> PyResult<()> {
    for (option, _) in changed.iter().filter(|(_, is_changed)| *is_changed) {
        let of = M::CHOICES.iter().filter(|(_, choice, _)| has(option, choice));
        let names: Vec<&str> = of.map(|(name, ..)| *name).collect();
        if !names.contains(&method) {
            let names = names.join(" and ");
            let message = format!("option `{option}` is of method {names}, not of {method}");
            return Err(PyValueError::new_err(message));
        }
    }
    Ok(())
}
