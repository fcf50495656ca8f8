//! Is Local RIC I/O-efficient? The experiment that the thesis announces (6.3.1): misses of four insertion orders.
//!
//! *Problem.* An incremental construction touches the triangles on the way to each site and those around it. How many blocks
//! that moves in a memory of M bytes depends on the order of insertion, and on where triangles and sites lie.
//! *Idea.* A short incremental Delaunay triangulation of the plane whose every access to a site or a triangle is told to
//! simulated memories. All orders run on the same code and the same sites; only Local RIC locates a block of sites before it
//! inserts them. Sites lie in memory as they are given, at random, or along a Hilbert curve.
//! *Guarantee.* All orders give the same triangles, which is checked. Counts are exact and the same on every machine.
//! *Reference.* The thesis, 6.3.1; Amenta, Choi, Rote, *Incremental constructions con BRIO*, SoCG 2003.

use taut_delaunay::{DelaunayOptions, Plane};
use taut_oblivious::{Probe, hilbert_order};
use taut_predicates::{Sign, plane};
use taut_reference::simulate::{CacheShape, Simulator};

use super::*;

/// Bytes of a block.
const BLOCK: usize = 64;
/// Bytes of the simulated memories.
const MEMORIES: [usize; 3] = [1 << 14, 1 << 17, 1 << 20];
/// Each round of a biased order, and each block of Local RIC, has 2³ times the sites of the one before.
const RATIO_BITS: u32 = 3;

/// The misses of each order, in a table.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.count(100_000);
    let values: Vec<f64> = generate(Distribution::Uniform, n, 2, SEED)?;
    let given: Vec<[f64; 2]> = values.as_chunks().0.to_vec();
    let along = hilbert_order(n, |i| given[i]);
    let sorted: Vec<[f64; 2]> = along.iter().map(|&i| given[i as usize]).collect();
    let built = Plane::build(&Points::new(&values, 2)?, &DelaunayOptions::default())?;
    let expected = built.simplices().count();
    let mut table = Table::new("sites lie | order | walk steps:2 | 16 KiB:2 | 128 KiB:2 | 1 MiB:2");
    let mut misses = |lie: &str, sites: &[[f64; 2]], order: Order| -> Result<f64> {
        let shapes = MEMORIES.map(|memory| CacheShape::lru(memory, BLOCK));
        let mut mesh = Mesh::new(sites, Simulator::new(&shapes)?)?;
        mesh.insert_all(order);
        ensure!(mesh.triangles() == expected, "{order:?}: {} triangles", mesh.triangles());
        let per_site = |k: usize| mesh.probe.counts(k).misses as f64 / n as f64;
        let steps = mesh.steps as f64 / n as f64;
        table.push(json!([lie, order.name(), steps, per_site(0), per_site(1), per_site(2)]));
        Ok(per_site(1))
    };
    let mut of_random = f64::NAN;
    let mut of_local = f64::NAN;
    for (lie, sites) in [("at random", &given), ("along a curve", &sorted)] {
        for order in [Order::Random, Order::LocalRic, Order::Strided, Order::Hilbert] {
            let found = misses(lie, sites, order)?;
            match order {
                Order::Random => of_random = found,
                Order::LocalRic => of_local = found,
                _ => {}
            }
        }
    }
    out.table(&format!("misses for each of {n} sites, blocks of {BLOCK} bytes"), table);
    let share = of_local / of_random;
    out.must(
        "Local RIC has fewer misses than a random order, sites along a curve, in 128 KiB",
        format!("{share:.2} of them"),
        share < 1.0,
    );
    Ok(())
}

/// The order in which sites are inserted.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Order {
    /// One random permutation.
    Random,
    /// Blocks of a random permutation, each located as a whole and then inserted triangle by triangle.
    LocalRic,
    /// Every 8ᵏ-th site of the curve, for k from large to 0.
    Strided,
    /// Along the curve.
    Hilbert,
}

impl Order {
    fn name(self) -> &'static str {
        match self {
            Order::Random => "random",
            Order::LocalRic => "local-ric",
            Order::Strided => "strided",
            Order::Hilbert => "hilbert",
        }
    }
}

/// Stands for the vertex at infinity.
const INFINITY: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
struct Triangle {
    vertices: [u32; 3],
    neighbors: [u32; 3],
}

/// A triangulation that grows; it is closed by ghosts, in which one vertex is at infinity.
struct Mesh<'a, P: Probe> {
    sites: &'a [[f64; 2]],
    /// With room for all, so that it never moves; `used` are in use.
    triangles: Vec<Triangle>,
    used: usize,
    free: Vec<u32>,
    /// The number of the insertion that looked at a triangle last.
    marks: Vec<u32>,
    stamp: u32,
    last: u32,
    start: [u32; 3],
    steps: u64,
    probe: P,
}

