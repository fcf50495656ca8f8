//! Noisy points around curves: honest ones, and every kind that deceives a certificate.

use super::shapes::{
    self, Base, capsule, eight, ellipse, fine, lens, moon, neck, polygon, spiral, waves,
};
use super::smooth::{radius, smooth_loop};
use super::{Noisy, Point, Random};

/// The classes. The strands of most are `r` half-widths apart.
pub const CLASSES: [&str; 18] = [
    "honest",
    "concentric",
    "side by side",
    "neck",
    "capsule",
    "lens",
    "moon",
    "fold on a circle",
    "fold on a loop",
    "finger",
    "small loop",
    "sparse loop",
    "missing arc",
    "spiral",
    "waves",
    "polygon",
    "crossing",
    "rings",
];

/// The law of points around curves.
pub struct Law {
    /// Half-width of the band where it is widest; twice the deviation of normal noise.
    pub half_width: f64,
    pub noise: Noise,
    /// The largest density along curves over the least.
    pub density_ratio: f64,
    /// The largest half-width over the least.
    pub width_ratio: f64,
    /// The share of points that are anywhere.
    pub outliers: f64,
    /// Whether places are spread evenly, each within its own part, instead of independently.
    pub even: bool,
}

#[derive(Clone, Copy, PartialEq)]
pub enum Noise {
    /// Across the curve, uniform.
    Uniform,
    /// Across the curve, normal.
    Normal,
    /// In both coordinates, uniform in a disk.
    Disk,
}

impl Law {
    pub fn draw(random: &mut Random, half_width: f64) -> Self {
        let noise = [Noise::Uniform, Noise::Normal, Noise::Uniform, Noise::Disk][random.below(4)];
        Self {
            half_width,
            noise,
            density_ratio: if random.is_one_of(2) { 1.0 } else { random.log_between(1.0, 5.0) },
            width_ratio: if random.is_one_of(2) { 1.0 } else { random.log_between(1.0, 3.0) },
            outliers: if random.is_one_of(2) { 0.0 } else { random.between(0.0, 0.15) },
            even: random.is_one_of(3),
        }
    }
}

/// Curves with how dense points are on each, over the first.
pub struct Curves {
    pub chains: Vec<(Vec<Point>, bool)>,
    pub densities: Vec<f64>,
}

impl Curves {
    pub fn one(chain: Vec<Point>, closed: bool) -> Self {
        Self { chains: vec![(chain, closed)], densities: vec![1.0] }
    }

    pub fn closed(chains: Vec<Vec<Point>>) -> Self {
        let densities = vec![1.0; chains.len()];
        Self { chains: chains.into_iter().map(|chain| (chain, true)).collect(), densities }
    }
}

/// A wave over the plane between 1 and `ratio`.
struct Wave {
    ratio: f64,
    x: f64,
    y: f64,
    phase: f64,
}

impl Wave {
    fn draw(random: &mut Random, ratio: f64, size: f64) -> Self {
        let (turn, often) = (random.between(0.0, 6.3), random.between(1.0, 3.0) / size);
        Self {
            ratio,
            x: often * turn.cos(),
            y: often * turn.sin(),
            phase: random.between(0.0, 6.3),
        }
    }

    fn at(&self, p: Point) -> f64 {
        let wave = (self.x * p[0] + self.y * p[1] + self.phase).sin();
        self.ratio.powf(0.5 + 0.5 * wave)
    }
}

