//! Fifteen classes of surfaces with a boundary: pieces of bodies' surfaces and of terrains, with rims and holes that are not smaller than told.

use super::fields::{Field, Terrain, Tube};
use super::shapes::Dice;
use super::*;

/// What a sheet is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Cap,
    PiercedBall,
    Pipe,
    PiercedPipe,
    PiercedRing,
    HalfRing,
    Hills,
    PiercedHills,
    Steps,
    Tray,
    Branches,
    TwoSheets,
    Gutter,
    Scallop,
    PiercedKnot,
}

impl Kind {
    /// All of them, with what tables call them.
    pub(super) const ALL: [(Self, &'static str); 15] = [
        (Self::Cap, "cap"),
        (Self::PiercedBall, "pierced ball"),
        (Self::Pipe, "pipe"),
        (Self::PiercedPipe, "pierced pipe"),
        (Self::PiercedRing, "pierced ring"),
        (Self::HalfRing, "half ring"),
        (Self::Hills, "hills"),
        (Self::PiercedHills, "pierced hills"),
        (Self::Steps, "steps and dents"),
        (Self::Tray, "tray"),
        (Self::Branches, "branches"),
        (Self::TwoSheets, "two sheets"),
        (Self::Gutter, "gutter"),
        (Self::Scallop, "scalloped hills"),
        (Self::PiercedKnot, "pierced knot"),
    ];
}

/// A surface with a boundary: where one function is zero and another one negative.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    pub(super) field: Field,
    pub(super) trim: Field,
    pub(super) components: usize,
    pub(super) genus: u64,
    /// Boundary loops.
    pub(super) loops: usize,
}

impl Sheet {
    /// Whether a point of the surface is on the sheet.
    pub(super) fn has(&self, point: Point) -> bool {
        self.trim.value(point) < 0.0
    }
}

/// Everything, as far as these shapes reach.
const ALL: Field = Field::Slab([9.0; 3]);

/// What is on one side of a plane: all that is above a level along an axis.
fn above(axis: usize, level: f64) -> Field {
    let mut place = [0.0; 3];
    place[axis] = level + 9.0;
    ALL.at(place)
}

/// All but for balls of this radius.
fn pierced(body: Field, places: &[Point], radius: f64) -> Field {
    let holes = places.iter().map(|&place| Field::Ball(radius).at(place));
    Field::Cut([body].into_iter().chain(holes).collect())
}

/// Hills of a few waves, this high at most.
fn hills(dice: &mut Dice, high: f64) -> Terrain {
    let count = dice.whole(2, 4);
    let wave = |_| {
        let (long, angle) = (dice.real(1.5, 4.0), dice.real(0.0, TAU));
        [high / count as f64, long * angle.cos(), long * angle.sin(), dice.real(0.0, TAU)]
    };
    Terrain { waves: (0..count).map(wave).collect(), ..Terrain::default() }
}

const AXES: [Point; 6] = [
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
];

