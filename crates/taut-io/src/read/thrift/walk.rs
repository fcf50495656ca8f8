//! A walk over one structure in Thrift's compact protocol.
//!
//! *Idea.* Known fields must be of the kind that the format gives them, as the decoder reads them by number whatever kind is
//! written; unknown fields are passed over by the kind that they say. Lists, sets and maps of booleans are refused, as the
//! decoder takes no byte for their elements.
//! *Guarantee.* A structure that was walked takes the decoder as many bytes, and every step of it at least one.
//! *Reference.* Thrift, compact protocol.

use super::format::{COMPRESSED_PAGE_SIZE, Kind, Shape};

/// Levels of structures within structures; no file needs more than ten.
const DEPTH_MAX: u32 = 64;

/// Why a structure cannot be walked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StructureError {
    /// It goes on beyond the bytes given.
    Cut,
    /// It is none, or one on which the decoder might not end.
    Wrong,
}

/// A structure that was walked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct VisitedStructure {
    /// The bytes that it takes.
    pub(super) length: usize,
    /// Its field [`COMPRESSED_PAGE_SIZE`], if it has one that is a number; like the decoder's, its last 32 bits.
    pub(super) page: Option<i32>,
}

pub(super) fn walk(bytes: &[u8], shape: Shape) -> Result<VisitedStructure, StructureError> {
    let mut walk = Walk { bytes, at: 0 };
    let page = walk.structure(shape, DEPTH_MAX)?;
    Ok(VisitedStructure { length: walk.at, page })
}

struct Walk<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Walk<'_> {
    fn byte(&mut self) -> Result<u8, StructureError> {
        let byte = *self.bytes.get(self.at).ok_or(StructureError::Cut)?;
        self.at += 1;
        Ok(byte)
    }

    fn skip(&mut self, bytes: u64) -> Result<(), StructureError> {
        let left = (self.bytes.len() - self.at) as u64;
        if bytes > left {
            return Err(StructureError::Cut);
        }
        self.at += bytes as usize;
        Ok(())
    }

    /// A number in sevens of bits, the lowest first.
    fn varint(&mut self) -> Result<u64, StructureError> {
        let mut number = 0;
        for shift in (0..70).step_by(7) {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Ok(number);
            }
        }
        Err(StructureError::Wrong)
    }

    /// Walks a structure; returns its field [`COMPRESSED_PAGE_SIZE`].
    fn structure(&mut self, shape: Shape, depth: u32) -> Result<Option<i32>, StructureError> {
        let depth = depth.checked_sub(1).ok_or(StructureError::Wrong)?;
        let (mut number, mut page) = (0i16, None);
        loop {
            let head = self.byte()?;
            let written = head & 0xf;
            if written == 0 {
                return Ok(page);
            }
            number = match head >> 4 {
                0 => unzigzag(self.varint()?) as i16,
                step => number.checked_add(step.into()).ok_or(StructureError::Wrong)?,
            };
            let known = shape.iter().find(|field| field.0 == number).map(|field| field.1);
            if known.is_some_and(|kind| !kind.is_written(written)) {
                return Err(StructureError::Wrong);
            }
            match written {
                // A boolean is told by its kind.
                1 | 2 => {}
                5 if number == COMPRESSED_PAGE_SIZE => page = Some(unzigzag(self.varint()?) as i32),
                written => self.value(written, known, depth)?,
            }
        }
    }

    /// Walks a value that takes at least one byte.
    fn value(
        &mut self,
        written: u8,
        known: Option<Kind>,
        depth: u32,
    ) -> Result<(), StructureError> {
        match written {
            3 => self.skip(1),
            4..=6 => self.varint().map(drop),
            7 => self.skip(8),
            8 => {
                let length = self.varint()?;
                self.skip(length)
            }
            9 | 10 => {
                let head = self.byte()?;
                let count = match head >> 4 {
                    15 => self.varint()?,
                    count => count.into(),
                };
                let known = match known {
                    Some(Kind::List(&known)) => Some(known),
                    _ => None,
                };
                self.elements(count, &[head & 0xf], known, depth)
            }
            11 => match self.varint()? {
                0 => Ok(()),
                count => {
                    let kinds = self.byte()?;
                    self.elements(count, &[kinds >> 4, kinds & 0xf], None, depth)
                }
            },
            12 => self.structure(known.map_or(&[], Kind::shape), depth).map(drop),
            13 => self.skip(16),
            _ => Err(StructureError::Wrong),
        }
    }

    fn elements(
        &mut self,
        count: u64,
        written: &[u8],
        known: Option<Kind>,
        depth: u32,
    ) -> Result<(), StructureError> {
        let depth = depth.checked_sub(1).ok_or(StructureError::Wrong)?;
        let other = |&written: &u8| known.is_some_and(|kind| !kind.is_written(written));
        if count > 0 && written.iter().any(|written| *written <= 2 || other(written)) {
            return Err(StructureError::Wrong);
        }
        for _ in 0..count {
            written.iter().try_for_each(|&written| self.value(written, known, depth))?;
        }
        Ok(())
    }
}

