//! The scene of a triangulation in space.

use super::{Picture, dot_size};
use crate::number::count;
use crate::{Layer3, LineStyle, Mesh3, Point3, Scene3, Shape3, Tone};

/// Up to this many edges can be looked through.
const SEEN_THROUGH_EDGES_MAX: usize = 4000;

/// Facets of a surface for each point that may be drawn: a surface has about two.
const FACETS_PER_POINT: usize = 2;

impl Picture<'_> {
    /// The hull as a surface, or the triangles of a plane; the edges within, if they are few; the points.
    pub(super) fn in_space(&self) -> Scene3 {
        let answer = self.answer();
        let mut caption = self.counts();
        let mut layers = Vec::new();
        let (name, triangles) = match answer.hull_dimension {
            Some(2) => ("triangles", &answer.simplices),
            Some(3) => ("convex hull", &answer.hull),
            _ => ("", &Vec::new()),
        };
        let facets = triangles.len() / 3;
        if facets > FACETS_PER_POINT.saturating_mul(self.options.max_points) {
            caption += &format!(
                " The {} triangles of the {name} are too many to draw.",
                count(facets as u64)
            );
        } else if facets > 0 {
            layers.push(Layer3 {
                name: name.into(),
                tone: Tone::Answer,
                line_style: LineStyle::Filled,
                shape: Shape3::Mesh(self.surface(triangles)),
            });
        }
        // A point has at least one edge, and few points have thousands: so much is cheap to find out.
        let edges = match answer.len() <= SEEN_THROUGH_EDGES_MAX {
            true => self.edges(|_| true),
            false => Vec::new(),
        };
        if (1..=SEEN_THROUGH_EDGES_MAX).contains(&edges.len()) {
            layers.push(Layer3 {
                name: "edges".into(),
                tone: Tone::Second,
                line_style: LineStyle::Thin,
                shape: Shape3::Polylines(
                    edges
                        .iter()
                        .map(|edge| edge.map(|id| self.places[id as usize]).to_vec())
                        .collect(),
                ),
            });
        } else if answer.hull_dimension.is_some_and(|dimension| dimension > 0) {
            caption += " The edges within are too many to see through, and are not drawn.";
        }
        let ids = self.sample();
        caption += &self.sampled(ids.len());
        let size = dot_size(ids.len()).max(1.0);
        let point = |&id: &u32| Point3 {
            id: Some(id.into()),
            at: self.places[id as usize],
            size,
            label: String::new(),
        };
        if !ids.is_empty() {
            layers.push(Layer3 {
                name: "points".into(),
                tone: Tone::Point,
                line_style: LineStyle::Solid,
                shape: Shape3::Points(ids.iter().map(point).collect()),
            });
        }
        Scene3::space(self.title(), caption, layers, self.options)
    }

    /// Triangles with their own vertices alone.
    fn surface(&self, triangles: &[u32]) -> Mesh3 {
        let mut ids = triangles.to_vec();
        ids.sort_unstable();
        ids.dedup();
        let place = |id: &u32| ids.binary_search(id).unwrap_or(0);
        Mesh3 {
            vertices: ids.iter().map(|&id| self.places[id as usize]).collect(),
            triangles: triangles
                .chunks_exact(3)
                .map(|t| [place(&t[0]), place(&t[1]), place(&t[2])])
                .collect(),
        }
    }
}
