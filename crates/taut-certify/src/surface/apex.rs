//! The data that show that a triangle of a surface has an empty ball.

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// The ball of a triangle: with the three vertices on its sphere, and empty. In JSON a whole number: the row, −1 for
/// [`Hull`](Apex::Hull), −2 for [`Gabriel`](Apex::Gabriel).
///
/// The smallest ball is looked into fastest. A ball whose sphere passes a large part of all points is slow to judge, as each of
/// these has to be looked at: where several balls are empty, name the smallest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Apex {
    /// The ball whose sphere passes this row as well: the far vertex of a Delaunay cell at the triangle.
    Row(u32),
    /// A facet of the convex hull: no point is beyond its plane, and none of those in the plane is inside the circle. Then all large
    /// enough balls beyond the plane are empty.
    Hull,
    /// The smallest ball of all, with its center in the plane of the triangle.
    Gabriel,
}

impl Serialize for Apex {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_i64(match self {
            Apex::Row(row) => i64::from(*row),
            Apex::Hull => -1,
            Apex::Gabriel => -2,
        })
    }
}

impl<'de> Deserialize<'de> for Apex {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match i64::deserialize(deserializer)? {
            -1 => Ok(Apex::Hull),
            -2 => Ok(Apex::Gabriel),
            row => u32::try_from(row).map(Apex::Row).map_err(|_| {
                D::Error::custom(format!("an apex is {row}: expected a row, -1 or -2"))
            }),
        }
    }
}
