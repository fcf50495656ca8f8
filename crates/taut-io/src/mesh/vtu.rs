//! VTK unstructured grids: XML that describes arrays, and the arrays appended as raw bytes.
//!
//! *Trap.* Raw bytes within XML are no XML, although VTK and ParaView write and read them so: only what stands before
//! the underscore that begins them is read as tags.

use taut_points::OrderBy;

use super::MeshBuilder;
use super::writing::Job;
use crate::cursor::{Cursor, Kind};
use crate::write::OutputFile;
use crate::{Error, FilePlace};

/// VTK's numbers of the cells of so many vertices: vertex, line, triangle, tetra.
const CELLS: [u8; 4] = [1, 3, 5, 10];

/// The longest tag, and the most of them: descriptions of arrays are short.
const LONGEST_TAG: u64 = 1 << 16;
const MOST_TAGS: usize = 1 << 10;

pub(super) fn write(job: &Job<'_>, out: &mut OutputFile<'_>) -> Result<(), Error> {
    let (vertices, width) = (job.mesh.vertex_count(), job.mesh.width as u64);
    let cells = job.mesh.simplex_count();
    // Each array is its length in bytes, as 8 bytes, and its values.
    let sizes = [24 * vertices, 8 * cells * width, 8 * cells, cells];
    let mut at = [0; 4];
    for i in 1..4 {
        at[i] = at[i - 1] + 8 + sizes[i - 1];
    }
    let array = |kind: &str, name: &str, more: &str, at: u64| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\"{more} format=\"appended\" offset=\"{at}\"/>\n"
        )
    };
    let header = format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <UnstructuredGrid>\n<Piece NumberOfPoints=\"{vertices}\" NumberOfCells=\"{cells}\">\n\
         <Points>\n{}</Points>\n<Cells>\n{}{}{}</Cells>\n\
         </Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_",
        array("Float64", "Points", " NumberOfComponents=\"3\"", at[0]),
        array("Int64", "connectivity", "", at[1]),
        array("Int64", "offsets", "", at[2]),
        array("UInt8", "types", "", at[3]),
    );
    out.put(header.as_bytes())?;
    out.put(&sizes[0].to_le_bytes())?;
    job.each_vertex(out, |_, at, bytes| at.iter().for_each(|x| bytes.extend(x.to_le_bytes())))?;
    out.put(&sizes[1].to_le_bytes())?;
    job.each_simplex(out, |ids, bytes| {
        ids.iter().for_each(|&id| bytes.extend(u64::from(id).to_le_bytes()));
    })?;
    out.put(&sizes[2].to_le_bytes())?;
    let mut end = 0_u64;
    job.each_simplex(out, |_, bytes| {
        end += width;
        bytes.extend(end.to_le_bytes());
    })?;
    out.put(&sizes[3].to_le_bytes())?;
    job.each_simplex(out, |ids, bytes| bytes.push(CELLS[ids.len() - 1]))?;
    out.put(b"\n</AppendedData>\n</VTKFile>\n")
}

struct Tag {
    name: String,
    attributes: Vec<(String, String)>,
}

impl Tag {
    fn get(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }
}

/// An array of the appended data.
struct Array {
    name: &'static str,
    kind: Kind,
    offset: u64,
}

