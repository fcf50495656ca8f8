//! Fourier transforms beside rustfft's.

use anyhow::{Result, ensure};
use rustfft::FftPlanner;
use serde_json::{Value, json};
use taut_oblivious::{Complex64, Direction, fft};

use super::draw::Draw;
use super::lanes::Lanes;
use crate::context::Context;
use crate::stats::times;
use crate::table::Table;

/// Three sizes; the goal is few passes over memory, not these times, so none of them has a bound.
pub(super) fn run(context: &Context) -> Result<Value> {
    let logs: &[u32] = if context.quick { &[12, 14] } else { &[17, 20, 22] };
    let mut table =
        Table::new(&["n", "taut, ns each", "rustfft, ns each", "rustfft ÷ taut", "difference"]);
    let mut measured = vec![];
    for &log in logs {
        let n = 1usize << log;
        let mut draw = Draw(1);
        let given: Vec<Complex64> =
            (0..n).map(|_| Complex64::new(draw.unit() - 0.5, draw.unit() - 0.5)).collect();
        let plan = FftPlanner::new().plan_fft_forward(n);
        let mut lanes = Lanes::default();
        let mut worst = 0.0f64;
        // Short ones are disturbed more easily.
        for _ in 0..context.runs << (22 - log).min(3) {
            // taut takes the signal as room to work in, as rustfft takes its scratch.
            let (mut signal, mut spectrum) = (given.clone(), given.clone());
            lanes.time("taut", || fft(&mut signal, &mut spectrum, Direction::Forward))?;
            let (mut other, mut scratch) = (given.clone(), given.clone());
            scratch.resize(plan.get_inplace_scratch_len().max(n), Complex64::ZERO);
            lanes.time("rustfft", || plan.process_with_scratch(&mut other, &mut scratch));
            let gap: f64 = spectrum.iter().zip(&other).map(|(a, b)| (a - b).norm_sqr()).sum();
            let size: f64 = other.iter().map(Complex64::norm_sqr).sum();
            worst = worst.max((gap / size).sqrt());
        }
        // Each is within 1e-15 log₂ n of the transform.
        ensure!(worst <= 2e-15 * f64::from(log), "the spectra of 2^{log} differ by {worst}");
        let each = |name| format!("{:.2}", lanes.of(name) / n as f64 * 1e9);
        let ratio = times(lanes.faster("taut", "rustfft"));
        table.push(vec![
            format!("2^{log}"),
            each("taut"),
            each("rustfft"),
            ratio,
            format!("{worst:.1e}"),
        ]);
        measured.push(json!({ "n": n, "lanes": lanes.json(n), "difference": worst }));
    }
    println!("relative difference of the spectra, in the mean of squares\n\n{table}");
    Ok(json!({ "sizes": measured }))
}
