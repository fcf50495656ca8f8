//! The tools of the page: for each its main options and its solver.

mod ball;
pub(crate) mod centers;
mod curve;
mod delaunay;
mod ellipsoid;
mod surface;

use serde_json::{Value, json};
use taut::certify::Answer;
use taut::points::Choice;
use taut::{Monitor, PointSource, Solution};

use crate::input::Opened;
use crate::options::Options;
use crate::shape::Shape;

/// A tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tool {
    Ball,
    Ellipsoid,
    Centers,
    Delaunay,
    Curve,
    Surface,
}

taut::points::choice! { "tool", Tool {
    Ball = "ball", "the smallest ball around points";
    Ellipsoid = "ellipsoid", "the ellipsoid of least volume around points";
    Centers = "centers", "k centers: minimize the largest distance to the nearest center";
    Delaunay = "delaunay", "the Delaunay triangulation of points in the plane or in space";
    Curve = "curve", "the curves that points of the plane were sampled from";
    Surface = "surface", "the surface that points of space were sampled from";
}}

impl Tool {
    /// Finds the shape of this tool.
    pub(crate) fn solve(
        self,
        points: &Opened,
        options: &Options,
        monitor: &Monitor<'_>,
    ) -> Result<Box<dyn Shape>, String> {
        match self {
            Tool::Ball => ball::solve(points, options, monitor),
            Tool::Ellipsoid => ellipsoid::solve(points, options, monitor),
            Tool::Centers => centers::solve(points, options, monitor),
            Tool::Delaunay => delaunay::solve(points, options, monitor),
            Tool::Curve => curve::solve(points, options, monitor),
            Tool::Surface => surface::solve(points, options, monitor),
        }
    }

    /// Describes the options of this tool.
    fn options(self) -> Vec<Value> {
        match self {
            Tool::Ball => ball::options(),
            Tool::Ellipsoid => ellipsoid::options(),
            Tool::Centers => centers::options(),
            Tool::Delaunay => delaunay::options(),
            Tool::Curve => curve::options(),
            Tool::Surface => surface::options(),
        }
    }

    /// Tests whether the algorithm of this tool can be stepped through.
    fn has_steps(self) -> bool {
        matches!(self, Tool::Ball | Tool::Centers | Tool::Delaunay | Tool::Surface)
    }

    /// Returns the extensions of the files that a shape of this tool can be written as, beside JSON.
    fn files(self) -> &'static [&'static str] {
        match self {
            Tool::Ball | Tool::Ellipsoid | Tool::Centers => &[],
            Tool::Delaunay => &["ply", "obj", "off", "vtu"],
            Tool::Curve => &["csv", "geojson"],
            Tool::Surface => &["ply", "obj", "off", "stl", "glb"],
        }
    }
}

/// Refuses to write a shape that has no file but its JSON.
fn no_file<A: Answer>(_: &Solution<A>, _: &dyn PointSource, name: &str) -> Result<Vec<u8>, String> {
    Err(format!("{name}: this shape has no file but its JSON"))
}

/// Describes all tools to the page.
pub(crate) fn schema() -> Value {
    let of = |&(name, tool, help): &(&str, Tool, &str)| {
        let (options, files) = (tool.options(), tool.files());
        let steps = tool.has_steps();
        json!({ "name": name, "help": help, "options": options, "files": files, "steps": steps })
    };
    Tool::CHOICES.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

    /// Solves and checks one sample with one tool.
    fn checked(tool: Tool, points: &Opened, options: &str) -> (Box<dyn Shape>, Value) {
        let options = Options::parse(options).unwrap();
        let mut shape = tool.solve(points, &options, &Monitor::silent()).unwrap();
        let said = shape.check(points, &Monitor::silent()).unwrap();
        (shape, said)
    }

    fn few() -> Opened {
        samples::generate("few").unwrap()
    }

    #[test]
    fn each_tool_is_described_with_its_usual_options() {
        let all = schema();
        assert_eq!(all.as_array().unwrap().len(), Tool::ALL.len());
        for tool in all.as_array().unwrap() {
            for option in tool["options"].as_array().unwrap() {
                assert!(!option["help"].as_str().unwrap().is_empty(), "{option}");
            }
        }
    }

    #[test]
    fn tools_of_the_plane_are_verified_in_the_words_of_the_command() {
        for (tool, words) in [
            (Tool::Ball, "ball of radius"),
            (Tool::Ellipsoid, "ellipsoid"),
            (Tool::Centers, "centers"),
            (Tool::Delaunay, "the Delaunay triangulation of 60 points in the plane"),
        ] {
            let (shape, said) = checked(tool, &few(), "{}");
            assert_eq!(said["verified"], true);
            let verdict = said["verdict"].as_str().unwrap();
            assert!(verdict.starts_with("Verified") && verdict.contains(words), "{verdict}");
            assert!(shape.picture(&few()).unwrap().contains("<svg"));
            assert!(taut::AnySolution::from_json(&shape.json()).is_ok());
        }
    }

    #[test]
    fn curves_and_surfaces_are_written_as_files() {
        let ring: String = (0..40)
            .map(|i| std::f64::consts::TAU * f64::from(i) / 40.0)
            .map(|t| format!("{},{}\n", t.cos(), t.sin()))
            .collect();
        let ring = Opened::read(ring.into_bytes(), "ring.csv").unwrap();
        let (shape, said) = checked(Tool::Curve, &ring, "{}");
        assert_eq!(said["verified"], true);
        assert!(shape.file(&ring, "curve.geojson").unwrap().starts_with(b"{"));

        let cube: String =
            (0..8).map(|i| format!("{} {} {}\n", i & 1, i >> 1 & 1, i >> 2)).collect();
        let cube = Opened::read(cube.into_bytes(), "cube.xyz").unwrap();
        let (shape, said) = checked(Tool::Surface, &cube, r#"{"method":"hull"}"#);
        assert_eq!(said["verified"], true);
        assert!(shape.file(&cube, "cube.ply").unwrap().starts_with(b"ply"));
        let (shape, _) = checked(Tool::Delaunay, &cube, "{}");
        assert!(shape.file(&cube, "cube.obj").is_err() || shape.file(&cube, "cube.vtu").is_ok());
        assert!(shape.file(&cube, "cube.csv").is_err());
    }

    #[test]
    fn wrong_options_are_named() {
        let wrong = Options::parse(r#"{"epsilon":"2"}"#).unwrap();
        let error = Tool::Ball.solve(&few(), &wrong, &Monitor::silent()).unwrap_err();
        assert!(error.contains("`epsilon` is 2"), "{error}");
    }
}
