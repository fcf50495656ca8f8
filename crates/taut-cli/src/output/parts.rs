//! Convex bodies as parts of a collision model: one obj file for each, and one URDF and one SDF file that name them.
//!
//! *Trap.* Both formats leave mass and visuals to whoever builds the robot: the files have neither, and SDF says that the model
//! is static. Names of files are relative, so that the folder can be moved.
//! *Reference.* URDF: wiki.ros.org/urdf/XML/link; SDFormat 1.7: sdformat.org/spec.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use anyhow::anyhow;
use taut::Monitor;
use taut::certify::InscribedBodies;
use taut_io::{AtomicFolder, Mesh, MeshOptions};

const URDF: &str = "bodies.urdf";
const SDF: &str = "bodies.sdf";

/// Whether a file of this name is one that [`parts`] writes.
pub(crate) fn is_part(name: &str) -> bool {
    let number = name.strip_prefix("body-").and_then(|rest| rest.strip_suffix(".obj"));
    [URDF, SDF].contains(&name)
        || number.is_some_and(|number| {
            !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
        })
}

/// The folder of all parts, complete, but not yet in its place.
pub(crate) fn parts(
    answer: &InscribedBodies,
    folder: &Path,
    monitor: &Monitor<'_>,
) -> anyhow::Result<AtomicFolder> {
    let made = taut_io::create_folder(folder, is_part)?;
    let names: Vec<String> = (0..answer.bodies.len()).map(|body| format!("body-{body}")).collect();
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

#[cfg(test)]
mod tests {
    #[test]
    fn own_files_are_known_by_name() {
        for name in ["bodies.urdf", "bodies.sdf", "body-0.obj", "body-12.obj"] {
            assert!(super::is_part(name), "{name}");
        }
        for name in ["body-.obj", "body-a.obj", "body-1.ply", "xbody-1.obj", "notes", ".hidden"] {
            assert!(!super::is_part(name), "{name}");
        }
    }
}
