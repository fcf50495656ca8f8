//! The front of a node: what it passes to the node above.
//!
//! *Content.* The sites whose stars are not finished, and the *frozen facets*: those between a finished simplex and one
//! that is not. Each facet is turned as the unfinished side sees it, and names the finished simplex behind it by its tile
//! and number, so that whoever finishes the other side knows both neighbors.
//! *Guarantee.* Canonical: the bytes are a function of the set of points under the node and of the tree of cells, whatever
//! the order of the rows and the number of threads.
//! *Bytes.* Little-endian: magic `TAUTFRNT`, version u32, D u32, sites u64, facets u64; for each site D × f64 and its row
//! as u64; for each facet D × u32 (places among the sites, 0xFFFF_FFFF for infinity), tile u32, and
//! simplex << 2 | facet as u32, 0xFFFF_FFFF where the finished side is outside the hull; at last the sum of the words.

use crate::Error;
use crate::outofcore::bytes::{Reader, word_sum};
use crate::simplex::GHOST;

const MAGIC: &[u8; 8] = b"TAUTFRNT";
const VERSION: u32 = 1;
/// Magic, version, D, and the two counts.
const HEADER: usize = 32;

/// A finished simplex at a frozen facet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// The tile with the simplex.
    pub tile: u32,
    /// Its number in the tile and the place of the facet, simplex << 2 | facet; [`Link::OUTSIDE`] if there is none.
    pub code: u32,
}

impl Link {
    /// In [`Link::code`]: the facet lies on the hull.
    pub const OUTSIDE: u32 = u32::MAX;

    /// The link to the outside of the hull.
    pub(crate) const HULL: Self = Self { tile: 0, code: Self::OUTSIDE };

    /// Tests whether the facet lies on the hull.
    pub fn is_outside(self) -> bool {
        self.code == Self::OUTSIDE
    }
}

/// A facet between a finished simplex and one that is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FrozenFacet<const D: usize> {
    /// Places among the sites of the front, [`GHOST`] for infinity; in positive order as the unfinished side sees it, in
    /// space from the smallest on.
    pub(crate) vertices: [u32; D],
    /// The finished side.
    pub(crate) link: Link,
}

/// Unfinished sites and frozen facets.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Front<const D: usize> {
    /// The coordinates of the sites as they were given, −0 as 0; all different.
    pub(crate) coordinates: Vec<[f64; D]>,
    /// The smallest row of each site.
    pub(crate) rows: Vec<u64>,
    /// The frozen facets.
    pub(crate) facets: Vec<FrozenFacet<D>>,
}

impl<const D: usize> Front<D> {
    /// A front without sites.
    pub fn empty() -> Self {
        Self { coordinates: vec![], rows: vec![], facets: vec![] }
    }

    /// The number of sites.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// The smallest row of each site.
    pub fn rows(&self) -> &[u64] {
        &self.rows
    }

    /// Returns true if there is no site.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Adds the sites and facets of another front, which has none of these sites.
    pub fn append(&mut self, other: Self) {
        let offset = self.rows.len() as u32;
        let moved = |v: u32| if v == GHOST { GHOST } else { v + offset };
        self.coordinates.extend(other.coordinates);
        self.rows.extend(other.rows);
        self.facets.extend(
            other.facets.into_iter().map(|f| FrozenFacet { vertices: f.vertices.map(moved), ..f }),
        );
    }

    /// Bytes of memory of a front with so many sites and facets.
    pub fn bytes(&self) -> usize {
        self.len() * (8 * D + 8) + self.facets.len() * (4 * D + 8)
    }

