//! From the field of distances to an image: colors, shading, covers, noise.

use super::Defect;
use super::person::Person;
use super::pose::{KNUCKLE_MM, Page};
use super::random::{Stream, hash};
use super::shape::{Strip, distance_to_polygon};
use super::truth::Outlined;
use crate::hand::color::{WHITE_XZ, XYZ_OF_RGB, linear_levels};
use crate::hand::read::RgbImage;

/// Half the width of the blur of an edge in pixels: a parabola of the variance of the optics (0.7 pixels) and a pixel.
const BLUR_PIXELS: f64 = 1.7;

/// The depth of the shading at the edge of a hand in mm.
const SHADE_MM: f64 = 2.0;

/// The standard deviation of the noise of a level.
const NOISE_LEVELS: f64 = 1.5;

/// A thing that covers a part of the page.
enum Overlay {
    /// A band across a finger: range along it, and what it adds to half the width, in mm.
    Band(Strip, [f64; 2], f64),
    /// A polygon in the frame of the hand.
    Patch(Vec<[f64; 2]>),
}

impl Overlay {
    fn distance(&self, p: [f64; 2]) -> f64 {
        match self {
            Self::Band(strip, range, thickness) => {
                let [t, v] = strip.local(p);
                let [offset, _] = strip.axis(t);
                let across = (v - offset).abs() - strip.half_width(t) - thickness;
                let along = (range[0] - t).max(t - range[1]);
                across.max(along)
            }
            Self::Patch(corners) => distance_to_polygon(corners, p),
        }
    }
}

/// Paints a scan. `random` goes on with the defect, `noise` is for colors and noise.
pub(super) fn paint(
    hand: &Outlined,
    person: &Person,
    page: &Page,
    defect: Option<Defect>,
    has_sleeve: bool,
    mut random: Stream,
    mut noise: Stream,
) -> RgbImage {
    let (width, height) = (page.width, page.height);
    let background_lab = [96.0, 0.0, -3.0 + 0.5 * noise.normal()];
    let background = srgb(background_lab);
    let cooler = srgb([96.0, 0.0, background_lab[2] - 1.0]);
    let cold: [f64; 3] = std::array::from_fn(|c| cooler[c] - background[c]);
    let [light, a, b] = person.skin;
    let skin = srgb(person.skin);
    let edge = srgb([0.75 * light, 0.8 * a, (0.6 * b).max(6.5)]);
    let covers = covers(hand, person, defect, has_sleeve, skin, page.pixels_per_mm, &mut random);
    let lifted = match defect {
        Some(Defect::Lifted(finger)) => Some(finger as usize),
        _ => None,
    };
    let shadow = (noise.below(4), 0.25);
    let key = noise.bits();
    let mut pixels = vec![0u8; 3 * width * height];
    let coverage = |pixels: f64| {
        let x = (0.5 - 0.5 * pixels / BLUR_PIXELS).clamp(0.0, 1.0);
        x * x * (3.0 - 2.0 * x)
    };
    for y in 0..height {
        for x in 0..width {
            let distance = normalized(hand, x, y, page);
            let chill = background_noise(key, x, y);
            let shade = shadow_at(shadow, x, y, page);
            let mut color: [f64; 3] =
                std::array::from_fn(|c| (background[c] + chill * cold[c]) * shade);
            let p = if covers.is_empty() && lifted.is_none() {
                [0.0; 2]
            } else {
                hand.pose.to_hand(page, [x as f64 + 0.5, y as f64 + 0.5])
            };
            let mut share = coverage(distance);
            if let Some(finger) = lifted.filter(|_| share > 0.0) {
                share *= contact(hand, finger, p);
            }
            if share > 0.0 {
                let depth = (-distance / (SHADE_MM * page.pixels_per_mm)).clamp(0.0, 1.0);
                for c in 0..3 {
                    let own = edge[c] + depth * (skin[c] - edge[c]);
                    color[c] += share * (own - color[c]);
                }
            }
            for (cover, paint) in &covers {
                let share = coverage(cover.distance(p) * page.pixels_per_mm);
                for c in 0..3 {
                    color[c] += share * (paint[c] - color[c]);
                }
            }
            let bits = hash(key ^ ((y as u64) << 32 | x as u64));
            for c in 0..3 {
                // Of 21 random bits, the number of ones is nearly normal with variance 21/4.
                let ones = (bits >> (21 * c) & 0x1f_ffff).count_ones();
                let level = color[c] + (f64::from(ones) - 10.5) * (NOISE_LEVELS / 2.291_287_847);
                pixels[3 * (y * width + x) + c] = (level + 0.5).clamp(0.0, 255.0) as u8;
            }
        }
    }
    sprinkle(&mut pixels, page, &mut noise);
    RgbImage::from_parts(pixels, width, height, page.dots_per_inch)
}

