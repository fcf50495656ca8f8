//! The data of a path: commands, each with its numbers, to the vertices of its subpaths.
//!
//! *Trap.* Numbers need no blank between them where sign or point parts them, and the flags of an arc need none at all: `a1 1 0 0110-5`
//! has the flags 0 and 1 and the end 10, −5.

use std::ops::Range;

use super::curves::{self, Place};
use crate::number::{self, NumberError};
use crate::read::chains::{Put, Stop};

/// Hands the vertices of all subpaths on, each subpath with its number from 0.
pub(super) fn walk(text: &[u8], data: Range<usize>, put: &mut Put<'_>) -> Result<(), Stop> {
    let end = data.end;
    let origin = [0.0; 2];
    let mut path = Path {
        text: &text[..end],
        at: data.start,
        put,
        current: origin,
        start: origin,
        control: None,
        pending: None,
        is_moved: false,
        next_ring: 0,
    };
    path.commands()
}

struct Path<'a, 'p> {
    text: &'a [u8],
    at: usize,
    put: &'a mut Put<'p>,
    current: Place,
    /// The first vertex of the subpath.
    start: Place,
    /// The last control point of the curve before, and its degree.
    control: Option<(u8, Place)>,
    /// The first vertex of a subpath that is not handed on yet.
    pending: Option<Place>,
    /// Whether that vertex comes from a command M.
    is_moved: bool,
    next_ring: usize,
}

impl Path<'_, '_> {
    fn commands(&mut self) -> Result<(), Stop> {
        self.skip_blanks();
        if self.peek().is_some_and(|byte| !byte.eq_ignore_ascii_case(&b'm')) {
            return self.refuse("a path begins with M");
        }
        while let Some(command) = self.peek() {
            if !command.is_ascii_alphabetic() {
                return self.refuse("expected a command");
            }
            let begin = self.at;
            self.at += 1;
            self.skip_blanks();
            let mut command = command;
            loop {
                self.command(command, begin)?;
                self.skip_separator();
                // Further numbers are the same command again; after M they are lines.
                let is_number =
                    self.peek().is_some_and(|byte| byte.is_ascii_digit() || b"+-.".contains(&byte));
                if !is_number || command.eq_ignore_ascii_case(&b'z') {
                    break;
                }
                command = match command {
                    b'M' => b'L',
                    b'm' => b'l',
                    other => other,
                };
            }
        }
        Ok(())
    }

    fn command(&mut self, command: u8, begin: usize) -> Result<(), Stop> {
        let from = if command.is_ascii_lowercase() { self.current } else { [0.0; 2] };
        let kind = command.to_ascii_uppercase();
        // Control points that S and T mirror.
        let before = self.control.take();
        let current = self.current;
        let mirrored = |degree: u8| match before {
            Some((found, [x, y])) if found == degree => {
                [2.0 * current[0] - x, 2.0 * current[1] - y]
            }
            _ => current,
        };
        match kind {
            b'M' => {
                let to = self.place(from)?;
                (self.current, self.start) = (to, to);
                (self.pending, self.is_moved) = (Some(to), true);
            }
            b'Z' => {
                if let Some(only) = self.pending.filter(|_| self.is_moved) {
                    self.vertex(only)?;
                }
                self.current = self.start;
                (self.pending, self.is_moved) = (Some(self.start), false);
            }
            b'L' => {
                let to = self.place(from)?;
                self.line(to)?;
            }
            b'H' => {
                let x = from[0] + self.number()?;
                self.line([x, current[1]])?;
            }
            b'V' => {
                let y = from[1] + self.number()?;
                self.line([current[0], y])?;
            }
            b'C' | b'S' => {
                let one = if kind == b'C' { self.place(from)? } else { mirrored(3) };
                let two = self.place(from)?;
                let to = self.place(from)?;
                self.chords(|each| curves::cubic([current, one, two, to], each))?;
                self.control = Some((3, two));
            }
            b'Q' | b'T' => {
                let one = if kind == b'Q' { self.place(from)? } else { mirrored(2) };
                let to = self.place(from)?;
                self.chords(|each| curves::quadratic([current, one, to], each))?;
                self.control = Some((2, one));
            }
            b'A' => {
                let radii = [self.number()?, self.number()?];
                let turn = self.number()?;
                let (is_large, is_positive) = (self.flag()?, self.flag()?);
                let to = self.place(from)?;
                let arc = curves::Arc { from: current, to, radii, turn, is_large, is_positive };
                self.chords(|each| curves::arc(&arc, each))?;
            }
            _ => {
                let shown = char::from(command);
                return Err(Stop::Text(begin, format!("{shown:?} is no command of a path")));
            }
        }
        Ok(())
    }

