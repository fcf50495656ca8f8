//! The tags of TIFF files, and of EXIF data, which have the same form.

const ORIENTATION: u16 = 0x0112;
const HORIZONTAL_RESOLUTION: u16 = 0x011a;
const VERTICAL_RESOLUTION: u16 = 0x011b;
const RESOLUTION_UNIT: u16 = 0x0128;
/// Bytes of an entry of a directory.
const ENTRY_BYTES: usize = 12;

/// The first directory of tags.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tags<'a> {
    bytes: &'a [u8],
    is_little: bool,
    directory: usize,
}

impl<'a> Tags<'a> {
    /// Finds the directory; `None` if the bytes do not begin as a TIFF does.
    pub(super) fn of(bytes: &'a [u8]) -> Option<Self> {
        let is_little = match bytes.get(..4)? {
            [b'I', b'I', 42, 0] => true,
            [b'M', b'M', 0, 42] => false,
            _ => return None,
        };
        let mut tags = Tags { bytes, is_little, directory: 0 };
        tags.directory = tags.long(4)? as usize;
        Some(tags)
    }

    /// How the image is to be turned, from 1 to 8: 1 is upright. The first entry with one number of 16 bits counts.
    pub(super) fn orientation(self) -> Option<u8> {
        let is_short = |&at: &usize| self.short(at + 2) == Some(3) && self.long(at + 4) == Some(1);
        let entry = self.entries(ORIENTATION).find(is_short)?;
        u8::try_from(self.short(entry + 8)?).ok().filter(|value| (1..=8).contains(value))
    }

    /// Dots per inch along rows and columns.
    pub(super) fn resolution(self) -> Option<[f64; 2]> {
        let last = |tag| self.entries(tag).next_back();
        let unit = last(RESOLUTION_UNIT).map_or(Some(2), |entry| self.short(entry + 8))?;
        let scale = match unit {
            2 => 1.0,
            3 => 2.54,
            _ => return None,
        };
        let ratio = |tag| self.ratio(self.long(last(tag)? + 8)? as usize);
        Some([ratio(HORIZONTAL_RESOLUTION)? * scale, ratio(VERTICAL_RESOLUTION)? * scale])
    }

    /// Where the entries of a tag begin.
    fn entries(self, tag: u16) -> impl DoubleEndedIterator<Item = usize> {
        let count = self.short(self.directory).map_or(0, usize::from);
        let start = move |entry: usize| self.directory.checked_add(2 + ENTRY_BYTES * entry);
        (0..count).filter_map(start).filter(move |&at| self.short(at) == Some(tag))
    }

    fn part<const N: usize>(self, at: usize) -> Option<[u8; N]> {
        self.bytes.get(at..at.checked_add(N)?)?.try_into().ok()
    }

    fn short(self, at: usize) -> Option<u16> {
        let bytes = self.part(at)?;
        Some(if self.is_little { u16::from_le_bytes(bytes) } else { u16::from_be_bytes(bytes) })
    }

    fn long(self, at: usize) -> Option<u32> {
        let bytes = self.part(at)?;
        Some(if self.is_little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    fn ratio(self, at: usize) -> Option<f64> {
        let (numerator, denominator) = (self.long(at)?, self.long(at.checked_add(4)?)?);
        (denominator > 0).then(|| f64::from(numerator) / f64::from(denominator))
    }
}
