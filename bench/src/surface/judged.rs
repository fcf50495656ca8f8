//! A surface through points, judged by its triangles alone: the same for taut and its peers.

use super::*;
use taut_mesh::topology;

/// What triangles on points are as a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Judged {
    /// Parts that hang together by edges.
    pub(super) components: usize,
    /// Handles of all parts together; `None` if one is no surface with two sides.
    pub(super) genus: Option<u64>,
    /// Boundary loops.
    pub(super) loops: usize,
    /// Edges of more than two triangles, and those along which two run in the same direction.
    pub(super) bad_edges: usize,
    /// Vertices with more than one fan.
    pub(super) bad_vertices: usize,
    /// Places of points that no triangle uses.
    pub(super) unused: usize,
    /// Vertices − edges + triangles.
    pub(super) euler: i64,
}

impl Judged {
    /// Judges triangles on points.
    pub(super) fn of(points: &[Point], triangles: &[[u32; 3]]) -> Result<Self> {
        let mesh = TriangleMesh::new(points, triangles)?;
        let found = topology(&mesh);
        // 0 and −0 are one place.
        let place = |point: Point| point.map(|x| (x + 0.0).to_bits());
        let count = |mut places: Vec<[u64; 3]>| {
            places.sort_unstable();
            places.dedup();
            places.len()
        };
        let all = count(points.iter().map(|&point| place(point)).collect());
        let corners = triangles.as_flattened().iter();
        let used = count(corners.map(|&row| place(points[row as usize])).collect());
        ensure!(used <= all, "more places are used than there are");
        Ok(Self {
            components: found.components.len(),
            genus: found.genus,
            loops: found.boundary_loops.len(),
            bad_edges: found.non_manifold_edges + found.inconsistent_edges,
            bad_vertices: found.non_manifold_vertices,
            unused: all - used,
            euler: found.euler_characteristic,
        })
    }

    /// Whether it is a closed surface of so many parts and handles, through all points.
    pub(super) fn is_exact(&self, components: usize, genus: u64) -> bool {
        let is_closed = self.loops == 0 && self.bad_edges == 0 && self.bad_vertices == 0;
        is_closed && self.unused == 0 && (self.components, self.genus) == (components, Some(genus))
    }

    /// Components, genus and loops in words.
    pub(super) fn shape(&self) -> String {
        let genus = self.genus.map_or("–".to_owned(), |genus| genus.to_string());
        format!("{}/{genus}/{}", self.components, self.loops)
    }

    /// Columns of [`Self::cells`].
    pub(super) const COLUMNS: &'static str =
        "components | genus | loops | bad edges | bad vertices | unused";

    /// For a table.
    pub(super) fn cells(&self) -> Value {
        json!({
            "components": self.components, "genus": self.genus, "loops": self.loops,
            "bad edges": self.bad_edges, "bad vertices": self.bad_vertices, "unused": self.unused,
            "χ": self.euler,
        })
    }

    /// The same as counters of a process of its own; the genus is missing where there is none.
    pub(super) fn counters(&self) -> Vec<(&'static str, u64)> {
        let cells = self.cells();
        let names = Judged::COLUMNS.split(" | ");
        names.filter_map(|name| Some((name, cells[name].as_u64()?))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_closed_through_all_is_exact() {
        let mut points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let sides = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        assert!(Judged::of(&points, &sides).unwrap().is_exact(1, 0));
        assert!(!Judged::of(&points, &sides).unwrap().is_exact(1, 1));
        assert!(!Judged::of(&points, &sides[1..]).unwrap().is_exact(1, 0));
        assert!(
            !Judged::of(&points, &[[2, 0, 1], sides[1], sides[2], sides[3]])
                .unwrap()
                .is_exact(1, 0)
        );
        points.push([-0.0, 0.0, 0.0]);
        assert!(Judged::of(&points, &sides).unwrap().is_exact(1, 0), "a duplicate");
        points.push([2.0; 3]);
        assert_eq!(Judged::of(&points, &sides).unwrap().unused, 1);
    }
}
