//! Curves through samples of the plane.

mod answer;
mod boxes;
mod chains;
mod clean;
mod cloud;
mod fit;
mod index;
mod options;
mod tour;

use taut_certify::{Curve, Solution};
use taut_points::{Monitor, PointSource, Points, Scalar};

use crate::Error;
use crate::threads::on_threads;
use answer::{Outcome, finish};
use cloud::Cloud;

pub use options::{CurveMethod, CurveOptions, Ends};

/// The curves that points of the plane were sampled from, with what is known about them.
///
/// # Errors
/// [`Error::Dimension`], [`Error::NonFinite`], [`Error::TooManyPoints`], [`Error::Option`].
pub fn curve<T: Scalar>(
    points: &Points<'_, T>,
    options: &CurveOptions,
) -> Result<Solution<Curve>, Error> {
    curve_of_source(points, options, &Monitor::silent())
}

/// The same for points of any source, with a monitor. They are held in memory while it works.
///
/// # Errors
/// As [`curve`], [`Error::Read`] when the points cannot be read, and [`Error::Cancelled`].
pub fn curve_of_source(
    source: &dyn PointSource,
    options: &CurveOptions,
    monitor: &Monitor<'_>,
) -> Result<Solution<Curve>, Error> {
    let wrong =
        |name, value: f64, expected| Error::Option { name, value: value.to_string(), expected };
    if !(options.rho >= 1.0 && options.rho.is_finite()) {
        return Err(wrong("rho", options.rho, "a number of at least 1"));
    }
    if !(options.omega > 0.0 && options.omega.is_finite()) {
        return Err(wrong("omega", options.omega, "a number above 0"));
    }
    on_threads(options.threads, || {
        let cloud = Cloud::read(source, monitor)?;
        let outcome = solve(&cloud, options, monitor)?;
        finish(&cloud, outcome, options, source, monitor)
    })
}

/// The curves by the method chosen.
fn solve(cloud: &Cloud, options: &CurveOptions, monitor: &Monitor<'_>) -> Result<Outcome, Error> {
    let outcome = Outcome { method: options.method.name(), ..Outcome::default() };
    Ok(match options.method {
        CurveMethod::Crust
        | CurveMethod::OneStepCrust
        | CurveMethod::NnCrust
        | CurveMethod::ConservativeCrust
        | CurveMethod::HnnCrust
        | CurveMethod::Corners => clean::solve(cloud, options.method, options.ends, monitor)?,
        CurveMethod::Tour => tour::tour(cloud, options, monitor)?,
        _ => outcome,
    })
}

#[doc(hidden)]
pub fn dev(points: &[[f64; 2]]) {
    let o = taut_oblivious::hilbert_order(points.len(), |i| points[i]);
    let p: Vec<_> = o.iter().map(|&i| points[i as usize]).collect();
    let t = std::time::Instant::now();
    let index = index::Index::new(&p);
    eprintln!("index {:?}", t.elapsed());
    let s = fit::seeds::seeds(&p, &index, &Monitor::silent()).unwrap();
    eprintln!("seeds {} {:?}", s.len(), t.elapsed());
    let c = fit::link::chains(&s, Ends::Auto);
    let mut strands: Vec<_> = c.iter().map(|c| fit::strand::Strand::new(c.seeds.iter().map(|s| fit::strand::Node { at: s.at, tangent: s.tangent, reach: s.reach, deviation: s.deviation }).collect(), c.closed)).collect();
    eprintln!("chains {:?} {:?}", c.iter().map(|c| (c.seeds.len(), c.closed)).collect::<Vec<_>>(), t.elapsed());
    let out = |strands: &[fit::strand::Strand], name: &str| {
        use std::io::Write;
        let mut f = std::fs::File::create(format!("/tmp/dev/out.{name}.xy")).unwrap();
        let mut e = std::fs::File::create(format!("/tmp/dev/out.{name}.e")).unwrap();
        let mut k = 0;
        for s in strands {
            for n in &s.nodes { writeln!(f, "{} {}", n.at[0], n.at[1]).unwrap(); }
            let m = s.nodes.len();
            for i in 0..s.edges() { writeln!(e, "{} {}", k + i, k + (i + 1) % m).unwrap(); }
            k += m;
        }
    };
    out(&strands, "0");
    let left = fit::strand::assign(&mut strands, &p, 5.0);
    eprintln!("assign left {} {:?}", left.len(), t.elapsed());
    for round in 1..3 {
        strands = strands.iter().map(|s| fit::strand::Strand::new(fit::regress::regress(s, if round == 1 { 3 } else { 1 }, &fit::regress::Noise { edge: (round > 1).then_some(1.73), outliers: left.len() > 100 }), s.closed)).collect();
        eprintln!("regress {:?}", t.elapsed());
        out(&strands, &round.to_string());
        let left = fit::strand::assign(&mut strands, &p, 5.0);
        eprintln!("assign left {} {:?}", left.len(), t.elapsed());
    }
}
