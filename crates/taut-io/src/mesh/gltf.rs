//! glTF 2.0: JSON that describes a buffer, and the buffer, in one binary file or within the JSON.
//!
//! The buffer holds positions, normals and colors of vertices, then the corners of triangles; without triangles the
//! vertices are points. Normals are scaled to length 1, and left out where one is 0, as the format wants them so.
//!
//! *Trap.* The bounds of positions must be those of the rounded coordinates: they are written with all digits of these.
//! *Trap.* The format takes y for up and colors for linear; coordinates and colors are written as they are.
//! *Reference.* The Khronos Group, glTF 2.0 specification, 2021.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::MeshView;
use super::normal::unit;
use crate::Error;
use crate::words::put_number;
use crate::write::OutputFile;

/// The magic number, and the types of the two chunks of a binary file.
const MAGIC: &[u8; 4] = b"glTF";
const JSON: &[u8; 4] = b"JSON";
const BIN: &[u8; 4] = b"BIN\0";

/// Bytes of a header of a file or of a chunk in a binary file.
const FILE_HEADER: u64 = 12;
const CHUNK_HEADER: u64 = 8;

/// The contents of the buffer, in order.
struct Buffer<'a> {
    mesh: &'a MeshView<'a>,
    /// Normals of length 1.
    normals: Option<Vec<[f64; 3]>>,
}

struct Run {
    /// The attribute of vertices; none of corners.
    attribute: Option<&'static str>,
    /// Type of a value and of its components, and bytes of a value.
    kind: &'static str,
    component: u32,
    size: usize,
    count: usize,
    /// Further remarks about it.
    more: String,
}

impl<'a> Buffer<'a> {
    fn new(mesh: &'a MeshView<'a>) -> Self {
        let units = |normals: &[[f64; 3]]| normals.iter().map(|&normal| unit(normal)).collect();
        Buffer { mesh, normals: mesh.normals.and_then(units) }
    }

    /// The runs of values, without empty ones, which the format forbids.
    fn runs(&self) -> Vec<Run> {
        let n = self.mesh.places().len();
        let run = |attribute, kind, component, size, count, more| Run {
            attribute: Some(attribute),
            kind,
            component,
            size,
            count,
            more,
        };
        let mut runs = vec![run("POSITION", "VEC3", 5126, 12, n, self.bounds())];
        if self.normals.is_some() {
            runs.push(run("NORMAL", "VEC3", 5126, 12, n, String::new()));
        }
        if self.mesh.colors.is_some() {
            // With opacity, so that each color begins at a multiple of four bytes.
            let normalized = ",\"normalized\":true".to_owned();
            runs.push(run("COLOR_0", "VEC4", 5121, 4, n, normalized));
        }
        let corners = 3 * self.mesh.triangles().len();
        if corners > 0 {
            let scalar = run("", "SCALAR", 5125, 4, corners, String::new());
            runs.push(Run { attribute: None, ..scalar });
        }
        runs
    }

    /// The least and the greatest of each coordinate, rounded as in the buffer.
    fn bounds(&self) -> String {
        let (mut least, mut greatest) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for at in self.mesh.places() {
            for k in 0..3 {
                least[k] = least[k].min(at[k] as f32);
                greatest[k] = greatest[k].max(at[k] as f32);
            }
        }
        format!(",\"min\":[{}],\"max\":[{}]", list(least), list(greatest))
    }

    fn len(&self) -> u64 {
        self.runs().iter().map(|run| (run.size * run.count) as u64).sum()
    }

