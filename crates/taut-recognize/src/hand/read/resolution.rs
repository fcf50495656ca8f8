//! The resolution that an image file gives: pHYs of PNG, JFIF and EXIF of JPEG, the tags of TIFF.

use super::exif::Tags;

/// Dots per inch that a scan of a hand can have.
const PLAUSIBLE: std::ops::RangeInclusive<f64> = 20.0..=2400.0;

/// The largest ratio of the resolutions along rows and columns: pixels are taken as square.
const RATIO_MAX: f64 = 1.01;

const INCHES_PER_METER: f64 = 1000.0 / 25.4;

/// Finds the resolution in dots per inch, if the file gives it, or else what it gives that no scan of a hand has.
pub(super) fn find(bytes: &[u8], exif: Option<&[u8]>) -> (Option<f64>, Option<[f64; 2]>) {
    let tags = |bytes| Tags::of(bytes).and_then(Tags::resolution);
    let found =
        png(bytes).or_else(|| jpeg(bytes)).or_else(|| tags(bytes)).or_else(|| exif.and_then(tags));
    let Some([horizontal, vertical]) = found else { return (None, None) };
    let ratio = horizontal / vertical;
    if !(PLAUSIBLE.contains(&horizontal) && (1.0 / RATIO_MAX..=RATIO_MAX).contains(&ratio)) {
        return (None, Some([horizontal, vertical]));
    }
    (Some((horizontal * vertical).sqrt()), None)
}

fn big_endian_32(bytes: &[u8], at: usize) -> Option<u32> {
    let part = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_be_bytes(part.try_into().ok()?))
}

fn big_endian_16(bytes: &[u8], at: usize) -> Option<u16> {
    let part = bytes.get(at..at.checked_add(2)?)?;
    Some(u16::from_be_bytes(part.try_into().ok()?))
}

/// Reads the chunk pHYs of a PNG: pixels per meter.
fn png(bytes: &[u8]) -> Option<[f64; 2]> {
    let mut at = 8;
    if !bytes.starts_with(super::png::SIGNATURE) {
        return None;
    }
    loop {
        let length = big_endian_32(bytes, at)? as usize;
        match bytes.get(at + 4..at + 8)? {
            b"pHYs" => {
                let (x, y) = (big_endian_32(bytes, at + 8)?, big_endian_32(bytes, at + 12)?);
                let is_metric = *bytes.get(at + 16)? == 1;
                return is_metric.then(|| [x, y].map(|n| f64::from(n) / INCHES_PER_METER));
            }
            // The chunk stands before the pixels.
            b"IDAT" | b"IEND" => return None,
            _ => at = at.checked_add(length)?.checked_add(12)?,
        }
    }
}

/// Reads the density of the JFIF segment of a JPEG.
fn jpeg(bytes: &[u8]) -> Option<[f64; 2]> {
    if !bytes.starts_with(&[0xff, 0xd8]) {
        return None;
    }
    let mut at = 2;
    loop {
        if *bytes.get(at)? != 0xff {
            return None;
        }
        let marker = *bytes.get(at + 1)?;
        let length = usize::from(big_endian_16(bytes, at + 2)?);
        match marker {
            0xe0 if bytes.get(at + 4..at + 9)? == b"JFIF\0" => {
                let scale = match *bytes.get(at + 11)? {
                    1 => 1.0,
                    2 => 2.54,
                    _ => return None,
                };
                let (x, y) = (big_endian_16(bytes, at + 12)?, big_endian_16(bytes, at + 14)?);
                return Some([x, y].map(|density| f64::from(density) * scale));
            }
            // The pixels begin.
            0xda | 0xd9 => return None,
            _ => at = at.checked_add(length)?.checked_add(2)?,
        }
    }
}
