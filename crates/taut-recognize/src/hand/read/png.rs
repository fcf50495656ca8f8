//! PNG files.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, Limits, Transformations};

use super::exif::Tags;
use super::{Decoded, ImageError, check_size, memory_max, over_white};

pub(super) const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Decodes a PNG of at most `pixels_max` pixels.
pub(super) fn decode(bytes: &[u8], pixels_max: u64) -> Result<Decoded, ImageError> {
    let decode = |error: png::DecodingError| ImageError::Decode(error.to_string());
    let limits = Limits { bytes: usize::try_from(memory_max(pixels_max)).unwrap_or(usize::MAX) };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    // Palettes, single bits and a transparent color become channels.
    decoder.set_transformations(Transformations::EXPAND);
    let header = decoder.read_header_info().map_err(decode)?;
    check_size(header.width, header.height, pixels_max)?;
    let mut reader = decoder.read_info().map_err(decode)?;
    let exif = reader.info().exif_metadata.as_deref().map(<[u8]>::to_vec);
    let size = reader
        .output_buffer_size()
        .ok_or_else(|| ImageError::Decode("the image does not fit into memory".to_owned()))?;
    let mut samples = vec![0; size];
    let frame = reader.next_frame(&mut samples).map_err(decode)?;
    samples.truncate(frame.buffer_size());
    if frame.bit_depth == BitDepth::Sixteen {
        samples = samples.as_chunks::<2>().0.iter().map(|&s| to_eight_bits(s)).collect();
    }
    let pixels = match frame.color_type {
        ColorType::Rgb => samples,
        ColorType::Rgba => over_white(&samples),
        ColorType::Grayscale => samples.into_iter().flat_map(|gray| [gray; 3]).collect(),
        ColorType::GrayscaleAlpha => {
            let rgba = |&[gray, opacity]: &[u8; 2]| [gray, gray, gray, opacity];
            over_white(&samples.as_chunks::<2>().0.iter().flat_map(rgba).collect::<Vec<_>>())
        }
        ColorType::Indexed => {
            return Err(ImageError::Decode("the palette was not applied".to_owned()));
        }
    };
    let orientation = exif.as_deref().and_then(Tags::of).and_then(|tags| tags.orientation());
    let (width, height) = (frame.width as usize, frame.height as usize);
    Ok(Decoded { pixels, width, height, orientation: orientation.unwrap_or(1), exif })
}

/// The nearest of 256 values.
fn to_eight_bits(sample: [u8; 2]) -> u8 {
    ((u32::from(u16::from_be_bytes(sample)) + 128) / 257) as u8
}