/// Returns the distance of a pixel from the outline in pixels: near it the field over its slope, as the field is flat
/// between the sides of a narrow valley.
fn normalized(hand: &Outlined, x: usize, y: usize, page: &Page) -> f64 {
    const SLOPE_MIN: f64 = 0.25;
    let field = |x: usize, y: usize| f64::from(hand.field[y * page.width + x]);
    let own = field(x, y);
    let is_inner = x > 0 && y > 0 && x + 1 < page.width && y + 1 < page.height;
    if own.abs() > 2.0 * BLUR_PIXELS || !is_inner {
        return own;
    }
    let slope = [field(x + 1, y) - field(x - 1, y), field(x, y + 1) - field(x, y - 1)];
    let slope = 0.5 * (slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
    own / slope.max(SLOPE_MIN)
}

/// Returns how much of a lifted finger is on the glass: all up to 60 % of its length, nothing from 74 % on.
fn contact(hand: &Outlined, finger: usize, p: [f64; 2]) -> f64 {
    let strip = &hand.strips[finger];
    let (base, length) = visible(strip, finger);
    let [t, v] = strip.local(p);
    let [offset, _] = strip.axis(t);
    let share = (t - base) / length;
    if share <= 0.0 || share > 1.3 || (v - offset).abs() > 1.2 * strip.half_width(t) {
        return 1.0;
    }
    ((0.74 - share) / 0.14).clamp(0.0, 1.0)
}

/// Returns the base and the length of the visible part of a finger along its strip.
fn visible(strip: &Strip, finger: usize) -> (f64, f64) {
    let base = if finger == 0 { 0.0 } else { KNUCKLE_MM };
    (base, strip.range[1] + strip.half_width(strip.range[1]) - base)
}

/// Returns what covers the hand, each with its color.
fn covers(
    hand: &Outlined,
    person: &Person,
    defect: Option<Defect>,
    has_sleeve: bool,
    skin: [f64; 3],
    pixels_per_mm: f64,
    random: &mut Stream,
) -> Vec<(Overlay, [f64; 3])> {
    let mut covers = vec![];
    match defect {
        Some(Defect::Ring { finger, pixels, b }) => {
            let strip = hand.strips[finger as usize].clone();
            let (base, length) = visible(&strip, finger as usize);
            let start = base + random.between(0.14, 0.34) * length;
            let millimeters = pixels / pixels_per_mm;
            let light = if b == 0.5 { 30.0 } else { 75.0 };
            let thickness = random.between(0.1, 0.7);
            let band = Overlay::Band(strip, [start, start + millimeters], thickness);
            covers.push((band, srgb([light, if b > 1.0 { 5.0 } else { 0.0 }, b])));
        }
        Some(Defect::Bandage { finger, thickness, b }) => {
            let strip = hand.strips[finger as usize].clone();
            let (base, length) = visible(&strip, finger as usize);
            let start = base + random.between(0.2, 0.55) * length;
            let end = start + random.between(12.0, 25.0);
            let light = if b == 18.0 { 65.0 } else { 85.0 };
            let a = if b == 18.0 { 9.0 } else { 1.0 };
            covers.push((Overlay::Band(strip, [start, end], thickness), srgb([light, a, b])));
        }
        Some(Defect::Joined { first, range }) => {
            let k = first as usize;
            let corner = |k: usize, share: f64| {
                let strip = &hand.strips[k];
                let (base, length) = visible(strip, k);
                let t = (base + share * length).min(strip.range[1]);
                strip.point(t, strip.axis(t)[0])
            };
            let patch = vec![
                corner(k, range[0]),
                corner(k, range[1]),
                corner(k + 1, range[1]),
                corner(k + 1, range[0]),
            ];
            covers.push((Overlay::Patch(patch), skin));
        }
        _ => {}
    }
    if has_sleeve {
        let (top, half) = (-random.between(0.0, 20.0), 0.7 * person.body[3] / 2.9);
        let corners = vec![[-half, top], [half, top], [half, top - 300.0], [-half, top - 300.0]];
        let b = if random.share() < 0.5 {
            random.between(-14.0, -4.0)
        } else {
            random.between(8.0, 20.0)
        };
        covers.push((Overlay::Patch(corners), srgb([random.between(20.0, 70.0), 0.0, b])));
    }
    covers
}

/// Returns the noise of the background in b*: smooth, and constant in blocks of 8 pixels as of a compressed image.
fn background_noise(key: u64, x: usize, y: usize) -> f64 {
    let lattice = |x: usize, y: usize, kind: u64| {
        let bits = hash(key.wrapping_add(kind) ^ ((y as u64) << 20 | x as u64));
        (bits >> 40) as f64 / (1u64 << 23) as f64 - 1.0
    };
    let (u, v) = ((x % 16) as f64 / 16.0, (y % 16) as f64 / 16.0);
    let (i, j) = (x / 16, y / 16);
    let smooth = (1.0 - v) * ((1.0 - u) * lattice(i, j, 1) + u * lattice(i + 1, j, 1))
        + v * ((1.0 - u) * lattice(i, j + 1, 1) + u * lattice(i + 1, j + 1, 1));
    3.0 * smooth + 1.2 * lattice(x / 8, y / 8, 2)
}

/// Returns how much light the lid's shadow leaves at one edge of the page.
fn shadow_at((edge, depth): (usize, f64), x: usize, y: usize, page: &Page) -> f64 {
    const SHADOW_MM: f64 = 6.0;
    let gap = [x, page.width - 1 - x, y, page.height - 1 - y][edge] as f64 / page.pixels_per_mm;
    1.0 - depth * (1.0 - gap / SHADOW_MM).max(0.0)
}

/// Scatters dust: discs of any color of up to 0.8 mm across, some 6 pixels.
fn sprinkle(pixels: &mut [u8], page: &Page, noise: &mut Stream) {
    for _ in 0..noise.below(13) {
        let center = [noise.share() * page.width as f64, noise.share() * page.height as f64];
        let radius = noise.between(0.15, 0.4) * page.pixels_per_mm;
        let color = srgb([
            noise.between(20.0, 80.0),
            noise.between(-5.0, 10.0),
            noise.between(-10.0, 20.0),
        ]);
        let range = |c: usize, size: usize| {
            let low = (center[c] - radius).max(0.0) as usize;
            low..((center[c] + radius) as usize + 1).min(size)
        };
        for y in range(1, page.height) {
            for x in range(0, page.width) {
                let (u, v) = (x as f64 + 0.5 - center[0], y as f64 + 0.5 - center[1]);
                if u * u + v * v <= radius * radius {
                    for c in 0..3 {
                        pixels[3 * (y * page.width + x) + c] = (color[c] + 0.5) as u8;
                    }
                }
            }
        }
    }
}

/// Returns the levels of sRGB, from 0 to 255 and not rounded, of a color of CIELAB; colors beyond sRGB are clipped.
fn srgb(lab: [f64; 3]) -> [f64; 3] {
    let inverse = |v: f64| {
        if v > 6.0 / 29.0 { v * v * v } else { (v - 4.0 / 29.0) * (108.0 / 841.0) }
    };
    let y = (lab[0] + 16.0) / 116.0;
    let target = [
        WHITE_XZ[0] * inverse(y + lab[1] / 500.0),
        inverse(y),
        WHITE_XZ[1] * inverse(y - lab[2] / 200.0),
    ];
    solve(&XYZ_OF_RGB, target).map(|intensity| {
        let levels = linear_levels();
        let above = levels.iter().position(|&level| level > intensity).unwrap_or(255).max(1);
        let (low, high) = (levels[above - 1], levels[above]);
        (above as f64 - 1.0 + (intensity - low) / (high - low)).clamp(0.0, 255.0)
    })
}

/// Solves a system of three linear equations by Cramer's rule.
fn solve(matrix: &[[f64; 3]; 3], target: [f64; 3]) -> [f64; 3] {
    let determinant = |m: &[[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = determinant(matrix);
    std::array::from_fn(|column| {
        let mut replaced = *matrix;
        for row in 0..3 {
            replaced[row][column] = target[row];
        }
        determinant(&replaced) / whole
    })
}
