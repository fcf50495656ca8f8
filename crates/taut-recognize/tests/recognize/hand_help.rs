//! Images turned and mirrored, and rates over synthetic scans.

use std::collections::BTreeMap;
use std::ops::Range;

use taut_recognize::hand::synthetic::{Defect, DefectKind, Generator, Scan};
use taut_recognize::hand::{FEATURES, Hand, HandOptions, RgbImage};

/// Makes an image from a function of columns and rows.
fn build(width: usize, height: usize, pixel: impl Fn(usize, usize) -> [u8; 3]) -> RgbImage {
    let pixels = (0..width * height).flat_map(|k| pixel(k % width, k / width)).collect();
    RgbImage::new(pixels, width, height, Some(90.0)).expect("the sizes agree")
}

fn at(image: &RgbImage, x: usize, y: usize) -> [u8; 3] {
    image.get(x, y).expect("a pixel of the image")
}

/// Turns an image by 90°.
pub(super) fn turned(image: &RgbImage) -> RgbImage {
    let height = image.height();
    build(height, image.width(), |x, y| at(image, y, height - 1 - x))
}

/// Mirrors an image.
pub(super) fn mirrored(image: &RgbImage) -> RgbImage {
    let width = image.width();
    build(width, image.height(), |x, y| at(image, width - 1 - x, y))
}

/// Rotates an image by an angle in degrees onto a page on which it fits, with bilinear interpolation.
pub(super) fn rotated(image: &RgbImage, degrees: f64) -> RgbImage {
    let side = (image.width() as f64).hypot(image.height() as f64) as usize + 4;
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let page = at(image, 30, 30);
    let pixel = |x: i64, y: i64| {
        let place = usize::try_from(x).ok().zip(usize::try_from(y).ok());
        place.and_then(|(x, y)| image.get(x, y)).unwrap_or(page)
    };
    build(side, side, |x, y| {
        let (u, v) = (x as f64 + 0.5 - 0.5 * side as f64, y as f64 + 0.5 - 0.5 * side as f64);
        let s = cosine * u + sine * v + 0.5 * image.width() as f64 - 0.5;
        let t = cosine * v - sine * u + 0.5 * image.height() as f64 - 0.5;
        let (i, j) = (s.floor(), t.floor());
        let (a, b) = (s - i, t - j);
        let corner = |di: i64, dj: i64| pixel(i as i64 + di, j as i64 + dj).map(f64::from);
        let (p, q, r, w) = (corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1));
        std::array::from_fn(|c| {
            let upper = p[c] + a * (q[c] - p[c]);
            let lower = r[c] + a * (w[c] - r[c]);
            (upper + b * (lower - upper)).round() as u8
        })
    })
}

/// Returns the largest relative difference.
pub(super) fn worst_error(found: &[f64; FEATURES], truth: &[f64; FEATURES]) -> f64 {
    found.iter().zip(truth).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
}

/// A feature that is off by more than this is wrong.
const WRONG: f64 = 0.05;

/// What happened to scans of one kind.
#[derive(Default)]
struct Tally {
    scans: u32,
    measured: u32,
    wrong: u32,
    reasons: BTreeMap<String, u32>,
}

/// Rates over scans.
#[derive(Default)]
pub(super) struct Rates {
    tallies: BTreeMap<&'static str, Tally>,
    tips: Vec<f64>,
    valleys: Vec<f64>,
}

impl Rates {
    /// Measures scans without defects, at the extractor's defaults.
    pub(super) fn free(&mut self, seed: u64, people: Range<u64>, scans: u64) {
        let generator = Generator { seed, ..Default::default() };
        for person in people {
            for scan in 0..scans {
                self.add(&generator.scan_with(person, scan, None));
            }
        }
    }

    /// Measures one scan of each defect of each person; half of the people show the left hand.
    pub(super) fn damaged(&mut self, seed: u64, people: Range<u64>) {
        use DefectKind::{Adducted, Bandage, Joined, Lifted, Ring, Shifted};
        use taut_recognize::hand::Side;
        for person in people {
            let side = if person % 2 == 0 { Side::Right } else { Side::Left };
            let generator = Generator { seed, side, ..Default::default() };
            for (scan, kind) in (0..).zip([Ring, Bandage, Joined, Adducted, Lifted, Shifted]) {
                self.add(&generator.scan_with(person, scan, Some(kind)));
            }
        }
    }

