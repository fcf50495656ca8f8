//! The maximum volume ellipsoid in a polytope {x : aᵢᵀx ≤ bᵢ}, bracketed in 256 bits.
//!
//! *Lower bound.* For any center c and positive definite H, the ellipsoid {c + σH^½z : |z| ≤ 1} lies in the polytope for
//! σ = minᵢ (bᵢ − aᵢᵀc)/hᵢ with hᵢ = √(aᵢᵀHaᵢ), and its log-volume is log κ_d + ½·log det H + d·log σ.
//! *Upper bound.* For λ ≥ 0 with Σλᵢaᵢ = 0, W = Σλᵢaᵢaᵢᵀ/hᵢ and β = Σλᵢbᵢ, no ellipsoid in the polytope has a log-volume above
//! log κ_d + d·log(β/d) − log det W − ½·log det H. Proof in the frame where H = I: {w + Bz} with B symmetric has
//! aᵢᵀw + aᵢᵀBaᵢ/|aᵢ| ≤ bᵢ; summed up, tr(BW) ≤ β, and tr(BW) ≥ d·(det B·det W)^(1/d). That Σλᵢaᵢ = 0 holds exactly is made
//! sure of by d of the λ, which are intervals that contain the solution.
//! *Solver.* The primal–dual method of Zhang and Gao in plain 256 bits; nothing that is proved depends on it.
//! *Reference.* Zhang and Gao, SIAM J. Optim. 14(1), 2003; Khachiyan and Todd, Math. Programming 61, 1993.

use super::interval::{Interval, log_unit_ball};
use super::linear::{Factor, Matrix, Vector, Way, dot, eliminated, image};
use super::mvee::{Bracket, longest};

/// At most this many steps are made.
const STEPS_MAX: usize = 120;
/// Steps end at this μ, as a power of two.
const GAP_EXPONENT: i64 = -110;

/// One half-space aᵀx ≤ b, with entries of a of about 1.
#[derive(Clone)]
pub(super) struct Side {
    pub(super) normal: Vector,
    pub(super) bound: Interval,
}

/// Center, H and multipliers that are nearly the best.
struct Guess {
    center: Vector,
    shape: Matrix,
    multipliers: Vector,
}

/// A bracket of the largest log-volume, from a point inside; `None` where none is found.
pub(super) fn bracket(sides: &[Side], inside: &[Interval]) -> Option<Bracket> {
    let guess = solve(sides, inside)?;
    Some(Bracket { lower: lower(sides, &guess)?, upper: upper(sides, &guess)? })
}

/// hᵢ for all sides.
fn widths(sides: &[Side], shape: &[Vector]) -> Option<Vector> {
    sides.iter().map(|s| dot(&s.normal, &image(shape, &s.normal)).root()).collect()
}

fn lower(sides: &[Side], guess: &Guess) -> Option<Interval> {
    let widths = widths(sides, &guess.shape)?;
    let mut least: Option<Interval> = None;
    for (side, width) in sides.iter().zip(&widths) {
        let part = side.bound.minus(&dot(&side.normal, &guess.center)).over(width)?;
        least = Some(match least {
            Some(least) if least.at_most(&part) == Some(true) => least,
            Some(least) if part.at_most(&least) == Some(true) => part,
            Some(least) => super::mvee::larger(least.negative(), part.negative()).negative(),
            None => part,
        });
    }
    let d = guess.center.len();
    let volume = Factor::of(&guess.shape, Way::Proved)?.determinant().ln()?.scaled(-1);
    let scale = least?.ln()?.times(&Interval::integer(d as i64));
    Some(log_unit_ball(d).plus(&volume).plus(&scale).lower())
}

