//! From samples to pixels: colors, and lines where the surface ends or steps back.

use taut_points::parallel::ParallelSlice;

use super::Raster;
use crate::{Theme, Tone};

/// A step in nearness from which on it is a step of the surface and not a slope: a tenth of the radius of the scene.
const NEARNESS_STEP_MIN: f32 = 0.025;

/// The color of a surface for each of 256 shades.
pub(crate) type Ramp = [[u8; 3]; 256];

/// Pixels with red, green, blue and opacity, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Image {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) pixels: Vec<[u8; 4]>,
}

/// The shades of a tone: from a third of its color to a tint of it, halfway to white.
pub(crate) fn ramp(theme: Theme, tone: Tone) -> Ramp {
    let hex = theme.color(tone);
    let channel =
        |k: usize| hex.get(1 + 2 * k..3 + 2 * k).and_then(|two| u8::from_str_radix(two, 16).ok());
    let base = [0, 1, 2].map(|k| f64::from(channel(k).unwrap_or(128)));
    let mut ramp = [[0; 3]; 256];
    for (shade, color) in ramp.iter_mut().enumerate() {
        let t = shade as f64 / 255.0;
        *color = base.map(|c| ((1.0 - t) * 0.33 * c + t * (0.5 * c + 127.5)).round() as u8);
    }
    ramp
}

impl Raster {
    /// The mean of `across` × `across` samples for each pixel, in the colors of their inks.
    pub(crate) fn image(&self, across: usize, inks: &[Ramp]) -> Image {
        let (width, height) = (self.width / across, self.height / across);
        let reach = across.div_ceil(2);
        let pixel = |x: usize, y: usize| {
            let (mut sum, mut count) = ([0_usize; 3], 0);
            for v in y * across..(y + 1) * across {
                for u in x * across..(x + 1) * across {
                    let sample = v * self.width + u;
                    if self.near[sample] == 0.0 {
                        continue;
                    }
                    let color =
                        inks[usize::from(self.ink[sample])][usize::from(self.light[sample])];
                    // Half as bright on a line.
                    let line = usize::from(self.is_cliff(u, v, reach));
                    for k in 0..3 {
                        sum[k] += usize::from(color[k]) >> line;
                    }
                    count += 1;
                }
            }
            let mean = |sum: usize| (sum + count / 2).checked_div(count).unwrap_or(0);
            let all = across * across;
            let [r, g, b] = sum.map(|s| mean(s) as u8);
            [r, g, b, ((255 * count + all / 2) / all) as u8]
        };
        let mut pixels = vec![[0; 4]; width * height];
        pixels.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
            row.iter_mut().enumerate().for_each(|(x, place)| *place = pixel(x, y));
        });
        Image { width, height, pixels }
    }

    /// Tests whether beside a sample, so many samples away, the surface ends or is much farther away.
    fn is_cliff(&self, u: usize, v: usize, reach: usize) -> bool {
        let near = |u: usize, v: usize| self.near[v * self.width + u];
        let edge = near(u, v) - NEARNESS_STEP_MIN;
        (u >= reach && near(u - reach, v) < edge)
            || (u + reach < self.width && near(u + reach, v) < edge)
            || (v >= reach && near(u, v - reach) < edge)
            || (v + reach < self.height && near(u, v + reach) < edge)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Facet, snap};
    use super::*;

    #[test]
    fn shades_rise_and_differ_by_theme() {
        let [light, dark] = [Theme::Light, Theme::Dark].map(|theme| ramp(theme, Tone::Answer));
        assert_eq!([light[0], light[255]], [[0, 38, 59], [128, 185, 217]]);
        assert!(light.windows(2).all(|two| (0..3).all(|k| two[0][k] <= two[1][k])));
        assert_ne!(light, dark);
    }

    #[test]
    fn pixels_are_means_of_samples() {
        let mut raster = Raster::new(8, 8);
        let corners = [[2.0, 2.0], [7.0, 2.0], [2.0, 7.0]].map(snap);
        raster.fill(&[Facet { corners, near: [1.0; 3], light: [1.0; 3], ink: 1, owner: 0 }]);
        let image = raster.image(2, &[[[0; 3]; 256], [[200; 3]; 256]]);
        assert_eq!((image.width, image.height), (4, 4));
        assert_eq!(image.pixels[0], [0; 4]);
        // Three samples of the corner pixel are on a line; ten samples in all are covered.
        assert_eq!(image.pixels[5], [125, 125, 125, 255]);
        let covered: usize = image.pixels.iter().map(|p| (4 * usize::from(p[3]) + 127) / 255).sum();
        assert_eq!(covered, 10);
    }
}
