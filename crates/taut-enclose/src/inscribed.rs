//! The ellipsoid of largest volume inside a polytope.
//!
//! *Problem.* {x : aᵢ′x ≤ bᵢ}: maximize ln det G over {c + Gz : |z| ≤ 1} with |G′aᵢ| + aᵢ′c ≤ bᵢ.
//! *Idea.* An interior point by a linear program ([`start`]), then Newton steps along the central path, each in the
//! frame in which the current ellipsoid is the unit ball, so that no step sees how long the polytope is ([`path`]). The
//! path gives multipliers; a least-squares correction makes them satisfy their equations to the last digits.
//! *Guarantee.* The ellipsoid is inside at any moment. The gap is n times the parameter of the path.
//! *Reference.* Khachiyan and Todd, Math. Programming 61, 1993; Zhang and Gao, SIAM J. Optim. 14(1), 2003; Nesterov and
//! Nemirovskii, Interior-Point Polynomial Algorithms, SIAM 1994, for the barrier.

mod path;
mod start;

use taut_certify::{InscribedCertificate, InscribedEllipsoid, PassBounds, Solution, Stop, Trace};
use taut_kernels::DoubleDouble;
use taut_kernels::vector::dot;
use taut_points::{
    InputError, Monitor, PointSource, PointsHash, Rows, exponent_of, hash_block, map_blocks,
    shown_number, two_to, two_to_in_steps,
};

use crate::Error;

/// An ellipsoid is drawn in by at most this, so that rounding does not take it beyond a half-space.
const SHRINKAGE_MAX: f64 = 1e-3;

/// Gap that rounding leaves, for each dimension.
const ROUNDING: f64 = 1e-13;

/// A multiplier below this part of the largest is taken for that of a half-space that does not touch.
const MULTIPLIER_RATIO_MIN: f64 = 1e-6;

/// Options to look for the inscribed ellipsoid. Write `InscribedOptions { epsilon: 1e-6, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct InscribedOptions<'a> {
    /// Wanted gap, optimum ≤ log-volume + ε. Range (0, 1), default 1e-9.
    pub epsilon: f64,
    /// Most Newton steps; then the ellipsoid so far is returned with its gap. At least 1, default 1000.
    pub max_steps: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for InscribedOptions<'_> {
    fn default() -> Self {
        InscribedOptions { epsilon: 1e-9, max_steps: 1000, monitor: Monitor::silent() }
    }
}

/// Half-spaces in memory.
struct HalfSpaces {
    dim: usize,
    /// n × (d + 1): a, then b, divided by the power of two that brings the largest entry of a to [1, 2).
    values: Vec<f64>,
    hash: PointsHash,
}

impl HalfSpaces {
    fn rows(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.dim + 1)
    }
}

/// The ellipsoid of largest volume in the polytope {x : aᵢ′x ≤ bᵢ}, given by rows of d + 1 numbers: aᵢ, then bᵢ.
///
/// The answer lies in every half-space, and its certificate proves that no ellipsoid in the polytope has a log-volume
/// larger by more than the gap. The gap is at most [`InscribedOptions::epsilon`] unless
/// [`Trace::stop`](taut_certify::Trace::stop) says why not.
///
/// *Cost.* Thirty to eighty Newton steps of O(nd⁴ + d⁶), after a linear program; O(nd + d⁴) memory,
/// for the half-spaces too, whatever they come from.
///
/// ```
/// use taut_enclose::{InscribedOptions, inscribed_ellipsoid};
///
/// // The rectangle [0, 4] × [0, 2].
/// let sides = [1.0, 0.0, 4.0, -1.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.0, -1.0, 0.0];
/// let sides = taut_points::Points::new(&sides, 3)?;
/// let found = inscribed_ellipsoid(&sides, &InscribedOptions::default())?;
/// assert!((found.answer.log_volume - (2.0 * std::f64::consts::PI).ln()).abs() < 1e-9);
/// assert!(found.check(&sides)?.gap <= 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Empty`], [`Error::Input`], [`Error::Overflow`], [`Error::Input`]; [`Error::NoNormal`];
/// [`Error::Unbounded`] with a direction in which the polytope does not end; [`Error::NoInterior`] with multipliers that
/// show why; [`Error::Undecided`] where rounding leaves neither proved.
pub fn inscribed_ellipsoid(
    half_spaces: &dyn PointSource,
    options: &InscribedOptions<'_>,
) -> Result<Solution<InscribedEllipsoid>, Error> {
    let wrong = |name, value: String, expected| {
        Err(Error::Input(InputError::Option { name, value, expected }))
    };
    if !(options.epsilon > 0.0 && options.epsilon < 1.0) {
        return wrong("epsilon", shown_number(options.epsilon), "a number in (0, 1)");
    }
    if options.max_steps == 0 {
        return wrong("max_steps", "0".into(), "at least 1");
    }
    let sides = read(half_spaces, &options.monitor)?;
    let start = start::interior(&sides)?;
    let found = path::follow(&sides, start, options, &options.monitor)?;
    prove(&sides, found, options)
}