    fn json(&self, uri: &str) -> String {
        let (mut views, mut accessors, mut attributes) = (Vec::new(), Vec::new(), Vec::new());
        let (mut offset, mut corners) = (0, String::new());
        for (i, run) in self.runs().iter().enumerate() {
            let Run { kind, component, count, more, .. } = run;
            let length = run.size * count;
            // Buffers of vertices and of corners are told apart for those who copy them to a graphics card.
            let target = if run.attribute.is_some() { 34962 } else { 34963 };
            views.push(format!(
                "{{\"buffer\":0,\"byteOffset\":{offset},\"byteLength\":{length},\"target\":{target}}}"
            ));
            accessors.push(format!(
                "{{\"bufferView\":{i},\"componentType\":{component},\"count\":{count},\"type\":\"{kind}\"{more}}}"
            ));
            match run.attribute {
                Some(name) => attributes.push(format!("\"{name}\":{i}")),
                None => corners = format!(",\"indices\":{i}"),
            }
            offset += length;
        }
        // 4 is triangles, 0 is points.
        let mode = if corners.is_empty() { 0 } else { 4 };
        format!(
            "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"taut\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],\
             \"nodes\":[{{\"mesh\":0}}],\"meshes\":[{{\"primitives\":[{{\"attributes\":{{{}}}{corners},\"mode\":{mode},\
             \"material\":0}}]}}],\"materials\":[{{\"doubleSided\":true,\"pbrMetallicRoughness\":{{\"metallicFactor\":0}}}}],\
             \"buffers\":[{{\"byteLength\":{offset}{uri}}}],\"bufferViews\":[{}],\"accessors\":[{}]}}",
            attributes.join(","),
            views.join(","),
            accessors.join(","),
        )
    }

    /// Hands the bytes of the buffer to `out`, through `encode`.
    fn write(
        &self,
        out: &mut OutputFile<'_>,
        mut encode: impl FnMut(&[u8], &mut Vec<u8>),
    ) -> Result<(), Error> {
        let mut place = |at: &[f64; 3], bytes: &mut Vec<u8>| {
            let [x, y, z] = at.map(|value| (value as f32).to_le_bytes());
            encode([x, y, z].as_flattened(), bytes);
        };
        out.each(self.mesh.places(), &mut place)?;
        out.each(self.normals.iter().flatten(), &mut place)?;
        out.each(self.mesh.colors.unwrap_or_default(), |&[r, g, b], bytes| {
            encode(&[r, g, b, u8::MAX], bytes);
        })?;
        out.each(self.mesh.triangles(), |ids, bytes| {
            encode(ids.map(u32::to_le_bytes).as_flattened(), bytes);
        })
    }
}

/// Numbers of single precision, with all their digits: who reads them in double precision gets the same values.
fn list(values: [f32; 3]) -> String {
    let mut text = Vec::new();
    for (i, value) in values.into_iter().enumerate() {
        if i > 0 {
            text.push(b',');
        }
        put_number(value.into(), &mut text);
    }
    String::from_utf8(text).expect("digits are text")
}

/// Bytes of a binary file; the JSON ends in blanks at a multiple of four.
fn binary_len(json: &str, buffer: u64) -> u64 {
    FILE_HEADER + CHUNK_HEADER + (json.len() as u64).next_multiple_of(4) + CHUNK_HEADER + buffer
}

pub(super) fn write_binary(mesh: &MeshView<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let buffer = Buffer::new(mesh);
    let mut json = buffer.json("");
    let too_large = || Error::MeshTooLarge { path: out.path.to_owned() };
    let size = |bytes: u64| u32::try_from(bytes).map(u32::to_le_bytes).map_err(|_| too_large());
    let whole = size(binary_len(&json, buffer.len()))?;
    json.push_str(&"   "[..json.len().next_multiple_of(4) - json.len()]);
    let (text, values) = (size(json.len() as u64)?, size(buffer.len())?);
    let parts =
        [&MAGIC[..], &2_u32.to_le_bytes(), &whole, &text, JSON, json.as_bytes(), &values, BIN];
    out.put(&parts.concat())?;
    buffer.write(out, |values, bytes| bytes.extend_from_slice(values))
}

pub(super) fn write_json(mesh: &MeshView<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let buffer = Buffer::new(mesh);
    // The place of the bytes is marked, and they are written there.
    const MARK: &str = "\u{1}";
    let uri = format!(",\"uri\":\"data:application/octet-stream;base64,{MARK}\"");
    let json = buffer.json(&uri);
    let (before, after) = json.split_once(MARK).expect("the mark was put there");
    out.put(before.as_bytes())?;
    // Three bytes make four digits; what is left over waits for those that follow.
    let mut rest = Vec::new();
    let mut digits = String::new();
    buffer.write(out, |values, bytes| {
        rest.extend_from_slice(values);
        let whole = rest.len() / 3 * 3;
        digits.clear();
        STANDARD.encode_string(&rest[..whole], &mut digits);
        bytes.extend_from_slice(digits.as_bytes());
        rest.drain(..whole);
    })?;
    out.put(STANDARD.encode(&rest).as_bytes())?;
    out.put(after.as_bytes())?;
    out.put(b"\n")
}