fn upper(sides: &[Side], guess: &Guess) -> Option<Interval> {
    let d = guess.center.len();
    let multipliers = balanced(sides, &guess.multipliers)?;
    let widths = widths(sides, &guess.shape)?;
    let mut weighted = vec![vec![Interval::zero(); d]; d];
    let mut beta = Interval::zero();
    for ((side, width), lambda) in sides.iter().zip(&widths).zip(&multipliers) {
        beta = beta.plus(&lambda.times(&side.bound));
        let part = lambda.over(width)?;
        for (j, row) in weighted.iter_mut().enumerate() {
            let term = part.times(&side.normal[j]);
            for (entry, a) in row.iter_mut().zip(&side.normal) {
                *entry = entry.plus(&term.times(a));
            }
        }
    }
    let dim = Interval::integer(d as i64);
    let spread = beta.over(&dim)?.ln()?.times(&dim);
    let of_weights = Factor::of(&weighted, Way::Proved)?.determinant().ln()?;
    let of_shape = Factor::of(&guess.shape, Way::Proved)?.determinant().ln()?.scaled(-1);
    Some(log_unit_ball(d).plus(&spread).minus(&of_weights).minus(&of_shape).upper())
}

/// Multipliers at least 0 with Σλᵢaᵢ = 0 exactly for some choice from the intervals.
fn balanced(sides: &[Side], guess: &[Interval]) -> Option<Vector> {
    let d = sides[0].normal.len();
    let mut multipliers: Vector =
        guess.iter().map(|l| if l.is_positive() { l.middle() } else { Interval::zero() }).collect();
    let mut order: Vec<usize> = (0..sides.len()).collect();
    let weight = |i: usize| multipliers[i].rounded();
    order.sort_by(|&i, &j| weight(j).total_cmp(&weight(i)));
    // The d sides of the largest multipliers whose normals are independent, by Gram–Schmidt.
    let (mut chosen, mut spanned): (Vec<usize>, Matrix) = (vec![], vec![]);
    for i in order {
        let mut rest = sides[i].normal.clone();
        for known in &spanned {
            let along = dot(known, &rest).over(&dot(known, known))?;
            for (r, k) in rest.iter_mut().zip(known) {
                *r = r.minus(&along.times(k)).into_middle();
            }
        }
        if dot(&rest, &rest).rounded() > 1e-6 && chosen.len() < d {
            chosen.push(i);
            spanned.push(rest);
        }
    }
    if chosen.len() < d {
        return None;
    }
    let residual = |j: usize| {
        let terms = sides.iter().zip(&multipliers);
        terms.fold(Interval::zero(), |sum, (s, l)| sum.plus(&l.times(&s.normal[j])))
    };
    let columns: Matrix =
        (0..d).map(|j| chosen.iter().map(|&i| sides[i].normal[j].clone()).collect()).collect();
    let right: Matrix = (0..d).map(|j| vec![residual(j).negative()]).collect();
    let (correction, _) = eliminated(&columns, &right, Way::Proved)?;
    for (&i, correction) in chosen.iter().zip(&correction) {
        multipliers[i] = multipliers[i].plus(&correction[0]);
    }
    chosen.iter().all(|&i| multipliers[i].is_positive()).then_some(multipliers)
}

/// H = (AᵀYA)⁻¹ for the multipliers y.
fn shape_of(sides: &[Side], y: &[Interval]) -> Option<Matrix> {
    let d = sides[0].normal.len();
    let mut matrix = vec![vec![Interval::zero(); d]; d];
    for (side, y) in sides.iter().zip(y) {
        for (j, row) in matrix.iter_mut().enumerate() {
            let term = y.times(&side.normal[j]);
            for (entry, a) in row.iter_mut().zip(&side.normal) {
                *entry = entry.plus(&term.times(a)).into_middle();
            }
        }
    }
    let factor = Factor::of(&matrix, Way::Plain)?;
    let unit =
        |j: usize| -> Vector { (0..d).map(|k| Interval::integer(i64::from(j == k))).collect() };
    let mut inverse: Matrix = (0..d).map(|j| factor.solve(&unit(j))).collect::<Option<_>>()?;
    for j in 0..d {
        for k in 0..j {
            inverse[j][k] = inverse[k][j].clone();
        }
    }
    Some(
        inverse
            .into_iter()
            .map(|row| row.into_iter().map(Interval::into_middle).collect())
            .collect(),
    )
}

