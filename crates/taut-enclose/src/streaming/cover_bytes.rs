//! A cover of a stream as bytes, for a stream whose next points come by elsewhere.

use taut_points::{ByteReader, ByteWriter, PartsError};

use super::instance::Instance;
use super::{StreamingCenters, StreamingOptions};
use crate::separated_set::SeparatedSet;

/// The word that bytes of a cover begin with.
const COVER: &str = "cover";

/// Rows beyond which nothing is counted, so that more can be added without overflow.
const ROWS_MAX: u64 = u64::MAX / 2;

impl StreamingCenters {
    /// The cover as bytes: as many as its points take, whatever came by.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = ByteWriter::new(COVER);
        for count in [self.dim, self.k, self.options.instances] {
            bytes.count(count);
        }
        bytes.whole(self.seen);
        bytes.floats(&self.first);
        bytes.wholes(&self.first_rows);
        bytes.wholes(&self.separated.rows);
        bytes.float(self.separated.distance);
        bytes.count(self.instances.len());
        self.instances.iter().for_each(|instance| instance.write(&mut bytes));
        bytes.into_bytes()
    }

    /// Reads what [`to_bytes`](Self::to_bytes) wrote; what is added then gives the bits that it gives to the cover itself.
    ///
    /// # Errors
    /// [`PartsError::Bytes`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PartsError> {
        let mut bytes = ByteReader::new(COVER, bytes)?;
        let [dim, k, instances] = [bytes.size()?, bytes.size()?, bytes.size()?];
        let options = StreamingOptions { instances };
        let mut cover = StreamingCenters::new(dim, k, &options).map_err(|_| bytes.wrong())?;
        cover.seen = bytes.whole()?;
        (cover.first, cover.first_rows) = (bytes.floats()?, bytes.wholes()?);
        let (rows, distance) = (bytes.wholes()?, bytes.float()?);
        cover.separated = SeparatedSet { rows, distance };
        for _ in 0..bytes.count(8)? {
            cover.instances.push(Instance::read(&mut bytes, k, dim)?);
        }
        let is_whole = match cover.instances.len() {
            0 => cover.first_rows.len() <= k,
            count => count == instances && cover.first_rows.is_empty(),
        };
        let fits = cover.first_rows.len().checked_mul(dim) == Some(cover.first.len())
            && cover.seen <= ROWS_MAX;
        if is_whole && fits { bytes.end(cover) } else { Err(bytes.wrong()) }
    }
}

#[cfg(test)]
mod tests {
    use taut_points::{Distribution, Points, generate};

    use super::*;

    /// A cover that travels after every few points, and one that stays.
    #[test]
    fn a_cover_that_travels_is_the_same() {
        let dim = 3;
        let values: Vec<f64> = generate(Distribution::Poisson, 400, dim, 3).unwrap();
        let mut stays = StreamingCenters::new(dim, 5, &StreamingOptions { instances: 3 }).unwrap();
        let mut travels = stays.clone();
        for step in values.chunks(7 * dim) {
            let points = Points::new(step, dim).unwrap();
            stays.add(&points).unwrap();
            travels.add(&points).unwrap();
            travels = StreamingCenters::from_bytes(&travels.to_bytes()).unwrap();
            assert_eq!(travels, stays);
        }
        assert!(!stays.instances.is_empty());
        let bytes = stays.to_bytes();
        for end in 0..bytes.len() {
            assert!(StreamingCenters::from_bytes(&bytes[..end]).is_err(), "{end}");
        }
    }

    /// Whatever bits are changed, there is an error or a cover to which points can be added.
    #[test]
    fn damaged_bytes_do_no_harm() {
        let values: Vec<f64> = generate(Distribution::Normal, 50, 2, 3).unwrap();
        let points = Points::new(&values, 2).unwrap();
        let mut cover = StreamingCenters::new(2, 3, &StreamingOptions { instances: 2 }).unwrap();
        cover.add(&points).unwrap();
        let bytes = cover.to_bytes();
        for at in 0..bytes.len() {
            for bit in 0..8 {
                let mut damaged = bytes.clone();
                damaged[at] ^= 1 << bit;
                if let Ok(mut read) = StreamingCenters::from_bytes(&damaged) {
                    let _ = read.add(&points);
                    read.covered();
                }
            }
        }
    }
}
