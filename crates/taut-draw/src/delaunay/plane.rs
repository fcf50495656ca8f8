//! Scenes of a triangulation in the plane.

use super::clip::Frame;
use super::{Picture, dot_size};
use crate::number::{count, counted};
use crate::{Layer2, LineStyle, Point2, Scene2, Shape2, Tone};

/// Up to this many, edges of the Voronoi diagram are drawn bold.
const BOLD_EDGES_MAX: usize = 600;

impl Picture<'_> {
    /// The triangulation, a window of it where it is crowded, and the Voronoi diagram.
    pub(super) fn in_plane(&self) -> Vec<Scene2> {
        let window = self.window();
        let mut scenes = vec![self.whole(window.as_ref())];
        if let Some(frame) = &window {
            let (layers, said) = self.part(frame);
            let said = format!("The window of the picture before, with {said}.");
            scenes.push(self.scene(format!("{}: a window", self.title()), said, layers));
        }
        if window.is_some() || !self.is_crowded() {
            scenes.extend(self.diagram(window.as_ref()));
        }
        scenes
    }

    fn scene(&self, title: String, caption: String, layers: Vec<Layer2>) -> Scene2 {
        Scene2::plane(title, caption, layers, self.options)
    }

    fn at(&self, id: u32) -> [f64; 2] {
        let [x, y, _] = self.places[id as usize];
        [x, y]
    }

    /// All of it: edges as far as there is room for them, the hull, the points.
    fn whole(&self, window: Option<&Frame>) -> Scene2 {
        let drawn = self.sample();
        let all = drawn.len() == self.places.len();
        let mut layers = Vec::new();
        let mut caption = self.counts();
        if all {
            let edges = self.edges(|_| true);
            let chains: Vec<_> =
                edges.iter().map(|edge| edge.map(|id| self.at(id)).to_vec()).collect();
            layers.extend(lines("edges", Tone::Answer, LineStyle::Thin, chains));
        } else {
            caption += " There are too many edges to draw them all.";
            caption += &self.sampled(drawn.len());
        }
        if self.answer().hull_dimension == Some(2) {
            let edge = |edge: &[u32]| edge.iter().map(|&id| self.at(id)).collect();
            let chains = self.answer().hull.chunks_exact(2).map(edge).collect();
            layers.extend(lines("convex hull", Tone::Answer, LineStyle::Solid, chains));
        }
        layers.extend(self.points(&drawn));
        if let Some(frame) = window {
            caption += " The frame is the window of the next picture.";
            let shape = Shape2::Polygons(vec![frame.corners().to_vec()]);
            let name = "window".to_owned();
            layers.push(Layer2 { name, tone: Tone::Support, line_style: LineStyle::Solid, shape });
        }
        self.scene(self.title(), caption, layers)
    }

    /// Returns what is in a window, and the words for it.
    fn part(&self, frame: &Frame) -> (Vec<Layer2>, String) {
        let holds = |&id: &u32| frame.holds(self.at(id));
        let edges = self.edges(|simplex| simplex.iter().any(holds));
        let chains: Vec<_> = edges
            .iter()
            .filter_map(|edge| frame.segment(self.at(edge[0]), self.at(edge[1])))
            .map(|ends| ends.to_vec())
            .collect();
        let ids = self.within(frame);
        let noun = if self.answer().duplicates.is_empty() { "point" } else { "distinct point" };
        let said = format!(
            "{} and {} as they are",
            counted(ids.len() as u64, noun),
            counted(chains.len() as u64, "edge")
        );
        let mut layers: Vec<Layer2> =
            lines("edges", Tone::Answer, LineStyle::Thin, chains).collect();
        layers.extend(self.points(&ids));
        (layers, said)
    }

    /// The Voronoi diagram, of all points or of a window.
    fn diagram(&self, window: Option<&Frame>) -> Option<Scene2> {
        let frame = window.copied().unwrap_or_else(|| self.frame());
        let cells = self.voronoi(&frame)?;
        let wanted = |simplex: &[u32]| {
            window.is_none_or(|frame| simplex.iter().any(|&id| frame.holds(self.at(id))))
        };
        let chains = self
            .edges(wanted)
            .iter()
            .filter_map(|edge| frame.segment(self.at(edge[0]), self.at(edge[1])))
            .map(|ends| ends.to_vec())
            .collect();
        let line_style =
            if cells.len() <= BOLD_EDGES_MAX { LineStyle::Solid } else { LineStyle::Thin };
        let ids = self.within(&frame);
        let mut caption = format!(
            "Each Voronoi cell holds what is nearer to its point than to any other; cells that share an edge \
             belong to points that share one. {} of the diagram are drawn.",
            match cells.len() {
                1 => "1 edge".to_owned(),
                more => format!("{} edges", count(more as u64)),
            }
        );
        if window.is_some() {
            caption += " This is the window of the pictures before.";
        }
        let mut layers: Vec<Layer2> =
            lines("Delaunay edges", Tone::Muted, LineStyle::Thin, chains).collect();
        layers.extend(lines("Voronoi diagram", Tone::Second, line_style, cells));
        layers.extend(self.points(&ids));
        let title = self.title().replacen("Delaunay triangulation", "Voronoi diagram", 1);
        Some(self.scene(title, caption, layers))
    }

    fn points(&self, ids: &[u32]) -> Option<Layer2> {
        let size = dot_size(ids.len());
        let point =
            |&id: &u32| Point2 { id: Some(id.into()), at: self.at(id), size, label: String::new() };
        (!ids.is_empty()).then(|| Layer2 {
            name: "points".into(),
            tone: Tone::Ink,
            line_style: LineStyle::Solid,
            shape: Shape2::Points(ids.iter().map(point).collect()),
        })
    }
}

/// A layer of lines, if there are any.
fn lines(
    name: &str,
    tone: Tone,
    line_style: LineStyle,
    chains: Vec<Vec<[f64; 2]>>,
) -> impl Iterator<Item = Layer2> {
    let layer =
        Layer2 { name: name.to_owned(), tone, line_style, shape: Shape2::Polylines(chains) };
    let some = matches!(&layer.shape, Shape2::Polylines(chains) if !chains.is_empty());
    some.then_some(layer).into_iter()
}
