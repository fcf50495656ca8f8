//! Nanoseconds per call of each stage, with the counters that prove which stage it was.
//!
//! `cargo run --release -p taut-predicates --example stages`

use std::hint::black_box;
use std::time::Instant;

use taut_predicates::{Exact, Separate, plane, space};

const CALLS: usize = 1 << 12;
const ROUND_COUNT: usize = 200;

/// Splitmix64: Steele, Lea & Flood, OOPSLA 2014.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, end: u64) -> f64 {
        (self.bits() % end) as f64
    }
}

fn show<T: Copy>(name: &str, inputs: &[T], mut call: impl FnMut(T) -> bool) {
    let mut best = f64::INFINITY;
    for _ in 0..ROUND_COUNT {
        let start = Instant::now();
        let mut positive = 0u32;
        for &input in inputs {
            positive += u32::from(call(black_box(input)));
        }
        black_box(positive);
        best = best.min(start.elapsed().as_nanos() as f64 / inputs.len() as f64);
    }
    print!("{name:<48} {best:8.1} ns");
}

fn plane(name: &str, integral: bool, inputs: &[[plane::Point; 4]]) {
    let mut exact = Exact::new(integral);
    show(name, inputs, |[a, b, c, q]| plane::conflict_exact(a, b, c, q, &mut exact));
    println!("   {:?}", counted(&exact, inputs.len()));
}

fn space(name: &str, integral: bool, inputs: &[[space::Point; 5]]) {
    let mut exact = Exact::new(integral);
    show(name, inputs, |[a, b, c, d, q]| space::conflict_exact(a, b, c, d, q, &mut exact));
    println!("   {:?}", counted(&exact, inputs.len()));
}

/// Per cent of calls: whole numbers, double-double, wide, unbounded; ties.
fn counted(exact: &Exact, inputs: usize) -> [u64; 5] {
    let s = exact.stages;
    let all = (inputs * ROUND_COUNT) as u64;
    [s.integer, s.double_double, s.wide, s.unbounded, s.ties].map(|n| (100 * n + all / 2) / all)
}

