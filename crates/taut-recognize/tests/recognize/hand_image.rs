//! Images from files: formats, resolution, rotation, limits and damage; each gives an image or a typed answer.

use std::io::Cursor;

use image::{DynamicImage, ImageFormat};
use taut_recognize::hand::color::{
    APPROXIMATION_MAX, FIXED_THRESHOLD, ThresholdTable, approximate_lab_b, lab_b,
};
use taut_recognize::hand::{Failure, Gate, Hand, HandError, HandOptions, ImageError, RgbImage};

const LIMIT: u64 = 1_000_000;

fn encode(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(vec![]);
    image.write_to(&mut bytes, format).expect("an image is written to memory");
    bytes.into_inner()
}

/// An image of 4 × 2 pixels, all different.
fn sample() -> image::RgbImage {
    image::RgbImage::from_fn(4, 2, |x, y| image::Rgb([10 * x as u8, 100 + y as u8, 200]))
}

/// Puts a chunk of a type and data behind the header of a PNG, with the checksum of both.
fn with_chunk(png: &[u8], body: &[u8]) -> Vec<u8> {
    let mut checksum = flate2::Crc::new();
    checksum.update(body);
    let mut bytes = png[..33].to_vec();
    bytes.extend((body.len() as u32 - 4).to_be_bytes());
    bytes.extend(body);
    bytes.extend(checksum.sum().to_be_bytes());
    bytes.extend(&png[33..]);
    bytes
}

/// Puts a chunk pHYs behind the header of a PNG.
fn with_density(png: &[u8], x: u32, y: u32, unit: u8) -> Vec<u8> {
    let mut body = b"pHYs".to_vec();
    body.extend(x.to_be_bytes());
    body.extend(y.to_be_bytes());
    body.push(unit);
    with_chunk(png, &body)
}

#[test]
fn formats_give_the_same_pixels() {
    let image = DynamicImage::from(sample());
    let sixteen = DynamicImage::from(image.to_rgb16());
    let alpha = DynamicImage::from(image.to_rgba8());
    for (kind, format) in [
        (&image, ImageFormat::Png),
        (&image, ImageFormat::Tiff),
        (&sixteen, ImageFormat::Png),
        (&sixteen, ImageFormat::Tiff),
        (&alpha, ImageFormat::Png),
    ] {
        let found = RgbImage::decode(&encode(kind, format), LIMIT).expect("an image is read");
        assert_eq!(found.pixels(), sample().as_raw().as_slice(), "{format:?}");
        assert_eq!((found.width(), found.height()), (4, 2));
    }
    let gray = DynamicImage::from(image.to_luma16());
    let found = RgbImage::decode(&encode(&gray, ImageFormat::Png), LIMIT).expect("gray is read");
    assert!(found.pixels().chunks(3).all(|p| p[0] == p[1] && p[1] == p[2]));
}

#[test]
fn transparent_pixels_are_white() {
    let clear = image::RgbaImage::from_pixel(2, 1, image::Rgba([9, 9, 9, 0]));
    let bytes = encode(&DynamicImage::from(clear), ImageFormat::Png);
    assert_eq!(RgbImage::decode(&bytes, LIMIT).expect("an image").pixels(), [255; 6]);
}

#[test]
fn resolution_is_that_of_the_file() {
    let png = encode(&DynamicImage::from(sample()), ImageFormat::Png);
    let density = |bytes: &[u8]| RgbImage::decode(bytes, LIMIT).map(|image| image.dots_per_inch());
    assert_eq!(density(&png), Ok(None));
    let found = density(&with_density(&png, 3543, 3543, 1)).expect("a PNG").expect("a resolution");
    assert!((found - 89.9922).abs() < 1e-3, "{found}");
    assert_eq!(density(&with_density(&png, 3543, 3543, 0)), Ok(None), "a ratio is no resolution");
    for (x, y) in [(3543, 4000), (1, 1), (0, 0), (u32::MAX, u32::MAX)] {
        let found = density(&with_density(&png, x, y, 1));
        assert_eq!(found, Ok(None), "{x} {y}");
    }
    // JFIF: the density is in bytes 13 to 17, its unit in byte 13.
    let mut jpeg = encode(&DynamicImage::from(sample()), ImageFormat::Jpeg);
    assert_eq!(&jpeg[6..10], b"JFIF");
    jpeg[13..18].copy_from_slice(&[1, 0, 150, 0, 150]);
    assert_eq!(density(&jpeg), Ok(Some(150.0)));
    jpeg[13..18].copy_from_slice(&[2, 0, 100, 0, 100]);
    assert_eq!(density(&jpeg), Ok(Some(254.0)));
}

