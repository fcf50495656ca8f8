//! Lines of `x y z`, then perhaps a normal, a color, or both in either order; before them perhaps an intensity, which is
//! passed over. A count may stand on the first line, as in pts files. Comments begin with `#` or `//`.
//!
//! *Idea.* Nothing says which three columns are which, so their values do, all rows together: vectors of length 1 (to one
//! in a hundred, or 0) are normals; else what is in [0, 255] is a color. The extensions `xyzn` and `xyzrgb` say it.
//! *Trap.* Points that are all purely red, green or blue, full at 1, look like normals: name their file `xyzrgb`.

use std::io::BufRead;
use std::path::Path;

use super::MeshBuilder;
use super::normal::unit;
use crate::words::{whole, words};
use crate::{Compression, Error, FilePlace};

/// The largest deviation of the length of a normal from 1: files keep as few as three digits of each coordinate.
const NORMAL_SLACK: f64 = 1e-2;

/// The role of three columns, where the name of the file states it.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Normal,
    Color,
}

/// Three columns after the coordinates.
#[derive(Default)]
struct Columns {
    values: Vec<[f64; 3]>,
    fraction: bool,
}

pub(super) fn read(
    mesh: &mut MeshBuilder<'_>,
    stream: Box<dyn BufRead>,
    name: &Path,
) -> Result<(), Error> {
    let mut lines = mesh.lines(stream, 0);
    let (mut count, mut width, mut row) = (None, None, Vec::new());
    let mut columns = [Columns::default(), Columns::default()];
    while lines.advance(mesh)? {
        let Some(line) = lines.current() else { break };
        if line.words.is_empty() || line.words.starts_with(b"//") {
            continue;
        }
        if let (None, None, Some(found)) = (width, count, whole(line.words)) {
            count = Some(found);
            continue;
        }
        let at = line.at;
        row.clear();
        for word in words(line.words) {
            row.push((mesh.number(at, word)?, word.contains(&b'.')));
        }
        let expected = *width.get_or_insert(row.len());
        if row.len() != expected {
            let problem = format!("{} columns, where the first row has {expected}", row.len());
            return Err(mesh.damaged(at, problem));
        }
        // An intensity stands alone between the coordinates and what comes in threes.
        let (groups, from) = match expected {
            3 | 6 | 9 => (expected / 3 - 1, 3),
            4 | 7 | 10 => (expected / 3 - 1, 4),
            _ => return Err(mesh.unsupported(at, format!("it has rows of {expected} columns"))),
        };
        mesh.vertex(at, [row[0].0, row[1].0, row[2].0])?;
        for (columns, group) in columns.iter_mut().zip(row[from..].chunks_exact(3)).take(groups) {
            let values = [group[0].0, group[1].0, group[2].0];
            columns.values.push(mesh.finite(at, "what stands after the coordinates,", values)?);
            columns.fraction |= group.iter().any(|value| value.1);
        }
    }
    if let Some(count) = count {
        let promised = u64::try_from(count)
            .map_err(|_| mesh.damaged(FilePlace::File, format!("it promises {count} points")))?;
        mesh.expect("points", promised, mesh.vertices.len() as u64)?;
    }
    let (inner, _) = Compression::split(name);
    let told = match inner.as_deref() {
        Some("xyzn") => Some(Role::Normal),
        Some("xyzrgb") => Some(Role::Color),
        _ => None,
    };
    columns
        .into_iter()
        .filter(|columns| !columns.values.is_empty())
        .try_for_each(|columns| take(mesh, columns, told))
}

/// Gives columns to the mesh as what they are; of two alike, the second is refused.
fn take(mesh: &mut MeshBuilder<'_>, columns: Columns, told: Option<Role>) -> Result<(), Error> {
    let at = FilePlace::File;
    let is_normal = |vector: &[f64; 3]| {
        let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
        unit(*vector).is_none() || (length - 1.0).abs() <= NORMAL_SLACK
    };
    let is_color = |color: &[f64; 3]| color.iter().all(|value| (0.0..=255.0).contains(value));
    let values = columns.values;
    let role = told.filter(|told| match told {
        Role::Normal => mesh.normals.is_empty(),
        Role::Color => mesh.colors.len() == 0,
    });
    // Where all is 0, it is black.
    let normals = values.iter().all(is_normal) && values.iter().flatten().any(|&x| x != 0.0);
    let role = role.or_else(|| match normals {
        true => Some(Role::Normal),
        false => values.iter().all(is_color).then_some(Role::Color),
    });
    match role {
        Some(Role::Normal) if mesh.normals.is_empty() => {
            mesh.normals = values;
            Ok(())
        }
        Some(Role::Color) if mesh.colors.len() == 0 => {
            values.into_iter().try_for_each(|color| mesh.color(at, color, columns.fraction))
        }
        Some(_) => Err(mesh.unsupported(at, "six columns are two normals or two colors")),
        None => Err(mesh.unsupported(at, "three columns are neither normals nor colors")),
    }
}
