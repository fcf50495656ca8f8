//! Which columns of a file are coordinates.

use std::fmt;
use std::str::FromStr;

use crate::Error;

/// A selection of columns by name, by number from 0, or by range: `x,y,z`, `0-2,5`, `1-`.
///
/// The order of the selection is the order of the coordinates.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Columns {
    parts: Vec<Part>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Part {
    Name(String),
    Number(usize),
    /// First and last; without a last, to the end.
    Range(usize, Option<usize>),
}

impl FromStr for Columns {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let wrong = |expected| Error::Columns { text: text.to_owned(), expected };
        let mut parts = Vec::new();
        for part in text.split(',').map(str::trim) {
            let number = |digits: &str| {
                let all = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
                all.then(|| digits.parse::<usize>())
            };
            parts.push(match (number(part), part.split_once('-')) {
                _ if part.is_empty() => {
                    return Err(wrong("a name, number or range between commas"));
                }
                (Some(Ok(only)), _) => Part::Number(only),
                (Some(Err(_)), _) => return Err(wrong("column numbers of a usual size")),
                (None, Some((first, last))) => match (number(first), number(last)) {
                    (Some(Ok(first)), None) if last.is_empty() => Part::Range(first, None),
                    (Some(Ok(first)), Some(Ok(last))) if first <= last => {
                        Part::Range(first, Some(last))
                    }
                    (Some(_), Some(_)) => {
                        return Err(wrong("ranges from a smaller to a larger number"));
                    }
                    _ => Part::Name(part.to_owned()),
                },
                (None, None) => Part::Name(part.to_owned()),
            });
        }
        Ok(Columns { parts })
    }
}

impl fmt::Display for Columns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, part) in self.parts.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            match part {
                Part::Name(name) => write!(f, "{comma}{name}")?,
                Part::Number(only) => write!(f, "{comma}{only}")?,
                Part::Range(first, None) => write!(f, "{comma}{first}-")?,
                Part::Range(first, Some(last)) => write!(f, "{comma}{first}-{last}")?,
            }
        }
        Ok(())
    }
}

impl Columns {
    /// A selection of columns by their names, which may be any text.
    pub fn of_names(names: impl IntoIterator<Item = String>) -> Self {
        Columns { parts: names.into_iter().map(Part::Name).collect() }
    }

    /// A selection of columns by their numbers, from 0.
    pub(crate) fn of_numbers(numbers: impl IntoIterator<Item = usize>) -> Self {
        Columns { parts: numbers.into_iter().map(Part::Number).collect() }
    }

    /// The selection of one column, by digits as its number, or else by its name.
    pub(crate) fn of_label(label: &str) -> Self {
        let is_number = !label.is_empty() && label.bytes().all(|b| b.is_ascii_digit());
        let number = label.parse().ok().filter(|_| is_number);
        Columns { parts: vec![number.map_or_else(|| Part::Name(label.to_owned()), Part::Number)] }
    }

    /// The selection with further columns after its own.
    pub(crate) fn with(&self, more: &Columns) -> Self {
        Columns { parts: [self.parts.as_slice(), &more.parts].concat() }
    }

    /// Returns true if a column is selected by its name, so that the file must have names.
    pub(crate) fn has_names(&self) -> bool {
        self.parts.iter().any(|part| matches!(part, Part::Name(_)))
    }

    /// The numbers of the selected columns in a file of `width` columns; `names` is empty where there are none.
    pub(crate) fn resolve(
        &self,
        path: &str,
        names: &[String],
        width: usize,
    ) -> Result<Vec<usize>, Error> {
        let inside = |number: usize| match number < width {
            true => Ok(number),
            false => Err(Error::ColumnNumber { path: path.to_owned(), number, width }),
        };
        let mut numbers = Vec::new();
        for part in &self.parts {
            match part {
                Part::Number(only) => numbers.push(inside(*only)?),
                Part::Range(first, last) => {
                    let last = inside(last.unwrap_or(width.saturating_sub(1)))?;
                    numbers.extend(inside(*first)?..=last);
                }
                Part::Name(name) if names.is_empty() => {
                    return Err(Error::NoNames { path: path.to_owned(), name: name.clone() });
                }
                Part::Name(name) => {
                    numbers.push(names.iter().position(|known| known == name).ok_or_else(|| {
                        Error::ColumnName {
                            path: path.to_owned(),
                            name: name.clone(),
                            known: names.to_vec(),
                        }
                    })?)
                }
            }
        }
        Ok(numbers)
    }
}