#[test]
fn exif_turns_the_image_and_gives_a_resolution() {
    let jpeg = encode(&DynamicImage::from(sample()), ImageFormat::Jpeg);
    // One directory: orientation 6 (turn right), resolutions 300 per inch.
    let mut exif = b"Exif\0\0MM\0\x2a\0\0\0\x08\0\x03".to_vec();
    exif.extend(b"\x01\x12\0\x03\0\0\0\x01\0\x06\0\0");
    exif.extend(b"\x01\x1a\0\x05\0\0\0\x01\0\0\0\x32\x01\x1b\0\x05\0\0\0\x01\0\0\0\x32");
    exif.extend(b"\0\0\0\0\0\0\x01\x2c\0\0\0\x01");
    let length = (exif.len() + 2) as u16;
    // In place of the JFIF segment, so that no other density is there.
    let after = 4 + usize::from(u16::from_be_bytes([jpeg[4], jpeg[5]]));
    let mut bytes = vec![0xff, 0xd8, 0xff, 0xe1];
    bytes.extend(length.to_be_bytes());
    bytes.extend(&exif);
    bytes.extend(&jpeg[after..]);
    let found = RgbImage::decode(&bytes, LIMIT).expect("a JPEG with EXIF is read");
    assert_eq!((found.width(), found.height()), (2, 4));
    assert_eq!(found.dots_per_inch(), Some(300.0));
}

/// Puts EXIF data of one tag, the orientation, behind the header of a PNG.
fn with_orientation(png: &[u8], orientation: u8) -> Vec<u8> {
    let mut body = b"eXIfMM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
    body.extend([orientation, 0, 0, 0, 0, 0, 0]);
    with_chunk(png, &body)
}

#[test]
fn a_png_is_turned_as_its_exif_data_say() {
    use image::metadata::Orientation;
    let png = encode(&DynamicImage::from(sample()), ImageFormat::Png);
    for orientation in 1..=8 {
        let found = RgbImage::decode(&with_orientation(&png, orientation), LIMIT).expect("a PNG");
        let mut expected = DynamicImage::from(sample());
        expected.apply_orientation(Orientation::from_exif(orientation).expect("one of eight"));
        assert_eq!(found.pixels(), expected.as_bytes(), "{orientation}");
        assert_eq!(found.width(), expected.width() as usize);
    }
    // The first entry with one number of 16 bits counts: neither a long one nor a second one.
    let entry = |kind: u8, value: u8| [1, 0x12, 0, kind, 0, 0, 0, 1, 0, value, 0, 0];
    for (entries, turned) in [
        (vec![entry(4, 6)], false),
        (vec![entry(3, 6), entry(3, 1)], true),
        (vec![entry(4, 1), entry(3, 6)], true),
    ] {
        let mut body = b"eXIfMM\0\x2a\0\0\0\x08\0".to_vec();
        body.push(entries.len() as u8);
        body.extend(entries.as_flattened());
        let found = RgbImage::decode(&with_chunk(&png, &body), LIMIT).expect("a PNG");
        assert_eq!(found.width() == 2, turned, "{entries:?}");
    }
    // No orientation of EXIF.
    for orientation in [0, 9, 255] {
        let found = RgbImage::decode(&with_orientation(&png, orientation), LIMIT).expect("a PNG");
        assert_eq!(found.pixels(), sample().as_raw().as_slice(), "{orientation}");
    }
}

