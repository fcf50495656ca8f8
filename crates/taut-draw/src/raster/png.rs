//! An image as PNG (ISO/IEC 15948), 8 bits each of red, green, blue and opacity.
//!
//! *Idea.* Each row is written as differences from the row above, which shading keeps small.
//! *Guarantee.* The same bytes on every machine: the compressor is one of plain Rust, whatever else is in the build.

use super::Image;

/// The compressor's level, 0 to 10. Level 6 takes three times as long, and the file of a shaded sphere is an eighth smaller.
const LEVEL: u8 = 4;

/// The bytes of a file.
pub(crate) fn png(image: &Image) -> Vec<u8> {
    let mut rows = Vec::with_capacity(image.height * (4 * image.width + 1));
    for y in 0..image.height {
        // Filter 2, up.
        rows.push(2);
        for x in 0..image.width {
            let here = image.pixels[y * image.width + x];
            let above = if y > 0 { image.pixels[(y - 1) * image.width + x] } else { [0; 4] };
            rows.extend([0, 1, 2, 3].map(|k| here[k].wrapping_sub(above[k])));
        }
    }
    let mut header = Vec::new();
    header.extend((image.width as u32).to_be_bytes());
    header.extend((image.height as u32).to_be_bytes());
    // 8 bits a channel, color with opacity, and the one method of compressing, filtering and ordering each.
    header.extend([8, 6, 0, 0, 0]);
    let mut out = b"\x89PNG\r\n\x1a\n".to_vec();
    chunk(&mut out, b"IHDR", &header);
    chunk(&mut out, b"IDAT", &miniz_oxide::deflate::compress_to_vec_zlib(&rows, LEVEL));
    chunk(&mut out, b"IEND", &[]);
    out
}

fn chunk(out: &mut Vec<u8>, kind: &[u8; 4], data: &[u8]) {
    out.extend((data.len() as u32).to_be_bytes());
    let begun = out.len();
    out.extend(kind);
    out.extend(data);
    let sum = crc(&out[begun..]);
    out.extend(sum.to_be_bytes());
}

/// The cyclic redundancy check of PNG, annex D, by half bytes.
fn crc(bytes: &[u8]) -> u32 {
    let table: [u32; 16] = std::array::from_fn(|i| {
        (0..4).fold(i as u32, |c, _| if c & 1 == 1 { 0xEDB8_8320 ^ (c >> 1) } else { c >> 1 })
    });
    let nibble = |c: u32, half: u32| table[((c ^ half) & 15) as usize] ^ (c >> 4);
    !bytes.iter().fold(!0, |c, &byte| nibble(nibble(c, byte.into()), u32::from(byte) >> 4))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_is_that_of_the_standard() {
        assert_eq!(crc(b"123456789"), 0xCBF4_3926);
        assert_eq!(crc(b"IEND"), 0xAE42_6082);
    }

    #[test]
    fn another_reader_finds_the_same_pixels() {
        let pixel = |i: usize| match i % 3 {
            0 => [0; 4],
            _ => [(i * 7) as u8, (i * 31) as u8, (i / 5) as u8, 255],
        };
        let image = Image { width: 37, height: 23, pixels: (0..37 * 23).map(pixel).collect() };
        let read = tiny_skia::Pixmap::decode_png(&png(&image)).unwrap();
        assert_eq!((read.width(), read.height()), (37, 23));
        assert_eq!(read.data(), image.pixels.as_flattened());
        assert_eq!(png(&image), png(&image));
    }
}
