//! Lines out of the pieces that tiles have of them.
//!
//! *Idea.* A piece that ends at an edge between tiles goes on with the piece that begins there at the same level; each edge is
//! crossed once by a level, so the rows of the edge are the key. Pieces wait in a file; what is kept of each are its ends.
//! *Guarantee.* Closed lines begin at the crossing with the smallest rows, as those within a tile.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;

use taut_oblivious::machine::Store;

use super::contours::Stroke;
use crate::Error;
use crate::outofcore::bytes::Reader;

/// Bytes of a place in the file.
const PLACE_BYTES: u64 = 16;

/// Places that are read at once.
const PLACES_AT_ONCE: u64 = 1 << 12;

/// A part of a line within one tile, from its first crossing to its last; of a closed line these are the same.
pub(super) struct Piece {
    pub(super) is_closed: bool,
    /// The edge to another tile where it begins.
    pub(super) from: Option<[u64; 2]>,
    /// The edge to another tile where it ends.
    pub(super) to: Option<[u64; 2]>,
    /// The smallest edge, and the number of its crossing.
    pub(super) least: ([u64; 2], usize),
    pub(super) places: Vec<[f64; 2]>,
}

/// A piece that waits in the file.
struct Waiting {
    level: u32,
    first: u64,
    count: u64,
    to: Option<[u64; 2]>,
    least: ([u64; 2], u64),
    has_previous: bool,
    is_done: bool,
}

pub(super) struct Chains<'a> {
    levels: &'a [f64],
    folder: PathBuf,
    file: Option<BufWriter<File>>,
    places: u64,
    waiting: Vec<Waiting>,
    /// Pieces by the edge and the level where they begin.
    begins: HashMap<([u64; 2], u32), u32>,
    pen: Pen<'a>,
}

/// Draws lines, without places that repeat the one before.
struct Pen<'a> {
    draw: &'a mut dyn FnMut(Stroke) -> Result<(), Error>,
    level: f64,
    first: Option<[f64; 2]>,
    last: [f64; 2],
    is_begun: bool,
    lines: u64,
}

impl Pen<'_> {
    fn begin(&mut self, level: f64) {
        (self.level, self.first, self.is_begun) = (level, None, false);
    }

    fn to(&mut self, place: [f64; 2]) -> Result<(), Error> {
        match self.first {
            None => self.first = Some(place),
            Some(first) if place != self.last => {
                if !self.is_begun {
                    self.is_begun = true;
                    (self.draw)(Stroke::Begin(self.level))?;
                    (self.draw)(Stroke::To(first))?;
                }
                (self.draw)(Stroke::To(place))?;
            }
            Some(_) => {}
        }
        self.last = place;
        Ok(())
    }

    fn end(&mut self) -> Result<(), Error> {
        if !self.is_begun {
            return Ok(());
        }
        self.lines += 1;
        (self.draw)(Stroke::End)
    }
}

impl<'a> Chains<'a> {
    pub(super) fn new(
        levels: &'a [f64],
        scratch: Option<PathBuf>,
        draw: &'a mut dyn FnMut(Stroke) -> Result<(), Error>,
    ) -> Self {
        let pen = Pen { draw, level: 0.0, first: None, last: [0.0; 2], is_begun: false, lines: 0 };
        Self {
            levels,
            folder: scratch.unwrap_or_else(std::env::temp_dir),
            file: None,
            places: 0,
            waiting: vec![],
            begins: HashMap::new(),
            pen,
        }
    }

    fn failed(&self) -> impl Fn(std::io::Error) -> Error + use<> {
        let path = self.folder.display().to_string();
        move |source| Error::File { path: path.clone(), source }
    }

