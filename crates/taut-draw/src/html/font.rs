//! The two faces of the page, as part of it: the same letters and widths on every machine.

/// The rules of the style sheet that hold the faces (Inter, under the SIL Open Font License; see `assets/`).
pub(super) fn faces() -> String {
    let face = |weight: u32, data: &[u8]| {
        format!(
            "@font-face{{font-family:Inter;font-weight:{weight};src:url(data:font/woff2;base64,{}) format(\"woff2\")}}\n",
            base64(data)
        )
    };
    face(400, include_bytes!("../../assets/Inter-Regular.woff2"))
        + &face(600, include_bytes!("../../assets/Inter-SemiBold.woff2"))
}

/// Base64 with padding (RFC 4648, section 4).
fn base64(data: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(data.len().div_ceil(3) * 4);
    for three in data.chunks(3) {
        let byte = |i: usize| three.get(i).copied().map_or(0, u32::from);
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * i) & 63) as usize];
            out.push(if i <= three.len() { letter as char } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #[test]
    fn base64_as_in_the_rfc() {
        let cases =
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")];
        for (data, text) in cases {
            assert_eq!(super::base64(data.as_bytes()), text);
        }
    }
}
