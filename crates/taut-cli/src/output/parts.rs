//! Convex bodies as parts of a collision model: one obj file for each, and one URDF and one SDF file that name them.
//!
//! *Trap.* Both formats leave mass and visuals to whoever builds the robot: the files have neither, and SDF says that the model
//! is static. Names of files are relative, so that the folder can be moved.
//! *Reference.* URDF: wiki.ros.org/urdf/XML/link; SDFormat 1.7: sdformat.org/spec.

use std::fmt::Write as _;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write as _};
use std::path::Path;

use anyhow::anyhow;
use taut::Monitor;
use taut::certify::InscribedBodies;
use taut_io::{AtomicFolder, Mesh, MeshOptions};

const URDF: &str = "bodies.urdf";
const SDF: &str = "bodies.sdf";

/// Bytes of the first line of an obj file that are read, at most: two counts and their names take fewer.
const HEAD_BYTES_MAX: u64 = 100;

/// Returns a test of whether a file is one that [`parts`] wrote to this folder, by the list of bodies that is there.
///
/// Lists are compared whole, so that one that somebody added to is not taken for ours.
pub(crate) fn own_parts(folder: &Path) -> impl Fn(&Path) -> bool {
    let text = |name: &str| fs::read_to_string(folder.join(name)).unwrap_or_default();
    let (found, other) = (text(URDF), text(SDF));
    let names = names(found.matches("<collision ").count());
    let is_ours = [found == urdf(&names), other == sdf(&names)];
    move |path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        match name.strip_suffix(".obj") {
            Some(body) => is_ours[0] && names.iter().any(|name| name == body) && is_body(path),
            None => is_ours[0] && name == URDF || is_ours[1] && name == SDF,
        }
    }
}

/// Tests whether an obj file begins with the counts that the writer puts there.
fn is_body(path: &Path) -> bool {
    let mut line = String::new();
    let read = fs::File::open(path)
        .and_then(|file| BufReader::new(file.take(HEAD_BYTES_MAX)).read_line(&mut line));
    let counts = line.strip_prefix("# ").and_then(|rest| rest.split_once(" vertices, "));
    read.is_ok() && counts.is_some_and(|(_, rest)| rest.ends_with(" simplices\n"))
}

/// The names of the bodies, of which each is a file.
fn names(bodies: usize) -> Vec<String> {
    (0..bodies).map(|body| format!("body-{body}")).collect()
}

/// The folder of all parts, complete, but not yet in its place.
pub(crate) fn parts(
    answer: &InscribedBodies,
    folder: &Path,
    monitor: &Monitor<'_>,
) -> anyhow::Result<AtomicFolder> {
    let made = taut_io::create_folder(folder, own_parts(folder))?;
    let names = names(answer.bodies.len());
    for (body, name) in answer.bodies.iter().zip(&names) {
        monitor.check()?;
        let (vertices, triangles) = answer.mesh(body);
        let mesh = Mesh::of_triangles(vertices, &triangles);
        let view = mesh.view().map_err(|error| anyhow!("{}: {error}", folder.display()))?;
        let path = made.path().join(format!("{name}.obj"));
        taut_io::write_mesh(&view, &path, &MeshOptions::default(), monitor)?;
    }
    for (name, text) in [(URDF, urdf(&names)), (SDF, sdf(&names))] {
        let mut file = taut_io::create(&made.path().join(name))?;
        file.write_all(text.as_bytes())
            .map_err(|source| anyhow!("{}: writing failed: {source}", folder.display()))?;
        file.commit()?;
    }
    Ok(made)
}

fn urdf(names: &[String]) -> String {
    let mut text =
        "<?xml version=\"1.0\"?>\n<robot name=\"bodies\">\n  <link name=\"bodies\">\n".to_owned();
    for name in names {
        let mesh = format!("<mesh filename=\"{name}.obj\"/>");
        // Writing to a string does not fail.
        writeln!(
            text,
            "    <collision name=\"{name}\">\n      <geometry>{mesh}</geometry>\n    </collision>"
        )
        .ok();
    }
    text + "  </link>\n</robot>\n"
}

fn sdf(names: &[String]) -> String {
    let mut text =
        "<?xml version=\"1.0\"?>\n<sdf version=\"1.7\">\n  <model name=\"bodies\">\n    \
        <static>true</static>\n    <link name=\"bodies\">\n"
            .to_owned();
    for name in names {
        let mesh = format!("<mesh><uri>{name}.obj</uri></mesh>");
        writeln!(
            text,
            "      <collision name=\"{name}\">\n        <geometry>{mesh}</geometry>\n      </collision>"
        )
        .ok();
    }
    text + "    </link>\n  </model>\n</sdf>\n"
}
