//! The outputs of convex bodies: the answer as JSON or as one mesh, and a folder of parts.

use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use taut::certify::InscribedBodies;
use taut::{Monitor, Solution};
use taut_io::{AtomicFile, Format, Mesh, MeshOptions, mesh_file};

use crate::output::meshes::mesh_format;
use crate::output::parts::{own_parts, parts};
use crate::output::writing::Outputs;
use crate::pipeline::Output;

/// The options for what is done with bodies.
#[derive(Debug, clap::Args)]
pub(super) struct Exports {
    /// Do without the independent check, which is one more read of all rows
    #[arg(long)]
    no_verify: bool,
    /// Write the answer: .json with the certificate, or the bodies as one mesh, .ply, .obj, .off, .stl, .glb, .gltf, .dxf, .wrl or
    /// .pov; - is JSON on standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    out: Option<PathBuf>,
    /// Write each body as an obj file to this folder, with bodies.urdf and bodies.sdf, which name them as collision parts; a
    /// folder of an earlier run is replaced as a whole, unless it holds anything else
    #[arg(long, value_name = "FOLDER", help_heading = "Writing")]
    parts: Option<PathBuf>,
    /// Print the JSON instead of the summary
    #[arg(long, help_heading = "Writing")]
    json: bool,
    /// Draw the bodies in the mesh; .svg and .png show one picture, .html all
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    draw: Option<PathBuf>,
}

impl Exports {
    pub(super) fn output(&self) -> Output<'_> {
        Output {
            no_verify: self.no_verify,
            out: self.out.as_deref(),
            json: self.json,
            draw: self.draw.as_deref(),
        }
    }

    /// Refuses formats that are not written, and folders that cannot be replaced.
    pub(super) fn check(&self, input: &Path) -> anyhow::Result<()> {
        mesh_format(self.out.as_deref())?;
        let Some(folder) = &self.parts else { return Ok(()) };
        let shown = folder.display();
        if [&self.out, &self.draw].into_iter().flatten().any(|file| file == folder) {
            bail!("`{shown}` is named for two outputs: name another folder for the parts");
        }
        for file in [&self.out, &self.draw].into_iter().flatten() {
            if is_within(file, folder) {
                bail!(
                    "`{}` lies in `{shown}`, which is replaced as a whole: name another place for it",
                    file.display()
                );
            }
        }
        if input != folder && is_within(input, folder) {
            bail!("`{shown}` holds the input: name another folder for the parts");
        }
        Ok(taut_io::check_folder(folder, own_parts(folder))?)
    }

    pub(super) fn write(
        &self,
        found: &Solution<InscribedBodies>,
        outputs: &mut Outputs,
        monitor: &Monitor<'_>,
    ) -> anyhow::Result<()> {
        match (&self.out, mesh_format(self.out.as_deref())?) {
            (Some(out), Some(format)) => {
                outputs.hold(one_mesh(&found.answer, out, format, monitor)?);
            }
            (Some(out), None) => outputs.add_json(out, found)?,
            (None, _) => {}
        }
        if let Some(folder) = &self.parts {
            outputs.hold_folder(parts(&found.answer, folder, monitor)?);
        }
        Ok(())
    }
}

/// Tests whether a file is or will be in a folder that may not be there yet.
fn is_within(file: &Path, folder: &Path) -> bool {
    let parent = file.parent().and_then(|parent| parent.canonicalize().ok());
    let known = parent.zip(folder.canonicalize().ok());
    file.starts_with(folder) || known.is_some_and(|(parent, folder)| parent.starts_with(folder))
}

/// All bodies as one mesh; no two bodies have a vertex in common.
fn one_mesh(
    answer: &InscribedBodies,
    out: &Path,
    format: Format,
    monitor: &Monitor<'_>,
) -> anyhow::Result<AtomicFile> {
    let (mut vertices, mut triangles) = (vec![], vec![]);
    for body in &answer.bodies {
        let first = vertices.len() as u32;
        let (places, facets) = answer.mesh(body);
        vertices.extend(places);
        triangles.extend(facets.iter().map(|triangle| triangle.map(|id| first + id)));
    }
    let mesh = Mesh::of_triangles(vertices, &triangles);
    let view = mesh.view().map_err(|error| anyhow!("{}: {error}", out.display()))?;
    let options = MeshOptions { format: Some(format), ..MeshOptions::default() };
    Ok(mesh_file(&view, out, &options, monitor)?)
}