/// A signed number from one whose lowest bit is the sign.
fn unzigzag(number: u64) -> i64 {
    (number >> 1) as i64 ^ -((number & 1) as i64)
}

#[cfg(test)]
mod tests {
    use super::super::format::{FILE_META_DATA, PAGE_HEADER};
    use super::*;

    fn page(bytes: &[u8], shape: Shape) -> Result<Option<i32>, StructureError> {
        walk(bytes, shape).map(|walked| walked.page)
    }

    #[test]
    fn a_structure_ends_where_it_says() {
        // Field 3 is 21, a boolean, a text, a list of two structures, a map of a byte to a double.
        let bytes = [
            0x35, 42, 0x11, 0x18, 2, b'a', b'b', 0x19, 0x2c, 0, 0x15, 1, 0, 0x1b, 1, 0x37, 9, 0, 0,
            0, 0, 0, 0, 0, 0, 0,
        ];
        assert_eq!(walk(&bytes, &[]), Ok(VisitedStructure { length: bytes.len(), page: Some(21) }));
        for cut in 0..bytes.len() {
            assert_eq!(walk(&bytes[..cut], &[]), Err(StructureError::Cut), "{cut}");
        }
    }

    #[test]
    fn what_takes_no_bytes_is_refused() {
        let many = [0xff, 0xff, 0xff, 0xff, 0x07];
        let list = [&[0x19, 0xf1][..], &many, &[0]].concat();
        let lists = [&[0x19, 0xf9][..], &many, &[0xf2], &many, &[0]].concat();
        let map = [&[0x1b][..], &many, &[0x12, 0]].concat();
        for bytes in [list, lists, map] {
            assert_eq!(page(&bytes, &[]), Err(StructureError::Wrong));
        }
        // None of them, and of a kind that is none.
        assert_eq!(page(&[0x19, 0x01, 0], &[]), Ok(None));
        assert_eq!(page(&[0x1e, 0], &[]), Err(StructureError::Wrong));
        assert_eq!(page(&[0x1c; 100], &[]), Err(StructureError::Wrong));
    }

    #[test]
    fn a_known_field_is_of_its_kind() {
        // The number of values as a list that the decoder would read as a number, and go on within it.
        assert_eq!(page(&[0x5c, 0x15, 2, 0, 0], PAGE_HEADER), Ok(None));
        assert_eq!(page(&[0x5c, 0x19, 0x18, 0, 0, 0], PAGE_HEADER), Err(StructureError::Wrong));
        assert_eq!(page(&[0x5c, 0x19, 0x18, 0, 0, 0], &[]), Ok(None));
        // A schema of numbers, an empty one, and one whose element holds a text as a number.
        assert_eq!(page(&[0x29, 0x15, 2, 0], FILE_META_DATA), Err(StructureError::Wrong));
        assert_eq!(page(&[0x29, 0x00, 0], FILE_META_DATA), Ok(None));
        assert_eq!(
            page(&[0x29, 0x1c, 0x18, 1, b'a', 0, 0], FILE_META_DATA),
            Err(StructureError::Wrong)
        );
    }
}
