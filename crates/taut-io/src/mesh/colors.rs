//! Colors as files write them: up to 255, or up to 1.
//!
//! *Idea.* Few formats say which of the two they mean, so the whole file tells: a value above 1 means that 255 is full, and
//! so do colors without any fraction. Where the format always means fractions, its reader says so of every color.

/// Colors as far as they were read.
#[derive(Default)]
pub(super) struct Colors {
    values: Vec<[f32; 3]>,
    fraction: bool,
    above_one: bool,
}

impl Colors {
    /// Adds a color; `fraction` says that it is written as fractions of 1. A value that is none is given back.
    pub(super) fn push(&mut self, color: [f64; 3], fraction: bool) -> Result<(), f64> {
        if let Some(&value) = color.iter().find(|value| !(0.0..=255.0).contains(*value)) {
            return Err(value);
        }
        self.fraction |= fraction;
        self.above_one |= color.iter().any(|&value| value > 1.0);
        self.values.push(color.map(|value| value as f32));
        Ok(())
    }

    pub(super) fn len(&self) -> usize {
        self.values.len()
    }

    /// The colors, full at 255.
    pub(super) fn finish(self) -> Vec<[u8; 3]> {
        let scale = if self.above_one || !self.fraction { 1.0 } else { 255.0 };
        let byte = |value: f32| (value * scale).round() as u8;
        self.values.into_iter().map(|color| color.map(byte)).collect()
    }
}

/// A byte as a fraction of 255.
pub(super) fn fraction(byte: u8) -> f64 {
    f64::from(byte) / 255.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(colors: &[[f64; 3]], fraction: bool) -> Vec<[u8; 3]> {
        let mut found = Colors::default();
        colors.iter().for_each(|&color| found.push(color, fraction).unwrap());
        found.finish()
    }

    #[test]
    fn the_file_tells_how_much_is_full() {
        assert_eq!(read(&[[0.0, 1.0, 255.0]], false), [[0, 1, 255]]);
        assert_eq!(read(&[[0.0, 1.0, 0.0]], false), [[0, 1, 0]]);
        assert_eq!(read(&[[0.0, 1.0, 0.0]], true), [[0, 255, 0]]);
        assert_eq!(read(&[[0.0, 1.0, 0.5]], true), [[0, 255, 128]]);
        assert_eq!(read(&[[0.5, 1.0, 254.7]], true), [[1, 1, 255]]);
    }

    #[test]
    fn every_byte_comes_back_from_its_fraction() {
        let colors: Vec<[f64; 3]> = (0..=255).map(|byte| [fraction(byte); 3]).collect();
        let bytes: Vec<[u8; 3]> = (0..=255).map(|byte| [byte; 3]).collect();
        assert_eq!(read(&colors, true), bytes);
    }

    #[test]
    fn values_that_are_no_color_are_given_back() {
        for bad in [-1.0, 255.5, f64::NAN, f64::INFINITY] {
            let refused = Colors::default().push([0.0, bad, 1.0], true).unwrap_err();
            assert_eq!(refused.to_bits(), bad.to_bits());
        }
    }
}
