//! Which way closed parts face where their vertices were given.
//!
//! *Problem.* The triangles of a surface were found among moved points. Where these were given the same triangles can bound a part from
//! its other side, and a part can lie within others that it was beside. Turn closed parts so that they face outwards, and those within
//! an odd number of others inwards. No two triangles meet beyond what they share.
//! *Idea.* The vertex v of a part that comes last by x, then y, then z is on its hull, and so is an edge vw: no other edge at v is steeper
//! as seen along z. The two triangles vwp and wvq of this edge are convex there, so the part faces outwards if q is below vwp. A
//! ray from v towards larger x crosses another part an odd number of times if that part is around v.
//! *Guarantee.* Only exact signs decide. O(m) for m triangles, and for two parts of which the box of one holds v of the other the triangles
//! of the first; O(c²) tests of boxes for c closed parts.
//! *Trap.* Several edges can be equally steep. Steepness is that of y + δz over x + εy + ε²z for infinitesimal δ and, much smaller, ε: by
//! the first of the turns in xy, in xz and in yz that is not 0. Edges of one direction, for which all are 0, would overlap. The
//! ray is moved by (ε, ε²) in yz, so that it is on no edge.
//! *Reference.* Edelsbrunner and Mücke, *Simulation of Simplicity*, ACM Trans. Graph. 9(1), 1990.

use taut_mesh::Topology;
use taut_points::parallel::{IntoParallel, ParallelSlice};
use taut_predicates::{Sign, plane, space};

use super::border::parts_of;
use super::spheres::Point;

/// A closed part.
#[derive(Clone, Debug)]
struct Part {
    triangles: Vec<[u32; 3]>,
    /// The vertex that comes last by x, then y, then z.
    last: u32,
    /// Least and largest coordinates.
    span: [Point; 2],
}

/// Turns the closed parts of an oriented surface that meets itself nowhere.
pub(super) fn turn(places: &[Point], triangles: &mut [[u32; 3]], found: &Topology) {
    /// The number of what is no closed part.
    const NONE: u32 = u32::MAX;
    let root = parts_of(triangles.iter().copied(), places.len());
    let root_of = |triangle: &[u32; 3]| root[triangle[0] as usize] as usize;
    let mut number = vec![NONE; places.len()];
    let mut count = 0;
    for one in found.components.iter().filter(|one| one.closed) {
        number[root_of(&triangles[one.first_triangle as usize])] = count;
        count += 1;
    }
    let mut members: Vec<Vec<[u32; 3]>> = vec![Vec::new(); count as usize];
    for triangle in &*triangles {
        if let Some(own) = members.get_mut(number[root_of(triangle)] as usize) {
            own.push(*triangle);
        }
    }
    let parts: Vec<Part> = members.into_par_iter().map(|own| Part::of(places, own)).collect();
    let is_wrong: Vec<bool> = parts
        .par_iter()
        .enumerate()
        .map(|(own, part)| {
            let others = parts.iter().enumerate().filter(|(other, _)| *other != own);
            let v = places[part.last as usize];
            let depth = others.filter(|(_, other)| other.is_around(places, v)).count();
            part.faces_outwards(places) != depth.is_multiple_of(2)
        })
        .collect();
    for triangle in triangles {
        if is_wrong.get(number[root_of(triangle)] as usize) == Some(&true) {
            triangle.swap(1, 2);
        }
    }
}

impl Part {
    fn of(places: &[Point], triangles: Vec<[u32; 3]>) -> Self {
        let (mut last, mut span) = (triangles[0][0], [[f64::INFINITY; 3], [-f64::INFINITY; 3]]);
        for &site in triangles.as_flattened() {
            let place = places[site as usize];
            if space::lexicographic(place, places[last as usize]).is_gt() {
                last = site;
            }
            let [least, most] = span;
            span = [
                [0, 1, 2].map(|k| place[k].min(least[k])),
                [0, 1, 2].map(|k| place[k].max(most[k])),
            ];
        }
        Self { triangles, last, span }
    }

