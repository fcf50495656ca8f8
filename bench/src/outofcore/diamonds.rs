//! The method of the thesis (6.2 and 6.5): conflict lists of the diamonds of a sample, and a triangulation of each list.
//!
//! *Problem.* Triangulate n points in parts that fit into memory.
//! *Idea.* Of a sample R of n^ε points take the Voronoi diagram and cut it into *diamonds*: the part of the cells of v and w
//! that the two points and their common facet span, one for each Delaunay edge vw of R. A point is in conflict with a diamond
//! if it is nearer than v to some place of it; the points in conflict with diamond vw are those whose cavity in Del(R) has the
//! edge vw. Each diamond triangulates its list and reports the simplices whose circumcenters lie in it.
//! *Guarantee.* A circumcenter in a diamond is that of a simplex of all points exactly if it is one of the list, v and w. The
//! lists have all points together 9 times in the plane, as a cavity has 3 inner edges and 6 on its border, and about 47 times
//! in space.
//! *Trap.* Cells of the hull reach to infinity. The part of such a cell that no facet spans, a wedge at v, is the diamond of v
//! and infinity, and its list has the points in conflict with the ghosts at v.
//! *Trap.* Circumcenters are rounded. One within rounding of a border may be reported by the wrong diamond or by none; the
//! number of simplices shows it. The tree merge asks no circumcenter.

use std::collections::HashMap;

use taut_delaunay::{DelaunayOptions, GHOST, Locator, Plane, Space, Triangulation};

use super::*;

/// The questions to a triangulation that differ in the plane and in space.
pub(crate) trait Conflicts<const D: usize> {
    fn conflicts(&self, point: [f64; D]) -> Vec<u32>;
}

impl Conflicts<2> for Locator<'_, 2, 3> {
    fn conflicts(&self, point: [f64; 2]) -> Vec<u32> {
        Locator::<2, 3>::conflicts(self, point)
    }
}

impl Conflicts<3> for Locator<'_, 3, 4> {
    fn conflicts(&self, point: [f64; 3]) -> Vec<u32> {
        Locator::<3, 4>::conflicts(self, point)
    }
}

/// The diamonds of a sample, and the points in conflict with each.
pub(crate) struct Lists {
    /// The two sites of the sample that span each diamond, the second infinity for a wedge.
    pub(crate) edges: Vec<[u32; 2]>,
    /// The diamond of a pair of sites.
    numbers: HashMap<[u32; 2], u32>,
    /// A diamond and the row of a point in conflict with it, point by point.
    pub(crate) copies: Vec<[u32; 2]>,
    /// Copies in diamonds that are no wedge.
    pub(crate) finite: u64,
    /// Points that are not in the sample.
    pub(crate) others: u64,
}

impl Lists {
    /// The lists of all rows of `points` that `in_sample` does not hold of.
    pub(crate) fn new<const D: usize, const V: usize>(
        sample: &Triangulation<D, V>,
        locator: &impl Conflicts<D>,
        points: &[[f64; D]],
        in_sample: &[bool],
    ) -> Self {
        let mut lists =
            Self { edges: vec![], numbers: HashMap::new(), copies: vec![], finite: 0, others: 0 };
        let mut edges: Vec<[u32; 2]> = Vec::new();
        for (row, &p) in points.iter().enumerate().filter(|&(row, _)| !in_sample[row]) {
            edges.clear();
            for t in locator.conflicts(p) {
                edges.extend(edges_of(sample.vertices(t)));
            }
            edges.sort_unstable();
            edges.dedup();
            lists.others += 1;
            for &edge in &edges {
                lists.finite += u64::from(edge[1] != GHOST);
                let diamond = lists.number(edge);
                lists.copies.push([diamond, row as u32]);
            }
        }
        lists
    }

    fn number(&mut self, edge: [u32; 2]) -> u32 {
        let next = self.edges.len() as u32;
        let number = *self.numbers.entry(edge).or_insert(next);
        if number == next {
            self.edges.push(edge);
        }
        number
    }

