//! Amounts of memory as people write them: `512M`, `2GiB`, `1500MB`.
//!
//! As in GNU `sort` and `dd`: K, M, G, T and KiB, MiB, GiB, TiB are powers of 1024, KB, MB, GB, TB powers of 1000.

/// Reads an amount of memory; the result is in bytes.
pub(crate) fn parse(text: &str) -> Result<u64, String> {
    let wrong = || format!("`{text}` is no amount of memory: write bytes or 512M, 2GiB, 1500MB");
    let digits = text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let unit = unit.trim().to_ascii_uppercase();
    let (prefix, base) = match unit.as_str() {
        "" | "B" => ("", 1u64),
        other => match (other.strip_suffix("IB"), other.strip_suffix('B')) {
            (Some(prefix), _) => (prefix, 1024),
            (None, Some(prefix)) => (prefix, 1000),
            (None, None) => (other, 1024),
        },
    };
    let power = match prefix {
        "" if base == 1 => 0,
        "K" => 1,
        "M" => 2,
        "G" => 3,
        "T" => 4,
        _ => return Err(wrong()),
    };
    let number: f64 = number.parse().map_err(|_| wrong())?;
    let bytes = number * base.pow(power) as f64;
    if (1.0..1e18).contains(&bytes) { Ok(bytes as u64) } else { Err(wrong()) }
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn units_are_those_of_sort_and_dd() {
        for (text, bytes) in [
            ("1", 1),
            ("4096b", 4096),
            ("512M", 512 << 20),
            ("2GiB", 2 << 30),
            ("2 gib", 2 << 30),
            ("1.5G", 3 << 29),
            ("1500MB", 1_500_000_000),
            ("1kB", 1000),
            ("1T", 1 << 40),
        ] {
            assert_eq!(parse(text), Ok(bytes), "{text}");
        }
    }

    #[test]
    fn anything_else_is_refused_and_named() {
        for text in ["", "G", "1X", "-1G", "1.2.3M", "0", "1iB", "9999999T", "NaN", "1e9"] {
            let said = parse(text).unwrap_err();
            assert!(said.contains(&format!("`{text}`")), "{said}");
        }
    }
}
