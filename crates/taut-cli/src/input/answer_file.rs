//! The text of an answer: read as a whole, but never without end.
//!
//! *Idea.* A file may be of any length up to a bound, a stream or a device may have no end at all. So the outline of JSON is
//! followed while the text comes in: one object, not nested too deeply, and nothing after it.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

use anyhow::{anyhow, bail};
use taut::points::try_reserve_exact;

use crate::commands::verify::shown;
use crate::output::writing;

/// Most bytes of an answer: 8 GiB, ten times what a surface of ten million points takes.
const ANSWER_MAX: u64 = 8 << 30;

/// Bytes read at a time.
const CHUNK: usize = 1 << 18;

/// Deepest nesting of an answer; its reader goes no deeper either.
const DEPTH_MAX: u32 = 128;

/// The remark for the case that the files may have been named in the wrong order.
pub(crate) const ORDER: &str = "the answer comes first, then the points";

/// Reads the answer in the file `path`; `-` is standard input.
pub(crate) fn read(path: &Path) -> anyhow::Result<String> {
    let name = shown(path);
    let failed = |source: std::io::Error| match source.kind() {
        ErrorKind::NotFound => anyhow!("{name}: no such file"),
        ErrorKind::IsADirectory => anyhow!("{name} is a folder: name the file of the answer"),
        _ => anyhow!("{name}: the answer could not be read: {source}"),
    };
    let bytes = if writing::is_stream(path) {
        whole(&mut std::io::stdin().lock(), 0, &name, failed)?
    } else {
        let mut file = File::open(path).map_err(failed)?;
        taut_io::refuse_device(&file, &name)?;
        let length = file.metadata().map_err(failed)?.len();
        whole(&mut file, length, &name, failed)?
    };
    String::from_utf8(bytes)
        .map_err(|_| anyhow!("{name}: not an answer of taut: it is no text; {ORDER}"))
}

/// All bytes of a stream of about `length` bytes.
fn whole(
    stream: &mut dyn Read,
    length: u64,
    name: &str,
    failed: impl Fn(std::io::Error) -> anyhow::Error,
) -> anyhow::Result<Vec<u8>> {
    let too_long = || anyhow!("{name} has more than {ANSWER_MAX} bytes, the most of an answer");
    if length > ANSWER_MAX {
        return Err(too_long());
    }
    let (mut bytes, mut chunk, mut outline) = (Vec::new(), vec![0; CHUNK], Outline::default());
    loop {
        let read = match stream.read(&mut chunk) {
            Ok(0) => return Ok(bytes),
            Ok(read) => read,
            Err(source) if source.kind() == ErrorKind::Interrupted => continue,
            Err(source) => return Err(failed(source)),
        };
        let piece = &chunk[..read];
        if let Err(problem) = outline.follow(piece) {
            bail!("{name}: not an answer of taut: {problem}; {ORDER}");
        }
        let wanted = bytes.len() + read;
        if wanted as u64 > ANSWER_MAX {
            return Err(too_long());
        }
        if wanted > bytes.capacity() {
            // The whole file at once; of a stream twice as much as there is.
            let more = usize::try_from(length).unwrap_or(0).max(2 * wanted) - bytes.len();
            try_reserve_exact(&mut bytes, more)
                .or_else(|_| try_reserve_exact(&mut bytes, read))
                .map_err(|_| anyhow!("{name}: out of memory: the answer does not fit into it"))?;
        }
        bytes.extend_from_slice(piece);
    }
}

/// The mark that some editors put before UTF-8.
const MARK: [u8; 3] = [0xef, 0xbb, 0xbf];

/// The progress through the text of one JSON object.
#[derive(Default)]
struct Outline {
    /// Objects and arrays that are open.
    depth: u32,
    begun: bool,
    /// Bytes of the mark that some editors put before UTF-8; all of it once anything else has come.
    mark: usize,
    within_text: bool,
    escaped: bool,
}

impl Outline {
    /// Follows the next bytes; says what is wrong where they cannot belong to one object.
    fn follow(&mut self, bytes: &[u8]) -> Result<(), &'static str> {
        for &byte in bytes {
            if let Some(&expected) = MARK.get(self.mark) {
                self.mark = if byte == expected { self.mark + 1 } else { MARK.len() };
                if byte == expected {
                    continue;
                }
            }
            if self.within_text {
                self.within_text = self.escaped || byte != b'"';
                self.escaped = !self.escaped && byte == b'\\';
                continue;
            }
            match byte {
                b' ' | b'\t' | b'\n' | b'\r' => {}
                _ if self.depth == 0 && self.begun => return Err("more follows its JSON object"),
                b'{' => self.open()?,
                _ if self.depth == 0 => return Err("it is no JSON object"),
                b'[' => self.open()?,
                b'}' | b']' => self.depth -= 1,
                b'"' => self.within_text = true,
                _ => {}
            }
        }
        Ok(())
    }

    fn open(&mut self) -> Result<(), &'static str> {
        self.begun = true;
        self.depth += 1;
        if self.depth > DEPTH_MAX { Err("its JSON is nested too deeply") } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(text: &str) -> Result<(), &'static str> {
        // Byte by byte, as pieces may end anywhere.
        let mut outline = Outline::default();
        text.as_bytes().chunks(1).try_for_each(|piece| outline.follow(piece))
    }

    #[test]
    fn only_one_object_is_followed() {
        for good in [
            "",
            " {",
            "\u{feff}{}",
            "{}\n",
            "{\"a\": [1, {\"}\\\"{\": \"\\\\\"}]} \n",
            "{\"a\": \"[[[\"}",
        ] {
            assert_eq!(judged(good), Ok(()), "{good}");
        }
        for bad in ["\0", "1,2", "[]", "\"x\"", "x{", "}", "\u{feff}x"] {
            assert_eq!(judged(bad), Err("it is no JSON object"), "{bad}");
        }
        assert_eq!(judged("{}{"), Err("more follows its JSON object"));
        assert_eq!(judged(&"{".repeat(128)), Ok(()));
        assert_eq!(judged(&"{".repeat(129)), Err("its JSON is nested too deeply"));
    }
}
