//! JPEG and TIFF files.

use std::io::Cursor;

use image::{DynamicImage, ImageDecoder, ImageReader, Limits};

use super::{Decoded, ImageError, check_size, memory_max, over_white};

/// Decodes a JPEG or TIFF of at most `pixels_max` pixels.
pub(super) fn decode(bytes: &[u8], pixels_max: u64) -> Result<Decoded, ImageError> {
    let decode = |error: image::ImageError| ImageError::Decode(error.to_string());
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| ImageError::Decode(error.to_string()))?;
    if reader.format().is_none() {
        return Err(ImageError::UnknownFormat);
    }
    let mut limits = Limits::default();
    limits.max_alloc = Some(memory_max(pixels_max));
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(decode)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height, pixels_max)?;
    let exif = decoder.exif_metadata().ok().flatten();
    let orientation = decoder.orientation().map_err(decode)?.to_exif();
    let decoded = DynamicImage::from_decoder(decoder).map_err(decode)?;
    let (width, height) = (decoded.width() as usize, decoded.height() as usize);
    let pixels = if decoded.color().has_alpha() {
        over_white(&decoded.into_rgba8())
    } else {
        decoded.into_rgb8().into_raw()
    };
    Ok(Decoded { pixels, width, height, orientation, exif })
}
