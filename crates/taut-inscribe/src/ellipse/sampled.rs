//! The largest ellipse around no sample of the rings: Algorithm 12 of the thesis, and its implementation.
//!
//! *Problem.* Among ellipses that have no sample inside, pass through three samples whose triangle holds the center, have normals near those of
//! the rings there, and are at least as thick as c spacings of the samples, find the one of the largest area.
//! *Idea.* A sample (x, y) is lifted to (x², y², 2xy, x, y). Conics with all samples outside are then half-spaces of ℝ⁵ that hold all lifted
//! samples; those through three samples p, q, r support the hull ([`hull`]) at a simplex of these. They are a convex cone of dimension 3, whose
//! extreme rays are the facets around the simplex. Each condition on a normal is two linear ones. Area is quasi-convex along pencils of
//! conics through four points, so that it is largest at a corner of the cone or where thickness ends an edge of it.
//! *Five points.* Without conditions on normals and thickness the largest ellipse passes through five samples: one facet.
//! *Corrections.* Those of [`conic`]; normals agree where their product is at least cos α; a simplex may be in any number of facets; and 1 − 1/(2c)
//! bounds lengths, so that areas have its square.
//! *Last step.* The polygon may enter the ellipse between samples: the largest ellipse of the same center and shape inside is the answer.
//! *Trap.* Samples on one conic are on one hyperplane: the lifted samples are rounded to whole numbers and perturbed.
//! *Reference.* Thesis, section 8.4.

mod conic;
mod hull;
mod samples;

use taut_points::{Cancelled, Monitor, OrderBy};

use self::conic::{Conic, Real};
use self::hull::{DIFFERENCE_MAX, Facet};
use self::samples::{Sample, samples};
use super::ascent::Ellipse;
use super::method::EllipseThesisOptions;
use crate::levels::Levels;
use crate::random::Random;
use crate::units::Units;

/// Lifted coordinates are from −2 to 2: what brings them to a quarter of the largest difference.
const LIFT_SCALE: f64 = (DIFFERENCE_MAX / 4 - PERTURBATION) as f64;

/// Largest change of a lifted coordinate by the perturbation, before it is rounded: 4e-6 of the extent.
const PERTURBATION: i64 = 8;

/// Parts of an edge of a cone between which thickness and center are looked at.
const EDGE_PARTS: usize = 6;

/// Halvings of a part of an edge in which the conditions end.
const HALVINGS: usize = 30;

/// How far a gradient may be beyond the largest angle, as a sine, for rounding of corners of a cone that lie on its border.
const NORMAL_SLACK: f64 = 1e-6;

/// The places of three out of five corners, ascending; the first is that of three out of three.
const TRIPLES: [[usize; 3]; 10] = [
    [0, 1, 2],
    [0, 1, 3],
    [0, 1, 4],
    [0, 2, 3],
    [0, 2, 4],
    [0, 3, 4],
    [1, 2, 3],
    [1, 2, 4],
    [1, 3, 4],
    [2, 3, 4],
];

/// What a method found.
pub(super) struct Sampled {
    pub(super) ellipse: Option<Ellipse>,
    pub(super) samples: u64,
    pub(super) facets: u64,
}

/// The samples, and the best ellipse so far.
struct Search<'a> {
    units: &'a Units,
    levels: Levels,
    /// The middle of the bounding box, which is the origin of samples and conics.
    middle: [f64; 2],
    samples: Vec<Sample>,
    least_axis: f64,
    /// Sine and cosine of the largest angle.
    angle: (f64, f64),
    best: Option<Real>,
}

/// Finds the largest ellipse through five samples, or through three.
pub(super) fn largest(
    units: &Units,
    options: &EllipseThesisOptions,
    has_five: bool,
    monitor: &Monitor<'_>,
) -> Result<Sampled, Cancelled> {
    let (search, facets) = searched(units, options, has_five, monitor)?;
    let ellipse = search.best.map(|best| {
        let center = [0, 1].map(|k| best.center[k] + search.middle[k]);
        Ellipse::of(best.shape, center, &units.edges)
    });
    Ok(Sampled { ellipse, samples: search.samples.len() as u64, facets })
}