    /// How often a point is copied to a bounded diamond.
    pub(crate) fn factor(&self) -> f64 {
        self.finite as f64 / self.others.max(1) as f64
    }
}

/// The edges of a simplex, the smaller site first; infinity is larger than all.
fn edges_of<const V: usize>(vertices: [u32; V]) -> impl Iterator<Item = [u32; 2]> {
    let pairs = (0..V).flat_map(|j| (0..j).map(move |i| [i, j]));
    pairs.map(move |[i, j]| {
        let (a, b) = (vertices[i], vertices[j]);
        [a.min(b), a.max(b)]
    })
}

/// A sample of about so many rows, in which row i is or is not whatever the others are.
pub(crate) fn sample(rows: usize, size: f64) -> Vec<bool> {
    let share = size / rows as f64;
    let is_in = |row: usize| {
        let mut z = (row as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        let lot = ((z ^ z >> 31) >> 11) as f64 / (1u64 << 53) as f64;
        lot < share
    };
    (0..rows).map(is_in).collect()
}

/// The rows that are marked, and their coordinates.
pub(crate) fn marked<const D: usize>(points: &[[f64; D]], marks: &[bool]) -> (Vec<u32>, Vec<f64>) {
    let rows: Vec<u32> =
        (0u32..).zip(marks).filter(|&(_, &mark)| mark).map(|(row, _)| row).collect();
    let values = rows.iter().flat_map(|&row| points[row as usize]).collect();
    (rows, values)
}

/// The copying factor of a set, in the plane or in space, with a sample of n^ε points.
pub(crate) fn factor(values: &[f64], dim: usize, epsilon: f64) -> Result<(Lists, usize)> {
    let n = values.len() / dim;
    let is_in = sample(n, (n as f64).powf(epsilon));
    let options = DelaunayOptions { threads: Some(1), ..Default::default() };
    match dim {
        2 => {
            let points: &[[f64; 2]] = values.as_chunks().0;
            let (rows, chosen) = marked(points, &is_in);
            let built = Plane::build(&Points::new(&chosen, 2)?, &options)?;
            Ok((Lists::new(&built, &built.locator(), points, &is_in), rows.len()))
        }
        _ => {
            let points: &[[f64; 3]] = values.as_chunks().0;
            let (rows, chosen) = marked(points, &is_in);
            let built = Space::build(&Points::new(&chosen, 3)?, &options)?;
            Ok((Lists::new(&built, &built.locator(), points, &is_in), rows.len()))
        }
    }
}

/// What the method of the thesis found.
pub(crate) struct ByDiamonds {
    /// The triangles of all diamonds together.
    pub(crate) triangles: u64,
    /// The number of diamonds with a list.
    pub(crate) diamonds: u64,
    /// The longest list.
    pub(crate) longest: u64,
    /// Entries of all lists.
    pub(crate) copies: u64,
}

/// Triangulates points of the plane by the diamonds of a sample of √n of them.
pub(crate) fn triangulate(points: &[[f64; 2]]) -> Result<ByDiamonds> {
    let options = DelaunayOptions { threads: Some(1), ..Default::default() };
    let is_in = sample(points.len(), (points.len() as f64).sqrt());
    let (rows, chosen) = marked(points, &is_in);
    let built = Plane::build(&Points::new(&chosen, 2)?, &options)?;
    let locator = built.locator();
    let mut lists = Lists::new(&built, &locator, points, &is_in);
    // Also those that no point is in conflict with: their triangles are those of the sample.
    let all = built.simplices().chain(built.ghosts()).flat_map(|t| edges_of(built.vertices(t)));
    all.for_each(|edge| {
        lists.number(edge);
    });
    let row_of = |site: u32| rows[built.row(site) as usize];
    lists.copies.sort_unstable();
    let (mut triangles, mut longest, mut begin) = (0, 0, 0);
    let mut values: Vec<f64> = Vec::new();
    for (diamond, &[v, w]) in lists.edges.iter().enumerate() {
        let end = begin + lists.copies[begin..].partition_point(|copy| copy[0] as usize <= diamond);
        longest = longest.max(end - begin);
        values.clear();
        let list = lists.copies[begin..end].iter().map(|copy| copy[1]);
        let mut members: Vec<u32> = list.collect();
        begin = end;
        // A triangle may have more sites of the sample: those around the edge are enough, as a circle whose center lies in
        // the diamond and that is empty passes through v or w, or only through points of the list.
        members.extend([v, w].into_iter().filter(|&site| site != GHOST).map(row_of));
        members.extend(locator.adjacent(v).into_iter().map(row_of));
        if w != GHOST {
            members.extend(locator.adjacent(w).into_iter().map(row_of));
        }
        members.sort_unstable();
        members.dedup();
        values.extend(members.iter().flat_map(|&row| points[row as usize]));
        let part = Plane::build(&Points::new(&values, 2)?, &options)?;
        for t in part.simplices() {
            let corners = part.vertices(t).map(|site| part.site(site));
            triangles += u64::from(diamond_of(&built, &locator, circumcenter(corners)) == [v, w]);
        }
    }
    let (diamonds, copies) = (lists.edges.len() as u64, lists.copies.len() as u64);
    Ok(ByDiamonds { triangles, diamonds, longest: longest as u64, copies })
}

/// The center of the circle through three points, rounded.
pub(crate) fn circumcenter([a, b, c]: [[f64; 2]; 3]) -> [f64; 2] {
    let (b, c) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    let double = 2.0 * (b[0] * c[1] - b[1] * c[0]);
    let (b2, c2) = (b[0] * b[0] + b[1] * b[1], c[0] * c[0] + c[1] * c[1]);
    [a[0] + (c[1] * b2 - b[1] * c2) / double, a[1] + (b[0] * c2 - c[0] * b2) / double]
}

/// The diamond of a place: its nearest site v, and the neighbor across the facet of v's cell that the ray from v through the
/// place leaves by, or infinity.
fn diamond_of(sample: &Plane, locator: &Locator<'_, 2, 3>, x: [f64; 2]) -> [u32; 2] {
    let Some(v) = locator.nearest(x) else { return [GHOST; 2] };
    let at = sample.site(v);
    let along = [x[0] - at[0], x[1] - at[1]];
    let mut first = (f64::INFINITY, GHOST);
    for w in locator.adjacent(v) {
        let to = sample.site(w);
        let to = [to[0] - at[0], to[1] - at[1]];
        let slope = 2.0 * (along[0] * to[0] + along[1] * to[1]);
        if slope > 0.0 {
            let reached = (to[0] * to[0] + to[1] * to[1]) / slope;
            if reached < first.0 {
                first = (reached, w);
            }
        }
    }
    [v.min(first.1), v.max(first.1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uniform(n: usize, dim: usize) -> Vec<f64> {
        generate(Distribution::Uniform, n, dim, 7).unwrap()
    }

    #[test]
    fn points_are_copied_nine_times_in_the_plane_and_forty_eight_times_in_space() {
        let (lists, sample) = factor(&uniform(60_000, 2), 2, 0.6).unwrap();
        assert!((500..1000).contains(&sample) && lists.others == 60_000 - sample as u64);
        assert!((lists.factor() - 9.0).abs() < 0.3, "{}", lists.factor());
        let (lists, _) = factor(&uniform(20_000, 3), 3, 0.7).unwrap();
        assert!((lists.factor() - 46.0).abs() < 4.0, "{}", lists.factor());
    }

    #[test]
    fn diamonds_together_have_all_triangles() {
        let values = uniform(5000, 2);
        let points: &[[f64; 2]] = values.as_chunks().0;
        let all = Plane::build(&Points::new(&values, 2).unwrap(), &Default::default()).unwrap();
        let found = triangulate(points).unwrap();
        assert_eq!(found.triangles, all.simplices().count() as u64);
        assert!(found.diamonds > 150 && found.longest < 1500);
    }
}