    /// The front as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(HEADER + self.bytes() + 8);
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&(D as u32).to_le_bytes());
        bytes.extend_from_slice(&(self.len() as u64).to_le_bytes());
        bytes.extend_from_slice(&(self.facets.len() as u64).to_le_bytes());
        for (p, row) in self.coordinates.iter().zip(&self.rows) {
            p.iter().for_each(|x| bytes.extend_from_slice(&x.to_le_bytes()));
            bytes.extend_from_slice(&row.to_le_bytes());
        }
        for facet in &self.facets {
            facet.vertices.iter().for_each(|v| bytes.extend_from_slice(&v.to_le_bytes()));
            bytes.extend_from_slice(&facet.link.tile.to_le_bytes());
            bytes.extend_from_slice(&facet.link.code.to_le_bytes());
        }
        let sum = word_sum(&bytes);
        bytes.extend_from_slice(&sum.to_le_bytes());
        bytes
    }

    /// The front that [`to_bytes`](Self::to_bytes) wrote.
    ///
    /// # Errors
    /// [`Error::DamagedFront`] if these are other bytes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let damaged = |what| Error::DamagedFront { what };
        let body = bytes.len().checked_sub(8).ok_or(damaged("it ends too early"))?;
        let mut reader = Reader::new(&bytes[body..]);
        if reader.u64() != Some(word_sum(&bytes[..body])) {
            return Err(damaged("its sum is wrong"));
        }
        let mut reader = Reader::new(&bytes[..body]);
        if reader.take(8) != Some(MAGIC) || reader.u32() != Some(VERSION) {
            return Err(damaged("it does not begin like a front"));
        }
        if reader.u32() != Some(D as u32) {
            return Err(damaged("its points have another dimension"));
        }
        let (sites, facets) = reader.u64().zip(reader.u64()).ok_or(damaged("it ends too early"))?;
        let expected = u128::from(sites) * (8 * D as u128 + 8)
            + u128::from(facets) * (4 * D as u128 + 8)
            + HEADER as u128;
        if expected != body as u128 || sites > u64::from(u32::MAX >> 2) {
            return Err(damaged("its length is wrong"));
        }
        let mut front = Self::empty();
        for _ in 0..sites {
            let p = reader.points::<D>().ok_or(damaged("it ends too early"))?;
            let row = reader.u64().ok_or(damaged("it ends too early"))?;
            if p.iter().any(|x| !x.is_finite()) {
                return Err(damaged("a coordinate is not finite"));
            }
            front.coordinates.push(p);
            front.rows.push(row);
        }
        for _ in 0..facets {
            let mut vertices = [0; D];
            for v in &mut vertices {
                *v = reader.u32().ok_or(damaged("it ends too early"))?;
                if *v != GHOST && u64::from(*v) >= sites {
                    return Err(damaged("a facet names a site that is not there"));
                }
            }
            if (1..D).any(|i| vertices[..i].contains(&vertices[i])) {
                return Err(damaged("a facet has a vertex twice"));
            }
            let (tile, code) =
                reader.u32().zip(reader.u32()).ok_or(damaged("it ends too early"))?;
            front.facets.push(FrozenFacet { vertices, link: Link { tile, code } });
        }
        Ok(front)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn front() -> Front<2> {
        let link = Link { tile: 7, code: 6 };
        Front {
            coordinates: vec![[0.5, -1.0], [2.0, 3.0]],
            rows: vec![1 << 40, 3],
            facets: vec![
                FrozenFacet { vertices: [0, 1], link },
                FrozenFacet { vertices: [1, GHOST], link: Link::HULL },
            ],
        }
    }

    #[test]
    fn bytes_come_back_and_no_other_bytes_do() {
        let bytes = front().to_bytes();
        assert_eq!(Front::from_bytes(&bytes).unwrap(), front());
        assert!(Front::<3>::from_bytes(&bytes).is_err());
        for end in 0..bytes.len() {
            assert!(Front::<2>::from_bytes(&bytes[..end]).is_err(), "{end} bytes");
        }
        for at in 0..bytes.len() {
            let mut other = bytes.clone();
            other[at] ^= 1;
            assert!(Front::<2>::from_bytes(&other).is_err(), "byte {at}");
        }
    }

    #[test]
    fn appended_facets_follow_their_sites() {
        let mut both = front();
        both.append(front());
        assert_eq!(both.len(), 4);
        assert_eq!(both.facets[2].vertices, [2, 3]);
        assert_eq!(both.facets[3].vertices, [3, GHOST]);
    }
}