/// Every kind of channels and bits, transparent colors and palettes: the pixels are those of the crate `image`.
#[test]
fn every_kind_of_png_is_read_as_by_another_reader() {
    use png::{BitDepth, ColorType, Encoder};
    let (width, height) = (5u32, 3u32);
    let kinds = [
        (ColorType::Grayscale, &[1, 2, 4, 8, 16][..]),
        (ColorType::GrayscaleAlpha, &[8, 16]),
        (ColorType::Rgb, &[8, 16]),
        (ColorType::Rgba, &[8, 16]),
        (ColorType::Indexed, &[1, 2, 4, 8]),
    ];
    let mut count = 0;
    for (color, depths) in kinds {
        for (&bits, has_transparent) in depths.iter().flat_map(|bits| [(bits, false), (bits, true)])
        {
            let has_alpha = matches!(color, ColorType::GrayscaleAlpha | ColorType::Rgba);
            if has_alpha && has_transparent {
                continue;
            }
            let row = (width as usize * color.samples() * bits).div_ceil(8);
            let data: Vec<u8> = (0..row * height as usize).map(|at| (at * 73 + 29) as u8).collect();
            let mut bytes = vec![];
            let mut encoder = Encoder::new(&mut bytes, width, height);
            encoder.set_color(color);
            encoder.set_depth(BitDepth::from_u8(bits as u8).expect("a depth of PNG"));
            if color == ColorType::Indexed {
                encoder.set_palette((0..768).map(|at| (at * 31 % 251) as u8).collect::<Vec<_>>());
            }
            if has_transparent {
                let of_colors: &[u8] = match color {
                    ColorType::Indexed => &[0, 128, 255, 7],
                    ColorType::Grayscale => &[0, 1],
                    _ => &[0, 29, 0, 102, 0, 175],
                };
                encoder.set_trns(of_colors);
            }
            let mut writer = encoder.write_header().expect("a header");
            writer.write_image_data(&data).expect("pixels");
            drop(writer);
            let found = RgbImage::decode(&bytes, LIMIT).expect("a PNG");
            let other = image::load_from_memory(&bytes).expect("a PNG");
            let over_white = |pixel: &image::Rgba<u8>| {
                let [r, g, b, opacity] = pixel.0.map(u32::from);
                [r, g, b].map(|v| ((v * opacity + 255 * (255 - opacity) + 127) / 255) as u8)
            };
            let expected: Vec<u8> = other.to_rgba8().pixels().flat_map(over_white).collect();
            assert_eq!(found.pixels(), expected, "{color:?}, {bits} bits, {has_transparent}");
            count += 1;
        }
    }
    assert_eq!(count, 26);
}