fn main() {
    let mut random = Random(1);
    println!("{:>98}", "% whole, double-double, wide, unbounded; ties");

    let uniform: Vec<_> =
        (0..CALLS).map(|_| [(); 4].map(|()| [random.unit(), random.unit()])).collect();
    show("plane: filter, uniform", &uniform, |[a, b, c, q]| {
        plane::in_circle_filter::<Separate>(a, b, c, q) > 0.0
    });
    println!();
    plane("plane: exact, uniform", false, &uniform);
    let squares = |random: &mut Random, step: f64| -> Vec<[plane::Point; 4]> {
        let square = |_| {
            let (x, y) = (random.below(1000), random.below(1000));
            let mut p = [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
            p.rotate_left((random.bits() % 4) as usize);
            p.map(|p| p.map(|x| x * step))
        };
        (0..CALLS).map(square).collect()
    };
    plane("plane: unit squares", true, &squares(&mut random, 1.0));
    plane("plane: squares of 100 000", true, &squares(&mut random, 1e5));
    plane("plane: squares of 0.1", false, &squares(&mut random, 0.1));
    plane("plane: squares of 0.125, not announced", false, &squares(&mut random, 0.125));
    let circle: Vec<_> = (0..CALLS)
        .map(|_| {
            let start = random.unit() * 6.0;
            [0.0, 1e-5, 2e-5, 3e-5].map(|step| {
                let angle: f64 = start + step;
                [angle.cos(), angle.sin()]
            })
        })
        .collect();
    plane("plane: neighbors on a circle", false, &circle);
    let mixed: Vec<_> = (0..CALLS)
        .map(|_| {
            let (x, y, far) = (random.unit() * 1e-30, random.unit(), random.unit());
            [[-x, -y], [x, -y], [x, y], [-x, y + far * 1e-47]]
        })
        .collect();
    plane("plane: rectangles of 1e-30 by 1", false, &mixed);
    let thin: Vec<_> = (0..CALLS)
        .map(|_| {
            let (x, y) = (random.unit() * 1e-8, random.unit());
            [[-x, -y], [x, -y], [x, y], [-x, y.next_up()]]
        })
        .collect();
    plane("plane: rectangles of 1e-8 by 1, but for an ulp", false, &thin);

    let uniform: Vec<_> = (0..CALLS)
        .map(|_| [(); 5].map(|()| [random.unit(), random.unit(), random.unit()]))
        .collect();
    show("space: filter, uniform", &uniform, |[a, b, c, d, q]| {
        space::in_sphere_filter::<Separate>(a, b, c, d, q) > 0.0
    });
    println!();
    space("space: exact, uniform", false, &uniform);
    let cubes = |random: &mut Random, step: f64| -> Vec<[space::Point; 5]> {
        let cube = |_| {
            let corner = [(); 3].map(|()| random.below(100));
            let mut p = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
                .map(|p| [0, 1, 2].map(|i| step * (corner[i] + p[i])));
            p.rotate_left(2 * (random.bits() % 2) as usize);
            let bits = random.bits();
            let q = match bits % 4 {
                0 => [1.0, 1.0, 0.0],
                1 => [1.0, 0.0, 1.0],
                2 => [0.0, 1.0, 1.0],
                _ => [1.0, 1.0, 1.0],
            };
            [p[0], p[1], p[2], p[3], [0, 1, 2].map(|i| step * (corner[i] + q[i]))]
        };
        (0..CALLS).map(cube).collect()
    };
    space("space: unit cubes", true, &cubes(&mut random, 1.0));
    space("space: cubes of 1000", true, &cubes(&mut random, 1000.0));
    space("space: cubes of 0.1", false, &cubes(&mut random, 0.1));
    let sphere: Vec<_> = (0..CALLS)
        .map(|_| {
            let mut points = [[0.0; 3]; 5];
            let start = [random.unit() * 6.0, random.unit() * 3.0];
            for p in &mut points {
                let (u, v): (f64, f64) =
                    (start[0] + random.unit() * 1e-2, start[1] + random.unit() * 1e-2);
                *p = [v.sin() * u.cos(), v.sin() * u.sin(), v.cos()];
            }
            points
        })
        .collect();
    space("space: neighbors on a sphere", false, &sphere);
    let mixed: Vec<_> = (0..CALLS)
        .map(|_| {
            let (x, y, z) = (random.unit() * 1e-30, random.unit(), random.unit() * 1e30);
            [[-x, -y, -z], [x, -y, -z], [-x, y, -z], [-x, -y, z], [x, y, z]]
        })
        .collect();
    space("space: boxes of 1e-30 by 1 by 1e30", false, &mixed);
    let thin: Vec<_> = (0..CALLS)
        .map(|_| {
            let (x, y, z) = (random.unit() * 1e-8, random.unit(), random.unit());
            [[-x, -y, -z], [x, -y, -z], [-x, y, -z], [-x, -y, z], [x, y, z.next_up()]]
        })
        .collect();
    space("space: boxes of 1e-8 by 1 by 1, but for an ulp", false, &thin);

    for (name, inputs) in [
        ("facets: uniform", &uniform),
        ("facets: unit cubes", &cubes(&mut random, 1.0)),
        ("facets: cubes of 0.1", &cubes(&mut random, 0.1)),
        ("facets: neighbors on a sphere", &sphere),
    ] {
        show(name, inputs, |[a, b, c, _, q]| space::in_equatorial_sphere(a, b, c, q).is_positive());
        println!();
        show(name, inputs, |[a, b, c, _, q]| space::shrunk_sphere(a, b, c, q, 2e-5).is_positive());
        println!("   shrunk");
    }
    for (name, inputs) in [
        ("circumcenters: uniform", &uniform),
        ("circumcenters: unit cubes", &cubes(&mut random, 1.0)),
    ] {
        show(name, inputs, |[a, b, c, d, q]| {
            space::circumcenter_side(a, b, c, d, 0, 0.5 * (a[0] + q[0])).is_positive()
        });
        println!();
    }
}
