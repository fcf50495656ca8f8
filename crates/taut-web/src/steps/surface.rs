//! The labels behind a surface: facets of the triangulation are obeyed, the surest first, until each cell is inside or outside.

use std::collections::BTreeSet;

use serde_json::Value;
use taut::Monitor;
use taut::certify::SurfaceMethod as Kind;
use taut::reconstruct::{LabelBorder, LabelTrace, label_trace};
use taut_draw::{
    Axis, Figure, Layer3, LineStyle, Point3, Projection, Scene3, Shading, Shape3, Surface3, Tone,
};
use taut_report::numbers::{count, counted};

use super::{Trace, said};
use crate::input::Opened;
use crate::options::Options;

/// Most points, so that a step takes no longer than a blink.
const POINTS_MAX: u64 = 10_000;

/// Steps between no label and all.
const STAGES: usize = 40;

/// Up to this many triangles each has a shade of its own, so that it can be told from the next.
const FLAT_TRIANGLES_MAX: usize = 4000;

/// The steps: no facet obeyed, some more each time, and the surface after repairs.
#[derive(Debug)]
pub(super) struct Labeling {
    trace: LabelTrace,
    /// The places of the facets that are obeyed.
    obeyed: Vec<usize>,
    /// For each stage, how many of them.
    stages: Vec<usize>,
    names: Vec<String>,
}

impl Labeling {
    pub(super) fn new(points: &Opened, options: &Options) -> Result<Self, String> {
        let rows = points.source().len();
        if rows > POINTS_MAX {
            let (rows, most) = (count(rows), count(POINTS_MAX));
            return Err(format!("the steps are shown for at most {most} points, not for {rows}"));
        }
        if options.choice::<Kind>("method")? != Kind::Tree
            || options.flag("open")
            || options.flag("denoise")
        {
            return Err("the steps are shown for the method tree without options".to_owned());
        }
        let trace = label_trace(points.source(), &Monitor::silent())
            .map_err(|error| points.explain(error))?;
        let places = trace.facets.iter().enumerate();
        let obeyed: Vec<usize> =
            places.filter(|(_, facet)| facet.is_obeyed).map(|(place, _)| place).collect();
        let stages = stages(&trace, &obeyed);
        Ok(Labeling { trace, obeyed, stages, names: points.columns(3) })
    }

    fn is_last(&self, step: usize) -> bool {
        step == STAGES + 1
    }

    /// The number of facets obeyed up to a step.
    fn obeyed(&self, step: usize) -> usize {
        self.stages[step.min(STAGES)]
    }

    fn border(&self, step: usize) -> Result<LabelBorder, String> {
        if step >= self.count() {
            return Err("there is no such step".to_owned());
        }
        let processed = match self.obeyed(step) {
            0 => 0,
            obeyed => self.obeyed[obeyed - 1] + 1,
        };
        Ok(self.trace.border(processed))
    }

    /// Says what changes between the labels of the tree and the surface.
    fn repairs(&self, border: &LabelBorder) -> String {
        let set = |triangles: &[[u32; 3]]| -> BTreeSet<[u32; 3]> {
            let sorted = |&[a, b, c]: &[u32; 3]| {
                let mut triangle = [a, b, c];
                triangle.sort_unstable();
                triangle
            };
            triangles.iter().map(sorted).collect()
        };
        let (before, after) = (set(&border.triangles), set(&self.trace.triangles));
        let gone = before.difference(&after).count();
        let new = after.difference(&before).count();
        match (gone, new) {
            (0, 0) => "No cell had to be turned over.".to_owned(),
            _ => format!(
                "Cells that the facets around them object to are turned over, and those where the border is no surface: {} go, {} come.",
                counted(gone as u64, "triangle"),
                count(new as u64)
            ),
        }
    }
}

/// Returns how many facets are obeyed at each stage. The surest are within one side, so a stage counts those that tell opposite sides as much
/// as all.
fn stages(trace: &LabelTrace, obeyed: &[usize]) -> Vec<usize> {
    let is_opposite = |&place: &usize| trace.facets[place].evidence < 0.0;
    let opposites = obeyed.iter().filter(|place| is_opposite(place)).count() as u64;
    let all = obeyed.len() as u64;
    let (mut passed, mut stages) = (0, vec![0]);
    for (k, place) in obeyed.iter().enumerate() {
        passed += u64::from(is_opposite(place));
        // Twice the part of the way, times both counts.
        let way = (k as u64 + 1) * opposites.max(1) + passed * all;
        let whole = all * (opposites.max(1) + opposites);
        while stages.len() as u64 * whole <= way * STAGES as u64 && stages.len() <= STAGES {
            stages.push(k + 1);
        }
    }
    stages.resize(STAGES + 1, obeyed.len());
    stages
}

impl Trace for Labeling {
    fn count(&self) -> usize {
        STAGES + 2
    }

