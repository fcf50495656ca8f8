//! Sixteen classes of closed shapes. Each has a least thickness, of its walls or of the gaps between them, and is otherwise drawn at random.

use super::fields::{Field, Tube, counted, length, minus};
use super::*;

/// What a shape is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    Plate,
    Fins,
    Cup,
    Gear,
    Bracket,
    Sieve,
    Knot,
    Gyroid,
    Shells,
    Blend,
    Blades,
    Balls,
    Links,
    Lattice,
    Pipes,
    Coil,
}

impl Class {
    /// All of them, with what tables call them.
    pub(super) const ALL: [(Self, &'static str); 16] = [
        (Self::Plate, "plate"),
        (Self::Fins, "fins"),
        (Self::Cup, "cup"),
        (Self::Gear, "gear"),
        (Self::Bracket, "bracket"),
        (Self::Sieve, "sieve"),
        (Self::Knot, "knot"),
        (Self::Gyroid, "gyroid"),
        (Self::Shells, "shells"),
        (Self::Blend, "blend"),
        (Self::Blades, "blades"),
        (Self::Balls, "balls"),
        (Self::Links, "links"),
        (Self::Lattice, "lattice"),
        (Self::Pipes, "pipes"),
        (Self::Coil, "coil"),
    ];
}

/// A body, and what is true of its surface.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) field: Field,
    pub(super) components: usize,
    pub(super) genus: u64,
    /// The least width of a wall or of a gap.
    pub(super) thickness: f64,
}

/// All shapes are within this distance of the origin.
pub(super) const RADIUS_MAX: f64 = 2.3;

/// Numbers in [0, 1), one after the other.
pub(super) struct Dice(std::vec::IntoIter<[f64; 1]>);

impl Dice {
    pub(super) fn new(seed: u64) -> Result<Self> {
        Ok(Self(chances::<1>(64, seed)?.into_iter()))
    }

    /// A number of a range.
    pub(super) fn real(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.0.next().map_or(0.5, |[x]| x)
    }

    /// A whole number of a range, both ends included.
    pub(super) fn whole(&mut self, from: usize, to: usize) -> usize {
        (self.real(from as f64, to as f64 + 1.0) as usize).min(to)
    }
}

/// Holes right through along z.
fn bores(body: Field, places: &[[f64; 2]], radius: f64) -> Field {
    let bore = |&[x, y]: &[f64; 2]| Field::Drum(radius, 2.0).at([x, y, 0.0]);
    Field::Cut([body].into_iter().chain(places.iter().map(bore)).collect())
}

/// The least distance of parts of a closed or open line which are not near each other along it.
fn least_gap(line: &[Point], apart: usize, is_closed: bool) -> f64 {
    let mut least = f64::INFINITY;
    for i in 0..line.len() {
        for j in i + apart..line.len() {
            if !is_closed || line.len() - (j - i) >= apart {
                least = least.min(length(minus(line[i], line[j])));
            }
        }
    }
    least
}

