//! `taut surface`: the surface that points of space were sampled from, with what is known about it.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use taut::certify::{Surface, SurfaceMethod as Kind};
use taut::points::{PointSource, Scratch};
use taut::reconstruct::thesis::{AlphaFilter, Extent, Priority, ThesisOptions};
use taut::reconstruct::{Denoise, HullOptions, Positions, SurfaceMode};
use taut::{Monitor, Solution, SurfaceMethod, SurfaceOptions, surface};
use taut_io::{Content, Format, Mesh, MeshOptions, mesh_file, open_mesh};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::choice::{check_method_options, choice};
use crate::input::reading::{Opened, Points, Reading};
use crate::output::meshes::mesh_format;
use crate::output::writing::{self, Outputs};
use crate::pipeline::{self, Find, Input, Output};
use crate::watch::Watch;

/// Find the surface that points of space were sampled from: triangles between the points, and whether they are a surface.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Certified means: an oriented manifold of Delaunay triangles that meets itself nowhere. Where that cannot be said, the \
reason is told, and the exit code is 0 all the same.
A mesh has the points as vertices, in their order, used or not; normals and colors of a ply, obj, off or xyz file go \
with them.
Exit: 0 done · 1 the check failed · 2 bad input or usage, nothing written
Example: taut surface bunny.ply -o bunny.stl
         taut surface points.csv -o surface.json --draw surface.html &&
         taut verify surface.json points.csv")]
