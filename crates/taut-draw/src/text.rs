//! Words: escaping for XML and HTML, and how wide they are in the bundled font.

/// Widths of the characters from space to tilde in thousandths of the size, in the regular face of Inter.
const ADVANCE: [u16; 95] = [
    281, 278, 403, 631, 638, 812, 639, 222, 362, 362, 500, 659, 280, 460, 276, 357, 625, 464, 605,
    636, 642, 608, 624, 571, 616, 624, 276, 280, 659, 659, 659, 507, 936, 676, 651, 727, 719, 598,
    587, 743, 740, 264, 543, 652, 562, 889, 753, 761, 635, 761, 639, 638, 642, 741, 676, 949, 642,
    665, 625, 362, 357, 362, 469, 452, 497, 564, 621, 558, 621, 582, 361, 609, 591, 237, 237, 544,
    237, 869, 585, 597, 609, 609, 372, 523, 364, 581, 557, 812, 540, 557, 541, 362, 327, 362, 659,
];

/// Text for an element or an attribute of XML or HTML; what XML forbids becomes U+FFFD.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' | '\r' => out.push(' '),
            c if c.is_control() || c == '\u{FFFE}' || c == '\u{FFFF}' => out.push('\u{FFFD}'),
            c => out.push(c),
        }
    }
    out
}

/// A string of JSON that may stand inside a script element of HTML.
pub(crate) fn json(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            // `</script>` and `<!--` must not appear, and the two separators end lines in old JavaScript.
            '<' | '>' | '&' | '\u{2028}' | '\u{2029}' => {
                out.push_str(&format!("\\u{:04x}", c as u32))
            }
            c if c.is_control() => out.push_str(&format!("\\u{:04x}", c as u32)),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// Width of a line at a font size, in the units of the size; wide scripts count as squares.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    let thousandths: f64 = text
        .chars()
        .map(|c| match c {
            ' '..='~' => f64::from(ADVANCE[c as usize - ' ' as usize]),
            '⁰'..='ₜ' | '¹' | '²' | '³' => 430.0,
            '\u{1100}'.. => {
                if ('\u{2000}'..='\u{2E7F}').contains(&c) {
                    660.0
                } else {
                    1000.0
                }
            }
            _ => 620.0,
        })
        .sum();
    thousandths * size / 1000.0
}

/// The text, cut with an ellipsis where it is wider than `room`.
pub(crate) fn fit(text: &str, room: f64, size: f64) -> String {
    if width(text, size) <= room {
        return text.to_owned();
    }
    let mut out = String::new();
    for c in text.chars() {
        out.push(c);
        if width(&out, size) + size * 0.83 > room {
            out.pop();
            break;
        }
    }
    out.truncate(out.trim_end().len());
    out.push('…');
    out
}

/// The text in lines no wider than `room`; a word longer than a line is broken.
pub(crate) fn wrap(text: &str, room: f64, size: f64) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let gap = if line.is_empty() { 0.0 } else { width(" ", size) };
        if !line.is_empty() && width(&line, size) + gap + width(word, size) > room {
            lines.push(std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        for c in word.chars() {
            line.push(c);
            if width(&line, size) > room && line.chars().count() > 1 {
                line.pop();
                lines.push(std::mem::take(&mut line));
                line.push(c);
            }
        }
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_escapes() {
        assert_eq!(escape("a<b>&\"'\u{0}\n"), "a&lt;b&gt;&amp;&quot;&#39;\u{FFFD} ");
        assert_eq!(json("</script>\"\\\u{1}"), r#""\u003c/script\u003e\"\\\u0001""#);
    }

    #[test]
    fn lines_keep_to_their_room() {
        let long = "word ".repeat(40) + &"x".repeat(300);
        for line in wrap(&long, 120.0, 12.0) {
            assert!(width(&line, 12.0) <= 120.0);
        }
        let words = |s: &str| s.chars().filter(|c| !c.is_whitespace()).count();
        assert_eq!(wrap(&long, 120.0, 12.0).iter().map(|l| words(l)).sum::<usize>(), words(&long));
        assert!(width(&fit(&long, 100.0, 12.0), 12.0) <= 100.0);
        assert_eq!(fit("short", 100.0, 12.0), "short");
    }
}
