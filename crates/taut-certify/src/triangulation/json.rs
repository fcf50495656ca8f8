//! Triangulations in JSON: flat lists of ids in memory, rows in the document.

use std::fmt;

use serde::de::{Error as _, SeqAccess, Visitor};
use serde::ser::SerializeStruct;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use taut_points::PointsHash;

use super::{
    Fingerprint, NO_NEIGHBOR, Triangulation, TriangulationCertificate, TriangulationCounts,
};
use crate::json::{hash_from_hex, hash_to_hex};

/// The fields as they are written.
#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a triangulation: an object with dimension, hull_dimension, simplices, hull and duplicates"
)]
pub(super) struct TriangulationDocument {
    dimension: u8,
    // A field that may be null is still a field.
    #[serde(deserialize_with = "Option::deserialize")]
    hull_dimension: Option<u8>,
    simplices: Table,
    hull: Table,
    duplicates: Vec<[u32; 2]>,
}

impl TryFrom<TriangulationDocument> for Triangulation {
    type Error = String;

    fn try_from(read: TriangulationDocument) -> Result<Self, String> {
        let width = read.hull_dimension.map_or(0, usize::from);
        Ok(Triangulation {
            dimension: read.dimension,
            hull_dimension: read.hull_dimension,
            simplices: read.simplices.of_width("simplices", width + 1)?,
            hull: read.hull.of_width("hull", width)?,
            duplicates: read.duplicates,
        })
    }
}

impl Serialize for Triangulation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let width = self.hull_dimension.map_or(0, usize::from);
        let mut document = serializer.serialize_struct("Triangulation", 5)?;
        document.serialize_field("dimension", &self.dimension)?;
        document.serialize_field("hull_dimension", &self.hull_dimension)?;
        document.serialize_field("simplices", &RowsOf(&self.simplices, width + 1))?;
        document.serialize_field("hull", &RowsOf(&self.hull, width))?;
        document.serialize_field("duplicates", &self.duplicates)?;
        document.end()
    }
}

/// The fields as they are written.
#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of a triangulation: an object with fingerprint, points_hash and counts"
)]
pub(super) struct CertificateDocument {
    #[serde(default)]
    neighbors: Table,
    fingerprint: Fingerprint,
    #[serde(deserialize_with = "hash_from_hex")]
    points_hash: PointsHash,
    counts: TriangulationCounts,
}

impl TryFrom<CertificateDocument> for TriangulationCertificate {
    type Error = String;

    fn try_from(read: CertificateDocument) -> Result<Self, String> {
        let width = read.neighbors.width.unwrap_or(0);
        Ok(TriangulationCertificate {
            neighbors: read.neighbors.of_width("neighbors", width)?,
            fingerprint: read.fingerprint,
            points_hash: read.points_hash,
            counts: read.counts,
        })
    }
}

impl Serialize for TriangulationCertificate {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Hex<'a>(#[serde(serialize_with = "hash_to_hex")] &'a PointsHash);

        let has_neighbors = !self.neighbors.is_empty();
        let fields = if has_neighbors { 4 } else { 3 };
        let mut document = serializer.serialize_struct("TriangulationCertificate", fields)?;
        if has_neighbors {
            // The width is that of the simplices, which this does not see; the counts tell it.
            let rows = usize::try_from(self.counts.simplices).unwrap_or(usize::MAX);
            let width = self.neighbors.len().checked_div(rows).unwrap_or(0);
            document.serialize_field("neighbors", &NeighborsOf(&self.neighbors, width))?;
        }
        document.serialize_field("fingerprint", &self.fingerprint)?;
        document.serialize_field("points_hash", &Hex(&self.points_hash))?;
        document.serialize_field("counts", &self.counts)?;
        document.end()
    }
}

/// A flat list, written in rows of this many numbers; of one where that is no whole number of rows.
struct RowsOf<'a>(&'a [u32], usize);

impl Serialize for RowsOf<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(rows(self.0, self.1))
    }
}

/// The same, for numbers of simplices.
struct NeighborsOf<'a>(&'a [u32], usize);

impl Serialize for NeighborsOf<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        struct Row<'a>(&'a [u32]);
        impl Serialize for Row<'_> {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_seq(self.0.iter().map(|&neighbor| match neighbor {
                    NO_NEIGHBOR => -1,
                    neighbor => i64::from(neighbor),
                }))
            }
        }
        serializer.collect_seq(rows(self.0, self.1).map(Row))
    }
}

fn rows(values: &[u32], width: usize) -> std::slice::ChunksExact<'_, u32> {
    let is_whole = width > 0 && values.len().is_multiple_of(width);
    values.chunks_exact(if is_whole { width } else { 1 })
}

/// Rows of equal length, as read.
#[derive(Default)]
struct Table {
    values: Vec<u32>,
    /// Numbers in each row; `None` while there is no row.
    width: Option<usize>,
}

impl Table {
    fn of_width(self, name: &str, expected: usize) -> Result<Vec<u32>, String> {
        match self.width {
            Some(found) if found != expected => {
                Err(format!("rows of {name} have {found} numbers, expected {expected}"))
            }
            _ => Ok(self.values),
        }
    }
}

impl<'de> Deserialize<'de> for Table {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OfRows;
        impl<'de> Visitor<'de> for OfRows {
            type Value = Table;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of rows of as many whole numbers each")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut rows: A) -> Result<Table, A::Error> {
                let mut table = Table::default();
                while let Some(row) = rows.next_element::<ShortRow>()? {
                    let found = row.numbers().len();
                    if found != *table.width.get_or_insert(found) || found == 0 {
                        return Err(A::Error::invalid_length(found, &self));
                    }
                    table.values.extend_from_slice(row.numbers());
                }
                Ok(table)
            }
        }
        deserializer.deserialize_seq(OfRows)
    }
}

/// One row, kept off the heap: there are millions.
struct ShortRow {
    values: [u32; 4],
    len: usize,
}

impl ShortRow {
    fn numbers(&self) -> &[u32] {
        &self.values[..self.len]
    }
}

impl<'de> Deserialize<'de> for ShortRow {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OfNumbers;
        impl<'de> Visitor<'de> for OfNumbers {
            type Value = ShortRow;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a row of one to four whole numbers from -1 to 4294967295")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<ShortRow, A::Error> {
                let mut row = ShortRow { values: [0; 4], len: 0 };
                while let Some(number) = numbers.next_element::<i64>()? {
                    let value = match number {
                        -1 => Some(NO_NEIGHBOR),
                        number => u32::try_from(number).ok(),
                    };
                    match (row.values.get_mut(row.len), value) {
                        (Some(place), Some(value)) => *place = value,
                        _ => return Err(A::Error::custom("not a row of ids")),
                    }
                    row.len += 1;
                }
                Ok(row)
            }
        }
        deserializer.deserialize_seq(OfNumbers)
    }
}