/// Looks at all simplices of the hull, and counts its facets.
fn searched<'a>(
    units: &'a Units,
    options: &EllipseThesisOptions,
    has_five: bool,
    monitor: &Monitor<'_>,
) -> Result<(Search<'a>, u64), Cancelled> {
    let (mut list, spacing) = samples(&units.edges, options.sample_count as usize);
    let middle = units.extent.map(|x| 0.5 * x);
    for sample in &mut list {
        sample.at = [0, 1].map(|k| sample.at[k] - middle[k]);
    }
    let mut random = Random::new(options.seed);
    random.shuffle(&mut list);
    let lifted: Vec<hull::Point> = list.iter().map(|sample| lift(sample.at, &mut random)).collect();
    let facets = hull::facets(&lifted, monitor)?;
    let mut search = Search {
        units,
        levels: Levels::of(&units.edges, units.extent[1]),
        middle,
        samples: list,
        least_axis: options.fatness * spacing,
        angle: options.angle.to_radians().sin_cos(),
        best: None,
    };
    let conics: Vec<Conic> = facets.iter().map(conic_of).collect();
    match has_five {
        true => {
            facets.iter().zip(&conics).for_each(|(f, conic)| search.consider(conic, &f.corners))
        }
        false => search.all_triples(&facets, &conics, monitor)?,
    }
    Ok((search, facets.len() as u64))
}

/// The lifted sample, rounded to whole numbers and perturbed.
fn lift([x, y]: [f64; 2], random: &mut Random) -> hull::Point {
    [x * x, y * y, 2.0 * x * y, x, y].map(|coordinate| {
        let shift = random.below(2 * PERTURBATION as usize + 1) as i64 - PERTURBATION;
        (coordinate * LIFT_SCALE).round() as i64 + shift
    })
}

/// The conic of a facet, which no sample is below.
fn conic_of(facet: &Facet) -> Conic {
    let offset = facet.offset as f64 / LIFT_SCALE;
    let normal = facet.normal.map(|n| n as f64);
    let largest = normal.iter().fold(offset.abs(), |most, n| most.max(n.abs()));
    let [xx, yy, xy, x, y] = normal.map(|n| -n / largest);
    Conic { q: [xx, xy, yy], r: [x, y], f: offset / largest }
}

impl Search<'_> {
    /// Algorithm 12: all triples of samples that are simplices of the hull.
    fn all_triples(
        &mut self,
        facets: &[Facet],
        conics: &[Conic],
        monitor: &Monitor<'_>,
    ) -> Result<(), Cancelled> {
        let mut incidences: Vec<([u32; 3], u32)> = vec![];
        for (number, facet) in facets.iter().enumerate() {
            let triples = TRIPLES.map(|triple| triple.map(|place| facet.corners[place]));
            incidences.extend(triples.map(|triple| (triple, number as u32)));
        }
        incidences.order();
        for around in incidences.chunk_by(|one, other| one.0 == other.0) {
            monitor.check()?;
            let triple = around[0].0;
            let facets_around = around.iter().map(|&(_, number)| number as usize);
            let cycle =
                cycle(triple, facets_around.map(|number| (&facets[number], number)).collect());
            let cone = cycle.into_iter().map(|number| conics[number]).collect();
            self.triple(triple, cone);
        }
        Ok(())
    }

    /// The largest ellipse through three samples, out of the cone of conics around their simplex.
    fn triple(&mut self, triple: [u32; 3], mut cone: Vec<Conic>) {
        for sample in triple {
            let Sample { at, normal } = self.samples[sample as usize];
            for border in self.borders(normal) {
                cone = clipped(&cone, |conic| dot(conic.gradient(at), border));
            }
        }
        for (i, one) in cone.iter().enumerate() {
            self.consider(one, &triple);
            let other = &cone[if i + 1 == cone.len() { 0 } else { i + 1 }];
            let at = |share: f64| one.mixed(1.0 - share, other, share);
            for part in 0..EDGE_PARTS {
                let [mut from, mut to] = [part, part + 1].map(|k| k as f64 / EDGE_PARTS as f64);
                let starts = self.feasible(&at(from), &triple).is_some();
                if starts == self.feasible(&at(to), &triple).is_some() {
                    continue;
                }
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (from + to);
                    let is_like_start = self.feasible(&at(middle), &triple).is_some() == starts;
                    *(if is_like_start { &mut from } else { &mut to }) = middle;
                }
                self.consider(&at(if starts { from } else { to }), &triple);
            }
        }
    }

    /// Two vectors that a gradient makes products of at least 0 with where its angle to a normal is at most the largest.
    fn borders(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 2] {
        let (sine, cosine) = self.angle;
        [cosine, -cosine].map(|turn| [sine * x - turn * y, turn * x + sine * y])
    }

    /// The ellipse of a conic through some samples, if it meets all conditions.
    fn feasible(&self, conic: &Conic, touched: &[u32]) -> Option<Real> {
        let found = conic.ellipse()?;
        let at = |place: usize| self.samples[touched[place] as usize].at;
        let holds_center = |triple: &[usize; 3]| {
            let [p, q, r] = triple.map(at);
            let sides = [[p, q], [q, r], [r, p]].map(|[p, q]| {
                (q[0] - p[0]) * (found.center[1] - p[1]) - (q[1] - p[1]) * (found.center[0] - p[0])
            });
            sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)
        };
        let triples: &[[usize; 3]] = if touched.len() == 3 { &TRIPLES[..1] } else { &TRIPLES };
        let is_thick = found.least_axis >= self.least_axis;
        (is_thick && triples.iter().any(holds_center)).then_some(found)
    }

    /// Takes the ellipse of a conic through some samples, if it meets all conditions and is the largest so far.
    fn consider(&mut self, conic: &Conic, touched: &[u32]) {
        let Some(found) = self.feasible(conic, touched) else { return };
        let least = self.best.map_or(0.0, |best| best.square_of_size);
        let has_normals = || {
            touched.iter().all(|&sample| {
                let Sample { at, normal } = self.samples[sample as usize];
                let gradient = conic.gradient(at);
                let rounding = NORMAL_SLACK * gradient[0].hypot(gradient[1]);
                self.borders(normal).iter().all(|&border| dot(gradient, border) >= -rounding)
            })
        };
        let center = [0, 1].map(|k| found.center[k] + self.middle[k]);
        if found.square_of_size > least
            && has_normals()
            && self.levels.is_inside(&self.units.edges, center)
        {
            self.best = Some(found);
        }
    }
}

