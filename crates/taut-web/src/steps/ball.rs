//! The ball of a growing core-set: the farthest point is added until none is outside.
//!
//! *Idea.* The smallest ball around a part of the points is no larger than that around all of them, so its radius is a lower bound;
//! its center with the distance of the farthest point is a ball around all of them, so that is an upper bound. This is Algorithm 1 of
//! the thesis; the default method adds several far points at a time.

use serde_json::Value;
use taut_draw::{Figure, LineStyle, Tone};
use taut_report::numbers::{count, counted, gap, short};

use super::frame::{Frame, circles, cloud, marked};
use super::{POINTS_MAX, Table, Trace, ball_of, place, said};
use crate::input::Opened;

/// Most rounds shown.
const ROUNDS_MAX: usize = 100;

/// Relative excess up to which a point counts as inside: the ball is exact to a few roundings.
const INSIDE_SLACK: f64 = 1e-12;

/// The ball of a core-set, and the point farthest from its center.
#[derive(Debug)]
struct Round {
    center: Vec<f64>,
    radius: f64,
    farthest: usize,
    reach: f64,
}

/// All rounds. Round i has the first i + 2 rows of the core-set, or fewer where all points are equal.
#[derive(Debug)]
pub(super) struct Rounds {
    table: Table,
    core_set: Vec<usize>,
    rounds: Vec<Round>,
    frame: Frame,
}

impl Rounds {
    pub(super) fn new(points: &Opened) -> Result<Self, String> {
        let rows = points.source().len();
        if rows > POINTS_MAX || rows == 0 {
            let (rows, most) = (count(rows), count(POINTS_MAX));
            return Err(format!("the steps are shown for 1 to {most} points, not for {rows}"));
        }
        let table = Table::of(points, POINTS_MAX)?;
        let (first, _) = table.farthest(table.row(0));
        let (second, apart) = table.farthest(table.row(first));
        let mut core_set = if apart > 0.0 { vec![first, second] } else { vec![first] };
        let mut rounds = Vec::new();
        let mut frame = Frame::of(&table);
        loop {
            let (center, radius) = ball_of(&table, &core_set)?;
            let (farthest, reach) = table.farthest(&center);
            frame.hold(place(&center), reach.max(radius));
            rounds.push(Round { center, radius, farthest, reach });
            let is_inside = reach <= radius * (1.0 + INSIDE_SLACK);
            if is_inside || core_set.contains(&farthest) || rounds.len() == ROUNDS_MAX {
                break;
            }
            core_set.push(farthest);
        }
        Ok(Rounds { table, core_set, rounds, frame })
    }

    fn round(&self, step: usize) -> Result<(&Round, &[usize]), String> {
        let round = self.rounds.get(step).ok_or("there is no such step")?;
        let size = self.core_set.len() - (self.rounds.len() - 1 - step);
        Ok((round, &self.core_set[..size]))
    }

    fn is_last(&self, step: usize) -> bool {
        step + 1 == self.rounds.len()
    }
}

impl Trace for Rounds {
    fn count(&self) -> usize {
        self.rounds.len()
    }

    fn words(&self, step: usize) -> Result<Value, String> {
        let (round, core_set) = self.round(step)?;
        let Round { radius, reach, farthest, .. } = round;
        let title = format!("The ball of {}", counted(core_set.len() as u64, "point"));
        let bounds = format!(
            "No ball around all {} points has a radius below {}, and one of radius {} holds them",
            count(self.table.len() as u64),
            short(*radius),
            short(reach.max(*radius))
        );
        let text = match self.is_last(step) {
            true => format!(
                "No point is outside: this is the smallest ball. Radius {}.",
                short(*radius)
            ),
            false => format!(
                "{bounds}: a gap of {}. Row {} is farthest from the center, so it joins the core-set.",
                gap((reach - radius) / radius),
                farthest + 1
            ),
        };
        Ok(said(title, text))
    }

    fn figure(&self, step: usize) -> Result<Figure, String> {
        let (round, core_set) = self.round(step)?;
        let center = place(&round.center);
        let next: &[usize] = if self.is_last(step) { &[] } else { &[round.farthest] };
        let outer = (!self.is_last(step)).then_some((center, round.reach));
        let layers = vec![
            cloud(&self.table, "points"),
            circles("holds all points", Tone::Answer, LineStyle::Dashed, outer),
            circles(
                "ball of the core-set",
                Tone::Bound,
                LineStyle::Filled,
                [(center, round.radius)],
            ),
            marked(&self.table, core_set, "core-set", Tone::Support, 4.5),
            marked(&self.table, next, "farthest point", Tone::Second, 6.0),
        ];
        let caption = match self.table.dim {
            0..=2 => String::new(),
            dim => format!("A shadow: the first two of {dim} coordinates."),
        };
        Ok(self.frame.figure(&self.table, String::new(), caption, layers))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

    #[test]
    fn bounds_close_in_on_the_radius_that_the_solver_finds() {
        for name in ["few", "normal-64"] {
            let points = samples::generate(name).unwrap();
            let options = taut::BallOptions { epsilon: 0.0, ..Default::default() };
            let best = taut::ball(points.source(), &options).unwrap().answer.radius;
            let rounds = Rounds::new(&points).unwrap();
            assert!(rounds.count() >= 2, "{name}: {}", rounds.count());
            for pair in rounds.rounds.windows(2) {
                assert!(pair[0].radius <= pair[1].radius * (1.0 + 1e-12));
            }
            for round in &rounds.rounds {
                assert!(
                    round.radius <= best * (1.0 + 1e-12) && round.reach >= best * (1.0 - 1e-12)
                );
            }
            let last = rounds.rounds.last().unwrap();
            assert!((last.radius - best).abs() <= 1e-10 * best, "{name}: {} {best}", last.radius);
            assert_eq!(rounds.round(0).unwrap().1.len(), 2);
            assert!(rounds.figure(rounds.count()).is_err());
        }
    }

    #[test]
    fn equal_points_are_one_step() {
        let points = Opened::read(b"1,1\n1,1\n1,1\n".to_vec(), "equal.csv").unwrap();
        let rounds = Rounds::new(&points).unwrap();
        assert_eq!(rounds.count(), 1);
        assert!(rounds.words(0).unwrap()["text"].as_str().unwrap().contains("Radius 0"));
    }
}
