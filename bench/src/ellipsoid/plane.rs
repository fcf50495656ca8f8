//! Ellipses around a million points, beside CGAL, whose ellipse is judged as well.

use anyhow::Result;
use serde_json::json;
use taut_certify::EllipsoidVerdict;

use super::Context;
use super::case::Case;
use super::goals::{self, Measured};
use super::laws::Law;
use super::points::{COLUMNS, solve};
use crate::input::{SEED, write_rows};
use crate::stats::{seconds, times};
use crate::table::Table;

/// CGAL's program, as `bench/setup` builds it.
const PEER: &str = "cgal-min-ellipse";
/// Relative deviation that rounding in the peer's last steps explains.
const ROUNDING: f64 = 1e-12;
/// Relative deviation beyond which an ellipse is called wrong: the tenth digit.
const WRONG: f64 = 1e-10;

/// What was found about the ellipse of a peer.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Judgement {
    /// Points that lie outside by more than rounding.
    outside: u64,
    /// By how much |F(x − c)| exceeds 1 at the worst of them.
    excess: f64,
    /// How far the logarithm of the area lies below (negative) or above the bracket that was proved; 0 inside.
    off: f64,
}

impl Judgement {
    /// Judges {x : q₁₁x² + 2q₁₂xy + q₂₂y² ≤ 1} about the centre; `numbers` are its two coordinates, q₁₁, q₁₂, q₂₂.
    fn of(values: &[f64], numbers: &[f64], bracket: Option<&EllipsoidVerdict>) -> Judgement {
        let [cx, cy, q11, q12, q22] = *numbers else {
            return Judgement { outside: 0, excess: f64::NAN, off: f64::NAN };
        };
        let (mut outside, mut worst) = (0, f64::NEG_INFINITY);
        for [x, y] in values.as_chunks::<2>().0 {
            let (x, y) = (x - cx, y - cy);
            let norm = (q11 * x * x + 2.0 * q12 * x * y + q22 * y * y).sqrt();
            // NaN is inside nothing.
            let inside = norm <= 1.0 + ROUNDING;
            outside += u64::from(!inside);
            worst = if norm.is_nan() { f64::INFINITY } else { worst.max(norm) };
        }
        let log_area = std::f64::consts::PI.ln() - 0.5 * (q11 * q22 - q12 * q12).ln();
        let off = bracket.map_or(f64::NAN, |bracket| match log_area {
            area if area < bracket.lower => area - bracket.lower,
            area if area > bracket.upper => area - bracket.upper,
            area if area.is_nan() => f64::NAN,
            _ => 0.0,
        });
        Judgement { outside, excess: worst - 1.0, off }
    }
}

impl std::fmt::Display for Judgement {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let within = |tolerance| self.excess <= tolerance && self.off.abs() <= tolerance;
        match (within(WRONG), within(ROUNDING)) {
            (false, _) => write!(f, "WRONG: ")?,
            (_, false) => write!(f, "INEXACT: ")?,
            _ => {}
        }
        match self.outside {
            0 => write!(f, "encloses ({:.1e})", self.excess)?,
            n => write!(f, "{n} points outside by up to {:.1e}", self.excess)?,
        }
        match self.off {
            off if off.abs() <= ROUNDING => write!(f, ", area in our bracket"),
            off => write!(f, ", log-area {off:+.1e} off our bracket"),
        }
    }
}

/// Runs the case under all laws.
pub(super) fn run(context: &mut Context, case: &Case, laws: &[Law]) -> Result<()> {
    let n = if context.quick { 100_000 } else { 1_000_000 };
    let mut all = Vec::new();
    for law in laws {
        let values = law.draw(n, 2, SEED)?;
        let what = format!("{law}, {n} × 2");
        let file = context.temp.path().join("points");
        write_rows(&file, &values, 2)?;
        let solved = solve(context, &values, 2, Some((PEER, &file)))?;
        let mut table = Table::new(&[&["program"], &COLUMNS[..], &["answer"]].concat());
        table.push([vec!["taut".to_owned()], solved.cells(), vec![String::new()]].concat());
        let mut row = vec![PEER.to_owned()];
        row.resize(COLUMNS.len() + 1, String::new());
        let mut judged = String::new();
        match &solved.rounds.peer {
            Some(Ok((answer, _))) => {
                row[1] = solved.rounds.peer_seconds().map(seconds).unwrap_or_default();
                row[COLUMNS.len()] = answer.support.to_string();
                let verdict = solved.verdict.as_ref().ok();
                judged = Judgement::of(&values, &answer.center, verdict).to_string();
                row.push(judged.clone());
            }
            Some(Err(silence)) => row.push(silence.to_string()),
            None => row.push("not asked".to_owned()),
        }
        table.push(row);
        println!("{what}\n\n{table}");
        let (ours, least) = (solved.rounds.one_thread(), solved.rounds.peer_seconds());
        if let (Some(ours), Some(median)) = (ours, solved.rounds.peer_median()) {
            // It shuffles the points anew in each round, and the least is that of its luckiest shuffle.
            println!("- the middle of CGAL's rounds is {} times our time", times(median / ours));
        }
        let faster = least.zip(ours).map(|(least, ours)| least / ours);
        let measured = Measured { faster, ..solved.measured() };
        let goals = goals::print(&[case.must], &[case.aim], &measured);
        println!();
        all.push(json!({ "input": what, "solved": solved.json(), "peer": judged, "goals": goals }));
    }
    context.report.add(json!({ "name": case.name, "inputs": all }));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_outside_and_wrong_areas_are_seen() {
        let unit = EllipsoidVerdict {
            lower: std::f64::consts::PI.ln() - 1e-15,
            upper: std::f64::consts::PI.ln() + 1e-15,
            gap: 2e-15,
            excess: 0.0,
            matrix_excess: 0.0,
            rank: 2,
        };
        let values = [1.0, 0.0, -1.0, 0.0, 0.0, 1.0];
        let of = |numbers: &[f64]| Judgement::of(&values, numbers, Some(&unit));
        let right = of(&[0.0, 0.0, 1.0, 0.0, 1.0]);
        assert_eq!((right.outside, right.excess, right.off), (0, 0.0, 0.0));
        assert_eq!(right.to_string(), "encloses (0.0e0), area in our bracket");
        let shifted = of(&[0.5, 0.0, 1.0, 0.0, 1.0]);
        assert_eq!((shifted.outside, shifted.off), (2, 0.0));
        assert!(shifted.to_string().starts_with("WRONG: 2 points outside by up to 5.0e-1"));
        assert!(of(&[0.0, 0.0, 0.5, 0.0, 0.5]).to_string().starts_with("WRONG: encloses"));
        let nan = of(&[f64::NAN, 0.0, 1.0, 0.0, 1.0]);
        assert!(nan.outside == 3 && nan.to_string().starts_with("WRONG"));
        assert!(of(&[0.0]).to_string().starts_with("WRONG"));
    }
}