/// n points around curves; the mean spacing, and the least density over the mean one.
pub fn scatter(mut curves: Curves, n: usize, law: &Law, random: &mut Random) -> (Noisy, f64) {
    let h = law.half_width;
    for (chain, closed) in &mut curves.chains {
        *chain = fine(chain, *closed, h / 5.0);
    }
    let all = || curves.chains.iter().flat_map(|(chain, _)| chain);
    let size = all().map(|p| p[0].abs().max(p[1].abs())).fold(0.0, f64::max);
    let density = Wave::draw(random, law.density_ratio, size);
    let width = Wave::draw(random, law.width_ratio, size);
    let mut edges: Vec<(Point, Point, f64)> = vec![];
    let (mut sum, mut length, mut least) = (0.0, 0.0, f64::INFINITY);
    for ((chain, closed), factor) in curves.chains.iter().zip(&curves.densities) {
        for k in 0..chain.len() - usize::from(!closed) {
            let (a, b) = (chain[k], chain[(k + 1) % chain.len()]);
            let own = (a[0] - b[0]).hypot(a[1] - b[1]);
            let weight = factor * density.at(a);
            sum += own * weight;
            length += own;
            least = least.min(weight);
            edges.push((a, b, sum));
        }
    }
    let far = (n as f64 * law.outliers).round() as usize;
    let near = n - far;
    let mut points = vec![];
    for k in 0..near {
        let share = if law.even { (k as f64 + random.unit()) / near as f64 } else { random.unit() };
        let place = share * sum;
        let edge = edges.partition_point(|edge| edge.2 <= place).min(edges.len() - 1);
        let (a, b, end) = edges[edge];
        let start = if edge > 0 { edges[edge - 1].2 } else { 0.0 };
        let t = (place - start) / (end - start);
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        let own = x.hypot(y);
        let wide = h * width.at(a) / law.width_ratio;
        let off = match law.noise {
            Noise::Uniform => [0.0, wide * random.between(-1.0, 1.0)],
            Noise::Normal => [0.0, 0.5 * wide * random.normal()],
            Noise::Disk => loop {
                let [p, q] = [(); 2].map(|()| random.between(-1.0, 1.0));
                if p * p + q * q <= 1.0 {
                    break [wide * p, wide * q];
                }
            },
        };
        points.push([
            a[0] + t * x + (off[0] * x - off[1] * y) / own,
            a[1] + t * y + (off[0] * y + off[1] * x) / own,
        ]);
    }
    let ends = |k: usize| {
        let range = |(low, high): (f64, f64), p: &Point| (low.min(p[k]), high.max(p[k]));
        let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), range);
        let more = 0.1 * (high - low) + h;
        (low - more, high + more)
    };
    let (x, y) = (ends(0), ends(1));
    points.extend((0..far).map(|_| [random.between(x.0, x.1), random.between(y.0, y.1)]));
    random.shuffle(&mut points);
    let spacing = length / near as f64;
    let noisy = Noisy {
        points,
        truth: curves.chains,
        half_width: h,
        lambda: h / spacing,
        is_fair: true,
        is_dense: false,
    };
    (noisy, least * length / sum)
}

/// A scene of one to three smooth loops with noise, at a half-width over spacing.
pub fn scene(seed: u64, lambda: f64) -> Noisy {
    let mut random = Random::of(4, seed);
    let (chains, length) = loops(&mut random, 3);
    let h = random.log_between(0.03, 0.25);
    let n = (lambda * length / h).clamp(250.0, 6300.0);
    // The length is given, and n bounded: the half-width follows.
    let law = Law { outliers: 0.0, ..Law::draw(&mut random, lambda * length / n) };
    scatter(Curves::closed(chains), n as usize, &law, &mut random).0
}

/// Smooth loops side by side of least feature size 1, and their length.
fn loops(random: &mut Random, most: usize) -> (Vec<Vec<Point>>, f64) {
    let mut chains: Vec<Vec<Point>> = vec![];
    let mut right = 0.0;
    for _ in 0..1 + random.below(most) {
        let chain = smooth_loop(random, 40.0, 2000);
        let reach = radius(&chain);
        // Twice the least feature size apart.
        chains.push(chain.iter().map(|p| [p[0] + right + reach, p[1]]).collect());
        right += 2.0 * reach + 2.0;
    }
    let length = chains.iter().map(|chain| Base::of(chain.clone()).length()).sum();
    (chains, length)
}

/// A draw of a class, strands at least 2.5 half-widths apart.
pub fn draw(class: usize, seed: u64) -> Noisy {
    let mut random = Random::of(100 + class as u64, seed);
    let r = random.log_between(2.5, 6.0);
    draw_at(class, seed, r)
}

