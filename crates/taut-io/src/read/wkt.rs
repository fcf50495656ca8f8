//! Well-known text: the positions of a geometry of the plane.
//!
//! *Read.* POINT, MULTIPOINT, LINESTRING, POLYGON and MULTIPOLYGON, in either case, with or without `Z`, `M` and `SRID=…;`, one
//! after the other. Several POINTs are points in their order; of all other geometries one is read, the only one or the one
//! chosen. Rings are numbered as in GeoJSON. The third and the fourth number of a position are left out.
//! *Refused.* Several geometries, and those of other kinds, by line and byte.
//! *Guarantee.* Nothing nests deeper than three parentheses, and the text alone is held.
//! *Reference.* OGC 06-103r4, Simple feature access, section 7; PostGIS for `SRID`.

use std::io::BufRead;

use super::Decoded;
use super::chains::{Put, Stop, read_text};
use crate::input::Job;
use crate::number::{self, NumberError};
use crate::{Error, Feature};

pub(super) fn read(job: &Job<'_>, stream: Box<dyn BufRead>) -> Result<Decoded, Error> {
    let wanted = match &job.options.feature {
        None => None,
        Some(Feature::Number(number)) => Some(*number),
        Some(Feature::Name(name)) => {
            let problem = format!(
                "geometries of WKT have numbers, counted from 0, but no names such as {name:?}"
            );
            return Err(Error::Feature { path: job.path.to_owned(), problem });
        }
    };
    read_text(job, stream, "a text of WKT", |text, put| {
        let mut parser = Parser { path: job.path, text, at: 0, put, is_wanted: true, ring: 0 };
        let count = parser.geometries(wanted)?;
        match wanted {
            Some(number) if number >= count => {
                let problem =
                    format!("there is no geometry {number}: it has {count}, counted from 0");
                Err(Error::Feature { path: job.path.to_owned(), problem }.into())
            }
            _ => Ok(()),
        }
    })
}

struct Parser<'a, 'p> {
    path: &'a str,
    text: &'a [u8],
    at: usize,
    put: &'a mut Put<'p>,
    /// Whether positions are handed on.
    is_wanted: bool,
    /// The number of the ring that is read.
    ring: usize,
}

impl Parser<'_, '_> {
    /// Reads all geometries and returns how many there are.
    fn geometries(&mut self, wanted: Option<u64>) -> Result<u64, Stop> {
        let mut count = 0;
        // The first geometry that has positions, and whether all so far are single points.
        let mut first: Option<(u64, bool)> = None;
        loop {
            self.skip_blanks();
            if self.at == self.text.len() {
                return Ok(count);
            }
            self.is_wanted = wanted.is_none_or(|number| number == count);
            let (is_point, is_empty) = self.geometry()?;
            match first {
                _ if is_empty || !self.is_wanted => {}
                Some((other, all_points)) if !(all_points && is_point) => {
                    let problem = format!(
                        "geometry {other} and geometry {count} (from 0) are both there, and one is read unless all are POINTs: \
                         choose one by its number with --select {other}, or write polygons that belong together as one MULTIPOLYGON"
                    );
                    return Err(Error::Feature { path: self.path.to_owned(), problem }.into());
                }
                _ => first = first.or(Some((count, is_point))),
            }
            count += 1;
        }
    }