    fn words(&self, step: usize) -> Result<Value, String> {
        let border = self.border(step)?;
        let triangles = counted(border.triangles.len() as u64, "triangle");
        if self.is_last(step) {
            let found = counted(self.trace.triangles.len() as u64, "triangle");
            return Ok(said(format!("The surface: {found}"), self.repairs(&border)));
        }
        let obeyed = self.obeyed(step);
        let title = format!(
            "{} of {} obeyed",
            count(obeyed as u64),
            counted(self.obeyed.len() as u64, "facet")
        );
        let text = match obeyed {
            0 => format!(
                "The triangulation of {} has {}, and the outside of its hull is one more. How the spheres of two neighbors meet says \
                 whether the surface is between them, and how surely.",
                counted(self.trace.sites.len() as u64, "point"),
                counted(self.trace.cells as u64 - 1, "cell")
            ),
            _ => {
                let last = &self.trace.facets[self.obeyed[obeyed - 1]];
                let side = if last.evidence < 0.0 { "opposite sides" } else { "one side" };
                let rest = match border.parts {
                    1 => "All cells are labeled".to_owned(),
                    parts => format!("{} parts are left", count(parts as u64)),
                };
                let undecided = match border.undecided.len() as u64 {
                    0 => String::new(),
                    some => {
                        format!(", {} have both sides in parts not yet joined to it", count(some))
                    }
                };
                format!(
                    "The last one puts its cells on {side} with a weight of {:.3}. {rest}. {triangles} separate the outside from the \
                     inside{undecided}.",
                    last.evidence.abs()
                )
            }
        };
        Ok(said(title, text))
    }

    fn figure(&self, step: usize) -> Result<Figure, String> {
        let border = self.border(step)?;
        let shape = |triangles: &[[u32; 3]], back: Tone| {
            let is_few = triangles.len() <= FLAT_TRIANGLES_MAX;
            Shape3::Surface(Surface3 {
                vertices: self.trace.sites.clone(),
                triangles: triangles.to_vec(),
                back,
                shading: if is_few { Shading::Flat } else { Shading::Smooth },
            })
        };
        let triangles = if self.is_last(step) { &self.trace.triangles } else { &border.triangles };
        let layer = |name: &str, tone: Tone, shape: Shape3| {
            let line_style = LineStyle::Solid;
            Layer3 { name: name.to_owned(), tone, line_style, shape }
        };
        let place = |(site, &at): (usize, &[f64; 3])| Point3 {
            id: Some(site as u64),
            at,
            size: 1.2,
            label: String::new(),
        };
        let places = self.trace.sites.iter().enumerate().map(place).collect();
        let mut layers = vec![layer("points", Tone::Point, Shape3::Points(places))];
        if !border.undecided.is_empty() && !self.is_last(step) {
            let shape = shape(&border.undecided, Tone::Muted);
            layers.push(layer("undecided", Tone::Muted, shape));
        }
        if !triangles.is_empty() {
            layers.push(layer("outside from inside", Tone::Answer, shape(triangles, Tone::Second)));
        }
        let axis = |k: usize| {
            let usual = ["x", "y", "z"][k].to_owned();
            Axis::named(self.names.get(k).cloned().unwrap_or(usual))
        };
        Ok(Figure::Space(Scene3 {
            title: String::new(),
            caption: String::new(),
            axes: [0, 1, 2].map(axis),
            layers,
            projection: Projection::Perspective,
            azimuth: 35.0,
            elevation: 22.0,
            width: 720.0,
            height: 560.0,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_grow_until_one_part_is_left() {
        let sphere: String = (0..200)
            .map(|i| {
                let (z, turn) = ((f64::from(i) + 0.5) / 100.0 - 1.0, 2.399_963 * f64::from(i));
                let r = (1.0 - z * z).sqrt();
                format!("{} {} {z}\n", r * turn.cos(), r * turn.sin())
            })
            .collect();
        let points = Opened::read(sphere.into_bytes(), "sphere.xyz").unwrap();
        let steps = Labeling::new(&points, &Options::default()).unwrap();
        let parts: Vec<usize> =
            (0..steps.count()).map(|step| steps.border(step).unwrap().parts).collect();
        assert!(parts.is_sorted_by(|a, b| a >= b) && parts[0] == steps.trace.cells);
        assert_eq!(parts[STAGES..], [1, 1]);
        assert!(steps.stages.is_sorted() && steps.stages[STAGES] == steps.trace.cells - 1);
        // A closed surface of all points, with the topology of the sphere.
        assert_eq!(steps.border(STAGES).unwrap().triangles.len(), 2 * 200 - 4);
        for step in 0..steps.count() {
            steps.words(step).unwrap();
            steps.figure(step).unwrap();
        }
        assert!(steps.words(steps.count()).is_err() && steps.figure(steps.count()).is_err());
        let other = Options::parse(r#"{"method":"hull"}"#).unwrap();
        assert!(Labeling::new(&points, &other).unwrap_err().contains("method tree"));
        let usual = Options::parse(r#"{"method":"tree"}"#).unwrap();
        assert!(Labeling::new(&points, &usual).is_ok());
    }
}