/// The same at a distance of strands in half-widths.
pub fn draw_at(class: usize, seed: u64, r: f64) -> Noisy {
    let mut random = Random::of(200 + class as u64, seed);
    let random = &mut random;
    let n = random.log_between(250.0, 6300.0);
    let h = random.log_between(0.005, 0.06);
    let apart = r * h;
    let law = |random: &mut Random| Law::draw(random, h);
    let curves = match CLASSES[class] {
        "honest" => return honest(random),
        "concentric" => {
            let base = base(random, apart);
            Curves::closed(vec![base.offset(0.0), base.offset(apart)])
        }
        "side by side" => {
            let other = random.between(0.3, 1.0);
            let at = [1.0 + other + apart, 0.0];
            Curves::closed(vec![ellipse([0.0; 2], 1.0, 1.0), ellipse(at, other, other)])
        }
        "neck" => Curves::closed(vec![neck(apart)]),
        "capsule" => Curves::closed(vec![capsule(2.0, apart)]),
        "lens" => Curves::closed(vec![lens(apart)]),
        "moon" => Curves::closed(vec![moon(apart)]),
        "fold on a circle" => {
            let long = h * random.log_between(4.0, 40.0);
            Curves::closed(vec![Base::circle().fold(1.0, long, apart, sign(random))])
        }
        "fold on a loop" => {
            let base = base(random, 1.5 * apart);
            let (u, long) = (base.length() * random.unit(), h * random.log_between(4.0, 40.0));
            Curves::closed(vec![base.fold(u, long.min(base.length() / 4.0), apart, sign(random))])
        }
        "finger" => {
            let high = random.between(2.0 * apart, (2.0 * apart).max(0.6));
            Curves::closed(vec![Base::circle().finger(1.0, high, apart, sign(random))])
        }
        "small loop" => {
            let small = random.log_between(1.5 * h, 0.4);
            let inside = if random.is_one_of(2) { -1.0 } else { 1.0 };
            let at = [1.0 + inside * (small + apart), 0.0];
            Curves::closed(vec![ellipse([0.0; 2], 1.0, 1.0), ellipse(at, small, small)])
        }
        "sparse loop" => {
            let other = random.between(0.2, 1.0);
            let at = [1.0 + other + apart.max(0.2 * random.unit()), 0.0];
            let chains = vec![ellipse([0.0; 2], 1.0, 1.0), ellipse(at, other, other)];
            let sparser = random.log_between(3.0, 20.0);
            Curves { densities: vec![1.0, 1.0 / sparser], ..Curves::closed(chains) }
        }
        "missing arc" => return missing_arc(random, n, h),
        "spiral" => {
            let turns = random.between(1.2, 3.0).min(0.6 / apart).max(1.05);
            Curves::one(spiral(turns, apart), false)
        }
        "waves" => {
            let height = h * random.between(0.5, 4.0);
            // No steeper than 45 degrees.
            let most = (1.0 / height).min(60.0) as usize;
            Curves::closed(vec![waves(3 + random.below(most.max(4) - 3), height)])
        }
        "polygon" => {
            let star = random.is_one_of(2);
            let corners = if star { 2 * (4 + random.below(4)) } else { 2 * (2 + random.below(4)) };
            let inner = if star { random.between(0.4, 0.7) } else { 1.0 };
            Curves::closed(vec![polygon(corners, inner)])
        }
        "crossing" => Curves::closed(vec![eight(random)]),
        _ => {
            // Three rings, one within the other.
            let gap = apart.min(0.25);
            let ring = |k: f64| ellipse([0.0; 2], 1.0 - k * gap, 1.0 - k * gap);
            Curves::closed(vec![ring(0.0), ring(1.0), ring(2.0)])
        }
    };
    let law = law(random);
    let rows = rows_of(&curves, n);
    let (mut found, _) = scatter(curves, n as usize, &law, random);
    // Noise in both coordinates fills what is between strands less than three half-widths apart.
    let is_filled = law.noise == Noise::Disk && r < 3.0;
    found.is_fair = rows >= 24.0 && !is_filled && (CLASSES[class] != "rings" || apart <= 0.25);
    found
}

fn sign(random: &mut Random) -> f64 {
    if random.is_one_of(2) { 1.0 } else { -1.0 }
}

/// A circle, or a smooth loop that is so large that strands so far off do not meet.
fn base(random: &mut Random, off: f64) -> Base {
    if random.is_one_of(2) {
        return Base::circle();
    }
    let points = smooth_loop(random, 40.0, 3000);
    let scale = (1.0 / radius(&points)).max(2.0 * off);
    Base::of(points.iter().map(|p| p.map(|x| x * scale)).collect())
}