    /// Adds what happened to other scans.
    pub(super) fn append(&mut self, other: Rates) {
        for (kind, tally) in other.tallies {
            let sum = self.tallies.entry(kind).or_default();
            sum.scans += tally.scans;
            sum.measured += tally.measured;
            sum.wrong += tally.wrong;
            for (reason, count) in tally.reasons {
                *sum.reasons.entry(reason).or_default() += count;
            }
        }
        self.tips.extend(other.tips);
        self.valleys.extend(other.valleys);
    }

    fn add(&mut self, scan: &Scan) {
        let truth = &scan.truth;
        let kind = match truth.defect {
            _ if truth.is_cut_off => "cut off",
            None | Some(Defect::Shifted) => "free",
            Some(Defect::Adducted { is_touching: false, .. }) => "close fingers",
            Some(Defect::Ring { .. }) => "ring",
            Some(Defect::Bandage { .. }) => "bandage",
            Some(Defect::Joined { .. } | Defect::Adducted { .. }) => "fused",
            Some(Defect::Lifted(_)) => "lifted",
        };
        let tally = self.tallies.entry(kind).or_default();
        tally.scans += 1;
        match Hand::from_rgb(&scan.image, &HandOptions::default()) {
            Ok(hand) => {
                tally.measured += 1;
                if let Some(features) = &truth.features {
                    tally.wrong += u32::from(worst_error(&hand.features, features) > WRONG);
                }
                assert_eq!(hand.side, truth.side);
                if kind == "free" {
                    let gap = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
                    let (tips, valleys) =
                        (hand.landmarks.tip_points(), hand.landmarks.valley_points());
                    self.tips.extend((0..5).map(|k| gap(tips[k], truth.tips[k])));
                    self.valleys.extend((0..4).map(|k| gap(valleys[k], truth.valleys[k])));
                }
            }
            Err(error) => {
                let name = format!("{error:?}");
                let name = name.trim_start_matches("Hand(").split([' ', '(', ')']).next();
                *tally.reasons.entry(name.unwrap_or_default().to_owned()).or_default() += 1;
            }
        }
    }

    fn rms(values: &[f64]) -> f64 {
        (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
    }

    /// Prints a line for each kind.
    pub(super) fn print(&self) {
        for (kind, tally) in &self.tallies {
            println!(
                "{kind}: {} scans, {} measured ({:.2} %), {} of them wrong; refused: {:?}",
                tally.scans,
                tally.measured,
                100.0 * f64::from(tally.measured) / f64::from(tally.scans),
                tally.wrong,
                tally.reasons
            );
        }
        let (tips, valleys) = (Self::rms(&self.tips), Self::rms(&self.valleys));
        println!("root mean square of tips {tips:.2} pixels, of valleys {valleys:.2} pixels");
    }

    /// Asserts what is reached: every hand that is cut off is refused, no cover, fused or lifted finger is silently wrong,
    /// and at most one free hand in 200 is refused.
    pub(super) fn assert_goals(&self) {
        for (kind, tally) in &self.tallies {
            // The truth of two fingers that nearly touch has its valley where the slit between them is closed by a pixel;
            // the ends of thumbs and little fingers hang on valleys that are nearly flat.
            let limit = match *kind {
                "close fingers" => 1 + tally.scans / 250,
                "free" => 1 + tally.scans / 400,
                _ => 0,
            };
            assert!(tally.wrong <= limit, "{kind}: {} wrong without a failure", tally.wrong);
        }
        let free = &self.tallies["free"];
        if let Some(cut) = self.tallies.get("cut off") {
            assert_eq!(cut.measured, 0, "hands that are cut off without a failure");
        }
        // The short run has too few scans for a rate.
        let refused = free.scans - free.measured;
        let allowed = (0.005 * f64::from(free.scans)).max(1.0);
        assert!(f64::from(refused) <= allowed, "{refused} free hands refused");
        let (tips, valleys) = (Self::rms(&self.tips), Self::rms(&self.valleys));
        assert!(tips <= 0.7 && valleys <= 0.7, "tips {tips}, valleys {valleys}");
    }
}
