//! Images from files: PNG, and with the feature `photographs` JPEG and TIFF, with limits on memory, turned upright, with
//! their resolution.
//!
//! 16-bit channels are rounded to 8, gray becomes RGB, CMYK is converted by the decoder, and transparency is laid over
//! white. Color profiles are not applied: values are taken as sRGB.

mod exif;
#[cfg(feature = "photographs")]
mod photograph;
mod png;
mod resolution;

use std::path::PathBuf;

/// An image of three bytes for each pixel, by rows, in sRGB.
#[derive(Clone, Debug, PartialEq)]
pub struct RgbImage {
    pixels: Vec<u8>,
    width: usize,
    height: usize,
    dots_per_inch: Option<f64>,
    /// The resolution of a file that no scan of a hand has, along rows and columns.
    implausible: Option<[f64; 2]>,
}

/// Why an image cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The file cannot be opened or read.
    #[error("{}: {error}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: String,
    },
    /// The bytes are of no format that is read.
    #[error("not an image in PNG, JPEG or TIFF")]
    UnknownFormat,
    /// This build does not read JPEG or TIFF.
    #[error(
        "this build does not read {0}: enable the cargo feature `photographs`, or convert the image to PNG"
    )]
    NotBuilt(&'static str),
    /// The image is damaged or of a kind that the decoder does not know.
    #[error("the image cannot be decoded: {0}")]
    Decode(String),
    /// The image has no pixels.
    #[error("the image is empty")]
    Empty,
    /// The image is larger than the limit.
    #[error("the image has {width} × {height} pixels, more than the limit of {limit}")]
    TooLarge {
        /// Its columns.
        width: u32,
        /// Its rows.
        height: u32,
        /// The largest number of pixels.
        limit: u64,
    },
    /// The buffer does not have three bytes for each pixel.
    #[error("{bytes} bytes are not {width} × {height} pixels of 3 bytes")]
    WrongSize {
        /// Bytes given.
        bytes: usize,
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// Neither the file nor the options give a resolution, without which there are no millimeters.
    #[error("the image does not give its resolution: set `dots_per_inch`")]
    NoResolution,
    /// The resolution of the file cannot be that of a scan of a hand.
    #[error(
        "the image gives its resolution as {horizontal} × {vertical} dots per inch: set `dots_per_inch`"
    )]
    BadResolution {
        /// Dots per inch along rows.
        horizontal: f64,
        /// Dots per inch along columns.
        vertical: f64,
    },
}

impl RgbImage {
    /// Makes an image from three bytes for each pixel, by rows.
    ///
    /// # Errors
    /// [`ImageError::Empty`] and [`ImageError::WrongSize`].
    pub fn new(
        pixels: Vec<u8>,
        width: usize,
        height: usize,
        dots_per_inch: Option<f64>,
    ) -> Result<Self, ImageError> {
        if width == 0 || height == 0 {
            return Err(ImageError::Empty);
        }
        let wanted = width.checked_mul(height).and_then(|count| count.checked_mul(3));
        if wanted != Some(pixels.len()) {
            return Err(ImageError::WrongSize { bytes: pixels.len(), width, height });
        }
        let dots_per_inch = dots_per_inch.filter(|value| value.is_finite() && *value > 0.0);
        Ok(Self { pixels, width, height, dots_per_inch, implausible: None })
    }

    /// Makes an image of a generator, whose sizes agree.
    pub(super) fn from_parts(
        pixels: Vec<u8>,
        width: usize,
        height: usize,
        dots_per_inch: f64,
    ) -> Self {
        let dots_per_inch = Some(dots_per_inch);
        Self { pixels, width, height, dots_per_inch, implausible: None }
    }

    /// Decodes an image file of at most `pixels_max` pixels.
    ///
    /// # Errors
    /// [`ImageError`]: the bytes are no image, or one that is too large or damaged.
    pub fn decode(bytes: &[u8], pixels_max: u64) -> Result<Self, ImageError> {
        let decoded = decode(bytes, pixels_max)?;
        let (dots_per_inch, implausible) = resolution::find(bytes, decoded.exif.as_deref());
        let Decoded { pixels, width, height, orientation, .. } = decoded;
        let (pixels, width, height) = turned(pixels, width, height, orientation);
        Ok(Self { implausible, ..Self::new(pixels, width, height, dots_per_inch)? })
    }

    /// Returns the resolution of the file where that cannot be one of a scan of a hand, along rows and columns.
    #[must_use]
    pub fn implausible_resolution(&self) -> Option<[f64; 2]> {
        self.implausible
    }