/// About how many rows the loop with the fewest gets.
fn rows_of(curves: &Curves, n: f64) -> f64 {
    let weights: Vec<f64> = curves
        .chains
        .iter()
        .zip(&curves.densities)
        .map(|((chain, _), density)| density * Base::of(chain.clone()).length())
        .collect();
    let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
    n * least / weights.iter().sum::<f64>()
}

/// Curves whose features are at least four half-widths, with at least forty samples to a feature everywhere.
fn honest(random: &mut Random) -> Noisy {
    let (chains, length) = loops(random, 2);
    let h = 1.0 / random.log_between(4.0, 30.0);
    let law = Law::draw(random, h);
    let most = 6300.0 / length;
    // Where density varies, the sparsest place counts: it has about a third of the mean at 5 : 1.
    let per = random.log_between(40.0 * law.density_ratio.sqrt(), (40.0f64 * 4.0).max(most));
    let n = (per * length / (1.0 - law.outliers)).min(6300.0);
    let (mut found, least) = scatter(Curves::closed(chains), n as usize, &law, random);
    found.is_dense = least * n * (1.0 - law.outliers) / length >= 40.0;
    found
}

/// A loop of which an arc is missing, some mean gaps long.
fn missing_arc(random: &mut Random, n: f64, h: f64) -> Noisy {
    let base = base(random, 0.0);
    let gaps = random.between(n.ln() + 2.0, n.ln() + 30.0);
    let gap = (gaps * base.length() / n).min(0.5 * base.length());
    missing_arc_of(random, &base, n, h, gap)
}

fn missing_arc_of(random: &mut Random, base: &Base, n: f64, h: f64, gap: f64) -> Noisy {
    let u = base.length() * random.unit();
    let law = Law::draw(random, h);
    let ends = [base.at([u, 0.0]), base.at([u + gap, 0.0])];
    let curves = Curves::one(base.without(u, gap), false);
    let (mut found, _) = scatter(curves, n as usize, &law, random);
    // The spacing beside the gap, as points show it: how many are nearest to an end of it.
    let reach = (40.0 * base.length() / n).min(0.2 * base.length());
    let beside = found
        .points
        .iter()
        .filter(|p| ends.iter().any(|end| (p[0] - end[0]).hypot(p[1] - end[1]) <= reach));
    let spacing = 2.0 * reach / beside.count().max(1) as f64;
    found.is_fair = gap >= (n.ln() + 8.0) * spacing && gap >= 3.0 * h;
    found
}

/// Two concentric circles, so many points on the first, the second so many times sparser; strands `r` half-widths apart.
pub fn concentric(seed: u64, per_strand: f64, ratio: f64, r: f64, noise: Noise) -> Noisy {
    let mut random = Random::of(5, seed);
    let h = random.log_between(0.01, 0.04);
    let law = Law {
        half_width: h,
        noise,
        density_ratio: 1.0,
        width_ratio: 1.0,
        outliers: 0.0,
        even: false,
    };
    let rings = vec![ellipse([0.0; 2], 1.0, 1.0), ellipse([0.0; 2], 1.0 - r * h, 1.0 - r * h)];
    let curves = Curves { densities: vec![1.0, 1.0 / ratio], ..Curves::closed(rings) };
    let n = per_strand * (1.0 + (1.0 - r * h) / ratio);
    scatter(curves, n as usize, &law, &mut random).0
}

/// A circle with a fold of 10 to 40 half-widths, strands `r` apart.
pub fn fold(seed: u64, n: usize, r: f64) -> Noisy {
    let mut random = Random::of(6, seed);
    let h = random.log_between(0.01, 0.03);
    let law = Law {
        half_width: h,
        noise: [Noise::Uniform, Noise::Normal][random.below(2)],
        density_ratio: 1.0,
        width_ratio: 1.0,
        outliers: 0.0,
        even: false,
    };
    let long = h * random.log_between(10.0, 40.0);
    let chain = shapes::Base::circle().fold(1.0, long, r * h, sign(&mut random));
    scatter(Curves::closed(vec![chain]), n, &law, &mut random).0
}
