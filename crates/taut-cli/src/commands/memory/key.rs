//! Where the key of a record is, as people write it: `0:8`, first byte and the one after the last.

use std::ops::Range;

/// Reads a range of bytes.
pub(super) fn parse(text: &str) -> Result<Range<usize>, String> {
    let wrong = || format!("`{text}` is no range of bytes: write 0:8 for the first eight");
    let (start, end) = text.split_once(':').ok_or_else(wrong)?;
    let (start, end) = (start.parse().map_err(|_| wrong())?, end.parse().map_err(|_| wrong())?);
    if start < end { Ok(start..end) } else { Err(wrong()) }
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn ranges_have_a_first_byte_and_one_after_the_last() {
        assert_eq!(parse("0:8"), Ok(0..8));
        assert_eq!(parse("24:32"), Ok(24..32));
        for text in ["", "8", "8:8", "9:8", "-1:8", "0:x", "0:8:9"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }
}
