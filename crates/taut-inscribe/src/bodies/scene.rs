//! A mesh with obstacles: which triangles are of the mesh, which of a solid, and which have no inside.
//!
//! *Numbers.* The last number of a row names its surface: 0 for the mesh, 1, 2, … for solids, −1 for walls and points.
//! *Solids.* Of equal triangles one is left. Triangles with an edge of their own are taken away until there is none: what is left, and
//! hangs together by edges, is a solid if each edge belongs to an even number of its triangles, with all that it encloses. If not, it
//! is one if that holds without the triangles that come twice, as the common face of two boxes does. All others are walls.

use std::collections::{HashMap, HashSet};

use taut_points::InputError;

use super::rows::point_rows;
use crate::Error;

/// The number of walls and points.
pub(super) const WALL: i32 = -1;

/// The number of the mesh.
pub(super) const MESH: i32 = 0;

/// Numbers of a row: the corners of a triangle, and the surface that it belongs to.
const DIM: usize = 10;

/// The corners of a triangle.
type Triangle = [[f64; 3]; 3];

/// The rows of a mesh and of the obstacles in it, as [`inscribed_bodies`](crate::inscribed_bodies) reads them.
///
/// ```
/// # use taut_inscribe::{Scene, triangle_rows};
/// let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let smaller = corners.map(|corner| corner.map(|x| x / 4.0 + 0.1));
/// let mut scene = Scene::around(&triangle_rows(&corners, &faces)?)?;
/// scene.add_surface(&triangle_rows(&smaller, &faces)?)?;
/// scene.add_surface(&triangle_rows(&smaller, &faces[..1])?)?;
/// scene.add_points(&[[0.5, 0.2, 0.2]]);
/// assert_eq!((scene.solids(), scene.walls()), (1, 1));
/// assert_eq!(scene.rows().len(), 10 * (4 + 4 + 1 + 1));
/// # Ok::<(), taut_inscribe::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scene {
    rows: Vec<f64>,
    solids: u64,
    walls: u64,
}

impl Scene {
    /// A mesh without obstacles. `mesh` are rows as those of [`triangle_rows`](crate::triangle_rows).
    ///
    /// # Errors
    /// [`Error::Input`] where the numbers are not 9 for each triangle.
    pub fn around(mesh: &[f64]) -> Result<Self, Error> {
        let mut scene = Scene { rows: vec![], solids: 0, walls: 0 };
        for triangle in triangles(mesh)? {
            scene.push(triangle, MESH);
        }
        Ok(scene)
    }

    /// Adds points, which no body contains.
    pub fn add_points(&mut self, points: &[[f64; 3]]) {
        for triangle in point_rows(points).as_chunks::<3>().0.as_chunks::<3>().0 {
            self.push(triangle, WALL);
        }
    }

    /// Adds a surface, whose triangles no body meets: its closed parts are solids, which hold no body, and others are walls.
    ///
    /// O(n) expected for n triangles.
    ///
    /// # Errors
    /// [`Error::Input`] where the numbers are not 9 for each triangle.
    pub fn add_surface(&mut self, surface: &[f64]) -> Result<(), Error> {
        let parts = Parts::of(triangles(surface)?);
        for (triangle, &solid) in parts.triangles.iter().zip(&parts.solid_of) {
            self.push(triangle, solid.map_or(WALL, |solid| self.solids as i32 + solid as i32 + 1));
        }
        self.solids += u64::from(parts.solids);
        self.walls += parts.solid_of.iter().filter(|solid| solid.is_none()).count() as u64;
        Ok(())
    }

    /// How many closed surfaces there are besides the mesh.
    pub fn solids(&self) -> u64 {
        self.solids
    }

    /// How many triangles belong to no closed surface.
    pub fn walls(&self) -> u64 {
        self.walls
    }

    /// The rows, each of 10 numbers.
    pub fn rows(&self) -> &[f64] {
        &self.rows
    }

    /// The rows, each of 10 numbers.
    pub fn into_rows(self) -> Vec<f64> {
        self.rows
    }

    fn push(&mut self, triangle: &Triangle, surface: i32) {
        self.rows.reserve(DIM);
        self.rows.extend(triangle.as_flattened());
        self.rows.push(f64::from(surface));
    }
}

