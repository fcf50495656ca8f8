//! Figures as PNG, through their SVG.
//!
//! *Guarantee.* The same figure gives the same bytes on every machine: the only fonts are two faces of Inter that
//! are part of this crate (`assets/`, under the SIL Open Font License); no font of the system is read.
//! *Trap.* The faces hold Latin, Greek and mathematical signs; letters of other scripts show as empty boxes.

use std::sync::{Arc, OnceLock};

use resvg::usvg::{self, fontdb};

use crate::{Error, Figure, Style, to_svg};

/// Largest number of pixels of a picture: about 256 MiB while it is drawn.
const MAX_PIXELS: f64 = 67_108_864.0;

/// The figure as PNG, `scale` pixels to each unit of its width and height, 0.1 to 10.
///
/// # Errors
/// [`Error::Option`] for a scale out of range, [`Error::Png`] for a picture of more than 67 million pixels.
pub fn to_png(figure: &Figure, style: &Style, scale: f32) -> Result<Vec<u8>, Error> {
    if !(0.1..=10.0).contains(&scale) {
        return Err(Error::Option {
            name: "scale",
            value: scale.to_string(),
            expected: "0.1 to 10",
        });
    }
    let wrong = |reason: String| Error::Png { reason };
    let options =
        usvg::Options { font_family: "Inter".into(), fontdb: fonts(), ..usvg::Options::default() };
    let tree =
        usvg::Tree::from_str(&to_svg(figure, style), &options).map_err(|e| wrong(e.to_string()))?;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|s| (s * scale).ceil());
    if f64::from(width) * f64::from(height) > MAX_PIXELS {
        return Err(wrong(format!(
            "{width} × {height} pixels are more than 67,108,864; ask for a smaller scale"
        )));
    }
    let mut pixels = tiny_skia::Pixmap::new(width as u32, height as u32)
        .ok_or_else(|| wrong(format!("{width} × {height} pixels cannot be held")))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| wrong(e.to_string()))
}

fn fonts() -> Arc<fontdb::Database> {
    static FONTS: OnceLock<Arc<fontdb::Database>> = OnceLock::new();
    FONTS
        .get_or_init(|| {
            let mut fonts = fontdb::Database::new();
            fonts.load_font_data(include_bytes!("../assets/Inter-Regular.otf").to_vec());
            fonts.load_font_data(include_bytes!("../assets/Inter-SemiBold.otf").to_vec());
            // Whatever family a document asks for, this is the one there is.
            fonts.set_sans_serif_family("Inter");
            fonts.set_serif_family("Inter");
            fonts.set_monospace_family("Inter");
            Arc::new(fonts)
        })
        .clone()
}