fn dot(u: [f64; 2], v: [f64; 2]) -> f64 {
    u[0] * v[0] + u[1] * v[1]
}

/// The facets around a simplex of three corners, each next to the one before: by their other two corners, which are edges of a cycle.
fn cycle(triple: [u32; 3], facets: Vec<(&Facet, usize)>) -> Vec<usize> {
    let others = |facet: &Facet| {
        let mut rest = facet.corners.into_iter().filter(|corner| !triple.contains(corner));
        [(); 2].map(|()| rest.next().unwrap_or_default())
    };
    let mut open: Vec<([u32; 2], usize)> =
        facets.into_iter().map(|(facet, number)| (others(facet), number)).collect();
    let mut found = vec![];
    let mut end = open.first().map(|first| first.0[0]);
    while let Some(place) =
        open.iter().position(|(pair, _)| end.is_some_and(|end| pair.contains(&end)))
    {
        let ([one, other], number) = open.swap_remove(place);
        end = Some(if end == Some(one) { other } else { one });
        found.push(number);
    }
    found
}

/// The part of a convex cone, given by its extreme rays in order, where a linear function is at least 0.
fn clipped(cone: &[Conic], value: impl Fn(&Conic) -> f64) -> Vec<Conic> {
    let mut kept = vec![];
    for (i, one) in cone.iter().enumerate() {
        let other = &cone[if i + 1 == cone.len() { 0 } else { i + 1 }];
        let (here, there) = (value(one), value(other));
        if here >= 0.0 {
            kept.push(*one);
        }
        if here * there < 0.0 {
            kept.push(one.mixed(there.abs(), other, here.abs()).normalized());
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Loops;

    /// The conic through five points, as the null vector of five rows by elimination with full pivots.
    fn through(points: [[f64; 2]; 5]) -> Conic {
        let mut rows = points.map(|[x, y]| [x * x, y * y, 2.0 * x * y, x, y, 1.0]);
        let mut order = [0, 1, 2, 3, 4, 5];
        for step in 0..5 {
            let places = (step..5).flat_map(|i| (step..6).map(move |j| (i, j)));
            let size = |&(i, j): &(usize, usize)| rows[i][j].abs();
            let (i, j) = places.max_by(|p, q| size(p).total_cmp(&size(q))).unwrap();
            rows.swap(step, i);
            rows.iter_mut().for_each(|row| row.swap(step, j));
            order.swap(step, j);
            for other in 0..5 {
                if other != step {
                    let factor = rows[other][step] / rows[step][step];
                    for k in step..6 {
                        rows[other][k] -= factor * rows[step][k];
                    }
                }
            }
        }
        let mut found = [0.0; 6];
        found[order[5]] = 1.0;
        for step in 0..5 {
            found[order[step]] = -rows[step][5] / rows[step][step];
        }
        // So that it is below 0 inside.
        let sign = found[0].signum();
        let [xx, yy, xy, x, y, f] = found.map(|value| sign * value);
        Conic { q: [xx, xy, yy], r: [x, y], f }
    }

    /// A star of wavy radius around the middle of its bounding box.
    fn star(seed: u64) -> Units {
        let mut random = Random::new(seed);
        let waves: Vec<(f64, f64)> =
            (2..6).map(|_| (0.12 * random.unit(), std::f64::consts::TAU * random.unit())).collect();
        let point = |i: usize| {
            let angle = std::f64::consts::TAU * i as f64 / 60.0;
            let wave = |(k, &(size, phase)): (usize, &(f64, f64))| {
                size * ((k + 2) as f64 * angle + phase).cos()
            };
            let radius = 1.0 + waves.iter().enumerate().map(wave).sum::<f64>();
            [radius * angle.cos(), radius * angle.sin()]
        };
        let mut loops = Loops::default();
        loops.push(&(0..60).map(point).collect::<Vec<_>>());
        Units::of(&loops.segments)
    }

    #[test]
    fn no_conic_through_five_samples_and_around_none_is_larger() {
        for seed in 0..6 {
            let units = star(seed);
            let options =
                EllipseThesisOptions { sample_count: 16, fatness: 0.0, angle: 70.0, seed: 1 };
            let (search, facets) = searched(&units, &options, true, &Monitor::silent()).unwrap();
            assert!(facets > 50, "{facets}");
            let best = search.best.map_or(0.0, |best| best.square_of_size);
            let samples = &search.samples;
            let mut expected: f64 = 0.0;
            let count = samples.len() as u32;
            for set in (0u32..1 << count).filter(|set| set.count_ones() == 5) {
                let mut members = (0..count).filter(|i| set >> i & 1 == 1);
                let touched = [(); 5].map(|()| members.next().unwrap());
                let conic = through(touched.map(|i| samples[i as usize].at));
                let value = |sample: &Sample| {
                    let [x, y] = sample.at;
                    let [a, b, c] = conic.q;
                    let square = a * x * x + 2.0 * b * x * y + c * y * y;
                    square + conic.r[0] * x + conic.r[1] * y + conic.f
                };
                let is_empty = samples.iter().all(|sample| value(sample) >= -1e-9);
                let mut other = Search {
                    best: None,
                    samples: samples.clone(),
                    levels: Levels::of(&units.edges, units.extent[1]),
                    ..search
                };
                if is_empty {
                    other.consider(&conic, &touched);
                }
                expected = expected.max(other.best.map_or(0.0, |best| best.square_of_size));
            }
            // The perturbation changes lifted samples by 4e-6, and coefficients of sparse samples by some tens of that.
            assert!((best / expected - 1.0).abs() < 1e-3, "{seed}: {best} and {expected}");
            let (three, _) = searched(&units, &options, false, &Monitor::silent()).unwrap();
            let of_three = three.best.map_or(0.0, |best| best.square_of_size);
            assert!(of_three >= best, "{seed}: {of_three} below {best}");
        }
    }

    #[test]
    fn a_cone_is_cut_where_the_function_is_0() {
        let conic = |x: f64, y: f64| Conic { q: [1.0, 0.0, 1.0], r: [x, y], f: 0.0 };
        let cone = [conic(-1.0, 0.0), conic(1.0, 0.0), conic(0.0, 1.0)];
        let cut = clipped(&cone, |conic| conic.r[0]);
        assert_eq!(cut.len(), 3);
        assert!(cut.iter().all(|conic| conic.r[0] >= 0.0) && cut.iter().any(|c| c.r == [0.0; 2]));
        assert!(clipped(&cone, |conic| -conic.q[0]).is_empty());
    }
}
