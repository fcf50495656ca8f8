//! Names of element types, of which many mean the same.

/// Types by the names that have no width in them; of `l`, `int`, `g` and the like it depends on the system.
const SHORT_NAMES: [(&str, &str); 22] = [
    ("?", "b1"),
    ("bool", "b1"),
    ("b", "i1"),
    ("B", "u1"),
    ("h", "i2"),
    ("H", "u2"),
    ("i", "i4"),
    ("I", "u4"),
    ("q", "i8"),
    ("Q", "u8"),
    ("e", "f2"),
    ("half", "f2"),
    ("f", "f4"),
    ("single", "f4"),
    ("d", "f8"),
    ("double", "f8"),
    ("float", "f8"),
    ("F", "c8"),
    ("csingle", "c8"),
    ("D", "c16"),
    ("cdouble", "c16"),
    ("complex", "c16"),
];

/// Returns true if two names are of one type, byte order included.
pub(in crate::files) fn is_same_type(a: &str, b: &str) -> bool {
    a == b || canonical(a).is_some_and(|name| canonical(b) == Some(name))
}

/// Bytes of an element of a type; none for a name that does not tell.
pub(in crate::files) fn width(name: &str) -> Option<u64> {
    let (_, name) = canonical(name)?;
    let (kind, rest) = name.split_at_checked(1)?;
    let digits = rest.split('[').next()?;
    let count: u64 = digits.parse().ok()?;
    count.checked_mul(if kind == "U" { 4 } else { 1 })
}

/// Byte order, `|` where there is none, and the short name.
fn canonical(name: &str) -> Option<(char, String)> {
    let (order, plain) = match name.chars().next()? {
        order @ ('<' | '>' | '=' | '|') => (order, &name[1..]),
        _ => ('=', name),
    };
    let short =
        SHORT_NAMES.iter().find(|(long, _)| *long == plain).map(|(_, short)| (*short).to_owned());
    let short = match short.or_else(|| by_bits(plain)) {
        Some(short) => short,
        // An old name of byte strings.
        None if plain.starts_with('a') => format!("S{}", &plain[1..]),
        None => plain.to_owned(),
    };
    let native = if cfg!(target_endian = "big") { '>' } else { '<' };
    let is_bytes = matches!(&*short, "b1" | "i1" | "u1") || short.starts_with(['S', 'V', 'O']);
    let order = match order {
        _ if is_bytes => '|',
        '=' | '|' => native,
        order => order,
    };
    Some((order, short))
}

/// Names that count bits: `float64`.
fn by_bits(name: &str) -> Option<String> {
    let kinds = [("float", 'f'), ("int", 'i'), ("uint", 'u'), ("complex", 'c')];
    kinds.into_iter().find_map(|(long, kind)| {
        let bits: u32 = name.strip_prefix(long)?.parse().ok()?;
        (bits >= 8 && bits.is_multiple_of(8)).then(|| format!("{kind}{}", bits / 8))
    })
}

#[cfg(test)]
mod tests {
    use super::{is_same_type, width};

    #[test]
    fn names_that_mean_the_same() {
        let native = if cfg!(target_endian = "big") { ">" } else { "<" };
        let other = if cfg!(target_endian = "big") { "<" } else { ">" };
        for names in [
            &["f8", "=f8", "|f8", "d", "=d", "double", "float", "float64", "=float64"][..],
            &["i4", "=i4", "i", "int32"],
            &["U3", "=U3"],
            &["M8[ns]", "=M8[ns]"],
            &["c16", "D", "complex", "complex128"],
        ] {
            let last = names[names.len() - 1].trim_start_matches('=');
            for name in names {
                assert!(is_same_type(name, &format!("{native}{last}")), "{name}");
                assert!(!is_same_type(name, &format!("{other}{last}")), "{name}");
            }
        }
        let bytes = [["u1", "|u1"], ["<u1", ">u1"], ["B", "uint8"], ["S3", "|S3"], ["a3", "<S3"]];
        for [a, b] in bytes.into_iter().chain([["?", "|b1"], ["V7", ">V7"], ["weird", "weird"]]) {
            assert!(is_same_type(a, b), "{a} {b}");
        }
        for [a, b] in [["<f8", "<i8"], ["f8", "f4"], ["u1", "b1"], ["b", "b1"], ["S3", "V3"]] {
            assert!(!is_same_type(a, b), "{a} {b}");
        }
        assert!(!is_same_type("", "f8") && !is_same_type("<M8[ns]", "<M8[us]"));
    }

    #[test]
    fn widths() {
        for (name, bytes) in [
            ("<f8", Some(8)),
            ("float32", Some(4)),
            ("D", Some(16)),
            ("?", Some(1)),
            ("|S7", Some(7)),
            ("<U3", Some(12)),
            ("<M8[ns]", Some(8)),
            ("<m8[25s]", Some(8)),
            ("V24", Some(24)),
            ("|O", None),
            ("", None),
            ("<", None),
            ("é8", None),
            ("U99999999999999999999", None),
            ("U9999999999999999999", None),
        ] {
            assert_eq!(width(name), bytes, "{name}");
        }
    }
}
