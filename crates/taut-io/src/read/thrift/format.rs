//! The structures by which a Parquet file describes itself: the kind of each field that a reader may know.
//!
//! *Reference.* Parquet format, `parquet.thrift`. Encryption is left out, and so is what has no field: unknown fields say
//! their own kind.

/// The type of a field.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Bool,
    Byte,
    I16,
    I32,
    I64,
    Double,
    Binary,
    List(&'static Kind),
    Struct(Shape),
}

/// The fields of a structure that a reader may know, each with its number.
pub(super) type Shape = &'static [(i16, Kind)];

use Kind::{Binary, Bool, Byte, Double, I16, I32, I64, List, Struct};

impl Kind {
    /// Returns true if a field says this kind with the number `written`, which for a boolean is its value.
    pub(super) fn is_written(self, written: u8) -> bool {
        match self {
            Bool => written == 1 || written == 2,
            Byte => written == 3,
            I16 => written == 4,
            I32 => written == 5,
            I64 => written == 6,
            Double => written == 7,
            Binary => written == 8,
            List(_) => written == 9,
            Struct(_) => written == 12,
        }
    }

    /// The fields of this kind that are known.
    pub(super) fn shape(self) -> Shape {
        match self {
            Struct(shape) => shape,
            _ => &[],
        }
    }
}

/// The field of [`PAGE_HEADER`] that says how many bytes follow it.
pub(super) const COMPRESSED_PAGE_SIZE: i16 = 3;

pub(super) const PAGE_HEADER: Shape = &[
    (1, I32),
    (2, I32),
    (COMPRESSED_PAGE_SIZE, I32),
    (4, I32),
    (5, Struct(DATA_PAGE_HEADER)),
    (6, Struct(&[])),
    (7, Struct(&[(1, I32), (2, I32), (3, Bool)])),
    (8, Struct(DATA_PAGE_HEADER_V2)),
];

const DATA_PAGE_HEADER: Shape = &[(1, I32), (2, I32), (3, I32), (4, I32), (5, Struct(STATISTICS))];

const DATA_PAGE_HEADER_V2: Shape = &[
    (1, I32),
    (2, I32),
    (3, I32),
    (4, I32),
    (5, I32),
    (6, I32),
    (7, Bool),
    (8, Struct(STATISTICS)),
];

const STATISTICS: Shape = &[
    (1, Binary),
    (2, Binary),
    (3, I64),
    (4, I64),
    (5, Binary),
    (6, Binary),
    (7, Bool),
    (8, Bool),
    (9, I64),
];

/// The footer.
pub(super) const FILE_META_DATA: Shape = &[
    (1, I32),
    (2, List(&Struct(SCHEMA_ELEMENT))),
    (3, I64),
    (4, List(&Struct(ROW_GROUP))),
    (5, List(&Struct(KEY_VALUE))),
    (6, Binary),
    // Each column's order is the one of its type, without a field of its own.
    (7, List(&Struct(&[(1, Struct(&[]))]))),
    (9, Binary),
];

const SCHEMA_ELEMENT: Shape = &[
    (1, I32),
    (2, I32),
    (3, I32),
    (4, Binary),
    (5, I32),
    (6, I32),
    (7, I32),
    (8, I32),
    (9, I32),
    (10, Struct(LOGICAL_TYPE)),
];

const LOGICAL_TYPE: Shape = &[
    (1, Struct(&[])),
    (2, Struct(&[])),
    (3, Struct(&[])),
    (4, Struct(&[])),
    (5, Struct(&[(1, I32), (2, I32)])),
    (6, Struct(&[])),
    (7, Struct(TIME)),
    (8, Struct(TIME)),
    (10, Struct(&[(1, Byte), (2, Bool)])),
    (11, Struct(&[])),
    (12, Struct(&[])),
    (13, Struct(&[])),
    (14, Struct(&[])),
    (15, Struct(&[])),
    (16, Struct(&[(1, Byte)])),
    (17, Struct(&[(1, Binary)])),
    (18, Struct(&[(1, Binary), (2, I32)])),
];

const TIME: Shape =
    &[(1, Bool), (2, Struct(&[(1, Struct(&[])), (2, Struct(&[])), (3, Struct(&[]))]))];

const KEY_VALUE: Shape = &[(1, Binary), (2, Binary)];

const ROW_GROUP: Shape = &[
    (1, List(&Struct(COLUMN_CHUNK))),
    (2, I64),
    (3, I64),
    (4, List(&Struct(&[(1, I32), (2, Bool), (3, Bool)]))),
    (5, I64),
    (6, I64),
    (7, I16),
];

const COLUMN_CHUNK: Shape = &[
    (1, Binary),
    (2, I64),
    (3, Struct(COLUMN_META_DATA)),
    (4, I64),
    (5, I32),
    (6, I64),
    (7, I32),
    (9, Binary),
];

const COLUMN_META_DATA: Shape = &[
    (1, I32),
    (2, List(&I32)),
    (3, List(&Binary)),
    (4, I32),
    (5, I64),
    (6, I64),
    (7, I64),
    (8, List(&Struct(KEY_VALUE))),
    (9, I64),
    (10, I64),
    (11, I64),
    (12, Struct(STATISTICS)),
    (13, List(&Struct(&[(1, I32), (2, I32), (3, I32)]))),
    (14, I64),
    (15, I32),
    (16, Struct(&[(1, I64), (2, List(&I64)), (3, List(&I64))])),
    (17, Struct(&[(1, Struct(BOUNDING_BOX)), (2, List(&I32))])),
];

const BOUNDING_BOX: Shape = &[
    (1, Double),
    (2, Double),
    (3, Double),
    (4, Double),
    (5, Double),
    (6, Double),
    (7, Double),
    (8, Double),
];