/// A JPEG of one block of 8 × 8 pixels in Adobe's CMYK, which stores 255 less each ink.
fn cmyk_jpeg(stored: [u8; 4]) -> Vec<u8> {
    let segment = |marker: u8, body: &[u8]| {
        let mut bytes = vec![0xff, marker];
        bytes.extend(((body.len() + 2) as u16).to_be_bytes());
        bytes.extend(body);
        bytes
    };
    let mut bytes = vec![0xff, 0xd8];
    // Version 100, no flags, no color transform.
    bytes.extend(segment(0xee, b"Adobe\0\x64\0\0\0\0\0"));
    // One table of quantization, 8 for each coefficient: a constant block is 8 times its value.
    bytes.extend(segment(0xdb, &[&[0][..], &[8; 64]].concat()));
    let parts = (1..=4).flat_map(|id| [id, 0x11, 0]);
    bytes.extend(segment(0xc0, &[8, 0, 8, 0, 8, 4].into_iter().chain(parts).collect::<Vec<_>>()));
    // Categories 0 to 11 of the first coefficient have codes of 4 bits, the end of the block that of 1 bit.
    let mut first = vec![0, 0, 0, 0, 12, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    first.extend(0..12);
    bytes.extend(segment(0xc4, &first));
    let mut others = vec![0x10, 1];
    others.extend([0; 16]);
    bytes.extend(segment(0xc4, &others));
    let parts = (1..=4).flat_map(|id| [id, 0]);
    bytes.extend(segment(
        0xda,
        &[4].into_iter().chain(parts).chain([0, 63, 0]).collect::<Vec<u8>>(),
    ));
    let mut bits = String::new();
    for value in stored {
        let value = i32::from(value) - 128;
        let category = (32 - value.unsigned_abs().leading_zeros()) as usize;
        let code = if value < 0 { value + (1 << category) - 1 } else { value };
        bits += &format!("{category:04b}");
        if category > 0 {
            bits += &format!("{code:0category$b}");
        }
        bits.push('0');
    }
    while !bits.len().is_multiple_of(8) {
        bits.push('1');
    }
    for start in (0..bits.len()).step_by(8) {
        let byte = u8::from_str_radix(&bits[start..start + 8], 2).expect("eight bits");
        bytes.push(byte);
        if byte == 0xff {
            bytes.push(0);
        }
    }
    bytes.extend([0xff, 0xd9]);
    bytes
}

#[test]
fn inks_become_colors() {
    for (stored, wanted) in [
        ([255, 255, 255, 255], [255, 255, 255]),
        ([0, 255, 255, 255], [0, 255, 255]),
        ([255, 0, 255, 255], [255, 0, 255]),
        ([255, 255, 0, 255], [255, 255, 0]),
        ([255, 255, 255, 0], [0, 0, 0]),
    ] {
        let found = RgbImage::decode(&cmyk_jpeg(stored), LIMIT).expect("a JPEG in CMYK is read");
        assert_eq!((found.width(), found.height()), (8, 8));
        // Decoders round differently.
        let is_near = |rgb: &[u8]| rgb.iter().zip(wanted).all(|(&a, b)| a.abs_diff(b) <= 2);
        assert!(found.pixels().chunks_exact(3).all(is_near), "{stored:?}: {:?}", found.get(0, 0));
    }
    let whole = cmyk_jpeg([255; 4]);
    let cut = RgbImage::decode(&whole[..whole.len() / 2], LIMIT);
    assert!(matches!(cut, Err(ImageError::Decode(_))), "{cut:?}");
}

#[test]
fn failures_say_where_and_what_helps() {
    use taut_recognize::hand::{Edge, FingerName, Pixel, Sign};
    let at = Pixel { x: 12, y: 345 };
    let finger = FingerName::Ring;
    for failure in [
        Failure::FingersTouching { first: FingerName::Middle, second: finger, at },
        Failure::CutOff { edge: Edge::Left, at },
        Failure::RingOrBandage { finger, sign: Sign::WidthStep, at },
        Failure::Hole { area_mm2: 5.0, at },
        Failure::SecondObject { area_mm2: 5.0, at },
    ] {
        let text = failure.to_string();
        assert!(text.contains("pixel (12, 345)") && text.contains("; "), "{text}");
    }
    for failure in [
        Failure::NoHand { area_mm2: 3.0 },
        Failure::LowContrast { contrast: 1.0, separation: 2.0 },
        Failure::TooFewTips { found: 3 },
        Failure::Unmeasurable,
        Failure::BrokenBoundary,
        Failure::ThumbUnclear { ratio: 1.0 },
        Failure::OtherHand,
        Failure::Proportions { distance: 9.0, limit: 8.0 },
    ] {
        assert!(failure.to_string().contains("; "), "{failure}");
    }
}

#[test]
fn damaged_and_foreign_files_are_typed() {
    let decode = |bytes: &[u8]| RgbImage::decode(bytes, LIMIT);
    assert_eq!(decode(b""), Err(ImageError::UnknownFormat));
    assert_eq!(decode(b"no image"), Err(ImageError::UnknownFormat));
    for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Tiff] {
        let whole = encode(&DynamicImage::from(sample()), format);
        for length in 0..whole.len() {
            // Some cuts leave all pixels; none panics.
            if let Err(error) = decode(&whole[..length]) {
                assert!(!error.to_string().is_empty());
            }
        }
        assert!(decode(&whole[..whole.len() / 2]).is_err(), "{format:?}");
    }
    let large = DynamicImage::from(image::RgbImage::new(1001, 1000));
    let found = decode(&encode(&large, ImageFormat::Png));
    assert_eq!(found, Err(ImageError::TooLarge { width: 1001, height: 1000, limit: LIMIT }));
    assert_eq!(
        RgbImage::new(vec![0; 5], 1, 2, None),
        Err(ImageError::WrongSize { bytes: 5, width: 1, height: 2 })
    );
    assert_eq!(RgbImage::new(vec![], 0, 2, None), Err(ImageError::Empty));
    let missing = Hand::from_file("no such file.png", &HandOptions::default());
    assert!(matches!(missing, Err(HandError::Image(ImageError::Io { .. }))));
}

