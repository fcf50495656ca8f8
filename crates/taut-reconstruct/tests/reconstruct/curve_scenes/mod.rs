//! Inputs with truth that no method was tuned to: smooth scenes without noise, borders, and noisy bands of every awkward shape.
//!
//! Each draw is a function of its seed. The example `curve_rates` prints rates over many seeds; the tests take few.
#![allow(dead_code, missing_docs, unreachable_pub)] // the tests and the example use a part each

pub mod bands;
pub mod borders;
pub mod judge;
pub mod shapes;
pub mod smooth;

pub type Point = [f64; 2];

/// Splitmix64.
pub struct Random(u64);

impl Random {
    /// Another stream for each class and seed.
    pub fn of(class: u64, seed: u64) -> Self {
        let mut random = Self(class.wrapping_mul(0xd134_2543_de82_ef95) ^ seed);
        random.bits();
        random
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in the logarithm.
    pub fn log_between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }

    pub fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n - 1)
    }

    pub fn is_one_of(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    pub fn normal(&mut self) -> f64 {
        let (a, b) = (1.0 - self.unit(), self.unit());
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }

    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}

/// Points without noise, and the edges between neighbors.
pub struct Clean {
    pub points: Vec<Point>,
    /// The rows of neighbors, the smaller one first, ascending.
    pub edges: Vec<[u32; 2]>,
}

impl Clean {
    /// The vertices of chains, each with whether it is closed; equal points are one. Rows are in a random order.
    pub fn of(chains: &[(Vec<Point>, bool)], random: &mut Random) -> Self {
        let mut number = std::collections::BTreeMap::new();
        let (mut points, mut edges) = (vec![], vec![]);
        for (chain, closed) in chains {
            let rows: Vec<u32> = chain
                .iter()
                .map(|p| {
                    *number.entry(p.map(f64::to_bits)).or_insert_with(|| {
                        points.push(*p);
                        points.len() as u32 - 1
                    })
                })
                .collect();
            edges.extend(rows.windows(2).map(|pair| [pair[0], pair[1]]));
            if *closed {
                edges.push([rows[rows.len() - 1], rows[0]]);
            }
        }
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        random.shuffle(&mut order);
        let mut shuffled = vec![[0.0; 2]; points.len()];
        order.iter().zip(&points).for_each(|(&row, &p)| shuffled[row as usize] = p);
        for edge in &mut edges {
            *edge = edge.map(|point| order[point as usize]);
            edge.sort_unstable();
        }
        edges.sort_unstable();
        edges.dedup();
        Self { points: shuffled, edges }
    }

    pub fn values(&self) -> Vec<f64> {
        self.points.as_flattened().to_vec()
    }
}

/// A noisy input.
pub struct Noisy {
    pub points: Vec<Point>,
    /// The true curves, finely, each with whether it is closed.
    pub truth: Vec<(Vec<Point>, bool)>,
    /// Half the width of the band of noise where it is widest.
    pub half_width: f64,
    /// Half-width over the mean spacing along the curves.
    pub lambda: f64,
    /// Whether the truth can be told at all, so that the goals are about it.
    pub is_fair: bool,
    /// Whether it is as dense, beside its features, as the certificate asks for.
    pub is_dense: bool,
}
