//! Numbers as people read them, and as SVG needs them.

/// A pixel coordinate: two decimals, no trailing zeros, always finite.
pub(crate) fn px(value: f64) -> String {
    let rounded =
        if value.is_finite() { (value.clamp(-1e6, 1e6) * 100.0).round() / 100.0 } else { 0.0 };
    // Adding 0 turns −0 into 0.
    format!("{}", rounded + 0.0)
}

/// At most `digits` significant digits, without trailing zeros; powers of ten where the plain form would be long.
pub(crate) fn short(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return if value.is_nan() { "undefined" } else { "∞" }.into();
    }
    let scientific = format!("{:.*e}", digits.max(1) - 1, value.abs());
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let body = if (-4..6.max(digits as i32)).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        trim(&format!("{:.*}", decimals, value.abs())).to_owned()
    } else {
        match trim(mantissa) {
            "1" => format!("10{}", superscript(exponent)),
            mantissa => format!("{mantissa}·10{}", superscript(exponent)),
        }
    };
    if value < 0.0 { format!("−{body}") } else { body }
}

fn trim(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

/// A whole number in groups of three.
pub(crate) fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

/// `count` of a thing, in singular or plural: "1 point", "2,000 points".
pub(crate) fn counted(value: u64, thing: &str) -> String {
    format!("{} {thing}{}", count(value), if value == 1 { "" } else { "s" })
}

/// An exponent, raised.
pub(crate) fn superscript(value: i32) -> String {
    let raise = |c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
    };
    value.to_string().chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_true() {
        let cases = [
            (0.0, "0"),
            (1.0, "1"),
            (-0.5, "−0.5"),
            (1234.5678, "1234.6"),
            (123456.0, "123456"),
            (1e6, "10⁶"),
            (1.5e-9, "1.5·10⁻⁹"),
            (-2.5e300, "−2.5·10³⁰⁰"),
            (0.00012345678, "0.00012346"),
            (99999.99, "100000"),
        ];
        for (value, text) in cases {
            assert_eq!(short(value, 5), text);
        }
        assert_eq!(px(-0.001), "0");
        assert_eq!(px(12.3456), "12.35");
        assert_eq!(px(f64::NAN), "0");
        assert_eq!([count(7), count(1000), count(20_000_000)], ["7", "1,000", "20,000,000"]);
        assert_eq!(superscript(-1024), "⁻¹⁰²⁴");
    }
}