    /// Returns true if its triangles run counter-clockwise as seen from beyond it.
    fn faces_outwards(&self, places: &[Point]) -> bool {
        let at = |site: u32| places[site as usize];
        let v = at(self.last);
        // The other two corners of each triangle at v, in their order.
        let fan: Vec<[u32; 2]> = self
            .triangles
            .iter()
            .filter_map(|&[a, b, c]| match self.last {
                last if last == a => Some([b, c]),
                last if last == b => Some([c, a]),
                last if last == c => Some([a, b]),
                _ => None,
            })
            .collect();
        let steeper = |one: [u32; 2], other: [u32; 2]| {
            if is_steeper(v, at(other[0]), at(one[0])) { other } else { one }
        };
        let Some([w, p]) = fan.iter().copied().reduce(steeper) else { return true };
        // Around a vertex of a closed part each edge has a triangle on either side.
        let before = fan.iter().find(|[_, end]| *end == w);
        before.is_none_or(|&[q, _]| space::orient(v, at(w), at(p), at(q)).is_negative())
    }

    /// Returns true if a point that is not on it is within.
    fn is_around(&self, places: &[Point], p: Point) -> bool {
        let [least, most] = self.span;
        let crossed = |triangle: &&[u32; 3]| crosses(triangle.map(|site| places[site as usize]), p);
        (0..3).all(|k| least[k] <= p[k] && p[k] <= most[k])
            && self.triangles.iter().filter(crossed).count() % 2 == 1
    }
}

/// The turn as seen along an axis: from y to z along x.
fn turn_along(axis: usize, [a, b, c]: [Point; 3]) -> Sign {
    let [i, j] = [[1, 2], [0, 2], [0, 1]][axis];
    let [a, b, c] = [a, b, c].map(|p| [p[i], p[j]]);
    plane::orient(a, b, c)
}

/// Returns true if the edge from v to `one` is steeper than that to `other`, as the head of this file has it.
fn is_steeper(v: Point, one: Point, other: Point) -> bool {
    let turns = [2, 1, 0].into_iter().map(|axis| turn_along(axis, [v, other, one]));
    turns.into_iter().find(|turn| !turn.is_zero()).is_some_and(Sign::is_positive)
}

/// Tests whether the ray from p towards larger x crosses a triangle that p is not on, once it is moved.
fn crosses(triangle: [Point; 3], p: Point) -> bool {
    let [a, b, c] = triangle;
    let facing = turn_along(0, triangle);
    // A difference of two doubles is 0 only if they are equal.
    let moved = |s: Point, t: Point| {
        let turns = [turn_along(0, [s, t, p]), Sign::from(s[2] - t[2]), Sign::from(t[1] - s[1])];
        turns.into_iter().find(|turn| !turn.is_zero())
    };
    // The plane is met at p + t·x with t = −det/nₓ, where nₓ has the sign of `facing`.
    !facing.is_zero()
        && [[a, b], [b, c], [c, a]].into_iter().all(|[s, t]| moved(s, t) == Some(facing))
        && space::orient(a, b, c, p) == -facing
}

#[cfg(test)]
mod tests {
    use taut_mesh::{TriangleMesh, topology};

    use super::*;

    /// Triangles of an octahedron on rows from `base` on, facing outwards, with its places.
    fn octahedron(base: u32, center: Point, radius: f64) -> (Vec<Point>, Vec<[u32; 3]>) {
        let apex = |k: usize| {
            let mut place = center;
            place[k / 2] += if k.is_multiple_of(2) { radius } else { -radius };
            place
        };
        let octant = |signs: u32| {
            let [x, y, z] = [0, 1, 2].map(|k| base + 2 * k + (signs >> k & 1));
            if signs.count_ones().is_multiple_of(2) { [x, y, z] } else { [x, z, y] }
        };
        ((0..6).map(apex).collect(), (0..8).map(octant).collect())
    }