pub(super) fn read(mesh: &mut MeshBuilder<'_>, cursor: &mut Cursor<'_>) -> Result<(), Error> {
    let mut tags: Vec<Tag> = Vec::new();
    while tags.last().is_none_or(|tag| tag.name != "AppendedData") {
        let text = cursor.text_before(b'>', LONGEST_TAG)?;
        let text =
            text.ok_or_else(|| mesh.damaged(FilePlace::File, "there is no appended data"))?;
        tags.extend(
            tag(&text).ok_or_else(|| mesh.damaged(FilePlace::File, "its description is no XML"))?,
        );
        if tags.len() > MOST_TAGS {
            return Err(mesh.damaged(FilePlace::File, "its description has no end"));
        }
    }
    let mark = cursor.text_before(b'_', LONGEST_TAG)?;
    if mark.is_none_or(|blank| !blank.trim().is_empty()) {
        return Err(
            mesh.damaged(FilePlace::File, "its appended data do not begin with an underscore")
        );
    }
    let find = |name: &str| tags.iter().find(|tag| tag.name == name);
    let file = find("VTKFile")
        .ok_or_else(|| mesh.damaged(FilePlace::File, "there is no tag `VTKFile`"))?;
    let wanted =
        [("type", "UnstructuredGrid"), ("byte_order", "LittleEndian"), ("header_type", "UInt64")];
    for (key, value) in wanted {
        if file.get(key) != Some(value) {
            return Err(mesh.unsupported(FilePlace::File, format!("its `{key}` is not {value}")));
        }
    }
    if file.get("compressor").is_some()
        || find("AppendedData").and_then(|tag| tag.get("encoding")) != Some("raw")
    {
        return Err(mesh.unsupported(FilePlace::File, "its data are compressed or encoded"));
    }
    let pieces: Vec<&Tag> = tags.iter().filter(|tag| tag.name == "Piece").collect();
    let [piece] = pieces[..] else {
        return Err(mesh.unsupported(FilePlace::File, format!("it has {} pieces", pieces.len())));
    };
    let count = |key: &str| {
        piece
            .get(key)
            .and_then(|count| count.parse::<u64>().ok())
            .ok_or_else(|| mesh.damaged(FilePlace::File, format!("its piece has no count `{key}`")))
    };
    let (vertices, cells) = (count("NumberOfPoints")?, count("NumberOfCells")?);
    let mut arrays = Vec::new();
    for name in ["Points", "connectivity", "offsets", "types"] {
        arrays.push(array(mesh, &tags, name)?);
    }
    // A stream is read once, so the arrays are taken as they come.
    let start = cursor.at;
    arrays.order_by_key(|array| array.offset);
    let (mut ids, mut ends, mut types) = (Vec::new(), Vec::new(), Vec::new());
    for array in &arrays {
        let place = FilePlace::Element(array.name, 0);
        let skipped = array.offset.checked_sub(cursor.at - start);
        let skipped = skipped.ok_or_else(|| mesh.damaged(place, "the arrays overlap"))?;
        cursor.skip(skipped, mesh, place)?;
        let bytes = cursor.whole(Kind::U64, mesh, place)? as u64;
        let values = bytes / array.kind.size() as u64;
        let expected = match array.name {
            "Points" => vertices.checked_mul(3),
            "connectivity" => Some(values).filter(|values| values / 4 <= cells),
            _ => Some(cells),
        };
        if expected != Some(values) || !bytes.is_multiple_of(array.kind.size() as u64) {
            return Err(mesh.damaged(place, format!("its length of {bytes} bytes is wrong")));
        }
        match array.name {
            "Points" => read_points(mesh, cursor, array.kind, vertices)?,
            "connectivity" => numbers(mesh, cursor, array, values, &mut ids)?,
            "offsets" => numbers(mesh, cursor, array, values, &mut ends)?,
            _ => numbers(mesh, cursor, array, values, &mut types)?,
        }
    }
    let rest = cursor.rest(1 << 10)?;
    let closing: Vec<u8> = rest.into_iter().filter(|b| !b.is_ascii_whitespace()).collect();
    if closing != b"</AppendedData></VTKFile>" {
        return Err(mesh.damaged(FilePlace::File, "the appended data do not end with its tags"));
    }
    let mut from = 0;
    for (number, (&end, &kind)) in (0..).zip(ends.iter().zip(&types)) {
        let place = FilePlace::Element("cell", number);
        let width = CELLS.iter().position(|&cell| i64::from(cell) == kind).map(|place| place + 1);
        let width = width
            .ok_or_else(|| mesh.unsupported(place, format!("it is of type {kind}, no simplex")))?;
        let row = usize::try_from(end).ok().filter(|&end| end == from + width);
        let row = row.and_then(|end| ids.get(from..end));
        let row = row.ok_or_else(|| mesh.damaged(place, "its offset does not fit its type"))?;
        from += width;
        mesh.simplex(place, row, width, vertices)?;
    }
    mesh.expect("ids", ids.len() as u64, from as u64)
}

fn array(mesh: &MeshBuilder<'_>, tags: &[Tag], name: &'static str) -> Result<Array, Error> {
    let is_it = |tag: &&Tag| tag.name == "DataArray" && tag.get("Name") == Some(name);
    let tag = tags
        .iter()
        .find(is_it)
        .ok_or_else(|| mesh.damaged(FilePlace::File, format!("there is no array `{name}`")))?;
    let kind = match tag.get("type") {
        Some("Float64") => Kind::F64,
        Some("Float32") => Kind::F32,
        Some("Int64") => Kind::I64,
        Some("UInt64") => Kind::U64,
        Some("Int32") => Kind::I32,
        Some("UInt32") => Kind::U32,
        Some("UInt8") => Kind::U8,
        _ => {
            return Err(
                mesh.unsupported(FilePlace::File, format!("array `{name}` is of an odd type"))
            );
        }
    };
    let offset = tag.get("offset").and_then(|offset| offset.parse().ok());
    match (tag.get("format"), offset) {
        (Some("appended"), Some(offset)) => Ok(Array { name, kind, offset }),
        _ => Err(mesh.unsupported(FilePlace::File, format!("array `{name}` is not appended"))),
    }
}

fn read_points(
    mesh: &mut MeshBuilder<'_>,
    cursor: &mut Cursor<'_>,
    kind: Kind,
    vertices: u64,
) -> Result<(), Error> {
    for number in 0..vertices {
        let place = FilePlace::Element("point", number);
        let mut at = [0.0; 3];
        for x in &mut at {
            *x = cursor.real(kind, mesh, place)?;
        }
        mesh.vertex(place, at)?;
    }
    Ok(())
}

fn numbers(
    mesh: &MeshBuilder<'_>,
    cursor: &mut Cursor<'_>,
    array: &Array,
    count: u64,
    to: &mut Vec<i64>,
) -> Result<(), Error> {
    for number in 0..count {
        to.push(cursor.whole(array.kind, mesh, FilePlace::Element(array.name, number))?);
    }
    Ok(())
}

/// The tag that a text ends with but for its `>`, if it is an opening one; `None` where it ends with none.
fn tag(text: &str) -> Option<Option<Tag>> {
    let (_, tag) = text.split_once('<')?;
    let tag = tag.trim_end_matches('/');
    if tag.starts_with(['/', '?', '!']) {
        return Some(None);
    }
    let end = tag.find(|c: char| c.is_ascii_whitespace()).unwrap_or(tag.len());
    let (name, mut words) = tag.split_at(end);
    let mut attributes = Vec::new();
    while let Some((key, after)) = words.split_once('=') {
        let after = after.trim_start();
        let quote = after.chars().next().filter(|&c| c == '"' || c == '\'')?;
        let (value, after) = after[1..].split_once(quote)?;
        attributes.push((key.trim().to_owned(), value.to_owned()));
        words = after;
    }
    Some(Some(Tag { name: name.to_owned(), attributes }))
}
