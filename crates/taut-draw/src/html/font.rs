//! The two faces of the page, as part of it: the same letters and widths on every machine.

use crate::base64::base64;

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
