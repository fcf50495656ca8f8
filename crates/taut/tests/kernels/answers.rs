//! Thirty-five seeded inputs and the answers to them, as hashes: what instruction sets and machines are compared by.
//!
//! *Trap.* Sines and logarithms differ between systems, so the inputs are made without them.

use taut::certify::{Answer, Placement};
use taut::{
    BallOptions, CentersOptions, CurveMethod, CurveOptions, DelaunayOptions, EllipsoidOptions,
    OrderOptions, Points, Solution, SurfaceOptions, ball, centers, curve, delaunay, ellipsoid,
    spatial_order, surface,
};

/// The inputs of each sort.
const SEEDS: u64 = 5;

/// An answer to one input.
pub(crate) struct Hashed {
    /// The input and the tool.
    pub(crate) name: String,
    /// True if the answer has the same bits for every instruction set and on every machine; else the digits may differ.
    pub(crate) is_exact: bool,
    /// FNV-1a of the JSON of the answer.
    pub(crate) hash: u64,
}

/// Returns all answers, each of them verified.
pub(crate) fn all() -> Vec<Hashed> {
    (0..SEEDS).flat_map(|seed| SORTS.iter().flat_map(move |sort| of_input(sort, seed))).collect()
}

/// A sort of inputs: its name, the dimension, the points.
type Sort = (&'static str, usize, fn(&mut Random) -> Vec<f64>);

const SORTS: [Sort; 7] = [
    ("square", 2, |random| (0..600).map(|_| random.signed()).collect()),
    ("lattice of the plane", 2, |random| (0..400).map(|_| random.whole(9)).collect()),
    ("ring", 2, |random| (0..200).flat_map(|_| random.on_ring()).collect()),
    ("cube", 3, |random| (0..600).map(|_| random.signed()).collect()),
    ("lattice of space", 3, |random| (0..450).map(|_| random.whole(5)).collect()),
    ("sphere", 3, |random| (0..300).flat_map(|_| random.on_sphere()).collect()),
    ("nine dimensions", 9, |random| (0..540).map(|_| random.signed()).collect()),
];

fn of_input(&(sort, dim, values): &Sort, seed: u64) -> Vec<Hashed> {
    let values = values(&mut Random(seed));
    let points = Points::new(&values, dim).expect("rows are whole");
    let among = CentersOptions { epsilon: 1e-3, placement: Placement::Rows, ..Default::default() };
    let free = CentersOptions { epsilon: 0.1, ..Default::default() };
    let mut among = digits("centers among rows", &centers(&points, 3, &among).unwrap(), &points);
    // Up to four coordinates a squared distance has one order of summation; beyond, the digits of the radius may differ.
    among.is_exact = dim <= 4;
    let mut found = vec![
        among,
        digits("ball", &ball(&points, &BallOptions::default()).unwrap(), &points),
        digits("ellipsoid", &ellipsoid(&points, &EllipsoidOptions::default()).unwrap(), &points),
    ];
    if dim <= 3 {
        let mesh = delaunay(&points, &DelaunayOptions::default()).unwrap();
        found.push(exact("delaunay", &mesh, &points));
        let order = spatial_order(&points, &OrderOptions::default()).unwrap();
        found.push(exact("order", &order, &points));
        found.push(digits("centers", &centers(&points, 3, &free).unwrap(), &points));
    }
    if sort == "ring" {
        let method = CurveMethod::HnnCrust;
        let crust = curve(&points, &CurveOptions { method, ..Default::default() }).unwrap();
        found.push(exact("curve by hnn-crust", &crust, &points));
        let fitted = curve(&points, &CurveOptions::default()).unwrap();
        found.push(digits("curve", &fitted, &points));
    }
    if sort == "sphere" {
        let options = SurfaceOptions::default();
        found.push(exact("surface", &surface(&points, &options).unwrap(), &points));
    }
    for answer in &mut found {
        answer.name = format!("{sort} {seed}: {}", answer.name);
    }
    found
}

fn exact<A: Answer>(tool: &str, solution: &Solution<A>, points: &Points<'_, f64>) -> Hashed {
    Hashed { is_exact: true, ..digits(tool, solution, points) }
}

fn digits<A: Answer>(tool: &str, solution: &Solution<A>, points: &Points<'_, f64>) -> Hashed {
    if let Err(refused) = solution.check(points) {
        panic!("{tool}: {refused}");
    }
    let hash = solution.to_json().bytes().fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    Hashed { name: tool.to_owned(), is_exact: false, hash }
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// Returns a number between −1 and 1.
    fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Returns a whole number below `n`.
    fn whole(&mut self, n: u64) -> f64 {
        (self.next() % n) as f64
    }

    /// Returns a point of the unit circle, with noise.
    fn on_ring(&mut self) -> [f64; 2] {
        let t = self.signed();
        let (x, y) = ((1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
        let side = if self.next().is_multiple_of(2) { 1.0 } else { -1.0 };
        [side * x + 0.01 * self.signed(), y + 0.01 * self.signed()]
    }

    /// Returns a point of the unit sphere, with rounding for noise.
    fn on_sphere(&mut self) -> [f64; 3] {
        loop {
            let v = [self.signed(), self.signed(), self.signed()];
            let square: f64 = v.iter().map(|x| x * x).sum();
            if (0.01..=1.0).contains(&square) {
                return v.map(|x| x / square.sqrt());
            }
        }
    }
}