fn read(source: &dyn PointSource, monitor: &Monitor<'_>) -> Result<HalfSpaces, Error> {
    if source.is_empty() {
        return Err(Error::Empty);
    }
    let columns = source.dim();
    if columns < 2 {
        return Err(Error::NoNormal { row: 0 });
    }
    monitor.pass(1, source.len());
    let blocks = map_blocks(source, monitor, |first, rows| {
        rows.check_finite(first)?;
        let hash = hash_block(&rows);
        let values: Vec<f64> = match rows {
            Rows::F32(points) => points.values().iter().map(|&v| v.into()).collect(),
            Rows::F64(points) => points.values().to_vec(),
        };
        Ok::<_, Error>((hash, values))
    })?;
    let hash = PointsHash::of_blocks(source.len(), columns, blocks.iter().map(|block| block.0));
    let mut values: Vec<f64> = blocks.into_iter().flat_map(|b| b.1).collect();
    for (row, side) in values.chunks_exact_mut(columns).enumerate() {
        let largest = side[..columns - 1].iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if largest == 0.0 {
            return Err(Error::NoNormal { row: row as u64 });
        }
        // In two steps: the power that takes the largest number to 1 is none itself.
        let [first, second] = two_to_in_steps(-exponent_of(largest));
        side.iter_mut().for_each(|v| *v = *v * first * second);
    }
    Ok(HalfSpaces { dim: columns - 1, values, hash })
}

/// The multipliers without those of half-spaces that do not touch: the path gives some to every half-space, and they
/// tend to 0 with it.
fn few(views: &[View], lambda: &[f64]) -> Option<Vec<f64>> {
    let weight = |i: usize| lambda[i] * dot(&views[i].normal, &views[i].normal).sqrt();
    let most = (0..lambda.len()).map(weight).fold(0.0, f64::max);
    let few: Vec<f64> = (0..lambda.len())
        .map(|i| if weight(i) > MULTIPLIER_RATIO_MIN * most { lambda[i] } else { 0.0 })
        .collect();
    (few != lambda).then_some(few)
}

/// c, G by rows, multipliers of all rows, and how it came about.
struct PathResult {
    center: Vec<f64>,
    axes: Vec<f64>,
    lambda: Vec<f64>,
    steps: u64,
    stop: Stop,
    history: Vec<PassBounds>,
}

/// A half-space in the frame of an ellipsoid.
struct View {
    /// ã = G′a and s = b − a′c, divided by `unit`, so that they have squares however thin the polytope is.
    normal: Vec<f64>,
    slack: f64,
    /// A power of two. A multiplier of the row is one of what is seen, divided by it.
    unit: f64,
}