pub(crate) struct Args {
    #[command(flatten)]
    points: Points,
    /// The way to find it
    #[arg(
        long, value_name = "NAME", default_value = Kind::default().name(), value_parser = choice::<Kind>()
    )]
    method: Kind,
    /// Of tree, leave gaps in the samples open: sheets end where their points end
    #[arg(long, conflicts_with = "closed")]
    open: bool,
    /// Of tree, close everything, as the boundary of bodies; the default
    #[arg(long)]
    closed: bool,
    /// Take noise out of the points first: leave outliers out and move each other point onto the sheet that its neighbors show
    #[arg(long)]
    denoise: bool,
    /// With --denoise, how many nearest points show the sheet of a point, itself among them; from 4 to 1000 [default: 24 to 272, by the noise]
    #[arg(long, value_name = "N", requires = "denoise")]
    neighbors: Option<usize>,
    /// With --denoise, how many times each point is moved; 0 leaves out outliers alone [default: 2]
    #[arg(long, value_name = "N", requires = "denoise")]
    iterations: Option<u32>,
    /// With --denoise, leave the vertices where the points are given: triangles are those of the moved points
    #[arg(long, requires = "denoise")]
    original: bool,
    /// Of alpha, the radius [default: the least at which all points are on one solid or in it]; of thesis and hull, the largest
    /// circumradius of a triangle [default: any]
    #[arg(long, value_name = "RADIUS", allow_negative_numbers = true)]
    alpha: Option<f64>,
    /// Of thesis and hull, by which part of its radius the sphere of a triangle is shrunk before it has to be empty [default: 2e-5]
    #[arg(long, value_name = "REAL", allow_negative_numbers = true)]
    epsilon: Option<f64>,
    /// Of thesis, the angle in radians below which two triangles at an edge are on slivers [default: π/12]
    #[arg(long, value_name = "ANGLE", allow_negative_numbers = true)]
    sliver_angle: Option<f64>,
    /// Of thesis, the least angle in radians between two triangles [default: π/4]
    #[arg(long, value_name = "ANGLE", allow_negative_numbers = true)]
    forbidden_angle: Option<f64>,
    /// Of thesis, what the front prefers [default: circumcentre-distance]
    #[arg(long, value_name = "NAME", value_parser = choice::<Priority>())]
    priority: Option<Priority>,
    /// Of thesis, start another front where no triangle reaches
    #[arg(long)]
    restarts: bool,
    /// Do without the independent check
    #[arg(long)]
    no_verify: bool,

    /// Write the answer: .json with the certificate, or the mesh alone as .ply, .obj, .off, .stl, .glb, .gltf, .dxf, .wrl or .pov; - is
    /// JSON on standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    out: Option<PathBuf>,
    /// Print the JSON instead of the summary
    #[arg(long, help_heading = "Writing")]
    json: bool,
    /// Draw the surface with the points it leaves out; .svg and .png show one picture, .html all
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    draw: Option<PathBuf>,

    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Find for Args {
    type Answer = Surface;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        Input { path: &self.points.path, reading: &self.reading, effort: &self.effort }
    }

    fn output(&self) -> Output<'_> {
        Output {
            no_verify: self.no_verify,
            out: self.out.as_deref(),
            json: self.json,
            draw: self.draw.as_deref(),
        }
    }

    fn check_options(&self) -> anyhow::Result<()> {
        self.check_method_options()?;
        mesh_format(self.out.as_deref()).map(drop)
    }

    fn solve(&self, points: &Opened, watch: &Watch) -> anyhow::Result<(Solution<Surface>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            surface(points.source(), &SurfaceOptions { monitor: *monitor, ..self.options() })
        };
        let found = watch.during("solving", solve).map_err(|error| points.explain(error))?;
        Ok((found, ()))
    }

    fn write(
        &self,
        found: &mut Solution<Surface>,
        _: &(),
        points: &Opened,
        outputs: &mut Outputs,
        _: &Monitor<'_>,
    ) -> anyhow::Result<()> {
        match (&self.out, mesh_format(self.out.as_deref())?) {
            (Some(out), Some(format)) => outputs.hold(self.mesh(found, points, out, format)?),
            (Some(out), None) => outputs.add_json(out, found)?,
            (None, _) => {}
        }
        Ok(())
    }
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        pipeline::run(self)
    }

    /// Refuses options that the method does not have, rather than passing over them.
    fn check_method_options(&self) -> anyhow::Result<()> {
        let options = [
            ("open", self.open),
            ("closed", self.closed),
            ("alpha", self.alpha.is_some()),
            ("epsilon", self.epsilon.is_some()),
            ("sliver-angle", self.sliver_angle.is_some()),
            ("forbidden-angle", self.forbidden_angle.is_some()),
            ("priority", self.priority.is_some()),
            ("restarts", self.restarts),
        ];
        check_method_options(self.method.name(), &options, |option, method| {
            SurfaceOptions::methods_of(option).contains(method)
        })
    }

    /// The file of the mesh, with what the file of the points says of them.
    fn mesh(
        &self,
        found: &Solution<Surface>,
        points: &Opened,
        out: &Path,
        format: Format,
    ) -> anyhow::Result<taut_io::AtomicFile> {
        let vertices = match found.answer.vertices.is_empty() {
            true => places(points)?,
            false => found.answer.vertices.clone(),
        };
        let Mesh { normals, colors, .. } = self.attributes(vertices.len())?;
        let mesh = Mesh::of_triangles(vertices, &found.answer.triangles);
        let mesh = Mesh { normals, colors, ..mesh };
        let view = mesh.view().map_err(|error| anyhow!("{}: {error}", out.display()))?;
        let options = MeshOptions { format: Some(format), ..MeshOptions::default() };
        Ok(mesh_file(&view, out, &options, &Monitor::silent())?)
    }

    /// A mesh with the normals and colors of the points, where their file has them and all its rows are points in its order.
    fn attributes(&self, points: usize) -> anyhow::Result<Mesh> {
        let path = &self.points.path;
        let format = Format::of_path(path).0.filter(|format| format.reads(Content::Surface));
        let Some(format) = format.filter(|_| !writing::is_stream(path)) else {
            return Ok(Mesh::default());
        };
        let mesh = open_mesh(path, Content::Surface, Some(format))?;
        Ok(if mesh.vertices.len() == points { mesh } else { Mesh::default() })
    }

    fn noise(&self) -> Denoise {
        let usual = Denoise::default();
        Denoise {
            neighbors: self.neighbors.or(usual.neighbors),
            iterations: self.iterations.unwrap_or(usual.iterations),
            positions: if self.original { Positions::Original } else { Positions::Projected },
        }
    }

    fn method(&self) -> SurfaceMethod {
        let usual = ThesisOptions::default();
        let epsilon = self.epsilon.unwrap_or(usual.epsilon);
        let alpha = self.alpha.map_or(AlphaFilter::None, AlphaFilter::Circumradius);
        match self.method {
            Kind::Tree if self.open => SurfaceMethod::Tree(SurfaceMode::Open),
            Kind::Tree => SurfaceMethod::Tree(SurfaceMode::Closed),
            Kind::Alpha => SurfaceMethod::Alpha(self.alpha),
            Kind::Hull => {
                SurfaceMethod::Hull(HullOptions { epsilon, alpha, ..HullOptions::default() })
            }
            Kind::Thesis => SurfaceMethod::Thesis(ThesisOptions {
                epsilon,
                alpha,
                sliver_angle: self.sliver_angle.unwrap_or(usual.sliver_angle),
                forbidden_angle: self.forbidden_angle.unwrap_or(usual.forbidden_angle),
                priority: self.priority.unwrap_or(usual.priority),
                extent: if self.restarts { Extent::Restarts } else { Extent::Front },
                ..usual
            }),
        }
    }

    fn options(&self) -> SurfaceOptions<'static> {
        SurfaceOptions {
            method: self.method(),
            denoise: self.denoise.then(|| self.noise()),
            // The threads are those of the pool, which reading and checking use as well.
            ..SurfaceOptions::default()
        }
    }
}

fn places(points: &Opened) -> anyhow::Result<Vec<[f64; 3]>> {
    let source: &dyn PointSource = points.source();
    let mut scratch = Scratch::new();
    let rows =
        source.read(0..source.len(), &mut scratch).map_err(|error| points.reading_failed(error))?;
    let mut place = [0.0; 3];
    Ok((0..rows.len())
        .map(|row| {
            rows.copy_row(row, &mut place);
            place
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches};

    #[test]
    fn the_defaults_are_those_of_the_library() {
        let command = super::Args::augment_args(clap::Command::new("surface"));
        let matches = command.get_matches_from(["surface", "points.csv"]);
        let args = super::Args::from_arg_matches(&matches).unwrap();
        assert_eq!(args.options(), taut::SurfaceOptions::default());
    }
}