fn triangles(rows: &[f64]) -> Result<&[Triangle], Error> {
    let (corners, rest) = rows.as_chunks::<3>();
    let (triangles, others) = corners.as_chunks::<3>();
    if !rest.is_empty() || !others.is_empty() {
        let (dim, expected) = (rows.len(), "a multiple of 9, the corners of triangles");
        return Err(InputError::Dimension { dim, expected }.into());
    }
    Ok(triangles)
}

/// The triangles of a surface, and which of them are solids.
struct Parts {
    /// Without those that have the corners of an earlier one.
    triangles: Vec<Triangle>,
    /// For each triangle the number of its solid, from 0.
    solid_of: Vec<Option<u32>>,
    solids: u32,
}

impl Parts {
    fn of(all: &[Triangle]) -> Self {
        let mut numbers: HashMap<[u64; 3], u32> = HashMap::new();
        let mut seen: HashMap<[u32; 3], usize> = HashMap::new();
        let (mut triangles, mut vertices, mut copies) = (vec![], vec![], vec![]);
        for triangle in all {
            // −0 and 0 are one number.
            let corners = triangle.map(|corner| {
                let next = numbers.len() as u32;
                *numbers.entry(corner.map(|x| (x + 0.0).to_bits())).or_insert(next)
            });
            let mut sorted = corners;
            sorted.sort_unstable();
            let at = *seen.entry(sorted).or_insert(triangles.len());
            if at == triangles.len() {
                triangles.push(*triangle);
                vertices.push(corners);
                copies.push(0u32);
            }
            copies[at] += 1;
        }
        let count = triangles.len();
        let mut parts = Parts { triangles, solid_of: vec![None; count], solids: 0 };
        let open = parts.take(&vertices, &(0..count as u32).collect::<Vec<_>>());
        // Solids side by side have a common face, which is no face of both together.
        let odd: Vec<u32> =
            open.into_iter().filter(|&at| !copies[at as usize].is_multiple_of(2)).collect();
        parts.take(&vertices, &odd);
        parts
    }

    /// Finds the solids among some of the triangles, and returns those that hang together without an edge of their own and are none.
    fn take(&mut self, vertices: &[[u32; 3]], among: &[u32]) -> Vec<u32> {
        let mut edges: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
        for &triangle in among {
            for edge in sides(vertices[triangle as usize]) {
                edges.entry(edge).or_default().push(triangle);
            }
        }
        peel(&mut edges, vertices);
        let left: HashSet<u32> = edges.values().flatten().copied().collect();
        let (mut seen, mut open): (HashSet<u32>, Vec<u32>) = Default::default();
        for &first in among.iter().filter(|triangle| left.contains(triangle)) {
            if !seen.insert(first) {
                continue;
            }
            let (mut part, mut next, mut is_closed) = (vec![first], 0, true);
            while let Some(&triangle) = part.get(next) {
                next += 1;
                for edge in sides(vertices[triangle as usize]) {
                    let Some(at) = edges.get(&edge) else { continue };
                    is_closed &= at.len().is_multiple_of(2);
                    part.extend(at.iter().filter(|&&other| seen.insert(other)));
                }
            }
            match is_closed {
                true => {
                    part.iter().for_each(|&at| self.solid_of[at as usize] = Some(self.solids));
                    self.solids += 1;
                }
                false => open.extend(part),
            }
        }
        open
    }
}

/// Takes away triangles with an edge that no other one has, until there is none.
fn peel(edges: &mut HashMap<[u32; 2], Vec<u32>>, vertices: &[[u32; 3]]) {
    let mut free: Vec<u32> = edges.values().filter_map(|at| single(at)).collect();
    while let Some(triangle) = free.pop() {
        for edge in sides(vertices[triangle as usize]) {
            if let Some(at) = edges.get_mut(&edge) {
                at.retain(|&other| other != triangle);
                free.extend(single(at));
            }
        }
    }
}

/// The only triangle of a list.
fn single(at: &[u32]) -> Option<u32> {
    match *at {
        [triangle] => Some(triangle),
        _ => None,
    }
}

/// The edges of a triangle, without those of no length; of two that are the same none.
fn sides([a, b, c]: [u32; 3]) -> impl Iterator<Item = [u32; 2]> {
    let is_triangle = a != b && b != c && c != a;
    let ordered = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    [[a, b], [b, c], [c, a]].into_iter().filter(move |_| is_triangle).map(ordered)
}

/// What is inside of which surfaces, by the parity of crossings along a line.
#[derive(Default)]
pub(super) struct Insides(Vec<i32>);

