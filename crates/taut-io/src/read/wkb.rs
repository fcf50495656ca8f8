//! Well-known binary of geometries, as GeoParquet has it in a column: the positions of each row.
//!
//! *Read.* Point, LineString, Polygon and their Multi forms, with or without z and m, in either byte order; the plane coordinates of each.
//! *Trap.* PostGIS and ISO mark z in different ways: by the highest bits of the type, and by thousands.
//! *Reference.* OGC 06-103r4, section 8.2; GeoParquet 1.1.

/// Positions of one chain: a point, a line or a ring.
pub(super) type Chain = Vec<[f64; 2]>;

/// Geometries within each other, at most.
const DEPTH_MAX: usize = 4;

/// The chains of a geometry, and whether it is a single point; or why it is refused.
pub(super) fn chains(bytes: &[u8]) -> Result<(Vec<Chain>, bool), String> {
    let mut reader = Reader { bytes, at: 0 };
    let mut found = vec![];
    let kind = reader.geometry(&mut found, 0)?;
    match reader.at == bytes.len() {
        true => Ok((found, kind == 1)),
        false => Err("more bytes follow its geometry".to_owned()),
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let bytes = self.bytes.get(self.at..).and_then(|rest| rest.first_chunk::<N>());
        let bytes = bytes.ok_or("its geometry is cut short")?;
        self.at += N;
        Ok(*bytes)
    }

    fn word(&mut self, is_little: bool) -> Result<u32, String> {
        let bytes = self.take::<4>()?;
        Ok(if is_little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    fn values(&mut self, is_little: bool, numbers: usize) -> Result<[f64; 2], String> {
        let mut all = [0.0; 4];
        for value in &mut all[..numbers] {
            let bytes = self.take::<8>()?;
            *value = if is_little { f64::from_le_bytes(bytes) } else { f64::from_be_bytes(bytes) };
        }
        Ok([all[0], all[1]])
    }

    fn position(&mut self, is_little: bool, numbers: usize) -> Result<[f64; 2], String> {
        let at = self.values(is_little, numbers)?;
        match at.iter().all(|value| value.is_finite()) {
            true => Ok(at),
            false => Err("a position is not finite".to_owned()),
        }
    }

    /// The position of a point. An empty point, which is all NaN, is a gap where it is not within another geometry.
    fn point(&mut self, is_little: bool, numbers: usize, depth: usize) -> Result<[f64; 2], String> {
        let begin = self.at;
        let at = self.values(is_little, numbers)?;
        if depth == 0 && at.iter().all(|value| value.is_nan()) {
            return Ok(at);
        }
        self.at = begin;
        self.position(is_little, numbers)
    }

    fn chain(&mut self, is_little: bool, numbers: usize) -> Result<Chain, String> {
        let count = self.word(is_little)?;
        (0..count).map(|_| self.position(is_little, numbers)).collect()
    }

    /// Reads a geometry and returns its type.
    fn geometry(&mut self, found: &mut Vec<Chain>, depth: usize) -> Result<u32, String> {
        if depth > DEPTH_MAX {
            return Err("its geometries are nested too deeply".to_owned());
        }
        let is_little = match self.take::<1>()? {
            [0] => false,
            [1] => true,
            [other] => return Err(format!("its byte order is {other}")),
        };
        let code = self.word(is_little)?;
        if code & 0x2000_0000 != 0 {
            self.word(is_little)?;
        }
        let (kind, iso) = (code & 0xffff, (code & 0xffff) / 1000);
        let has_z = code & 0x8000_0000 != 0 || matches!(iso, 1 | 3);
        let has_m = code & 0x4000_0000 != 0 || matches!(iso, 2 | 3);
        let numbers = 2 + usize::from(has_z) + usize::from(has_m);
        let kind = kind % 1000;
        match kind {
            1 => found.push(vec![self.point(is_little, numbers, depth)?]),
            2 => found.push(self.chain(is_little, numbers)?),
            3 => {
                for _ in 0..self.word(is_little)? {
                    found.push(self.chain(is_little, numbers)?);
                }
            }
            4..=6 => {
                for _ in 0..self.word(is_little)? {
                    self.geometry(found, depth + 1)?;
                }
            }
            other => return Err(format!("its geometry is of type {other}, which is not read")),
        }
        Ok(kind)
    }
}
