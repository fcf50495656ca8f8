//! Images to PNG, with their resolution.

use png::{BitDepth, ColorType, Encoder, EncodingError, PixelDimensions, Unit};

use super::MM_PER_INCH;
use super::read::RgbImage;

impl RgbImage {
    /// Returns the bytes of a PNG file, with the resolution if it is known.
    ///
    /// # Errors
    /// [`EncodingError`] for an image of more columns or rows than the format has.
    pub fn to_png(&self) -> Result<Vec<u8>, EncodingError> {
        let too_large = || std::io::Error::other("more columns or rows than PNG has");
        let size = |count: usize| u32::try_from(count).map_err(|_| too_large());
        let mut bytes = vec![];
        let mut encoder = Encoder::new(&mut bytes, size(self.width())?, size(self.height())?);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        if let Some(dots_per_inch) = self.dots_per_inch() {
            let per_meter = (dots_per_inch * 1000.0 / MM_PER_INCH).round() as u32;
            encoder.set_pixel_dims(Some(PixelDimensions {
                xppu: per_meter,
                yppu: per_meter,
                unit: Unit::Meter,
            }));
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels())?;
        writer.finish()?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back() {
        let pixels: Vec<u8> = (0..5 * 3 * 3).map(|i| (i * 37 % 256) as u8).collect();
        for dots_per_inch in [None, Some(90.0), Some(300.0)] {
            let image = RgbImage::new(pixels.clone(), 5, 3, dots_per_inch).unwrap();
            let read = RgbImage::decode(&image.to_png().unwrap(), 100).unwrap();
            assert_eq!((read.pixels(), read.width(), read.height()), (&pixels[..], 5, 3));
            // The file has whole dots for each meter.
            match (read.dots_per_inch(), dots_per_inch) {
                (None, None) => {}
                (Some(read), Some(written)) => assert!((read / written - 1.0).abs() < 2e-4),
                other => panic!("{other:?}"),
            }
        }
    }
}