    /// Returns the bytes, three for each pixel, by rows.
    #[must_use]
    pub fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    /// Returns the number of columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Returns the resolution, if the file gives it.
    #[must_use]
    pub fn dots_per_inch(&self) -> Option<f64> {
        self.dots_per_inch
    }

    /// Returns a pixel; `None` beyond the image.
    #[must_use]
    pub fn get(&self, x: usize, y: usize) -> Option<[u8; 3]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let at = 3 * (y * self.width + x);
        Some([self.pixels[at], self.pixels[at + 1], self.pixels[at + 2]])
    }
}

/// A decoded image with its metadata.
struct Decoded {
    /// Red, green and blue of each pixel, by rows.
    pixels: Vec<u8>,
    width: usize,
    height: usize,
    /// How the image is to be turned, as EXIF counts: from 1, upright, to 8.
    orientation: u8,
    exif: Option<Vec<u8>>,
}

fn decode(bytes: &[u8], pixels_max: u64) -> Result<Decoded, ImageError> {
    if bytes.starts_with(png::SIGNATURE) {
        return png::decode(bytes, pixels_max);
    }
    #[cfg(feature = "photographs")]
    return photograph::decode(bytes, pixels_max);
    #[cfg(not(feature = "photographs"))]
    Err(not_built(bytes))
}

/// What a build without photographs says of a file that is no PNG.
#[cfg(any(test, not(feature = "photographs")))]
fn not_built(bytes: &[u8]) -> ImageError {
    match bytes {
        [0xff, 0xd8, 0xff, ..] => ImageError::NotBuilt("JPEG"),
        [b'I', b'I', 42, 0, ..] | [b'M', b'M', 0, 42, ..] => ImageError::NotBuilt("TIFF"),
        _ => ImageError::UnknownFormat,
    }
}

/// Bytes that a decoder may take for so many pixels.
fn memory_max(pixels_max: u64) -> u64 {
    /// Bytes of a decoded pixel at most, 16 bits in four channels, and as much again while it is converted.
    const PIXEL_BYTES_MAX: u64 = 16;
    /// What a decoder needs beside its pixels.
    const DECODER_BYTES: u64 = 32 << 20;
    pixels_max.saturating_mul(PIXEL_BYTES_MAX).saturating_add(DECODER_BYTES)
}

fn check_size(width: u32, height: u32, pixels_max: u64) -> Result<(), ImageError> {
    if width == 0 || height == 0 {
        return Err(ImageError::Empty);
    }
    if u64::from(width) * u64::from(height) > pixels_max {
        return Err(ImageError::TooLarge { width, height, limit: pixels_max });
    }
    Ok(())
}

/// Lays pixels of red, green, blue and opacity over white.
fn over_white(rgba: &[u8]) -> Vec<u8> {
    let blend = |value: u8, opacity: u8| {
        let (value, opacity) = (u32::from(value), u32::from(opacity));
        ((value * opacity + 255 * (255 - opacity) + 127) / 255) as u8
    };
    let mut rgb = Vec::with_capacity(rgba.len() / 4 * 3);
    for pixel in rgba.as_chunks::<4>().0 {
        rgb.extend(pixel[..3].iter().map(|&value| blend(value, pixel[3])));
    }
    rgb
}

/// Turns and mirrors an image as its file asks for, and returns its new width and height.
fn turned(
    pixels: Vec<u8>,
    width: usize,
    height: usize,
    orientation: u8,
) -> (Vec<u8>, usize, usize) {
    if orientation == 1 {
        return (pixels, width, height);
    }
    let is_upright = orientation < 5;
    let (columns, rows) = if is_upright { (width, height) } else { (height, width) };
    let (right, bottom) = (width - 1, height - 1);
    let source = |x: usize, y: usize| match orientation {
        2 => (right - x, y),
        3 => (right - x, bottom - y),
        4 => (x, bottom - y),
        5 => (y, x),
        6 => (y, bottom - x),
        7 => (right - y, bottom - x),
        8 => (right - y, x),
        _ => (x, y),
    };
    let mut turned = Vec::with_capacity(pixels.len());
    for (y, x) in (0..rows).flat_map(|y| (0..columns).map(move |x| (y, x))) {
        let (x, y) = source(x, y);
        turned.extend_from_slice(&pixels[3 * (y * width + x)..][..3]);
    }
    (turned, columns, rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_built_says_so() {
        assert_eq!(not_built(b"\xff\xd8\xff\xe0 and more"), ImageError::NotBuilt("JPEG"));
        assert_eq!(not_built(b"II\x2a\0 and more"), ImageError::NotBuilt("TIFF"));
        assert_eq!(not_built(b"MM\0\x2a and more"), ImageError::NotBuilt("TIFF"));
        assert_eq!(not_built(b"no image"), ImageError::UnknownFormat);
    }
}