#[test]
fn a_header_that_promises_too_much_allocates_nothing() {
    // A PNG of 60 000 × 60 000 pixels in 60 bytes.
    let png = encode(&DynamicImage::from(sample()), ImageFormat::Png);
    let mut header = b"IHDR".to_vec();
    header.extend(60_000u32.to_be_bytes());
    header.extend(60_000u32.to_be_bytes());
    header.extend([8, 2, 0, 0, 0]);
    let mut checksum = flate2::Crc::new();
    checksum.update(&header);
    let mut bytes = png[..12].to_vec();
    bytes.extend(&header);
    bytes.extend(checksum.sum().to_be_bytes());
    bytes.extend(&png[33..]);
    let found = RgbImage::decode(&bytes, 100_000_000);
    assert!(
        matches!(found, Err(ImageError::TooLarge { .. } | ImageError::Decode(_))),
        "{:?}",
        found.map(|image| image.width())
    );
}

#[test]
fn pages_without_a_hand_are_typed() {
    let page = |color: [u8; 3], side: usize| {
        let pixels = color.iter().copied().cycle().take(3 * side * side).collect();
        RgbImage::new(pixels, side, side, Some(90.0)).expect("the sizes agree")
    };
    let options = HandOptions::default();
    for color in [[0, 0, 0], [255, 255, 255], [128, 128, 128], [220, 180, 150]] {
        for side in [1, 2, 63, 64, 65, 300] {
            let found = Hand::from_rgb(&page(color, side), &options);
            assert!(
                matches!(
                    found,
                    Err(HandError::Hand(Failure::NoHand { .. } | Failure::LowContrast { .. }))
                ),
                "{color:?} {side}: {found:?}"
            );
        }
    }
    let nameless = RgbImage::new(vec![0; 12], 2, 2, None).expect("the sizes agree");
    let found = Hand::from_rgb(&nameless, &options);
    assert!(matches!(found, Err(HandError::Image(ImageError::NoResolution))), "{found:?}");
    for dots_per_inch in [0.0, -1.0, f64::NAN, 1e9] {
        let options = HandOptions { dots_per_inch: Some(dots_per_inch), ..Default::default() };
        let found = Hand::from_rgb(&nameless, &options);
        assert!(matches!(found, Err(HandError::Option { name: "dots_per_inch", .. })), "{found:?}");
    }
}

#[test]
fn the_table_of_a_threshold_is_the_formula() {
    // Every red and green with some blues, among them those at the limit.
    for threshold in [FIXED_THRESHOLD, -3.0, 20.0] {
        let table = ThresholdTable::new(threshold);
        for red in (0..=255u8).step_by(5) {
            for green in (0..=255u8).step_by(3) {
                for blue in (0..=255u8).step_by(7) {
                    let rgb = [red, green, blue];
                    assert_eq!(table.is_above(rgb), lab_b(rgb) > threshold, "{rgb:?}");
                }
            }
        }
    }
    // The table of the other function of b*, and the limit of its error.
    for red in (0..=255u8).step_by(3) {
        for green in (0..=255u8).step_by(5) {
            for blue in (0..=255u8).step_by(3) {
                let rgb = [red, green, blue];
                assert!(
                    (approximate_lab_b(rgb) - lab_b(rgb)).abs() <= APPROXIMATION_MAX,
                    "{rgb:?}"
                );
            }
        }
    }
    // Published values of CIELAB under D65: white and gray have none, blue −107.86, yellow 94.48.
    assert!(lab_b([255, 255, 255]).abs() < 0.02);
    assert!((lab_b([0, 0, 255]) + 107.86).abs() < 0.05);
    assert!((lab_b([255, 255, 0]) - 94.48).abs() < 0.05);
}

/// The files that the fuzzer begins with, and what it found.
#[test]
fn files_of_the_fuzzer_give_no_panic() {
    let folder =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/hand_image");
    if !folder.exists() {
        return println!(
            "skipped files_of_the_fuzzer_give_no_panic: this package comes without its seeds"
        );
    }
    let (mut images, mut hands) = (0, 0);
    for entry in std::fs::read_dir(folder).unwrap() {
        let bytes = std::fs::read(entry.unwrap().path()).unwrap();
        images += usize::from(RgbImage::decode(&bytes, LIMIT).is_ok());
        let options =
            HandOptions { dots_per_inch: Some(40.0), gate: Gate::Report, ..HandOptions::default() };
        hands += usize::from(Hand::from_image(&bytes, &options).is_ok());
    }
    assert!(images >= 8 && hands >= 1, "{images} images, {hands} hands");
}