    fn chords(
        &mut self,
        curve: impl FnOnce(&mut dyn FnMut(Place) -> Result<(), Stop>) -> Result<(), Stop>,
    ) -> Result<(), Stop> {
        curve(&mut |to| self.line(to))
    }

    fn line(&mut self, to: Place) -> Result<(), Stop> {
        if let Some(first) = self.pending {
            self.vertex(first)?;
        }
        self.current = to;
        self.hand_on(to)
    }

    /// The first vertex of a subpath.
    fn vertex(&mut self, at: Place) -> Result<(), Stop> {
        self.pending = None;
        self.next_ring += 1;
        self.hand_on(at)
    }

    fn hand_on(&mut self, at: Place) -> Result<(), Stop> {
        match at.iter().all(|x| x.is_finite()) {
            true => Ok((self.put)(self.next_ring - 1, at)?),
            false => self.refuse("a coordinate is beyond the range of double precision"),
        }
    }

    fn place(&mut self, from: Place) -> Result<Place, Stop> {
        Ok([from[0] + self.number()?, from[1] + self.number()?])
    }

    fn number(&mut self) -> Result<f64, Stop> {
        self.skip_separator();
        let rest = &self.text[self.at..];
        let mut length = usize::from(rest.first().is_some_and(|byte| b"+-".contains(byte)));
        let digits = |from: usize| rest[from..].iter().take_while(|b| b.is_ascii_digit()).count();
        length += digits(length);
        if rest.get(length) == Some(&b'.') {
            length += 1;
            length += digits(length);
        }
        if rest.get(length).is_some_and(|byte| b"eE".contains(byte)) {
            let sign = rest.get(length + 1).is_some_and(|byte| b"+-".contains(byte));
            let exponent = length + 1 + usize::from(sign);
            match digits(exponent.min(rest.len())) {
                0 => {}
                count => length = exponent + count,
            }
        }
        match number::parse(&rest[..length]) {
            Ok(value) if value.is_finite() => {
                self.at += length;
                Ok(value)
            }
            Ok(_) => self.refuse("the number is not finite"),
            Err(NumberError::NotANumber) => self.refuse("expected a number"),
            Err(NumberError::Underflow) => {
                self.refuse(&format!("the number {}", number::UNDERFLOW))
            }
        }
    }

    fn flag(&mut self) -> Result<bool, Stop> {
        self.skip_separator();
        match self.peek() {
            Some(flag @ (b'0' | b'1')) => {
                self.at += 1;
                Ok(flag == b'1')
            }
            _ => self.refuse("expected a flag of an arc, 0 or 1"),
        }
    }

    fn skip_blanks(&mut self) {
        while self.peek().is_some_and(|byte| byte.is_ascii_whitespace()) {
            self.at += 1;
        }
    }

    /// Blanks, with a comma among them or not.
    fn skip_separator(&mut self) {
        self.skip_blanks();
        if self.peek() == Some(b',') {
            self.at += 1;
            self.skip_blanks();
        }
    }

    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn refuse<T>(&self, problem: &str) -> Result<T, Stop> {
        Err(Stop::Text(self.at, problem.to_owned()))
    }
}