/// Returns what a half-space looks like, with twice the digits where numbers cancel.
fn seen(row: &[f64], center: &[f64], axes: &[f64]) -> View {
    let dim = center.len();
    let mut slack = DoubleDouble::from(row[dim]);
    let mut normal = vec![DoubleDouble::ZERO; dim];
    for (j, axes) in axes.chunks_exact(dim).enumerate() {
        slack = slack - DoubleDouble::product(row[j], center[j]);
        for (sum, &g) in normal.iter_mut().zip(axes) {
            *sum = *sum + DoubleDouble::product(row[j], g);
        }
    }
    let largest = normal.iter().fold(slack.high.abs(), |m, v| m.max(v.high.abs()));
    let unit = two_to(exponent_of(largest).clamp(-1000, 1000));
    View { normal: normal.iter().map(|v| v.high / unit).collect(), slack: slack.high / unit, unit }
}

/// From the end of the path to an answer: grown until it touches, multipliers corrected for what it is then.
fn prove(
    sides: &HalfSpaces,
    found: PathResult,
    options: &InscribedOptions<'_>,
) -> Result<Solution<InscribedEllipsoid>, Error> {
    let dim = sides.dim;
    let PathResult { center, mut axes, lambda, steps, mut stop, history } = found;
    let measure = |axes: &[f64]| {
        sides
            .rows()
            .map(|row| seen(row, &center, axes))
            .map(|view| view.slack / dot(&view.normal, &view.normal).sqrt())
            .fold(f64::INFINITY, f64::min)
    };
    // Norms and roundings of G; the checker asks for a little more than nothing. Where G is so thin that rounding its
    // entries moves it by more, a wider margin is found.
    let margin = 8.0 * (dim + 8) as f64 * f64::EPSILON;
    let mut wider = margin;
    path::orthogonalize(&mut axes, dim);
    loop {
        let room = measure(&axes) * (1.0 - wider);
        if !(room > 0.0 && room.is_finite()) || wider > SHRINKAGE_MAX {
            return Err(Error::Undecided);
        }
        axes.iter_mut().for_each(|g| *g *= room);
        let is_inside = measure(&axes) >= 1.0 + 0.5 * margin;
        if is_inside {
            break;
        }
        wider *= 4.0;
    }
    let views: Vec<View> = sides.rows().map(|row| seen(row, &center, &axes)).collect();
    let lambda: Vec<f64> = views.iter().zip(lambda).map(|(view, l)| l * view.unit).collect();
    let few = few(&views, &lambda);
    let mut lambda = path::corrected(&views, lambda);
    let mut gap = path::gap(&views, &lambda);
    if let Some(few) = few.map(|few| path::corrected(&views, few)) {
        let by_few = path::gap(&views, &few);
        if by_few.is_finite() && by_few <= gap.max(0.5 * options.epsilon) {
            (lambda, gap) = (few, by_few);
        }
    }
    let log_det = path::log_determinant(&axes, dim);
    let log_volume = log_det + crate::ellipsoid::outcome::log_unit_ball(dim);
    if !log_volume.is_finite() || center.iter().chain(&axes).any(|v| !v.is_finite()) {
        return Err(Error::Overflow);
    }
    let gap = (gap + margin * dim as f64).min(f64::MAX);
    if stop == Stop::Converged && gap > options.epsilon {
        stop = Stop::Rounding;
    }
    let lambda: Vec<f64> = views.iter().zip(lambda).map(|(view, l)| l / view.unit).collect();
    let is_used = |l: f64| l > 0.0 && l.is_finite();
    let support: Vec<usize> = (0..lambda.len()).filter(|&i| is_used(lambda[i])).collect();
    let certificate = InscribedCertificate {
        support: support.iter().map(|&i| i as u64).collect(),
        multipliers: support.iter().map(|&i| lambda[i]).collect(),
        gap,
        points_hash: sides.hash,
    };
    let answer = InscribedEllipsoid {
        center,
        axes: axes.chunks_exact(dim).map(<[f64]>::to_vec).collect(),
        log_volume,
    };
    let trace = Trace {
        method: "newton".into(),
        stop,
        passes: 1,
        iterations: steps,
        core_set: support.len() as u64,
        history,
        ..Trace::default()
    };
    Ok(Solution { answer, certificate, trace })
}