    /// Reads a geometry; returns whether it is a POINT, and whether it is empty.
    fn geometry(&mut self) -> Result<(bool, bool), Stop> {
        let begin = self.at;
        let mut word = self.word();
        if word == "SRID" {
            let rest = &self.text[self.at..];
            let length = rest.iter().position(|byte| !(byte.is_ascii_digit() || *byte == b'='));
            self.at += length.unwrap_or(rest.len());
            self.expect(b';', "expected a semicolon after the number of SRID")?;
            word = self.word();
        }
        // POINT Z, POINTZ and POINT ZM are of one kind.
        let kinds = ["POINT", "MULTIPOINT", "LINESTRING", "POLYGON", "MULTIPOLYGON"];
        let kind = kinds.into_iter().find(|&kind| {
            word.strip_prefix(kind).is_some_and(|rest| ["", "Z", "M", "ZM"].contains(&rest))
        });
        let Some(kind) = kind else {
            let problem = match word.as_str() {
                "" => "expected the name of a geometry".to_owned(),
                other => format!(
                    "{other:?} is not read: expected POINT, MULTIPOINT, LINESTRING, POLYGON or MULTIPOLYGON"
                ),
            };
            return Err(Stop::Text(begin, problem));
        };
        let next = self.word();
        let next = if ["Z", "M", "ZM"].contains(&next.as_str()) { self.word() } else { next };
        match next.as_str() {
            "EMPTY" => return Ok((kind == "POINT", true)),
            "" => {}
            _ => return self.refuse("expected an opening parenthesis or EMPTY"),
        }
        self.ring = 0;
        match kind {
            "POINT" => {
                self.expect(b'(', "expected an opening parenthesis")?;
                self.position()?;
                self.expect(b')', "expected a closing parenthesis after one position")?;
            }
            "MULTIPOINT" => self.list(|parser: &mut Self| match parser.peek() == Some(b'(') {
                true => {
                    parser.at += 1;
                    parser.position()?;
                    parser.expect(b')', "expected a closing parenthesis after one position")
                }
                false => parser.position(),
            })?,
            "LINESTRING" => self.list(Self::position)?,
            "POLYGON" => self.list(Self::ring)?,
            _ => self.list(|parser: &mut Self| parser.list(Self::ring))?,
        }
        Ok((kind == "POINT", false))
    }

    fn ring(&mut self) -> Result<(), Stop> {
        self.list(Self::position)?;
        self.ring += 1;
        Ok(())
    }

    /// Items between parentheses, with commas between them.
    fn list(&mut self, item: impl Fn(&mut Self) -> Result<(), Stop>) -> Result<(), Stop> {
        self.expect(b'(', "expected an opening parenthesis")?;
        loop {
            self.skip_blanks();
            item(self)?;
            match self.peek() {
                Some(b',') => self.at += 1,
                _ => return self.expect(b')', "expected a comma or a closing parenthesis"),
            }
        }
    }

    /// Two to four numbers with blanks between them.
    fn position(&mut self) -> Result<(), Stop> {
        let mut at = [0.0; 4];
        let mut count = 0;
        while self.peek().is_some_and(|byte| byte.is_ascii_digit() || b"+-.".contains(&byte)) {
            if count == 4 {
                return self.refuse("a position has more than 4 numbers");
            }
            at[count] = self.number()?;
            count += 1;
        }
        if count < 2 {
            return self.refuse("expected a position of at least 2 numbers");
        }
        match self.is_wanted {
            true => Ok((self.put)(self.ring, [at[0], at[1]])?),
            false => Ok(()),
        }
    }

    fn number(&mut self) -> Result<f64, Stop> {
        match number::parse_start(&self.text[self.at..]) {
            Ok((value, _)) if !value.is_finite() => self.refuse("the number is not finite"),
            Ok((value, used)) => {
                self.at += used;
                match self.text.get(self.at) {
                    None | Some(b',' | b')') => Ok(value),
                    Some(byte) if byte.is_ascii_whitespace() => Ok(value),
                    Some(_) => self.refuse("expected a blank, a comma or a parenthesis"),
                }
            }
            Err(NumberError::NotANumber) => self.refuse("this is no number"),
            Err(NumberError::Underflow) => {
                self.refuse(&format!("the number {}", number::UNDERFLOW))
            }
        }
    }

    /// The next word in capitals, after blanks; empty where there is none.
    fn word(&mut self) -> String {
        self.skip_blanks();
        let rest = &self.text[self.at..];
        let length = rest.iter().position(|byte| !byte.is_ascii_alphabetic()).unwrap_or(rest.len());
        self.at += length;
        String::from_utf8_lossy(&rest[..length]).to_ascii_uppercase()
    }

    fn skip_blanks(&mut self) {
        while self.text.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
    }

    /// The next byte that is no blank.
    fn peek(&mut self) -> Option<u8> {
        self.skip_blanks();
        self.text.get(self.at).copied()
    }

    fn expect(&mut self, byte: u8, problem: &str) -> Result<(), Stop> {
        if self.peek() != Some(byte) {
            return self.refuse(problem);
        }
        self.at += 1;
        Ok(())
    }

    fn refuse<T>(&self, problem: &str) -> Result<T, Stop> {
        let end = self.text.trim_ascii_end().len();
        match self.at < end {
            true => Err(Stop::Text(self.at, problem.to_owned())),
            false => Err(Stop::Text(end, format!("the text ends early: {problem}"))),
        }
    }
}
