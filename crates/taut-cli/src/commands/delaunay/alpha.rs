//! The part of a triangulation that an eraser of a given radius leaves.

use std::path::{Path, PathBuf};

use taut::delaunay::{Plane, Space};
use taut::{Monitor, PointSource};
use taut_io::{MeshOptions, MeshView, mesh_file};

use super::built::Built;
use crate::output::numbers::{count, exact};
use crate::output::writing::Outputs;
use crate::reports::Field;

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Alpha complex")]
pub(super) struct Alpha {
    /// Count what has a circumradius of at most RADIUS, a length, and write it with the two options below
    #[arg(long = "alpha", value_name = "RADIUS", value_parser = length, allow_negative_numbers = true)]
    radius: Option<f64>,
    /// Write the simplices of the alpha complex as a mesh
    #[arg(long, value_name = "FILE", requires = "radius")]
    alpha_out: Option<PathBuf>,
    /// Write its boundary as a mesh: facets with one of these simplices on one side
    #[arg(long, value_name = "FILE", requires = "radius")]
    alpha_boundary: Option<PathBuf>,
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(radius) if radius >= 0.0 => Ok(radius),
        _ => Err("expected a length, at least 0".into()),
    }
}

impl Alpha {
    /// The radius, where an alpha complex is asked for.
    pub(super) fn radius(&self) -> Option<f64> {
        self.radius
    }

    pub(super) fn simplices_file(&self) -> Option<&Path> {
        self.alpha_out.as_deref()
    }

    pub(super) fn boundary_file(&self) -> Option<&Path> {
        self.alpha_boundary.as_deref()
    }

    pub(super) fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.alpha_out.iter().chain(&self.alpha_boundary)
    }

    pub(super) fn complex(&self, built: &Built) -> Option<Complex> {
        let radius = self.radius?;
        Some(match built {
            Built::Plane(plane) => Complex::of_plane(plane, radius),
            Built::Space(space) => Complex::of_space(space, radius),
        })
    }
}

/// An alpha complex in rows of the input.
pub(super) struct Complex {
    radius: f64,
    /// Vertices of a simplex; a facet has one less.
    width: usize,
    simplices: Vec<u32>,
    boundary: Vec<u32>,
    singular: usize,
}

impl Complex {
    fn of_plane(plane: &Plane, radius: f64) -> Self {
        let complex = plane.alpha_complex(radius);
        let rows = |sites: &[u32]| sites.iter().map(|&site| plane.row(site)).collect::<Vec<_>>();
        Complex {
            radius,
            width: 3,
            simplices: complex.simplices.iter().flat_map(|&t| rows(&plane.vertices(t))).collect(),
            boundary: complex.boundary.iter().flat_map(|facet| rows(facet)).collect(),
            singular: complex.singular.len(),
        }
    }

    fn of_space(space: &Space, radius: f64) -> Self {
        let complex = space.alpha_complex(radius);
        let rows = |sites: &[u32]| sites.iter().map(|&site| space.row(site)).collect::<Vec<_>>();
        Complex {
            radius,
            width: 4,
            simplices: complex.simplices.iter().flat_map(|&t| rows(&space.vertices(t))).collect(),
            boundary: complex.boundary.iter().flat_map(|facet| rows(facet)).collect(),
            singular: complex.singular.len(),
        }
    }

    pub(super) fn field(&self) -> Field {
        let simplices = (self.simplices.len() / self.width) as u64;
        let boundary = (self.boundary.len() / (self.width - 1)) as u64;
        let names = if self.width == 3 { "triangles" } else { "tetrahedra" };
        field(self.radius, names, [simplices, boundary, self.singular as u64])
    }

    pub(super) fn write(
        &self,
        outputs: &mut Outputs,
        to: &Alpha,
        points: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> anyhow::Result<()> {
        let files = [
            (&to.alpha_out, &self.simplices, self.width),
            (&to.alpha_boundary, &self.boundary, self.width - 1),
        ];
        for (path, simplices, width) in files {
            if let Some(path) = path {
                let mesh = MeshView::on_points(points, simplices, width);
                outputs.hold(mesh_file(&mesh, path, &MeshOptions::default(), monitor)?);
            }
        }
        Ok(())
    }
}

/// What is said of a complex of so many simplices, facets on their boundary, and facets on their own.
pub(super) fn field(radius: f64, names: &str, [simplices, boundary, singular]: [u64; 3]) -> Field {
    Field::new("alpha", format!("{} {names} of radius at most {}", count(simplices), exact(radius)))
        .remark(format!(
            "{} facets on their boundary, {} more on their own",
            count(boundary),
            count(singular)
        ))
}