/// Zhang and Gao's method, with their letters: h = √diag Q for Q = AHAᵀ, slacks z of the sides, yz = μ.
fn solve(sides: &[Side], inside: &[Interval]) -> Option<Guess> {
    let (m, d, way) = (sides.len(), inside.len(), Way::Plain);
    // Sides in offsets from the point inside, each divided by its distance: aᵀx ≤ 1.
    let unit: Vec<Side> = sides
        .iter()
        .map(|side| {
            let room = side.bound.minus(&dot(&side.normal, inside)).into_middle();
            if !room.is_positive() {
                return None;
            }
            let normal: Option<Vector> =
                side.normal.iter().map(|a| Some(way.keep(a.over(&room)?))).collect();
            Some(Side { normal: normal?, bound: Interval::integer(1) })
        })
        .collect::<Option<_>>()?;
    let one = Interval::integer(1);
    let mut x = vec![Interval::zero(); d];
    let mut y = vec![one.clone(); m];
    let mut room = vec![one.clone(); m];
    let mut z: Vector = vec![];
    let count = Interval::integer(m as i64);
    for step in 0..STEPS_MAX {
        let mut shape = shape_of(&unit, &y)?;
        let products = |shape: &Matrix| -> Matrix {
            let half: Matrix = unit.iter().map(|s| image(shape, &s.normal)).collect();
            half.iter()
                .map(|h| unit.iter().map(|s| dot(&s.normal, h).into_middle()).collect())
                .collect()
        };
        let mut q = products(&shape);
        let roots = |q: &Matrix| -> Option<Vector> {
            (0..m).map(|i| Some(way.keep(q[i][i].root()?))).collect()
        };
        let mut h = roots(&q)?;
        if step == 0 {
            // y is scaled so that the ellipsoid is the largest of its shape.
            let ratios = (0..m).map(|i| room[i].over(&h[i]).map_or(0.0, |r| r.rounded()));
            let t = Interval::exact(ratios.fold(f64::INFINITY, f64::min))?;
            let square = t.square();
            y = y.iter().map(|y| Some(way.keep(y.over(&square)?))).collect::<Option<_>>()?;
            shape = shape_of(&unit, &y)?;
            q = products(&shape);
            h = roots(&q)?;
            let least = Interval::fraction(1, 10)?;
            z = (0..m)
                .map(|i| {
                    let slack = way.keep(room[i].minus(&h[i]));
                    if least.at_most(&slack) == Some(true) { slack } else { least.clone() }
                })
                .collect();
        }
        let gap = way.keep(dot(&y, &z).over(&count)?);
        let residual = (0..m)
            .map(|i| room[i].minus(&h[i]).minus(&z[i]).absolute().rounded())
            .fold(0.0, f64::max);
        if gap.binary_order() < GAP_EXPONENT && residual < 1e-30 {
            let center = inside.iter().zip(&x).map(|(c, x)| c.plus(x).into_middle()).collect();
            // The multipliers of the sides as they were: λ = yh, over the same distances.
            let multipliers = unit
                .iter()
                .zip(sides)
                .zip(y.iter().zip(&h))
                .map(|((unit, side), (y, h))| {
                    let used = (0..d).filter(|&j| side.normal[j].is_nonzero());
                    let largest = used.max_by_key(|&j| side.normal[j].binary_order())?;
                    let part = unit.normal[largest].over(&side.normal[largest])?;
                    Some(way.keep(y.times(h).times(&part)))
                })
                .collect::<Option<_>>()?;
            return Some(Guess { center, shape, multipliers });
        }
        let tenth = Interval::fraction(1, 10)?;
        let mu = match gap.at_most(&tenth) {
            Some(true) if gap.binary_order() > -30 => way.keep(gap.times(&tenth)),
            Some(true) => way.keep(gap.scaled(-8)),
            _ => way.keep(gap.scaled(-1)),
        };
        let yh: Vector = y.iter().zip(&h).map(|(y, h)| way.keep(y.times(h))).collect();
        let r1: Vector = (0..d)
            .map(|j| {
                let terms = unit.iter().zip(&yh);
                terms.fold(Interval::zero(), |s, (side, yh)| s.minus(&side.normal[j].times(yh)))
            })
            .collect();
        // G = (YQ)∘(YQ)ᵀ + diag(2yh·z); T = G⁻¹ diag(h + z) Y A.
        let g: Matrix = (0..m)
            .map(|i| {
                let mut row: Vector =
                    (0..m).map(|j| way.keep(q[i][j].square().times(&y[i]).times(&y[j]))).collect();
                row[i] = way.keep(row[i].plus(&yh[i].times(&z[i]).scaled(1)));
                row
            })
            .collect();
        let r23: Vector = (0..m)
            .map(|i| {
                let r2 = room[i].minus(&h[i]).minus(&z[i]);
                let r3 = mu.minus(&y[i].times(&z[i])).over(&y[i])?;
                Some(way.keep(r2.minus(&r3)))
            })
            .collect::<Option<_>>()?;
        let factor = Factor::of(&g, way)?;
        let t: Matrix = (0..d)
            .map(|j| {
                let right: Vector = (0..m)
                    .map(|i| way.keep(h[i].plus(&z[i]).times(&y[i]).times(&unit[i].normal[j])))
                    .collect();
                factor.solve(&right)
            })
            .collect::<Option<_>>()?;
        // (AᵀP)ⱼᵢ = 2yᵢhᵢ·Tᵢⱼ − yᵢaᵢⱼ.
        let atp: Matrix = (0..d)
            .map(|j| {
                (0..m)
                    .map(|i| {
                        let first = yh[i].times(&t[j][i]).scaled(1);
                        way.keep(first.minus(&y[i].times(&unit[i].normal[j])))
                    })
                    .collect()
            })
            .collect();
        let column = |k: usize| -> Vector { unit.iter().map(|s| s.normal[k].clone()).collect() };
        let system: Matrix = atp
            .iter()
            .map(|row| (0..d).map(|k| way.keep(dot(row, &column(k)))).collect())
            .collect();
        let right: Matrix =
            (0..d).map(|j| vec![way.keep(r1[j].plus(&dot(&atp[j], &r23)))]).collect();
        let (dx, _) = eliminated(&system, &right, way)?;
        let dx: Vector = dx.into_iter().flatten().collect();
        let adx: Vector = unit.iter().map(|s| way.keep(dot(&s.normal, &dx))).collect();
        let right: Vector =
            (0..m).map(|i| way.keep(yh[i].scaled(1).times(&adx[i].minus(&r23[i])))).collect();
        let relative = factor.solve(&right)?;
        let dy: Vector = y.iter().zip(&relative).map(|(y, r)| way.keep(y.times(r))).collect();
        let dz: Vector = (0..m)
            .map(|i| {
                let r3 = mu.minus(&y[i].times(&z[i])).over(&y[i])?;
                Some(way.keep(r3.minus(&z[i].times(&relative[i]))))
            })
            .collect::<Option<_>>()?;
        let less: Vector = adx.iter().map(Interval::negative).collect();
        let alpha = longest(&room, &less).min(longest(&y, &dy)).min(longest(&z, &dz));
        let alpha = Interval::exact(alpha)?;
        let go = |x: &mut Interval, step: &Interval| *x = way.keep(x.plus(&alpha.times(step)));
        x.iter_mut().zip(&dx).for_each(|(x, step)| go(x, step));
        y.iter_mut().zip(&dy).for_each(|(x, step)| go(x, step));
        z.iter_mut().zip(&dz).for_each(|(x, step)| go(x, step));
        room.iter_mut().zip(&less).for_each(|(x, step)| go(x, step));
    }
    None
}
