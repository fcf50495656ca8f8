//! The parts that pictures of balls and ellipsoids have in common: what an answer and its rows must agree in, how large marks are,
//! and what they are called.

use taut_certify::Items;

use crate::Error;
use crate::item_pass::noun;
use crate::number::{count, counted, digits};
use crate::scene::Mark;

/// An error unless both numbers are the same.
pub(crate) fn agree(what: &'static str, expected: usize, found: usize) -> Result<(), Error> {
    match expected == found {
        true => Ok(()),
        false => Err(Error::Mismatch { what, expected: expected as u64, found: found as u64 }),
    }
}

/// An error if one of `ids` is beyond the `found` rows there are.
pub(crate) fn all_there<'a>(
    what: &'static str,
    ids: impl IntoIterator<Item = &'a u64>,
    found: u64,
) -> Result<(), Error> {
    match ids.into_iter().find(|&&id| id >= found) {
        Some(beyond) => Err(Error::Mismatch { what, expected: beyond.saturating_add(1), found }),
        None => Ok(()),
    }
}

/// An error for the first number that is none, by its name.
pub(crate) fn all_finite<'a>(
    numbers: impl IntoIterator<Item = (&'static str, &'a f64)>,
) -> Result<(), Error> {
    match numbers.into_iter().find(|(_, value)| !value.is_finite()) {
        Some((what, &value)) => Err(Error::NonFinite { what: what.into(), value }),
        None => Ok(()),
    }
}

/// Radius of the disc of an item that is not of the support, pixels, where so many are drawn.
pub(crate) fn dot_size(drawn: usize) -> f64 {
    match drawn {
        0..=100 => 3.6,
        101..=1000 => 2.8,
        1001..=5000 => 2.0,
        _ => 1.4,
    }
}

/// Radius of the disc of a support mark, pixels: its area grows with the multiplier, beside the largest of them.
pub(crate) fn support_size(multiplier: f64, largest: f64) -> f64 {
    if largest > 0.0 { 4.0 + 4.5 * (multiplier.max(0.0) / largest).sqrt() } else { 4.0 }
}

/// The marks of a support; `place` says where the item at a place in it, and of a row, decides the answer.
pub(crate) fn support_marks(
    support: &[u64],
    multipliers: &[f64],
    place: impl Fn(usize, u64) -> Result<Vec<f64>, Error>,
) -> Result<Vec<Mark>, Error> {
    let largest = multipliers.iter().fold(0.0_f64, |a, &m| a.max(m));
    let pairs = support.iter().zip(multipliers).enumerate();
    pairs
        .map(|(k, (&id, &multiplier))| {
            let label = format!("support, multiplier {}", digits(multiplier, 4));
            Ok(Mark { id, at: place(k, id)?, size: support_size(multiplier, largest), label })
        })
        .collect()
}

/// The items that are not of the support, in a legend.
pub(crate) fn others_name(items: Items) -> String {
    match items {
        Items::Points => "points".into(),
        Items::Balls | Items::Ellipsoids => format!("{}s of the input", noun(items)),
    }
}

/// Returns what is drawn of all `n` items, where more than so many are not.
pub(crate) fn drawn_of(drawn: u64, n: u64, thing: &str, which: &str) -> String {
    match n {
        1 => format!(" The one {thing} is drawn."),
        n if drawn == n => format!(" All {} are drawn.", counted(n, thing)),
        n => format!(" {} of {} are drawn: {which}.", count(drawn), counted(n, thing)),
    }
}

/// That items lie outside where none should; nothing where none does.
pub(crate) fn misfit(outside: u64, thing: &str, shape: &str) -> String {
    match outside {
        0 => String::new(),
        k => format!(
            " {} {} outside the {shape}: the answer does not fit these {thing}s.",
            counted(k, thing),
            if k == 1 { "reaches" } else { "reach" },
        ),
    }
}