impl<'a, P: Probe> Mesh<'a, P> {
    /// The triangle of the first three sites that do not lie on a line.
    fn new(sites: &'a [[f64; 2]], mut probe: P) -> Result<Self> {
        ensure!(sites.len() >= 3, "at least three sites");
        let third = (2..sites.len() as u32)
            .find(|&c| plane::orient(sites[0], sites[1], sites[c as usize]) != Sign::Zero);
        let Some(c) = third else { bail!("all sites lie on a line") };
        let (a, b) = match plane::orient(sites[0], sites[1], sites[c as usize]) {
            Sign::Positive => (0, 1),
            _ => (1, 0),
        };
        let nothing = Triangle { vertices: [INFINITY; 3], neighbors: [0; 3] };
        // Two for each site, ghosts included.
        let mut triangles = vec![nothing; 2 * sites.len()];
        triangles[0] = Triangle { vertices: [a, b, c], neighbors: [2, 3, 1] };
        triangles[1] = Triangle { vertices: [b, a, INFINITY], neighbors: [3, 2, 0] };
        triangles[2] = Triangle { vertices: [c, b, INFINITY], neighbors: [1, 3, 0] };
        triangles[3] = Triangle { vertices: [a, c, INFINITY], neighbors: [2, 1, 0] };
        let marks = vec![0; triangles.len()];
        probe.place(sites);
        probe.place(&triangles);
        probe.place(&marks);
        let start = [a, b, c];
        Ok(Self {
            sites,
            triangles,
            used: 4,
            free: vec![],
            marks,
            stamp: 0,
            last: 0,
            start,
            steps: 0,
            probe,
        })
    }

    /// Triangles without a vertex at infinity.
    fn triangles(&self) -> usize {
        let dead: std::collections::HashSet<u32> = self.free.iter().copied().collect();
        let live = |&t: &u32| !dead.contains(&t);
        let finite = |&t: &u32| !self.triangles[t as usize].vertices.contains(&INFINITY);
        (0..self.used as u32).filter(live).filter(finite).count()
    }

    fn triangle(&mut self, t: u32) -> Triangle {
        self.probe.read(&self.triangles[t as usize..=t as usize]);
        self.triangles[t as usize]
    }

    fn site(&mut self, v: u32) -> [f64; 2] {
        self.probe.read(&self.sites[v as usize..=v as usize]);
        self.sites[v as usize]
    }

    fn insert_all(&mut self, order: Order) {
        let n = self.sites.len() as u32;
        let start = self.start;
        let open = |v: &u32| !start.contains(v);
        match order {
            Order::Hilbert => {
                let sites = self.sites;
                let along = hilbert_order(sites.len(), |i| sites[i]);
                along.into_iter().filter(open).for_each(|v| self.insert(v));
            }
            Order::Strided => {
                let sites = self.sites;
                let along = hilbert_order(sites.len(), |i| sites[i]);
                let top = n.ilog2() / RATIO_BITS;
                for level in (0..=top).rev() {
                    let places = (0..n.div_ceil(1 << (level * RATIO_BITS)))
                        .filter(|k| k % (1 << RATIO_BITS) != 0 || level == top);
                    for k in places {
                        let v = along[(k << (level * RATIO_BITS)) as usize];
                        if open(&v) {
                            self.insert(v);
                        }
                    }
                }
            }
            Order::Random => permutation(n).into_iter().filter(open).for_each(|v| self.insert(v)),
            Order::LocalRic => {
                let all: Vec<u32> = permutation(n).into_iter().filter(open).collect();
                let (mut begin, mut size) = (0, 1usize << RATIO_BITS);
                while begin < all.len() {
                    let end = all.len().min(begin + size);
                    // The triangle of each site, then its place in the permutation.
                    let mut located: Vec<(u32, usize)> = Vec::with_capacity(end - begin);
                    for place in begin..end {
                        located.push((self.locate(all[place]), place));
                    }
                    located.sort_unstable();
                    for (_, place) in located {
                        self.insert(all[place]);
                    }
                    (begin, size) = (end, size << RATIO_BITS);
                }
            }
        }
    }

    /// The triangle or ghost in conflict with a site that the walk from the last one ends at.
    fn locate(&mut self, v: u32) -> u32 {
        let q = self.site(v);
        let mut here = self.last;
        let first = self.triangle(here);
        if let Some(at) = first.vertices.iter().position(|&w| w == INFINITY) {
            here = first.neighbors[at];
        }
        loop {
            self.steps += 1;
            let Triangle { vertices, neighbors } = self.triangle(here);
            if vertices.contains(&INFINITY) {
                return here;
            }
            let corners = vertices.map(|w| self.site(w));
            let beyond = (0..3).find(|&i| {
                plane::orient(corners[(i + 1) % 3], corners[(i + 2) % 3], q) == Sign::Negative
            });
            match beyond {
                None => return here,
                Some(i) => here = neighbors[i],
            }
        }
    }

