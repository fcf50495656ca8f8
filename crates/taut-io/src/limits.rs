//! Bounds on what one piece of a file can make a reader hold in memory.
//!
//! *Idea.* A reader works piece by piece: a line of text, a point, a message. Points are spilled to disk when they outgrow
//! [`ReadOptions::memory`](crate::ReadOptions::memory), but a piece must be held whole, so its size is bounded here.

use crate::Error;

/// Most bytes of a line of text, however much memory is allowed: 64 MiB, three million numbers of 20 digits. A longer line
/// is no table of points, and a compressed file of a few kilobytes can hold one of any length.
pub const LONGEST_LINE: usize = 64 << 20;

/// Share of the allowed memory that a line or a point may take. Its parsed form takes up to seven times as much beside
/// it (two bytes of text are a number of 8 bytes, in a buffer that may be half empty).
const PIECE_SHARE: u64 = 8;

/// Bytes of a piece that are always allowed, so that a small limit on memory refuses no ordinary file: 1 MiB.
const PIECE_LEAST: u64 = 1 << 20;

/// Most bytes of a line or a point where `memory` bytes of points are allowed; all where there is no limit.
fn largest_piece(memory: Option<u64>) -> u64 {
    memory.map_or(u64::MAX, |memory| (memory / PIECE_SHARE).max(PIECE_LEAST))
}

/// Most bytes of a line of text where `memory` bytes of points are allowed.
pub(crate) fn longest_line(memory: Option<u64>) -> usize {
    usize::try_from(largest_piece(memory)).map_or(LONGEST_LINE, |most| most.min(LONGEST_LINE))
}

/// Refuses a point of more bytes than a piece may have.
pub(crate) fn check_point(path: &str, bytes: u64, memory: Option<u64>) -> Result<(), Error> {
    let most = largest_piece(memory);
    match bytes <= most {
        true => Ok(()),
        false => Err(Error::TooLarge {
            path: path.to_owned(),
            problem: "a single point",
            bytes,
            memory: most,
            remedy: "allow at least eight times as much as a point takes, or check the shape of the array",
        }),
    }
}

/// Most bytes of parts of a file that must be held together.
pub(crate) fn most_held(memory: Option<u64>) -> u64 {
    memory.map_or(u64::MAX, |memory| memory.max(PIECE_LEAST))
}

/// Refuses parts of a file that must be held together, of which `bytes` are known so far.
pub(crate) fn check_held(
    path: &str,
    problem: &'static str,
    bytes: u64,
    memory: Option<u64>,
    remedy: &'static str,
) -> Result<(), Error> {
    let most = most_held(memory);
    match bytes <= most {
        true => Ok(()),
        false => {
            Err(Error::TooLarge { path: path.to_owned(), problem, bytes, memory: most, remedy })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_takes_an_eighth_of_the_memory_within_fixed_bounds() {
        assert_eq!(longest_line(None), LONGEST_LINE);
        assert_eq!(longest_line(Some(u64::MAX)), LONGEST_LINE);
        assert_eq!(longest_line(Some(100 << 20)), (100 << 20) / 8);
        assert_eq!(longest_line(Some(1)), 1 << 20);
    }
}