/// The sheet of a kind whose holes have at least this radius, as far as there is room.
pub(super) fn sheet(kind: Kind, hole: f64, seed: u64) -> Result<Sheet> {
    let dice = &mut Dice::new(seed)?;
    let square = Field::Slab([1.0, 1.0, 9.0]);
    let known = |field: Field, trim: Field, [components, genus, loops]: [usize; 3]| {
        Ok(Sheet { field, trim, components, genus: genus as u64, loops })
    };
    let wide = |most: f64| hole.min(most);
    match kind {
        Kind::Cap => known(Field::Ball(1.0), above(2, dice.real(-0.7, 0.6)), [1, 0, 1]),
        Kind::PiercedBall => {
            let holes = dice.whole(2, 6);
            let trim = pierced(ALL, &AXES[..holes], wide(0.6));
            known(Field::Ball(1.0), trim, [1, 0, holes])
        }
        Kind::Pipe => {
            let pipe = Field::Drum(dice.real(0.4, 0.8), 9.0);
            known(pipe, Field::Slab([9.0, 9.0, dice.real(0.4, 1.0)]), [1, 0, 2])
        }
        Kind::PiercedPipe => {
            let (radius, holes) = (dice.real(0.6, 0.8), dice.whole(1, 4));
            let places: Vec<Point> = AXES[..holes].iter().map(|p| p.map(|x| radius * x)).collect();
            let trim = pierced(Field::Slab([9.0, 9.0, 0.8]), &places, wide(0.35));
            known(Field::Drum(radius, 9.0), trim, [1, 0, 2 + holes])
        }
        Kind::PiercedRing => {
            let holes = dice.whole(1, 4);
            let places: Vec<Point> = AXES[..holes].iter().map(|p| p.map(|x| 1.15 * x)).collect();
            let trim = pierced(ALL, &places, wide(0.36));
            known(Field::Ring(0.8, 0.35), trim, [1, 1, holes])
        }
        Kind::HalfRing => {
            let ring = Field::Ring(0.8, dice.real(0.2, 0.35));
            known(ring, above(1, dice.real(-0.3, 0.3)), [1, 0, 2])
        }
        Kind::Hills => known(Field::Terrain(hills(dice, 0.4)), square, [1, 0, 1]),
        Kind::PiercedHills => {
            let (hills, holes) = (hills(dice, 0.4), dice.whole(1, 4));
            let places = [[0.5, 0.5], [-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5]];
            let bore = |&[x, y]: &[f64; 2]| Field::Drum(wide(0.35), 9.0).at([x, y, 0.0]);
            let trim = [square].into_iter().chain(places[..holes].iter().map(bore)).collect();
            known(Field::Terrain(hills), Field::Cut(trim), [1, 0, 1 + holes])
        }
        Kind::Steps => {
            let mut terrain = hills(dice, 0.1);
            let step = |k: usize| {
                let high = dice.real(0.15, 0.3);
                [dice.real(0.0, TAU), 0.4 * k as f64 - 0.2, high, high * dice.real(0.15, 0.4)]
            };
            terrain.steps = (0..2).map(step).collect();
            let dent = |k: usize| {
                let deep = dice.real(0.1, 0.25);
                let wide = deep * dice.real(0.6, 1.2);
                [k as f64 - 0.5, dice.real(-0.5, 0.5), deep, wide]
            };
            terrain.dents = (0..2).map(dent).collect();
            known(Field::Terrain(terrain), square, [1, 0, 1])
        }
        Kind::Tray => {
            let half = [dice.real(0.6, 1.0), dice.real(0.6, 1.0), dice.real(0.2, 0.6)];
            let lid = above(2, half[2] - 1e-3);
            known(Field::Slab(half), Field::Cut(vec![ALL, lid]), [1, 0, 1])
        }
        Kind::Branches => {
            let branches = dice.whole(3, 6);
            let radius = dice.real(0.2, 0.25);
            let branch = |p: &Point| {
                let line = vec![[0.0; 3], p.map(|x| 2.0 * x)];
                Field::Tube(Tube::new(line, radius))
            };
            let all = AXES[..branches].iter().map(branch).collect();
            known(Field::Blend(0.03, all), Field::Ball(1.1), [1, 0, branches])
        }
        Kind::TwoSheets => {
            let (hills, gap) = (hills(dice, 0.3), 1.6 * hole);
            let at = |z: f64| Field::Terrain(hills.clone()).at([0.0, 0.0, z]);
            known(Field::Cut(vec![at(0.5 * gap), at(-0.5 * gap)]), square, [2, 0, 2])
        }
        Kind::Gutter => {
            let half = Field::Slab([9.0, 9.0, dice.real(0.5, 1.0)]);
            let trim = half.at([0.0, 9.0 + dice.real(-0.3, 0.3), 0.0]);
            known(Field::Drum(dice.real(0.6, 0.9), 9.0), trim, [1, 0, 1])
        }
        Kind::Scallop => {
            let bites = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
            let bite = |[x, y]: [f64; 2]| Field::Drum(dice.real(0.2, 0.6), 9.0).at([x, y, 0.0]);
            let trim = [square].into_iter().chain(bites.map(bite)).collect();
            let terrain = hills(&mut Dice::new(seed + 1)?, 0.4);
            known(Field::Terrain(terrain), Field::Cut(trim), [1, 0, 1])
        }
        Kind::PiercedKnot => {
            let steps = 144;
            let place = |k: usize, off: f64| {
                let angle = TAU * k as f64 / steps as f64;
                let radius = 0.95 + 0.42 * (3.0 * angle).cos() + off;
                let (sin, cos) = (2.0 * angle).sin_cos();
                [radius * cos, radius * sin, 0.42 * (3.0 * angle).sin()]
            };
            let line = (0..=steps).map(|k| place(k, 0.0)).collect();
            let holes = dice.whole(1, 4);
            // Where the line is farthest out.
            let places: Vec<Point> =
                [0, 48, 96].iter().map(|&k| place(k, 0.2)).take(holes).collect();
            let trim = pierced(ALL, &places, wide(0.22));
            known(Field::Tube(Tube::new(line, 0.2)), trim, [1, 1, holes.min(3)])
        }
    }
}