    /// The triangles after they are turned.
    fn turned(places: &[Point], triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
        let mesh = TriangleMesh::new(places, triangles).expect("rows that exist");
        let mut triangles = triangles.to_vec();
        turn(places, &mut triangles, &topology(&mesh));
        triangles
    }

    fn flipped(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
        triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
    }

    #[test]
    fn a_body_in_any_position_is_turned_to_face_outwards() {
        let (places, outward) = octahedron(0, [0.0; 3], 1.0);
        // Whole numbers, so that many vertices come last together but for y and z, and edges are equally steep.
        let frames: [[Point; 3]; 5] = [
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[1.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 1.0]],
            [[1.0, 1.0, 1.0], [1.0, -1.0, 0.0], [1.0, 1.0, -2.0]],
            [[0.0, 1.0, 0.0], [1e-300, 0.0, 0.0], [0.0, 0.0, 1e300]],
        ];
        for frame in frames {
            let place =
                |p: &Point| [0, 1, 2].map(|k| (0..3).map(|i| p[i] * frame[i][k]).sum::<f64>());
            let moved: Vec<Point> = places.iter().map(place).collect();
            let [origin, x, y, z] = [[0.0; 3], frame[0], frame[1], frame[2]];
            let is_mirrored = space::orient(origin, x, y, z).is_negative();
            let expected = if is_mirrored { flipped(&outward) } else { outward.clone() };
            assert_eq!(turned(&moved, &expected), expected, "{frame:?}");
            assert_eq!(turned(&moved, &flipped(&expected)), expected, "{frame:?}");
        }
    }

    #[test]
    fn random_stars_are_turned_to_face_their_center() {
        // Each vertex of a divided octahedron on its own ray from the center: embedded, and not convex.
        let (mut rays, mut triangles) = octahedron(0, [0.0; 3], 1.0);
        for _ in 0..2 {
            let mut middle = |a: u32, b: u32| {
                let [p, q] = [a, b].map(|site| rays[site as usize]);
                let place = [0, 1, 2].map(|k| p[k] + q[k]);
                let known = rays.iter().position(|ray| *ray == place);
                known.unwrap_or_else(|| {
                    rays.push(place);
                    rays.len() - 1
                }) as u32
            };
            let divide = |&[a, b, c]: &[u32; 3]| {
                let [x, y, z] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, x, z], [x, b, y], [z, y, c], [x, y, z]]
            };
            triangles = triangles.iter().flat_map(divide).collect();
        }
        let mut state = 1u64;
        for _ in 0..200 {
            let stretched = |ray: &Point| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                // Lengths that are small whole numbers give ties and flat edges.
                ray.map(|x| x * (1 + (state >> 33) % 5) as f64)
            };
            let places: Vec<Point> = rays.iter().map(stretched).collect();
            assert_eq!(turned(&places, &triangles), triangles);
            assert_eq!(turned(&places, &flipped(&triangles)), triangles);
        }
    }

    #[test]
    fn parts_within_others_face_inwards_by_turns() {
        let (mut places, mut expected) = (Vec::new(), Vec::new());
        let centers = [([0.0; 3], 8.0), ([0.0; 3], 4.0), ([0.0; 3], 1.0), ([20.0, 0.0, 0.0], 8.0)];
        for (number, (center, radius)) in (0u32..).zip(centers) {
            let (own, outward) = octahedron(6 * number, center, radius);
            places.extend(own);
            expected.extend(if number == 1 { flipped(&outward) } else { outward });
        }
        assert_eq!(turned(&places, &expected), expected);
        assert_eq!(turned(&places, &flipped(&expected)), expected);
    }

    #[test]
    fn what_has_a_boundary_is_left_as_it_is() {
        let (places, outward) = octahedron(0, [0.0; 3], 1.0);
        let cup = flipped(&outward[..4]);
        assert_eq!(turned(&places, &cup), cup);
    }
}