impl Insides {
    /// Crosses a triangle of a surface.
    pub(super) fn cross(&mut self, surface: i32) {
        if surface == WALL {
            return;
        }
        match self.0.iter().position(|&other| other == surface) {
            Some(at) => {
                self.0.swap_remove(at);
            }
            None => self.0.push(surface),
        }
    }

    /// Whether the place is in the mesh and in no solid.
    pub(super) fn is_free(&self) -> bool {
        self.0 == [MESH]
    }
}

/// The parts of a line that are in the mesh and in no solid, and whether its end is in no surface: rounding may miss crossings.
/// `crossings` ascend, each with the number of its surface.
pub(super) fn free_parts(crossings: &[(f64, i32)]) -> (Vec<[f64; 2]>, bool) {
    let (mut insides, mut parts) = (Insides::default(), vec![]);
    for pair in crossings.windows(2) {
        insides.cross(pair[0].1);
        if insides.is_free() {
            parts.push([pair[0].0, pair[1].0]);
        }
    }
    if let Some(last) = crossings.last() {
        insides.cross(last.1);
    }
    (parts, insides.0.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The faces of a box.
    fn cuboid(low: [f64; 3], high: [f64; 3]) -> Vec<f64> {
        super::super::rows::box_rows(&[low, high])
    }

    fn of(surfaces: &[Vec<f64>]) -> (u64, u64) {
        let mut scene = Scene::around(&cuboid([0.0; 3], [9.0; 3])).unwrap();
        for surface in surfaces {
            scene.add_surface(surface).unwrap();
        }
        (scene.solids(), scene.walls())
    }

    #[test]
    fn solids_are_found_beside_walls() {
        let [one, other] = [cuboid([1.0; 3], [2.0; 3]), cuboid([1.5; 3], [3.0; 3])];
        let loose = vec![5.0, 5.0, 5.0, 6.0, 5.0, 5.0, 5.0, 6.0, 5.0];
        // A fin on an edge of the first box.
        let fin = vec![1.0, 1.0, 1.0, 2.0, 1.0, 1.0, 1.0, 0.0, 0.0];
        assert_eq!(of(&[]), (0, 0));
        assert_eq!(of(std::slice::from_ref(&one)), (1, 0));
        assert_eq!(of(&[[one.clone(), other.clone()].concat()]), (2, 0));
        assert_eq!(of(&[one.clone(), other.clone()]), (2, 0));
        assert_eq!(of(&[[one.clone(), loose.clone()].concat()]), (1, 1));
        assert_eq!(of(&[[fin, one.clone()].concat()]), (1, 1));
        assert_eq!(of(&[[one.clone(), one.clone()].concat()]), (1, 0));
        assert_eq!(of(&[one[9..].to_vec()]), (0, 11));
        assert_eq!(of(&[[loose.clone(), loose].concat()]), (0, 1));
        // Two boxes with a common face, which is a wall in what is then one solid.
        let mut corner = cuboid([1.0; 3], [2.0; 3]);
        corner.iter_mut().step_by(3).for_each(|x| *x = 4.0 - *x);
        assert_eq!(of(&[[one, corner].concat()]), (1, 2));
        assert!(Scene::around(&[0.0; 8]).is_err());
    }

    #[test]
    fn parts_are_in_the_mesh_and_in_no_solid() {
        let parts = |crossings: &[(f64, i32)]| free_parts(crossings);
        assert_eq!(parts(&[]), (vec![], true));
        assert_eq!(parts(&[(0.0, 0), (1.0, 0)]), (vec![[0.0, 1.0]], true));
        assert_eq!(parts(&[(0.0, 0)]), (vec![], false));
        let solid = [(0.0, 0), (1.0, 1), (2.0, 1), (5.0, 0)];
        assert_eq!(parts(&solid), (vec![[0.0, 1.0], [2.0, 5.0]], true));
        // A solid that leaves the mesh, two that overlap, and a wall, which parts nothing.
        let leaving = [(0.0, 0), (1.0, 1), (2.0, 0), (5.0, 1)];
        assert_eq!(parts(&leaving), (vec![[0.0, 1.0]], true));
        let overlapping = [(0.0, 0), (1.0, 1), (2.0, 2), (3.0, 1), (4.0, 2), (5.0, 0)];
        assert_eq!(parts(&overlapping), (vec![[0.0, 1.0], [4.0, 5.0]], true));
        let wall = [(0.0, 0), (1.0, -1), (5.0, 0)];
        assert_eq!(parts(&wall), (vec![[0.0, 1.0], [1.0, 5.0]], true));
    }
}
