//! The samples of the page: files beside it, and points that are calculated by a formula.

use serde_json::{Value, json};
use taut::PointSource;
use taut::points::generate::Parameters;
use taut::points::generate::curves::{CurveNoise, CurveSource, TestCurve};
use taut::points::{Distribution, GeneratedSource, OwnedPoints, ScalarKind, Scratch};

use crate::input::Opened;

/// A sample: its name in the address of the page, its words, and the tools that it shows best.
struct Sample {
    name: &'static str,
    title: &'static str,
    tools: &'static [&'static str],
    points: Points,
}

/// Where the points of a sample come from.
enum Points {
    /// A file beside the page.
    File(&'static str),
    /// So many points in a number of dimensions, as `taut generate` makes them.
    Drawn(&'static str, u64, usize, u64),
    /// So many points near a curve, as `taut generate curve` makes them.
    Curve(&'static str, u64),
}

const SAMPLES: &[Sample] = &[
    Sample {
        name: "clouds",
        title: "Five clouds: 1000 points of the plane",
        tools: &["ball", "ellipsoid", "centers", "delaunay"],
        points: Points::File("clouds.csv"),
    },
    Sample {
        name: "few",
        title: "60 points of the plane, to step through",
        tools: &["delaunay", "ball"],
        points: Points::Drawn("uniform", 60, 2, 4),
    },
    Sample {
        name: "normal-64",
        title: "1000 normal points in 64 dimensions",
        tools: &["ball"],
        points: Points::Drawn("normal", 1000, 64, 0),
    },
    Sample {
        name: "iris",
        title: "150 irises: four lengths of each",
        tools: &["ellipsoid", "ball"],
        points: Points::File("iris.csv"),
    },
    Sample {
        name: "europe",
        title: "432 cities of Europe, in kilometers",
        tools: &["centers", "delaunay"],
        points: Points::File("europe.csv"),
    },
    Sample {
        name: "plane-100000",
        title: "100,000 points of a square",
        tools: &["delaunay"],
        points: Points::Drawn("uniform", 100_000, 2, 1),
    },
    Sample {
        name: "space-5000",
        title: "5000 points of a cube",
        tools: &["delaunay"],
        points: Points::Drawn("uniform", 5000, 3, 1),
    },
    Sample {
        name: "loops",
        title: "1068 noisy points near four curves",
        tools: &["curve"],
        points: Points::File("loops.csv"),
    },
    Sample {
        name: "gear-10000",
        title: "10,000 noisy points near a ring with teeth",
        tools: &["curve"],
        points: Points::Curve("gear20", 10_000),
    },
    Sample {
        name: "knot",
        title: "A knotted tube: 2000 points of space",
        tools: &["surface", "ball", "ellipsoid"],
        points: Points::File("knot.xyz"),
    },
    Sample {
        name: "torus-36000",
        title: "A torus: 36,000 points of space",
        tools: &["surface"],
        points: Points::Drawn("torus", 36_000, 3, 1),
    },
];

/// Describes the samples to the page.
pub(crate) fn schema() -> Value {
    let of = |sample: &Sample| {
        let file = match sample.points {
            Points::File(file) => Some(file),
            Points::Drawn(..) | Points::Curve(..) => None,
        };
        json!({ "name": sample.name, "title": sample.title, "tools": sample.tools, "file": file })
    };
    SAMPLES.iter().map(of).collect()
}

/// Makes the points of a sample that is no file.
pub(crate) fn generate(name: &str) -> Result<Opened, String> {
    let sample = SAMPLES.iter().find(|sample| sample.name == name);
    let sample = sample.ok_or_else(|| format!("there is no sample {name}"))?;
    let made = match sample.points {
        Points::File(file) => return Err(format!("the sample {name} is the file {file}")),
        Points::Drawn(distribution, n, dim, seed) => drawn(distribution, n, dim, seed),
        Points::Curve(shape, n) => near_curve(shape, n),
    };
    Ok(Opened::made(made.map_err(|error| error.to_string())?, name))
}

fn drawn(
    name: &str,
    n: u64,
    dim: usize,
    seed: u64,
) -> Result<Box<dyn PointSource>, taut::points::Error> {
    let distribution = Distribution::named(name, n, dim, &Parameters::default())?;
    held(&GeneratedSource::new(distribution, n, dim, seed, ScalarKind::F64)?)
}

fn near_curve(shape: &str, n: u64) -> Result<Box<dyn PointSource>, taut::points::Error> {
    let curve = TestCurve::named(shape).expect("a sample names a curve there is");
    // As `taut generate curve` has it where nothing is said.
    let noise = CurveNoise { delta: 0.05, outliers: 0.0, ..CurveNoise::default() };
    held(&CurveSource::new(curve.build(), n, noise, 0, ScalarKind::F64)?)
}

/// The points of a source in memory, so that no pass draws them again.
fn held(source: &dyn PointSource) -> Result<Box<dyn PointSource>, taut::points::Error> {
    let mut scratch = Scratch::new();
    let rows = source.read(0..source.len(), &mut scratch).expect("a formula can be read");
    let mut values = vec![0.0; rows.len() * source.dim()];
    for (i, row) in values.chunks_exact_mut(source.dim()).enumerate() {
        rows.copy_row(i, row);
    }
    Ok(Box::new(OwnedPoints::new(values, source.dim())?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_made_or_are_files_of_the_tour() {
        for sample in SAMPLES {
            match sample.points {
                Points::File(file) => {
                    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../taut-cli/samples");
                    assert!(std::path::Path::new(folder).join(file).exists(), "{file}");
                    assert!(generate(sample.name).is_err());
                }
                Points::Drawn(_, n, dim, _) => {
                    let made = generate(sample.name).unwrap();
                    assert_eq!((made.source().len(), made.source().dim()), (n, dim));
                }
                Points::Curve(_, n) => {
                    assert_eq!(generate(sample.name).unwrap().source().len(), n);
                }
            }
        }
        assert!(generate("none").is_err());
    }
}