    fn is_in_conflict(&mut self, t: u32, q: [f64; 2]) -> bool {
        let Triangle { vertices, neighbors } = self.triangle(t);
        let Some(at) = vertices.iter().position(|&w| w == INFINITY) else {
            let [a, b, c] = vertices.map(|w| self.site(w));
            return plane::conflict(a, b, c, q);
        };
        let (a, b) = (self.site(vertices[(at + 1) % 3]), self.site(vertices[(at + 2) % 3]));
        match plane::orient(a, b, q) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => {
                let behind = self.triangle(neighbors[at]).vertices;
                let [a, b, c] = behind.map(|w| self.site(w));
                plane::conflict(a, b, c, q)
            }
        }
    }

    /// Replaces the triangles in conflict with a site by a fan around it.
    fn insert(&mut self, v: u32) {
        let first = self.locate(v);
        let q = self.site(v);
        self.stamp += 1;
        let mut cavity = vec![first];
        self.mark(first);
        // Edges of the border: the triangle beyond, and the two vertices as the fan sees them.
        let mut border: Vec<(u32, u32, u32, u32)> = Vec::new();
        let mut next = 0;
        while next < cavity.len() {
            let t = cavity[next];
            let Triangle { vertices, neighbors } = self.triangle(t);
            for i in 0..3 {
                let other = neighbors[i];
                if self.is_marked(other) {
                    continue;
                }
                if self.is_in_conflict(other, q) {
                    self.mark(other);
                    cavity.push(other);
                } else {
                    border.push((other, t, vertices[(i + 1) % 3], vertices[(i + 2) % 3]));
                }
            }
            next += 1;
        }
        self.free.extend(cavity);
        let mut fan: Vec<(u32, u32, u32)> = Vec::with_capacity(border.len());
        for &(other, inner, a, b) in &border {
            let t = self.free.pop().unwrap_or_else(|| {
                self.used += 1;
                self.used as u32 - 1
            });
            fan.push((t, a, b));
            let place = t as usize;
            self.triangles[place] = Triangle { vertices: [v, a, b], neighbors: [other, 0, 0] };
            // The neighbor across the edge a b sees it from the other side; `inner` is where it pointed.
            let back = self.triangles[other as usize];
            let at = (0..3).find(|&i| {
                back.neighbors[i] == inner
                    && back.vertices[(i + 1) % 3] == b
                    && back.vertices[(i + 2) % 3] == a
            });
            if let Some(at) = at {
                self.triangles[other as usize].neighbors[at] = t;
                self.probe.write(&self.triangles[other as usize..=other as usize]);
            }
        }
        for &(t, a, b) in &fan {
            let of = |from: u32| fan.iter().find(|&&(_, first, _)| first == from).map(|f| f.0);
            let to = |end: u32| fan.iter().find(|&&(_, _, last)| last == end).map(|f| f.0);
            // Opposite a lies the triangle that begins at b, opposite b the one that ends at a.
            self.triangles[t as usize].neighbors[1] = of(b).unwrap_or(t);
            self.triangles[t as usize].neighbors[2] = to(a).unwrap_or(t);
            self.probe.write(&self.triangles[t as usize..=t as usize]);
        }
        self.last = fan.first().map_or(self.last, |f| f.0);
    }

    fn mark(&mut self, t: u32) {
        self.marks[t as usize] = self.stamp;
        self.probe.write(&self.marks[t as usize..=t as usize]);
    }

    fn is_marked(&mut self, t: u32) -> bool {
        self.probe.read(&self.marks[t as usize..=t as usize]);
        self.marks[t as usize] == self.stamp
    }
}

/// A random permutation of so many numbers.
fn permutation(n: u32) -> Vec<u32> {
    let mut all: Vec<u32> = (0..n).collect();
    all.sort_by_cached_key(|&v| {
        let z = (u64::from(v) + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB)
    });
    all
}

#[cfg(test)]
mod tests {
    use taut_oblivious::NoProbe;

    use super::*;

    #[test]
    fn all_orders_give_the_triangles_of_the_library() {
        let random: Vec<f64> = generate(Distribution::Uniform, 500, 2, 3).unwrap();
        let grid = (0..225).flat_map(|i| [f64::from(i % 15), f64::from(i / 15)]).collect();
        for values in [random, grid] {
            let built = Plane::build(&Points::new(&values, 2).unwrap(), &Default::default());
            let expected = built.unwrap().simplices().count();
            for order in [Order::Random, Order::LocalRic, Order::Strided, Order::Hilbert] {
                let mut mesh = Mesh::new(values.as_chunks().0, NoProbe).unwrap();
                mesh.insert_all(order);
                assert_eq!(mesh.triangles(), expected, "{order:?}");
            }
        }
    }
}
