//! Points in and files out: one [`open`], one [`create`], one [`write_points`], one module per format.
//!
//! | you want | call | promise |
//! |---|---|---|
//! | points of a file or of standard input | [`open`] | every point or an error that names file, row, column and value |
//! | points of bytes in memory | [`open_bytes`] | the same |
//! | rows of numbers as they come, none of them kept | [`RowStream`] | the same |
//! | points with a label each | [`open`] with [`ReadOptions::label`] | the same; labels of text files may be any text |
//! | a file | [`create`] | the earlier file stays as it was until [`AtomicFile::commit`] |
//! | a folder of files | [`create_folder`] | the earlier folder stays as it was until [`AtomicFolder::commit`] |
//! | points as a file | [`write_points`] | block by block, so the points may be larger than memory |
//! | curves of the plane as a file | [`write_polylines`] | loops within loops are holes where a format knows them |
//! | lines with a height each as GeoJSON, place by place | [`LineFile`] | lines may be larger than memory |
//! | a raster as `.npy` or ESRI ASCII, cells in any order | [`RasterFile`] | the raster may be larger than memory |
//! | a mesh as a file: simplices on points, or a surface | [`write_mesh`] | every bit, where the format has room |
//! | the bytes of such a file of a mesh or of curves, where there are no files | [`mesh_bytes`], [`polylines_bytes`] | the same |
//! | a mesh of a file, whoever wrote it | [`open_mesh`] | every vertex and simplex, or an error that names file and line or element |
//! | the triangles of a mesh as points of dimension 9 | [`open_triangles`] | the same |
//! | type, shape, order and place of a NumPy array in a file | [`NpyArray::open`] | elements of any fixed width, as many as the header promises |
//!
//! ```
//! use taut_io::{ReadOptions, open_bytes};
//!
//! let input = open_bytes(b"x,y\n0,0\n2,0\n1,1\n".to_vec(), "points.csv", &ReadOptions::default())?;
//! assert_eq!((input.source.len(), input.source.dim()), (3, 2));
//! assert_eq!(input.columns, ["x", "y"]);
//! # Ok::<(), taut_io::Error>(())
//! ```
//!
//! Uncompressed npy files (C order, little-endian floats) and raw files are read in place and never parsed.
//! Everything else is decoded once, to memory or, when it outgrows [`ReadOptions::memory`], to a temporary file of
//! raw values. The names `.gz`, `.xz` and `.zst` compress any format.
//!
//! A *mesh* is simplices of one dimension on vertices: a [triangulation](Content::Triangulation) on given points, or a
//! [surface](Content::Surface) of triangles on vertices of its own. [`Format`] is the one table of formats, of points, meshes
//! and curves.
//!
//! Not for: points of differing dimension, polygons that stay polygons, textures, images.

#![forbid(unsafe_code)]

mod array;
mod columns;
mod compress;
mod create;
mod cursor;
mod device;
mod error;
mod filter;
mod format;
mod input;
mod joined;
mod labels;
mod limits;
mod mesh;
mod npy_header;
mod number;
mod options;
mod polylines;
mod raster;
mod read;
mod sink;
mod space;
mod spill;
mod stream;
mod words;
mod write;

pub use array::NpyArray;
pub use columns::Columns;
pub use create::{
    AtomicFile, AtomicFolder, ScratchFolder, check_folder, check_writable, create, create_folder,
    remove_unfinished,
};
pub use device::refuse_device;
pub use error::{Error, FilePlace, FilterError, Place, RasterError, StreamRowError};
pub use format::{Compression, Content, Format};
pub use input::{Input, open, open_bytes};
pub use limits::LONGEST_LINE;
pub use mesh::{
    Encoding, Mesh, MeshOptions, MeshView, SimplexSource, SpooledSimplices, mesh_bytes, mesh_file,
    open_mesh, open_mesh_bytes, open_triangles, write_mesh,
};
pub use options::{Bounds, Feature, Header, RawLayout, ReadOptions, Thinning};
pub use polylines::{LineFile, polylines_bytes, polylines_file, write_polylines};
pub use raster::{RasterFile, RasterHeader, check_raster};
pub use space::free_bytes;
pub use spill::spill_bytes;
pub use stream::{RowForm, RowStream};
pub use taut_mesh::Polyline;
pub use write::write_points;
