//! Decimal text to `f64`: the one function by which all text formats read numbers.
//!
//! *Guarantee.* A number is read to the nearest `f64`. What would be infinite stays infinite, for the caller to refuse; what
//! is not 0 but would be read as 0 is refused here, so that no digit is lost in silence.

/// Why a word is not read as a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NumberError {
    /// It is no number.
    NotANumber,
    /// It is a number other than 0, but nearer to 0 than to any other `f64`.
    Underflow,
}

/// The remark about an underflow, after the number.
pub(crate) const UNDERFLOW: &str =
    "is not 0, but too small for double precision, which would make it 0";

/// Reads a word, NaN and infinities included.
pub(crate) fn parse(word: &[u8]) -> Result<f64, NumberError> {
    let value = fast_float2::parse(word).map_err(|_| NumberError::NotANumber)?;
    checked(value, word)
}

/// Reads the number that `text` begins with, and returns its length too.
pub(crate) fn parse_start(text: &[u8]) -> Result<(f64, usize), NumberError> {
    let (value, used) = fast_float2::parse_partial(text).map_err(|_| NumberError::NotANumber)?;
    Ok((checked(value, &text[..used])?, used))
}

/// The value, unless it is 0 and the number is not. Only a value of 0 costs a second look at its digits.
fn checked(value: f64, word: &[u8]) -> Result<f64, NumberError> {
    if value == 0.0 && has_nonzero_digit(word) {
        return Err(NumberError::Underflow);
    }
    Ok(value)
}

/// Returns true if there is a digit other than 0 before the exponent.
#[cold]
fn has_nonzero_digit(word: &[u8]) -> bool {
    let mut mantissa = word.iter().take_while(|byte| !matches!(byte, b'e' | b'E'));
    mantissa.any(|byte| matches!(byte, b'1'..=b'9'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_that_would_become_0_is_refused_and_0_is_not() {
        for word in ["1e-400", "-1e-400", "2.4703282292062327e-324", "0.00001E-320", "+.5e-999"] {
            assert_eq!(parse(word.as_bytes()), Err(NumberError::Underflow), "{word}");
            let row = format!("{word},1");
            assert_eq!(parse_start(row.as_bytes()), Err(NumberError::Underflow), "{row}");
        }
        for word in ["0", "-0", "0e-400", "0.000", "-0.0E5", "0e400"] {
            assert_eq!(parse(word.as_bytes()), Ok(0.0), "{word}");
        }
        assert_eq!(parse_start(b"0,5"), Ok((0.0, 1)));
    }

    #[test]
    fn subnormal_numbers_are_read() {
        assert_eq!(parse(b"5e-324"), Ok(f64::from_bits(1)));
        assert_eq!(parse(b"2.4703282292062329e-324"), Ok(f64::from_bits(1)));
        assert_eq!(parse(b"-2.2250738585072014e-308"), Ok(-f64::MIN_POSITIVE));
        assert_eq!(parse(b"1e400"), Ok(f64::INFINITY));
        assert_eq!(parse(b"1x"), Err(NumberError::NotANumber));
    }
}