    /// Draws a whole line, or has a piece wait.
    pub(super) fn add(&mut self, level: u32, piece: &Piece) -> Result<(), Error> {
        if piece.is_closed || (piece.from.is_none() && piece.to.is_none()) {
            self.pen.begin(self.levels[level as usize]);
            let (_, least) = piece.least;
            let turned = if piece.is_closed {
                // The first crossing is the last one, too.
                [&piece.places[least..], &piece.places[1..=least]]
            } else {
                [&piece.places[..], &[]]
            };
            turned.concat().into_iter().try_for_each(|place| self.pen.to(place))?;
            return self.pen.end();
        }
        let number = self.waiting.len() as u32;
        if let Some(from) = piece.from {
            self.begins.insert((from, level), number);
        }
        self.waiting.push(Waiting {
            level,
            first: self.places,
            count: piece.places.len() as u64,
            to: piece.to,
            least: (piece.least.0, piece.least.1 as u64),
            has_previous: false,
            is_done: false,
        });
        self.places += piece.places.len() as u64;
        let failed = self.failed();
        if self.file.is_none() {
            let file = tempfile::tempfile_in(&self.folder).map_err(&failed)?;
            self.file = Some(BufWriter::with_capacity(1 << 16, file));
        }
        if let Some(file) = &mut self.file {
            for x in piece.places.as_flattened() {
                file.write_all(&x.to_le_bytes()).map_err(&failed)?;
            }
        }
        Ok(())
    }

    fn next(&self, piece: usize) -> Option<usize> {
        let Waiting { to, level, .. } = self.waiting[piece];
        self.begins.get(&(to?, level)).map(|&next| next as usize)
    }

    /// Draws the lines that go from tile to tile, and says how many lines there are.
    pub(super) fn finish(mut self) -> Result<u64, Error> {
        let Some(file) = self.file.take() else { return Ok(self.pen.lines) };
        let failed = self.failed();
        let file = file.into_inner().map_err(|error| failed(error.into_error()))?;
        for piece in 0..self.waiting.len() {
            if let Some(next) = self.next(piece) {
                self.waiting[next].has_previous = true;
            }
        }
        // Lines from hull to hull begin where nothing comes before.
        for piece in 0..self.waiting.len() {
            if !self.waiting[piece].has_previous {
                self.pen.begin(self.levels[self.waiting[piece].level as usize]);
                let mut at = Some(piece);
                while let Some(piece) = at {
                    self.waiting[piece].is_done = true;
                    let Waiting { first, count, .. } = self.waiting[piece];
                    self.draw(&file, first, count)?;
                    at = self.next(piece);
                }
                self.pen.end()?;
            }
        }
        for piece in 0..self.waiting.len() {
            if !self.waiting[piece].is_done {
                self.draw_closed(&file, piece)?;
            }
        }
        Ok(self.pen.lines)
    }

    /// Draws the closed line of a piece, from its smallest edge on.
    fn draw_closed(&mut self, file: &File, piece: usize) -> Result<(), Error> {
        let (mut start, mut at) = (piece, piece);
        loop {
            self.waiting[at].is_done = true;
            if self.waiting[at].least.0 < self.waiting[start].least.0 {
                start = at;
            }
            match self.next(at).filter(|&next| next != piece) {
                Some(next) => at = next,
                None => break,
            }
        }
        let Waiting { first, count, least: (_, least), level, .. } = self.waiting[start];
        self.pen.begin(self.levels[level as usize]);
        self.draw(file, first + least, count - least)?;
        let mut at = start;
        while let Some(next) = self.next(at).filter(|&next| next != start) {
            let Waiting { first, count, .. } = self.waiting[next];
            self.draw(file, first, count)?;
            at = next;
        }
        self.draw(file, first, least + 1)?;
        self.pen.end()
    }

    /// Draws some places of the file.
    fn draw(&mut self, file: &File, mut first: u64, mut count: u64) -> Result<(), Error> {
        let failed = self.failed();
        while count > 0 {
            let read = count.min(PLACES_AT_ONCE);
            let mut bytes = vec![0; (read * PLACE_BYTES) as usize];
            file.read_exact_at(&mut bytes, first * PLACE_BYTES).map_err(&failed)?;
            let mut reader = Reader::new(&bytes);
            while let Some(place) = reader.points() {
                self.pen.to(place)?;
            }
            (first, count) = (first + read, count - read);
        }
        Ok(())
    }
}