/// The shape of a class, of about this thickness.
pub(super) fn shape(class: Class, thickness: f64, seed: u64) -> Result<Shape> {
    let (t, dice) = (thickness, &mut Dice::new(seed)?);
    let known = |field: Field, components: usize, genus: usize| {
        Ok(Shape { field, components, genus: genus as u64, thickness: t })
    };
    match class {
        Class::Plate => {
            let holes = dice.whole(0, 3);
            let radius = dice.real(0.1, 0.2).max(0.5 * t);
            let places = [[-0.65, dice.real(-0.2, 0.2)], [0.0, 0.1], [0.65, dice.real(-0.2, 0.2)]];
            let body = Field::Slab([1.1, dice.real(0.6, 0.9), 0.5 * t]);
            known(bores(body, &places[..holes], radius), 1, holes)
        }
        Class::Fins => {
            let most = 1 + (1.8 / (2.2 * t)) as usize;
            let fins = dice.whole(3, 7).min(most);
            let (deep, high) = (dice.real(0.4, 0.7), dice.real(0.25, 0.5));
            let fin = |k: usize| {
                let x = 1.9 * k as f64 / (fins - 1).max(1) as f64 - 0.95;
                Field::Slab([0.5 * t, deep, high]).at([x * (1.0 - 0.5 * t), 0.0, high])
            };
            let base = Field::Slab([1.0, deep + 0.1, 0.5 * t]);
            known(Field::Any([base].into_iter().chain((0..fins).map(fin)).collect()), 1, 0)
        }
        Class::Cup => {
            let (radius, half) = (dice.real(0.6, 0.9), dice.real(0.5, 0.9));
            let has_handle = dice.whole(0, 1) == 1;
            let tube = (0.5 * t).max(0.09);
            let handle = Field::Ring(0.35, tube).about(0, 0.25 * TAU).at([radius, 0.0, 0.0]);
            let wall = Field::Drum(radius, half);
            let outer = if has_handle { Field::Any(vec![wall, handle]) } else { wall };
            let room = Field::Drum(radius - t, half).at([0.0, 0.0, t]);
            known(Field::Cut(vec![outer, room]), 1, usize::from(has_handle))
        }
        Class::Gear => {
            let most = (0.9 * TAU / (2.2 * t)) as usize;
            let teeth = dice.whole(8, 16).min(most);
            let width = 0.25 * 0.9 * TAU / teeth as f64;
            let half = (0.5 * t).max(dice.real(0.0, 0.15));
            let tooth = |k: usize| {
                let angle = TAU * k as f64 / teeth as f64;
                Field::Slab([0.2, width, half]).at([0.85, 0.0, 0.0]).about(2, angle)
            };
            let disk = Field::Drum(0.8, half);
            let body = Field::Any([disk].into_iter().chain((0..teeth).map(tooth)).collect());
            known(bores(body, &[[0.0, 0.0]], dice.real(0.2, 0.4)), 1, 1)
        }
        Class::Bracket => {
            let half = dice.real(0.5, 0.7);
            let (lower, upper) = (dice.whole(0, 2), dice.whole(0, 2));
            let radius = dice.real(0.1, 0.15).max(0.5 * t);
            let places = [[-0.35, 0.0], [0.35, 0.0]].map(|[x, y]| [x + 0.1, y]);
            let flat = |long: f64, holes: usize| {
                bores(Field::Slab([long, half, 0.5 * t]), &places[..holes], radius)
            };
            let upright = flat(0.8, upper).about(1, -0.25 * TAU).at([-0.9, 0.0, 0.8 - 0.5 * t]);
            let body = Field::Any(vec![flat(0.9 + 0.5 * t, lower), upright]);
            known(body, 1, lower + upper)
        }
        Class::Sieve => {
            let radius = dice.real(0.06, 0.12).max(0.6 * t);
            let pitch = 2.0 * radius + t;
            let side = |long: f64| (((long - t) / pitch) as usize).clamp(1, 7);
            let (m, n) = (side(2.2), side(1.6));
            let place = |k: usize, count: usize| pitch * (k as f64 - 0.5 * (count - 1) as f64);
            let places: Vec<[f64; 2]> =
                (0..m * n).map(|k| [place(k % m, m), place(k / m, n)]).collect();
            let half = |count: usize| 0.5 * pitch * count as f64 + 0.5 * t;
            let body = Field::Slab([half(m), half(n), 0.5 * t]);
            known(bores(body, &places, radius), 1, m * n)
        }
        Class::Knot => {
            let (p, q) = [(2, 3), (2, 5), (3, 4), (3, 2)][dice.whole(0, 3)];
            let steps = 144;
            let place = |k: usize| {
                let angle = TAU * k as f64 / steps as f64;
                let (around, across) = (angle * p as f64, angle * q as f64);
                let radius = 0.95 + 0.42 * across.cos();
                [radius * around.cos(), radius * around.sin(), 0.42 * across.sin()]
            };
            let line: Vec<Point> = (0..=steps).map(place).collect();
            let apart = least_gap(&line[..steps], 14, true);
            let radius = if apart > 2.0 * t { 0.5 * (apart - t) } else { 0.25 * apart };
            let radius = radius.min(0.22);
            let thickness = (apart - 2.0 * radius).min(2.0 * radius);
            let field = Field::Tube(Tube::new(line, radius));
            Ok(Shape { field, components: 1, genus: 1, thickness })
        }
        Class::Gyroid => {
            // Struts are a third of a period wide; where the ball cuts them, necks can be narrower. They are as wide as twice
            // the largest offset that changes nothing.
            const TRIES: u64 = 40;
            let period = (2.0 * t / 0.35).clamp(0.8, 1.6);
            let mut best: Option<Shape> = None;
            for attempt in 0..TRIES {
                let dice = &mut Dice::new(seed + 1_000_003 * attempt)?;
                let off = [0; 3].map(|_| dice.real(0.0, period));
                let gyroid = Field::Gyroid(period).at(off);
                let field = Field::Meet(0.05, Box::new([gyroid, Field::Ball(1.1)]));
                let at = |level: f64| counted(&field, level, 1.3, 48);
                let (components, genus) = at(0.0);
                let is_stable = |level: f64| {
                    [-level, level].iter().all(|&level| at(level) == (components, genus))
                };
                let thickness = [0.5, 0.35, 0.2, 0.1].map(|part| part * t);
                let thickness = thickness.into_iter().find(|&level| is_stable(level));
                let thickness = 2.0 * thickness.unwrap_or(0.02 * t);
                if best.as_ref().is_none_or(|best| thickness > best.thickness) {
                    best = Some(Shape { field, components, genus, thickness });
                }
                if thickness >= t {
                    break;
                }
            }
            best.context("no gyroid was drawn")
        }
        Class::Shells => {
            let count = dice.whole(2, 4).min(1 + (0.8 / t) as usize);
            let ball = |k: usize| {
                Field::Ball(1.1 - t * k as f64).at([0.0, 0.0, 0.05 * t * (k % 2) as f64])
            };
            // What is in an odd number of them.
            let mut field = ball(count - 1);
            for k in (0..count - 1).rev() {
                field = Field::Cut(vec![ball(k), field]);
            }
            Ok(Shape { field, components: count, genus: 0, thickness: 0.95 * t })
        }
        Class::Blend => {
            // Necks and gaps are wide if offsets to both sides change nothing.
            for attempt in 0..400 {
                let dice = &mut Dice::new(seed + 1_000_003 * attempt)?;
                let bodies = dice.whole(3, 6);
                let body = |_| {
                    let place = [0; 3].map(|_| dice.real(-0.8, 0.8));
                    let turn = dice.real(0.0, TAU);
                    let ring = Field::Ring(dice.real(0.3, 0.5), dice.real(0.1, 0.18));
                    let ball = Field::Ball(dice.real(0.2, 0.4));
                    let one = if dice.whole(0, 1) == 0 { ring } else { ball };
                    one.about(0, turn).at(place)
                };
                let field = Field::Blend(0.05, (0..bodies).map(body).collect());
                let at = |level: f64| counted(&field, level, RADIUS_MAX, 92);
                let (components, genus) = at(0.0);
                let t = t.min(0.2);
                if [-0.5 * t, 0.5 * t].iter().all(|&level| at(level) == (components, genus)) {
                    return Ok(Shape { field, components, genus, thickness: t });
                }
            }
            bail!("no blend of thickness {t} was found from seed {seed}")
        }
        Class::Blades => {
            let (blades, pitch) = (dice.whole(3, 6), dice.real(0.3, 1.0));
            let blade = |k: usize| {
                let own = Field::Slab([0.5, 0.28, 0.5 * t]).about(0, pitch);
                own.at([0.65, 0.0, 0.0]).about(2, TAU * k as f64 / blades as f64)
            };
            let hub = Field::Drum(0.3, 0.4);
            known(Field::Any([hub].into_iter().chain((0..blades).map(blade)).collect()), 1, 0)
        }
        Class::Balls => {
            let radius = dice.real(0.3, 0.4);
            let place =
                |k: usize| [k, k >> 1, k >> 2].map(|k| ((k & 1) as f64 - 0.5) * (2.0 * radius + t));
            known(Field::Any((0..8).map(|k| Field::Ball(radius).at(place(k))).collect()), 8, 0)
        }
        Class::Links => {
            let tube = (0.5 * (0.5 - t)).max(0.08);
            let link = |k: usize| {
                let turn = 0.25 * TAU * (k % 2) as f64;
                Field::Ring(0.5, tube).about(0, turn).at([0.5 * (k as f64 - 1.0), 0.0, 0.0])
            };
            // The first and the third ring lie in one plane, and would meet.
            let chain = [0, 1].map(link).to_vec();
            let thickness = (0.5 - 2.0 * tube).min(2.0 * tube);
            Ok(Shape { field: Field::Any(chain), components: 2, genus: 2, thickness })
        }
        Class::Lattice => {
            let cells = dice.whole(1, 2);
            let half = 0.9;
            let mut beams = vec![];
            let at = |k: usize| 2.0 * half * k as f64 / cells as f64 - half;
            for axis in 0..3 {
                for (j, k) in (0..=cells).flat_map(|j| (0..=cells).map(move |k| (j, k))) {
                    let (mut sides, mut place) = ([0.5 * t; 3], [0.0; 3]);
                    sides[axis] = half + 0.5 * t;
                    place[(axis + 1) % 3] = at(j);
                    place[(axis + 2) % 3] = at(k);
                    beams.push(Field::Slab(sides).at(place));
                }
            }
            let (nodes, edges) = ((cells + 1).pow(3), 3 * cells * (cells + 1).pow(2));
            known(Field::Any(beams), 1, edges - nodes + 1)
        }
        Class::Pipes => {
            // Bores are as wide as walls.
            let (most, long) = if t > 0.34 { (2, 0.7) } else { (4, 1.0) };
            let pipes = dice.whole(2, 4).min(most);
            let radius = dice.real(0.25, 0.32).max(1.5 * t);
            let half = dice.real(0.6, long);
            let pitch = 2.0 * radius + t;
            let pipe = |k: usize| {
                let rows = (pipes - 1) >> 1;
                let off = [(k & 1, 1), (k >> 1, rows)];
                let off = off.map(|(k, last)| pitch * (k as f64 - 0.5 * last as f64));
                let bore = Field::Drum(radius - t, 2.0);
                Field::Cut(vec![Field::Drum(radius, half), bore]).at([off[0], off[1], 0.0])
            };
            known(Field::Any((0..pipes).map(pipe).collect()), pipes, pipes)
        }
        Class::Coil => {
            let turns = dice.real(2.5, 4.5).min(1.8 / (2.2 * t)).max(1.5);
            let rise = 2.0 / turns;
            let steps = 160;
            let place = |k: usize| {
                let s = k as f64 / steps as f64;
                let angle = TAU * turns * s;
                [0.7 * angle.cos(), 0.7 * angle.sin(), 2.0 * s - 1.0]
            };
            let line: Vec<Point> = (0..=steps).map(place).collect();
            let radius = (0.5 * (0.97 * rise - t)).clamp(0.5 * t, 0.25);
            let thickness = (0.97 * rise - 2.0 * radius).min(2.0 * radius);
            let field = Field::Tube(Tube::new(line, radius));
            Ok(Shape { field, components: 1, genus: 0, thickness })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_have_the_topology_that_they_are_said_to_have() {
        // What gyroids and blends are is counted when they are drawn.
        let is_known = |class: Class| ![Class::Gyroid, Class::Blend].contains(&class);
        for (class, name) in Class::ALL.into_iter().filter(|&(class, _)| is_known(class)) {
            for seed in 0..2 {
                let shape = shape(class, 0.25, seed).unwrap();
                let found = counted(&shape.field, 0.0, RADIUS_MAX, 32);
                assert_eq!(found, (shape.components, shape.genus), "{name} {seed}");
            }
        }
    }
}
